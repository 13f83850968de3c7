//! Tests that compare the lower bounds of nodes of k-DOPs with distances.

use crate::direction_table::DirectionTable;
use crate::node::KdopNode;
use crate::{Directions, Kdop};
use nalgebra::{Matrix3, Point3, Vector3};
use p2m_bvh::engine::node::{Frame, NodeRef, WIDTH};
use p2m_bvh::engine::packet::Member;
use p2m_bvh::engine::volume::WideNode;
use p2m_core::engine::simd::{InstructionSet, Isa, Lanes, SimdKernel};
use p2m_core::{Aabb, Triangle};
use p2m_testkit::{Cases, cases};
use rand::{Rng, RngExt};

struct LowerBounds<'a, const K: usize>(&'a KdopNode<K>, &'a DirectionTable<K>, &'a [f32; K]);

impl<const K: usize> SimdKernel for LowerBounds<'_, K> {
    type Output = [f32; WIDTH];
    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [f32; WIDTH] {
        let mut bounds = [0.0; WIDTH];
        self.0.lower_bounds::<I::F32x8>(self.1, self.2).store(&mut bounds);
        bounds
    }
}

fn vector(rng: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-0.5..0.5))
}

/// Computes the distance to a k-DOP by projecting the query point onto all vertices, edges and faces: the nearest point
/// is one of these projections.
fn distance<const K: usize>(kdop: &Kdop<K>, normals: &[Vector3<f64>; K], q: &Vector3<f64>) -> f64 {
    let excess: Vec<f64> = (0..K).map(|i| normals[i].dot(q) - kdop.heights[i]).collect();
    if excess.iter().all(|s| *s <= 0.0) {
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
        offer(normals[a] * excess[a]);
        for b in a + 1..K {
            let c = normals[a].dot(&normals[b]);
            if c.abs() < 1.0 - 1e-9 {
                let [x, y] = [excess[a] - c * excess[b], excess[b] - c * excess[a]].map(|x| x / (1.0 - c * c));
                offer(normals[a] * x + normals[b] * y);
            }
            for c in b + 1..K {
                let rows = Matrix3::from_rows(&[a, b, c].map(|i| normals[i].transpose()));
                if rows.determinant().abs() > 1e-6
                    && let Some(inverse) = rows.try_inverse()
                {
                    offer(inverse * Vector3::new(excess[a], excess[b], excess[c]));
                }
            }
        }
    }
    nearest
}

/// Compares bounds of random k-DOPs with distances on every instruction set. The k-DOPs bound triangles of many sizes
/// and shapes, and the query points are near and far, and across faces and edges.
///
/// Returns the number of comparisons, the number of bounds of the k-DOP within 1 % of the distance, and the number of
/// bounds of the box within 1 % of it.
fn compare<const K: usize>(directions: &Directions<K>, nodes: &Cases, name: &str) -> [usize; 3] {
    let table = DirectionTable::new(directions);
    let normals = directions.normals();
    let scene = Aabb { min: Point3::new(-0.9, -0.9, -0.9), max: Point3::new(0.9, 0.9, 0.9) };
    let frame = Frame::around(&scene);
    let mut counts = [0; 3];
    for case in nodes.clone() {
        let mut rng = p2m_testkit::rng(name, case);
        let mut node = KdopNode::<K>::new([NodeRef::packet(0); WIDTH]);
        let mut exact = [Kdop::<K>::empty(); WIDTH];
        let mut boxes = [Aabb::empty(); WIDTH];
        for slot in 0..WIDTH - 1 {
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
            boxes[slot] = Aabb::from_points(&corners);
            let member = Member::from_primitive(&Triangle { vertices: corners });
            node.set_bounds(slot, &KdopNode::enclose(&table, &frame, &[member], &boxes[slot]));
            exact[slot] = Kdop::from_points(directions, &corners);
        }
        for _ in 0..8 {
            let slot = rng.random_range(0..WIDTH - 1);
            let near = exact[slot];
            let towards = normals[rng.random_range(0..K)];
            let offset = 2f64.powi(rng.random_range(-28..8));
            let centre = nalgebra::center(&boxes[slot].min, &boxes[slot].max).coords;
            let q = match rng.random_range(0..4) {
                0 => centre + towards * offset + vector(&mut rng) * (offset * 0.1),
                1 => centre + (towards + normals[rng.random_range(0..K)]) * offset,
                2 => centre + vector(&mut rng) * offset,
                _ => centre + vector(&mut rng) * (near.heights[0] + near.heights[1]),
            };
            let query = KdopNode::query(&table, &frame, &q.into()).expect("near enough");
            let distances: [f64; WIDTH - 1] =
                std::array::from_fn(|slot| distance(&exact[slot], normals, &q) * frame.per_unit);
            for isa in Isa::available() {
                let bounds = isa.run(LowerBounds(&node, &table, &query));
                assert!(bounds[WIDTH - 1] > f32::MAX || bounds[WIDTH - 1].is_nan(), "an empty slot");
                for (slot, distance) in distances.into_iter().enumerate() {
                    let bound = f64::from(bounds[slot]);
                    let limit = distance * distance * (1.0 + 2f64.powi(-20)) + 2f64.powi(-120);
                    assert!(
                        bound <= limit,
                        "{name}, case {case}, {isa}: {bound:e} for {:e}, {q:?}",
                        distance * distance
                    );
                    counts[0] += 1;
                    counts[1] += usize::from(bound.sqrt() >= 0.99 * distance);
                    let box_bound = boxes[slot].lower_bound(&q.into()).sqrt() * frame.per_unit;
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
    let (many, several, few) = (cases(6_000, 150), cases(4_000, 80), cases(600, 60));
    let all = [
        ("6", compare(&Directions::<6>::default(), &many, "slabs of 6")),
        ("14", compare(&Directions::<14>::default(), &many, "slabs of 14")),
        ("18", compare(&Directions::<18>::default(), &several, "slabs of 18")),
        ("26", compare(&Directions::<26>::default(), &few, "slabs of 26")),
        ("turned", compare(&turned, &many, "turned slabs")),
        ("skew", compare(&skew, &several, "skew slabs")),
    ];
    for (name, [compared, close, box_close]) in all {
        println!("{name}: {compared} bounds, {close} within 1 % of the distance, {box_close} of boxes");
    }
    // Each node has seven bounds, which are computed for eight query points on each instruction set.
    let nodes = 3 * many.len() + 2 * several.len() + few.len();
    assert_eq!(all.iter().map(|(_, counts)| counts[0]).sum::<usize>(), nodes * 7 * 8 * Isa::available().len());
    for (name, [compared, close, box_close]) in &all[1..5] {
        assert!(many.is_replay() || close * 10 > compared * 8 && close > box_close, "{name}");
    }
}

#[test]
fn the_six_dop_of_the_axes_bounds_as_boxes_do() {
    let cases = cases(500, 100);
    let [compared, close, box_close] = compare(&Directions::<6>::default(), &cases, "slabs of the axes");
    assert!(compared > 0 && box_close == compared, "{box_close} of {compared}");
    assert!(cases.is_replay() || close * 100 >= compared * 98, "{close} of {compared}");
}
