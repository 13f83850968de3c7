//! Builds of trees: a binary tree of splits ([`split`], by a surface-area cost: [`sah`]), which is then collapsed into wide
//! nodes ([`collapse`]).

pub(crate) mod collapse;
mod sah;
mod split;

pub use split::{SplitOptions, SplitRule};

use p2m_core::{Aabb, PrimitiveId, Real};

/// A node of the binary tree: a leaf with `count` primitives from place `first`, or, with `count` 0, the parent of
/// nodes `first` and `first + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node<V> {
    /// Contains everything below the node.
    pub(crate) volume: V,
    first: u32,
    count: u32,
}

impl<V> Node<V> {
    /// The children of an inner node, `None` for a leaf.
    pub(crate) fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.first as usize + 1])
    }

    /// The places in [`Hierarchy::order`] of a leaf's primitives; empty for an inner node.
    pub(crate) fn places(&self) -> std::ops::Range<usize> {
        let first = if self.count == 0 { 0 } else { self.first as usize };
        first..first + self.count as usize
    }
}

/// A binary tree of volumes over a set of primitives. Node 0 is the root; there is none over an empty set. Parents come
/// before children, siblings are side by side.
pub(crate) struct Hierarchy<V> {
    pub(crate) nodes: Vec<Node<V>>,
    /// The primitives in the order of the leaves.
    pub(crate) order: Vec<PrimitiveId>,
}

/// No node lies deeper below the root than this, whatever the input: splits by cost until half of it, by halving from
/// there on, and sets have at most 2^30 primitives. So searches keep their stack in an array.
pub(crate) const MAX_DEPTH: usize = 64;

impl<V> Hierarchy<V> {
    /// Splits primitives with these boxes, which are finite. A leaf's volume joins those of its primitives, a parent's
    /// those of its children.
    ///
    /// O(n log n) time expected, O(n) memory: at most 2 n - 1 nodes.
    pub(crate) fn build<T: Real>(
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
