//! The state of a search for the nearest primitives, and its update by the filter of a packet.
//!
//! The state holds the least upper bound on the distance that the filters have found. Primitives whose lower bound is
//! within that limit become pending candidates.

use crate::packet::{LANES, Local, Packet, ROUND_UP, at_most, smallest};
use crate::traverse::primitive_fn::EvaluateFn;
use crate::tree::frame::Frame;
use crate::tree::wide_node::VolumeNodes;
use crate::tree::{Leaves, PacketTree};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::{Collector, Isa};

/// The most pending candidates. There is no record of how the number was tuned.
pub(super) const MAX_PENDING: usize = 32;

/// A primitive that may be the answer.
#[derive(Clone, Copy, Default)]
pub(super) struct Candidate {
    /// A lower bound on the distance of the primitive, in the frame of the tree.
    pub(super) lower_bound: f32,
    pub(super) packet: u32,
    pub(super) lane: u32,
}

/// The state of a search.
pub struct SearchState<'a, C> {
    pub(super) leaves: &'a Leaves,
    /// The frame of the tree.
    frame: &'a Frame,
    pub(super) isa: Isa,
    pub(super) query: [f64; 3],
    pub(super) collector: &'a mut C,
    pub(super) evaluate: EvaluateFn<'a, C>,
    /// The function that evaluates the pending candidates.
    finish: fn(&mut SearchState<'_, C>),
    /// An upper bound on the distance of the nearest primitive.
    pub(super) upper_bound: f64,
    /// The distance above which primitives are not candidates.
    pub(super) candidate_limit: f64,
    /// The square of the distance above which nodes are skipped, in the frame of the tree.
    node_limit: f32,
    /// Whether the collector may accept a primitive other than the nearest one.
    pub(super) is_approximate: bool,
    /// The candidate that will be evaluated first, and an upper bound on its distance. Only approximate searches have
    /// an incumbent.
    pub(super) incumbent: Option<(Candidate, f64)>,
    pub(super) pending: [Candidate; MAX_PENDING],
    pub(super) pending_len: usize,
}

impl<'a, C: Collector> SearchState<'a, C> {
    /// Creates the state of a new search. `upper_bound` is a distance within which some primitive is known to be.
    #[inline(always)]
    pub fn new<V: VolumeNodes>(
        tree: &'a PacketTree<V>,
        query: [f64; 3],
        upper_bound: f64,
        collector: &'a mut C,
        evaluate: EvaluateFn<'a, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) -> Self {
        let is_approximate = collector.is_approximate();
        let mut state = Self {
            leaves: &tree.leaves,
            frame: &tree.frame,
            isa: tree.isa,
            query,
            collector,
            evaluate,
            finish,
            upper_bound,
            candidate_limit: 0.0,
            node_limit: 0.0,
            is_approximate,
            incumbent: None,
            pending: [Candidate::default(); MAX_PENDING],
            pending_len: 0,
        };
        state.update_limits();
        state
    }

    /// Returns the square of the distance above which boxes are skipped, in the frame of the tree.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.node_limit
    }

    /// Adds a primitive that is evaluated without a filter.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "packets and lanes fit")]
    pub fn add(&mut self, packet: usize, lane: usize) {
        self.push_pending(Candidate { lower_bound: 0.0, packet: packet as u32, lane: lane as u32 });
    }

    /// Returns whether an approximate search may stop.
    #[inline(always)]
    pub fn may_stop(&self) -> bool {
        self.is_approximate && self.collector.may_stop(self.incumbent_distance() < f64::INFINITY)
    }

    /// Reports to the collector that everything with at least this bound is skipped. The bound is a square in the frame
    /// of the tree.
    #[inline(always)]
    pub fn record_skipped(&mut self, bound: f32) {
        self.collector.record_skipped(self.frame.square_below(bound));
    }

    #[inline(always)]
    fn incumbent_distance(&self) -> f64 {
        self.incumbent.map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// Makes the primitive in a packet and lane, which is within `distance`, the incumbent of an approximate search.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "packets and lanes fit")]
    pub fn hold(&mut self, primitive: Option<(usize, usize)>, distance: f64) {
        if self.is_approximate
            && let Some((packet, lane)) = primitive
        {
            // The infinite lower bound keeps this primitive from becoming pending once a nearer one replaces it. The
            // search reaches it anyway if it can be the answer, and of two copies the wrong one could be dropped as a
            // tie.
            let candidate = Candidate { lower_bound: f32::INFINITY, packet: packet as u32, lane: lane as u32 };
            self.replace_incumbent(candidate, distance);
        }
    }

    #[cold]
    #[inline(never)]
    fn replace_incumbent(&mut self, candidate: Candidate, distance: f64) {
        if let Some((before, _)) = self.incumbent.replace((candidate, distance))
            && before.lower_bound < f32::INFINITY
        {
            self.push_pending(before);
        }
        self.update_limits();
    }

    /// Computes the limits from the upper bound, the incumbent and the collector.
    #[inline(always)]
    pub(super) fn update_limits(&mut self) {
        let bound = self.collector.prune_above().sqrt() * (1.0 + 4.0 * f64::EPSILON);
        self.candidate_limit = if self.upper_bound < bound { self.upper_bound } else { bound };
        let square = self.upper_bound * self.upper_bound * (1.0 + 4.0 * f64::EPSILON);
        let mut prune = self.collector.prune_given_upper_bound(square);
        if self.is_approximate {
            let distance = self.incumbent_distance();
            let skip = self.collector.prune_given_incumbent(distance * distance * (1.0 + 4.0 * f64::EPSILON));
            if skip < prune {
                prune = skip;
                let bound = skip.sqrt() * (1.0 + 4.0 * f64::EPSILON);
                self.candidate_limit = if bound < self.candidate_limit { bound } else { self.candidate_limit };
            }
        }
        self.node_limit = self.frame.square_above(prune);
    }

    /// Filters some lanes of a packet. Primitives that may be the answer become pending.
    #[inline(always)]
    pub fn packet<I: InstructionSet>(&mut self, number: usize, lanes: u32) {
        self.packet_inlined_if::<I>(I::F32x8::INLINES, number, lanes);
    }

    /// Filters some lanes of a packet, inlined or out of line.
    #[inline(always)]
    pub fn packet_inlined_if<I: InstructionSet>(&mut self, is_inlined: bool, number: usize, lanes: u32) {
        if is_inlined {
            self.packet_inline::<I>(number, lanes);
        } else {
            I::call(Packets { state: self, number, lanes });
        }
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up, and packets and lanes fit")]
    fn packet_inline<I: InstructionSet>(&mut self, number: usize, lanes: u32) {
        self.collector.visit_packet();
        let packet = &self.leaves.packets[number];
        let candidate =
            |lower_bound: f32, lane: usize| Candidate { lower_bound, packet: number as u32, lane: lane as u32 };
        let Some(local) = packet.local(&self.query) else {
            let mut rest = lanes;
            while rest != 0 {
                self.push_pending(candidate(0.0, rest.trailing_zeros() as usize));
                rest &= rest - 1;
            }
            return;
        };
        let limit = ((self.candidate_limit * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
        let mut squares = [0.0; LANES];
        packet.squares::<I>(&local, limit, &mut squares);
        let mut passed = at_most::<I::Wide>(&squares, limit * limit) & lanes;
        if passed == 0 {
            return;
        }
        if self.collector.is_single_nearest() && packet.has_vertices() {
            let mut nearest = (smallest::<I::Wide>(&squares).sqrt() + local.deficit) * ROUND_UP;
            if self.collector.keeps_near_ties() {
                nearest = (nearest + (self.collector.near_tie_slack() * packet.per_unit()) as f32) * ROUND_UP;
            }
            let upper_bound = f64::from(nearest) * packet.unit();
            if upper_bound < self.upper_bound {
                self.upper_bound = upper_bound;
                self.update_limits();
                let limit = (nearest + local.excess) * ROUND_UP;
                passed &= at_most::<I::Wide>(&squares, limit * limit);
            }
            if self.is_approximate && upper_bound < self.incumbent_distance() {
                passed &= !self.make_nearest_incumbent(number, &local, &squares, upper_bound);
                let limit = ((self.candidate_limit * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
                passed &= at_most::<I::Wide>(&squares, limit * limit);
            }
        }
        while passed != 0 {
            let lane = passed.trailing_zeros() as usize;
            passed &= passed - 1;
            packet.prefetch_vertices(lane, &self.leaves.vertices);
            self.push_pending(candidate(self.lower_bound(packet, &local, squares[lane]), lane));
        }
        if !self.collector.is_single_nearest() {
            self.evaluate_pending();
        }
    }

    /// Returns the lower bound of a candidate in the frame of the tree, given the square that the filter of its packet
    /// found.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "`distance_below` allows for the rounding")]
    fn lower_bound(&self, packet: &Packet, local: &Local, square: f32) -> f32 {
        let distance = square.sqrt() * (1.0 - f32::EPSILON) - local.excess;
        // In the frame of the tree the result is in the range of f32. The difference of two f32 numbers of magnitude
        // about 1 or more does not underflow.
        (f64::from(distance) * packet.unit() * self.frame.per_unit) as f32
    }

    /// Converts the lower bound of a candidate to units of the scene and rounds it down.
    #[inline(always)]
    pub(super) fn distance_below(&self, lower_bound: f32) -> f64 {
        f64::from(lower_bound) * (1.0 - f64::from(f32::EPSILON)) * self.frame.unit
    }

    /// Makes the primitive in the lane with the smallest square the incumbent. It is within `distance`. Returns the bit
    /// of that lane.
    #[cold]
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, reason = "packets and lanes fit")]
    fn make_nearest_incumbent(&mut self, number: usize, local: &Local, squares: &[f32; LANES], distance: f64) -> u32 {
        let packet = &self.leaves.packets[number];
        let used = (0..LANES).filter(|lane| packet.lanes() >> lane & 1 == 1);
        let Some(lane) = used.min_by(|a, b| squares[*a].total_cmp(&squares[*b])) else { return 0 };
        packet.prefetch_vertices(lane, &self.leaves.vertices);
        let lower_bound = self.lower_bound(packet, local, squares[lane]);
        self.replace_incumbent(Candidate { lower_bound, packet: number as u32, lane: lane as u32 }, distance);
        1 << lane
    }

    #[inline(always)]
    fn push_pending(&mut self, candidate: Candidate) {
        if self.pending_len == MAX_PENDING {
            self.evaluate_pending();
        }
        self.pending[self.pending_len] = candidate;
        self.pending_len += 1;
    }

    /// Evaluates the pending candidates that are still within the limit, the one with the least bound first.
    #[inline(always)]
    pub fn evaluate_pending(&mut self) {
        (self.finish)(self);
    }
}

/// The filters of some lanes of a packet, and of the packets that continue its run as far as the collector wants their
/// primitives, as a kernel.
struct Packets<'a, 'b, C> {
    state: &'a mut SearchState<'b, C>,
    number: usize,
    lanes: u32,
}

impl<C: Collector> SimdKernel for Packets<'_, '_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { state, mut number, mut lanes } = self;
        loop {
            state.packet_inline::<I>(number, lanes);
            if state.collector.is_single_nearest()
                || !state.leaves.is_rest_wanted(number, state.query, &*state.collector)
            {
                return;
            }
            number += 1;
            lanes = state.leaves.packets[number].lanes();
        }
    }
}
