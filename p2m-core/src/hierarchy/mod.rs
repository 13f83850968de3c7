//! What every tree of this project shares: how primitives are split, how nodes are numbered, how they are searched.
//!
//! A [`Hierarchy`] is a binary tree over a permutation of the primitives and knows nothing of volumes: an AABB tree
//! keeps a box beside each node, a k-DOP tree its heights. Searching takes two closures, the lower bound of a node and
//! the visit of a leaf, and leaves every decision to a [`Collector`](crate::Collector).

mod cost;
mod overlap;
mod search;
mod split;

pub use overlap::Overlap;
pub use split::{SplitOptions, SplitRule};

use crate::{Aabb, PrimitiveId, Real};

/// A node: a leaf with `count` primitives from place `first`, or, with `count` 0, the parent of nodes `first` and
/// `first + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<V> {
    /// Contains everything below the node.
    pub volume: V,
    first: u32,
    count: u32,
}

impl<V> Node<V> {
    /// The children of an inner node, `None` for a leaf.
    #[inline(always)]
    #[must_use]
    pub fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.first as usize + 1])
    }

    /// The places in [`Hierarchy::order`] of a leaf's primitives; empty for an inner node.
    #[inline(always)]
    #[must_use]
    pub fn places(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// A binary tree of volumes over a set of primitives. Node 0 is the root; there is none over an empty set.
///
/// No node lies deeper than [`MAX_DEPTH`], whatever the input, so searches keep their stack in an array.
#[derive(Clone, Debug)]
pub struct Hierarchy<V> {
    nodes: Vec<Node<V>>,
    order: Vec<PrimitiveId>,
}

/// No node lies deeper below the root than this: splits by cost until half of it, by halving from there on, and sets
/// have at most 2^30 primitives.
pub const MAX_DEPTH: usize = 64;

impl<V> Hierarchy<V> {
    /// Splits primitives with these boxes, which are finite. A leaf's volume joins those of its primitives, a parent's
    /// those of its children.
    ///
    /// # Panics
    /// Never: every leaf has a primitive.
    ///
    /// # Complexity
    /// O(n log n) time expected, O(n) memory: at most 2 n - 1 nodes.
    #[must_use]
    pub fn build<T: Real>(
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

    /// The nodes, parents before children, siblings side by side.
    #[must_use]
    pub fn nodes(&self) -> &[Node<V>] {
        &self.nodes
    }

    /// The primitives in the order of the leaves.
    #[must_use]
    pub fn order(&self) -> &[PrimitiveId] {
        &self.order
    }

    /// How deep each node lies below the root, in the order of [`nodes`](Self::nodes).
    #[must_use]
    pub fn depths(&self) -> Vec<u8> {
        let mut depths = vec![0; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate() {
            for child in node.children().into_iter().flatten() {
                depths[child] = depths[at] + 1;
            }
        }
        depths
    }

    /// Heap memory it owns, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.nodes.capacity() * size_of::<Node<V>>() + self.order.capacity() * size_of::<PrimitiveId>()
    }
}
