//! Poses of the second scene, relative to the first.

use anyhow::Result;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::pair::{PairOptions, PairQuery};
use p2m_core::{PrimitiveSet, Soup};
use p2m_testkit::{rng, vector};
use rand::Rng;

/// The trees of two scenes.
pub(super) type Trees<'a> = [AabbTree<f64, &'a Soup<f64>>; 2];

/// A set of poses.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Set {
    /// Random rotations, with the centres two diagonals apart.
    Far,
    /// Random rotations, moved towards the first scene until the gap is about 1 % of the diagonal.
    Near,
    /// Random rotations, with the centres less than half a diagonal apart, so that most poses intersect.
    Deep,
    /// A path around the first scene, in steps of about a degree.
    Path,
}

impl Set {
    pub(super) const ALL: [Self; 4] = [Self::Far, Self::Near, Self::Deep, Self::Path];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Far => "far",
            Self::Near => "near",
            Self::Deep => "deep",
            Self::Path => "path",
        }
    }

    /// Returns the poses of the set.
    pub(super) fn poses(self, trees: &Trees<'_>, diagonal: f64, count: usize, seed: u64) -> Vec<Isometry3<f64>> {
        let mut rng = rng(self.name(), seed);
        let centres = [&trees[0], &trees[1]].map(|tree| centre(tree.set()));
        let placed = |turn: UnitQuaternion<f64>, offset: Vector3<f64>| {
            Isometry3::from_parts(Translation3::from(centres[0].coords + offset - turn * centres[1].coords), turn)
        };
        (0..count)
            .map(|i| {
                let (turn, direction) = (turn(&mut rng), direction(&mut rng));
                match self {
                    Self::Far => placed(turn, direction * (2.0 * diagonal)),
                    Self::Deep => placed(turn, direction * (0.3 * diagonal)),
                    Self::Near => {
                        let mut reach = 2.0 * diagonal;
                        for _ in 0..60 {
                            let options = PairOptions::default().with_motion(placed(turn, direction * reach));
                            let gap = trees[0].closest_pair(&trees[1], &options).map_or(0.0, |pair| pair.distance);
                            reach -= (gap - 0.01 * diagonal).max(0.0);
                            if gap < 0.011 * diagonal {
                                break;
                            }
                        }
                        placed(turn, direction * reach)
                    }
                    Self::Path => {
                        let angle = i as f64 * 0.017;
                        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, 0.5, 0.8) * angle);
                        let direction =
                            Vector3::new((0.7 * angle).cos(), 0.5 * (0.3 * angle).sin(), (0.7 * angle).sin());
                        placed(turn, direction.normalize() * (0.9 * diagonal))
                    }
                }
            })
            .collect()
    }
}

/// Returns a random direction.
pub(super) fn direction(rng: &mut impl Rng) -> Vector3<f64> {
    loop {
        let v = vector(rng);
        if (1e-3..=1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

fn turn(rng: &mut impl Rng) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(vector(rng) * std::f64::consts::PI)
}

fn centre(soup: &Soup<f64>) -> Point3<f64> {
    nalgebra::center(&soup.aabb().min, &soup.aabb().max)
}

/// Returns a scene scaled to a diagonal.
pub(super) fn scaled_to(soup: &Soup<f64>, diagonal: f64) -> Result<Soup<f64>> {
    let factor = diagonal / p2m_testkit::queries::diagonal(soup);
    let mut scaled = soup.clone();
    scaled.map_positions(|p| Point3::from(p.coords * factor))?;
    Ok(scaled)
}
