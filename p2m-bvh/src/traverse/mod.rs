//! The way through the nodes, the nearest child first.

pub(crate) mod box_query;
pub(crate) mod nearest;
pub(crate) mod range;
pub(crate) mod ray;
pub(crate) mod ray_slab;

use crate::tree::aabb_node::{NodeRef, WIDTH};
use crate::tree::volume::{Volume, WideNode};
use crate::tree::{MAX_WIDE_DEPTH, PacketTree};
use p2m_core::engine::simd::{EightLanes, InstructionSet, Lanes, lane_of_key, number_of_key};
use std::ops::ControlFlow;

/// Entries of the stack: seven waiting siblings on each level at most, and room for one node to be written whole.
pub(crate) const STACK: usize = (WIDTH - 1) * MAX_WIDE_DEPTH + WIDTH;
/// Most trees are not deep, and a long stack takes a moment to clear.
const SHORT_STACK: usize = 96;
const SHORT_DEPTH: usize = (SHORT_STACK - WIDTH) / (WIDTH - 1);

/// What goes through the nodes.
pub(crate) trait Walk<V: Volume> {
    /// Numbers by which the children of a node are taken in turn, none of them negative.
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L;
    /// Children above this number are left out.
    fn limit(&self) -> f32;
    /// A node is visited.
    fn visit_node(&mut self);
    /// A packet is visited; breaks to end the search.
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()>;
    /// Whether the search ends although there is more to visit: that is then [given up](Self::forgo). Not by default.
    #[inline(always)]
    fn is_content(&self) -> bool {
        false
    }
    /// What has this number and those above it are not visited.
    #[inline(always)]
    fn forgo(&mut self, bound: f32) {
        let _ = bound;
    }
}

/// Goes through a tree.
#[inline(always)]
pub(crate) fn walk<I: InstructionSet, V: Volume, W: Walk<V>>(tree: &PacketTree<V>, walk: &mut W) {
    if tree.depth <= SHORT_DEPTH {
        walk_with::<I, V, W, SHORT_STACK>(tree, walk);
    } else {
        walk_with::<I, V, W, STACK>(tree, walk);
    }
}

#[inline(always)]
fn walk_with<I: InstructionSet, V: Volume, W: Walk<V>, const STACK: usize>(tree: &PacketTree<V>, walk: &mut W) {
    // Keys of children in descending order, and whose children they are.
    let mut keys = [0u32; STACK];
    let mut parents = [0u32; STACK];
    let mut top = 0;
    let mut at = tree.root;
    if at == NodeRef::NONE {
        return;
    }
    // Of the child that is visited.
    let mut bound = 0.0;
    loop {
        if walk.is_content() {
            let waiting = keys[..top].iter().map(|key| number_of_key(*key));
            return walk.forgo(waiting.fold(bound, f32::min));
        }
        if at.is_packet() {
            if walk.visit_packet::<I>(at.number()).is_break() {
                return;
            }
        } else {
            walk.visit_node();
            let node = &tree.nodes[at.number()];
            let bounds: I::Eight = walk.bounds(node);
            let room: &mut [u32; WIDTH] = (&mut keys[top..top + WIDTH]).try_into().expect("eight keys");
            let count = bounds.sorted_keys(walk.limit(), room);
            parents[top..top + WIDTH].fill(at.0);
            // The nearest one and the next, whatever they are: a branch would be mispredicted. The keys behind the
            // last are 0, which is the first child.
            tree.prefetch(node.children()[lane_of_key(keys[(top + count).wrapping_sub(1).min(STACK - 1)])]);
            tree.prefetch(node.children()[lane_of_key(keys[(top + count).wrapping_sub(2).min(STACK - 1)])]);
            if count > 0 {
                top += count - 1;
                bound = number_of_key(keys[top]);
                at = node.children()[lane_of_key(keys[top])];
                continue;
            }
        }
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            let key = keys[top];
            bound = number_of_key(key);
            if bound <= walk.limit() {
                at = tree.nodes[NodeRef(parents[top]).number()].children()[lane_of_key(key)];
                break;
            }
        }
    }
}
