//! The exact evaluation of pending candidates.

use crate::packet::Packet;
use crate::traverse::primitive_fn::EvaluateFn;
use crate::traverse::search_state::{Candidate, SearchState};
use crate::tree::Leaves;
use p2m_core::Collector;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::side_by_side::{SIDE_BY_SIDE, TriangleLanes, certain_vertex_squares};
use p2m_core::engine::simd::{InstructionSet, SimdKernel};

/// The number of pending candidates above which ties at shared vertices are removed before any candidate is evaluated.
/// There is no record of how it was tuned.
const SORT_TIES_ABOVE_CANDIDATES: usize = 3;

/// Offers the primitive in a lane to the collector, unless its key exceeds `square`.
#[inline(always)]
pub(super) fn offer<C: Collector>(
    leaves: &Leaves,
    packet: &Packet,
    lane: usize,
    query: [f64; 3],
    square: f64,
    collector: &mut C,
    evaluate: EvaluateFn<'_, C>,
) {
    let id = packet.ids()[lane];
    // A collector that keeps near ties gets every candidate, because a candidate that is nearer by rounding alone must
    // not exclude another one.
    let square = if collector.keeps_near_ties() { f64::INFINITY } else { square };
    if !packet.has_vertices() {
        evaluate(collector, id, square);
    } else {
        packet.offer(lane, &leaves.vertices, query, square, collector);
    }
}

impl<C: Collector> SearchState<'_, C> {
    /// Drops pending triangles that cannot win because they tie or lose at a vertex.
    ///
    /// For a query far from a mesh, all triangles around the nearest vertex are tied. Among the triangles whose nearest
    /// point is certainly a vertex, only the nearest one is kept, and ties go to the lowest id. Keys of vertices are
    /// exact to a few u, so dropping the others does not affect the certified lower bound either.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "ties are equality of bits")]
    fn drop_shared_vertex_ties<I: InstructionSet>(&mut self) {
        let mut eight = TriangleLanes::<3>::default();
        let count = self.pending_len.min(SIDE_BY_SIDE);
        for (lane, candidate) in self.pending[..count].iter().enumerate() {
            let packet = &self.leaves.packets[candidate.packet as usize];
            // A primitive of another kind has three equal corners here, for which no vertex is certain.
            if let Some(vertices) = packet.triangle_corners(candidate.lane as usize, &self.leaves.vertices) {
                eight.set(lane, &self.query, vertices);
            }
        }
        let squares = certain_vertex_squares::<I::Doubles>(&eight);
        let mut winner = (f64::INFINITY, u32::MAX, 0);
        for (i, candidate) in self.pending[..count].iter().enumerate() {
            let id = self.leaves.packets[candidate.packet as usize].ids()[candidate.lane as usize].number();
            if squares[i] < winner.0 || (squares[i] == winner.0 && id < winner.1) {
                winner = (squares[i], id, i);
            }
        }
        for (i, candidate) in self.pending[..count].iter_mut().enumerate() {
            if squares[i] < f64::INFINITY && i != winner.2 {
                candidate.lower_bound = f32::INFINITY;
            }
        }
    }

    /// Evaluates the pending candidates, the one with the least bound first, and clears the list.
    #[inline(always)]
    fn evaluate_pending_inline<I: InstructionSet>(&mut self) {
        if self.is_approximate {
            self.evaluate_incumbent();
        }
        let mut first = 0;
        for i in 1..self.pending_len {
            if self.pending[i].lower_bound < self.pending[first].lower_bound {
                first = i;
            }
        }
        self.pending.swap(0, first);
        if self.pending_len > SORT_TIES_ABOVE_CANDIDATES
            && self.collector.is_single_nearest()
            && !self.collector.keeps_near_ties()
        {
            self.drop_shared_vertex_ties::<I>();
        }
        for i in 0..self.pending_len {
            let Candidate { lower_bound, packet, lane } = self.pending[i];
            if self.distance_below(lower_bound) <= self.candidate_limit {
                // The upper bound is at least one unit of a frame, so its square does not underflow. A bound on keys
                // may be smaller than that.
                let upper_bound = self.upper_bound * self.upper_bound * (1.0 + 4.0 * f64::EPSILON);
                let packet = &self.leaves.packets[packet as usize];
                let prune = self.collector.prune_above_for_id(packet.ids()[lane as usize]);
                let square = if upper_bound < prune { upper_bound } else { prune };
                offer(self.leaves, packet, lane as usize, self.query, square, self.collector, self.evaluate);
                self.update_limits();
            }
        }
        self.pending_len = 0;
    }

    /// Evaluates the incumbent of an approximate search, and skips the pending candidates if the collector accepts it.
    #[cold]
    #[inline(never)]
    fn evaluate_incumbent(&mut self) {
        let Some((Candidate { packet, lane, .. }, _)) = self.incumbent.take() else { return };
        let (packet, lane) = (&self.leaves.packets[packet as usize], lane as usize);
        // The collector's limit is not applied, because candidates were skipped in favour of this one.
        offer(self.leaves, packet, lane, self.query, f64::INFINITY, self.collector, self.evaluate);
        if self.collector.may_stop(false) {
            for candidate in &self.pending[..self.pending_len] {
                let distance = self.distance_below(candidate.lower_bound).max(0.0);
                self.collector.record_skipped(distance * distance);
            }
            self.pending_len = 0;
        }
        self.update_limits();
    }
}

/// Evaluates the pending candidates with the instruction set of the tree.
///
/// It is a function of its own, so that the traversal need not share its registers with the evaluation.
#[inline(never)]
pub fn finish<C: Collector>(state: &mut SearchState<'_, C>) {
    state.isa.run(EvaluatePending(state));
}

/// Evaluates the pending candidates of a search for the nearest primitive. It is not generic, unlike [`finish`], so
/// that it is compiled once.
#[inline(never)]
pub fn finish_nearest(state: &mut SearchState<'_, BestF64>) {
    state.isa.run(EvaluatePending(state));
}

/// The evaluation of pending candidates as a kernel that is compiled for each instruction set.
struct EvaluatePending<'a, 'b, C>(&'a mut SearchState<'b, C>);

impl<C: Collector> SimdKernel for EvaluatePending<'_, '_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        self.0.evaluate_pending_inline::<I>();
    }
}
