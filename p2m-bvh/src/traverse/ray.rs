//! What a ray meets: the way through the nodes that it enters, nearest first.
//!
//! The line of the ray is cut to the box of the scene, and begins where it enters that: so nodes can be clipped in f32
//! wherever the ray comes from. Packets leave out what the line certainly misses; the rest is decided exactly.
//! docs/proofs/rays.md has the proofs.

use crate::packet::Line;
use crate::traverse::ray_slab::SLIGHT;
use crate::traverse::{Walk, walk};
use crate::tree::aabb_node::Frame;
use crate::tree::volume::{Volume, WideNode};
use crate::tree::{Leaves, PacketTree};
use p2m_core::engine::ray::TINY;
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::power_of_two;
use p2m_core::{Aabb, Crossing, PrimitiveId, Ray, RayCollector};
use std::ops::ControlFlow;

/// Where a ray meets a primitive of which the tree has only a box, unless that is beyond a parameter.
pub type Intersect<'a, 'r> = &'a dyn Fn(PrimitiveId, f64) -> Option<Crossing<'r>>;

/// A search as an operation.
pub struct RaySearch<'a, 'r, V: Volume, C> {
    pub tree: &'a PacketTree<V>,
    pub ray: &'r Ray,
    /// How near it has to come to segments and points: 0 if nothing asks for that.
    pub radius: f64,
    pub hits: &'a mut C,
    pub intersect: Intersect<'a, 'r>,
}

impl<'r, V: Volume, C: RayCollector<'r>> SimdKernel for RaySearch<'_, 'r, V, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { tree, ray, radius, hits, intersect } = self;
        let mut tests = Tests { leaves: &tree.leaves, ray, only_crossings: hits.only_crossings(), hits, intersect };
        let line = FrameLine::line(&tree.frame, ray, radius);
        let from = line.from(ray.min);
        let Some(piece) = FrameLine::new(&tree.frame, &tree.half, &line, from) else {
            return tests.everything();
        };
        if let Some(piece) = piece {
            let local = V::Node::ray(&tree.shape, &piece);
            let mut entering = Entering { tests, line, piece, local, from, to: 0.0, limit: 0.0 };
            entering.update();
            walk::<I, V, _>(tree, &mut entering);
        }
    }
}

/// Exact tests of primitives.
struct Tests<'a, 'r, C> {
    leaves: &'a Leaves,
    ray: &'r Ray,
    only_crossings: bool,
    hits: &'a mut C,
    intersect: Intersect<'a, 'r>,
}

impl<'r, C: RayCollector<'r>> Tests<'_, 'r, C> {
    /// Tests the primitive in a lane of a packet; breaks if no other one matters.
    #[inline(always)]
    fn test(&mut self, packet: usize, lane: usize) -> ControlFlow<()> {
        let packet = &self.leaves.packets[packet];
        let id = packet.ids()[lane];
        if !self.hits.wants(id) {
            return ControlFlow::Continue(());
        }
        self.hits.visit_primitive();
        let limit = self.hits.limit();
        let (places, count) = packet.vertices_of(lane);
        let crossing = if count == 0 {
            (self.intersect)(id, limit)
        } else {
            let vertices = places.map(|place| self.leaves.vertices[place]);
            Crossing::of_vertices(self.ray, &vertices[..count], limit, self.only_crossings)
        };
        match crossing {
            Some(crossing) => self.hits.offer(id, &crossing),
            None => ControlFlow::Continue(()),
        }
    }

    /// Rays and scenes that f32 and f64 cannot place.
    #[cold]
    #[inline(never)]
    fn everything(&mut self) {
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

/// Of some sums and products of f64.
const ROUNDING: f64 = power_of_two(-48);
/// What positions may be off in the frame besides, which is small beside rounding to f32.
const MARGIN: f64 = power_of_two(-30);

/// Whether a ray certainly misses the box of a scene, half of which is `half`: it begins outside and goes away, or the
/// box lies on one side of its projection along an axis. Most rays from far away are done with that.
#[inline(always)]
pub fn misses(ray: &Ray, radius: f64, frame: &Frame, half: &[f64; 3]) -> bool {
    let (o, d, c) = (&ray.origin, &ray.direction, &frame.centre);
    let towards = [c[0] - o[0], c[1] - o[1], c[2] - o[2]];
    // With room for all rounding here (the centre has brought its own), and for that of a parameter to zero.
    let half = [0, 1, 2].map(|k: usize| half[k] + o[k].abs() * ROUNDING + d[k].abs() * TINY + radius);
    // All of it and then one branch: one after the other they are mispredicted.
    let away = |k: usize| (towards[k] > half[k]) & (d[k] <= 0.0) | (towards[k] < -half[k]) & (d[k] >= 0.0);
    let goes_away = (ray.min >= 0.0) & (away(0) | away(1) | away(2));
    let beside = |i: usize, j: usize| {
        let off = (towards[i] * d[j] - towards[j] * d[i]).abs();
        let least = half[i] * d[j].abs() + half[j] * d[i].abs();
        // Not where something overflows.
        (off > least + TINY) & (off <= f64::MAX)
    };
    goes_away | beside(0, 1) | beside(1, 2) | beside(2, 0)
}

/// Half of the box of a scene, with room for the rounding of its centre and of what [`misses`] computes.
pub fn half_box(frame: &Frame, bounds: &Aabb<f64>) -> [f64; 3] {
    let half = |k: usize| (bounds.max[k] * 0.5 - bounds.min[k] * 0.5) * (1.0 + SLIGHT);
    std::array::from_fn(|k| half(k) + frame.centre[k].abs() * ROUNDING + TINY)
}

/// The piece of a line that lies in the box of a scene, in the frame of its nodes.
pub struct FrameLine {
    /// A point of the line before it enters the box, or begins.
    pub base: [f64; 3],
    /// The largest component is 1 or -1.
    pub direction: [f64; 3],
    /// What the base may be off, and the radius of the ray.
    pub margin: f64,
    /// From the origin of the line to the base.
    ahead: f64,
    /// From the base to behind the box.
    length: f64,
    per_unit: f64,
}

/// Lines that begin at most so many units away are placed well enough in f64.
const FARTHEST: f64 = power_of_two(30);
/// Beyond so many units a radius is not worth a search.
const WIDEST: f64 = 64.0;
/// What the box is widened by, in units.
const BESIDE: f64 = power_of_two(-20);

impl FrameLine {
    /// The line of a ray, from near the scene.
    #[inline(always)]
    pub fn line(frame: &Frame, ray: &Ray, radius: f64) -> Line {
        let [x, y, z] = frame.place(&ray.origin).map(f64::abs);
        if x.max(y).max(z) <= FARTHEST { Line::of(ray, radius) } else { Line::from_afar(ray, radius, &frame.centre) }
    }

    /// What lies in the box, half of which is `half`, of a line that begins at the length `from` from its origin. `None` if f32 cannot place it,
    /// `Some(None)` if there is nothing.
    #[inline(always)]
    pub fn new(frame: &Frame, half: &[f64; 3], line: &Line, from: f64) -> Option<Option<Self>> {
        let q = frame.place(&line.origin);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        let (off, radius) = (line.off * frame.per_unit, line.radius * frame.per_unit);
        if !(frame.is_plain() && radius <= WIDEST) {
            return None;
        }
        // The foot of the centre of the scene: rounding moves what is far away by much more than the scene is large.
        if largest - off > FARTHEST {
            return Some(None);
        }
        let radius = radius + off;
        if !(radius <= WIDEST && largest <= FARTHEST) {
            return None;
        }
        let from = from * frame.per_unit;
        let (mut enter, mut exit) = (from - from.abs() * ROUNDING - BESIDE, f64::INFINITY);
        for k in 0..3 {
            let d = line.direction[k];
            // The box is symmetric about the centre of the frame.
            let reach = half[k] * frame.per_unit + radius + BESIDE;
            // So far from the origin along this axis that the rounding of its centre hides the scene.
            if reach > 2.0 * WIDEST {
                return None;
            }
            let [low, high] = [-reach - q[k], reach - q[k]];
            if d == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return Some(None);
                }
                continue;
            }
            let (near, far) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
            enter = enter.max(near);
            exit = exit.min(far);
        }
        if enter > exit {
            return Some(None);
        }
        let base = std::array::from_fn(|k| q[k] + enter * line.direction[k]);
        let margin = ROUNDING * (largest + enter.abs()) + MARGIN + radius;
        Some(Some(Self {
            base,
            direction: line.direction,
            margin,
            ahead: enter,
            length: exit - enter,
            per_unit: frame.per_unit,
        }))
    }

    /// A length along the line from its origin as one from the base, rounded up.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    pub fn limit(&self, length: f64) -> f32 {
        let length = length * self.per_unit;
        let from_base = length - self.ahead + (length.abs() + self.ahead.abs()) * ROUNDING;
        // Bounds of nodes are good to 2^-22, and NaN comes of infinity.
        let length = if from_base < self.length { from_base } else { self.length };
        (length as f32) * (1.0 + 16.0 * f32::EPSILON) + f32::EPSILON
    }
}

/// A search on its way through the nodes.
struct Entering<'a, 'r, V: Volume, C> {
    tests: Tests<'a, 'r, C>,
    line: Line,
    piece: FrameLine,
    local: <V::Node as WideNode>::Ray,
    /// The lengths along the line between which hits matter, from its origin, and the latter from the base.
    from: f64,
    to: f64,
    limit: f32,
}

impl<'r, V: Volume, C: RayCollector<'r>> Entering<'_, 'r, V, C> {
    /// Brings the limits up to date with the collector.
    #[inline(always)]
    fn update(&mut self) {
        let limit = self.tests.hits.limit();
        self.to = self.line.to(if limit < self.tests.ray.max { limit } else { self.tests.ray.max });
        self.limit = self.piece.limit(self.to);
    }
}

impl<'r, V: Volume, C: RayCollector<'r>> Walk<V> for Entering<'_, 'r, V, C> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        node.entries(&self.local)
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
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()> {
        self.tests.hits.visit_packet();
        self.tests.leaves.prefetch_vertices(number);
        let mut met = self.tests.leaves.packets[number].met_by::<I>(&self.line, self.from, self.to);
        while met != 0 {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            self.tests.test(number, lane)?;
            self.update();
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AabbTree;
    use nalgebra::{Point3, Vector3};
    use p2m_core::{BuildIndex, Crossing, Hits, RayStatsCollector, Triangle};

    /// Wants the hit of one primitive.
    #[derive(Clone)]
    struct Only(usize, Vec<PrimitiveId>);

    impl<'r> RayCollector<'r> for Only {
        fn wants(&self, primitive: PrimitiveId) -> bool {
            primitive.index() == self.0
        }
        fn offer(&mut self, primitive: PrimitiveId, _: &Crossing<'r>) -> ControlFlow<()> {
            self.1.push(primitive);
            ControlFlow::Continue(())
        }
    }

    #[test]
    fn what_is_not_wanted_is_not_tested() {
        let points = [0.0, 1.0, 2.0].map(|x| p2m_core::Point::new(Point3::new(x, 0.0, 0.0)));
        let tree = AabbTree::build(&points, &Default::default()).unwrap();
        let ray = Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).unwrap();
        for wanted in 0..3 {
            let mut counting = RayStatsCollector::new(Only(wanted, Vec::new()));
            tree.visit_ray(&ray, &mut counting);
            assert_eq!((counting.primitives, counting.collector.1), (1, vec![PrimitiveId::new(wanted)]));
        }
    }

    #[test]
    fn what_is_counted_is_what_is_wanted() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let square =
            [Triangle::new(corners[0], corners[1], corners[2]), Triangle::new(corners[0], corners[2], corners[3])];
        let tree = AabbTree::build(square, &Default::default()).unwrap();
        let ray = Ray::new(&Point3::new(1.0, 1.0, 3.0), &Vector3::new(0.0, 0.0, -1.0)).unwrap();
        let search = |wanted: Hits<'static>| {
            let mut counting = RayStatsCollector::new(RayStatsCollector::new(wanted));
            tree.visit_ray(&ray, &mut counting);
            let inner = &counting.collector;
            assert_eq!(
                [counting.nodes, counting.packets, counting.primitives],
                [inner.nodes, inner.packets, inner.primitives]
            );
            (counting.primitives, counting.limit(), counting.collector.collector)
        };
        assert_eq!(search(Hits::any()).0, 1);
        assert_eq!(search(Hits::first()).1, 3.0);
        assert_eq!(search(Hits::all()).2.all.len(), 2);
        assert_eq!(search(Hits::count()).2.count, 2);
        assert_eq!(search(Hits::crossings()).2.count, 1);
    }
}
