//! Ray casting: the traversal of the nodes that a ray enters, nearest first.
//!
//! Packets leave out primitives that the line of the ray certainly misses; the others are tested exactly.
//! [docs/proofs/rays.md] has the proofs.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use crate::packet::RayLine;
use crate::traverse::primitive_fn::{IntersectFn, intersection};
use crate::traverse::{Visitor, traverse};
use crate::tree::frame_line::{FrameLine, misses_scene};
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode, entries};
use crate::tree::{Leaves, PacketTree};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::{Crossing, PrimitiveSet, Ray, RayCollector, Real};
use std::ops::ControlFlow;

impl<V: VolumeNodes> PacketTree<V> {
    /// Offers to `collector` every hit of a ray with `set` that it could want. The tree has to be built over that set.
    #[inline]
    pub fn search_ray<'r, T: Real, S: PrimitiveSet<T> + ?Sized, C: RayCollector<'r>>(
        &self,
        set: &S,
        ray: &'r Ray,
        collector: &mut C,
    ) {
        let only_crossings = collector.only_crossings();
        let Some(radius) = self.search_radius(ray, only_crossings) else { return };
        self.run_ray(ray, radius, collector, &intersection(set, ray, only_crossings));
    }

    /// Runs the search of [`search_ray`](Self::search_ray) for any set. Callers that are not generic compile it once.
    #[inline(always)]
    #[doc(hidden)]
    pub fn run_ray<'r, C: RayCollector<'r>>(
        &self,
        ray: &'r Ray,
        radius: f64,
        hits: &mut C,
        intersect: IntersectFn<'_, 'r>,
    ) {
        self.isa.run(RaySearch { tree: self, ray, radius, hits, intersect });
    }

    /// The distance within which a ray hits primitives that are not triangles; `None` if it certainly misses the scene.
    #[inline(always)]
    pub(crate) fn search_radius(&self, ray: &Ray, only_crossings: bool) -> Option<f64> {
        let radius = if self.leaves.has_non_triangles && !only_crossings { ray.radius } else { 0.0 };
        (self.root != NodeRef::NONE && !misses_scene(ray, radius + ray.origin_error, &self.frame, &self.half_extent))
            .then_some(radius)
    }
}

/// A search with a ray as a kernel that is compiled for each instruction set.
struct RaySearch<'a, 'r, V: VolumeNodes, C> {
    tree: &'a PacketTree<V>,
    ray: &'r Ray,
    /// The distance within which the ray hits segments and points; 0 if there are none, or if they do not count.
    radius: f64,
    hits: &'a mut C,
    intersect: IntersectFn<'a, 'r>,
}

impl<'r, V: VolumeNodes, C: RayCollector<'r>> SimdKernel for RaySearch<'_, 'r, V, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { tree, ray, radius, hits, intersect } = self;
        let mut tests =
            ExactTests { leaves: &tree.leaves, ray, only_crossings: hits.only_crossings(), hits, intersect };
        let line = FrameLine::line_of(&tree.frame, ray, radius);
        let from = line.length_below(ray.min);
        let Some(piece) = FrameLine::new(&tree.frame, &tree.half_extent, &line, from) else {
            return tests.test_all();
        };
        if let Some(piece) = piece {
            let local = V::Node::ray(&tree.shared, &piece);
            let mut visitor = RayVisitor { tests, line, piece, local, from, to: 0.0, limit: 0.0 };
            visitor.update_limits();
            traverse::<I, V, _>(tree, &mut visitor);
        }
    }
}

/// The exact tests of a ray with primitives.
struct ExactTests<'a, 'r, C> {
    leaves: &'a Leaves,
    ray: &'r Ray,
    only_crossings: bool,
    hits: &'a mut C,
    intersect: IntersectFn<'a, 'r>,
}

impl<'r, C: RayCollector<'r>> ExactTests<'_, 'r, C> {
    /// Tests the primitive in a lane of a packet; breaks if the collector wants no further hit.
    #[inline(always)]
    fn test(&mut self, packet: usize, lane: usize) -> ControlFlow<()> {
        let packet = &self.leaves.packets[packet];
        let id = packet.ids()[lane];
        if !self.hits.wants(id) {
            return ControlFlow::Continue(());
        }
        self.hits.visit_primitive();
        let limit = self.hits.limit();
        let (indices, count) = packet.vertices_of(lane);
        let crossing = if count == 0 {
            if let Some(flow) = self.hits.take_candidate(id, &[]) {
                return flow;
            }
            (self.intersect)(id, limit)
        } else {
            let vertices = indices.map(|index| self.leaves.vertices[index]);
            if let Some(flow) = self.hits.take_candidate(id, &vertices[..count]) {
                return flow;
            }
            crossing(self.ray, &vertices[..count], limit, self.only_crossings)
        };
        match crossing {
            Some(crossing) => self.hits.offer(id, &crossing),
            None => ControlFlow::Continue(()),
        }
    }

    /// Tests all primitives, for rays and scenes whose positions neither f32 nor f64 resolves.
    #[cold]
    #[inline(never)]
    fn test_all(&mut self) {
        for number in 0..self.leaves.packets.len() {
            self.hits.visit_packet();
            for lane in 0..self.leaves.packets[number].ids().len() {
                if self.test(number, lane).is_break() {
                    return;
                }
            }
        }
    }
}

/// Calls [`Crossing::from_vertices`] out of line, so that it is compiled once for all volumes and instruction sets.
#[inline(never)]
fn crossing<'r>(ray: &'r Ray, vertices: &[[f64; 3]], limit: f64, only_crossings: bool) -> Option<Crossing<'r>> {
    Crossing::from_vertices(ray, vertices, limit, only_crossings)
}

/// The visitor of a search with a ray.
struct RayVisitor<'a, 'r, V: VolumeNodes, C> {
    tests: ExactTests<'a, 'r, C>,
    line: RayLine,
    piece: FrameLine,
    local: <V::Node as WideNode>::Ray,
    /// The length from the origin of the line at which the search begins.
    from: f64,
    /// The length from the origin of the line at which the search ends.
    to: f64,
    /// The length from the base of the piece at which the search ends, in the frame of the tree.
    limit: f32,
}

impl<'r, V: VolumeNodes, C: RayCollector<'r>> RayVisitor<'_, 'r, V, C> {
    /// Computes the limits from the collector.
    #[inline(always)]
    fn update_limits(&mut self) {
        let limit = self.tests.hits.limit();
        self.to = self.line.length_above(if limit < self.tests.ray.max { limit } else { self.tests.ray.max });
        self.limit = self.piece.limit(self.to);
    }
}

impl<'r, V: VolumeNodes, C: RayCollector<'r>> Visitor<V> for RayVisitor<'_, 'r, V, C> {
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
        self.tests.hits.visit_node();
    }
    #[inline(always)]
    fn visit_packet<I: InstructionSet>(&mut self, mut number: usize) -> ControlFlow<()> {
        loop {
            self.tests.hits.visit_packet();
            self.tests.leaves.prefetch_vertices(number);
            let mut passed = self.tests.leaves.packets[number].lanes_hit_by::<I>(&self.line, self.from, self.to);
            while passed != 0 {
                let lane = passed.trailing_zeros() as usize;
                passed &= passed - 1;
                self.tests.test(number, lane)?;
                self.update_limits();
            }
            if !self.tests.leaves.packets[number].is_continued() {
                return ControlFlow::Continue(());
            }
            number += 1;
        }
    }
}
