//! An index by the bounding volume hierarchy of the crate parry3d-f64.

use super::ROUND_DOWN;
use nalgebra::Point3;
use p2m_core::{
    Best, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, Collector, Near, NearQuery, Primitive, PrimitiveId,
    PrimitiveSet, Real, Shape, check_set, shape_of,
};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use std::cell::RefCell;
use std::marker::PhantomData;

/// The largest bound that is passed to parry, which ignores nodes whose cost is the largest number.
const MAX_BOUND: f64 = 1e300;

/// An index over a set of primitives that uses the tree of boxes of parry.
///
/// # Complexity
/// Building takes O(n log n), and a query is expected to take O(log n).
pub struct ParryIndex<T: Real, S> {
    set: S,
    scalar: PhantomData<T>,
    tree: Bvh,
}

impl<T: Real, S: PrimitiveSet<T>> ParryIndex<T, S> {
    /// Returns the set that the index was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Offers a collector every primitive within its bound. `query` has to be finite.
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        let point = query.coords.map(Real::to_f64);
        // Parry takes functions that cannot change what they capture.
        let collector = RefCell::new(collector);
        // Parry visits only nodes strictly below its bound. Candidates exactly at the bound may tie, so it gets the
        // next larger number.
        let cost = |collector: &C| collector.prune_above().next_up().min(f64::MAX);
        let bound = |node: &BvhNode, _: f64| {
            let (min, max) = (node.mins(), node.maxs());
            let gap = |x: f64, min: f64, max: f64| (min - x).max(x - max).max(0.0);
            let gaps = [gap(point.x, min.x, max.x), gap(point.y, min.y, max.y), gap(point.z, min.z, max.z)];
            let square = (gaps[0] * gaps[0] + gaps[1] * gaps[1] + gaps[2] * gaps[2]) * ROUND_DOWN;
            if square < MAX_BOUND { square } else { MAX_BOUND }
        };
        let offer = |index: u32, _: f64| {
            let id = PrimitiveId::new(index as usize);
            let mut collector = collector.borrow_mut();
            collector.offer(id, self.set.get(id).project(query));
            Some(cost(&collector))
        };
        let bound_at_start = cost(&collector.borrow());
        let _ = self.tree.find_best(bound_at_start, bound, offer);
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for ParryIndex<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.visit(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T>> NearQuery<T> for ParryIndex<T, S> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.visit(query, near);
    }
}

impl<T: Real, S: PrimitiveSet<T>> CertifiedQuery<T> for ParryIndex<T, S> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T>> BuildIndex<T, S> for ParryIndex<T, S> {
    type Options = ();
    type Error = BuildError;

    fn build(set: S, (): &()) -> Result<Self, BuildError> {
        check_set(&set)?;
        let boxes: Vec<Aabb> = (0..set.len())
            .map(|i| {
                let bounds = set.get(PrimitiveId::new(i)).aabb().to_f64();
                let point = |p: Point3<f64>| <[f64; 3]>::from(p.coords).into();
                Aabb { mins: point(bounds.min), maxs: point(bounds.max) }
            })
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Ok(Self { set, scalar: PhantomData, tree })
    }
}
