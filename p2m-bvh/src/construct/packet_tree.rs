//! Building and refitting a [`PacketTree`].

use crate::construct::collapse::{PacketBinaryTree, PacketRange};
use crate::construct::options::{SplitOptions, TreeOptions};
use crate::construct::primitive::BuildPrimitive;
use crate::construct::split::{split, to_u32};
use crate::packet::{Kind, LANES, Member, Members, Packet};
use crate::tree::frame::Frame;
use crate::tree::frame_line::half_extent;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use crate::tree::{Leaves, PacketTree};
use crate::volume::Volume;
use p2m_core::engine::parallel::{join, map, map_owned, map_slice, thread_count};
use p2m_core::engine::simd::Isa;
use p2m_core::{Aabb, BuildError, Primitive, PrimitiveId, PrimitiveSet, Real, check_set};
use std::sync::OnceLock;

/// The least unit of a packet, relative to the unit of the tree: 2^-36. Finer units would bring nothing.
const MIN_UNIT_RATIO: f64 = 1.0 / (1u64 << 36) as f64;

impl<V: Volume> PacketTree<V> {
    /// Builds the tree over a set whose boxes are finite.
    ///
    /// # Complexity
    /// O(n log n) expected time, and O(K n) more for k-DOPs; O(n) memory.
    #[must_use]
    pub fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S, options: &V::Options) -> Self {
        let (bounds, _) = scene_box(set, options.splits().parallel);
        Self::build_within(bounds, set, options)
    }

    /// Checks a set as [`check_set`] does and builds the tree over it, in one pass over the set.
    pub(crate) fn build_checked<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &V::Options,
    ) -> Result<Self, BuildError> {
        if set.len() > PrimitiveId::MAX_COUNT {
            return Err(BuildError::TooMany { len: set.len() });
        }
        let (bounds, is_finite) = scene_box(set, options.splits().parallel);
        if !is_finite {
            check_set(set)?;
        }
        Ok(Self::build_within(bounds, set, options))
    }

    /// Builds the tree over a set, given its box.
    fn build_within<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        bounds: Aabb<f64>,
        set: &S,
        options: &V::Options,
    ) -> Self {
        let frame = Frame::around(&bounds);
        let place = |i: usize| {
            let id = PrimitiveId::new(i);
            let primitive = set.get(id);
            BuildPrimitive::new(&frame, &primitive.aabb().to_f64(), Kind::of(&primitive), id)
        };
        let primitives = map(set.len(), options.splits().parallel, place);
        let members = |id: PrimitiveId| Member::from_primitive(&set.get(id));
        Self::build_from_primitives(primitives, bounds, &members, options.shared(), options.splits())
    }

    /// Builds the tree from all primitives, which are in the frame around `bounds`. The function does not depend on the
    /// type of the set, so it is compiled once.
    #[inline(never)]
    pub(crate) fn build_from_primitives(
        mut primitives: Vec<BuildPrimitive>,
        bounds: Aabb<f64>,
        members: Members<'_>,
        shared: V::Shared,
        options: &SplitOptions,
    ) -> Self {
        let frame = Frame::around(&bounds);
        let splits = split(&mut primitives, &frame, members, options);
        let (binary, packets) = PacketBinaryTree::new(&splits);
        drop(splits);
        let order = map_slice(&primitives, options.parallel, BuildPrimitive::id);
        drop(primitives);
        let content = |packet: usize| {
            let PacketRange { primitives, is_continued } = &packets[packet];
            (&order[primitives.start as usize..primitives.end as usize], *is_continued)
        };
        let pack = || pack::<V>(packets.len(), &content, members, &frame, &shared, options.parallel);
        // The nodes are needed only after the packets, and only packets can be made on several threads.
        let collapse = move || binary.collapse();
        let ((root, children, depth), (leaves, packet_bounds)) = join(options.parallel, collapse, pack);
        let mut tree = Self {
            isa: Isa::best(),
            shared,
            frame,
            bounds,
            half_extent: half_extent(&frame, &bounds),
            root_bounds: V::Node::EMPTY,
            root,
            depth,
            nodes: children.into_iter().map(V::Node::new).collect(),
            leaves,
            len: order.len(),
            least_ids: OnceLock::new(),
        };
        tree.bound_nodes(&packet_bounds);
        tree
    }

    /// Computes the bounds of all nodes from the bounds of the packets.
    fn bound_nodes(&mut self, packet_bounds: &[<V::Node as WideNode>::Bounds]) {
        let mut node_bounds = vec![V::Node::EMPTY; self.nodes.len()];
        // Backwards, because children come after their parents.
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

    /// Refits the tree to a set in which the same primitives have moved. Their boxes have to be finite.
    ///
    /// The tree keeps its shape, so searches get slower the farther primitives have moved apart. Answers equal the
    /// answers of a tree that is built anew. Of the options only the choice to use all threads has an effect.
    ///
    /// More than sixteen primitives with the same vertices, bit for bit, are one leaf. If they have moved apart, the
    /// tree is built anew with the default splits, in O(n log n).
    ///
    /// # Panics
    /// Panics if the set has another number of primitives.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(&mut self, set: &S, options: &V::Options) {
        self.refit_with(set, options.splits().parallel);
    }

    /// Refits the tree as [`refit`](Self::refit) does, with all threads if `parallel` is set.
    pub(crate) fn refit_with<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(&mut self, set: &S, parallel: bool) {
        assert_eq!(set.len(), self.len, "as many primitives as before");
        self.refit_to(&|id| Member::from_primitive(&set.get(id)), parallel);
    }

    /// Refits the tree to moved primitives. The function does not depend on the type of the set, so it is compiled
    /// once.
    #[inline(never)]
    pub(crate) fn refit_to(&mut self, members: Members<'_>, parallel: bool) {
        let boxes = map_slice(&self.leaves.packets, parallel, |packet| {
            packet.ids().iter().fold(Aabb::empty(), |all, id| all.union(&members(*id).bounds))
        });
        self.bounds = boxes.iter().fold(Aabb::empty(), |all, one| all.union(one));
        self.frame = Frame::around(&self.bounds);
        self.half_extent = half_extent(&self.frame, &self.bounds);
        if self.has_parted_run(members) {
            let place =
                |i: usize| BuildPrimitive::from_member(&self.frame, &members(PrimitiveId::new(i)), PrimitiveId::new(i));
            let primitives = map(self.len, parallel, place);
            let splits = SplitOptions::default().with_parallel(parallel);
            let tree = Self::build_from_primitives(primitives, self.bounds, members, self.shared.clone(), &splits);
            *self = tree.with_isa(self.isa);
            return;
        }
        let content = |packet: usize| {
            let packet = &self.leaves.packets[packet];
            (packet.ids(), packet.is_continued())
        };
        let (leaves, packet_bounds) = pack::<V>(boxes.len(), &content, members, &self.frame, &self.shared, parallel);
        self.leaves = leaves;
        self.bound_nodes(&packet_bounds);
    }

    /// Returns whether the primitives of a run no longer have the same vertices.
    fn has_parted_run(&self, members: Members<'_>) -> bool {
        self.leaves.packets.windows(2).filter(|pair| pair[0].is_continued()).any(|pair| {
            let first = members(pair[0].ids()[0]);
            pair.iter().flat_map(Packet::ids).any(|id| !members(*id).is_same(&first))
        })
    }
}

/// Returns the box around a set, and whether all its primitives are finite.
fn scene_box<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S, parallel: bool) -> (Aabb<f64>, bool) {
    let len = set.len();
    let of_chunk = |chunk: usize| {
        let (mut all, mut is_finite) = (Aabb::empty(), true);
        for i in chunk * CHUNK..len.min((chunk + 1) * CHUNK) {
            let primitive = set.get(PrimitiveId::new(i));
            all = all.union(&primitive.aabb());
            is_finite &= primitive.is_finite();
        }
        (all, is_finite)
    };
    let chunks = map(len.div_ceil(CHUNK), parallel, of_chunk);
    let (all, is_finite) =
        chunks.iter().fold((Aabb::empty(), true), |(all, is_finite), chunk| (all.union(&chunk.0), is_finite & chunk.1));
    (all.to_f64(), is_finite)
}

/// The bounds of a node of a tree.
type Bounds<V> = <<V as VolumeNodes>::Node as WideNode>::Bounds;

/// Makes packets and bounds them in the frame of the tree.
fn pack<'a, V: Volume>(
    packets: usize,
    content: Content<'_, 'a>,
    members: Members<'_>,
    frame: &Frame,
    shared: &V::Shared,
    parallel: bool,
) -> (Leaves, Vec<Bounds<V>>) {
    let bounds: Vec<OnceLock<Bounds<V>>> = (0..packets).map(|_| OnceLock::new()).collect();
    let bound = |packet: usize, primitives: &[Member], around: &Aabb<f64>| {
        bounds[packet].get_or_init(|| V::Node::enclose(shared, frame, primitives, around));
    };
    let leaves = pack_leaves(packets, content, members, frame, parallel, &bound);
    let bounds = bounds.into_iter().map(|bounds| bounds.into_inner().expect("every packet was bounded"));
    (leaves, bounds.collect())
}

/// A function that returns the ids of the primitives of a packet, and whether the next packet continues it.
type Content<'c, 'a> = &'c (dyn Fn(usize) -> (&'a [PrimitiveId], bool) + Sync);

/// A function that receives the number of a packet, its primitives and the box around them.
type BoundFn<'b> = &'b (dyn Fn(usize, &[Member], &Aabb<f64>) + Sync);

/// Makes packets, and calls `bound` with the number of each packet, its primitives and the box around them. The
/// function does not depend on the volume, so it is compiled once.
///
/// All threads make a group of packets together, each chunk with a vertex list of its own. The lists of a group are
/// joined while the next group is made, and are then reused. So only the lists of few groups are in memory beside the
/// packets (decision 064).
fn pack_leaves<'a>(
    packets: usize,
    content: Content<'_, 'a>,
    members: Members<'_>,
    frame: &Frame,
    parallel: bool,
    bound: BoundFn<'_>,
) -> Leaves {
    let pack_chunk = |(first, chunk, vertices): (usize, &mut [Packet], &mut Vec<[f64; 3]>)| {
        vertices.clear();
        let mut primitives = Vec::with_capacity(LANES);
        for (number, packet) in (first..).zip(chunk) {
            let (ids, is_continued) = content(number);
            primitives.clear();
            primitives.extend(ids.iter().map(|id| members(*id)));
            let bounds = primitives.iter().fold(Aabb::empty(), |all: Aabb<f64>, one: &Member| all.union(&one.bounds));
            bound(number, &primitives, &bounds);
            *packet = Packet::new(ids, &primitives, &bounds, frame.unit * MIN_UNIT_RATIO, vertices)
                .with_continuation(is_continued);
        }
    };
    // The operating system clears the pages of the array when they are first written.
    let mut packed: Vec<Packet> = bytemuck::zeroed_vec(packets);
    let mut joined = JoinedVertices::new(packets);
    let chunks_per_group = MIN_CHUNKS_PER_GROUP.max(4 * thread_count(parallel));
    let no_lists = || vec![Vec::new(); chunks_per_group];
    let (mut waiting, mut spare): ((&mut [Packet], _), _) = ((&mut [], no_lists()), no_lists());
    for (group, group_packets) in packed.chunks_mut(chunks_per_group * PACKET_CHUNK).enumerate() {
        let mut lists = spare;
        let chunks = group_packets.chunks_mut(PACKET_CHUNK).zip(&mut lists).enumerate();
        let first = |chunk: usize| (group * chunks_per_group + chunk) * PACKET_CHUNK;
        let chunks = chunks.map(|(i, (chunk, list))| (first(i), chunk, list)).collect();
        let (waiting_packets, waiting_lists) = waiting;
        let join_waiting = || joined.append(waiting_packets, &waiting_lists);
        join(parallel, join_waiting, || map_owned(chunks, parallel, pack_chunk));
        (waiting, spare) = ((group_packets, lists), waiting_lists);
    }
    joined.append(waiting.0, &waiting.1);
    joined.finish(packed)
}

/// The vertices of all packets in one array, in the order of the packets, and the offset of each packet in it.
struct JoinedVertices {
    packets: usize,
    vertices: Vec<[f64; 3]>,
    offsets: Vec<u32>,
    has_non_triangles: bool,
}

impl JoinedVertices {
    fn new(packets: usize) -> Self {
        Self { packets, vertices: Vec::new(), offsets: Vec::with_capacity(packets + 1), has_non_triangles: false }
    }

    /// Appends the vertices of the next packets. Each list belongs to [`PACKET_CHUNK`] packets, whose vertex offsets
    /// count from the start of the list.
    fn append(&mut self, packets: &mut [Packet], lists: &[Vec<[f64; 3]>]) {
        for (chunk, list) in packets.chunks_mut(PACKET_CHUNK).zip(lists) {
            let first = to_u32(self.vertices.len());
            for packet in &mut *chunk {
                packet.vertex_offset += first;
                self.offsets.push(packet.vertex_offset);
                self.has_non_triangles |= !packet.has_triangles();
            }
            if self.vertices.capacity() - self.vertices.len() < list.len() {
                // The remaining packets probably have as many vertices each as the packets so far.
                let known = self.vertices.len() + list.len();
                let all = known as u64 * self.packets as u64 / self.offsets.len() as u64;
                let more = usize::try_from(all + all / 64).unwrap_or(0).saturating_sub(self.vertices.len());
                self.vertices.reserve_exact(more.max(list.len()));
            }
            self.vertices.extend_from_slice(list);
        }
    }

    fn finish(mut self, packets: Vec<Packet>) -> Leaves {
        self.offsets.push(to_u32(self.vertices.len()));
        self.vertices.shrink_to_fit();
        Leaves {
            packets: packets.into(),
            vertices: self.vertices.into(),
            vertex_offsets: self.offsets.into(),
            has_non_triangles: self.has_non_triangles,
        }
    }
}

/// The number of primitives that a thread handles at a time. There is no record of how it was tuned.
const CHUNK: usize = 1 << 14;
/// The number of packets that a thread makes at a time. There is no record of how it was tuned.
const PACKET_CHUNK: usize = 1 << 7;
/// The least number of chunks of packets that are made before their vertices are joined. It applies to up to four
/// threads. There is no record of how it was tuned.
const MIN_CHUNKS_PER_GROUP: usize = 1 << 4;
