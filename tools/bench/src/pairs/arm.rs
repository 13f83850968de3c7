//! A robot arm of six capsules that moves beside a scene.

use super::poses::direction;
use super::{Indexes, distance};
use crate::contest::{Competitor, Kind};
use nalgebra::{Point3, Vector3};
use p2m_core::pair::{PairOptions, PairQuery};
use p2m_core::{PrimitiveSet, Segment, Soup};
use p2m_testkit::{rng, vector};

/// The number of capsules of an arm.
const LINKS: usize = 6;

/// The axes of the capsules of an arm, and their radius.
#[derive(Clone, Copy)]
pub(super) struct Arm {
    axes: [[Point3<f64>; 2]; LINKS],
    radius: f64,
}

/// Returns an arm at consecutive poses. It stands beside the scene, and each joint turns a little between poses.
pub(super) fn walk(soup: &Soup<f64>, count: usize, seed: u64) -> Vec<Arm> {
    let mut rng = rng("arm", seed);
    let bounds = soup.aabb();
    let size = bounds.max - bounds.min;
    let diagonal = size.norm();
    let centre = nalgebra::center(&bounds.min, &bounds.max);
    let base = centre + Vector3::new(0.6 * diagonal, 0.0, 0.0);
    let mut directions: [Vector3<f64>; LINKS] = std::array::from_fn(|_| direction(&mut rng));
    (0..count)
        .map(|_| {
            for direction in &mut directions {
                *direction = (*direction + vector(&mut rng) * 0.03).normalize();
            }
            let mut from = base;
            let axes = directions.map(|direction| {
                let axis = [from, from + direction * (0.15 * diagonal)];
                from = axis[1];
                axis
            });
            Arm { axes, radius: 0.01 * diagonal }
        })
        .collect()
}

/// Returns the competitors. Each computes the smallest distance of any capsule of an arm.
pub(super) fn competitors<'a>(indexes: &'a Indexes<'_>) -> Vec<Competitor<'a, Arm, f64>> {
    let (tree, single, double) = (&indexes.trees[0], &indexes.single[0], &indexes.double[0]);
    let nearest = |[a, b]: &[Point3<f64>; 2], options: PairOptions<f64>, arm: &Arm| {
        tree.closest_to(&Segment::new(*a, *b), &options.with_radius(arm.radius))
    };
    let least = |distances: [f64; LINKS]| distances.into_iter().fold(f64::INFINITY, f64::min);
    let mut last = [None; LINKS];
    vec![
        Competitor::new("AABB tree", Kind::Exact, move |arm: &Arm| {
            least(arm.axes.map(|axis| distance(nearest(&axis, PairOptions::default(), arm))))
        }),
        Competitor::new("AABB tree, begun with the last pairs", Kind::Exact, move |arm: &Arm| {
            least(std::array::from_fn(|i| {
                let mut options = PairOptions::default();
                options.hint = last[i];
                let pair = nearest(&arm.axes[i], options, arm);
                last[i] = pair.map(|pair| pair.primitives);
                distance(pair)
            }))
        }),
        Competitor::new("AABB tree, each capsule within the last", Kind::Exact, move |arm: &Arm| {
            arm.axes.iter().fold(f64::INFINITY, |least, axis| {
                distance(nearest(axis, PairOptions::default().with_max_distance(least), arm)).min(least)
            })
        }),
        Competitor::new("parry3d-f64", Kind::External, move |arm: &Arm| {
            least(arm.axes.map(|axis| double.distance_to_capsule(&axis, arm.radius)))
        }),
        Competitor::new("parry3d", Kind::External, move |arm: &Arm| {
            least(arm.axes.map(|axis| single.distance_to_capsule(&axis, arm.radius)))
        }),
    ]
}
