//! Nearest-first search over wide nodes and packets.
//!
//! Filters bound distances from both sides, so the search can go through the whole tree before it evaluates a single
//! primitive: it keeps the least upper bound that it has seen, skips what lies above it, and remembers as candidates
//! what may lie below. At the end few are left, mostly one and those that share its nearest feature, and these are
//! offered to the collector, which decides by exact keys. Where the collector wants more than the nearest, candidates
//! are offered packet by packet.

use super::PacketTree;
use super::node::{Child, Query, WIDTH};
use crate::packet::{LANES, Packet};
use crate::simd::{EightLanes, InstructionSet, Lanes, Operation, lane_of_key, number_of_key};
use crate::{Collector, PrimitiveId};

/// Entries of the stack: seven waiting siblings on each level at most, and room for one node to be written whole.
pub(super) const STACK: usize = (WIDTH - 1) * super::MAX_WIDE_DEPTH + WIDTH;
/// Most trees are not deep, and a long stack takes a moment to clear.
const SHORT_STACK: usize = 128;
const SHORT_DEPTH: usize = (SHORT_STACK - WIDTH) / (WIDTH - 1);
/// Candidates that wait for their evaluation.
const CANDIDATES: usize = 32;

/// A search as an operation. `evaluate` offers a primitive to the collector unless its key exceeds a square, `fetch` says
/// that this may happen soon.
pub(super) struct Search<'a, C, E, F> {
    pub(super) tree: &'a PacketTree,
    pub(super) query: [f64; 3],
    pub(super) collector: &'a mut C,
    pub(super) evaluate: E,
    pub(super) fetch: F,
}

impl<C: Collector, E: Fn(&mut C, PrimitiveId, f64), F: Fn(PrimitiveId)> Operation for Search<'_, C, E, F> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let tree = self.tree;
        let Some(local) = tree.frame.query(&self.query) else { return self.run_far() };
        let mut filter = Filter {
            tree,
            query: self.query,
            collector: self.collector,
            evaluate: self.evaluate,
            fetch: self.fetch,
            reach: f64::INFINITY,
            keep: 0.0,
            limit: 0.0,
            waiting: [(0.0, PrimitiveId::new(0)); CANDIDATES],
            count: 0,
        };
        filter.update();
        if tree.depth <= SHORT_DEPTH {
            filter.traverse::<I, SHORT_STACK>(&local);
        } else {
            filter.traverse::<I, STACK>(&local);
        }
        filter.evaluate_waiting();
    }
}

impl<C: Collector, E: Fn(&mut C, PrimitiveId, f64), F: Fn(PrimitiveId)> Search<'_, C, E, F> {
    /// The same in f64 and without filters, for queries and scenes that f32 cannot tell apart.
    #[cold]
    #[inline(never)]
    fn run_far(self) {
        let Self { tree, query, collector, evaluate, .. } = self;
        let query = nalgebra::Point3::from(query);
        let mut stack = vec![(0.0, tree.root)];
        while let Some((bound, child)) = stack.pop() {
            if bound > collector.prune_above() || child == Child::NONE {
                continue;
            }
            if child.is_packet() {
                collector.visit_packet();
                for id in tree.packets[child.number()].ids() {
                    let limit = collector.prune_above();
                    evaluate(collector, *id, limit);
                }
                continue;
            }
            collector.visit_node();
            let from = stack.len();
            let boxes = tree.nodes[child.number()].boxes();
            stack.extend(boxes.map(|(bounds, child)| (tree.frame.disclose(&bounds).lower_bound(&query), child)));
            // The nearest one last.
            stack[from..].sort_by(|a, b| b.0.total_cmp(&a.0));
        }
    }
}

/// The state of a search.
struct Filter<'a, C, E, F> {
    tree: &'a PacketTree,
    query: [f64; 3],
    collector: &'a mut C,
    evaluate: E,
    fetch: F,
    /// Some primitive is known to be at most this far.
    reach: f64,
    /// The distance above which primitives are no candidates.
    keep: f64,
    /// The square above which nodes are skipped, in their frame.
    limit: f32,
    /// Lower bounds of distances, and the primitives.
    waiting: [(f32, PrimitiveId); CANDIDATES],
    count: usize,
}

impl<C: Collector, E: Fn(&mut C, PrimitiveId, f64), F: Fn(PrimitiveId)> Filter<'_, C, E, F> {
    #[inline(always)]
    fn traverse<I: InstructionSet, const STACK: usize>(&mut self, local: &Query) {
        let tree = self.tree;
        // Keys of children in descending order, and whose children they are.
        let mut keys = [0u32; STACK];
        let mut parents = [0u32; STACK];
        let mut top = 0;
        let mut at = tree.root;
        if at == Child::NONE {
            return;
        }
        loop {
            if at.is_packet() {
                self.collector.visit_packet();
                self.packet::<I>(&tree.packets[at.number()]);
            } else {
                self.collector.visit_node();
                let node = &tree.nodes[at.number()];
                let bounds: I::Eight = node.lower_bounds(local);
                let room: &mut [u32; WIDTH] = (&mut keys[top..top + WIDTH]).try_into().expect("eight keys");
                let count = bounds.sorted_keys(self.limit, room);
                parents[top..top + WIDTH].fill(at.0);
                for key in &keys[(top + count).saturating_sub(3).max(top)..top + count] {
                    let child = node.children[lane_of_key(*key)];
                    if child.is_packet() {
                        tree.packets[child.number()].prefetch();
                    } else {
                        tree.nodes[child.number()].prefetch();
                    }
                }
                top += count;
            }
            loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                let key = keys[top];
                if number_of_key(key) <= self.limit {
                    at = tree.nodes[Child(parents[top]).number()].children[lane_of_key(key)];
                    break;
                }
            }
        }
    }

    /// Brings the bounds up to date with the reach and the collector.
    #[inline(always)]
    fn update(&mut self) {
        let bound = self.collector.prune_above().sqrt() * (1.0 + 4.0 * f64::EPSILON);
        self.keep = if self.reach < bound { self.reach } else { bound };
        let square = self.reach * self.reach * (1.0 + 4.0 * f64::EPSILON);
        self.limit = self.tree.frame.square_above(self.collector.prune_given(square));
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up, and places fit")]
    fn packet<I: InstructionSet>(&mut self, packet: &Packet) {
        const ROUND_UP: f32 = 1.0 + 16.0 * f32::EPSILON;
        let Some(local) = packet.local(&self.query) else {
            packet.ids().iter().for_each(|id| self.wait(0.0, *id));
            return;
        };
        let mut squares = [0.0; LANES];
        packet.squares::<I>(&local, &mut squares);
        let lanes = packet.lanes();
        let keep = ((self.keep * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
        let mut found = at_most::<I::Wide>(&squares, keep * keep) & lanes;
        if found == 0 {
            return;
        }
        if self.collector.is_nearest_only() && packet.bounds_above() {
            let reach = (smallest::<I::Wide>(&squares).sqrt() + local.deficit) * ROUND_UP;
            let here = f64::from(reach) * packet.unit();
            if here < self.reach {
                self.reach = here;
                self.update();
                let keep = (reach + local.excess) * ROUND_UP;
                found &= at_most::<I::Wide>(&squares, keep * keep);
            }
        }
        while found != 0 {
            let lane = found.trailing_zeros() as usize;
            found &= found - 1;
            let low = squares[lane].sqrt() * (1.0 - f32::EPSILON) - local.excess;
            // In the frame of the scene, where f32 has room; a difference of f32 about 1 or above does not underflow.
            let low = f64::from(low) * packet.unit() * self.tree.frame.per_unit;
            self.wait(low as f32, packet.ids()[lane]);
        }
        if !self.collector.is_nearest_only() {
            self.evaluate_waiting();
        }
    }

    #[inline(always)]
    fn wait(&mut self, low: f32, id: PrimitiveId) {
        if self.count == CANDIDATES {
            self.evaluate_waiting();
        }
        (self.fetch)(id);
        self.waiting[self.count] = (low, id);
        self.count += 1;
    }

    /// Evaluates the candidates that are still of interest, the most promising one first.
    #[inline(always)]
    fn evaluate_waiting(&mut self) {
        let waiting = &mut self.waiting[..self.count];
        if let Some(first) = (0..waiting.len()).min_by(|a, b| waiting[*a].0.total_cmp(&waiting[*b].0)) {
            waiting.swap(0, first);
        }
        for i in 0..self.count {
            let (low, id) = self.waiting[i];
            // Less for its rounding.
            if f64::from(low) * (1.0 - f64::from(f32::EPSILON)) * self.tree.frame.unit <= self.keep {
                // The reach is at least a unit of a frame: its square does not underflow, as that of a bound on keys may.
                let reach = self.reach * self.reach * (1.0 + 4.0 * f64::EPSILON);
                let prune = self.collector.prune_above();
                (self.evaluate)(self.collector, id, if reach < prune { reach } else { prune });
                self.update();
            }
        }
        self.count = 0;
    }
}

/// One bit for each square that is at most `limit`.
#[inline(always)]
fn at_most<L: Lanes>(squares: &[f32; LANES], limit: f32) -> u32 {
    let mut mask = 0;
    let mut at = 0;
    while at < LANES {
        mask |= L::load(&squares[at..]).at_most(L::splat(limit)) << at;
        at += L::LEN;
    }
    mask
}

#[inline(always)]
fn smallest<L: Lanes>(squares: &[f32; LANES]) -> f32 {
    let mut all = L::load(&squares[..]);
    let mut at = L::LEN;
    while at < LANES {
        all = all.min(L::load(&squares[at..]));
        at += L::LEN;
    }
    all.smallest()
}
