//! From a cube and the tree to refine_root with their lists.
//!
//! A cell starts with what its parent could not rule out. While these are many, they are nodes of the tree, which are
//! opened and tested by their passing_boxes (*refine_coarse*). Once they are few packets, the filters of packets are computed at the
//! corners (*refine_fine*): 19 new lattice points for the eight children of a cell, whose nearest points give the new
//! dominators.
//!
//! # What is refine_children
//!
//! A refine_children costs memory and saves time where queries are. The fraction of queries that a cell gets (its *query_mass*) is taken
//! to be a mixture: uniform_boxes in the has_all_bounds domain, uniform_boxes in smaller passing_boxes around the scene, and on the surface. What a build_list
//! costs is how many of its packets the bounds of its blocks let pass in the centre of the cell, and its blocks. A cell
//! is refine_children if query_mass times cost is worth it. Whether a budget is exceeded does not depend on the order in which refine_root
//! are made, so a refinement that exceeds one is given up at once and another one made that asks for more worth: the
//! result is the same on any number of threads.

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

/// Fine refine_root have at most this many packets.
const MAX_FINE_PACKETS: usize = 256;
/// Fine refine_root with fewer packets are left to one thread.
const MIN_PARALLEL_PACKETS: usize = 48;
/// Searches of more packets and primitives are work of their own.
const CHARGE_SEARCH_ABOVE_TESTS: usize = 512;
/// Nanoseconds that a query gains by a build_list in the place of a probe_tree of the tree.
const NS_SAVED_BY_LIST: f64 = 300.0;
/// Part of its cost that a cell loses by a refine_children.
const COST_SAVED_BY_SPLIT: f64 = 0.5;
/// What codes take of each refine_children at most: eight rows for a node of two levels, which stands for five is_worth_splitting at least.
const CODE_BYTES_PER_SPLIT: u64 = (8 * size_of::<Row>()).div_ceil(5) as u64;
/// Nanoseconds that a refine_children has to save each query in a cell that has as many queries as there are for a packet.
const MIN_NS_SAVED_BY_SPLIT: f64 = 100.0;

impl Refinement<'_> {
    /// A probe_tree of the tree. A usual one is part of what is_worth_splitting count; where most of the scene is about as near, it takes as
    /// long as the scene is large.
    pub(crate) fn probe_tree(&self, x: V3) -> TreeProbe {
        let searched = (self.search)(x);
        let tests = searched.packets + searched.primitives;
        self.counters.charge_tests(if tests > CHARGE_SEARCH_ABOVE_TESTS { tests } else { 0 });
        searched
    }

    /// The nearest point of the scene.
    pub(crate) fn nearest(&self, x: V3) -> V3 {
        self.probe_tree(x).nearest
    }

    /// The refine_root of the cube.
    pub(crate) fn refine_root(&self, low: V3, side: f64) -> RefinedCell {
        let at = |c: usize| -> V3 { std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }) };
        let corners = std::array::from_fn(|c| Corner { x: at(c), y: self.nearest(at(c)) });
        let root = CoarseCandidate { child: self.tree.root, bounds: *self.tree.bounds() };
        self.refine_coarse(&Cube { low, side, level: 0, corners }, vec![root], 1.0)
    }

    /// Whether a cell may have queries.
    fn may_have_queries(&self, cube: &Cube) -> bool {
        match self.domain {
            Domain::Everywhere => true,
            Domain::Box(bounds) => bounds.meets(&cube.bounds()),
            Domain::Band(width) => {
                // From everywhere in the cell the scene is at least as far as from a corner, less the way there.
                let diagonal = cube.side * 1.733;
                let least = |corner: &Corner| norm_squared(sub(corner.x, corner.y)).sqrt() - diagonal;
                cube.corners.iter().all(|corner| least(corner) <= width)
            }
        }
    }

    /// The fraction of queries in a cell, of which these passing_boxes are near; each stands for as many packets.
    fn query_mass<'a>(&self, cube: &Cube, near: impl Iterator<Item = (&'a Aabb<f64>, f64)>) -> f64 {
        let own = cube.bounds();
        let mut query_mass = 0.0;
        for (has_all_bounds, density) in self.uniform_boxes {
            let part = (0..3).map(|k| own.max[k].min(has_all_bounds.max[k]) - own.min[k].max(has_all_bounds.min[k]));
            query_mass += part.map(|x| x.max(0.0)).product::<f64>() * density;
        }
        for (bounds, packets) in near {
            if bounds.meets(&own) {
                let size = (bounds.max - bounds.min).max();
                // Of something larger than the cell a part lies in it.
                let part = if size > cube.side { (cube.side / size).powi(2) } else { 1.0 };
                query_mass += self.inv_packet_count * packets * part;
            }
        }
        query_mass
    }

    /// Whether a refine_children pays.
    fn is_worth_splitting(&self, cube: &Cube, query_mass: f64, cost: f64) -> bool {
        let worth =
            query_mass * cost * COST_SAVED_BY_SPLIT * self.resolution >= MIN_NS_SAVED_BY_SPLIT * self.inv_packet_count;
        worth && cube.level < MAX_LEVEL && !self.counters.is_exceeded()
    }

    fn finish_cell(&self, cell: RefinedCell, fraction: f64) -> RefinedCell {
        self.counters.add_finished(fraction);
        if let RefinedCell::Blocks(blocks) = &cell {
            self.counters.bytes.fetch_add(size_of_val(blocks.as_slice()) as u64, Ordering::Relaxed);
        }
        cell
    }

    fn refine_coarse(&self, cube: &Cube, mut candidates: Vec<CoarseCandidate>, fraction: f64) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(cube) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        let dominators = Dominators::from_corners(&cube.corners, self.slack);
        candidates.retain(|c| dominators.keeps_box(&cube.corners, &c.bounds));
        // Opened until they are packets or too many.
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
            let items: Vec<PacketCandidate> =
                candidates.iter().filter_map(|c| self.packet_candidate(cube, &dominators, c)).collect();
            return self.refine_fine(cube, items, fraction);
        }
        // What is not a packet has eight of them at least.
        let near = |c: &CoarseCandidate| if c.child.is_packet() { 1.0 } else { 8.0 };
        let query_mass = self.query_mass(cube, candidates.iter().map(|c| (&c.bounds, near(c))));
        if !self.is_worth_splitting(cube, query_mass, NS_SAVED_BY_LIST) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        // Searches of the tree for 19 corners, each of some packets.
        self.counters.charge_tests(19 * 8);
        let lattice: [Corner; LATTICE_POINTS] = std::array::from_fn(|at| match cube_corner_at(at) {
            Some(corner) => cube.corners[corner],
            None => Corner { x: cube.point(at), y: self.nearest(cube.point(at)) },
        });
        self.refine_children(cube.children(&lattice).map(|child| (child, ())), true, |child, ()| {
            self.refine_coarse(child, candidates.clone(), fraction * 0.125)
        })
    }

    /// The refine_root of the children, on all threads if asked to and they are large.
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
            let refine_root: Vec<RefinedCell> = children.map(|(cube, own)| cell(&cube, own)).collect();
            let refine_root: [RefinedCell; 8] =
                refine_root.try_into().unwrap_or_else(|_| unreachable!("eight children"));
            return RefinedCell::Split(Box::new(refine_root));
        }
        let _ = (large, self.parallel);
        RefinedCell::Split(Box::new(children.map(|(cube, own)| cell(&cube, own))))
    }

    /// The packet of a candidate at the corners of a cell; `None` if no lane passes the corner test.
    fn packet_candidate(
        &self,
        cube: &Cube,
        dominators: &Dominators,
        candidate: &CoarseCandidate,
    ) -> Option<PacketCandidate> {
        let number = candidate.child.number();
        let packet = &self.tree.leaves.packets[number];
        let points = cube.corners.map(|c| c.x);
        let mut distances = [LaneDistances::UNKNOWN; 8];
        let at = DistancesAtPoints { packet, points: &points, distances: &mut distances, nearest: &mut [None; 8] };
        self.isa().run(at);
        let lanes =
            self.isa().run(KeepLanes { packet, dominators, distances: &distances, corners: &[0, 1, 2, 3, 4, 5, 6, 7] });
        let packet = u32::try_from(number).expect("packets have numbers");
        (lanes != 0).then_some(PacketCandidate { packet, lanes, bounds: candidate.bounds, distances })
    }

    pub(crate) fn isa(&self) -> Isa {
        self.tree.isa()
    }

    fn refine_fine(&self, cube: &Cube, items: Vec<PacketCandidate>, fraction: f64) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(cube) {
            return self.finish_cell(RefinedCell::Tree, fraction);
        }
        let centre = self.centre(cube, &items);
        let query_mass = self.query_mass(cube, items.iter().map(|packet_candidate| (&packet_candidate.bounds, 1.0)));
        let tests = centre.passing_boxes.min(centre.passing_corners) as f64;
        let blocks = items.len() as f64 / BLOCK_WIDTH as f64;
        let cost = NS_PER_PACKET * (tests - 1.0) + NS_PER_BLOCK * (blocks - 1.0).max(0.0);
        if !self.is_worth_splitting(cube, query_mass, cost) {
            return self.finish_cell(self.build_list(cube, &items, &centre), fraction);
        }
        self.counters.charge_tests(NEW_LATTICE_POINTS.len() * items.len());
        // All filters at all lattice points; those at the corners and in the centre are known.
        let points = NEW_LATTICE_POINTS.map(|at| cube.point(at));
        let mut all: Vec<[LaneDistances; LATTICE_POINTS]> = Vec::with_capacity(items.len());
        let mut nearest = [NearestSample::NONE; LATTICE_POINTS];
        for (packet_candidate, at_centre) in items.iter().zip(&centre.distances) {
            let packet = &self.tree.leaves.packets[packet_candidate.packet as usize];
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
                distances[2 * CHILD_CORNERS[0][corner]] = packet_candidate.distances[corner];
            }
            distances[LATTICE_CENTRE] = *at_centre;
            for ((at, own), near) in NEW_LATTICE_POINTS.into_iter().zip(new_distances).zip(new_nearest) {
                distances[at] = own;
                nearest[at].add(near, packet_candidate.packet);
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
            let mut own = Vec::with_capacity(items.len());
            for (packet_candidate, distances) in items.iter().zip(&all) {
                let packet = &self.tree.leaves.packets[packet_candidate.packet as usize];
                let lanes = packet_candidate.lanes
                    & self.isa().run(KeepLanes { packet, dominators: &dominators, distances, corners });
                if lanes != 0 {
                    own.push(PacketCandidate {
                        lanes,
                        distances: corners.map(|at| distances[at]),
                        ..*packet_candidate
                    });
                }
            }
            (child, own)
        });
        drop(all);
        self.refine_children(children, items.len() >= MIN_PARALLEL_PACKETS, |child, own| {
            self.refine_fine(child, own, fraction * 0.125)
        })
    }
}
