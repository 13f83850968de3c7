//! What a ray meets: the way through the nodes that it enters, nearest first.
//!
//! The line of the ray is cut to the box of the scene, and begins where it enters that: so nodes can be clipped in f32
//! wherever the ray comes from. Packets leave out what the line certainly misses; the rest is decided exactly.
//! docs/rays.md has the proofs.

use super::node::Frame;
use super::ray_slab::SLIGHT;
use super::volume::{Volume, WideNode};
use super::walk::{Walk, walk};
use super::{Leaves, PacketTree};
use crate::kernel::power_of_two;
use crate::packet::Line;
use crate::ray::TINY;
use crate::simd::{InstructionSet, Lanes, Operation};
use crate::{Aabb, Crossing, PrimitiveId, Ray, RayCollector};
use std::ops::ControlFlow;

/// Where a ray meets a primitive of which the tree has only a box, unless that is beyond a parameter.
pub(crate) type Intersect<'a, 'r> = &'a dyn Fn(PrimitiveId, f64) -> Option<Crossing<'r>>;

/// A search as an operation.
pub(crate) struct RaySearch<'a, 'r, V: Volume, C> {
    pub(crate) tree: &'a PacketTree<V>,
    pub(crate) ray: &'r Ray,
    /// How near it has to come to segments and points: 0 if nothing asks for that.
    pub(crate) radius: f64,
    pub(crate) hits: &'a mut C,
    pub(crate) intersect: Intersect<'a, 'r>,
}

impl<'r, V: Volume, C: RayCollector<'r>> Operation for RaySearch<'_, 'r, V, C> {
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
pub(super) fn misses(ray: &Ray, radius: f64, frame: &Frame, half: &[f64; 3]) -> bool {
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
pub(super) fn half_box(frame: &Frame, bounds: &Aabb<f64>) -> [f64; 3] {
    let half = |k: usize| (bounds.max[k] * 0.5 - bounds.min[k] * 0.5) * (1.0 + SLIGHT);
    std::array::from_fn(|k| half(k) + frame.centre[k].abs() * ROUNDING + TINY)
}

/// The piece of a line that lies in the box of a scene, in the frame of its nodes.
pub(crate) struct FrameLine {
    /// A point of the line before it enters the box, or begins.
    pub(super) base: [f64; 3],
    /// The largest component is 1 or -1.
    pub(super) direction: [f64; 3],
    /// What the base may be off, and the radius of the ray.
    pub(super) margin: f64,
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
    fn line(frame: &Frame, ray: &Ray, radius: f64) -> Line {
        let [x, y, z] = frame.place(&ray.origin).map(f64::abs);
        if x.max(y).max(z) <= FARTHEST { Line::of(ray, radius) } else { Line::from_afar(ray, radius, &frame.centre) }
    }

    /// What lies in the box, half of which is `half`, of a line that begins at the length `from` from its origin. `None` if f32 cannot place it,
    /// `Some(None)` if there is nothing.
    #[inline(always)]
    fn new(frame: &Frame, half: &[f64; 3], line: &Line, from: f64) -> Option<Option<Self>> {
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
    fn limit(&self, length: f64) -> f32 {
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
    use super::super::node::{BoxNode, Child, WIDTH};
    use super::super::slabs::SlabNode;
    use super::*;
    use crate::kdop::Slabs;
    use crate::packet::Member;
    use crate::{Directions, Isa, PrimitiveSet, Triangle};
    use nalgebra::{Point3, Vector3};
    use p2m_testkit::{Cases, cases, vector};
    use rand::RngExt;

    struct Entries<'a, N: WideNode>(&'a N, &'a N::Ray);

    impl<N: WideNode> Operation for Entries<'_, N> {
        type Output = [f32; WIDTH];
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> [f32; WIDTH] {
            let mut entries = [0.0; WIDTH];
            self.0.entries::<I::Eight>(self.1).store(&mut entries);
            entries
        }
    }

    /// Rays to points of some random triangles: how many were hit, all of whose places were entered, and how many other
    /// places were.
    fn compare<N: WideNode>(shape: &N::Shape, name: &str, cases: &Cases) -> [usize; 2] {
        let mut counts = [0; 2];
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng(name, case);
            let place = vector(&mut rng) * 2f64.powi(rng.random_range(-20..20));
            let scale = place.norm() * 2f64.powi(-rng.random_range(0..20));
            let at = |v: Vector3<f64>| Point3::from(place + v * scale);
            let triangles: Vec<_> = (0..WIDTH - 1)
                .map(|_| {
                    let (centre, size) = (vector(&mut rng), 2f64.powi(-rng.random_range(0..20)));
                    let [a, b, c] = [(); 3].map(|()| at(centre + vector(&mut rng) * size));
                    Triangle::new(a, b, c)
                })
                .collect();
            let bounds = triangles[..].aabb();
            let frame = Frame::around(&bounds);
            let mut node = N::new([Child::packet(0); WIDTH]);
            for (place, triangle) in triangles.iter().enumerate() {
                let own = Member::of(triangle);
                node.put(place, &N::enclose(shape, &frame, &[own], &own.bounds));
            }
            for _ in 0..8 {
                let vertices = triangles[rng.random_range(0..WIDTH - 1)].vertices;
                let weights = [(); 3].map(|()| rng.random_range(0.01..1.0));
                let sum: f64 = weights.iter().sum();
                let target = vertices.iter().zip(weights).map(|(v, w)| v.coords * (w / sum)).sum::<Vector3<f64>>();
                let mut direction = vector(&mut rng);
                match rng.random_range(0..4) {
                    0 => direction[rng.random_range(0..3)] = 0.0,
                    1 => direction[rng.random_range(0..3)] *= 2f64.powi(-rng.random_range(20..60)),
                    _ => {}
                }
                let distance = scale * 2f64.powi(rng.random_range(-20..48));
                let ray = Ray::new(&Point3::from(target - direction * distance), &direction).expect("valid");
                let ray = if rng.random() { ray.line() } else { ray };
                let parameter = |triangle: &Triangle<f64>| {
                    Crossing::of(triangle, &ray, f64::INFINITY, false).map(|crossing| crossing.parameter())
                };
                let hits: Vec<Option<f64>> = triangles.iter().map(parameter).collect();
                let line = FrameLine::line(&frame, &ray, 0.0);
                let half = half_box(&frame, &bounds);
                let piece = FrameLine::new(&frame, &half, &line, line.from(ray.min)).expect("plain");
                if misses(&ray, 0.0, &frame, &half) || piece.is_none() {
                    assert!(hits.iter().all(Option::is_none), "{name} {case}: {ray:?}");
                    continue;
                }
                let piece = piece.expect("checked");
                let local = N::ray(shape, &piece);
                for isa in Isa::available() {
                    let entries = isa.run(Entries(&node, &local));
                    assert!(entries[WIDTH - 1] > f32::MAX, "an empty place");
                    for (hit, entry) in hits.iter().zip(entries) {
                        match hit {
                            Some(t) => {
                                let limit = piece.limit(line.to(*t));
                                assert!(entry >= 0.0 && entry <= limit, "{isa} {name} {case}: {entry:e} {limit:e}");
                                counts[0] += 1;
                            }
                            None => counts[1] += usize::from(entry <= f32::MAX),
                        }
                    }
                }
            }
        }
        counts
    }

    #[test]
    fn children_that_are_met_are_entered() {
        let (name, cases) = ("rays and nodes", cases(2_000, 500));
        let of_boxes = compare::<BoxNode>(&(), name, &cases);
        let of_six = compare::<SlabNode<6>>(&Slabs::new(&Directions::default()), name, &cases);
        let of_more = compare::<SlabNode<26>>(&Slabs::new(&Directions::default()), name, &cases);
        println!("hit, and entered besides: boxes {of_boxes:?}, 6-DOPs {of_six:?}, 26-DOPs {of_more:?}");
        assert!(cases.have_more_than(20_000, of_boxes[0]) && of_boxes[0] == of_six[0] && of_six[0] == of_more[0]);
        if cases.is_replay() {
            return;
        }
        assert!(of_more[1] * 3 < of_boxes[1] * 2 && of_boxes[1] < of_boxes[0], "{of_boxes:?} {of_more:?}");
        assert!(of_six[1].abs_diff(of_boxes[1]) * 100 < of_boxes[1], "{of_boxes:?} {of_six:?}");
    }
}
