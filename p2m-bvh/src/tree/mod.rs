//! A tree of nodes with eight children over packets.
//!
//! A node is a few cache lines with the bounds of eight children side by side ([`wide_node`]; boxes are in
//! [`aabb_node`], k-DOPs in the crate p2m-kdop). A leaf is a [`Packet`] of up to sixteen primitives. Both are stored in
//! f32 or less, in a [`Frame`] of their own, and only bound distances. The functions that build and search a tree are
//! in the modules `construct` and `traverse` of this crate.

pub(crate) mod aabb_node;
pub(crate) mod frame;
pub(crate) mod frame_line;
pub(crate) mod node_ref;
pub(crate) mod ray_slab;
pub(crate) mod rounded;
mod saved;
mod validate;
pub(crate) mod view;
pub(crate) mod wide_node;

use crate::packet::Packet;
use frame::Frame;
use node_ref::NodeRef;
use p2m_core::engine::simd::{Isa, prefetch_lines};
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{Aabb, Collector, PrimitiveId};
use std::sync::OnceLock;
use wide_node::{VolumeNodes, WideNode};

/// The most nodes on a path from the root, which every build guarantees. So searches can keep their stack in an array.
pub(crate) const MAX_DEPTH: usize = 66;

/// A tree over a set of primitives that it does not contain. Every method that needs the set has to get the same one.
#[derive(Clone, Debug)]
pub struct PacketTree<V: VolumeNodes = Aabb<f64>> {
    pub(crate) isa: Isa,
    /// The data that all volumes share.
    pub(crate) shared: V::Shared,
    /// The frame of the nodes.
    #[doc(hidden)]
    pub frame: Frame,
    pub(crate) bounds: Aabb<f64>,
    /// Half of the extent of the box, enlarged for searches with rays.
    pub(crate) half_extent: [f64; 3],
    /// The bounds of the whole scene, in the form of the nodes.
    pub(crate) root_bounds: <V::Node as WideNode>::Bounds,
    /// The root, which is [`NodeRef::NONE`] for an empty set.
    #[doc(hidden)]
    pub root: NodeRef,
    /// The number of nodes on the longest path from the root.
    pub(crate) depth: usize,
    pub(crate) nodes: Vec<V::Node>,
    /// The packets and their exact vertices.
    #[doc(hidden)]
    pub leaves: Leaves,
    /// The number of primitives.
    pub(crate) len: usize,
    /// The least id of each node, computed when a search for pairs first needs it.
    pub(crate) least_ids: OnceLock<Vec<PrimitiveId>>,
}

/// The packets of a tree with their exact vertices.
#[derive(Clone, Debug)]
pub struct Leaves {
    /// The packets in the order of the leaves.
    pub packets: Array<Packet>,
    /// The exact vertices of the packets, one packet after the other.
    pub vertices: Array<[f64; 3]>,
    /// The index of the first vertex of each packet, and the number of all vertices. They are in an array of their own,
    /// which stays in the cache, so that vertices can be prefetched together with their packet.
    pub(crate) vertex_offsets: Array<u32>,
    /// Whether a packet has primitives other than triangles.
    pub(crate) has_non_triangles: bool,
}

impl<V: VolumeNodes> PacketTree<V> {
    /// Returns the box around the whole scene, which is the empty box for an empty set.
    #[must_use]
    pub fn bounds(&self) -> &Aabb<f64> {
        &self.bounds
    }

    /// Returns the number of nodes on the longest path from the root.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Returns the children of a node, with boxes around them.
    #[doc(hidden)]
    pub fn child_boxes(&self, node: NodeRef) -> impl Iterator<Item = (Aabb<f64>, NodeRef)> + '_ {
        let node = &self.nodes[node.number()];
        node.used_slots().map(|slot| (self.child_box(node, slot), node.children()[slot]))
    }

    /// Returns a box around the child in a slot of a node.
    pub(crate) fn child_box(&self, node: &V::Node, slot: usize) -> Aabb<f64> {
        V::Node::scene_box(&node.bounds(slot), &self.shared, &self.frame)
    }

    /// Returns the least id of a node or a packet. The first call for a node takes O(n).
    pub(crate) fn least_id(&self, node: NodeRef) -> PrimitiveId {
        let of_packet =
            |packet: usize| *self.leaves.packets[packet].ids().iter().min().expect("a packet has primitives");
        if node.is_packet() {
            return of_packet(node.number());
        }
        let least_ids = self.least_ids.get_or_init(|| {
            let mut least_ids = vec![PrimitiveId::new(0); self.nodes.len()];
            // Backwards, because children come after their parents.
            for (number, node) in self.nodes.iter().enumerate().rev() {
                let children = node.used_slots().map(|slot| node.children()[slot]);
                let ids = children.map(|child| match child.is_packet() {
                    true => of_packet(child.number()),
                    false => least_ids[child.number()],
                });
                least_ids[number] = ids.min().expect("a node has children");
            }
            least_ids
        });
        least_ids[node.number()]
    }

    /// Prefetches a node or a packet.
    #[inline(always)]
    pub(crate) fn prefetch(&self, child: NodeRef) {
        let (node, packet) = (self.nodes.as_ptr(), self.leaves.packets.as_ptr());
        let address: *const u8 = if child.is_packet() {
            packet.wrapping_add(child.number()).cast()
        } else {
            node.wrapping_add(child.number()).cast()
        };
        // A packet has seven cache lines, and few nodes have more. The lines behind a smaller node mostly belong to its
        // sibling.
        prefetch_lines(address, size_of::<Packet>().max(size_of::<V::Node>()));
    }

    /// Returns the instruction set that searches use.
    #[must_use]
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// Returns the tree with another instruction set for its searches. Bounds may then differ in their last bits, and
    /// so may the number of visited nodes, but answers do not.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// Returns the heap memory of the tree, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.nodes.capacity() * size_of::<V::Node>()
            + self.leaves.packets.memory()
            + self.leaves.vertices.memory()
            + self.leaves.vertex_offsets.memory()
            + self.least_ids.get().map_or(0, |ids| ids.capacity() * size_of::<PrimitiveId>())
    }

    /// Returns a mask of the used lanes for each packet.
    #[doc(hidden)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "a packet has sixteen lanes")]
    pub fn lane_masks(&self) -> Vec<u16> {
        self.leaves.packets.iter().map(|packet| packet.lanes() as u16).collect()
    }

    /// Returns the number of packets, and the number of their used lanes.
    #[must_use]
    pub fn packets(&self) -> (usize, usize) {
        (self.leaves.packets.len(), self.len)
    }
}

impl Leaves {
    /// Returns whether a packet is continued, and the primitives of the next packet may be part of the answer. They
    /// have the same keys as this packet's primitives and higher ids.
    #[inline(always)]
    pub(crate) fn is_rest_wanted(&self, number: usize, query: V3, collector: &impl Collector) -> bool {
        let packet = &self.packets[number];
        packet.is_continued() && {
            let limit = collector.prune_above_for_id(self.packets[number + 1].ids()[0]);
            // A limit above the general one means that the collector does not compare keys.
            limit > collector.prune_above() || (limit >= 0.0 && packet.is_lane_within(0, &self.vertices, query, limit))
        }
    }
    /// Returns a packet and the packets that continue its run.
    pub(crate) fn run(&self, number: usize) -> impl Iterator<Item = &Packet> {
        let rest = &self.packets[number..];
        let len = 1 + rest.iter().take_while(|packet| packet.is_continued()).count();
        rest[..len].iter()
    }

    /// Prefetches a packet.
    #[inline(always)]
    #[doc(hidden)]
    pub fn prefetch(&self, number: usize) {
        prefetch_lines(self.packets.as_ptr().wrapping_add(number), size_of::<Packet>());
    }

    /// Prefetches the exact vertices of a packet, up to eight cache lines of them.
    #[inline(always)]
    #[doc(hidden)]
    pub fn prefetch_vertices(&self, number: usize) {
        let [first, end] = [self.vertex_offsets[number], self.vertex_offsets[number + 1]].map(|offset| offset as usize);
        let bytes = (end - first) * size_of::<[f64; 3]>();
        prefetch_lines(self.vertices.as_ptr().wrapping_add(first), bytes.min(8 * 64));
    }
}
