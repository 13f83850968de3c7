//! The queries whose instructions are counted.
//!
//! Generic code is compiled in the crate that uses it. Tests are compiled with optimised dependencies but are not
//! optimised themselves. So indexes become trait objects in this crate, in functions that are not inlined elsewhere,
//! and the queries run here.

use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, ClosestPoint, QueryOptions, Ray, RayQuery, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::Kdop;
use std::hint::black_box;

/// An index of any type.
pub type Index<'a> = dyn ClosestPoint<f64> + Sync + 'a;

/// A tree of any type.
pub trait Tree: ClosestPoint<f64> + RayQuery<f64> + Sync {}
impl<I: ClosestPoint<f64> + RayQuery<f64> + Sync> Tree for I {}

/// Returns an AABB tree as a trait object.
#[must_use]
#[inline(never)]
pub fn aabb_tree<'a>(tree: &'a TreeIndex<f64, &'a Soup<f64>, Aabb<f64>>) -> &'a dyn Tree {
    tree
}

/// Returns a k-DOP tree of 14 faces as a trait object.
#[must_use]
#[inline(never)]
pub fn kdop_tree<'a>(tree: &'a TreeIndex<f64, &'a Soup<f64>, Kdop<14>>) -> &'a dyn Tree {
    tree
}

/// Returns an octree as a trait object.
#[must_use]
#[inline(never)]
pub fn octree<'a>(index: &'a OctreeIndex<f64, &'a Soup<f64>>) -> &'a Index<'a> {
    index
}

/// Returns a P2M index as a trait object.
#[must_use]
#[inline(never)]
pub fn p2m<'a>(index: &'a P2mIndex<f64, &'a Soup<f64>>) -> &'a Index<'a> {
    index
}

/// The way in which closest-point queries are passed to an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueryMode {
    /// One query after the other.
    Single,
    /// A reordered batch on one thread, in which several searches are interleaved.
    Several,
}

/// Computes the closest points of all queries.
pub fn run_queries(index: &Index<'_>, mode: QueryMode, queries: &[Point3<f64>]) {
    if mode == QueryMode::Single {
        return queries.iter().for_each(|query| {
            black_box(index.closest_point(query));
        });
    }
    let options = BatchOptions::default().with_parallel(false);
    let mut answers = vec![None; queries.len()];
    batch::closest_points_into(index, queries, &QueryOptions::default(), &options, &mut answers);
    black_box(answers);
}

/// Computes the first intersections of all rays.
pub fn run_rays(tree: &dyn Tree, rays: &[Ray]) {
    for ray in rays {
        black_box(tree.first_intersection(ray));
    }
}
