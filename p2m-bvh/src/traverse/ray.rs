//! Ray casting: a traversal of the nodes that a ray enters, nearest first.
//!
//! The filters of packets exclude primitives that the line of the ray certainly misses; the others are tested exactly.
//! [docs/proofs/rays.md] has the proofs.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use crate::packet::RayLine;
use crate::traverse::primitive_fn::IntersectFn;
use crate::traverse::{Visitor, traverse};
use crate::tree::frame_line::{FrameLine, misses_scene};
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode, entries, is_inlined};
use crate::tree::{Leaves, PacketTree};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::{Crossing, Isa, Ray, RayCollector};
use std::ops::ControlFlow;

/// The exact test of a primitive, which is given by its packet and its lane. It returns the new parameter above which
/// hits are not needed, or `None` if no further hit is needed.
pub(crate) type TestFn<'a> = &'a mut dyn FnMut(usize, usize) -> Option<f64>;

impl<V: VolumeNodes> PacketTree<V> {
    /// Returns the radius within which a ray hits primitives other than triangles, or `None` if it certainly misses the
    /// scene.
    #[inline(always)]
    pub(crate) fn search_radius(&self, ray: &Ray, only_crossings: bool) -> Option<f64> {
        let radius = if self.leaves.has_non_triangles && !only_crossings { ray.radius } else { 0.0 };
        (self.root != NodeRef::NONE && !misses_scene(ray, radius + ray.origin_error, &self.frame, &self.half_extent))
            .then_some(radius)
    }
}

/// A ray search as a kernel that is compiled for each instruction set. It returns the numbers of visited nodes and
/// packets.
pub(crate) struct RaySearch<'a, V: VolumeNodes> {
    pub(crate) tree: &'a PacketTree<V>,
    pub(crate) ray: &'a Ray,
    /// The radius within which the ray hits segments and points; 0 if there are none, or if they do not count.
    pub(crate) radius: f64,
    /// The parameter above which hits are not needed.
    pub(crate) limit: f64,
    pub(crate) test: TestFn<'a>,
}

impl<V: VolumeNodes> SimdKernel for RaySearch<'_, V> {
    type Output = [usize; 2];

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [usize; 2] {
        let Self { tree, ray, radius, limit, test } = self;
        let line = FrameLine::line_of(&tree.frame, ray, radius);
        let from = line.length_below(ray.min);
        let Some(piece) = FrameLine::new(&tree.frame, &tree.half_extent, &line, from) else {
            return [0, test_all(&tree.leaves, test)];
        };
        let Some(piece) = piece else { return [0, 0] };
        let local = V::Node::ray(&tree.shared, &piece);
        let (leaves, max) = (&tree.leaves, ray.max);
        let mut visitor =
            RayVisitor { leaves, test, max, line, piece, local, from, to: 0.0, limit: 0.0, visits: [0, 0] };
        visitor.update_limits(limit);
        traverse::<I, V, _>(tree, &mut visitor);
        visitor.visits
    }
}

/// Tests all primitives, for rays and scenes whose positions neither f32 nor f64 resolves. Returns the number of tested
/// packets.
#[cold]
#[inline(never)]
fn test_all(leaves: &Leaves, test: TestFn<'_>) -> usize {
    for (number, packet) in leaves.packets.iter().enumerate() {
        for lane in 0..packet.ids().len() {
            if test(number, lane).is_none() {
                return number + 1;
            }
        }
    }
    leaves.packets.len()
}

/// The exact tests of the primitives of a tree with a ray.
pub(crate) struct ExactTests<'a, 'r, C> {
    pub(crate) leaves: &'a Leaves,
    pub(crate) isa: Isa,
    pub(crate) ray: &'r Ray,
    pub(crate) only_crossings: bool,
    pub(crate) hits: &'a mut C,
    pub(crate) intersect: IntersectFn<'a, 'r>,
}

impl<'r, C: RayCollector<'r>> ExactTests<'_, 'r, C> {
    /// Tests the primitive in a lane of a packet, as a [`TestFn`].
    #[inline(never)]
    pub(crate) fn test(&mut self, packet: usize, lane: usize) -> Option<f64> {
        self.isa.run(ExactTest { tests: self, packet, lane })
    }
}

/// An exact test as a kernel. It has no lanes, but processors with more instructions copy its structures faster. It
/// depends neither on the volume nor on the set.
struct ExactTest<'t, 'a, 'r, C> {
    tests: &'t mut ExactTests<'a, 'r, C>,
    packet: usize,
    lane: usize,
}

impl<'r, C: RayCollector<'r>> SimdKernel for ExactTest<'_, '_, 'r, C> {
    type Output = Option<f64>;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Option<f64> {
        let Self { tests: ExactTests { leaves, ray, only_crossings, hits, intersect, .. }, packet, lane } = self;
        let packet = &leaves.packets[packet];
        let id = packet.ids()[lane];
        if hits.wants(id) {
            hits.visit_primitive();
            let limit = hits.limit();
            let (indices, count) = packet.vertices_of(lane);
            let crossing = if count == 0 {
                intersect(id, limit)
            } else {
                let [a, b, c] = indices;
                let vertices = [leaves.vertices[a], leaves.vertices[b], leaves.vertices[c]];
                Crossing::from_vertices(ray, &vertices[..count], limit, *only_crossings)
            };
            if let Some(crossing) = crossing
                && hits.offer(id, &crossing).is_break()
            {
                return None;
            }
        }
        Some(hits.limit())
    }
}

/// The visitor of a ray search.
struct RayVisitor<'a, V: VolumeNodes> {
    leaves: &'a Leaves,
    test: TestFn<'a>,
    /// The largest parameter of the ray.
    max: f64,
    line: RayLine,
    piece: FrameLine,
    local: <V::Node as WideNode>::Ray,
    /// The length from the origin of the line at which the search begins.
    from: f64,
    /// The length from the origin of the line at which the search ends.
    to: f64,
    /// The length from the base of the piece at which the search ends, in the frame of the tree.
    limit: f32,
    /// The numbers of visited nodes and packets.
    visits: [usize; 2],
}

impl<V: VolumeNodes> RayVisitor<'_, V> {
    /// Computes the limits from the parameter above which hits are not needed.
    #[inline(always)]
    fn update_limits(&mut self, limit: f64) {
        self.to = self.line.length_above(if limit < self.max { limit } else { self.max });
        self.limit = self.piece.limit(self.to);
    }
}

impl<V: VolumeNodes> Visitor<V> for RayVisitor<'_, V> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        entries(node, &self.local)
    }
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }
    #[inline(always)]
    fn visit_node(&mut self) {
        self.visits[0] = self.visits[0].wrapping_add(1);
    }
    #[inline(always)]
    fn visit_packet<I: InstructionSet>(&mut self, mut number: usize) -> ControlFlow<()> {
        loop {
            self.visits[1] = self.visits[1].wrapping_add(1);
            self.leaves.prefetch_vertices(number);
            let (packet, is_inlined) = (&self.leaves.packets[number], is_inlined::<V, I>());
            let mut passed = packet.lanes_hit_by::<I>(is_inlined, &self.line, self.from, self.to);
            while passed != 0 {
                let lane = passed.trailing_zeros() as usize;
                passed &= passed - 1;
                let Some(limit) = (self.test)(number, lane) else { return ControlFlow::Break(()) };
                self.update_limits(limit);
            }
            if !self.leaves.packets[number].is_continued() {
                return ControlFlow::Continue(());
            }
            number += 1;
        }
    }
}
