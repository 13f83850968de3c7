//! What every partition of space into cells with lists offers.

use crate::progress::Progress;
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::evaluation;
use p2m_bvh::engine::nearest::{EvaluateFn, SearchState, finish};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::{Best, Collector, Isa, Near, PrimitiveId, PrimitiveSet, Real};

/// A partition with its lists, over a set of primitives that it does not keep: every method that needs the set is given
/// the same one.
///
/// Sealed: searches rest on proofs about the cells.
#[allow(private_bounds, reason = "that is what seals it")]
pub trait Partition: CellQuery + Sized {
    /// How it is built.
    type Options: Default;
    /// What it is made of.
    type Report;

    /// Builds it over a set whose boxes are finite. `progress` is told of each stage that begins, from this thread, and
    /// of each percent, from any thread.
    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &Self::Options,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Self;

    /// Offers to `collector` every primitive of the set that it could want. `query` is finite.
    #[inline]
    fn search<T: Real, S: PrimitiveSet<T>, C: Collector>(&self, set: &S, query: &Point3<T>, collector: &mut C) {
        self.query_with(to_f64_array(query), collector, &evaluation(set, query), finish);
    }

    /// The same for the nearest primitive.
    fn search_nearest<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>) {
        self.query_nearest(to_f64_array(query), best.minimum(), &evaluation(set, query));
    }

    /// The same for what is near.
    fn search_near<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>, near: &mut Near<'_>) {
        self.query_near(to_f64_array(query), near, &evaluation(set, query));
    }

    /// The same for several queries, which may be answered side by side.
    fn search_nearest_of_several<T: Real, S: PrimitiveSet<T>>(
        &self,
        set: &S,
        queries: &[Point3<T>; SIDE_BY_SIDE],
        best: &mut [Best<T>; SIDE_BY_SIDE],
    ) {
        let evaluations = queries.each_ref().map(|query| evaluation(set, query));
        let evaluates = evaluations.each_ref().map(|evaluate| evaluate as EvaluateFn<'_, BestF64>);
        self.query_several(&queries.each_ref().map(to_f64_array), best.each_mut().map(Best::minimum), evaluates);
    }

    /// The primitives of the list of the cell that a point is in, in ascending order: what a search in the cell may
    /// come to look at. `None` where the tree answers.
    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>>;

    /// How many primitives each list has.
    fn list_lengths(&self) -> Vec<usize>;

    /// The tree over the packets, which answers what cells do not.
    fn tree(&self) -> &PacketTree;

    /// What it is made of.
    fn report(&self) -> Self::Report;

    /// Heap memory it owns, by parts, in bytes.
    fn parts(&self) -> Vec<(&'static str, usize)>;

    /// All of it.
    fn memory(&self) -> usize {
        self.parts().iter().map(|part| part.1).sum()
    }

    /// Searches with another instruction set. Answers do not depend on it.
    #[must_use]
    fn with_isa(self, isa: Isa) -> Self;
}

/// How many queries are answered side by side.
pub const SIDE_BY_SIDE: usize = 16;

/// The way of a query to its cell and through its list.
pub(crate) trait CellQuery {
    /// Offers to a collector every primitive that it could want: from the list of the cell to one of nearest primitives, from the
    /// tree to others.
    fn query_with<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    );

    /// The same for the nearest one, in a function of its own: what is not generic is compiled once, in this crate.
    fn query_nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>);

    /// The same for what is near,
    fn query_near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>);

    /// and for the nearest ones of several queries.
    fn query_several(
        &self,
        queries: &[V3; SIDE_BY_SIDE],
        minimums: [&mut BestF64; SIDE_BY_SIDE],
        evaluates: [EvaluateFn<'_, BestF64>; SIDE_BY_SIDE],
    ) {
        for ((query, minimum), evaluate) in queries.iter().zip(minimums).zip(evaluates) {
            self.query_nearest(*query, minimum, evaluate);
        }
    }
}
