//! The packets that intersect the balls of corners, found by floods over the Delaunay tetrahedra.
//!
//! The tetrahedra whose balls intersect a primitive are connected through faces, and include the tetrahedra at its
//! vertices ([docs/proofs/p2m.md]). So a flood from the vertices finds them all. It tests few balls that do not
//! intersect the primitive, where a search of the tree for each ball would descend from the root and test one point at
//! a time.
//!
//! Balls whose centres are imprecise, or that are much larger than the scene, are left to searches of the tree. So are
//! all balls if packets intersect too many of them, as around the centre of a sphere.
//!
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md

use crate::delaunay::Delaunay;
use crate::parallel_chunks::map_chunks_in_order;
use crate::voronoi::adjacency::IncidenceLists;
use crate::voronoi::budget::{Limits, to_u32};
use crate::voronoi::corner::CellCorner;
use crate::voronoi::local_numbers::LocalNumbers;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::{LANES, Locals, PLACES, ROUND_UP, at_most};
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, norm_squared};
use std::ops::Range;

/// The number of packets whose balls one task finds.
const PACKETS_PER_TASK: usize = 64;
/// The number of packets that are tried first.
const TRIED_PACKETS: usize = 64;
/// Floods are given up if they test each ball with more packets than this on average, first for the packets that are
/// tried, then for all. Usually it is eight, and thirty take about as long as a search of the tree (observed).
const MAX_PACKETS_PER_BALL: [usize; 2] = [24, 32];
/// The largest radius of a ball that floods handle, in units of 2^40 times the slack, which is about the distance of
/// the bounding sites. Larger balls are left to searches of the tree.
const MAX_RADIUS: f64 = 1.0;

/// The corners of all packets.
pub(crate) struct FloodedCorners {
    /// For each packet the numbers of the corners whose balls it intersects, in ascending order.
    pub(crate) of_packets: IncidenceLists,
    /// For each corner the number of its packets, or [`UNDECIDED`].
    pub(crate) packet_counts: Vec<u32>,
}

/// The number of the packets of a ball that could not be decided, or that has too many for a list.
pub(crate) const UNDECIDED: u32 = u32::MAX;

/// The floods of a triangulation.
pub(crate) struct Flood<'a> {
    tree: &'a PacketTree,
    delaunay: &'a Delaunay,
    corners: &'a [CellCorner],
    limits: Limits<'a>,
    /// For each site some tetrahedron at it.
    tetrahedron_of_site: Vec<u32>,
    /// The radius above which balls are left to searches of the tree.
    max_radius: f64,
    /// An upper bound on the power of a point of a packet in the sphere of a tetrahedron that a flood crosses.
    max_power: f64,
}

/// The state of a flood, reused from packet to packet.
#[derive(Default)]
struct FloodState {
    /// The tetrahedra that were reached, in the order in which they are tested.
    reached: LocalNumbers,
    /// The tetrahedra whose balls the packet intersects.
    found: Vec<u32>,
}

/// The results of some packets.
struct FoundChunk {
    /// For each packet the number of its corners.
    counts: Vec<usize>,
    /// The corners, one packet after the other.
    corners: Vec<u32>,
    /// The number of balls that were tested.
    tested: usize,
}

impl<'a> Flood<'a> {
    /// Prepares the floods of a triangulation with these corners. The result is `None` if some packet has no vertices
    /// from which a flood could begin.
    pub(crate) fn new(
        tree: &'a PacketTree,
        delaunay: &'a Delaunay,
        corners: &'a [CellCorner],
        limits: Limits<'a>,
    ) -> Option<Self> {
        if !tree.leaves.packets.iter().all(|packet| packet.has_vertices()) {
            return None;
        }
        let mut tetrahedron_of_site = vec![0; delaunay.sites().len()];
        for (number, tetrahedron) in (0..).zip(delaunay.tetrahedra()) {
            tetrahedron.iter().for_each(|site| tetrahedron_of_site[*site as usize] = number);
        }
        let max_radius = limits.slack * (1u64 << 40) as f64 * MAX_RADIUS;
        let max_power = 12.0 * limits.slack * max_radius + 48.0 * limits.slack * limits.slack;
        Some(Self { tree, delaunay, corners, limits, tetrahedron_of_site, max_radius, max_power })
    }

    /// Finds the corners of all packets, or returns `None` if that takes too long.
    pub(crate) fn find(&self, progress: &dyn Fn(usize, usize)) -> Option<FloodedCorners> {
        let packet_count = self.tree.leaves.packets.len();
        let mut state = FloodState::default();
        let max_tested = MAX_PACKETS_PER_BALL.map(|most| self.corners.len().saturating_mul(most));
        let (mut tried, max_tried) = ([0; 2], max_tested[0] / packet_count.max(1) * TRIED_PACKETS);
        let step = packet_count.div_ceil(TRIED_PACKETS).max(1);
        for packet in (0..packet_count).step_by(step) {
            self.run(packet, &mut state, max_tried);
            tried = [tried[0] + state.reached.keys().len(), tried[1] + state.found.len()];
            if tried[0] > max_tried {
                return None;
            }
        }
        let mut packet_counts = vec![0; self.corners.len()];
        let of_tree = self.search_tree(&mut packet_counts);
        let budget = self.limits.budget;
        let work = |numbers: Range<usize>| {
            let mut state = FloodState::default();
            let mut chunk = FoundChunk { counts: Vec::new(), corners: Vec::new(), tested: 0 };
            for number in numbers {
                if budget.is_exceeded() {
                    break;
                }
                self.run(number, &mut state, max_tested[1]);
                state.found.extend_from_slice(of_tree.get(number));
                state.found.sort_unstable();
                chunk.corners.extend_from_slice(&state.found);
                chunk.counts.push(state.found.len());
                chunk.tested += state.reached.keys().len();
            }
            budget.charge(chunk.tested);
            chunk
        };
        let mut tested = 0;
        let mut firsts = Vec::with_capacity(packet_count + 1);
        let mut items: Vec<u32> = Vec::with_capacity(tried[1] * step + tried[1] * step / 8);
        map_chunks_in_order(packet_count, PACKETS_PER_TASK, self.limits.parallel, work, |chunk: FoundChunk| {
            tested += chunk.tested;
            if tested > max_tested[1] || !budget.fits::<u32>(items.len() + chunk.corners.len()) {
                return;
            }
            let mut first = items.len();
            for count in chunk.counts {
                firsts.push(to_u32(first));
                first += count;
            }
            chunk.corners.iter().for_each(|corner| packet_counts[*corner as usize] += 1);
            items.extend_from_slice(&chunk.corners);
            progress(firsts.len(), packet_count);
        });
        if tested > max_tested[1] || firsts.len() < packet_count {
            return None;
        }
        firsts.push(to_u32(items.len()));
        items.shrink_to_fit();
        Some(FloodedCorners { of_packets: IncidenceLists::from_parts(firsts, items), packet_counts })
    }

    /// Returns whether a flood decides which packets intersect the ball of a corner.
    fn is_precise(&self, corner: &CellCorner) -> bool {
        corner.radius > 0.0 && corner.error <= self.limits.slack && corner.radius <= self.max_radius
    }

    /// Searches the tree for the packets of all other balls, and returns them by packets.
    fn search_tree(&self, packet_counts: &mut [u32]) -> IncidenceLists {
        let mut found: Vec<(u32, u32)> = Vec::new();
        let mut selections: Vec<Selection> = Vec::new();
        for (number, corner) in self.corners.iter().enumerate().filter(|(_, corner)| !self.is_precise(corner)) {
            selections.clear();
            let is_decided = corner.radius > 0.0
                && !self.limits.budget.is_exceeded()
                && corner.collect_ball(self.tree, self.limits, self.limits.max_list_packets, &mut selections);
            if !is_decided {
                packet_counts[number] = UNDECIDED;
            } else if self.limits.budget.fits::<(u32, u32)>(found.len() + selections.len()) {
                found.extend(selections.iter().map(|selection| (selection.packet, to_u32(number))));
            }
        }
        IncidenceLists::new(self.tree.leaves.packets.len(), found.iter().copied())
    }

    /// Finds the precise corners of a packet, or stops after `max_tested` balls.
    fn run(&self, packet: usize, state: &mut FloodState, max_tested: usize) {
        self.tree.isa().run(FloodPacket { flood: self, packet, state, max_tested });
    }
}

/// The flood from one packet as a SIMD kernel.
///
/// The basic idea is a breadth-first search over tetrahedra, which begins at a vertex of each primitive of the packet:
///
/// ```text
/// queue = one tetrahedron at a vertex of each primitive
/// while tetrahedra are left in the queue:
///     take up to sixteen of them
///     compute the distances from their corners to all lanes of the packet
///     for each tetrahedron whose ball, enlarged by the margins, may intersect the packet:
///         report it if its corner is precise and its ball intersects the packet
///         append its neighbours to the queue
/// ```
///
/// Sixteen corners are tested together because the filter of a packet works on so many points at a time. The packet is
/// compared by its box as well, which excludes more far away. A tetrahedron without a known corner is always crossed,
/// because its ball is unknown.
struct FloodPacket<'a, 'b> {
    flood: &'a Flood<'a>,
    packet: usize,
    state: &'b mut FloodState,
    max_tested: usize,
}

impl SimdKernel for FloodPacket<'_, '_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up; sixteen lanes")]
    fn run<I: InstructionSet>(self) {
        let Self { flood, packet, state: FloodState { reached, found }, max_tested } = self;
        reached.clear();
        found.clear();
        if packet > 0 && flood.tree.leaves.packets[packet - 1].is_continued() {
            // The primitives of a continuation can only tie with primitives of an earlier packet, which have lower ids.
            return;
        }
        let packet = &flood.tree.leaves.packets[packet];
        let (slack, per_unit) = (flood.limits.slack, packet.per_unit());
        let bounds = packet.bounds_of(packet.lanes() as u16);
        let [low, high] = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        for lane in 0..packet.ids().len() {
            let start = flood.tetrahedron_of_site[flood.delaunay.site_of(packet.vertices_of(lane).0[0])];
            reached.number(start);
        }
        let (mut locals, mut squares) = (Locals::default(), [[0.0; LANES]; PLACES]);
        let mut done = 0;
        while done < reached.keys().len() && reached.keys().len() <= max_tested {
            let count = PLACES.min(reached.keys().len() - done);
            let mut tetrahedra = [0; PLACES];
            tetrahedra[..count].copy_from_slice(&reached.keys()[done..done + count]);
            done += count;
            let mut positions = [[0.0; 3]; PLACES];
            for (position, tetrahedron) in positions.iter_mut().zip(&tetrahedra[..count]) {
                *position = flood.corners[*tetrahedron as usize].position;
            }
            packet.squares_at_points::<I>(&positions[..count], &mut locals, &mut squares);
            for (place, &tetrahedron) in tetrahedra[..count].iter().enumerate() {
                let corner = &flood.corners[tetrahedron as usize];
                let aside: V3 =
                    std::array::from_fn(|k| (low[k] - corner.position[k]).max(corner.position[k] - high[k]).max(0.0));
                let box_square = norm_squared(aside) * (1.0 - 16.0 * f64::EPSILON);
                // The filter of the packet is imprecise far away, where its box excludes more.
                let is_within = |radius: f64| {
                    let limit = ((radius * per_unit) as f32 + locals.excess[place]) * ROUND_UP;
                    box_square <= radius * radius
                        && (locals.far >> place & 1 == 1
                            || at_most::<I::Wide>(&squares[place], limit * limit * ROUND_UP) & packet.lanes() != 0)
                };
                let radius = corner.radius + 2.0 * corner.error + slack;
                let outer = corner.radius + corner.error;
                let crossed = (outer * outer + flood.max_power).sqrt() * (1.0 + 8.0 * f64::EPSILON) + corner.error;
                // An unknown corner has no ball.
                if corner.radius > 0.0 {
                    if !is_within(crossed.max(radius)) {
                        continue;
                    }
                    if flood.is_precise(corner) && is_within(radius) {
                        found.push(tetrahedron);
                    }
                }
                for next in flood.delaunay.neighbours()[tetrahedron as usize] {
                    if next != Delaunay::NONE {
                        reached.number(next);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voronoi::budget::BuildBudget;
    use crate::voronoi::corner::compute_corners;
    use nalgebra::{Point3, Vector3};
    use p2m_bvh::SplitOptions;
    use p2m_core::{Primitive, Segment, Shape, Triangle};
    use p2m_testkit::{cases, rng, vector};
    use rand::RngExt;

    /// Runs the floods of some primitives, and passes what they find to `check`, with the tree and the corners.
    fn flood(shapes: &[Shape<f64>], check: impl FnOnce(&PacketTree, &[CellCorner], Option<FloodedCorners>)) {
        let tree: PacketTree = PacketTree::build(shapes, &SplitOptions::default());
        let delaunay = Delaunay::new(&tree.leaves.vertices, 300.0).expect("finite");
        let budget = &BuildBudget::new(1e6, 1e6, shapes.len());
        let limits = Limits { slack: 1e-9, max_list_packets: 2048, max_added_sites: 0, parallel: false, budget };
        let corners = compute_corners(&delaunay, false);
        let found = Flood::new(&tree, &delaunay, &corners, limits).and_then(|flood| flood.find(&|_, _| ()));
        check(&tree, &corners, found);
    }

    /// Floods find each packet that a ball intersects, and hardly any other.
    #[test]
    fn floods_find_the_packets_of_all_balls() {
        let (mut expected_total, mut others) = (0, 0);
        let cases = cases(40, 10);
        for case in cases.clone() {
            let mut rng = rng("floods", case);
            let size = 2f64.powi(-(case as i32 % 5));
            let mut shapes: Vec<Shape<f64>> = Vec::new();
            for i in 0..60 {
                let around = Point3::from(vector(&mut rng));
                let [a, b, c] = [(); 3].map(|()| around + vector(&mut rng) * size);
                shapes.push(if i % 3 == 0 { Segment::new(a, b).into() } else { Triangle::new(a, b, c).into() });
            }
            // Cospherical and coplanar vertices have corners that are unknown or imprecise.
            for _ in 0..case % 4 * 10 {
                let a = Point3::from(std::array::from_fn(|_| f64::from(rng.random_range(-2..3))));
                shapes.push(Segment::new(a, a + Vector3::x()).into());
            }
            flood(&shapes, |tree, corners, found| {
                let found = found.expect("few packets");
                for (number, corner) in (0..).zip(corners).filter(|(_, corner)| corner.radius > 0.0) {
                    let mut count = 0;
                    for (packet, content) in tree.leaves.packets.iter().enumerate() {
                        let position = Point3::from(corner.position);
                        let distances =
                            content.ids().iter().map(|id| shapes[id.index()].project(&position).key.distance());
                        let is_expected = distances.fold(f64::INFINITY, f64::min) <= corner.radius;
                        let is_found = found.of_packets.get(packet).contains(&number);
                        assert!(is_found || !is_expected, "case {case}: corner {number} of packet {packet}");
                        expected_total += usize::from(is_expected);
                        others += usize::from(is_found && !is_expected);
                        count += u32::from(is_found);
                    }
                    assert_eq!(count, found.packet_counts[number as usize], "case {case}: corner {number}");
                }
            });
        }
        println!("{expected_total} expected, {others} others");
        assert!(cases.have_more_than(1000, expected_total) && others * 20 < expected_total);
    }

    /// On a sphere each packet intersects a large part of all balls, so floods are given up.
    #[test]
    fn floods_are_given_up_where_packets_intersect_most_balls() {
        let mut rng = rng("floods on a sphere", 0);
        let shapes: Vec<Shape<f64>> = (0..1000)
            .map(|_| {
                let a = vector(&mut rng).normalize();
                let b = (a + vector(&mut rng) * 1e-3).normalize();
                Segment::new(Point3::from(a), Point3::from(b)).into()
            })
            .collect();
        flood(&shapes, |_, _, found| assert!(found.is_none()));
    }
}
