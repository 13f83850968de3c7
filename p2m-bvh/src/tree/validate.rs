//! The validation of a tree from a file.
//!
//! The checks take one pass over the nodes, the packets and the exact vertices. They cover everything that searches
//! need in order to end without a panic: all numbers are in range, each node and each packet is used once, and stacks
//! have room for the depth. They do not cover bounds, which can only make answers wrong.

use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use crate::tree::{Leaves, MAX_DEPTH, PacketTree};
use p2m_core::PrimitiveId;
use p2m_core::storage::{LoadError, check_chunks, require};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

/// The section with the references of the nodes.
pub(super) const CHILDREN: &str = "tree/children";
/// The section with the packets.
pub(super) const PACKETS: &str = "tree/packets";
/// The section with the exact vertices.
pub(super) const VERTICES: &str = "tree/vertices";
/// The section with the index of the first vertex of each packet.
pub(super) const VERTEX_OFFSETS: &str = "tree/first-vertices";

/// The nodes and packets that have been referred to.
struct Referenced {
    /// The depth of each node, or 0 as long as no reference to it was found.
    depths: Vec<usize>,
    packets: Vec<bool>,
}

impl Referenced {
    /// Records a reference to a node or a packet at a depth.
    fn add(&mut self, reference: NodeRef, depth: usize) -> Result<(), LoadError> {
        let number = reference.number();
        let is_new = if reference.is_packet() {
            self.packets.get_mut(number).map(|is_used| !std::mem::replace(is_used, true))
        } else {
            self.depths.get_mut(number).map(|known| std::mem::replace(known, depth) == 0)
        };
        require(is_new.is_some(), CHILDREN, "a node or a packet does not exist")?;
        require(is_new == Some(true), CHILDREN, "a node or a packet is used twice")
    }
}

/// Checks the references of all nodes and returns the number of nodes on the longest path from the root. A node that
/// comes before its parent is refused, because such references could form a cycle.
pub(super) fn check_references<V: VolumeNodes>(tree: &PacketTree<V>) -> Result<usize, LoadError> {
    let mut referenced =
        Referenced { depths: vec![0; tree.nodes.len()], packets: vec![false; tree.leaves.packets.len()] };
    if tree.root != NodeRef::NONE {
        referenced.add(tree.root, 1)?;
    }
    let mut longest = 0;
    for (number, node) in tree.nodes.iter().enumerate() {
        let depth = referenced.depths[number];
        require(depth > 0, CHILDREN, "a node comes before its parent or has none")?;
        require(depth <= MAX_DEPTH, CHILDREN, "the tree is too deep")?;
        longest = longest.max(depth);
        require(node.used_slots().next().is_some(), CHILDREN, "a node has no child")?;
        node.used_slots().try_for_each(|slot| referenced.add(node.children()[slot], depth + 1))?;
    }
    for (packet, _) in tree.leaves.packets.iter().enumerate().filter(|(_, packet)| packet.is_continued()) {
        require(referenced.packets[packet], CHILDREN, "a packet is not used")?;
        referenced.add(NodeRef::packet(packet + 1), 0)?;
    }
    require(!referenced.packets.contains(&false), CHILDREN, "a packet is not used")?;
    Ok(longest)
}

/// Checks the packets of a tree over this number of primitives, and their exact vertices.
pub(super) fn check_leaves(leaves: &Leaves, primitives: usize) -> Result<(), LoadError> {
    let Leaves { packets, vertices, vertex_offsets, .. } = leaves;
    require(primitives <= PrimitiveId::MAX_COUNT, PACKETS, "there are too many primitives")?;
    require(vertex_offsets.len() == packets.len() + 1, VERTEX_OFFSETS, "there is not one offset for each packet")?;
    let (first, last) = (vertex_offsets[0] as usize, vertex_offsets[packets.len()] as usize);
    require(first == 0 && last == vertices.len(), VERTEX_OFFSETS, "the offsets do not cover all vertices")?;
    check_chunks(vertices, |_, chunk| {
        // A fold without an early exit is vectorised.
        let are_finite = chunk.as_flattened().iter().fold(true, |all, x| all & x.is_finite());
        require(are_finite, VERTICES, "a coordinate is not finite")
    })?;
    let is_id_used: Vec<AtomicBool> = std::iter::repeat_with(AtomicBool::default).take(primitives).collect();
    let is_new = |id: &PrimitiveId| is_id_used.get(id.index()).is_some_and(|is_used| !is_used.swap(true, Relaxed));
    check_chunks(packets, |first, chunk| {
        for (packet, offsets) in chunk.iter().zip(vertex_offsets[first..].windows(2)) {
            require(offsets[0] <= offsets[1], VERTEX_OFFSETS, "the offsets are not in ascending order")?;
            require(packet.has_valid_fields(offsets[0], offsets[1]), PACKETS, "a number is out of range")?;
            require(packet.ids().iter().all(is_new), PACKETS, "an id is wrong")?;
        }
        Ok(())
    })?;
    require(is_id_used.into_iter().all(AtomicBool::into_inner), PACKETS, "a primitive is missing")
}
