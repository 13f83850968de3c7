//! Tests of the children that a ray enters, for nodes of boxes and of k-DOPs.

use crate::Directions;
use crate::direction_table::DirectionTable;
use crate::node::KdopNode;
use nalgebra::{Point3, Vector3};
use p2m_bvh::engine::node::{BoxNode, Frame, NodeRef, WIDTH};
use p2m_bvh::engine::packet::Member;
use p2m_bvh::engine::ray::{FrameLine, half_extent, misses_scene};
use p2m_bvh::engine::volume::WideNode;
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::{Crossing, Isa, PrimitiveSet, Ray, Triangle};
use p2m_testkit::{Cases, cases, vector};
use rand::RngExt;

struct Entries<'a, N: WideNode>(&'a N, &'a N::Ray);

impl<N: WideNode> SimdKernel for Entries<'_, N> {
    type Output = [f32; WIDTH];
    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [f32; WIDTH] {
        let mut entries = [0.0; WIDTH];
        self.0.entries::<I::F32x8>(self.1).store(&mut entries);
        entries
    }
}

/// Casts rays at points of random triangles and checks that the ray enters the slots of all triangles that it hits.
/// Returns the number of hits, and the number of other slots that were entered.
fn compare<N: WideNode>(shared: &N::Shared, name: &str, cases: &Cases) -> [usize; 2] {
    let mut counts = [0; 2];
    for case in cases.clone() {
        let mut rng = p2m_testkit::rng(name, case);
        let origin = vector(&mut rng) * 2f64.powi(rng.random_range(-20..20));
        let scale = origin.norm() * 2f64.powi(-rng.random_range(0..20));
        let at = |v: Vector3<f64>| Point3::from(origin + v * scale);
        let triangles: Vec<_> = (0..WIDTH - 1)
            .map(|_| {
                let (centre, size) = (vector(&mut rng), 2f64.powi(-rng.random_range(0..20)));
                let [a, b, c] = [(); 3].map(|()| at(centre + vector(&mut rng) * size));
                Triangle::new(a, b, c)
            })
            .collect();
        let bounds = triangles[..].aabb();
        let frame = Frame::around(&bounds);
        let mut node = N::new([NodeRef::packet(0); WIDTH]);
        for (slot, triangle) in triangles.iter().enumerate() {
            let member = Member::from_primitive(triangle);
            node.set_bounds(slot, &N::enclose(shared, &frame, &[member], &member.bounds));
        }
        for _ in 0..8 {
            let vertices = triangles[rng.random_range(0..WIDTH - 1)].vertices;
            let weights = [(); 3].map(|()| rng.random_range(0.01..1.0));
            let sum: f64 = weights.iter().sum();
            let target = vertices.iter().zip(weights).map(|(v, w)| v.coords * (w / sum)).sum::<Vector3<f64>>();
            let mut direction = vector(&mut rng);
            match rng.random_range(0..4) {
                0 => direction[rng.random_range(0..3)] = 0.0,
                1 => direction[rng.random_range(0..3)] *= 2f64.powi(-rng.random_range(20..60)),
                _ => {}
            }
            let distance = scale * 2f64.powi(rng.random_range(-20..48));
            let ray = Ray::new(&Point3::from(target - direction * distance), &direction).expect("valid");
            let ray = if rng.random() { ray.line() } else { ray };
            let parameter = |triangle: &Triangle<f64>| {
                Crossing::from_primitive(triangle, &ray, f64::INFINITY, false).map(|crossing| crossing.parameter())
            };
            let hits: Vec<Option<f64>> = triangles.iter().map(parameter).collect();
            let line = FrameLine::line_of(&frame, &ray, 0.0);
            let half = half_extent(&frame, &bounds);
            let piece = FrameLine::new(&frame, &half, &line, line.length_below(ray.min)).expect("plain");
            if misses_scene(&ray, 0.0, &frame, &half) || piece.is_none() {
                assert!(hits.iter().all(Option::is_none), "{name} {case}: {ray:?}");
                continue;
            }
            let piece = piece.expect("checked");
            let local = N::ray(shared, &piece);
            for isa in Isa::available() {
                let entries = isa.run(Entries(&node, &local));
                assert!(entries[WIDTH - 1] > f32::MAX, "an empty slot");
                for (hit, entry) in hits.iter().zip(entries) {
                    match hit {
                        Some(t) => {
                            let limit = piece.limit(line.length_above(*t));
                            assert!(entry >= 0.0 && entry <= limit, "{isa} {name} {case}: {entry:e} {limit:e}");
                            counts[0] += 1;
                        }
                        None => counts[1] += usize::from(entry <= f32::MAX),
                    }
                }
            }
        }
    }
    counts
}

#[test]
fn children_with_a_hit_are_entered() {
    let (name, cases) = ("rays and nodes", cases(2_000, 500));
    let box_counts = compare::<BoxNode>(&(), name, &cases);
    let six_counts = compare::<KdopNode<6>>(&DirectionTable::new(&Directions::default()), name, &cases);
    let more_counts = compare::<KdopNode<26>>(&DirectionTable::new(&Directions::default()), name, &cases);
    println!("hits, and other slots entered: boxes {box_counts:?}, 6-DOPs {six_counts:?}, 26-DOPs {more_counts:?}");
    assert!(
        cases.have_more_than(20_000, box_counts[0])
            && box_counts[0] == six_counts[0]
            && six_counts[0] == more_counts[0]
    );
    if cases.is_replay() {
        return;
    }
    assert!(more_counts[1] * 3 < box_counts[1] * 2 && box_counts[1] < box_counts[0], "{box_counts:?} {more_counts:?}");
    assert!(six_counts[1].abs_diff(box_counts[1]) * 100 < box_counts[1], "{box_counts:?} {six_counts:?}");
}
