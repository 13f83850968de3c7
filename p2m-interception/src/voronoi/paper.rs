//! The structure of the paper: cells of vertices with a KD-tree, long lists and R-trees.

use crate::list::interleaved_lists::InterleavedLists;
use crate::options::{P2mOptions, P2mReport};
use crate::partition::{CellQuery, Partition};
use crate::progress::Progress;
use crate::voronoi::Voronoi;
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::interleaved::InterleavedSearch;
use p2m_bvh::engine::nearest::{EvaluateFn, SearchState};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::vector::V3;
use p2m_core::{Collector, Isa, Near, PrimitiveId, PrimitiveSet, Real};

/// The options of a [`PaperIndex`](crate::PaperIndex): those of a P2M index, which are
/// [`P2mOptions::as_in_paper`] by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperOptions(pub P2mOptions);

impl Default for PaperOptions {
    fn default() -> Self {
        Self(P2mOptions::as_in_paper())
    }
}

/// The partition [`Voronoi`] with other default options. It only passes calls on.
#[derive(Clone, Debug)]
pub struct PaperVoronoi(Voronoi);

impl Partition for PaperVoronoi {
    type Options = PaperOptions;
    type Report = P2mReport;

    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &PaperOptions,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Self {
        Self(Voronoi::build(set, &options.0, progress))
    }

    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>> {
        self.0.list(point)
    }

    fn list_lengths(&self) -> Vec<usize> {
        self.0.list_lengths()
    }

    fn tree(&self) -> &PacketTree {
        self.0.tree()
    }

    fn report(&self) -> P2mReport {
        self.0.report()
    }

    fn parts(&self) -> Vec<(&'static str, usize)> {
        self.0.parts()
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self(self.0.with_isa(isa))
    }
}

impl CellQuery for PaperVoronoi {
    #[inline(always)]
    fn query_with<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        self.0.query_with(query, collector, evaluate, finish);
    }

    fn query_nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        self.0.query_nearest(query, minimum, evaluate);
    }

    fn query_near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        self.0.query_near(query, near, evaluate);
    }

    fn search_several(&self, count: usize, several: &mut InterleavedSearch<'_>, lists: &mut InterleavedLists) {
        self.0.search_several(count, several, lists);
    }
}
