//! Nearest-first search over wide nodes and packets.
//!
//! Filters bound distances from both sides, so the search can go through the whole tree before it evaluates a single
//! primitive: it keeps the least upper bound that it has seen, skips what lies above it, and remembers as candidates
//! what may lie below. At the end few are left, mostly one and those that share its nearest feature, and these are
//! offered to the collector, which decides by exact keys. Where the collector wants more than the nearest, candidates
//! are offered packet by packet, or up to 32 at a time where the filter knows nothing.

use crate::packet::{LANES, Local, Packet, ROUND_UP, at_most, smallest};
use crate::traverse::{Walk, walk};
use crate::tree::aabb_node::{Frame, NodeRef};
use crate::tree::volume::{Volume, WideNode};
use crate::tree::{Leaves, PacketTree};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vertices::{SIDE_BY_SIDE, certain_vertices};
use p2m_core::{Collector, Isa, PrimitiveId};
use std::ops::ControlFlow;

/// Candidates that wait for their evaluation.
const CANDIDATES: usize = 32;

/// Offers a primitive of which the tree has only a box to the collector, unless its key exceeds a square. Not a type
/// parameter: so searches do not depend on the set, and are compiled once for all of them.
pub type EvaluateFn<'a, C> = &'a dyn Fn(&mut C, PrimitiveId, f64);

/// A search as an operation.
pub struct Search<'a, V: Volume, C> {
    pub tree: &'a PacketTree<V>,
    pub query: [f64; 3],
    /// Some primitive is known to be at most this far,
    pub reach: f64,
    /// perhaps the one in this packet and lane.
    pub held: Option<(usize, usize)>,
    pub collector: &'a mut C,
    pub evaluate: EvaluateFn<'a, C>,
    pub finish: fn(&mut SearchState<'_, C>),
}

impl<V: Volume, C: Collector> SimdKernel for Search<'_, V, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let tree = self.tree;
        let Some(local) = V::Node::query(&tree.shape, &tree.frame, &self.query) else { return self.run_far() };
        let mut filter = SearchState::new(tree, self.query, self.reach, self.collector, self.evaluate, self.finish);
        filter.hold(self.held, self.reach);
        let mut nearest = Nearest { filter, shape: &tree.shape, local };
        walk::<I, V, _>(tree, &mut nearest);
        nearest.filter.evaluate_waiting();
    }
}

impl<V: Volume, C: Collector> Search<'_, V, C> {
    /// The same in f64 and without filters, for queries and scenes that f32 cannot tell apart.
    #[cold]
    #[inline(never)]
    fn run_far(self) {
        let Self { tree, query, collector, evaluate, .. } = self;
        let place = nalgebra::Point3::from(query);
        let mut stack = vec![(0.0, tree.root)];
        while let Some((bound, child)) = stack.pop() {
            if collector.is_approximate() && collector.may_stop(false) {
                return collector.record_skipped(stack.iter().fold(bound, |least, waiting| least.min(waiting.0)));
            }
            if bound > collector.prune_above() || child == NodeRef::NONE {
                continue;
            }
            if child.is_packet() {
                collector.visit_packet();
                let packet = &tree.leaves.packets[child.number()];
                for lane in 0..packet.ids().len() {
                    let limit = collector.prune_above();
                    offer_apart(&tree.leaves, packet, lane, query, limit, collector, evaluate);
                }
                continue;
            }
            collector.visit_node();
            let from = stack.len();
            stack.extend(tree.child_boxes(child).map(|(bounds, child)| (bounds.lower_bound(&place), child)));
            nearest_last(&mut stack[from..]);
        }
    }
}

/// [`offer`] as a function of its own, so that it is compiled once for all volumes where its speed does not matter.
#[inline(never)]
fn offer_apart<C: Collector>(
    leaves: &Leaves,
    packet: &Packet,
    lane: usize,
    query: [f64; 3],
    square: f64,
    collector: &mut C,
    evaluate: EvaluateFn<'_, C>,
) {
    offer(leaves, packet, lane, query, square, collector, evaluate);
}

/// Sorts children by their bounds. Not generic, for sorting is much code.
fn nearest_last(children: &mut [(f64, NodeRef)]) {
    children.sort_by(|a, b| b.0.total_cmp(&a.0));
}

/// A search on its way through the nodes.
struct Nearest<'a, V: Volume, C> {
    filter: SearchState<'a, C>,
    shape: &'a V::Shape,
    local: <V::Node as WideNode>::Query,
}

impl<V: Volume, C: Collector> Walk<V> for Nearest<'_, V, C> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        node.lower_bounds(self.shape, &self.local)
    }
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.filter.limit
    }
    #[inline(always)]
    fn visit_node(&mut self) {
        self.filter.collector.visit_node();
    }
    #[inline(always)]
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()> {
        self.filter.packet::<I>(number, self.filter.leaves.packets[number].lanes());
        ControlFlow::Continue(())
    }
    #[inline(always)]
    fn is_content(&self) -> bool {
        self.filter.is_content()
    }
    #[inline(always)]
    fn forgo(&mut self, bound: f32) {
        self.filter.forgo(bound);
    }
}

/// Offers the primitive in a lane to the collector, unless its key exceeds `square`.
#[inline(always)]
fn offer<C: Collector>(
    leaves: &Leaves,
    packet: &Packet,
    lane: usize,
    query: [f64; 3],
    square: f64,
    collector: &mut C,
    evaluate: EvaluateFn<'_, C>,
) {
    let id = packet.ids()[lane];
    // What is nearer by rounding alone is no reason to leave out another one.
    let square = if collector.keeps_near_ties() { f64::INFINITY } else { square };
    if !packet.has_vertices() {
        evaluate(collector, id, square);
    } else {
        packet.offer(lane, &leaves.vertices, query, square, collector);
    }
}

/// A primitive that may be the answer.
#[derive(Clone, Copy, Default)]
struct Candidate {
    /// A lower bound of its distance, in the frame of the scene.
    low: f32,
    packet: u32,
    lane: u32,
}

/// The state of a search.
pub struct SearchState<'a, C> {
    leaves: &'a Leaves,
    /// Of the nodes.
    frame: &'a Frame,
    isa: Isa,
    query: [f64; 3],
    collector: &'a mut C,
    evaluate: EvaluateFn<'a, C>,
    finish: fn(&mut SearchState<'_, C>),
    /// Some primitive is known to be at most this far.
    reach: f64,
    /// The distance above which primitives are no candidates.
    keep: f64,
    /// The square above which nodes are skipped, in their frame.
    limit: f32,
    /// Whether the collector may be content with less than the nearest primitive.
    approximate: bool,
    /// The candidate that is evaluated first, and how far it is at most.
    held: Option<(Candidate, f64)>,
    waiting: [Candidate; CANDIDATES],
    count: usize,
}

impl<'a, C: Collector> SearchState<'a, C> {
    /// Nothing seen yet, but some primitive is known to be at most `reach` far.
    #[inline(always)]
    pub fn new<V: Volume>(
        tree: &'a PacketTree<V>,
        query: [f64; 3],
        reach: f64,
        collector: &'a mut C,
        evaluate: EvaluateFn<'a, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) -> Self {
        let approximate = collector.is_approximate();
        let mut filter = Self {
            leaves: &tree.leaves,
            frame: &tree.frame,
            isa: tree.isa,
            query,
            collector,
            evaluate,
            finish,
            reach,
            keep: 0.0,
            limit: 0.0,
            approximate,
            held: None,
            waiting: [Candidate::default(); CANDIDATES],
            count: 0,
        };
        filter.update();
        filter
    }

    /// The square above which boxes are skipped, in the frame of the scene.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.limit
    }

    /// Adds a primitive that is to be evaluated whatever its filter says.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "places fit")]
    pub fn add(&mut self, packet: usize, lane: usize) {
        self.wait(Candidate { low: 0.0, packet: packet as u32, lane: lane as u32 });
    }

    /// Whether the search may end.
    #[inline(always)]
    pub fn is_content(&self) -> bool {
        self.approximate && self.collector.may_stop(self.held.is_some())
    }

    /// What has this bound, a square in the frame of the scene, and what is farther is not searched.
    #[inline(always)]
    pub fn forgo(&mut self, bound: f32) {
        self.collector.record_skipped(self.frame.square_below(bound));
    }

    #[inline(always)]
    fn held_distance(&self) -> f64 {
        self.held.map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// Holds the primitive in a packet and lane, which is at most `distance` far, for an approximate search.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "places fit")]
    pub fn hold(&mut self, place: Option<(usize, usize)>, distance: f64) {
        if self.approximate
            && let Some((packet, lane)) = place
        {
            // Once something nearer is held it must not wait: the search comes to it where it matters, and of two that are the
            // same the wrong one could be dropped as a tie.
            let candidate = Candidate { low: f32::INFINITY, packet: packet as u32, lane: lane as u32 };
            self.hold_candidate(candidate, distance);
        }
    }

    #[cold]
    #[inline(never)]
    fn hold_candidate(&mut self, candidate: Candidate, distance: f64) {
        if let Some((before, _)) = self.held.replace((candidate, distance))
            && before.low < f32::INFINITY
        {
            self.wait(before);
        }
        self.update();
    }

    /// Brings the bounds up to date with the reach and the collector.
    #[inline(always)]
    fn update(&mut self) {
        let bound = self.collector.prune_above().sqrt() * (1.0 + 4.0 * f64::EPSILON);
        self.keep = if self.reach < bound { self.reach } else { bound };
        let square = self.reach * self.reach * (1.0 + 4.0 * f64::EPSILON);
        let mut prune = self.collector.prune_given_upper_bound(square);
        if self.approximate {
            let held = self.held_distance();
            let skip = self.collector.prune_given_incumbent(held * held * (1.0 + 4.0 * f64::EPSILON));
            if skip < prune {
                prune = skip;
                let bound = skip.sqrt() * (1.0 + 4.0 * f64::EPSILON);
                self.keep = if bound < self.keep { bound } else { self.keep };
            }
        }
        self.limit = self.frame.square_above(prune);
    }

    /// Looks at some lanes of a packet.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up, and places fit")]
    pub fn packet<I: InstructionSet>(&mut self, number: usize, lanes: u32) {
        self.collector.visit_packet();
        let packet = &self.leaves.packets[number];
        let candidate = |low: f32, lane: usize| Candidate { low, packet: number as u32, lane: lane as u32 };
        let Some(local) = packet.local(&self.query) else {
            let mut rest = lanes;
            while rest != 0 {
                self.wait(candidate(0.0, rest.trailing_zeros() as usize));
                rest &= rest - 1;
            }
            return;
        };
        let keep = ((self.keep * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
        let mut squares = [0.0; LANES];
        packet.squares::<I>(&local, keep, &mut squares);
        let mut found = at_most::<I::Wide>(&squares, keep * keep) & lanes;
        if found == 0 {
            return;
        }
        if self.collector.is_single_nearest() && packet.has_vertices() {
            let reach = (smallest::<I::Wide>(&squares).sqrt() + local.deficit) * ROUND_UP;
            let here = f64::from(reach) * packet.unit();
            if here < self.reach {
                self.reach = here;
                self.update();
                let keep = (reach + local.excess) * ROUND_UP;
                found &= at_most::<I::Wide>(&squares, keep * keep);
            }
            if self.approximate && here < self.held_distance() {
                found &= !self.hold_nearest(number, &local, &squares, here);
                let keep = ((self.keep * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
                found &= at_most::<I::Wide>(&squares, keep * keep);
            }
        }
        while found != 0 {
            let lane = found.trailing_zeros() as usize;
            found &= found - 1;
            packet.prefetch_vertices(lane, &self.leaves.vertices);
            self.wait(candidate(self.low(packet, &local, squares[lane]), lane));
        }
        if !self.collector.is_single_nearest() {
            self.evaluate_waiting();
        }
    }

    /// The lower bound of a candidate, from what the filter found.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "what reads it allows for that")]
    fn low(&self, packet: &Packet, local: &Local, square: f32) -> f32 {
        let low = square.sqrt() * (1.0 - f32::EPSILON) - local.excess;
        // In the frame of the scene, where f32 has room; a difference of f32 about 1 or above does not underflow.
        (f64::from(low) * packet.unit() * self.frame.per_unit) as f32
    }

    /// The same bound in the scene.
    #[inline(always)]
    fn low_in_scene(&self, low: f32) -> f64 {
        f64::from(low) * (1.0 - f64::from(f32::EPSILON)) * self.frame.unit
    }

    /// Holds the lane of a packet with the smallest square, which is at most `distance` far. Returns its bit.
    #[cold]
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, reason = "places fit")]
    fn hold_nearest(&mut self, number: usize, local: &Local, squares: &[f32; LANES], distance: f64) -> u32 {
        let packet = &self.leaves.packets[number];
        let used = (0..LANES).filter(|lane| packet.lanes() >> lane & 1 == 1);
        let Some(lane) = used.min_by(|a, b| squares[*a].total_cmp(&squares[*b])) else { return 0 };
        packet.prefetch_vertices(lane, &self.leaves.vertices);
        let low = self.low(packet, local, squares[lane]);
        self.hold_candidate(Candidate { low, packet: number as u32, lane: lane as u32 }, distance);
        1 << lane
    }

    #[inline(always)]
    fn wait(&mut self, candidate: Candidate) {
        if self.count == CANDIDATES {
            self.evaluate_waiting();
        }
        self.waiting[self.count] = candidate;
        self.count += 1;
    }

    /// Evaluates the candidates that are still of interest, the most promising one first.
    #[inline(always)]
    pub fn evaluate_waiting(&mut self) {
        (self.finish)(self);
    }

    /// Of the triangles of which a vertex is certainly the nearest point only the nearest stay, and of these the first:
    /// others are as far or farther. They are not missed in the certified bound either, for keys of vertices are
    /// right to some u.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "ties are equality of bits")]
    fn drop_ties(&mut self) {
        let mut corners = [[[0.0; SIDE_BY_SIDE]; 3]; 3];
        let count = self.count.min(SIDE_BY_SIDE);
        for (i, candidate) in self.waiting[..count].iter().enumerate() {
            let packet = &self.leaves.packets[candidate.packet as usize];
            if let Some(own) = packet.triangle_corners(candidate.lane as usize, &self.leaves.vertices) {
                for v in 0..3 {
                    for k in 0..3 {
                        corners[v][k][i] = own[v][k];
                    }
                }
            }
        }
        // What is no triangle is three times the same point here, of which nothing is certain.
        let squares = certain_vertices(self.query, &corners);
        let mut winner = (f64::INFINITY, u32::MAX, 0);
        for (i, candidate) in self.waiting[..count].iter().enumerate() {
            let id = self.leaves.packets[candidate.packet as usize].ids()[candidate.lane as usize].number();
            if squares[i] < winner.0 || (squares[i] == winner.0 && id < winner.1) {
                winner = (squares[i], id, i);
            }
        }
        for (i, candidate) in self.waiting[..count].iter_mut().enumerate() {
            if squares[i] < f64::INFINITY && i != winner.2 {
                candidate.low = f32::INFINITY;
            }
        }
    }

    #[inline(always)]
    fn finish(&mut self) {
        if self.approximate {
            self.finish_held();
        }
        let mut first = 0;
        for i in 1..self.count {
            if self.waiting[i].low < self.waiting[first].low {
                first = i;
            }
        }
        self.waiting.swap(0, first);
        if self.count > FEW && self.collector.is_single_nearest() && !self.collector.keeps_near_ties() {
            self.drop_ties();
        }
        for i in 0..self.count {
            let Candidate { low, packet, lane } = self.waiting[i];
            // Less for its rounding.
            if self.low_in_scene(low) <= self.keep {
                // The reach is at least a unit of a frame: its square does not underflow, as that of a bound on keys
                // may.
                let reach = self.reach * self.reach * (1.0 + 4.0 * f64::EPSILON);
                let packet = &self.leaves.packets[packet as usize];
                let prune = self.collector.prune_above_for_id(packet.ids()[lane as usize]);
                let square = if reach < prune { reach } else { prune };
                offer(self.leaves, packet, lane as usize, self.query, square, self.collector, self.evaluate);
                self.update();
            }
        }
        self.count = 0;
    }
}

impl<C: Collector> SearchState<'_, C> {
    /// Evaluates what is held, and gives up what waits if that is enough.
    #[cold]
    #[inline(never)]
    fn finish_held(&mut self) {
        let Some((Candidate { packet, lane, .. }, _)) = self.held.take() else { return };
        let (packet, lane) = (&self.leaves.packets[packet as usize], lane as usize);
        // Whatever the collector skips for the sake of what it has: more was skipped for the sake of this one.
        offer(self.leaves, packet, lane, self.query, f64::INFINITY, self.collector, self.evaluate);
        if self.collector.may_stop(false) {
            for candidate in &self.waiting[..self.count] {
                let low = self.low_in_scene(candidate.low).max(0.0);
                self.collector.record_skipped(low * low);
            }
            self.count = 0;
        }
        self.update();
    }
}

/// So many candidates are evaluated one by one.
const FEW: usize = 3;

/// Evaluates the candidates that wait with the instruction set, in a function of its own: the traversal is better off
/// with registers of its own.
#[inline(never)]
pub fn finish<C: Collector>(filter: &mut SearchState<'_, C>) {
    filter.isa.run(Finish(filter));
}

/// The same for the nearest primitive: what is not generic is compiled once.
#[inline(never)]
pub fn finish_nearest(filter: &mut SearchState<'_, BestF64>) {
    filter.isa.run(Finish(filter));
}

/// The evaluation of the candidates that wait.
struct Finish<'a, 'b, C>(&'a mut SearchState<'b, C>);

impl<C: Collector> SimdKernel for Finish<'_, '_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        self.0.finish();
    }
}
