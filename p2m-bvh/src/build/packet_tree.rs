//! Building and refitting a [`PacketTree`].

use crate::build::collapse::PacketBinaryTree;
use crate::build::options::TreeOptions;
use crate::build::split_tree::SplitTree;
use crate::packet::{Kind, LANES, Member, Members, Packet};
use crate::tree::frame::Frame;
use crate::tree::frame_line::half_extent;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::WideNode;
use crate::tree::{Leaves, PacketTree};
use crate::volume::Volume;
use p2m_core::engine::simd::Isa;
use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet, Real};
use std::ops::Range;

/// The least unit of a packet, as a part of the unit of the tree: 2^-36. Finer units would bring nothing.
const MIN_UNIT_RATIO: f64 = 1.0 / (1u64 << 36) as f64;

impl<V: Volume> PacketTree<V> {
    /// Builds the tree over a set whose boxes are finite.
    ///
    /// # Complexity
    /// O(n log n) expected time, and O(K n) more for k-DOPs; O(n) memory.
    #[must_use]
    pub fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S, options: &V::Options) -> Self {
        let box_and_kind = |i: usize| {
            let primitive = set.get(PrimitiveId::new(i));
            (primitive.aabb(), Kind::of(&primitive))
        };
        let (boxes, kinds): (Vec<Aabb<T>>, Vec<Kind>) = (0..set.len()).map(box_and_kind).unzip();
        Self::build_from_boxes(&boxes, &kinds, &|id| Member::from_primitive(&set.get(id)), options)
    }

    /// Builds the tree from the boxes and kinds of all primitives. The function does not depend on the type of the
    /// set, so it is compiled once for each scalar.
    fn build_from_boxes<T: Real>(
        boxes: &[Aabb<T>],
        kinds: &[Kind],
        members: Members<'_>,
        options: &V::Options,
    ) -> Self {
        let (shared, options) = (options.shared(), options.splits());
        let mut binary = SplitTree::build(boxes, options, |id| boxes[id.index()].to_f64(), Aabb::union);
        let bounds = binary.nodes.first().map_or(Aabb::empty(), |root| root.volume);
        // Each leaf becomes one packet or several, because a packet has primitives of one kind.
        let mut ranges: Vec<(Range<usize>, Kind)> = Vec::new();
        let mut leaf_packets = vec![0..0; binary.nodes.len()];
        for (at, node) in binary.nodes.iter().enumerate() {
            let leaf = node.range();
            let ids = &mut binary.order[leaf.clone()];
            // Primitives of a kind are sorted by id, because neighbours in the user's order tend to be
            // neighbours in memory.
            ids.sort_unstable_by_key(|id| (kinds[id.index()], *id));
            let first = ranges.len();
            for run in ids.chunk_by(|a, b| kinds[a.index()] == kinds[b.index()]) {
                let kind = kinds[run[0].index()];
                for ids in run.chunks(LANES) {
                    let from = ranges.last().filter(|_| ranges.len() > first).map_or(leaf.start, |(r, _)| r.end);
                    ranges.push((from..from + ids.len(), kind));
                }
            }
            leaf_packets[at] = first..ranges.len();
        }
        let frame = Frame::around(&bounds);
        let order = binary.order;
        let pack = |(range, kind): &(Range<usize>, Kind)| {
            let ids = &order[range.clone()];
            let primitives = gather(members, ids);
            let bounds = common_box(&primitives);
            let enclosed = V::Node::enclose(&shared, &frame, &primitives, &bounds);
            (Packet::new(ids, &primitives, *kind, &bounds, frame.unit * MIN_UNIT_RATIO), (bounds, enclosed))
        };
        let (packed, bounded): (Vec<_>, Vec<_>) = map(&ranges, options.parallel, pack).into_iter().unzip();
        let (packet_boxes, packet_bounds): (Vec<_>, Vec<_>) = bounded.into_iter().unzip();
        let leaves = Leaves::new(packed);
        let (root, children, depth) = PacketBinaryTree::new(&binary.nodes, &leaf_packets, &packet_boxes).collapse();
        let nodes = children.into_iter().map(V::Node::new).collect();
        let mut tree = Self {
            isa: Isa::best(),
            shared,
            frame,
            bounds,
            half_extent: half_extent(&frame, &bounds),
            root_bounds: V::Node::EMPTY,
            root,
            depth,
            nodes,
            leaves,
            len: boxes.len(),
        };
        tree.bound_nodes(&packet_bounds);
        tree
    }

    /// Computes the bounds of all nodes from those of the packets.
    fn bound_nodes(&mut self, packet_bounds: &[<V::Node as WideNode>::Bounds]) {
        let mut node_bounds = vec![V::Node::EMPTY; self.nodes.len()];
        // The loop runs backwards, because children come after their parents.
        for number in (0..self.nodes.len()).rev() {
            let mut all = V::Node::EMPTY;
            let node = &mut self.nodes[number];
            for slot in 0..WIDTH {
                let child = node.children()[slot];
                if child == NodeRef::NONE {
                    continue;
                }
                let bounds =
                    if child.is_packet() { packet_bounds[child.number()] } else { node_bounds[child.number()] };
                all = V::Node::union(&all, &bounds);
                node.set_bounds(slot, &bounds);
            }
            node_bounds[number] = all;
        }
        self.root_bounds = packet_bounds.iter().fold(V::Node::EMPTY, |all, bounds| V::Node::union(&all, bounds));
    }

    /// Fits the tree to a set in which the same primitives have moved. Their boxes have to be finite.
    ///
    /// The tree keeps its shape, so searches get slower the farther primitives have moved apart. Answers are those of a
    /// tree that is built anew. Of the options only the choice to use all threads has an effect.
    ///
    /// # Panics
    /// Panics if the set has another number of primitives.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(&mut self, set: &S, options: &V::Options) {
        assert_eq!(set.len(), self.len, "as many primitives as before");
        self.refit_to(&|id| Member::from_primitive(&set.get(id)), options.splits().parallel);
    }

    /// Fits the tree to moved primitives. The function does not depend on the type of the set, so it is compiled once.
    fn refit_to(&mut self, members: Members<'_>, parallel: bool) {
        let packet_boxes = map(&self.leaves.packets, parallel, |packet| common_box(&gather(members, packet.ids())));
        self.bounds = packet_boxes.iter().fold(Aabb::empty(), |a, b| a.union(b));
        self.frame = Frame::around(&self.bounds);
        self.half_extent = half_extent(&self.frame, &self.bounds);
        let min_unit = self.frame.unit * MIN_UNIT_RATIO;
        let pack = |(packet, bounds): &(&Packet, &Aabb<f64>)| {
            let primitives = gather(members, packet.ids());
            // A primitive of the new set may be of another kind.
            let first = primitives[0].kind;
            let kind = if primitives.iter().all(|primitive| primitive.kind == first) { first } else { Kind::Box };
            let enclosed = V::Node::enclose(&self.shared, &self.frame, &primitives, bounds);
            (Packet::new(packet.ids(), &primitives, kind, bounds, min_unit), enclosed)
        };
        let bounded: Vec<_> = self.leaves.packets.iter().zip(&packet_boxes).collect();
        let (packed, packet_bounds): (Vec<_>, Vec<_>) = map(&bounded, parallel, pack).into_iter().unzip();
        self.leaves = Leaves::new(packed);
        self.bound_nodes(&packet_bounds);
    }
}

/// The members with some ids.
fn gather(members: Members<'_>, ids: &[PrimitiveId]) -> Vec<Member> {
    ids.iter().map(|id| members(*id)).collect()
}

/// The box around some primitives.
fn common_box(primitives: &[Member]) -> Aabb<f64> {
    primitives.iter().fold(Aabb::empty(), |all, one| all.union(&one.bounds))
}

/// Maps a slice in order, on all threads if `parallel` is set and the feature `rayon` is on.
fn map<A: Sync, B: Send>(all: &[A], parallel: bool, f: impl Fn(&A) -> B + Sync) -> Vec<B> {
    #[cfg(feature = "rayon")]
    if parallel {
        use rayon::prelude::*;
        return all.par_iter().map(&f).collect();
    }
    let _ = parallel;
    all.iter().map(f).collect()
}
