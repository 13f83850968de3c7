//! The list of a finished cell, and the sample at its centre that decides whether the cell is finished.

use crate::list::block::{BLOCK_WIDTH, Block, BoundKind, Entry, round_reference};
use crate::list::corner_test::{DistancesAtPoints, LaneDistances, MinOverLanes};
use crate::octree::cell::{Cube, LATTICE_CENTRE};
use crate::octree::refinement::{
    CellCentre, NS_PER_BLOCK, NS_PER_NODE, NS_PER_PACKET, NearestSample, PacketCandidate, RefinedCell, Refinement,
    TreeProbe,
};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Best, QueryOptions};

/// A cell with a longer list is left to the tree.
const MAX_LIST_PACKETS: usize = 256;
/// Longer lists are compared with a search of the tree at the centre of the cell.
const COMPARE_WITH_TREE_ABOVE_PACKETS: usize = 24;

impl Refinement<'_> {
    /// Returns the point of the sampled primitive that is nearest to `x`. If the filters do not bound all packets, it
    /// searches the tree for the nearest point of the scene instead.
    pub(crate) fn nearest_of_sample(&self, near: &NearestSample, has_all_bounds: bool, x: V3) -> V3 {
        if !has_all_bounds || near.distance == f64::INFINITY {
            return self.nearest(x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        let packet = &self.tree.leaves.packets[near.packet as usize];
        packet.offer(near.lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }

    /// Runs the filters of all packets at the centre of a cell.
    pub(crate) fn sample_centre(&self, cube: &Cube, candidates: &[PacketCandidate<'_>]) -> CellCentre {
        let x = cube.point(LATTICE_CENTRE);
        let mut centre = CellCentre {
            distances: Vec::with_capacity(candidates.len()),
            has_all_bounds: true,
            y: x,
            passing_boxes: 0,
            passing_corners: 0,
        };
        let mut nearest = NearestSample::NONE;
        self.counters.charge_tests(candidates.len());
        for candidate in candidates {
            let mut distances = [LaneDistances::UNKNOWN];
            let mut near = [None];
            let packet = &self.tree.leaves.packets[candidate.packet as usize];
            centre.has_all_bounds &= packet.has_vertices();
            self.isa().run(DistancesAtPoints { packet, points: &[x], distances: &mut distances, nearest: &mut near });
            centre.distances.push(distances[0]);
            nearest.add(near[0], candidate.packet);
        }
        centre.y = self.nearest_of_sample(&nearest, centre.has_all_bounds, x);
        // The next lines count the packets that each kind of bounds lets pass at the centre.
        let squares = cube.corners.map(|corner| norm_squared(sub(corner.x, centre.y)));
        let y_squared = norm_squared(sub(x, centre.y));
        let f = candidates.iter().map(|candidate| {
            let unit = self.tree.leaves.packets[candidate.packet as usize].unit();
            let PacketCandidate { distances, corners, lanes, .. } = *candidate;
            let least = self.isa().run(MinOverLanes { distances, points: corners, lanes });
            std::array::from_fn(|i| (least[i] * unit) * (least[i] * unit) - squares[i])
        });
        let f: Vec<[f64; 8]> = f.collect();
        let top = f.as_flattened().iter().fold(0.0f64, |a, x| a.max(-x));
        let bound = |f: &[f64; 8]| y_squared + f.iter().map(|f| f.min(top)).sum::<f64>() / 8.0 - top / 128.0;
        centre.passing_corners = f.iter().filter(|f| bound(f) <= y_squared).count();
        // Boxes are considered only near the scene, and only if corners let several packets pass.
        centre.passing_boxes = if centre.passing_corners > 2 && y_squared < 4.0 * cube.side * cube.side {
            let bound = |candidate: &PacketCandidate<'_>| candidate.bounds.lower_bound(&nalgebra::Point3::from(x));
            candidates.iter().filter(|candidate| bound(candidate) <= y_squared).count()
        } else {
            usize::MAX
        };
        centre
    }

    /// Builds the list of a cell as it is stored, or a cell without a list if the tree is better.
    pub(crate) fn build_list(
        &self,
        cube: &Cube,
        candidates: &[PacketCandidate<'_>],
        centre: &CellCentre,
    ) -> RefinedCell {
        let frame = &self.tree.frame;
        let y = round_reference(frame.place(&centre.y));
        let squares = cube.corners.map(|corner| norm_squared(sub(frame.place(&corner.x), y)));
        // The margin covers the rounding in f64 of these squares and of positions in the frame, and the error of the
        // cell in which a query is located. Values of f matter only below zero, where f changes by at most twice the
        // distance to y for each unit of displacement.
        let largest = squares.iter().fold(1.0, |a: f64, x| a.max(*x));
        let margin = largest * 2f64.powi(-46) + 4.0 * self.slack * frame.per_unit * largest.sqrt();
        let mut entries: Vec<(f64, Entry)> = Vec::with_capacity(candidates.len());
        let mut single = None;
        let mut count = 0;
        for (candidate, distances) in candidates.iter().zip(&centre.distances) {
            let packet = &self.tree.leaves.packets[candidate.packet as usize];
            let lanes = self.lanes_without_ties(cube, candidate);
            if lanes == 0 {
                continue;
            }
            count += lanes.count_ones();
            single = Some((candidate.packet, lanes.trailing_zeros()));
            let bounds = frame.enclose(&packet.bounds_of(lanes));
            let length = packet.unit() * frame.per_unit;
            let PacketCandidate { distances: at_corners, corners, .. } = *candidate;
            let least = self.isa().run(MinOverLanes { distances: at_corners, points: corners, lanes });
            let f = std::array::from_fn(|i| (least[i] * length) * (least[i] * length) - squares[i] - margin);
            // Packets that are nearer to the centre come into earlier blocks.
            let order =
                self.isa().run(MinOverLanes { distances: std::slice::from_ref(distances), points: &[0], lanes })[0]
                    * length;
            entries.push((order, Entry { packet: candidate.packet, lanes, bounds, f }));
        }
        match (count, single) {
            (1, Some((packet, lane))) => RefinedCell::Single(packet, u8::try_from(lane).expect("sixteen lanes")),
            _ if entries.is_empty()
                || entries.len() > MAX_LIST_PACKETS
                || self.is_tree_faster(cube, entries.len(), centre) =>
            {
                RefinedCell::Tree
            }
            _ => {
                entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
                let entries: Vec<Entry> = entries.into_iter().map(|e| e.1).collect();
                let bounds = if centre.passing_boxes < centre.passing_corners {
                    BoundKind::Boxes
                } else {
                    BoundKind::Corners { level: cube.level, y }
                };
                RefinedCell::Blocks(Block::from_list(&entries, bounds))
            }
        }
    }

    /// Returns whether a search of the tree takes less time at the centre of the cell than a long list would.
    fn is_tree_faster(&self, cube: &Cube, len: usize, centre: &CellCentre) -> bool {
        if len <= COMPARE_WITH_TREE_ABOVE_PACKETS {
            return false;
        }
        let tests = centre.passing_boxes.min(centre.passing_corners) as f64;
        let list = NS_PER_PACKET * tests + NS_PER_BLOCK * len as f64 / BLOCK_WIDTH as f64;
        let TreeProbe { nodes, packets, .. } = self.probe_tree(cube.point(LATTICE_CENTRE));
        list > NS_PER_PACKET * packets as f64 + NS_PER_NODE * nodes as f64
    }

    /// Returns the lanes of a candidate without those that can only tie with a primitive of a lower id. Such a lane
    /// has one vertex as its nearest point everywhere in the cell, with a margin that makes the kernel return exactly
    /// the distance to this vertex, and a primitive with a lower id has the same vertex.
    fn lanes_without_ties(&self, cube: &Cube, candidate: &PacketCandidate<'_>) -> u16 {
        /// The relative margin by which a vertex has to be the nearest point. The kernel needs 2^-38.
        const MARGIN: f64 = 1.0 / (1u64 << 36) as f64;
        let packet = &self.tree.leaves.packets[candidate.packet as usize];
        // The slack is added because rounding may put a query beside its cell.
        let half = cube.side * 0.5 + self.slack;
        let centre = cube.low.map(|x| x + cube.side * 0.5);
        let mut kept = candidate.lanes;
        for lane in (0..packet.ids().len()).filter(|lane| candidate.lanes >> lane & 1 == 1) {
            let (corners, count) = packet.vertices_of(lane);
            let corners = &corners[..count];
            let vertex = |v: usize| self.tree.leaves.vertices[corners[v]];
            let ties = (0..corners.len()).any(|v| {
                if self.lowest_owners[corners[v]] >= packet.ids()[lane] {
                    return false;
                }
                let nearest = vertex(v);
                (0..corners.len()).filter(|&w| w != v).all(|w| {
                    let other = vertex(w);
                    let edge: V3 = std::array::from_fn(|k| other[k] - nearest[k]);
                    let to: V3 = std::array::from_fn(|k| centre[k] - nearest[k]);
                    let size = (0..3).map(|k| to[k].abs() + half + edge[k].abs()).fold(0.0, f64::max);
                    // This is the largest value of (q - nearest) . edge in the cell.
                    let largest: f64 = (0..3).map(|k| to[k] * edge[k] + half * edge[k].abs()).sum();
                    largest < -MARGIN * size * size
                })
            });
            if ties {
                kept &= !(1 << lane);
            }
        }
        kept
    }
}
