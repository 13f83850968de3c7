//! The rule of an octree: which cells are split, and which get a list.
//!
//! A split costs memory and saves time where queries are. The *mass* of a cell is the share of queries that fall into
//! it, summed over several kinds of queries, each with a weight: uniform in the domain, uniform in smaller boxes around
//! the scene, and on the surface. Weights do not add up to 1. The *cost* of the list of a cell is the time that a query
//! at the centre of the cell spends on it, beyond the time for one packet in one block: testing the packets that the
//! bounds of the blocks let pass, and bounding the packets of the blocks. A cell without a list has a fixed cost, the
//! time by which a search of the tree is slower than a list. A cell is split if its mass times the part of its cost
//! that a split saves exceeds a threshold. The higher the resolution is, the lower is the threshold.
//!
//! A cell that is not split gets a list, unless the list would be long, or the tree is faster than the list.
//!
//! This file has the whole rule, and no part of it is needed for correct answers. The refinement
//! ([`refinement`](crate::octree::refinement)) asks it about each cell.

use crate::list::block::{BLOCK_WIDTH, MAX_LEVEL};
use crate::octree::candidate::Candidate;
use crate::octree::cube::{Cube, LATTICE_CENTRE};
use crate::octree::domain::{DomainCube, EVERYWHERE_SCENE_SIZES};
use crate::octree::scene_tree::TreeProbe;
use crate::options::Domain;
use p2m_core::Aabb;
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The boxes in which queries are expected to be uniform: the side in sizes of the scene, and the weight. The boxes are
/// nested, so queries are denser near the scene. No record exists of how the weights were chosen.
const QUERY_BOXES: [(f64, f64); 4] = [(EVERYWHERE_SCENE_SIZES, 1.0), (4.0, 0.3), (2.0, 0.3), (1.05, 1.0)];

/// The time in which a query tests a packet of a list or of the tree, in nanoseconds. This and the next two times were
/// observed on one processor, of which no record exists. Only their ratios matter, and the cells depend on each of
/// them.
const NS_PER_PACKET: f64 = 40.0;
/// The time in which a query bounds the packets of one block of a list, in nanoseconds.
const NS_PER_BLOCK: f64 = 15.0;
/// The time in which a query visits a node of the tree, in nanoseconds.
const NS_PER_NODE: f64 = 30.0;
/// The cost of a cell without a list: the time that a query saves if a list replaces a search of the
/// tree, in nanoseconds.
pub(crate) const NS_SAVED_BY_LIST: f64 = 300.0;

/// The fraction of its cost that a cell is assumed to save by a split.
const COST_SAVED_BY_SPLIT: f64 = 0.5;
/// A cell is split at once, before the filters of its packets run, if even this fraction of the cost predicted from
/// their boxes justifies it.
const CERTAIN_PART_OF_BOX_COST: f64 = 0.25;
/// The least saving for which a cell is split at resolution 1, in nanoseconds times mass. The unit of mass is the mass
/// of one packet.
const MIN_NS_SAVED_BY_SPLIT: f64 = 100.0;

/// The largest number of packets in a list. Cells with more are left to the tree. Lists of up to 256 packets pay,
/// because a block of eight is bounded faster than one packet is tested
/// (docs/decisions/016-lists-bounded-by-cell-corners.md).
pub(crate) const MAX_LIST_PACKETS: usize = 256;
/// The number of packets above which a list is compared with a search of the tree at the centre of the cell.
const COMPARE_WITH_TREE_ABOVE_PACKETS: usize = 24;

/// The expected distribution of queries, which decides how much a split is worth.
pub(crate) struct ExpectedQueries {
    /// The boxes in which queries are uniform, each with the number of queries in a unit of volume.
    uniform_boxes: Vec<(Aabb<f64>, f64)>,
    /// The reciprocal of the number of packets: each packet has this share of the queries on the surface.
    inv_packet_count: f64,
}

impl ExpectedQueries {
    /// Makes the distribution of queries in a domain with this cube, and on the surface of `packet_count` packets.
    pub(crate) fn new(domain: Domain, cube: &DomainCube, packet_count: usize) -> Self {
        let uniform_box = |scale: f64, weight: f64| {
            let half = cube.scene_extent * (scale * 0.5);
            let bounds = Aabb { min: cube.scene_centre - half, max: cube.scene_centre + half };
            (bounds, weight / (half * 2.0).product())
        };
        let uniform_boxes = match domain {
            Domain::Everywhere => QUERY_BOXES.map(|(scale, weight)| uniform_box(scale, weight)).to_vec(),
            Domain::Box(_) | Domain::Band(_) => {
                vec![(cube.domain, 1.0 / (cube.domain.max - cube.domain.min).product())]
            }
        };
        Self { uniform_boxes, inv_packet_count: 1.0 / packet_count as f64 }
    }

    /// Estimates the mass of a cell: its share of the queries.
    fn query_mass(&self, cube: &Cube, candidates: &[Candidate]) -> f64 {
        let cell_bounds = cube.bounds();
        let mut mass = 0.0;
        for (bounds, density) in &self.uniform_boxes {
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

    /// Returns the least resolution at which a split is worth its memory, given the cost of the cell. It is infinite
    /// for a cell of the last level.
    pub(crate) fn resolution_of_split(&self, cube: &Cube, candidates: &[Candidate], cost: f64) -> f64 {
        if cube.level >= MAX_LEVEL || cost <= 0.0 {
            return f64::INFINITY;
        }
        let mass = self.query_mass(cube, candidates);
        MIN_NS_SAVED_BY_SPLIT * self.inv_packet_count / (mass * cost * COST_SAVED_BY_SPLIT)
    }
}

/// The centre of a cell, at which one query stands for all queries in the cell. Its vectors are reused.
#[derive(Default)]
pub(crate) struct CellCentre {
    /// The nearest point of the scene, which is a dominator.
    pub(crate) y: V3,
    /// The squared lower bounds of the distances from the centre to the boxes of all candidates.
    pub(crate) box_squares: Vec<f64>,
    /// For each candidate lower bounds of the distances from the corners to its lanes.
    pub(crate) from_corners: Vec<[f64; 8]>,
    /// The number of packets that a block with boxes would let pass.
    passing_boxes: usize,
    /// The number of packets that a block with corners would let pass.
    passing_corners: usize,
}

impl CellCentre {
    /// Counts the packets that blocks with boxes would let pass, given `y` and `box_squares`.
    pub(crate) fn count_passing_boxes(&mut self, cube: &Cube) {
        let y_squared = norm_squared(sub(cube.point(LATTICE_CENTRE), self.y));
        self.passing_boxes = self.box_squares.iter().filter(|square| **square <= y_squared).count();
    }

    /// Counts the packets that blocks with corners would let pass, given `y` and `from_corners`.
    pub(crate) fn count_passing_corners(&mut self, cube: &Cube) {
        let squares = cube.corners.map(|corner| norm_squared(sub(corner.x, self.y)));
        let y_squared = norm_squared(sub(cube.point(LATTICE_CENTRE), self.y));
        let mut top = 0.0f64;
        for least in &self.from_corners {
            for i in 0..8 {
                top = top.max(squares[i] - least[i] * least[i]);
            }
        }
        let is_passing = |least: &&[f64; 8]| {
            let sum: f64 = (0..8).map(|i| (least[i] * least[i] - squares[i]).min(top)).sum();
            sum / 8.0 - top / 128.0 <= 0.0
        };
        self.passing_corners = self.from_corners.iter().filter(is_passing).count();
        // Boxes are considered only near the scene, and only if corners let several packets pass.
        if self.passing_corners <= 2 || y_squared >= 4.0 * cube.side * cube.side {
            self.passing_boxes = usize::MAX;
        }
    }

    /// Returns whether the blocks of the list have boxes, which let fewer packets pass than corners.
    pub(crate) fn prefers_boxes(&self) -> bool {
        self.passing_boxes < self.passing_corners
    }

    /// Returns the number of packets of the list that a query tests.
    fn tests(&self) -> usize {
        self.passing_boxes.min(self.passing_corners)
    }

    /// Returns a cost that the list is taken to have in any case, when only the boxes of its packets are known.
    pub(crate) fn certain_cost(&self, packets: usize) -> f64 {
        CERTAIN_PART_OF_BOX_COST * list_cost(self.passing_boxes, packets)
    }

    /// Returns the cost of a cell with this number of packets.
    pub(crate) fn cost(&self, packets: usize) -> f64 {
        if packets <= MAX_LIST_PACKETS { list_cost(self.tests(), packets) } else { NS_SAVED_BY_LIST }
    }

    /// Returns whether a cell that is not split has a list of this number of packets. `probe` searches the tree
    /// at the centre.
    pub(crate) fn has_list(&self, packets: usize, probe: impl FnOnce() -> TreeProbe) -> bool {
        if packets == 0 || packets > MAX_LIST_PACKETS {
            return false;
        }
        if packets <= COMPARE_WITH_TREE_ABOVE_PACKETS {
            return true;
        }
        let list = NS_PER_PACKET * self.tests() as f64 + NS_PER_BLOCK * packets as f64 / BLOCK_WIDTH as f64;
        let probe = probe();
        list <= NS_PER_PACKET * probe.packets as f64 + NS_PER_NODE * probe.nodes as f64
    }
}

/// Returns the cost of a list of `packets` packets, of which a query tests `tests`, in nanoseconds beyond the cost of
/// the shortest list.
fn list_cost(tests: usize, packets: usize) -> f64 {
    let blocks = packets as f64 / BLOCK_WIDTH as f64;
    NS_PER_PACKET * (tests as f64 - 1.0) + NS_PER_BLOCK * (blocks - 1.0).max(0.0)
}
