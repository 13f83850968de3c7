//! A view of the nodes of a tree, for visualisation.

use crate::tree::PacketTree;
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::{Aabb, PrimitiveId};

/// A node or a packet of a tree, with its volume.
#[derive(Clone, Copy, Debug)]
pub struct TreeNode<V> {
    /// The volume around everything below the node. It is rounded outwards by at most 2^-22 of the longest side of the
    /// scene's box and 2^-48 of the distance of the box's centre from the origin.
    pub volume: V,
    /// The level of the node below the root, which is at level 0.
    pub depth: usize,
    reference: NodeRef,
}

impl<V: VolumeNodes> PacketTree<V> {
    /// Returns the root, or `None` for an empty set.
    pub fn root(&self) -> Option<TreeNode<V>> {
        let volume = || V::Node::scene_volume(&self.root_bounds, &self.shared, &self.frame);
        (self.root != NodeRef::NONE).then(|| TreeNode { volume: volume(), depth: 0, reference: self.root })
    }

    /// Returns the children of a node of this tree. A packet has no children, except in a run of packets with the same
    /// vertices, where the next packet counts as its child.
    pub fn children(&self, node: &TreeNode<V>) -> impl Iterator<Item = TreeNode<V>> + '_ {
        let wide = (!node.reference.is_packet()).then(|| &self.nodes[node.reference.number()]);
        let depth = node.depth + 1;
        let of_node = wide.into_iter().flat_map(move |wide| {
            wide.used_slots().map(move |slot| TreeNode {
                volume: V::Node::scene_volume(&wide.bounds(slot), &self.shared, &self.frame),
                depth,
                reference: wide.children()[slot],
            })
        });
        let number = node.reference.number();
        let is_continued = node.reference.is_packet() && self.leaves.packets[number].is_continued();
        let next = is_continued.then(|| TreeNode {
            volume: node.volume.clone(),
            depth,
            reference: NodeRef::packet(number + 1),
        });
        of_node.chain(next)
    }

    /// Returns the primitives of a packet of this tree, or `None` if the node is not a packet.
    pub fn primitives(&self, node: &TreeNode<V>) -> Option<&[PrimitiveId]> {
        node.reference.is_packet().then(|| self.leaves.packets[node.reference.number()].ids())
    }

    /// Returns the sum of the surface areas of the boxes of all nodes and packets below the root.
    pub fn surface_area(&self) -> f64 {
        let area = |bounds: Aabb<f64>| {
            let size = bounds.max - bounds.min;
            2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
        };
        let children = self.nodes.iter().flat_map(|node| node.used_slots().map(|slot| self.child_box(node, slot)));
        children.map(area).sum()
    }

    /// Returns all nodes and packets of the tree, parents before their children.
    pub fn parts(&self) -> impl Iterator<Item = TreeNode<V>> + '_ {
        let mut pending: Vec<TreeNode<V>> = self.root().into_iter().collect();
        std::iter::from_fn(move || {
            let node = pending.pop()?;
            pending.extend(self.children(&node));
            Some(node)
        })
    }
}
