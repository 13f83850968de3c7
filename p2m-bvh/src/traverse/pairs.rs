//! Searches for near pairs of primitives: of a tree and a shape, or of two trees, one of which may have moved.
//!
//! A search holds pairs of nodes, of which one is cut into its children at a time: the one with the larger box. Pairs
//! whose boxes are farther apart than the best pair so far are left out. The gap of two boxes never exceeds the key of
//! primitives in them (docs/proofs/pairs.md), so there is no slack, and the answer is that of all pairs.
//!
//! The motion of a tree is applied to the vertices of its packets, each coordinate rounded, and to the boxes of its
//! nodes with a margin above all roundings.

use crate::packet::LANES;
use crate::tree::PacketTree;
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::engine::vector::V3;
use p2m_core::pair::{Motion, Pairs, bounds_of, nearest_of_hulls};
use p2m_core::{Aabb, PrimitiveId};

/// One of the two sides of a search.
pub(crate) trait Side {
    /// Returns the root with its box; `None` if there is nothing.
    fn root(&self) -> Option<(NodeRef, Aabb<f64>)>;
    /// Adds the children of a node with their boxes.
    fn children(&self, node: NodeRef, add: &mut dyn FnMut(NodeRef, Aabb<f64>));
    /// Loads the primitives of a packet.
    fn load(&self, packet: NodeRef, primitives: &mut Hulls);
}

/// The primitives of a packet, as hulls of vertices.
pub(crate) struct Hulls {
    /// The packet that is loaded.
    packet: NodeRef,
    len: usize,
    /// The number of vertices of each hull.
    vertex_counts: [usize; LANES],
    vertices: [[V3; 3]; LANES],
    boxes: [Aabb<f64>; LANES],
    ids: [PrimitiveId; LANES],
}

impl Hulls {
    fn new() -> Self {
        Self {
            packet: NodeRef::NONE,
            len: 0,
            vertex_counts: [0; LANES],
            vertices: [[[0.0; 3]; 3]; LANES],
            boxes: [Aabb::empty(); LANES],
            ids: [PrimitiveId::new(0); LANES],
        }
    }

    fn set(&mut self, i: usize, id: PrimitiveId, vertices: &[V3]) {
        self.vertices[i][..vertices.len()].copy_from_slice(vertices);
        (self.vertex_counts[i], self.boxes[i], self.ids[i]) = (vertices.len(), bounds_of(vertices), id);
    }

    fn hull(&self, i: usize) -> &[V3] {
        &self.vertices[i][..self.vertex_counts[i]]
    }
}

/// A single shape of one to three vertices, which is a tree of one packet.
pub(crate) struct ShapeSide<'a>(pub(crate) &'a [V3]);

impl Side for ShapeSide<'_> {
    fn root(&self) -> Option<(NodeRef, Aabb<f64>)> {
        Some((NodeRef::packet(0), bounds_of(self.0)))
    }

    fn children(&self, _: NodeRef, _: &mut dyn FnMut(NodeRef, Aabb<f64>)) {}

    fn load(&self, _: NodeRef, primitives: &mut Hulls) {
        primitives.len = 1;
        primitives.set(0, PrimitiveId::new(0), self.0);
    }
}

/// A tree where it is.
pub(crate) struct TreeSide<'a, V: VolumeNodes>(pub(crate) &'a PacketTree<V>);

impl<V: VolumeNodes> TreeSide<'_, V> {
    fn load_moved(&self, packet: NodeRef, primitives: &mut Hulls, motion: impl Fn(V3) -> V3) {
        let leaves = &self.0.leaves;
        let packet = &leaves.packets[packet.number()];
        let ids = packet.ids();
        primitives.len = ids.len();
        for (lane, id) in ids.iter().enumerate() {
            let (indices, count) = packet.vertices_of(lane);
            assert!(count > 0, "distances between primitives are defined for those that have vertices");
            let vertices = indices.map(|index| motion(leaves.vertices[index]));
            primitives.set(lane, *id, &vertices[..count]);
        }
    }
}

impl<V: VolumeNodes> Side for TreeSide<'_, V> {
    fn root(&self) -> Option<(NodeRef, Aabb<f64>)> {
        (self.0.root != NodeRef::NONE).then_some((self.0.root, self.0.bounds))
    }

    fn children(&self, node: NodeRef, add: &mut dyn FnMut(NodeRef, Aabb<f64>)) {
        let wide = &self.0.nodes[node.number()];
        for slot in wide.used_slots() {
            add(wide.children()[slot], self.0.child_box(wide, slot));
        }
    }

    fn load(&self, packet: NodeRef, primitives: &mut Hulls) {
        self.load_moved(packet, primitives, |vertex| vertex);
    }
}

/// A tree that has moved.
pub(crate) struct MovedSide<'a, V: VolumeNodes> {
    pub(crate) tree: TreeSide<'a, V>,
    pub(crate) motion: Motion,
}

impl<V: VolumeNodes> Side for MovedSide<'_, V> {
    fn root(&self) -> Option<(NodeRef, Aabb<f64>)> {
        self.tree.root().map(|(root, bounds)| (root, self.motion.apply_to_box(&bounds)))
    }

    fn children(&self, node: NodeRef, add: &mut dyn FnMut(NodeRef, Aabb<f64>)) {
        self.tree.children(node, &mut |child, bounds| add(child, self.motion.apply_to_box(&bounds)));
    }

    fn load(&self, packet: NodeRef, primitives: &mut Hulls) {
        self.tree.load_moved(packet, primitives, |vertex| self.motion.apply(vertex));
    }
}

/// Two nodes that may contain a near pair, with their boxes and the square of the gap between these.
#[derive(Clone, Copy)]
struct NodePair {
    gap: f64,
    nodes: [NodeRef; 2],
    boxes: [Aabb<f64>; 2],
}

impl NodePair {
    fn new(a: (NodeRef, Aabb<f64>), b: (NodeRef, Aabb<f64>)) -> Self {
        Self { gap: a.1.gap_squared(&b.1), nodes: [a.0, b.0], boxes: [a.1, b.1] }
    }
}

/// Offers every pair of primitives that may be near.
pub(crate) fn search_pairs<A: Side, B: Side>(a: &A, b: &B, pairs: &mut Pairs<'_>) {
    let (Some(root_a), Some(root_b)) = (a.root(), b.root()) else { return };
    let mut pending = vec![NodePair::new(root_a, root_b)];
    let mut loaded = [Hulls::new(), Hulls::new()];
    while let Some(NodePair { gap, nodes, boxes }) = pending.pop() {
        if gap > pairs.prune_above() {
            continue;
        }
        if pairs.is_done() {
            return;
        }
        let first = pending.len();
        match nodes.map(NodeRef::is_packet) {
            [true, true] => {
                let [hulls_a, hulls_b] = &mut loaded;
                load(a, nodes[0], hulls_a);
                load(b, nodes[1], hulls_b);
                search_packets(hulls_a, hulls_b, &boxes, pairs);
                continue;
            }
            [a_is_packet, b_is_packet] => {
                let cuts_a = b_is_packet || (!a_is_packet && extent(&boxes[0]) >= extent(&boxes[1]));
                let prune = pairs.prune_above();
                let mut push = |pair: NodePair| {
                    if pair.gap <= prune {
                        pending.push(pair);
                    }
                };
                if cuts_a {
                    a.children(nodes[0], &mut |n, bounds| push(NodePair::new((n, bounds), (nodes[1], boxes[1]))));
                } else {
                    b.children(nodes[1], &mut |n, bounds| push(NodePair::new((nodes[0], boxes[0]), (n, bounds))));
                }
            }
        }
        // The nearest pair is visited first. Boxes that overlap are taken by the distance of their centres.
        pending[first..].sort_unstable_by(|p, q| order(q).partial_cmp(&order(p)).unwrap_or(std::cmp::Ordering::Equal));
    }
}

/// Loads the primitives of a packet, unless they are loaded.
fn load(side: &impl Side, packet: NodeRef, primitives: &mut Hulls) {
    if primitives.packet != packet {
        side.load(packet, primitives);
        primitives.packet = packet;
    }
}

/// Returns the sum of the sides of a box.
fn extent(bounds: &Aabb<f64>) -> f64 {
    (bounds.max - bounds.min).sum()
}

/// Returns the numbers by which pairs of nodes are ordered.
fn order(pair: &NodePair) -> (f64, f64) {
    let [a, b] = &pair.boxes;
    (pair.gap, ((a.min - b.min) + (a.max - b.max)).norm_squared())
}

/// Offers the pairs of the primitives of two packets.
fn search_packets(a: &Hulls, b: &Hulls, boxes: &[Aabb<f64>; 2], pairs: &mut Pairs<'_>) {
    let prune = pairs.prune_above();
    let is_near = |bounds: &Aabb<f64>, other: &Aabb<f64>| bounds.gap_squared(other) <= prune;
    let mut near_b = [0; LANES];
    let mut near_b_len = 0;
    for j in (0..b.len).filter(|j| is_near(&b.boxes[*j], &boxes[0])) {
        near_b[near_b_len] = j;
        near_b_len += 1;
    }
    for i in (0..a.len).filter(|i| is_near(&a.boxes[*i], &boxes[1])) {
        for &j in &near_b[..near_b_len] {
            let prune = pairs.prune_above();
            let ids = [a.ids[i], b.ids[j]];
            if a.boxes[i].gap_squared(&b.boxes[j]) > prune || !pairs.can_change(ids) {
                continue;
            }
            pairs.offer_result(ids, nearest_of_hulls(a.hull(i), b.hull(j), prune));
            if pairs.is_done() {
                return;
            }
        }
    }
}
