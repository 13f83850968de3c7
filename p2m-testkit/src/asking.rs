//! Queries whose instructions are counted.
//!
//! Generic code is compiled where it is used. Tests optimise this crate and not their own programs, so indexes become
//! trait objects here, in functions that are not inlined elsewhere, and queries are asked here.

use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, ClosestPoint, QueryOptions, Ray, RayQuery, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::Kdop;
use std::hint::black_box;

/// An index of any kind.
pub type Index<'a> = dyn ClosestPoint<f64> + Sync + 'a;

/// A tree of any kind.
pub trait Tree: ClosestPoint<f64> + RayQuery<f64> + Sync {}
impl<I: ClosestPoint<f64> + RayQuery<f64> + Sync> Tree for I {}

/// An AABB tree as a trait object.
#[must_use]
#[inline(never)]
pub fn aabb_tree<'a>(tree: &'a TreeIndex<f64, &'a Soup<f64>, Aabb<f64>>) -> &'a dyn Tree {
    tree
}

/// A k-DOP tree of 14 faces as a trait object.
#[must_use]
#[inline(never)]
pub fn kdop_tree<'a>(tree: &'a TreeIndex<f64, &'a Soup<f64>, Kdop<14>>) -> &'a dyn Tree {
    tree
}

/// An octree as a trait object.
#[must_use]
#[inline(never)]
pub fn octree<'a>(index: &'a OctreeIndex<f64, &'a Soup<f64>>) -> &'a Index<'a> {
    index
}

/// A P2M index as a trait object.
#[must_use]
#[inline(never)]
pub fn p2m<'a>(index: &'a P2mIndex<f64, &'a Soup<f64>>) -> &'a Index<'a> {
    index
}

/// How closest points are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// One query after the other.
    Single,
    /// A reordered batch on one thread, in which every query has the answer before it as a hint.
    Hints,
    /// A reordered batch on one thread, in which an index may answer several queries side by side.
    Several,
}

/// Asks for the closest points of all queries.
pub fn ask(index: &Index<'_>, way: Way, queries: &[Point3<f64>]) {
    if way == Way::Single {
        return queries.iter().for_each(|query| {
            black_box(index.closest_point(query));
        });
    }
    let options = BatchOptions::default().with_parallel(false).with_hints(way == Way::Hints);
    let mut answers = vec![None; queries.len()];
    batch::closest_points_into(index, queries, &QueryOptions::default(), &options, &mut answers);
    black_box(answers);
}

/// Asks for the first intersections of all rays.
pub fn ask_rays(tree: &dyn Tree, rays: &[Ray]) {
    for ray in rays {
        black_box(tree.first_intersection(ray));
    }
}
