//! The binary tree of splits with volumes.

use crate::build::options::SplitOptions;
use crate::build::split::{SplitNode, split};
use p2m_core::{Aabb, PrimitiveId, Real};

/// A binary tree of volumes over a set of primitives.
///
/// Node 0 is the root; an empty set has no nodes. Parents come before children, and siblings are side by side.
pub(crate) struct SplitTree<V> {
    pub(crate) nodes: Vec<SplitNode<V>>,
    /// The primitives in the order of the leaves.
    pub(crate) order: Vec<PrimitiveId>,
}

impl<V> SplitTree<V> {
    /// Splits primitives with these boxes, which have to be finite. The volume of a leaf joins those of its primitives,
    /// and the volume of a parent joins those of its children.
    ///
    /// The tree takes O(n log n) expected time and O(n) memory: it has at most 2 n - 1 nodes.
    pub(crate) fn build<T: Real>(
        boxes: &[Aabb<T>],
        options: &SplitOptions,
        volume_of: impl Fn(PrimitiveId) -> V,
        join: impl Fn(&V, &V) -> V,
    ) -> Self {
        let (topology, order) = split(boxes, options);
        // The loop runs from the last node to the first, so that children come before their parents. Node i is pushed
        // at the index `last - i`.
        let last = topology.len().wrapping_sub(1);
        let mut nodes: Vec<SplitNode<V>> = Vec::with_capacity(topology.len());
        for node in topology.iter().rev() {
            let volume = match node.children() {
                Some([a, b]) => join(&nodes[last - a].volume, &nodes[last - b].volume),
                None => {
                    let all = order[node.range()].iter().map(|id| volume_of(*id));
                    all.reduce(|a, b| join(&a, &b)).expect("every leaf has a primitive")
                }
            };
            nodes.push(SplitNode { volume, first: node.first, count: node.count });
        }
        nodes.reverse();
        Self { nodes, order }
    }
}
