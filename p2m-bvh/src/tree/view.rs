//! Going through a tree from outside: what pairs of trees and pictures need.

use crate::tree::PacketTree;
use crate::tree::aabb_node::NodeRef;
use crate::tree::volume::{Volume, WideNode};
use p2m_core::{Aabb, PrimitiveId};
use std::ops::ControlFlow;

/// A node or a packet of a tree, with its volume.
#[derive(Clone, Copy, Debug)]
pub struct TreeNode<V> {
    /// Around everything below it, rounded outwards by 2^-22 of the longest side of the scene's box and 2^-48 of the
    /// distance of its middle from the origin at most.
    pub volume: V,
    /// How far below the root, which is at 0.
    pub depth: usize,
    child: NodeRef,
}

impl<V: Volume> PacketTree<V> {
    /// The root; `None` for an empty set.
    pub fn root(&self) -> Option<TreeNode<V>> {
        let volume = || V::Node::volume(&self.whole, &self.shape, &self.frame);
        (self.root != NodeRef::NONE).then(|| TreeNode { volume: volume(), depth: 0, child: self.root })
    }

    /// The children of a node of this tree; none for a packet.
    pub fn children(&self, part: &TreeNode<V>) -> impl Iterator<Item = TreeNode<V>> + '_ {
        let node = (!part.child.is_packet()).then(|| &self.nodes[part.child.number()]);
        let depth = part.depth + 1;
        node.into_iter().flat_map(move |node| {
            node.used().map(move |place| TreeNode {
                volume: V::Node::volume(&node.at(place), &self.shape, &self.frame),
                depth,
                child: node.children()[place],
            })
        })
    }

    /// The primitives of a packet of this tree; `None` for a node.
    pub fn primitives(&self, part: &TreeNode<V>) -> Option<&[PrimitiveId]> {
        part.child.is_packet().then(|| self.leaves.packets[part.child.number()].ids())
    }

    /// All nodes and packets, parents before children.
    pub fn parts(&self) -> impl Iterator<Item = TreeNode<V>> + '_ {
        let mut open: Vec<TreeNode<V>> = self.root().into_iter().collect();
        std::iter::from_fn(move || {
            let part = open.pop()?;
            open.extend(self.children(&part));
            Some(part)
        })
    }
}

impl<V: Volume> PacketTree<V> {
    /// QueryCost the leaves that may meet a box, by their volumes, until `visit` breaks. [`BoxQuery`](p2m_core::BoxQuery)
    /// tells exactly which primitives do.
    pub fn visit_leaves_in_box(
        &self,
        bounds: &Aabb<f64>,
        mut visit: impl FnMut(&[PrimitiveId]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut open: Vec<_> = self.root().into_iter().collect();
        while let Some(part) = open.pop() {
            if bounds.is_empty() || !part.volume.may_meet_box(self.directions(), bounds) {
                continue;
            }
            match self.primitives(&part) {
                Some(ids) => visit(ids)?,
                None => open.extend(self.children(&part)),
            }
        }
        ControlFlow::Continue(())
    }
}
