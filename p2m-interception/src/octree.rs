use nalgebra::Point3;
use p2m_core::interception::{Octree, OctreeOptions, OctreeReport};
use p2m_core::{Best, BuildError, BuildIndex, ClosestPoint, Collector, Isa, PrimitiveSet, Real, check_set};
use std::marker::PhantomData;

/// An interception index with cubes as cells, over a set of primitives, which it keeps.
///
/// Queries outside of the refined box ([`OctreeOptions::domain`]) and collectors of more than the nearest primitive are
/// answered by the AABB tree over the same packets.
///
/// # Complexity
/// A query takes O(log n) steps to its cell, and then what the list has: a few packets, however many primitives there
/// are, where the cell could be made small enough.
#[derive(Clone, Debug)]
pub struct OctreeIndex<T: Real, S> {
    set: S,
    scalar: PhantomData<T>,
    octree: Octree,
}

impl<T: Real, S: PrimitiveSet<T>> OctreeIndex<T, S> {
    /// Builds the index as [`BuildIndex::build`], and tells `progress` what part is done: each percent once, from any
    /// thread.
    ///
    /// # Errors
    /// For a coordinate that is not finite and for more primitives than ids.
    pub fn build_with_progress(
        set: S,
        options: &OctreeOptions,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        check_set(&set)?;
        let octree = Octree::build(&set, options, progress);
        Ok(Self { set, scalar: PhantomData, octree })
    }

    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The cells, without the set.
    pub fn octree(&self) -> &Octree {
        &self.octree
    }

    /// What it is made of.
    pub fn report(&self) -> OctreeReport {
        self.octree.report()
    }

    /// Heap memory that the index owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.octree.memory()
    }

    /// The same index, searched with another instruction set. Answers do not depend on it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { octree: self.octree.with_isa(isa), ..self }
    }

    /// Offers to any collector every primitive that it could want; [`ClosestPoint::search`] with [`Best`].
    /// `query` is finite.
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.octree.search(&self.set, query, collector);
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for OctreeIndex<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.octree.search_nearest(&self.set, query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync> BuildIndex<T, S> for OctreeIndex<T, S> {
    type Options = OctreeOptions;
    type Error = BuildError;

    fn build(set: S, options: &OctreeOptions) -> Result<Self, BuildError> {
        Self::build_with_progress(set, options, &|_| ())
    }
}
