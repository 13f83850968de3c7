//! The refinement of a cube into cells with interception lists.
//!
//! A cell starts with the candidates that its parent could not exclude. As long as there are many, they are nodes of
//! the tree, which are opened and tested by their boxes (a *coarse* cell). Once few packets are left, the filters of
//! these packets are computed at the corners (a *fine* cell). A fine cell that is split needs the filters at 18 new
//! lattice points for its eight children. The nearest points of the scene to these lattice points become new
//! dominators.
//!
//! # Which cells are split
//!
//! A split costs memory and saves time where queries are. The weight of the queries that a cell gets is its
//! *mass*. It is the sum over several kinds of queries, uniform in the domain, uniform in smaller boxes around the
//! scene, and on the surface, of the part of each kind times its weight, so masses need not add up to 1. The cost of
//! the list of a fine cell is a time: that of the packets which the bounds of its blocks let pass at the centre of the
//! cell, and that of its blocks, both beyond the first one. A coarse cell has a fixed cost, that of a search of the
//! tree instead of a list. A cell is split if its mass times the part of its cost that a split saves exceeds a
//! threshold.
//!
//! Whether a budget is exceeded does not depend on the order in which cells are made. A refinement that exceeds one is
//! stopped at once, and another one with a higher threshold follows. So the result is the same on any number of
//! threads.

use crate::list::block::{BLOCK_WIDTH, MAX_LEVEL};
use crate::list::corner_test::{Corner, DistancesAtPoints, Dominators, KeepLanes, LaneDistances};
use crate::octree::cell::{CHILD_CORNERS, Cube, LATTICE_CENTRE, LATTICE_POINTS, NEW_LATTICE_POINTS, cube_corner_at};
use crate::octree::code::Row;
use crate::octree::refinement::{
    CoarseCandidate, NS_PER_BLOCK, NS_PER_PACKET, NearestSample, PacketCandidate, RefinedCell, Refinement, TreeProbe,
};
use crate::options::Domain;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Isa};
use std::sync::atomic::Ordering;

/// The number of packets up to which a cell is fine.
const MAX_FINE_PACKETS: usize = 256;
/// A fine cell with fewer packets refines its children on one thread.
const MIN_PARALLEL_PACKETS: usize = 48;
/// A search of the tree that takes more tests is charged to the work. Shorter ones are included in the charge
/// of a split.
const CHARGE_SEARCH_ABOVE_TESTS: usize = 512;
/// The time that a query saves if a list replaces a search of the tree, in nanoseconds.
const NS_SAVED_BY_LIST: f64 = 300.0;
/// The part of its cost that a cell is assumed to save by a split.
const COST_SAVED_BY_SPLIT: f64 = 0.5;
/// The memory of the codes of a split at most. Eight rows with two levels stand for at least five splits.
const CODE_BYTES_PER_SPLIT: u64 = (8 * size_of::<Row>()).div_ceil(5) as u64;
/// The time that a split has to save, in nanoseconds times mass, where the mass of a cell is measured in that of one
/// packet.
const MIN_NS_SAVED_BY_SPLIT: f64 = 100.0;

impl Refinement<'_> {
    /// Searches the tree. The work of an ordinary search is included in what a split is charged. Where most of the
    /// scene is about equally near, a search takes time in proportion to the size of the scene, and is charged here.
    pub(crate) fn probe_tree(&self, x: V3) -> TreeProbe {
        let probe = (self.search)(x);
        let tests = probe.packets + probe.primitives;
        self.counters.charge_tests(if tests > CHARGE_SEARCH_ABOVE_TESTS { tests } else { 0 });
        probe
    }

    /// Returns the point of the scene that is nearest to `x`.
    pub(crate) fn nearest(&self, x: V3) -> V3 {
        self.probe_tree(x).nearest
    }

    /// Refines the cube of the domain.
    pub(crate) fn refine_root(&self, low: V3, side: f64) -> RefinedCell {
        let at = |c: usize| -> V3 { std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }) };
        let corners = std::array::from_fn(|c| Corner { x: at(c), y: self.nearest(at(c)) });
        let root = CoarseCandidate { child: self.tree.root, bounds: *self.tree.bounds() };
        self.refine_coarse(&Cube { low, side, level: 0, corners }, vec![root], 1.0)
    }

    /// Returns whether a cell may contain queries of the domain.
    fn may_have_queries(&self, cube: &Cube) -> bool {
        match self.domain {
            Domain::Everywhere => true,
            Domain::Box(bounds) => bounds.intersects(&cube.bounds()),
            Domain::Band(width) => {
                // From any point of the cell the scene is at least as far as from a corner, minus the diagonal.
                let diagonal = cube.side * 1.733;
                let least = |corner: &Corner| norm_squared(sub(corner.x, corner.y)).sqrt() - diagonal;
                cube.corners.iter().all(|corner| least(corner) <= width)
            }
        }
    }

    /// Estimates the mass of a cell: its share of the queries. `near` has boxes that may be in the cell, each with the
    /// number of packets that it stands for.
    fn query_mass<'a>(&self, cube: &Cube, near: impl Iterator<Item = (&'a Aabb<f64>, f64)>) -> f64 {
        let cell_bounds = cube.bounds();
        let mut mass = 0.0;
        for (bounds, density) in self.uniform_boxes {
            let part = (0..3).map(|k| cell_bounds.max[k].min(bounds.max[k]) - cell_bounds.min[k].max(bounds.min[k]));
            mass += part.map(|x| x.max(0.0)).product::<f64>() * density;
        }
        for (bounds, packets) in near {
            if bounds.intersects(&cell_bounds) {
                let size = (bounds.max - bounds.min).max();
                // If a box is larger than the cell, only a part of its surface lies in the cell.
                let part = if size > cube.side { (cube.side / size).powi(2) } else { 1.0 };
                mass += self.inv_packet_count * packets * part;
            }
        }
        mass
    }

    /// Returns whether a split is worth its memory.
    fn is_worth_splitting(&self, cube: &Cube, mass: f64, cost: f64) -> bool {
        let is_worth =
            mass * cost * COST_SAVED_BY_SPLIT * self.resolution >= MIN_NS_SAVED_BY_SPLIT * self.inv_packet_count;
        is_worth && cube.level < MAX_LEVEL && !self.counters.is_exceeded()
    }

    /// Counts a finished cell, which covers a part of the domain, and its memory.
    fn finish_cell(&self, cell: RefinedCell, fraction: f64) -> RefinedCell {
        self.counters.add_finished(fraction);
        if let RefinedCell::Blocks(blocks) = &cell {
            self.counters.bytes.fetch_add(size_of_val(blocks.as_slice()) as u64, Ordering::Relaxed);
        }
        cell
    }

    /// Refines a cell whose candidates may be nodes of the tree.
    fn refine_coarse(&self, cube: &Cube, mut candidates: Vec<CoarseCandidate>, fraction: f64) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(cube) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        let dominators = Dominators::from_corners(&cube.corners, self.slack);
        candidates.retain(|c| dominators.keeps_box(&cube.corners, &c.bounds));
        // Candidates are opened until all are packets, or until there are too many.
        let mut open = 1;
        while open > 0 && candidates.len() <= MAX_FINE_PACKETS {
            open = 0;
            let mut opened = Vec::with_capacity(2 * candidates.len());
            for candidate in &candidates {
                if candidate.child.is_packet() {
                    opened.push(*candidate);
                } else {
                    open += 1;
                    let children = self.tree.child_boxes(candidate.child);
                    let children = children.map(|(bounds, child)| CoarseCandidate { child, bounds });
                    opened.extend(children.filter(|c| dominators.keeps_box(&cube.corners, &c.bounds)));
                }
            }
            candidates = opened;
        }
        if open == 0 && candidates.len() <= MAX_FINE_PACKETS {
            self.counters.charge_tests(8 * candidates.len());
            let distances: Vec<[LaneDistances; 8]> =
                candidates.iter().map(|candidate| self.distances_from_corners(cube, candidate)).collect();
            let all = candidates.iter().zip(&distances);
            let packets = all.filter_map(|(c, distances)| self.packet_candidate(&dominators, c, distances)).collect();
            return self.refine_fine(cube, packets, fraction);
        }
        // A node has at least eight packets.
        let near = |c: &CoarseCandidate| if c.child.is_packet() { 1.0 } else { 8.0 };
        let mass = self.query_mass(cube, candidates.iter().map(|c| (&c.bounds, near(c))));
        if !self.is_worth_splitting(cube, mass, NS_SAVED_BY_LIST) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        // The children need 19 searches of the tree, each of which tests some packets.
        self.counters.charge_tests(19 * 8);
        let lattice: [Corner; LATTICE_POINTS] = std::array::from_fn(|at| match cube_corner_at(at) {
            Some(corner) => cube.corners[corner],
            None => Corner { x: cube.point(at), y: self.nearest(cube.point(at)) },
        });
        self.refine_children(cube.children(&lattice).map(|child| (child, ())), true, |child, ()| {
            self.refine_coarse(child, candidates.clone(), fraction * 0.125)
        })
    }

    /// Refines the children of a cell, on all threads if the options allow it and the cell is `large`.
    fn refine_children<P: Send>(
        &self,
        children: [(Cube, P); 8],
        large: bool,
        cell: impl Fn(&Cube, P) -> RefinedCell + Sync + Send,
    ) -> RefinedCell {
        self.counters.bytes.fetch_add(CODE_BYTES_PER_SPLIT, Ordering::Relaxed);
        #[cfg(feature = "rayon")]
        if self.parallel && large {
            use rayon::prelude::*;
            let children = Vec::from(children).into_par_iter();
            let cells: Vec<RefinedCell> = children.map(|(cube, inherited)| cell(&cube, inherited)).collect();
            let cells: [RefinedCell; 8] = cells.try_into().unwrap_or_else(|_| unreachable!("eight children"));
            return RefinedCell::Split(Box::new(cells));
        }
        let _ = (large, self.parallel);
        RefinedCell::Split(Box::new(children.map(|(cube, inherited)| cell(&cube, inherited))))
    }

    /// Computes the distances from the corners of a cell to the lanes of a packet.
    fn distances_from_corners(&self, cube: &Cube, candidate: &CoarseCandidate) -> [LaneDistances; 8] {
        let packet = &self.tree.leaves.packets[candidate.child.number()];
        let points = cube.corners.map(|c| c.x);
        let mut distances = [LaneDistances::UNKNOWN; 8];
        let at = DistancesAtPoints { packet, points: &points, distances: &mut distances, nearest: &mut [None; 8] };
        self.isa().run(at);
        distances
    }

    /// Applies the corner test to a packet. The result is `None` if no lane passes.
    fn packet_candidate<'a>(
        &self,
        dominators: &Dominators,
        candidate: &CoarseCandidate,
        distances: &'a [LaneDistances; 8],
    ) -> Option<PacketCandidate<'a>> {
        const CORNERS: &[usize; 8] = &[0, 1, 2, 3, 4, 5, 6, 7];
        let number = candidate.child.number();
        let packet = &self.tree.leaves.packets[number];
        let lanes = self.isa().run(KeepLanes { packet, dominators, distances, corners: CORNERS });
        let packet = u32::try_from(number).expect("packets have numbers");
        (lanes != 0).then_some(PacketCandidate { packet, lanes, bounds: candidate.bounds, distances, corners: CORNERS })
    }

    /// Returns the instruction set of the tree.
    pub(crate) fn isa(&self) -> Isa {
        self.tree.isa()
    }

    /// Refines a cell whose candidates are packets.
    fn refine_fine(&self, cube: &Cube, candidates: Vec<PacketCandidate<'_>>, fraction: f64) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(cube) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        let centre = self.sample_centre(cube, &candidates);
        let mass = self.query_mass(cube, candidates.iter().map(|candidate| (&candidate.bounds, 1.0)));
        let tests = centre.passing_boxes.min(centre.passing_corners) as f64;
        let blocks = candidates.len() as f64 / BLOCK_WIDTH as f64;
        let cost = NS_PER_PACKET * (tests - 1.0) + NS_PER_BLOCK * (blocks - 1.0).max(0.0);
        if !self.is_worth_splitting(cube, mass, cost) {
            return self.finish_cell(self.build_list(cube, &candidates, &centre), fraction);
        }
        self.counters.charge_tests(NEW_LATTICE_POINTS.len() * candidates.len());
        // The filters at the corners and at the centre are known already.
        let points = NEW_LATTICE_POINTS.map(|at| cube.point(at));
        let mut all: Vec<[LaneDistances; LATTICE_POINTS]> = Vec::with_capacity(candidates.len());
        let mut nearest = [NearestSample::NONE; LATTICE_POINTS];
        for (candidate, at_centre) in candidates.iter().zip(&centre.distances) {
            let packet = &self.tree.leaves.packets[candidate.packet as usize];
            let mut new_distances = [LaneDistances::UNKNOWN; NEW_LATTICE_POINTS.len()];
            let mut new_nearest = [None; NEW_LATTICE_POINTS.len()];
            self.isa().run(DistancesAtPoints {
                packet,
                points: &points,
                distances: &mut new_distances,
                nearest: &mut new_nearest,
            });
            let mut distances = [LaneDistances::UNKNOWN; LATTICE_POINTS];
            for corner in 0..8 {
                distances[2 * CHILD_CORNERS[0][corner]] = candidate.distances[candidate.corners[corner]];
            }
            distances[LATTICE_CENTRE] = *at_centre;
            for ((at, new), near) in NEW_LATTICE_POINTS.into_iter().zip(new_distances).zip(new_nearest) {
                distances[at] = new;
                nearest[at].add(near, candidate.packet);
            }
            all.push(distances);
        }
        let lattice: [Corner; LATTICE_POINTS] = std::array::from_fn(|at| match cube_corner_at(at) {
            Some(corner) => cube.corners[corner],
            None if at == LATTICE_CENTRE => Corner { x: cube.point(at), y: centre.y },
            None => Corner {
                x: cube.point(at),
                y: self.nearest_of_sample(&nearest[at], centre.has_all_bounds, cube.point(at)),
            },
        });
        let mut number = 0;
        let children = cube.children(&lattice).map(|child| {
            let corners = &CHILD_CORNERS[number];
            number += 1;
            let dominators = Dominators::from_corners(&child.corners, self.slack);
            let mut inherited = Vec::with_capacity(candidates.len());
            for (candidate, distances) in candidates.iter().zip(&all) {
                let packet = &self.tree.leaves.packets[candidate.packet as usize];
                let lanes =
                    candidate.lanes & self.isa().run(KeepLanes { packet, dominators: &dominators, distances, corners });
                if lanes != 0 {
                    inherited.push(PacketCandidate { lanes, distances, corners, ..*candidate });
                }
            }
            (child, inherited)
        });
        self.refine_children(children, candidates.len() >= MIN_PARALLEL_PACKETS, |child, inherited| {
            self.refine_fine(child, inherited, fraction * 0.125)
        })
    }
}
