//! Searches that are compiled once for each bounding volume.

use crate::traverse::evaluate::{finish, finish_nearest};
use crate::traverse::pairs::TreeSide;
use crate::traverse::primitive_fn::{EvaluateFn, IntersectFn, evaluation, intersection};
use crate::traverse::several::Several;
use crate::traverse::walkers::Walkers;
use crate::tree::PacketTree;
use crate::tree::wide_node::VolumeNodes;
use nalgebra::Point3;
use p2m_core::engine::pairs::PairSide;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::ray::RayCandidates;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::pair::Motion;
use p2m_core::{Aabb, Best, Hits, Near, PrimitiveId, PrimitiveSet, Ray, RayCollector, Real};

/// The searches of a tree with the collectors of the library.
///
/// They do not depend on the set and the scalar. Being functions of their own they are compiled once for each volume,
/// in the crate that defines it, and not in every crate that calls them.
pub trait CompiledSearches: VolumeNodes {
    /// Searches for the nearest primitive.
    fn nearest(tree: &PacketTree<Self>, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>);

    /// Searches for the nearest primitives of several query points, those of the first `count` searches.
    fn nearest_of_several(
        tree: &PacketTree<Self>,
        walkers: &mut Walkers<Self>,
        several: &mut Several<'_, Self>,
        count: usize,
    );

    /// Searches for the primitives near a point.
    fn near<'n>(tree: &PacketTree<Self>, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>);

    /// Searches for the hits of a ray.
    fn rays<'r>(
        tree: &PacketTree<Self>,
        ray: &'r Ray,
        radius: f64,
        hits: &mut Hits<'r>,
        intersect: IntersectFn<'_, 'r>,
    );

    /// Searches for the primitives that a ray may hit.
    fn ray_candidates(tree: &PacketTree<Self>, ray: &Ray, radius: f64, candidates: &mut RayCandidates<'_>);

    /// Passes a tree, after some motions in their order, to a search for pairs.
    fn as_pair_side(tree: &PacketTree<Self>, motions: &[Motion], search: &mut dyn FnMut(&dyn PairSide));
}

impl CompiledSearches for Aabb<f64> {
    fn nearest(tree: &PacketTree, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        tree.run(query, minimum, evaluate, finish_nearest);
    }

    fn nearest_of_several(
        tree: &PacketTree,
        walkers: &mut Walkers<Self>,
        several: &mut Several<'_, Self>,
        count: usize,
    ) {
        walkers.search(tree, several, count);
    }

    fn near<'n>(tree: &PacketTree, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        tree.run(query, near, evaluate, finish);
    }

    fn rays<'r>(tree: &PacketTree, ray: &'r Ray, radius: f64, hits: &mut Hits<'r>, intersect: IntersectFn<'_, 'r>) {
        tree.run_ray(ray, radius, hits, intersect);
    }

    fn ray_candidates(tree: &PacketTree, ray: &Ray, radius: f64, candidates: &mut RayCandidates<'_>) {
        tree.run_ray(ray, radius, candidates, &|_, _| None);
    }

    fn as_pair_side(tree: &PacketTree, motions: &[Motion], search: &mut dyn FnMut(&dyn PairSide)) {
        search(&TreeSide::new(tree, motions));
    }
}

impl<V: CompiledSearches> PacketTree<V> {
    /// Offers to `best` the primitives of `set` that may be the nearest.
    #[inline]
    #[doc(hidden)]
    pub fn search_nearest<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>) {
        V::nearest(self, to_f64_array(query), best.minimum(), &evaluation(set, query));
    }

    /// Offers to `near` the primitives of `set` that it could want.
    #[inline]
    #[doc(hidden)]
    pub fn search_near<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, near: &mut Near<'_>) {
        V::near(self, to_f64_array(query), near, &evaluation(set, query));
    }

    /// Offers to `hits` the hits of a ray with `set` that it could want.
    #[inline]
    #[doc(hidden)]
    pub fn search_hits<'r, T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, ray: &'r Ray, hits: &mut Hits<'r>) {
        let only_crossings = hits.only_crossings();
        let Some(radius) = self.search_radius(ray, only_crossings) else { return };
        V::rays(self, ray, radius, hits, &intersection(set, ray, only_crossings));
    }

    /// Calls `visit` for the primitives that a ray may hit.
    #[inline]
    #[doc(hidden)]
    pub fn search_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[V3]) -> f64) {
        let Some(radius) = self.search_radius(ray, false) else { return };
        V::ray_candidates(self, ray, radius, &mut RayCandidates::new(visit));
    }
}
