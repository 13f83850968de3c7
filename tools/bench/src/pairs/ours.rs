//! The indexes of this project.

use super::poses::{Set, Trees};
use super::{Competitor, Kind, each};
use crate::scene::Scene;
use anyhow::Result;
use nalgebra::Isometry3;
use p2m_bvh::AabbTree;
use p2m_core::pair::{ClosestPair, PairOptions, PairQuery};
use p2m_core::{Real, Soup};
use p2m_kdop::KdopTree;

type Poses = [Isometry3<f64>];

/// Our trees of two scenes.
pub(super) struct Scenes<'a> {
    pub(super) trees: Trees<'a>,
    kdops: [KdopTree<f64, &'a Soup<f64>>; 2],
    single: Option<[AabbTree<f32, &'a Soup<f32>>; 2]>,
}

impl<'a> Scenes<'a> {
    pub(super) fn build(scene: &'a Scene, other: &'a Scene) -> Result<Self> {
        let soups = [&*scene.double, &*other.double];
        let single = match [scene.single.as_deref(), other.single.as_deref()] {
            [Some(a), Some(b)] => Some([AabbTree::new(a)?, AabbTree::new(b)?]),
            _ => None,
        };
        let [a, b] = soups.map(AabbTree::new);
        let [c, d] = soups.map(KdopTree::new);
        Ok(Self { trees: [a?, b?], kdops: [c?, d?], single })
    }

    /// Returns the competitors for a set of poses of the second scene.
    pub(super) fn competitors(&self, set: Set, diagonal: f64) -> Vec<Competitor<'_, Isometry3<f64>>> {
        let [a, b] = &self.trees;
        let [c, d] = &self.kdops;
        let mut all = vec![
            Competitor::new("AABB tree", Kind::Exact, |poses: &Poses, out: &mut [f64]| {
                each(poses, out, |motion| distance(a.closest_pair(b, &moved(motion))));
            }),
            Competitor::new("14-DOP tree", Kind::Exact, |poses: &Poses, out: &mut [f64]| {
                each(poses, out, |motion| distance(c.closest_pair(d, &moved(motion))));
            }),
        ];
        if set != Set::Deep {
            all.push(Competitor::new(
                "AABB tree, begun with the last pair",
                Kind::Exact,
                |poses: &Poses, out: &mut [f64]| {
                    let mut last = None;
                    each(poses, out, |motion| {
                        let mut options = moved(motion);
                        options.hint = last;
                        let pair = a.closest_pair(b, &options);
                        last = pair.map(|pair| pair.primitives);
                        distance(pair)
                    });
                },
            ));
        }
        let limit = diagonal * 0.1;
        all.push(Competitor::new(
            "AABB tree, within 0.1 diagonals",
            Kind::Other,
            move |poses: &Poses, out: &mut [f64]| {
                each(poses, out, |motion| {
                    a.closest_pair(b, &moved(motion).with_max_distance(limit)).map_or(f64::NAN, |pair| pair.distance)
                });
            },
        ));
        all.push(Competitor::new(
            "AABB tree, whether they intersect",
            Kind::Other,
            |poses: &Poses, out: &mut [f64]| {
                each(poses, out, |motion| {
                    if a.is_any_pair_near(b, &moved(motion).with_max_distance(0.0)) { 0.0 } else { f64::NAN }
                });
            },
        ));
        if let Some([a, b]) = &self.single {
            all.push(Competitor::new("AABB tree in f32", Kind::Other, |poses: &Poses, out: &mut [f64]| {
                each(poses, out, |motion| distance(a.closest_pair(b, &moved(motion))));
            }));
        }
        all
    }
}

fn moved<T: Real>(motion: &Isometry3<f64>) -> PairOptions<T> {
    PairOptions::default().with_motion(*motion)
}

fn distance<T: Real>(pair: Option<ClosestPair<T>>) -> f64 {
    pair.map_or(f64::INFINITY, |pair| pair.distance.to_f64())
}
