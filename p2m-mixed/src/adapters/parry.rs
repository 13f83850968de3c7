//! The bounding volume hierarchy of the crate parry3d-f64.

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

/// No bound is above this: parry leaves out what costs as much as the largest number.
const FAR: f64 = 1e300;

/// An index over a set of primitives by the tree of boxes of parry.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BuildIndex, ClosestPoint, Segment};
/// use p2m_mixed::adapters::ParryIndex;
///
/// let wires = [Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0))];
/// let index = ParryIndex::build(&wires, &())?;
/// assert_eq!(index.closest_point(&Point3::new(1.0, 2.0, 0.0)).unwrap().distance, 2.0);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// # Complexity
/// Build O(n log n); queries expected O(log n).
pub struct ParryIndex<T: Real, S> {
    set: S,
    scalar: PhantomData<T>,
    tree: Bvh,
}

impl<T: Real, S: PrimitiveSet<T>> ParryIndex<T, S> {
    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Offers to any collector every primitive that it could want. `query` is finite.
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        let place = query.coords.map(Real::to_f64);
        // Parry takes functions that change nothing.
        let collector = RefCell::new(collector);
        // What is as far as the bound may tie, so that is not the bound for parry, which goes below it.
        let cost = |collector: &C| collector.prune_above().next_up().min(f64::MAX);
        let bound = |node: &BvhNode, _: f64| {
            let (min, max) = (node.mins(), node.maxs());
            let beside = |x: f64, min: f64, max: f64| (min - x).max(x - max).max(0.0);
            let way = [beside(place.x, min.x, max.x), beside(place.y, min.y, max.y), beside(place.z, min.z, max.z)];
            let square = (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) * ROUND_DOWN;
            if square < FAR { square } else { FAR }
        };
        let offer = |number: u32, _: f64| {
            let id = PrimitiveId::new(number as usize);
            let mut collector = collector.borrow_mut();
            collector.offer(id, self.set.get(id).project(query));
            Some(cost(&collector))
        };
        let most = cost(&collector.borrow());
        let _ = self.tree.find_best(most, bound, offer);
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
                let place = |p: Point3<f64>| <[f64; 3]>::from(p.coords).into();
                Aabb { mins: place(bounds.min), maxs: place(bounds.max) }
            })
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Ok(Self { set, scalar: PhantomData, tree })
    }
}
