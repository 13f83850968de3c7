//! Nodes whose children are bounded by k-DOPs.
//!
//! A child is at least as far as the intersection of two half-spaces: one that holds the box of the first three
//! directions, across the way to its nearest point, and one behind a face of another direction. That is computed
//! for every other direction, and the largest is kept; docs/proofs/kdop.md derives it, with its roundings.

use crate::Kdop;
use crate::heights::Slabs;
use nalgebra::{Point3, Vector3};
use p2m_bvh::engine::node::{Frame, NodeRef, WIDTH};
use p2m_bvh::engine::packet::Member;
use p2m_bvh::engine::ray::FrameLine;
use p2m_bvh::engine::ray_slab::{Piece, SlabRay};
use p2m_bvh::engine::volume::WideNode;
use p2m_core::Aabb;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// Eight k-DOPs side by side. Unused ones are empty: their distance is infinite or NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct SlabNode<const K: usize> {
    heights: [[f32; WIDTH]; K],
    children: [NodeRef; WIDTH],
}

const _: () = assert!(size_of::<SlabNode<14>>() == 512);

/// What heights in the frame may lack, where products are rounded: coordinates are 4 at most, so the sizes of three
/// products add up to less than 7; coordinates, products and both sums err by 2^-53 of that each, in all by less than
/// 30 x 2^-53.
const SLACK: f64 = power_of_two(-48);
/// What is taken from all slacks but those of a box along the axes, in units of the size X of the query in the frame:
/// 20 u of f32. What the proof needs it for is small, and mostly hidden: products and heights are rounded outwards
/// besides, and limits have room for 2^-19. So tests do not tell when it is missing.
const QUERY_SLACK: f64 = 20.0 * power_of_two(-24);
/// What is left of an increment, for the roundings of its factor: 1 - 2^-15.
const SHRINK: f32 = 1.0 - 1.0 / 32768.0;
/// The least sine, squared, that two half-spaces are taken to meet at. If it is smaller, less is gained than there
/// could be.
const LEAST_SINE: f32 = 1.0 / 16.0;
/// Below this squares are not told apart: 2^-100.
const TINY: f32 = 1.0 / (1u128 << 100) as f32;

impl<const K: usize> WideNode for SlabNode<K> {
    type Volume = Kdop<K>;
    type Shape = Slabs<K>;
    type Bounds = [f32; K];
    /// The products of the query with the normals, rounded down and less by [`QUERY_SLACK`].
    type Query = [f32; K];
    /// One slab for each pair of opposite directions; the second half is not used.
    type Ray = [SlabRay; K];

    const NOTHING: [f32; K] = [f32::NEG_INFINITY; K];

    fn new(children: [NodeRef; WIDTH]) -> Self {
        Self { heights: [[f32::NEG_INFINITY; WIDTH]; K], children }
    }

    #[inline(always)]
    fn children(&self) -> &[NodeRef; WIDTH] {
        &self.children
    }

    const ROWS: usize = K;

    fn rows(&self) -> impl Iterator<Item = [f32; WIDTH]> {
        self.heights.into_iter()
    }

    fn of_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self {
        Self { heights: std::array::from_fn(|i| rows[i]), children }
    }

    fn put(&mut self, place: usize, bounds: &[f32; K]) {
        self.heights.iter_mut().zip(bounds).for_each(|(row, x)| row[place] = *x);
    }

    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    fn enclose(shape: &Slabs<K>, frame: &Frame, primitives: &[Member], _: &Aabb<f64>) -> [f32; K] {
        let normals = shape.directions.normals();
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
                // The corners of its box.
                let [min, max] = [to_f64_array(&primitive.bounds.min), to_f64_array(&primitive.bounds.max)];
                (0..8).for_each(|i| add([0, 1, 2].map(|k: usize| if i >> k & 1 == 0 { min[k] } else { max[k] })));
            }
        }
        let up = |i: usize| ((heights[i] + if shape.rounds[i] { SLACK } else { 0.0 }) as f32).next_up();
        std::array::from_fn(up)
    }

    fn join(a: &[f32; K], b: &[f32; K]) -> [f32; K] {
        std::array::from_fn(|i| a[i].max(b[i]))
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn query(shape: &Slabs<K>, frame: &Frame, query: &[f64; 3]) -> Option<[f32; K]> {
        let q = frame.local(query)?;
        let size = q[0].abs().max(q[1].abs()).max(q[2].abs()) + 2.0;
        let normals = shape.directions.normals();
        let mut result = [0.0; K];
        for j in 0..K / 2 {
            let n = &normals[2 * j];
            let product = n.x * q[0] + n.y * q[1] + n.z * q[2];
            let slack = if shape.is_exact_side(j) { 0.0 } else { QUERY_SLACK * size };
            result[2 * j] = ((product - slack) as f32).next_down();
            result[2 * j + 1] = ((-product - slack) as f32).next_down();
        }
        Some(result)
    }

    #[inline(always)]
    fn lower_bounds<L: Lanes>(&self, shape: &Slabs<K>, query: &[f32; K]) -> L {
        let zero = L::splat(0.0);
        // A vector that every point of the child is at least its own length away along; its square.
        let (first, gap, square) = if shape.orthogonal {
            let gap: [L; 3] = [self.gap(query, 0), self.gap(query, 1), self.gap(query, 2)];
            (3, gap, gap[2].mul_add(gap[2], gap[1].mul_add(gap[1], gap[0].mul(gap[0]))))
        } else {
            self.widest_gap(shape, query)
        };
        let scaled = square.mul(L::splat(SHRINK));
        let least = square.mul(L::splat(LEAST_SINE)).max(L::splat(TINY));
        let mut best = square;
        let mut j = first;
        while j < K / 2 {
            let above = self.slack::<L>(query, 2 * j);
            let below = self.slack::<L>(query, 2 * j + 1);
            let [x, y, z] = shape.cosines[2 * j];
            let along = gap[2].mul_add(L::splat(z), gap[1].mul_add(L::splat(y), gap[0].mul(L::splat(x))));
            let against = zero.sub(along);
            // The slack of the face that the query is outside of, and the part of the gap in its direction.
            let slack = above.max(below);
            let part = below.if_below(above, along, against);
            let rest = along.mul_add(against, square).max(least);
            let more = slack.sub(part).max(zero);
            // The bound is derived for faces that the query is outside of.
            let more = zero.if_below(slack, more, zero);
            let both = more.mul(more).mul_add(scaled.mul(rest.reciprocal()), square);
            let slack = slack.max(zero);
            // Where the nearest point of the face's half-space is in the other one, its distance.
            let bound = slack.mul(part).if_below(square, both, slack.mul(slack));
            best = bound.max(best);
            j += 1;
        }
        best
    }

    fn ray(shape: &Slabs<K>, line: &FrameLine) -> [SlabRay; K] {
        let [base, direction] = [line.base, line.direction].map(Vector3::from);
        let normals = shape.directions.normals();
        std::array::from_fn(|j| {
            let n = &normals[2 * (j % (K / 2))];
            SlabRay::new(n.dot(&base), n.dot(&direction), line.margin * 2.0)
        })
    }

    #[inline(always)]
    fn entries<L: Lanes>(&self, ray: &[SlabRay; K]) -> L {
        let mut piece = Piece::new();
        for (slab, heights) in ray.iter().zip(self.heights.chunks_exact(2)) {
            piece.clip(slab, L::splat(0.0).sub(L::load(&heights[1])), L::load(&heights[0]));
        }
        piece.entry()
    }

    fn at(&self, place: usize) -> [f32; K] {
        self.heights.map(|row| row[place])
    }

    fn disclose(bounds: &[f32; K], shape: &Slabs<K>, frame: &Frame) -> Aabb<f64> {
        frame.disclose(&shape.enclosing_box(&bounds.map(f64::from)))
    }

    fn volume(bounds: &[f32; K], shape: &Slabs<K>, frame: &Frame) -> Kdop<K> {
        let centre = Vector3::from(frame.centre);
        let height = |i: usize| {
            let normal = &shape.directions.normals()[i];
            let own = f64::from(bounds[i]) * frame.unit;
            let size = own.abs() + normal.component_mul(&centre).abs().sum();
            // The sum errs by 5 u of this size. Where it overflows the height cannot be told.
            if size.is_finite() { own + normal.dot(&centre) + size * power_of_two(-50) } else { f64::INFINITY }
        };
        Kdop { heights: std::array::from_fn(height) }
    }

    fn may_meet(bounds: &[f32; K], shape: &Slabs<K>, frame: &Frame, other: &Aabb<f64>) -> bool {
        let place = |p: &Point3<f64>| Point3::from(frame.place(&[p.x, p.y, p.z]));
        // Going into the frame errs by u of each coordinate, which heights of boxes have room for, but for faces along
        // the axes: there points of the scene have been rounded as this box is, and rounding keeps their order.
        let own = Kdop { heights: bounds.map(f64::from) };
        own.may_meet_box(&shape.directions, &Aabb { min: place(&other.min), max: place(&other.max) })
    }
}

impl<const K: usize> SlabNode<K> {
    /// How far the query is outside of face i, if positive.
    #[inline(always)]
    fn slack<L: Lanes>(&self, query: &[f32; K], i: usize) -> L {
        L::splat(query[i]).sub(L::load(&self.heights[i]))
    }

    /// How far it is outside of slab j, with its sign.
    #[inline(always)]
    fn gap<L: Lanes>(&self, query: &[f32; K], j: usize) -> L {
        let zero = L::splat(0.0);
        let above = self.slack::<L>(query, 2 * j).max(zero);
        let below = self.slack::<L>(query, 2 * j + 1).max(zero);
        above.sub(below)
    }

    /// The way to the slab that the query is farthest outside of, where no three directions are orthogonal.
    #[inline(always)]
    fn widest_gap<L: Lanes>(&self, shape: &Slabs<K>, query: &[f32; K]) -> (usize, [L; 3], L) {
        let zero = L::splat(0.0);
        let mut gap = [zero; 3];
        let mut widest = zero;
        let mut i = 0;
        while i < K {
            let slack = self.slack::<L>(query, i);
            let [x, y, z] = shape.cosines[i];
            gap = [
                widest.if_below(slack, slack.mul(L::splat(x)), gap[0]),
                widest.if_below(slack, slack.mul(L::splat(y)), gap[1]),
                widest.if_below(slack, slack.mul(L::splat(z)), gap[2]),
            ];
            widest = slack.max(widest);
            i += 1;
        }
        (0, gap, widest.mul(widest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Directions;
    use nalgebra::Matrix3;
    use p2m_core::Triangle;
    use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};
    use p2m_testkit::oracle::is_product_at_most;
    use p2m_testkit::{Cases, cases};
    use rand::{Rng, RngExt};

    struct Bounds<'a, const K: usize>(&'a SlabNode<K>, &'a Slabs<K>, &'a [f32; K]);

    impl<const K: usize> SimdKernel for Bounds<'_, K> {
        type Output = [f32; WIDTH];
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> [f32; WIDTH] {
            let mut bounds = [0.0; WIDTH];
            self.0.lower_bounds::<I::Eight>(self.1, self.2).store(&mut bounds);
            bounds
        }
    }

    fn vector(rng: &mut impl Rng) -> Vector3<f64> {
        Vector3::from_fn(|_, _| rng.random_range(-0.5..0.5))
    }

    /// The distance to a k-DOP by going through all vertices, edges and faces: the nearest point is the foot of the
    /// query on one of them.
    fn distance<const K: usize>(kdop: &Kdop<K>, normals: &[Vector3<f64>; K], q: &Vector3<f64>) -> f64 {
        let slack: Vec<f64> = (0..K).map(|i| normals[i].dot(q) - kdop.heights[i]).collect();
        if slack.iter().all(|s| *s <= 0.0) {
            return 0.0;
        }
        let size = q.norm() + 4.0;
        let inside = |x: &Vector3<f64>| (0..K).all(|i| normals[i].dot(x) <= kdop.heights[i] + 1e-12 * size);
        let mut nearest = f64::INFINITY;
        let mut offer = |step: Vector3<f64>| {
            if step.norm() < nearest && inside(&(q - step)) {
                nearest = step.norm();
            }
        };
        for a in 0..K {
            offer(normals[a] * slack[a]);
            for b in a + 1..K {
                let c = normals[a].dot(&normals[b]);
                if c.abs() < 1.0 - 1e-9 {
                    let [x, y] = [slack[a] - c * slack[b], slack[b] - c * slack[a]].map(|x| x / (1.0 - c * c));
                    offer(normals[a] * x + normals[b] * y);
                }
                for c in b + 1..K {
                    let rows = Matrix3::from_rows(&[a, b, c].map(|i| normals[i].transpose()));
                    if rows.determinant().abs() > 1e-6
                        && let Some(inverse) = rows.try_inverse()
                    {
                        offer(inverse * Vector3::new(slack[a], slack[b], slack[c]));
                    }
                }
            }
        }
        nearest
    }

    /// Bounds of random k-DOPs (of triangles of all sizes and shapes) for random queries (near and far, and across
    /// their faces and edges) against distances, on every instruction set: how many were compared, how often the
    /// bound was within 1 % of the distance, and how often that of the box was.
    fn compare<const K: usize>(directions: &Directions<K>, nodes: &Cases, name: &str) -> [usize; 3] {
        let slabs = Slabs::new(directions);
        let normals = directions.normals();
        let scene = Aabb { min: Point3::new(-0.9, -0.9, -0.9), max: Point3::new(0.9, 0.9, 0.9) };
        let frame = Frame::around(&scene);
        let mut counts = [0; 3];
        for case in nodes.clone() {
            let mut rng = p2m_testkit::rng(name, case);
            let mut node = SlabNode::<K>::new([NodeRef::packet(0); WIDTH]);
            let mut exact = [Kdop::<K>::empty(); WIDTH];
            let mut boxes = [Aabb::empty(); WIDTH];
            for place in 0..WIDTH - 1 {
                let centre = vector(&mut rng);
                let size = 2f64.powi(-rng.random_range(0..24));
                let mut flat = vector(&mut rng).normalize();
                if rng.random() {
                    flat = normals[rng.random_range(0..K)];
                }
                let corners = [(); 3].map(|()| {
                    let v = vector(&mut rng);
                    Point3::from(centre + (v - flat * (v.dot(&flat) * [0.0, 0.9, 1.0][rng.random_range(0..3)])) * size)
                });
                boxes[place] = Aabb::of_points(&corners);
                let own = Member::of(&Triangle { vertices: corners });
                node.put(place, &SlabNode::enclose(&slabs, &frame, &[own], &boxes[place]));
                exact[place] = Kdop::of_points(directions, &corners);
            }
            for _ in 0..8 {
                let place = rng.random_range(0..WIDTH - 1);
                let near = exact[place];
                let towards = normals[rng.random_range(0..K)];
                let offset = 2f64.powi(rng.random_range(-28..8));
                let at = nalgebra::center(&boxes[place].min, &boxes[place].max).coords;
                let q = match rng.random_range(0..4) {
                    0 => at + towards * offset + vector(&mut rng) * (offset * 0.1),
                    1 => at + (towards + normals[rng.random_range(0..K)]) * offset,
                    2 => at + vector(&mut rng) * offset,
                    _ => at + vector(&mut rng) * (near.heights[0] + near.heights[1]),
                };
                let query = SlabNode::query(&slabs, &frame, &q.into()).expect("near enough");
                let distances: [f64; WIDTH - 1] =
                    std::array::from_fn(|place| distance(&exact[place], normals, &q) * frame.per_unit);
                for isa in Isa::available() {
                    let bounds = isa.run(Bounds(&node, &slabs, &query));
                    assert!(bounds[WIDTH - 1] > f32::MAX || bounds[WIDTH - 1].is_nan(), "an empty place");
                    for (place, distance) in distances.into_iter().enumerate() {
                        let bound = f64::from(bounds[place]);
                        let limit = distance * distance * (1.0 + 2f64.powi(-20)) + 2f64.powi(-120);
                        assert!(
                            bound <= limit,
                            "{name}, case {case}, {isa}: {bound:e} for {:e}, {q:?}",
                            distance * distance
                        );
                        counts[0] += 1;
                        counts[1] += usize::from(bound.sqrt() >= 0.99 * distance);
                        let box_bound = boxes[place].lower_bound(&q.into()).sqrt() * frame.per_unit;
                        counts[2] += usize::from(box_bound >= 0.99 * distance);
                    }
                }
            }
        }
        counts
    }

    #[test]
    fn bounds_never_exceed_the_distance_and_are_mostly_close_to_it() {
        let turned = [[2.0, 1.0, 2.0], [1.0, 2.0, -2.0], [-2.0, 2.0, 1.0], [1.0, 0.3, 0.2]].map(Vector3::from);
        let skew = [[2.0, 1.0, 2.0], [1.0, 0.1, -0.4], [0.0, 1.0, 0.3], [1.0, 0.12, -0.4]].map(Vector3::from);
        let turned = Directions::<8>::new(&turned).expect("four");
        let skew = Directions::<8>::new(&skew).expect("four");
        assert!(turned.starts_orthogonal() && !skew.starts_orthogonal());
        let (most, some, few) = (cases(6_000, 150), cases(4_000, 80), cases(600, 60));
        let all = [
            ("6", compare(&Directions::<6>::default(), &most, "slabs of 6")),
            ("14", compare(&Directions::<14>::default(), &most, "slabs of 14")),
            ("18", compare(&Directions::<18>::default(), &some, "slabs of 18")),
            ("26", compare(&Directions::<26>::default(), &few, "slabs of 26")),
            ("turned", compare(&turned, &most, "turned slabs")),
            ("skew", compare(&skew, &some, "skew slabs")),
        ];
        for (name, [compared, close, box_close]) in all {
            println!("{name}: {compared} bounds, {close} within 1 % of the distance, {box_close} of boxes");
        }
        // Seven bounds, of eight queries, on each instruction set.
        let nodes = 3 * most.len() + 2 * some.len() + few.len();
        assert_eq!(all.iter().map(|(_, counts)| counts[0]).sum::<usize>(), nodes * 7 * 8 * Isa::available().len());
        for (name, [compared, close, box_close]) in &all[1..5] {
            assert!(most.is_replay() || close * 10 > compared * 8 && close > box_close, "{name}");
        }
    }

    /// Heights of a set in the frame around it, and the frame.
    fn enclosed<const K: usize>(slabs: &Slabs<K>, points: &[Point3<f64>]) -> (Frame, [f32; K]) {
        let own: Vec<_> = points.iter().map(|p| Member::of(&p2m_core::Point::new(*p))).collect();
        let bounds = Aabb::of_points(points);
        let frame = Frame::around(&bounds);
        (frame, SlabNode::enclose(slabs, &frame, &own, &bounds))
    }

    #[test]
    fn heights_are_never_below_exact_products() {
        let slabs = Slabs::new(&Directions::<26>::default());
        let normals = slabs.directions.normals();
        for case in cases(400, 200) {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("heights of nodes", case));
            // Points whose products with a normal cancel. The frame is that of the scene, so points are exact in it.
            let normal = normals[rng.random_range(6..26)];
            let x = normal.cross(&vector(&mut rng));
            let points = [x, -x, vector(&mut rng) * 1e-9].map(Point3::from);
            let (frame, heights) = enclosed(&slabs, &points);
            assert_eq!(frame.centre, [0.0; 3]);
            for (n, h) in normals.iter().zip(&heights) {
                for p in &points {
                    let local = Vector3::from(frame.place(&[p.x, p.y, p.z]));
                    assert!(is_product_at_most((*n).into(), local.into(), f64::from(*h)), "{n} {p} {h:e}");
                }
            }
            // As volumes, wherever the scene lies and however large it is, and against boxes at their corners.
            let scale = [1.0, 1e-200, 1e200, f64::MAX][round / 5 % 4];
            let far = vector(&mut rng) * [0.0, 1e3, 1e9, 1e13, 1e16][round % 5];
            let place = |p: &Point3<f64>| Point3::from((p.coords + far) * scale);
            let points = points.map(|p| place(&p));
            if points.iter().any(|p| p.iter().any(|x| x.is_infinite())) {
                continue;
            }
            let (frame, heights) = enclosed(&slabs, &points);
            let volume = SlabNode::volume(&heights, &slabs, &frame);
            for p in &points {
                for (n, h) in normals.iter().zip(&volume.heights) {
                    assert!(is_product_at_most((*n).into(), p.coords.into(), *h), "{n} {p} {h:e}");
                }
                for corner in 0..8 {
                    let size = (points[0] - points[1]).amax();
                    let other = p + Vector3::from_fn(|k, _| if corner >> k & 1 == 0 { -size } else { size });
                    let around = Aabb::of_points(&[*p, other]);
                    assert!(SlabNode::may_meet(&heights, &slabs, &frame, &around), "{p} {around:?}");
                }
            }
        }
    }

    #[test]
    fn heights_that_overflow_are_infinite() {
        let slabs = Slabs::new(&Directions::<26>::default());
        let m = f64::MAX;
        for corner in [Vector3::repeat(-m), Vector3::repeat(m), Vector3::new(-0.7 * m, -0.7 * m, 0.7 * m)] {
            let points = [corner, corner * 0.9].map(Point3::from);
            let (frame, heights) = enclosed(&slabs, &points);
            let volume = SlabNode::volume(&heights, &slabs, &frame);
            assert!(volume.heights.iter().all(|h| *h > f64::NEG_INFINITY), "{volume:?}");
            assert!(volume.may_meet(&volume) && !volume.is_empty());
            for p in &points {
                assert!(volume.contains_point(&slabs.directions, p));
                assert!(SlabNode::may_meet(&heights, &slabs, &frame, &Aabb { min: *p, max: *p }));
            }
        }
    }

    #[test]
    fn the_six_dop_of_the_axes_bounds_as_boxes_do() {
        let cases = cases(500, 100);
        let [compared, close, box_close] = compare(&Directions::<6>::default(), &cases, "slabs of the axes");
        assert!(compared > 0 && box_close == compared, "{box_close} of {compared}");
        assert!(cases.is_replay() || close * 100 >= compared * 98, "{close} of {compared}");
    }
}
