//! The interface of a partition of space into cells with interception lists.

use crate::list::interleaved_lists::InterleavedLists;
use crate::progress::Progress;
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::evaluation;
use p2m_bvh::engine::interleaved::InterleavedSearch;
use p2m_bvh::engine::nearest::{EvaluateFn, SearchState, finish};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::{Best, CellSummary, Collector, Isa, Near, PrimitiveId, PrimitiveSet, Real};

/// A partition with its lists, over a set of primitives that it does not store. Every method that takes a set has to
/// be given the set that the partition was built over.
///
/// The trait is sealed, because searches rely on proofs about the cells.
#[allow(private_bounds, reason = "that is what seals it")]
pub trait Partition: CellQuery + Sized {
    /// The options of a build.
    type Options: Default;
    /// The statistics of a partition.
    type Report: Into<CellSummary>;

    /// Builds the partition over a set whose bounding boxes are finite. `progress` is called for each stage that
    /// begins, from the calling thread, and for each percent, from any thread.
    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &Self::Options,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Self;

    /// Offers to `collector` every primitive of the set that it may need. `query` has to be finite.
    #[inline]
    fn search<T: Real, S: PrimitiveSet<T>, C: Collector>(&self, set: &S, query: &Point3<T>, collector: &mut C) {
        self.query_with(to_f64_array(query), collector, &evaluation(set, query), finish);
    }

    /// Offers to `best` every primitive that may be the nearest. `query` has to be finite.
    fn search_nearest<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>) {
        self.query_nearest(to_f64_array(query), best.minimum(), &evaluation(set, query));
    }

    /// Offers to `near` every primitive that it may need. `query` has to be finite.
    fn search_near<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>, near: &mut Near<'_>) {
        self.query_near(to_f64_array(query), near, &evaluation(set, query));
    }

    /// Returns the primitives in the list of the cell that contains a point, in ascending order. A search in the cell
    /// evaluates only these. The result is `None` if the tree answers.
    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>>;

    /// Returns the number of primitives in each list.
    fn list_lengths(&self) -> Vec<usize>;

    /// Returns the tree over the packets. It answers wherever the cells do not.
    fn tree(&self) -> &PacketTree;

    /// Returns the statistics of the partition.
    fn report(&self) -> Self::Report;

    /// Returns the heap memory of each part of the partition, in bytes.
    fn parts(&self) -> Vec<(&'static str, usize)>;

    /// Returns the heap memory of the partition in bytes.
    fn memory(&self) -> usize {
        self.parts().iter().map(|part| part.1).sum()
    }

    /// Selects the instruction set of searches. Answers do not depend on it.
    #[must_use]
    fn with_isa(self, isa: Isa) -> Self;
}

/// Returns whether a list has all primitives that a collector may need. A list holds the primitives that can be
/// nearest, and those that are farther only by rounding.
#[inline(always)]
pub(crate) fn are_lists_enough(collector: &impl Collector) -> bool {
    collector.is_single_nearest() && collector.near_tie_slack() <= 0.0
}

/// The search of a query's cell. Its methods are not generic over the set, so that most of them are compiled once,
/// in this crate.
pub(crate) trait CellQuery {
    /// Offers to a collector every primitive that it may need. A collector of the nearest primitive gets them from the
    /// list of the cell, other collectors get them from the tree.
    fn query_with<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    );

    /// Offers the primitives that may be the nearest.
    fn query_nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>);

    /// Offers the primitives that a [`Near`] may need.
    fn query_near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>);

    /// Runs the first `count` searches of `several` in turns. Each finds the primitives that may be the nearest to its
    /// query.
    fn search_several(&self, count: usize, several: &mut InterleavedSearch<'_>, lists: &mut InterleavedLists);
}
