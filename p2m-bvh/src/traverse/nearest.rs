//! The search for the nearest primitives.
//!
//! The basic idea: filters bound distances from both sides, so the search can traverse the whole tree before it
//! evaluates a single primitive. It keeps the least upper bound so far, skips everything above it, and collects the
//! primitives below it as pending candidates. At the end few are left, usually one primitive and its neighbours that
//! share the nearest feature. They are offered to the collector, which decides by exact keys. If the collector needs
//! more than the nearest primitive, candidates are offered packet by packet.

use crate::packet::Packet;
use crate::traverse::evaluate::offer;
use crate::traverse::primitive_fn::{EvaluateFn, evaluation};
use crate::traverse::search_state::SearchState;
use crate::traverse::{Visitor, evaluate, traverse};
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode, is_inlined, lower_bounds};
use crate::tree::{Leaves, PacketTree};
use nalgebra::Point3;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{Collector, PrimitiveSet, Real};
use std::ops::ControlFlow;

impl<V: VolumeNodes> PacketTree<V> {
    /// Offers to `collector` every primitive of `set` that it may need. The tree has to be built over that set, and
    /// `query` has to be finite.
    #[inline]
    pub fn search<T: Real, S: PrimitiveSet<T> + ?Sized, C: Collector>(
        &self,
        set: &S,
        query: &Point3<T>,
        collector: &mut C,
    ) {
        self.run(to_f64_array(query), collector, &evaluation(set, query), evaluate::finish);
    }

    /// Runs the search for any set. Callers that are not generic compile it once.
    #[inline(always)]
    #[doc(hidden)]
    pub fn run<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        self.isa.run(Search { tree: self, query, reach: f64::INFINITY, held: None, collector, evaluate, finish });
    }
}

/// A search as a kernel that is compiled for each instruction set.
pub struct Search<'a, V: VolumeNodes, C> {
    /// The tree that is searched.
    pub tree: &'a PacketTree<V>,
    /// The query point, which is finite.
    pub query: [f64; 3],
    /// An upper bound on the distance of the nearest primitive, or infinity if none is known.
    pub reach: f64,
    /// The packet and the lane of a primitive within the reach, if one is known.
    pub held: Option<(usize, usize)>,
    /// The collector that receives the candidates.
    pub collector: &'a mut C,
    /// Evaluates primitives without stored vertices.
    pub evaluate: EvaluateFn<'a, C>,
    /// Evaluates the pending candidates: [`finish`](evaluate::finish) or [`finish_nearest`](evaluate::finish_nearest).
    pub finish: fn(&mut SearchState<'_, C>),
}

impl<V: VolumeNodes, C: Collector> SimdKernel for Search<'_, V, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let tree = self.tree;
        let Some(local) = V::Node::query(&tree.shared, &tree.frame, &self.query) else { return self.run_far() };
        // The state is created in its final place, because it is large and would otherwise be copied.
        let state = SearchState::new(tree, self.query, self.reach, self.collector, self.evaluate, self.finish);
        let mut visitor = NearestVisitor { state, shared: &tree.shared, local };
        visitor.state.hold(self.held, self.reach);
        traverse::<I, V, _>(tree, &mut visitor);
        visitor.state.evaluate_pending();
    }
}

impl<V: VolumeNodes, C: Collector> Search<'_, V, C> {
    /// Searches in f64 and without filters, for query points and scenes whose distances f32 does not resolve.
    #[cold]
    #[inline(never)]
    fn run_far(self) {
        let Self { tree, query, collector, evaluate, .. } = self;
        let point = Point3::from(query);
        let mut stack = vec![(0.0, tree.root)];
        while let Some((bound, child)) = stack.pop() {
            if collector.is_approximate() && collector.may_stop(false) {
                return collector.record_skipped(stack.iter().fold(bound, |least, pending| least.min(pending.0)));
            }
            if bound > collector.prune_above() || child == NodeRef::NONE {
                continue;
            }
            if child.is_packet() {
                let mut packet = child.number();
                loop {
                    collector.visit_packet();
                    let content = &tree.leaves.packets[packet];
                    for lane in 0..content.ids().len() {
                        let limit = collector.prune_above();
                        offer_outlined(&tree.leaves, content, lane, query, limit, collector, evaluate);
                    }
                    if collector.is_single_nearest() || !tree.leaves.is_rest_wanted(packet, query, collector) {
                        break;
                    }
                    packet += 1;
                }
                continue;
            }
            collector.visit_node();
            let from = stack.len();
            stack.extend(tree.child_boxes(child).map(|(bounds, child)| (bounds.lower_bound(&point), child)));
            sort_nearest_last(&mut stack[from..]);
        }
    }
}

/// Calls [`offer`] without inlining it, so that it is compiled once for all volumes. The slow search does not need
/// inlining.
#[inline(never)]
fn offer_outlined<C: Collector>(
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

/// Sorts children by their bounds, the nearest last. Not generic, so that the sort is compiled once.
fn sort_nearest_last(children: &mut [(f64, NodeRef)]) {
    children.sort_by(|a, b| b.0.total_cmp(&a.0));
}

/// The visitor of a search for the nearest primitives.
struct NearestVisitor<'a, V: VolumeNodes, C> {
    state: SearchState<'a, C>,
    shared: &'a V::Shared,
    local: <V::Node as WideNode>::Query,
}

impl<V: VolumeNodes, C: Collector> Visitor<V> for NearestVisitor<'_, V, C> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        lower_bounds(node, self.shared, &self.local)
    }
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.state.limit()
    }
    #[inline(always)]
    fn visit_node(&mut self) {
        self.state.collector.visit_node();
    }
    #[inline(always)]
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()> {
        let is_inlined = self.state.collector.has_inlined_filters() && is_inlined::<V, I>();
        self.state.packet_inlined_if::<I>(is_inlined, number, self.state.leaves.packets[number].lanes());
        ControlFlow::Continue(())
    }
    #[inline(always)]
    fn may_stop(&self) -> bool {
        self.state.may_stop()
    }
    #[inline(always)]
    fn record_skipped(&mut self, bound: f32) {
        self.state.record_skipped(bound);
    }
}
