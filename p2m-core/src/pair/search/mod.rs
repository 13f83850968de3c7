//! The search for near pairs of primitives: between a tree and a shape, or between two trees, one of which may have
//! moved.
//!
//! # Method
//!
//! The basic idea is a dual-tree traversal: the search keeps a stack of pairs of nodes, takes the nearest pair, and
//! replaces the larger of its two nodes (or the only one that is not a packet) by its eight children. Pairs of packets
//! are searched primitive by primitive. A pair of nodes is pruned if it is certainly farther apart than the best pair
//! so far, by one of two bounds.
//!
//! - **Directions** (the files `directions` and `slab`). The fixed node of the pair lies between two planes in each of
//!   a few directions: the axes of both frames, and for a shape the directions that are orthogonal to its edges and to
//!   an axis. The distances between the eight children and the slabs between these planes are bounded side by side, in
//!   f32.
//! - **The direction of the best pair** (the file `support`). Where two surfaces are nearest, they face each other and
//!   are nearly flat. A box around such a piece reaches towards the other surface by as much as the box is wide, but
//!   the piece itself only by the square of that. So the search computes the exact extents of nodes along the direction
//!   of the best pair, from their extreme vertices. Without this bound, the number of pairs of nodes that no box
//!   excludes grows with the number of triangles; with it, few are left on each level.
//!
//! If f32 does not resolve one node in the frame of the other, the gap between boxes in f64 is the only bound.
//!
//! # Correctness
//!
//! The gap between two boxes never exceeds the key of primitives in them ([docs/proofs/pairs.md]). The other bounds
//! have margins above their rounding and above the error of keys. So the answer equals the answer over all pairs, bit
//! for bit. The motion of a tree is applied to the vertices of its packets, each coordinate rounded, and to directions
//! and boxes with a margin above all roundings.
//!
//! [docs/proofs/pairs.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/pairs.md

mod directions;
mod height;
mod hulls;
mod place;
mod side;
mod slab;
mod support;

use super::Pairs;
use crate::PrimitiveId;
pub use directions::Directions;
pub use height::{Height, Rows};
use hulls::search_packets;
pub use hulls::{Hulls, MAX_HULLS};
pub use place::{NO_NODE, Place, WIDTH};
pub use side::{Children, PairSide, Placement, ShapeSide};
pub use slab::{ChildBounds, Slab, bound_children};
use support::Supports;

/// Two nodes that may contain a near pair.
#[derive(Clone, Copy)]
struct NodePair {
    /// The square of a lower bound on the distance.
    square: f64,
    gap: f32,
    places: [Place; 2],
}

/// The state of a search for pairs between two sides.
struct Search<'a, 'p, 'v> {
    sides: [&'a dyn PairSide; 2],
    /// The directions, or `None` if f32 does not resolve one side in the frame of the other.
    directions: Option<Directions>,
    supports: Supports,
    pending: Vec<NodePair>,
    /// The side and the node for which `slabs` were computed.
    fixed: Option<(usize, u32)>,
    slabs: Vec<Slab>,
    goes_on: &'a dyn Fn() -> bool,
    pairs: &'p mut Pairs<'v>,
}

/// Offers every pair of primitives that may be near. Before each step it calls `goes_on`, and ends if the result is
/// `false`.
pub fn search_pairs(a: &dyn PairSide, b: &dyn PairSide, goes_on: &dyn Fn() -> bool, pairs: &mut Pairs<'_>) {
    let (Some(root_a), Some(root_b)) = (a.root(), b.root()) else { return };
    let sides = [a, b];
    if a.bounds().gap_squared(&b.bounds()) > pairs.prune_above() {
        return;
    }
    let directions = Directions::new(sides);
    let supports = Supports::new(directions.as_ref().map(|all| all.margin));
    let (pending, slabs) = (Vec::new(), Vec::new());
    let mut search = Search { sides, directions, supports, pending, fixed: None, slabs, goes_on, pairs };
    search.pending.push(NodePair { square: 0.0, gap: 0.0, places: [root_a, root_b] });
    search.run();
}

impl Search<'_, '_, '_> {
    fn run(&mut self) {
        let mut loaded = [Hulls::new(), Hulls::new()];
        while let Some(NodePair { square, places, .. }) = self.pending.pop() {
            if square > self.pairs.prune_above() || self.pairs.is_settled(square, || least_ids(self.sides, &places)) {
                continue;
            }
            if self.pairs.is_done() || !(self.goes_on)() {
                return;
            }
            match [0, 1].map(|i| self.sides[i].is_packet(places[i].node)) {
                [true, true] => {
                    self.search_packets([places[0].node, places[1].node], &mut loaded);
                    if !self.pairs.is_nearest() {
                        self.search_rest_of_runs([places[0].node, places[1].node], &mut loaded);
                    }
                }
                [_, true] => self.cut(0, places),
                [true, _] => self.cut(1, places),
                _ => self.cut(usize::from(places[0].size < places[1].size), places),
            }
        }
    }

    /// Offers the pairs of the primitives of two packets.
    fn search_packets(&mut self, packets: [u32; 2], loaded: &mut [Hulls; 2]) {
        for ((side, packet), hulls) in self.sides.iter().zip(packets).zip(&mut *loaded) {
            if hulls.packet != packet {
                side.load(packet, hulls);
            }
        }
        let [a, b] = &*loaded;
        search_packets(a, b, self.supports.margin, self.supports.direction, self.pairs);
        self.supports.follow(self.pairs);
    }

    /// Offers the pairs of the packets that continue two packets. They have the same vertices, so they can only tie
    /// with pairs of the first packets.
    fn search_rest_of_runs(&mut self, first: [u32; 2], loaded: &mut [Hulls; 2]) {
        let [side_a, side_b] = self.sides;
        let mut packets = first;
        loop {
            if let Some(b) = side_b.next_packet(packets[1]) {
                packets[1] = b;
            } else if let Some(a) = side_a.next_packet(packets[0]) {
                packets = [a, first[1]];
            } else {
                return;
            }
            if self.pairs.is_done() || !(self.goes_on)() {
                return;
            }
            self.search_packets(packets, loaded);
        }
    }

    /// Adds the pairs of each child of one node with the other node.
    fn cut(&mut self, side: usize, places: [Place; 2]) {
        let prune = self.pairs.prune_above();
        let other = places[1 - side];
        let children = match &self.directions {
            Some(directions) => {
                if self.fixed != Some((1 - side, other.node)) {
                    directions.slabs(1 - side, self.sides[1 - side], &other, &mut self.slabs);
                    self.fixed = Some((1 - side, other.node));
                }
                self.sides[side].cut(places[side].node, &self.slabs, directions.triples)
            }
            None => {
                let bounds = self.sides[1 - side].box_of(&other);
                self.sides[side].cut_by_box(places[side].node, &bounds)
            }
        };
        let first = self.pending.len();
        for slot in 0..WIDTH {
            let square = children.squares[slot];
            // The comparison may be false for unused slots, so the number of the child is tested as well.
            if square > prune || children.nodes[slot] == NO_NODE {
                continue;
            }
            let parent = places[side].node;
            #[allow(clippy::cast_possible_truncation, reason = "below eight")]
            let child = Place { node: children.nodes[slot], parent, slot: slot as u8, size: children.sizes[slot] };
            let mut pair = NodePair { square, gap: children.gaps[slot], places };
            pair.places[side] = child;
            if self.supports.is_near(self.sides, &pair.places, prune) {
                self.pending.push(pair);
            }
        }
        // The nearest pair is visited first. Ties go to the pair with the lowest ids, with which all others can only
        // tie.
        let ids = |pair: &NodePair| least_ids(self.sides, &pair.places);
        self.pending[first..].sort_unstable_by(|p, q| q.gap.total_cmp(&p.gap).then_with(|| ids(q).cmp(&ids(p))));
    }
}

/// Returns the least id of each of two nodes.
fn least_ids(sides: [&dyn PairSide; 2], places: &[Place; 2]) -> [PrimitiveId; 2] {
    [0, 1].map(|i| sides[i].least_id(places[i].node))
}
