use crate::octree::Octree;
use crate::partition::{Partition, SIDE_BY_SIDE};
use crate::progress::Progress;
use crate::voronoi::Voronoi;
use nalgebra::Point3;
use p2m_core::storage::{self, LoadError, Reader, Saved, Writer};
use p2m_core::{
    Best, BuildError, BuildIndex, CertifiedQuery, Closest, ClosestPoint, Collector, Inspect, Isa, Near, NearQuery,
    PrimitiveId, PrimitiveSet, QueryOptions, Real, Shape, StatsCollector, check_set, shape_of,
};
use std::marker::PhantomData;

/// An interception index with cubes as cells.
///
/// Queries outside of the refined box ([`OctreeOptions::domain`](crate::OctreeOptions::domain)) and
/// collectors of more than the nearest primitive are answered by the AABB tree over the same packets.
///
/// # Complexity
/// A query takes O(log n) steps to its cell, and then what the list has: a few packets, however many primitives there
/// are, where the cell could be made small enough.
pub type OctreeIndex<T, S> = InterceptionIndex<T, S, Octree>;

/// An interception index with the Voronoi cells of the scene's vertices as cells.
///
/// Queries farther from the scene than five of its sizes and collectors of more than the nearest primitive are answered
/// by the AABB tree over the same packets.
///
/// # Complexity
/// A query takes a few steps to its cell, from a hint by a grid, and then what the list has.
///
/// # References
/// \[Zong2023\]
pub type P2mIndex<T, S> = InterceptionIndex<T, S, Voronoi>;

/// An interception index over a set of primitives, which it keeps.
#[derive(Clone, Debug)]
pub struct InterceptionIndex<T: Real, S, P> {
    set: S,
    scalar: PhantomData<T>,
    partition: P,
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> InterceptionIndex<T, S, P> {
    /// Builds the index as [`BuildIndex::build`], and tells `progress` of each stage that begins, from this thread, and
    /// of each percent, from any thread ([`StageTimes`](crate::StageTimes) sums their times).
    ///
    /// # Errors
    /// For a coordinate that is not finite, and for more primitives than ids.
    pub fn build_with_progress(
        set: S,
        options: &P::Options,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        check_set(&set)?;
        let partition = P::build(&set, options, progress);
        Ok(Self { set, scalar: PhantomData, partition })
    }

    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The cells, without the set.
    pub fn partition(&self) -> &P {
        &self.partition
    }

    /// What it is made of.
    pub fn report(&self) -> P::Report {
        self.partition.report()
    }

    /// Heap memory that the index owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.partition.memory()
    }

    /// The same index, searched with another instruction set. Answers do not depend on it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { partition: self.partition.with_isa(isa), ..self }
    }

    /// Offers to any collector every primitive that it could want; [`ClosestPoint::search`] with [`Best`].
    /// `query` is finite.
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.partition.search(&self.set, query, collector);
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Saved> InterceptionIndex<T, S, P> {
    /// Adds the cells to a file, without the set.
    ///
    /// # Panics
    /// If the file has an index already.
    pub fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        storage::save(&self.partition, &self.set, writer);
    }

    /// The cells of a file over a set like the one that they were built over, as if they had been built.
    ///
    /// # Errors
    /// [`LoadError`].
    ///
    /// # Complexity
    /// O(n) to look at the set and copy the nodes of the tree; the rest stays in the file.
    pub fn load(set: S, reader: &Reader) -> Result<Self, LoadError> {
        let partition = storage::load(&set, reader)?;
        Ok(Self { set, scalar: PhantomData, partition })
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> Inspect<T> for InterceptionIndex<T, S, P> {
    fn inspect(&self, query: &Point3<T>, counting: &mut StatsCollector<T>) {
        self.visit(query, counting);
    }

    fn parts(&self) -> Vec<(&'static str, usize)> {
        self.partition.parts()
    }

    fn list_lengths(&self) -> Vec<usize> {
        self.partition.list_lengths()
    }

    fn list_length(&self, point: &Point3<T>) -> Option<usize> {
        self.partition.list(&point.map(Real::to_f64)).map(|list| list.len())
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> ClosestPoint<T> for InterceptionIndex<T, S, P> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.partition.search_nearest(&self.set, query, best);
    }

    fn closest_points_into(&self, queries: &[Point3<T>], options: &QueryOptions<T>, out: &mut [Option<Closest<T>>]) {
        assert_eq!(queries.len(), out.len(), "one answer for each query");
        for (queries, out) in queries.chunks(SIDE_BY_SIDE).zip(out.chunks_mut(SIDE_BY_SIDE)) {
            let several: Option<&[Point3<T>; SIDE_BY_SIDE]> = queries.try_into().ok();
            let finite =
                |queries: &[Point3<T>; SIDE_BY_SIDE]| queries.iter().flat_map(|q| q.iter()).all(|x| x.is_finite());
            if let Some(queries) = several.filter(|queries| finite(queries)) {
                let mut best = queries.each_ref().map(|query| {
                    let mut best = Best::new(options);
                    best.offer_hint(&self.set, query);
                    best
                });
                self.partition.search_nearest_of_several(&self.set, queries, &mut best);
                out.iter_mut().zip(best).for_each(|(to, best)| *to = best.finish());
            } else {
                queries.iter().zip(out).for_each(|(query, to)| *to = self.closest_point_with(query, options));
            }
        }
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> NearQuery<T> for InterceptionIndex<T, S, P> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.partition.search_near(&self.set, query, near);
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> CertifiedQuery<T> for InterceptionIndex<T, S, P> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync, P: Partition> BuildIndex<T, S> for InterceptionIndex<T, S, P> {
    type Options = P::Options;
    type Error = BuildError;

    fn build(set: S, options: &P::Options) -> Result<Self, BuildError> {
        Self::build_with_progress(set, options, &|_| ())
    }
}
