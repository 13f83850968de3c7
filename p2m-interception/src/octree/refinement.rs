//! The refinement of a cube into cells with interception lists.
//!
//! A cell starts with the candidates that its parent could not exclude. As long as there are many, they are nodes of
//! the tree, which are opened and tested by their boxes. Once they are packets, and few, the filters of these packets
//! run at the corners of the cell. A split tests the candidates of a cell for all eight children at once
//! ([`lattice`](crate::octree::lattice)). The nearest points of the scene to the corners of the children become new
//! dominators.
//!
//! A pass splits the cells that are worth it at its resolution ([`split_rule`](crate::octree::split_rule)). Cells that
//! only a later pass may split are left open ([`passes`](crate::octree::passes)).

use crate::list::corner_test::{BoxTest, Corner, Dominators};
use crate::octree::budget::{FinishedPart, Spent};
use crate::octree::candidate::{Candidate, OpenCandidate, open_candidates};
use crate::octree::cell::{OpenCell, Place, RefinedCell};
use crate::octree::cell_list::{CellList, bound_from_corners};
use crate::octree::code::Row;
use crate::octree::cube::{CHILD_CORNERS, CUBE_CORNERS, Cube, LATTICE_CENTRE, LATTICE_POINTS, cube_corner_at};
use crate::octree::lattice::{
    BoundBoxes, FilterAtCorners, FilterLanes, KnownDistances, LatticeDistances, LatticeLimits, NEAREST_BOX_COUNT,
    ReachChildren,
};
use crate::octree::scene_tree::SceneTree;
use crate::octree::split_rule::{ExpectedQueries, MAX_LIST_PACKETS, NS_SAVED_BY_LIST};
use crate::octree::task::CellTask;
use crate::options::Domain;
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The largest memory of the codes of a split. Eight rows with two levels stand for at least five splits.
const CODE_BYTES_PER_SPLIT: usize = (8 * size_of::<Row>()).div_ceil(5);

/// A refinement of the cube of a domain: everything that is the same for all cells.
pub(crate) struct Refinement<'a> {
    /// The scene with its tree.
    pub(crate) scene: SceneTree<'a>,
    /// The expected distribution of queries, by which cells are split.
    pub(crate) queries: ExpectedQueries,
    /// The domain in which queries are expected.
    pub(crate) domain: Domain,
    /// The resolution of the last pass. No pass splits cells for which it is too low.
    pub(crate) last_resolution: f64,
    /// Whether cells are refined on all threads.
    pub(crate) parallel: bool,
    /// The budgets of memory and work.
    pub(crate) budgets: Spent,
    /// The finished part of the domain.
    pub(crate) finished: FinishedPart<'a>,
}

impl Refinement<'_> {
    /// Refines the cube of the domain.
    pub(crate) fn refine_root(&self, task: &mut CellTask, low: V3, side: f64, place: Place) -> RefinedCell {
        let at = |c: usize| -> V3 { std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }) };
        let corners = std::array::from_fn(|c| Corner { x: at(c), y: self.scene.nearest(&mut task.account, at(c)) });
        let root = Candidate::root(self.scene.tree);
        self.refine_unfiltered(task, Cube { low, side, level: 0, corners }, vec![root], place)
    }

    /// Splits a cell that an earlier pass has left open.
    pub(crate) fn split_open(&self, task: &mut CellTask, cell: &OpenCell, place: Place) -> RefinedCell {
        let (OpenCell { cube, has_packets, .. }, candidates) = (cell, self.candidates_of(cell));
        if *has_packets {
            self.sample_centre(task, cube, &candidates);
        }
        self.split(task, cube, &candidates, *has_packets, None, place)
    }

    /// Finishes a cell that no pass has split.
    pub(crate) fn finish_open(&self, task: &mut CellTask, cell: &OpenCell, place: Place) -> RefinedCell {
        let cube = &cell.cube;
        if !cell.may_have_list() {
            return self.finish_cell(task, RefinedCell::Tree, place);
        }
        let dominators = Dominators::from_corners(&cube.corners, self.scene.slack);
        self.filter_at_corners(task, cube, self.candidates_of(cell), &dominators, |task, candidates, known| {
            self.sample_centre(task, cube, &candidates);
            self.count_passing(task, cube, &candidates, known);
            self.finish_with_list(task, cube, &candidates, known, place)
        })
    }

    /// Returns the candidates of an open cell.
    fn candidates_of(&self, cell: &OpenCell) -> Vec<Candidate> {
        cell.candidates.iter().map(|candidate| candidate.with_box(self.scene.tree)).collect()
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

    /// Counts a finished cell, which covers a part of the domain, and its memory.
    fn finish_cell(&self, task: &mut CellTask, cell: RefinedCell, place: Place) -> RefinedCell {
        self.finished.add(place.part);
        if let RefinedCell::List(_, first) = cell {
            task.account.spent += Spent::new(size_of_val(&task.blocks[first as usize..]), 0);
        }
        cell
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
        let dominators = Dominators::from_corners(&cube.corners, self.scene.slack);
        let test = BoxTest::new(&dominators, &cube.corners);
        let has_packets = open_candidates(self.scene.tree, &test, &mut candidates);
        let may_have_list = has_packets && candidates.len() <= MAX_LIST_PACKETS;
        let cost = if may_have_list {
            self.sample_centre(task, &cube, &candidates);
            task.scratch.centre.certain_cost(candidates.len())
        } else {
            NS_SAVED_BY_LIST
        };
        let resolution = self.queries.resolution_of_split(&cube, &candidates, cost);
        if resolution <= self.last_resolution {
            if has_packets && !may_have_list && resolution <= task.resolution {
                self.sample_centre(task, &cube, &candidates);
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

    /// Runs the filters of packets at the corners of a cell, applies the corner test, and continues with
    /// the packets that pass.
    fn filter_at_corners(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        mut candidates: Vec<Candidate>,
        dominators: &Dominators,
        go_on: impl FnOnce(&mut CellTask, Vec<Candidate>, KnownDistances<'_>) -> RefinedCell,
    ) -> RefinedCell {
        task.account.spent += Spent::new(0, 8 * candidates.len());
        let mut distances = task.scratch.distances.pop().unwrap_or_default();
        self.scene.isa().run(FilterAtCorners {
            lattice: &mut task.scratch.lattice,
            packets: &self.scene.tree.leaves.packets,
            points: &std::array::from_fn(|at| cube.point(at)),
            dominators,
            candidates: &mut candidates,
            distances: &mut distances,
        });
        let cell = go_on(task, candidates, KnownDistances { distances: &distances, corners: &CUBE_CORNERS });
        task.scratch.distances.push(distances);
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
        self.sample_centre(task, cube, &candidates);
        self.count_passing(task, cube, &candidates, known);
        let cost = task.scratch.centre.cost(candidates.len());
        let resolution = self.queries.resolution_of_split(cube, &candidates, cost);
        if resolution <= self.last_resolution {
            return self.split_or_leave_open(task, cube, candidates, true, Some(known), resolution, place);
        }
        self.finish_with_list(task, cube, &candidates, known, place)
    }

    /// Bounds the distances from the centre of a cell to the boxes of all candidates, and finds the nearest point.
    fn sample_centre(&self, task: &mut CellTask, cube: &Cube, candidates: &[Candidate]) {
        let centre = &mut task.scratch.centre;
        let x = cube.point(LATTICE_CENTRE);
        let mut few = [(f64::INFINITY, 0); NEAREST_BOX_COUNT];
        centre.box_squares.clear();
        for (number, candidate) in candidates.iter().enumerate() {
            let square = candidate.bounds.lower_bound(&x.into());
            centre.box_squares.push(square);
            let mut new = (square, number);
            for old in &mut few {
                if new.0 < old.0 {
                    std::mem::swap(&mut new, old);
                }
            }
        }
        centre.y = self.scene.nearest_of_few(&mut task.account, candidates, few, x);
        centre.count_passing_boxes(cube);
    }

    /// Counts the packets that each kind of bounds lets pass at the centre, which was sampled before.
    fn count_passing(&self, task: &mut CellTask, cube: &Cube, candidates: &[Candidate], known: KnownDistances<'_>) {
        let centre = &mut task.scratch.centre;
        centre.from_corners.clear();
        bound_from_corners(&self.scene, candidates, known, &mut centre.from_corners);
        centre.count_passing_corners(cube);
    }

    /// Finishes a cell with a list, unless one primitive is the nearest everywhere or the tree is better. The centre of
    /// the cell was sampled before.
    fn finish_with_list(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        candidates: &[Candidate],
        known: KnownDistances<'_>,
        place: Place,
    ) -> RefinedCell {
        let centre = &task.scratch.centre;
        let list = CellList::new(&self.scene, cube, candidates, known, centre);
        let probe = || self.scene.probe(&mut task.account, cube.point(LATTICE_CENTRE));
        let cell = if let Some((packet, lane)) = list.single() {
            RefinedCell::Single(packet, lane)
        } else if centre.has_list(list.entries.len(), probe) {
            let first = u32::try_from(task.blocks.len()).expect("a task has few blocks");
            task.blocks.extend(list.blocks());
            RefinedCell::List(0, first)
        } else {
            RefinedCell::Tree
        };
        self.finish_cell(task, cell, place)
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
        task.account.spent += cell.reserved();
        task.open.push(cell);
        RefinedCell::Tree
    }

    /// Splits a cell into its eight children, and refines each of them depth first.
    ///
    /// The basic idea is to treat the children together. Their corners coincide in the 27 points of a lattice, so a
    /// candidate is tested once at each lattice point instead of once at each of the 64 corners:
    ///
    /// 1. Bound the distances from the lattice to the boxes of all candidates.
    /// 2. Find a dominator for each lattice point: a point of the scene that is the nearest, or nearly so. The corners
    ///    of the cell have one already, and so has the centre of a cell with packets. For other points the packets with
    ///    the nearest boxes are evaluated. As long as candidates are nodes, the tree is searched instead.
    /// 3. Find the children that the box of each candidate may reach, by the corner test of boxes.
    /// 4. If the candidates are packets, run their filters at the corners of these children only, and apply the corner
    ///    test to their lanes. Distances at the corners of the cell are `known` and are not computed again.
    /// 5. Refine each child with the candidates and lanes that reach it, and with the distances that were just
    ///    computed.
    ///
    /// The tree answers in the cell if a budget is exceeded. The centre of a cell with packets has to be sampled
    /// before.
    fn split(
        &self,
        task: &mut CellTask,
        cube: &Cube,
        candidates: &[Candidate],
        has_packets: bool,
        known: Option<KnownDistances<'_>>,
        place: Place,
    ) -> RefinedCell {
        if task.account.exceeds(self.budgets) {
            return RefinedCell::Tree;
        }
        let from_corners = if known.is_some() { &task.scratch.centre.from_corners[..] } else { &[] };
        self.scene.isa().run(BoundBoxes { lattice: &mut task.scratch.lattice, cube, candidates, from_corners });
        let mut lattice = [Corner { x: [0.0; 3], y: task.scratch.centre.y }; LATTICE_POINTS];
        for (at, corner) in lattice.iter_mut().enumerate() {
            corner.x = cube.point(at);
            if let Some(known) = cube_corner_at(at) {
                corner.y = cube.corners[known].y;
            } else if !has_packets {
                let known = &mut task.scratch.nearest_points;
                corner.y = self.scene.nearest_to_lattice_point(&mut task.account, known, corner.x);
            } else if at != LATTICE_CENTRE {
                let few = task.scratch.lattice.nearest_boxes(at, cube.side);
                corner.y = self.scene.nearest_of_few(&mut task.account, candidates, few, corner.x);
            }
        }
        let limits = LatticeLimits::new(&lattice, cube.side, self.scene.slack);
        self.scene.isa().run(ReachChildren { lattice: &mut task.scratch.lattice, limits: &limits });
        let children = cube.children(&lattice);
        let mut distances = Vec::new();
        if has_packets {
            distances = task.scratch.distances.pop().unwrap_or_default();
            if distances.len() < candidates.len() {
                distances.resize(candidates.len(), LatticeDistances::default());
            }
            let dominators = std::array::from_fn(|c| Dominators::from_corners(&children[c].corners, self.scene.slack));
            let tests = self.scene.isa().run(FilterLanes {
                lattice: &mut task.scratch.lattice,
                packets: &self.scene.tree.leaves.packets,
                candidates,
                points: &lattice.map(|corner| corner.x),
                known,
                dominators: &dominators,
                distances: &mut distances,
            });
            task.account.spent += Spent::new(CODE_BYTES_PER_SPLIT, tests);
        } else {
            // The children need at most 19 searches of the tree, each of which tests some packets.
            task.account.spent += Spent::new(CODE_BYTES_PER_SPLIT, 19 * 8);
            task.scratch.lattice.keep_all_lanes();
        }
        let inherited: [Vec<Candidate>; 8] = std::array::from_fn(|child| {
            let lanes = task.scratch.lattice.lanes.iter().map(|lanes| lanes[child]);
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
            task.scratch.distances.push(distances);
        }
        RefinedCell::Split(first)
    }
}
