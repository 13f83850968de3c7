//! A tree of wide nodes over packets.
//!
//! A binary tree of splits is collapsed into nodes of eight children ([`collapse`]). A node is a few cache lines with
//! the bounds of eight children side by side ([`volume`]: boxes in [`node`], k-DOPs in [`slabs`]), a leaf a [`Packet`]
//! of up to sixteen primitives. Both are in f32 or less and only bound distances, from both sides and with proof; what
//! may be the answer is evaluated in f64 by the kernel of the contract ([`search`]).

pub(crate) mod aabb_node;
mod saved;
mod view;
pub(crate) mod volume;

use crate::build::{Hierarchy, MAX_DEPTH, collapse};
use crate::packet::{Kind, LANES, Member, Members, Packet};
use crate::traverse::nearest::{EvaluateFn, Search, SearchState, finish};
use crate::traverse::ray::{self, Intersect, RaySearch};
use aabb_node::{Frame, NodeRef, WIDTH};
use nalgebra::Point3;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{Isa, prefetch_lines};
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{
    Aabb, Best, Collector, Crossing, Hits, Near, Primitive, PrimitiveId, PrimitiveSet, Ray, RayCollector, Real,
};
use volume::{TreeOptions, WideNode};

pub use view::TreeNode;
pub use volume::Volume;

/// No path from the root is longer: that of the binary tree, and one node more where a leaf has several kinds.
pub(crate) const MAX_WIDE_DEPTH: usize = MAX_DEPTH + 2;

/// A tree over a set of primitives, which it does not keep: every method that needs the set is given the same one.
#[derive(Clone, Debug)]
pub struct PacketTree<V: Volume = Aabb<f64>> {
    pub(crate) isa: Isa,
    pub(crate) shape: V::Shape,
    #[doc(hidden)]
    pub frame: Frame,
    pub(crate) bounds: Aabb<f64>,
    /// Half of the box, for rays.
    pub(crate) half: [f64; 3],
    /// Around everything, as nodes have it.
    pub(crate) whole: <V::Node as WideNode>::Bounds,
    #[doc(hidden)]
    pub root: NodeRef,
    /// Nodes on the longest path from the root.
    pub(crate) depth: usize,
    pub(crate) nodes: Vec<V::Node>,
    #[doc(hidden)]
    pub leaves: Leaves,
    /// How many primitives there are.
    pub(crate) len: usize,
}

/// The packets of a tree.
#[derive(Clone, Debug)]
pub struct Leaves {
    pub packets: Array<Packet>,
    /// The exact vertices of the packets, one packet after the other.
    pub vertices: Array<[f64; 3]>,
    /// Where those of each packet begin: few numbers, which stay in the cache, so that vertices can be asked for with
    /// their packet.
    pub(crate) firsts: Array<u32>,
    /// Whether there is anything but triangles.
    pub(crate) has_others: bool,
}

impl<V: Volume> PacketTree<V> {
    /// The directions of the faces of its volumes: [`Volume::Directions`].
    #[must_use]
    pub fn directions(&self) -> &V::Directions {
        V::directions(&self.shape)
    }
}

impl<V: Volume> PacketTree<V> {
    /// The box around everything; the empty box for an empty set.
    #[must_use]
    pub fn bounds(&self) -> &Aabb<f64> {
        &self.bounds
    }

    /// Nodes on the longest path from the root.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Builds the tree over a set whose boxes are finite.
    ///
    /// # Complexity
    /// O(n log n) time expected, and O(K n) for k-DOPs; O(n) memory.
    #[must_use]
    pub fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(set: &S, options: &V::Options) -> Self {
        let of_id = |i: usize| {
            let primitive = set.get(PrimitiveId::new(i));
            (primitive.aabb(), Kind::of(&primitive))
        };
        let (boxes, kinds): (Vec<Aabb<T>>, Vec<Kind>) = (0..set.len()).map(of_id).unzip();
        Self::build_of(&boxes, &kinds, &|id| Member::of(&set.get(id)), options)
    }

    /// The same for all sets of a scalar.
    fn build_of<T: Real>(boxes: &[Aabb<T>], kinds: &[Kind], members: Members<'_>, options: &V::Options) -> Self {
        let (shape, options) = (options.shape(), options.splits());
        let mut binary = Hierarchy::build(boxes, options, |id| boxes[id.index()].to_f64(), Aabb::union);
        let bounds = binary.nodes.first().map_or(Aabb::empty(), |root| root.volume);
        // One packet after the other for each leaf, kinds apart.
        let mut ranges: Vec<(std::ops::Range<usize>, Kind)> = Vec::new();
        let mut of_leaf = vec![0..0; binary.nodes.len()];
        for (at, node) in binary.nodes.iter().enumerate() {
            let places = node.places();
            let ids = &mut binary.order[places.clone()];
            // And by id: neighbours in the user's order tend to be neighbours in memory.
            ids.sort_unstable_by_key(|id| (kinds[id.index()], *id));
            let first = ranges.len();
            for run in ids.chunk_by(|a, b| kinds[a.index()] == kinds[b.index()]) {
                let kind = kinds[run[0].index()];
                for ids in run.chunks(LANES) {
                    let from = ranges.last().filter(|_| ranges.len() > first).map_or(places.start, |(r, _)| r.end);
                    ranges.push((from..from + ids.len(), kind));
                }
            }
            of_leaf[at] = first..ranges.len();
        }
        let frame = Frame::around(&bounds);
        let order = binary.order;
        let pack = |(places, kind): &(std::ops::Range<usize>, Kind)| {
            let ids = &order[places.clone()];
            let primitives = gather(members, ids);
            let bounds = around(&primitives);
            let enclosed = V::Node::enclose(&shape, &frame, &primitives, &bounds);
            (Packet::new(ids, &primitives, *kind, &bounds, frame.unit * FINEST), (bounds, enclosed))
        };
        let (packed, bounded): (Vec<_>, Vec<_>) = map(&ranges, options.parallel, pack).into_iter().unzip();
        let (packet_boxes, packet_bounds): (Vec<_>, Vec<_>) = bounded.into_iter().unzip();
        let leaves = Leaves::new(packed);
        let (root, children, depth) = collapse::Binary::new(&binary.nodes, &of_leaf, &packet_boxes).collapse();
        let nodes = children.into_iter().map(V::Node::new).collect();
        let mut tree = Self {
            isa: Isa::best(),
            shape,
            frame,
            bounds,
            half: ray::half_box(&frame, &bounds),
            whole: V::Node::NOTHING,
            root,
            depth,
            nodes,
            leaves,
            len: boxes.len(),
        };
        tree.bound_nodes(&packet_bounds);
        tree
    }

    /// Bounds all nodes, given the bounds of the packets.
    fn bound_nodes(&mut self, of_packets: &[<V::Node as WideNode>::Bounds]) {
        let mut of_nodes = vec![V::Node::NOTHING; self.nodes.len()];
        // Children come after their parents.
        for number in (0..self.nodes.len()).rev() {
            let mut all = V::Node::NOTHING;
            let node = &mut self.nodes[number];
            for place in 0..WIDTH {
                let child = node.children()[place];
                if child == NodeRef::NONE {
                    continue;
                }
                let own = if child.is_packet() { of_packets[child.number()] } else { of_nodes[child.number()] };
                all = V::Node::join(&all, &own);
                node.put(place, &own);
            }
            of_nodes[number] = all;
        }
        self.whole = of_packets.iter().fold(V::Node::NOTHING, |all, own| V::Node::join(&all, own));
    }

    /// Fits the tree to another set of as many primitives: the same ones, moved. The tree keeps its shape, so searches
    /// get slower the more primitives have moved apart; answers are those of a tree that is built anew. Boxes are
    /// finite. Of the options only whether all threads are used matters.
    ///
    /// # Panics
    /// If the set has another number of primitives.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(&mut self, set: &S, options: &V::Options) {
        assert_eq!(set.len(), self.len, "as many primitives as before");
        self.refit_to(&|id| Member::of(&set.get(id)), options.splits().parallel);
    }

    /// The same for all sets.
    fn refit_to(&mut self, members: Members<'_>, parallel: bool) {
        let packet_boxes = map(&self.leaves.packets, parallel, |packet| around(&gather(members, packet.ids())));
        self.bounds = packet_boxes.iter().fold(Aabb::empty(), |a, b| a.union(b));
        self.frame = Frame::around(&self.bounds);
        self.half = ray::half_box(&self.frame, &self.bounds);
        let finest = self.frame.unit * FINEST;
        let pack = |(packet, bounds): &(&Packet, &Aabb<f64>)| {
            let primitives = gather(members, packet.ids());
            // A primitive may have become one of another kind.
            let first = primitives[0].kind;
            let kind = if primitives.iter().all(|primitive| primitive.kind == first) { first } else { Kind::Box };
            let enclosed = V::Node::enclose(&self.shape, &self.frame, &primitives, bounds);
            (Packet::new(packet.ids(), &primitives, kind, bounds, finest), enclosed)
        };
        let bounded: Vec<_> = self.leaves.packets.iter().zip(&packet_boxes).collect();
        let (packed, packet_bounds): (Vec<_>, Vec<_>) = map(&bounded, parallel, pack).into_iter().unzip();
        self.leaves = Leaves::new(packed);
        self.bound_nodes(&packet_bounds);
    }

    /// Offers to `collector` every primitive of `set`, over which the tree was built, that it could want. `query` is
    /// finite.
    #[inline]
    pub fn search<T: Real, S: PrimitiveSet<T> + ?Sized, C: Collector>(
        &self,
        set: &S,
        query: &Point3<T>,
        collector: &mut C,
    ) {
        self.run(to_f64_array(query), collector, &evaluation(set, query), finish);
    }

    /// The same for all sets. The callers that are not generic compile it once for what they ask.
    #[inline(always)]
    #[doc(hidden)]
    pub fn run<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        self.isa.run(Search { tree: self, query, reach: f64::INFINITY, held: None, collector, evaluate, finish });
    }

    /// The same for the nearest primitive.
    #[inline]
    #[doc(hidden)]
    pub fn search_nearest<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>) {
        V::nearest(self, to_f64_array(query), best.minimum(), &evaluation(set, query));
    }

    /// The same for what is near.
    #[inline]
    #[doc(hidden)]
    pub fn search_near<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, near: &mut Near<'_>) {
        V::near(self, to_f64_array(query), near, &evaluation(set, query));
    }

    /// Offers to a collector every hit of a ray with the set over which the tree was built that it could want.
    #[inline]
    pub fn search_ray<'r, T: Real, S: PrimitiveSet<T> + ?Sized, C: RayCollector<'r>>(
        &self,
        set: &S,
        ray: &'r Ray,
        collector: &mut C,
    ) {
        let only_crossings = collector.only_crossings();
        let Some(radius) = self.radius_of(ray, only_crossings) else { return };
        self.run_ray(ray, radius, collector, &intersection(set, ray, only_crossings));
    }

    /// The same for all sets.
    #[inline(always)]
    #[doc(hidden)]
    pub fn run_ray<'r, C: RayCollector<'r>>(
        &self,
        ray: &'r Ray,
        radius: f64,
        hits: &mut C,
        intersect: Intersect<'_, 'r>,
    ) {
        self.isa.run(RaySearch { tree: self, ray, radius, hits, intersect });
    }

    /// The same for the hits that its methods want.
    #[inline]
    #[doc(hidden)]
    pub fn search_hits<'r, T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, ray: &'r Ray, hits: &mut Hits<'r>) {
        let only_crossings = hits.only_crossings();
        let Some(radius) = self.radius_of(ray, only_crossings) else { return };
        V::rays(self, ray, radius, hits, &intersection(set, ray, only_crossings));
    }

    /// How near a ray has to come to what is no triangle; `None` if it certainly misses everything.
    #[inline(always)]
    fn radius_of(&self, ray: &Ray, only_crossings: bool) -> Option<f64> {
        let radius = if self.leaves.has_others && !only_crossings { ray.radius } else { 0.0 };
        (self.root != NodeRef::NONE && !ray::misses(ray, radius, &self.frame, &self.half)).then_some(radius)
    }

    /// The children of a node, with boxes around them.
    #[doc(hidden)]
    pub fn child_boxes(&self, node: NodeRef) -> impl Iterator<Item = (Aabb<f64>, NodeRef)> + '_ {
        let node = &self.nodes[node.number()];
        node.used().map(|place| (self.box_of(node, place), node.children()[place]))
    }

    /// A box around a child of a node.
    pub(crate) fn box_of(&self, node: &V::Node, place: usize) -> Aabb<f64> {
        V::Node::disclose(&node.at(place), &self.shape, &self.frame)
    }

    /// Asks for a node or a packet before it is read.
    #[inline(always)]
    pub(crate) fn prefetch(&self, child: NodeRef) {
        let (node, packet) = (self.nodes.as_ptr(), self.leaves.packets.as_ptr());
        let at: *const u8 = if child.is_packet() {
            packet.wrapping_add(child.number()).cast()
        } else {
            node.wrapping_add(child.number()).cast()
        };
        // A packet has seven cache lines, and few nodes have more. What comes behind a node is mostly its sibling.
        prefetch_lines(at, size_of::<Packet>().max(size_of::<V::Node>()));
    }

    /// The instruction set it searches with.
    #[must_use]
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// Searches with another instruction set: the work may differ in the last bits of its bounds, answers do not.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// Heap memory it owns, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.nodes.capacity() * size_of::<V::Node>()
            + self.leaves.packets.memory()
            + self.leaves.vertices.memory()
            + self.leaves.firsts.memory()
    }

    /// Packets, and lanes of them in use: how well they are filled.
    #[must_use]
    pub fn packets(&self) -> (usize, usize) {
        (self.leaves.packets.len(), self.len)
    }
}

impl Leaves {
    /// Puts the vertices of all packets one after the other.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "ids leave two bits, and a primitive has three vertices at most"
    )]
    pub(crate) fn new(packed: Vec<(Packet, Vec<[f64; 3]>)>) -> Self {
        let mut vertices = Vec::with_capacity(packed.iter().map(|(_, own)| own.len()).sum());
        let place = |(mut packet, own): (Packet, Vec<[f64; 3]>)| {
            packet.first_vertex = vertices.len() as u32;
            vertices.extend(own);
            packet
        };
        let packets: Vec<Packet> = packed.into_iter().map(place).collect();
        let firsts =
            packets.iter().map(|packet| packet.first_vertex).chain([vertices.len() as u32]).collect::<Vec<_>>().into();
        let has_others = packets.iter().any(|packet| !packet.has_triangles());
        Self { packets: packets.into(), vertices: vertices.into(), firsts, has_others }
    }

    /// Asks for a packet before it is read.
    #[inline(always)]
    #[doc(hidden)]
    pub fn prefetch(&self, number: usize) {
        prefetch_lines(self.packets.as_ptr().wrapping_add(number), size_of::<Packet>());
    }

    /// Asks for the vertices of a packet, up to eight cache lines.
    #[inline(always)]
    #[doc(hidden)]
    pub fn prefetch_vertices(&self, number: usize) {
        let [first, end] = [self.firsts[number], self.firsts[number + 1]].map(|place| place as usize);
        let bytes = (end - first) * size_of::<[f64; 3]>();
        prefetch_lines(self.vertices.as_ptr().wrapping_add(first), bytes.min(8 * 64));
    }
}

/// Units of packets below this part of the scene's are not needed: 2^-36.
const FINEST: f64 = 1.0 / (1u64 << 36) as f64;

/// The members of a packet.
fn gather(members: Members<'_>, ids: &[PrimitiveId]) -> Vec<Member> {
    ids.iter().map(|id| members(*id)).collect()
}

/// The box around some primitives.
fn around(primitives: &[Member]) -> Aabb<f64> {
    primitives.iter().fold(Aabb::empty(), |all, one| all.union(&one.bounds))
}

/// Offers a primitive of a set to a collector, unless its key exceeds a square.
pub fn evaluation<T: Real, S: PrimitiveSet<T> + ?Sized, C: Collector>(
    set: &S,
    query: &Point3<T>,
) -> impl Fn(&mut C, PrimitiveId, f64) {
    move |collector, id, square| {
        if let Some(projection) = set.get(id).project_within(query, square) {
            collector.offer(id, projection);
        }
    }
}

/// Where a ray meets a primitive of a set, unless that is beyond a parameter.
fn intersection<'r, T: Real, S: PrimitiveSet<T> + ?Sized>(
    set: &S,
    ray: &'r Ray,
    only_crossings: bool,
) -> impl Fn(PrimitiveId, f64) -> Option<Crossing<'r>> {
    move |id, limit| Crossing::of(&set.get(id), ray, limit, only_crossings)
}

/// Maps in order, on all threads if asked to.
fn map<A: Sync, B: Send>(all: &[A], parallel: bool, f: impl Fn(&A) -> B + Sync) -> Vec<B> {
    #[cfg(feature = "rayon")]
    if parallel {
        use rayon::prelude::*;
        return all.par_iter().map(&f).collect();
    }
    let _ = parallel;
    all.iter().map(f).collect()
}
