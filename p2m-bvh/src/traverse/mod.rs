//! The traversal of a tree, nearest child first.
//!
//! The basic idea is a depth-first search with a stack of pending children. A step takes a child, bounds its eight
//! children side by side, and pushes the children within the limit in descending order of their bounds, so that the
//! nearest one is on top. An entry of the stack is one number, a key, which holds the bound in its upper bits and the
//! slot of the child in the lowest ones; keys are sorted as integers. The limit shrinks during a search, so a bound is
//! compared with it again when its entry is popped.

pub(crate) mod box_query;
pub(crate) mod evaluate;
pub(crate) mod groups;
pub(crate) mod interleaved_search;
pub(crate) mod interleaved_traversal;
pub(crate) mod nearest;
pub(crate) mod pairs;
pub(crate) mod primitive_fn;
pub(crate) mod range;
pub(crate) mod ray;
pub(crate) mod search_state;

use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use crate::tree::{MAX_DEPTH, PacketTree};
use p2m_core::engine::simd::{EightLanes, InstructionSet, Lanes, lane_of_key, value_of_key};
use std::ops::ControlFlow;

/// The capacity of a stack. Each level has at most `WIDTH - 1` pending siblings, and `sorted_keys` always writes
/// `WIDTH` entries.
pub(crate) const STACK_LEN: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH;
/// The capacity of the stacks of interleaved searches, which suffices for most trees.
const SHORT_STACK_LEN: usize = 96;
/// The largest depth of a tree for which the stacks of interleaved searches suffice.
const SHORT_STACK_DEPTH: usize = (SHORT_STACK_LEN - WIDTH) / (WIDTH - 1);

/// The part of a traversal that depends on the kind of search.
pub(crate) trait Visitor<V: VolumeNodes> {
    /// Returns bounds on the children of a node, by which these are sorted. No bound is negative.
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L;
    /// Returns the largest bound with which a child is visited.
    fn limit(&self) -> f32;
    /// Called for each node that is visited.
    fn visit_node(&mut self);
    /// Called for each packet that is visited; breaks to end the search.
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()>;
    /// Returns whether the search may stop before everything within the limit was visited. By default it may not.
    #[inline(always)]
    fn may_stop(&self) -> bool {
        false
    }
    /// Called when the traversal stops early. `bound` is a lower bound on everything that was not visited.
    #[inline(always)]
    fn record_skipped(&mut self, bound: f32) {
        let _ = bound;
    }
}

/// The capacity of the stack of a single search, which spills when it is full. It suffices for most searches, and is so
/// small that a few instructions clear it.
const NEAR_STACK_LEN: usize = 64;
/// The keys or the parents of that stack.
type NearStack = [u32; NEAR_STACK_LEN];
/// The number of entries that stay on the stack when it spills.
const KEPT_LEN: usize = NEAR_STACK_LEN / 2;

/// Moves all but the uppermost [`KEPT_LEN`] entries of a full stack to a vector.
#[cold]
#[inline(never)]
fn spill(keys: &mut NearStack, parents: &mut NearStack, below: &mut Vec<(u32, u32)>, top: usize) {
    let moved = top - KEPT_LEN;
    below.extend(keys[..moved].iter().copied().zip(parents[..moved].iter().copied()));
    keys.copy_within(moved..top, 0);
    parents.copy_within(moved..top, 0);
}

/// Moves spilled entries back to the stack, and returns their number.
#[cold]
#[inline(never)]
fn refill(keys: &mut NearStack, parents: &mut NearStack, below: &mut Vec<(u32, u32)>) -> usize {
    let from = below.len().saturating_sub(KEPT_LEN);
    let count = below.len() - from;
    for (i, (key, parent)) in below.drain(from..).enumerate() {
        (keys[i], parents[i]) = (key, parent);
    }
    count
}

/// Traverses a tree with a visitor.
#[inline(always)]
pub(crate) fn traverse<I: InstructionSet, V: VolumeNodes, W: Visitor<V>>(tree: &PacketTree<V>, visitor: &mut W) {
    // The stack: for each pending child its key, which combines its bound and its slot, and its parent node. Children
    // of the same node are in descending order of their keys.
    let mut keys = [0u32; NEAR_STACK_LEN];
    // The two arrays are filled with different values. With equal ones the compiler fills both by one function call,
    // which is slower than a few instructions for each.
    let mut parents = [u32::MAX; NEAR_STACK_LEN];
    // Spilled entries from the bottom of the stack. Only deep trees have some.
    let mut below = Vec::new();
    let mut top = 0;
    let mut at = tree.root;
    if at == NodeRef::NONE {
        return;
    }
    // The bound of the node or packet that is being visited.
    let mut bound = 0.0;
    loop {
        if visitor.may_stop() {
            let pending = keys[..top].iter().map(|key| value_of_key(*key)).fold(bound, f32::min);
            let below = below.iter().map(|(key, _): &(u32, u32)| value_of_key(*key));
            return visitor.record_skipped(below.fold(pending, f32::min));
        }
        if at.is_packet() {
            if visitor.visit_packet::<I>(at.number()).is_break() {
                return;
            }
        } else {
            visitor.visit_node();
            let node = &tree.nodes[at.number()];
            let bounds: I::F32x8 = visitor.bounds(node);
            if top > NEAR_STACK_LEN - WIDTH {
                spill(&mut keys, &mut parents, &mut below, top);
                top = KEPT_LEN;
            }
            let entries: &mut [u32; WIDTH] = (&mut keys[top..top + WIDTH]).try_into().expect("eight keys");
            let count = bounds.sorted_keys(visitor.limit(), entries);
            parents[top..top + WIDTH].fill(at.0);
            // The two nearest children are prefetched without a test of their number, because that branch would be
            // mispredicted. Keys behind the last one are 0, which stands for the first child.
            let last = NEAR_STACK_LEN - 1;
            tree.prefetch(node.children()[lane_of_key(keys[(top + count).wrapping_sub(1).min(last)])]);
            tree.prefetch(node.children()[lane_of_key(keys[(top + count).wrapping_sub(2).min(last)])]);
            if count > 0 {
                top += count - 1;
                bound = value_of_key(keys[top]);
                at = node.children()[lane_of_key(keys[top])];
                continue;
            }
        }
        loop {
            if top == 0 {
                if below.is_empty() {
                    return;
                }
                top = refill(&mut keys, &mut parents, &mut below);
            }
            top -= 1;
            let key = keys[top];
            bound = value_of_key(key);
            if bound <= visitor.limit() {
                at = tree.nodes[NodeRef(parents[top]).number()].children()[lane_of_key(key)];
                break;
            }
        }
    }
}
