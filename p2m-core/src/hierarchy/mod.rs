//! What every tree of this project shares: how primitives are split, how nodes are laid out, how they are searched.
//!
//! Primitives are split top-down into a binary tree by a [`SplitRule`] (`split`, `cost`), which is then collapsed into
//! a [`PacketTree`]: nodes of eight children over packets of sixteen primitives, searched nearest first with vector
//! instructions. Every decision between candidates is left to a [`Collector`](crate::Collector).

mod cost;
mod index;
mod split;
pub(crate) mod wide;

pub use index::TreeIndex;
pub use split::{SplitOptions, SplitRule};
pub use wide::{PacketTree, Part, Volume};

use crate::{Aabb, PrimitiveId, Real};

/// A node of the binary tree: a leaf with `count` primitives from place `first`, or, with `count` 0, the parent of
/// nodes `first` and `first + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node<V> {
    /// Contains everything below the node.
    volume: V,
    first: u32,
    count: u32,
}

impl<V> Node<V> {
    /// The children of an inner node, `None` for a leaf.
    fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.first as usize + 1])
    }

    /// The places in [`Hierarchy::order`] of a leaf's primitives; empty for an inner node.
    fn places(&self) -> std::ops::Range<usize> {
        let first = if self.count == 0 { 0 } else { self.first as usize };
        first..first + self.count as usize
    }
}

/// A binary tree of volumes over a set of primitives. Node 0 is the root; there is none over an empty set. Parents come
/// before children, siblings are side by side.
struct Hierarchy<V> {
    nodes: Vec<Node<V>>,
    /// The primitives in the order of the leaves.
    order: Vec<PrimitiveId>,
}

/// No node lies deeper below the root than this, whatever the input: splits by cost until half of it, by halving from
/// there on, and sets have at most 2^30 primitives. So searches keep their stack in an array.
const MAX_DEPTH: usize = 64;

impl<V> Hierarchy<V> {
    /// Splits primitives with these boxes, which are finite. A leaf's volume joins those of its primitives, a parent's
    /// those of its children.
    ///
    /// O(n log n) time expected, O(n) memory: at most 2 n - 1 nodes.
    fn build<T: Real>(
        boxes: &[Aabb<T>],
        options: &SplitOptions,
        of_primitive: impl Fn(PrimitiveId) -> V,
        join: impl Fn(&V, &V) -> V,
    ) -> Self {
        let (topology, order) = split::build(boxes, options);
        // From the last node to the first, so that children come before their parents: node i lands at `last - i`.
        let last = topology.len().wrapping_sub(1);
        let mut nodes: Vec<Node<V>> = Vec::with_capacity(topology.len());
        for node in topology.iter().rev() {
            let volume = match node.children() {
                Some([a, b]) => join(&nodes[last - a].volume, &nodes[last - b].volume),
                None => {
                    let all = order[node.places()].iter().map(|id| of_primitive(*id));
                    all.reduce(|a, b| join(&a, &b)).expect("every leaf has a primitive")
                }
            };
            nodes.push(Node { volume, first: node.first, count: node.count });
        }
        nodes.reverse();
        Self { nodes, order }
    }
}
