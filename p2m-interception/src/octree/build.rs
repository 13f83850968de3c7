//! The refinement of a cube into cells with interception lists.
//!
//! A cell starts with the candidates that its parent could not exclude. As long as there are many, they are nodes of
//! the tree, which are opened and tested by their boxes. Once they are packets, and few, the filters of these packets
//! run at the corners of the cell. A split tests the candidates of a cell for all eight children at once
//! ([`lattice`](crate::octree::lattice)). The nearest points of the scene to the corners of the children become new
//! dominators.
//!
//! # Which cells are split
//!
//! A split costs memory and saves time where queries are. The weight of the queries that a cell gets is its
//! *mass*. It is the sum over several kinds of queries, uniform in the domain, uniform in smaller boxes around the
//! scene, and on the surface, of the part of each kind times its weight, so masses need not add up to 1. The cost of
//! the list of a cell is a time: that of the packets which the bounds of its blocks let pass at the centre of the
//! cell, and that of its blocks, both beyond the first one. A cell without a list has a fixed cost, that of a search of
//! the tree instead of a list. A cell is split if its mass times the part of its cost that a split saves exceeds a
//! threshold, which is the lower the higher the resolution is.
//!
//! A pass splits the cells that are worth it at its resolution. Cells that only a later pass may split are left open
//! ([`passes`](crate::octree::passes)).

use crate::list::block::{BLOCK_WIDTH, MAX_LEVEL};
use crate::list::corner_test::{BoxTest, Corner, Dominators};
use crate::octree::budget::Spent;
use crate::octree::cell::{CHILD_CORNERS, CUBE_CORNERS, Cube, LATTICE_CENTRE, LATTICE_POINTS, cube_corner_at};
use crate::octree::cell_list::MAX_LIST_PACKETS;
use crate::octree::code::Row;
use crate::octree::lattice::{
    BoundBoxes, FilterAtCorners, FilterLanes, LatticeDistances, LatticeLimits, ReachChildren,
};
use crate::octree::refinement::{
    Candidate, CellTask, KnownDistances, NS_PER_BLOCK, NS_PER_PACKET, OpenCandidate, OpenCell, Place, RefinedCell,
    Refinement, TreeProbe,
};
use crate::options::Domain;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::Isa;
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The number of candidates up to which nodes are opened.
const MAX_OPENED: usize = 512;
/// A search of the tree that takes more tests is charged to the work. Shorter ones are included in the charge
/// of a split.
const CHARGE_SEARCH_ABOVE_TESTS: usize = 512;
/// The time that a query saves if a list replaces a search of the tree, in nanoseconds.
const NS_SAVED_BY_LIST: f64 = 300.0;
/// The part of its cost that a cell is assumed to save by a split.
const COST_SAVED_BY_SPLIT: f64 = 0.5;
/// A cell that would be split even if its list cost this part of what the boxes of its packets predict is split before
/// the filters of the packets have run.
const CERTAIN_PART_OF_BOX_COST: f64 = 0.25;
/// The memory of the codes of a split at most. Eight rows with two levels stand for at least five splits.
const CODE_BYTES_PER_SPLIT: usize = (8 * size_of::<Row>()).div_ceil(5);
/// The time that a split has to save, in nanoseconds times mass, where the mass of a cell is measured in that of one
/// packet.
const MIN_NS_SAVED_BY_SPLIT: f64 = 100.0;

impl Refinement<'_> {
    /// Returns the instruction set of the tree.
    pub(crate) fn isa(&self) -> Isa {
        self.tree.isa()
    }

    /// Searches the tree. The work of an ordinary search is included in what a split is charged. Where most of the
    /// scene is about equally near, a search takes time in proportion to the size of the scene, and is charged here.
    pub(crate) fn probe_tree(&self, task: &mut CellTask, x: V3) -> TreeProbe {
        let probe = (self.search)(x);
        let tests = probe.packets + probe.primitives;
        task.spent.tests += if tests > CHARGE_SEARCH_ABOVE_TESTS { tests as i64 } else { 0 };
        probe
    }

    /// Returns the point of the scene that is nearest to `x`.
    pub(crate) fn nearest(&self, task: &mut CellTask, x: V3) -> V3 {
        self.probe_tree(task, x).nearest
    }

    /// Returns the point of the scene that is nearest to a lattice point, which the task may know already.
    fn nearest_to_lattice_point(&self, task: &mut CellTask, x: V3) -> V3 {
        let key = x.map(f64::to_bits);
        if let Some(known) = task.nearest_points.get(&key) {
            return *known;
        }
        let nearest = self.nearest(task, x);
        task.nearest_points.insert(key, nearest);
        nearest
    }

    /// Refines the cube of the domain.
    pub(crate) fn refine_root(&self, task: &mut CellTask, low: V3, side: f64, place: Place) -> RefinedCell {
        let at = |c: usize| -> V3 { std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }) };
        let corners = std::array::from_fn(|c| Corner { x: at(c), y: self.nearest(task, at(c)) });
        let (bounds, child) = (*self.tree.bounds(), self.tree.root);
        let root = Candidate { bounds, child, parent: NodeRef::NONE, index: 0, lanes: u16::MAX };
        self.refine_unfiltered(task, Cube { low, side, level: 0, corners }, vec![root], place)
    }

    /// Splits a cell that an earlier pass has left open.
    pub(crate) fn split_open(&self, task: &mut CellTask, cell: &OpenCell, place: Place) -> RefinedCell {
        let (OpenCell { cube, has_packets, .. }, candidates) = (cell, self.candidates_of(cell));
        if *has_packets {
            self.sample_centre(cube, &candidates, task);
        }
        self.split(task, cube, &candidates, *has_packets, None, place)
    }

    /// Finishes a cell that no pass has split.
    pub(crate) fn finish_open(&self, task: &mut CellTask, cell: &OpenCell, place: Place) -> RefinedCell {
        let cube = &cell.cube;
        if !cell.may_have_list() {
            return self.finish_cell(task, RefinedCell::Tree, place);
        }
        let dominators = Dominators::from_corners(&cube.corners, self.slack);
        self.filter_at_corners(task, cube, self.candidates_of(cell), &dominators, |task, candidates, known| {
            self.sample_centre(cube, &candidates, task);
            self.count_passing(cube, &candidates, known, &mut task.centre);
            let list = self.build_list(cube, &candidates, known, task);
            self.finish_cell(task, list, place)
        })
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

    /// Estimates the mass of a cell: its share of the queries.
    fn query_mass(&self, cube: &Cube, candidates: &[Candidate]) -> f64 {
        let cell_bounds = cube.bounds();
        let mut mass = 0.0;
        for (bounds, density) in self.uniform_boxes {
            let part = (0..3).map(|k| cell_bounds.max[k].min(bounds.max[k]) - cell_bounds.min[k].max(bounds.min[k]));
            mass += part.map(|x| x.max(0.0)).product::<f64>() * density;
        }
        for Candidate { bounds, child, .. } in candidates {
            if bounds.intersects(&cell_bounds) {
                let size = (bounds.max - bounds.min).max();
                // If a box is larger than the cell, only a part of its surface lies in the cell.
                let part = if size > cube.side { (cube.side / size).powi(2) } else { 1.0 };
                // A node has at least eight packets.
                mass += self.inv_packet_count * if child.is_packet() { part } else { 8.0 * part };
            }
        }
        mass
    }

    /// Returns the resolution from which on a split is worth its memory. It is infinite for a cell of the last level.
    fn resolution_of_split(&self, cube: &Cube, mass: f64, cost: f64) -> f64 {
        if cube.level >= MAX_LEVEL || cost <= 0.0 {
            return f64::INFINITY;
        }
        MIN_NS_SAVED_BY_SPLIT * self.inv_packet_count / (mass * cost * COST_SAVED_BY_SPLIT)
    }

    /// Counts a finished cell, which covers a part of the domain, and its memory.
    fn finish_cell(&self, task: &mut CellTask, cell: RefinedCell, place: Place) -> RefinedCell {
        self.finished.add(place.part);
        if let RefinedCell::List(_, first) = cell {
            task.spent += Spent::new(size_of_val(&task.blocks[first as usize..]), 0);
        }
        cell
    }

    /// Opens the candidates of a cell until all are packets, or until there are too many. Returns whether all are
    /// packets.
    fn open_candidates(&self, cube: &Cube, dominators: &Dominators, candidates: &mut Vec<Candidate>) -> bool {
        let test = BoxTest::new(dominators, &cube.corners);
        candidates.retain(|c| test.keeps(&c.bounds));
        while candidates.len() <= MAX_OPENED {
            if candidates.iter().all(|candidate| candidate.child.is_packet()) {
                return true;
            }
            let mut opened = Vec::with_capacity(2 * candidates.len());
            for candidate in &*candidates {
                if candidate.child.is_packet() {
                    opened.push(*candidate);
                } else {
                    for (bounds, child) in self.tree.child_boxes(candidate.child) {
                        if test.keeps(&bounds) {
                            opened.push(Candidate { bounds, child, parent: candidate.child, ..*candidate });
                        }
                    }
                }
            }
            *candidates = opened;
        }
        false
    }

    /// Refines a cell for which no filter of a packet has run.
    fn refine_unfiltered(
        &self,
        task: &mut CellTask,
        cube: Cube,
        mut candidates: Vec<Candidate>,
        place: Place,
    ) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(&cube) {
            return self.finish_cell(task, RefinedCell::Tree, place);
        }
        let dominators = Dominators::from_corners(&cube.corners, self.slack);
        let has_packets = self.open_candidates(&cube, &dominators, &mut candidates);
        let may_have_list = has_packets && candidates.len() <= MAX_LIST_PACKETS;
        let cost = if may_have_list {
            self.sample_centre(&cube, &candidates, task);
            CERTAIN_PART_OF_BOX_COST * list_cost(task.centre.passing_boxes, candidates.len())
        } else {
            NS_SAVED_BY_LIST
        };
        let resolution = self.resolution_of_split(&cube, self.query_mass(&cube, &candidates), cost);
        if resolution <= self.last_resolution {
            if has_packets && !may_have_list && resolution <= task.resolution {
                self.sample_centre(&cube, &candidates, task);
            }
            return self.split_or_leave_open(task, &cube, candidates, has_packets, None, resolution, place);
        }
        if !may_have_list {
            return self.finish_cell(task, RefinedCell::Tree, place);
        }
        self.filter_at_corners(task, &cube, candidates, &dominators, |task, candidates, known| {
            self.refine_filtered(task, &cube, candidates, known, place)
        })
    }

    /// Runs the filters of packets at the corners of a cell, applies the corner test, and continues with the packets
    /// that pass.
    fn filter_at_corners(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        mut candidates: Vec<Candidate>,
        dominators: &Dominators,
        go_on: impl FnOnce(&mut CellTask, Vec<Candidate>, KnownDistances<'_>) -> RefinedCell,
    ) -> RefinedCell {
        task.spent += Spent::new(0, 8 * candidates.len());
        let mut distances = task.distances.pop().unwrap_or_default();
        self.isa().run(FilterAtCorners {
            lattice: &mut task.lattice,
            packets: &self.tree.leaves.packets,
            points: &std::array::from_fn(|at| cube.point(at)),
            dominators,
            candidates: &mut candidates,
            distances: &mut distances,
        });
        let cell = go_on(task, candidates, KnownDistances { distances: &distances, corners: &CUBE_CORNERS });
        task.distances.push(distances);
        cell
    }

    /// Refines a cell for which the filters of all packets have run at its corners.
    fn refine_filtered(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        candidates: Vec<Candidate>,
        known: KnownDistances<'_>,
        place: Place,
    ) -> RefinedCell {
        if cube.level > 0 && !self.may_have_queries(cube) {
            return self.finish_cell(task, RefinedCell::Tree, place);
        }
        self.sample_centre(cube, &candidates, task);
        self.count_passing(cube, &candidates, known, &mut task.centre);
        let cost = if candidates.len() <= MAX_LIST_PACKETS {
            list_cost(task.centre.passing_boxes.min(task.centre.passing_corners), candidates.len())
        } else {
            NS_SAVED_BY_LIST
        };
        let resolution = self.resolution_of_split(cube, self.query_mass(cube, &candidates), cost);
        if resolution <= self.last_resolution {
            return self.split_or_leave_open(task, cube, candidates, true, Some(known), resolution, place);
        }
        let list = self.build_list(cube, &candidates, known, task);
        self.finish_cell(task, list, place)
    }

    /// Splits a cell if it is worth it in the current pass, and leaves it open otherwise.
    #[allow(clippy::too_many_arguments, reason = "all of them describe the cell")]
    fn split_or_leave_open(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        candidates: Vec<Candidate>,
        has_packets: bool,
        known: Option<KnownDistances<'_>>,
        resolution: f64,
        place: Place,
    ) -> RefinedCell {
        if resolution <= task.resolution {
            return self.split(task, cube, &candidates, has_packets, known, place);
        }
        let candidates = candidates.iter().map(OpenCandidate::from).collect();
        let cell = OpenCell { cube: *cube, candidates, has_packets, resolution, place };
        task.spent += Spent::reserved_for(&cell);
        task.open.push(cell);
        RefinedCell::Tree
    }

    /// Splits a cell. The centre of a cell with packets was sampled before.
    fn split(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        candidates: &[Candidate],
        has_packets: bool,
        known: Option<KnownDistances<'_>>,
        place: Place,
    ) -> RefinedCell {
        if task.exceeds(self.budgets) {
            return RefinedCell::Tree;
        }
        let from_corners = if known.is_some() { &task.centre.from_corners[..] } else { &[] };
        self.isa().run(BoundBoxes { lattice: &mut task.lattice, cube, candidates, from_corners });
        let mut lattice = [Corner { x: [0.0; 3], y: task.centre.y }; LATTICE_POINTS];
        for (at, corner) in lattice.iter_mut().enumerate() {
            corner.x = cube.point(at);
            if let Some(known) = cube_corner_at(at) {
                corner.y = cube.corners[known].y;
            } else if !has_packets {
                corner.y = self.nearest_to_lattice_point(task, corner.x);
            } else if at != LATTICE_CENTRE {
                let few = task.lattice.nearest_boxes(at, cube.side);
                corner.y = self.nearest_of_few(task, candidates, few, corner.x);
            }
        }
        let limits = LatticeLimits::new(&lattice, cube.side, self.slack);
        self.isa().run(ReachChildren { lattice: &mut task.lattice, limits: &limits });
        let children = cube.children(&lattice);
        let mut distances = Vec::new();
        if has_packets {
            distances = task.distances.pop().unwrap_or_default();
            if distances.len() < candidates.len() {
                distances.resize(candidates.len(), LatticeDistances::default());
            }
            let dominators = std::array::from_fn(|c| Dominators::from_corners(&children[c].corners, self.slack));
            let tests = self.isa().run(FilterLanes {
                lattice: &mut task.lattice,
                packets: &self.tree.leaves.packets,
                candidates,
                points: &lattice.map(|corner| corner.x),
                known,
                dominators: &dominators,
                distances: &mut distances,
            });
            task.spent += Spent::new(CODE_BYTES_PER_SPLIT, tests);
        } else {
            // The children need at most 19 searches of the tree, each of which tests some packets.
            task.spent += Spent::new(CODE_BYTES_PER_SPLIT, 19 * 8);
            task.lattice.keep_all_lanes();
        }
        let inherited: [Vec<Candidate>; 8] = std::array::from_fn(|child| {
            let lanes = task.lattice.lanes.iter().map(|lanes| lanes[child]);
            let mut inherited = Vec::with_capacity(lanes.clone().filter(|lanes| *lanes != 0).count());
            for ((index, candidate), lanes) in (0..).zip(candidates).zip(lanes) {
                if lanes != 0 {
                    inherited.push(Candidate { index, lanes, ..*candidate });
                }
            }
            inherited
        });
        let first = task.cells.len();
        task.cells.resize(first + 8, RefinedCell::Tree);
        for (c, (child, inherited)) in children.into_iter().zip(inherited).enumerate() {
            let place = Place { number: first + c, part: place.part * 0.125 };
            task.cells[place.number] = if has_packets {
                let known = KnownDistances { distances: &distances, corners: &CHILD_CORNERS[c] };
                self.refine_filtered(task, &child, inherited, known, place)
            } else {
                self.refine_unfiltered(task, child, inherited, place)
            };
        }
        if has_packets {
            task.distances.push(distances);
        }
        RefinedCell::Split(first)
    }
}

/// Returns the cost of a list of which a query tests some packets, in nanoseconds beyond that of the shortest list.
fn list_cost(tests: usize, packets: usize) -> f64 {
    let blocks = packets as f64 / BLOCK_WIDTH as f64;
    NS_PER_PACKET * (tests as f64 - 1.0) + NS_PER_BLOCK * (blocks - 1.0).max(0.0)
}
