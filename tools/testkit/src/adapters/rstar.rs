//! An index by the R*-tree of the crate rstar.

use super::ROUND_DOWN;
use nalgebra::Point3;
use p2m_core::{
    Best, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, Collector, Near, NearQuery, Primitive, PrimitiveId,
    PrimitiveSet, Real, Shape, check_set, shape_of,
};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::marker::PhantomData;

type Entry = GeomWithData<Rectangle<[f64; 3]>, PrimitiveId>;

/// An index over a set of primitives that uses an R*-tree of their boxes \[Beckmann1990\].
///
/// Boxes are visited nearest first, until the next one is farther than the incumbent.
///
/// # Complexity
/// Building takes O(n log n), and a query is expected to take O(log n).
#[derive(Debug, Clone)]
pub struct RstarIndex<T: Real, S> {
    set: S,
    scalar: PhantomData<T>,
    tree: RTree<Entry>,
}

impl<T: Real, S: PrimitiveSet<T>> RstarIndex<T, S> {
    /// Returns the set that the index was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Offers a collector every primitive within its bound. `query` has to be finite.
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        let point: [f64; 3] = query.coords.map(Real::to_f64).into();
        for (entry, square) in self.tree.nearest_neighbor_iter_with_distance_2(point) {
            if square * ROUND_DOWN > collector.prune_above() {
                return;
            }
            collector.offer(entry.data, self.set.get(entry.data).project(query));
        }
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for RstarIndex<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.visit(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T>> NearQuery<T> for RstarIndex<T, S> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.visit(query, near);
    }
}

impl<T: Real, S: PrimitiveSet<T>> CertifiedQuery<T> for RstarIndex<T, S> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T>> BuildIndex<T, S> for RstarIndex<T, S> {
    type Options = ();
    type Error = BuildError;

    fn build(set: S, (): &()) -> Result<Self, BuildError> {
        check_set(&set)?;
        let entry = |id: PrimitiveId| {
            let bounds = set.get(id).aabb().to_f64();
            let bounds = AABB::from_corners(bounds.min.coords.into(), bounds.max.coords.into());
            GeomWithData::new(Rectangle::from_aabb(bounds), id)
        };
        let tree = RTree::bulk_load((0..set.len()).map(PrimitiveId::new).map(entry).collect());
        Ok(Self { set, scalar: PhantomData, tree })
    }
}
