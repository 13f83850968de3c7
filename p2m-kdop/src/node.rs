//! The node of a k-DOP tree, which bounds its children by k-DOPs.

use crate::Kdop;
use crate::direction_table::DirectionTable;
use crate::lower_bound::squared_lower_bounds;
use nalgebra::{Point3, Vector3};
use p2m_bvh::engine::node::{Frame, NodeRef, WIDTH};
use p2m_bvh::engine::packet::Member;
use p2m_bvh::engine::ray::{FrameLine, RayInterval, SlabRay};
use p2m_bvh::engine::volume::WideNode;
use p2m_core::Aabb;
use p2m_core::engine::pairs::{Height, Rows};
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// A node of eight k-DOPs, stored side by side. The k-DOPs of unused slots are empty, so their distance is infinite or
/// NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct KdopNode<const K: usize> {
    heights: [[f32; WIDTH]; K],
    children: [NodeRef; WIDTH],
}

const _: () = assert!(size_of::<KdopNode<14>>() == 512);

/// A bound on the error of a height in the frame if products are rounded.
///
/// Coordinates are at most 4, so the magnitudes of three products add up to less than 7. Coordinates, products and both
/// sums have relative errors of at most 2^-53 each, which is less than 30 x 2^-53 in total.
const HEIGHT_SLACK: f64 = power_of_two(-48);
/// The slack of a query point: the amount that is subtracted from its products with the normals, relative to its size X
/// in the frame. It is 20 u of f32. Sides of an axis-aligned box have no slack.
///
/// The proof needs only a small part of it. Besides, products and heights are rounded outwards, and limits have a
/// margin of 2^-19. Tests therefore do not fail without it.
const QUERY_SLACK: f64 = 20.0 * power_of_two(-24);

impl<const K: usize> Rows for KdopNode<K> {
    #[inline(always)]
    fn row(&self, number: usize) -> &[f32; WIDTH] {
        &self.heights[number]
    }
}

impl<const K: usize> WideNode for KdopNode<K> {
    const INLINES_PORTABLE: bool = false;
    type Volume = Kdop<K>;
    type Shared = DirectionTable<K>;
    type Bounds = [f32; K];
    /// The products of the query point with the normals, minus [`QUERY_SLACK`] and rounded down.
    type Query = [f32; K];
    /// One slab per pair of opposite directions. The second half of the array is unused.
    type Ray = [SlabRay; K];

    const EMPTY: [f32; K] = [f32::NEG_INFINITY; K];
    const ROWS: usize = K;

    fn new(children: [NodeRef; WIDTH]) -> Self {
        Self { heights: [[f32::NEG_INFINITY; WIDTH]; K], children }
    }

    #[inline(always)]
    fn children(&self) -> &[NodeRef; WIDTH] {
        &self.children
    }

    fn from_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self {
        Self { heights: std::array::from_fn(|i| rows[i]), children }
    }

    fn set_bounds(&mut self, slot: usize, bounds: &[f32; K]) {
        self.heights.iter_mut().zip(bounds).for_each(|(row, x)| row[slot] = *x);
    }

    fn bounds(&self, slot: usize) -> [f32; K] {
        self.heights.map(|row| row[slot])
    }

    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    fn enclose(table: &DirectionTable<K>, frame: &Frame, primitives: &[Member], _: &Aabb<f64>) -> [f32; K] {
        let normals = table.directions.normals();
        let mut heights = [f64::NEG_INFINITY; K];
        let mut add = |corner: [f64; 3]| {
            let x = Vector3::from(frame.place(&corner));
            for j in 0..K / 2 {
                let product = normals[2 * j].dot(&x);
                heights[2 * j] = heights[2 * j].max(product);
                heights[2 * j + 1] = heights[2 * j + 1].max(-product);
            }
        };
        for primitive in primitives {
            primitive.vertices().iter().for_each(|vertex| add(*vertex));
            if primitive.vertices().is_empty() {
                // A primitive without vertices is bounded by the corners of its box.
                let [min, max] = [to_f64_array(&primitive.bounds.min), to_f64_array(&primitive.bounds.max)];
                (0..8).for_each(|i| add([0, 1, 2].map(|k: usize| if i >> k & 1 == 0 { min[k] } else { max[k] })));
            }
        }
        let rounded_up =
            |i: usize| ((heights[i] + if table.is_rounded[i] { HEIGHT_SLACK } else { 0.0 }) as f32).next_up();
        std::array::from_fn(rounded_up)
    }

    fn union(a: &[f32; K], b: &[f32; K]) -> [f32; K] {
        std::array::from_fn(|i| a[i].max(b[i]))
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn query(table: &DirectionTable<K>, frame: &Frame, query: &[f64; 3]) -> Option<[f32; K]> {
        let q = frame.local(query)?;
        let size = q[0].abs().max(q[1].abs()).max(q[2].abs()) + 2.0;
        let normals = table.directions.normals();
        let mut result = [0.0; K];
        for j in 0..K / 2 {
            let n = &normals[2 * j];
            let product = n.x * q[0] + n.y * q[1] + n.z * q[2];
            let slack = if table.is_exact_side(j) { 0.0 } else { QUERY_SLACK * size };
            result[2 * j] = ((product - slack) as f32).next_down();
            result[2 * j + 1] = ((-product - slack) as f32).next_down();
        }
        Some(result)
    }

    #[inline(always)]
    fn lower_bounds<L: Lanes>(&self, table: &DirectionTable<K>, query: &[f32; K]) -> L {
        squared_lower_bounds(&self.heights, table, query)
    }

    fn height(table: &DirectionTable<K>, direction: &[f64; 3]) -> Height {
        Height::new(table.as_sum_of_heights(direction))
    }

    fn ray(table: &DirectionTable<K>, line: &FrameLine) -> [SlabRay; K] {
        let [base, direction] = [line.base, line.direction].map(Vector3::from);
        // An array cannot have K / 2 entries, so the second half is unused.
        let mut ray = [SlabRay::default(); K];
        for (slab, faces) in ray.iter_mut().zip(table.directions.normals().chunks_exact(2)) {
            *slab = SlabRay::new(faces[0].dot(&base), faces[0].dot(&direction), line.margin * 2.0);
        }
        ray
    }

    #[inline(always)]
    fn entries<L: Lanes>(&self, ray: &[SlabRay; K]) -> L {
        let mut interval = RayInterval::complete();
        for (slab, heights) in ray.iter().zip(self.heights.chunks_exact(2)) {
            interval.clip(slab, L::splat(0.0).sub(L::load(&heights[1])), L::load(&heights[0]));
        }
        interval.entry()
    }

    fn scene_box(bounds: &[f32; K], table: &DirectionTable<K>, frame: &Frame) -> Aabb<f64> {
        frame.to_scene(&table.enclosing_box(&bounds.map(f64::from)))
    }

    fn scene_volume(bounds: &[f32; K], table: &DirectionTable<K>, frame: &Frame) -> Kdop<K> {
        let centre = Vector3::from(frame.centre);
        let height = |i: usize| {
            let normal = &table.directions.normals()[i];
            let local = f64::from(bounds[i]) * frame.unit;
            let size = local.abs() + normal.component_mul(&centre).abs().sum();
            // The sum errs by at most 5 u of this size. If the size overflows, the height is unknown.
            if size.is_finite() { local + normal.dot(&centre) + size * power_of_two(-50) } else { f64::INFINITY }
        };
        Kdop { heights: std::array::from_fn(height) }
    }

    fn may_intersect_box(bounds: &[f32; K], table: &DirectionTable<K>, frame: &Frame, other: &Aabb<f64>) -> bool {
        let to_frame = |p: &Point3<f64>| Point3::from(frame.place(&[p.x, p.y, p.z]));
        // The conversion to the frame errs by u of each coordinate, which the rounding of heights covers. It does not
        // cover faces along the axes, but there the points of the scene were rounded exactly as this box is, and
        // rounding is monotone.
        let kdop = Kdop { heights: bounds.map(f64::from) };
        kdop.may_intersect_box(&table.directions, &Aabb { min: to_frame(&other.min), max: to_frame(&other.max) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Directions;
    use p2m_testkit::cases;
    use p2m_testkit::oracle::is_product_at_most;
    use rand::{Rng, RngExt};

    fn vector(rng: &mut impl Rng) -> Vector3<f64> {
        Vector3::from_fn(|_, _| rng.random_range(-0.5..0.5))
    }

    /// Returns the frame around some points, and their heights in it.
    fn enclosed<const K: usize>(table: &DirectionTable<K>, points: &[Point3<f64>]) -> (Frame, [f32; K]) {
        let members: Vec<_> = points.iter().map(|p| Member::from_primitive(&p2m_core::Point::new(*p))).collect();
        let bounds = Aabb::from_points(points);
        let frame = Frame::around(&bounds);
        (frame, KdopNode::enclose(table, &frame, &members, &bounds))
    }

    #[test]
    fn heights_are_never_below_exact_products() {
        let table = DirectionTable::new(&Directions::<26>::default());
        let normals = table.directions.normals();
        for case in cases(400, 200) {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("heights of nodes", case));
            // The terms of the products of these points with a normal cancel. The frame is centred at the origin, so
            // the points are exact in it.
            let normal = normals[rng.random_range(6..26)];
            let x = normal.cross(&vector(&mut rng));
            let points = [x, -x, vector(&mut rng) * 1e-9].map(Point3::from);
            let (frame, heights) = enclosed(&table, &points);
            assert_eq!(frame.centre, [0.0; 3]);
            for (n, h) in normals.iter().zip(&heights) {
                for p in &points {
                    let local = Vector3::from(frame.place(&[p.x, p.y, p.z]));
                    assert!(is_product_at_most((*n).into(), local.into(), f64::from(*h)), "{n} {p} {h:e}");
                }
            }
            // Volumes are checked at many positions and scales of the scene, and against boxes at the points.
            let scale = [1.0, 1e-200, 1e200, f64::MAX][round / 5 % 4];
            let far = vector(&mut rng) * [0.0, 1e3, 1e9, 1e13, 1e16][round % 5];
            let moved = |p: &Point3<f64>| Point3::from((p.coords + far) * scale);
            let points = points.map(|p| moved(&p));
            if points.iter().any(|p| p.iter().any(|x| x.is_infinite())) {
                continue;
            }
            let (frame, heights) = enclosed(&table, &points);
            let volume = KdopNode::scene_volume(&heights, &table, &frame);
            for p in &points {
                for (n, h) in normals.iter().zip(&volume.heights) {
                    assert!(is_product_at_most((*n).into(), p.coords.into(), *h), "{n} {p} {h:e}");
                }
                for corner in 0..8 {
                    let size = (points[0] - points[1]).amax();
                    let other = p + Vector3::from_fn(|k, _| if corner >> k & 1 == 0 { -size } else { size });
                    let around = Aabb::from_points(&[*p, other]);
                    assert!(KdopNode::may_intersect_box(&heights, &table, &frame, &around), "{p} {around:?}");
                }
            }
        }
    }

    #[test]
    fn heights_that_overflow_are_infinite() {
        let table = DirectionTable::new(&Directions::<26>::default());
        let m = f64::MAX;
        for corner in [Vector3::repeat(-m), Vector3::repeat(m), Vector3::new(-0.7 * m, -0.7 * m, 0.7 * m)] {
            let points = [corner, corner * 0.9].map(Point3::from);
            let (frame, heights) = enclosed(&table, &points);
            let volume = KdopNode::scene_volume(&heights, &table, &frame);
            assert!(volume.heights.iter().all(|h| *h > f64::NEG_INFINITY), "{volume:?}");
            assert!(volume.may_intersect(&volume) && !volume.is_empty());
            for p in &points {
                assert!(volume.contains_point(&table.directions, p));
                assert!(KdopNode::may_intersect_box(&heights, &table, &frame, &Aabb { min: *p, max: *p }));
            }
        }
    }
}
