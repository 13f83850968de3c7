//! The middle of a cell, which predicts what queries cost there, and the list of a finished cell.

use crate::list::block::{BLOCK_WIDTH, Block, BoundKind, Entry, round_reference};
use crate::list::corner_test::{DistancesAtPoint, NearestVertices};
use crate::octree::budget::Spent;
use crate::octree::cell::{Cube, LATTICE_CENTRE};
use crate::octree::lattice::{BoundFromCorners, NEAREST_BOX_COUNT};
use crate::octree::refinement::{
    Candidate, CellCentre, CellTask, KnownDistances, NS_PER_BLOCK, NS_PER_NODE, NS_PER_PACKET, RefinedCell, Refinement,
    TreeProbe,
};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Best, QueryOptions};

/// A cell with a longer list is left to the tree.
pub(crate) const MAX_LIST_PACKETS: usize = 256;
/// Longer lists are compared with a search of the tree at the centre of the cell.
const COMPARE_WITH_TREE_ABOVE_PACKETS: usize = 24;

impl Refinement<'_> {
    /// Returns a point of the scene that is the nearest to `x`, or nearly so, given the few packets whose boxes are the
    /// nearest to `x` with the squared lower bounds of their distances, the nearest first. If the filter of one of
    /// them cannot be used, it searches the tree.
    pub(crate) fn nearest_of_few(
        &self,
        task: &mut CellTask,
        candidates: &[Candidate],
        few: [(f64, usize); NEAREST_BOX_COUNT],
        x: V3,
    ) -> V3 {
        let mut best = (f64::INFINITY, 0, 0);
        for (square, number) in few {
            if square >= best.0 * best.0 {
                break;
            }
            task.spent += Spent::new(0, 1);
            let packet = candidates[number].child.number();
            let at = DistancesAtPoint { packet: &self.tree.leaves.packets[packet], point: &x };
            let Some((distance, lane)) = self.isa().run(at).1 else { return self.nearest(task, x) };
            if distance < best.0 {
                best = (distance, packet, lane);
            }
        }
        let (distance, packet, lane) = best;
        if distance == f64::INFINITY {
            return self.nearest(task, x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        self.tree.leaves.packets[packet].offer(lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }

    /// Bounds the distances from the centre of a cell to the boxes of all candidates, and finds the nearest point.
    pub(crate) fn sample_centre(&self, cube: &Cube, candidates: &[Candidate], task: &mut CellTask) {
        let x = cube.point(LATTICE_CENTRE);
        let mut few = [(f64::INFINITY, 0); NEAREST_BOX_COUNT];
        task.centre.box_squares.clear();
        for (number, candidate) in candidates.iter().enumerate() {
            let square = candidate.bounds.lower_bound(&x.into());
            task.centre.box_squares.push(square);
            let mut new = (square, number);
            for old in &mut few {
                if new.0 < old.0 {
                    std::mem::swap(&mut new, old);
                }
            }
        }
        task.centre.y = self.nearest_of_few(task, candidates, few, x);
        let y_squared = norm_squared(sub(x, task.centre.y));
        task.centre.passing_boxes = task.centre.box_squares.iter().filter(|square| **square <= y_squared).count();
    }

    /// Counts the packets that each kind of bounds lets pass at the centre, which was sampled before.
    pub(crate) fn count_passing(
        &self,
        cube: &Cube,
        candidates: &[Candidate],
        known: KnownDistances<'_>,
        centre: &mut CellCentre,
    ) {
        let squares = cube.corners.map(|corner| norm_squared(sub(corner.x, centre.y)));
        let y_squared = norm_squared(sub(cube.point(LATTICE_CENTRE), centre.y));
        centre.from_corners.clear();
        self.bound_from_corners(candidates, known, &mut centre.from_corners);
        let mut top = 0.0f64;
        for least in &centre.from_corners {
            for i in 0..8 {
                top = top.max(squares[i] - least[i] * least[i]);
            }
        }
        let is_passing = |least: &&[f64; 8]| {
            let sum: f64 = (0..8).map(|i| (least[i] * least[i] - squares[i]).min(top)).sum();
            sum / 8.0 - top / 128.0 <= 0.0
        };
        centre.passing_corners = centre.from_corners.iter().filter(is_passing).count();
        // Boxes are considered only near the scene, and only if corners let several packets pass.
        if centre.passing_corners <= 2 || y_squared >= 4.0 * cube.side * cube.side {
            centre.passing_boxes = usize::MAX;
        }
    }

    /// Appends lower bounds of the distances from the corners of a cell to candidates.
    fn bound_from_corners(&self, candidates: &[Candidate], known: KnownDistances<'_>, bounds: &mut Vec<[f64; 8]>) {
        self.isa().run(BoundFromCorners { packets: &self.tree.leaves.packets, candidates, known, bounds });
    }

    /// Builds the list of a cell as it is stored, or a cell without a list if the tree is better. The centre of the
    /// cell was sampled before.
    pub(crate) fn build_list(
        &self,
        cube: &Cube,
        candidates: &[Candidate],
        known: KnownDistances<'_>,
        task: &mut CellTask,
    ) -> RefinedCell {
        let centre = &task.centre;
        let frame = &self.tree.frame;
        let y = round_reference(frame.place(&centre.y));
        let squares = cube.corners.map(|corner| norm_squared(sub(frame.place(&corner.x), y)));
        // The margin covers the rounding in f64 of these squares and of positions in the frame, and the error of the
        // cell in which a query is located. Values of f matter only below zero, where f changes by at most twice the
        // distance to y for each unit of displacement.
        let largest = squares.iter().fold(1.0, |a: f64, x| a.max(*x));
        let margin = largest * 2f64.powi(-46) + 4.0 * self.slack * frame.per_unit * largest.sqrt();
        let has_boxes = centre.passing_boxes < centre.passing_corners;
        // The keys are sorted, and the entries follow, because an entry is four times as large as its key.
        let (mut entries, mut keys) = (Vec::with_capacity(candidates.len()), Vec::with_capacity(candidates.len()));
        let (mut count, mut bounds) = (0, Vec::with_capacity(1));
        for (candidate, from_corners) in candidates.iter().zip(&centre.from_corners) {
            let number = candidate.child.number();
            let packet = &self.tree.leaves.packets[number];
            let lanes = self.lanes_without_ties(cube, candidate);
            if lanes == 0 {
                continue;
            }
            count += lanes.count_ones();
            bounds.clear();
            if lanes == candidate.lanes {
                bounds.push(*from_corners);
            } else {
                self.bound_from_corners(&[Candidate { lanes, ..*candidate }], known, &mut bounds);
            }
            let from_corners = bounds[0];
            // Packets that are nearer to the cell come into earlier blocks. The sum is not negative, and the bits of
            // such numbers have the order of the numbers.
            let order: f64 = from_corners.iter().map(|least| least * least).sum();
            keys.push((order.to_bits(), number, entries.len()));
            let mut entry = Entry {
                packet: u32::try_from(number).expect("packets have numbers"),
                lanes,
                bounds: [[0.0; 3]; 2],
                f: [0.0; 8],
            };
            if has_boxes {
                entry.bounds = frame.enclose(&packet.bounds_of(lanes));
            } else {
                let length = frame.per_unit;
                entry.f = std::array::from_fn(|i| {
                    (from_corners[i] * length) * (from_corners[i] * length) - squares[i] - margin
                });
            }
            entries.push(entry);
        }
        match &entries[..] {
            [Entry { packet, lanes, .. }] if count == 1 => {
                RefinedCell::Single(*packet, u8::try_from(lanes.trailing_zeros()).expect("sixteen lanes"))
            }
            entries
                if entries.is_empty()
                    || entries.len() > MAX_LIST_PACKETS
                    || self.is_tree_faster(task, cube, entries.len()) =>
            {
                RefinedCell::Tree
            }
            entries => {
                keys.sort_unstable();
                let entries: Vec<Entry> = keys.iter().map(|(_, _, entry)| entries[*entry]).collect();
                let bounds = if has_boxes { BoundKind::Boxes } else { BoundKind::Corners { level: cube.level, y } };
                let first = u32::try_from(task.blocks.len()).expect("a task has few blocks");
                task.blocks.extend(Block::from_list(&entries, bounds));
                RefinedCell::List(0, first)
            }
        }
    }

    /// Returns whether a search of the tree takes less time at the centre of the cell than a long list would.
    fn is_tree_faster(&self, task: &mut CellTask, cube: &Cube, len: usize) -> bool {
        if len <= COMPARE_WITH_TREE_ABOVE_PACKETS {
            return false;
        }
        let tests = task.centre.passing_boxes.min(task.centre.passing_corners) as f64;
        let list = NS_PER_PACKET * tests + NS_PER_BLOCK * len as f64 / BLOCK_WIDTH as f64;
        let TreeProbe { nodes, packets, .. } = self.probe_tree(task, cube.point(LATTICE_CENTRE));
        list > NS_PER_PACKET * packets as f64 + NS_PER_NODE * nodes as f64
    }

    /// Returns the lanes of a candidate without those that can only tie with a primitive of a lower id. Such a lane
    /// has one vertex as its nearest point everywhere in the cell, with a margin that makes the kernel return exactly
    /// the distance to this vertex, and a primitive with a lower id has the same vertex.
    fn lanes_without_ties(&self, cube: &Cube, candidate: &Candidate) -> u16 {
        /// The relative margin by which a vertex has to be the nearest point. The kernel needs 2^-38.
        const MARGIN: f64 = 1.0 / (1u64 << 36) as f64;
        let packet = &self.tree.leaves.packets[candidate.child.number()];
        // The slack is added because rounding may put a query beside its cell.
        let half = cube.side * 0.5 + self.slack;
        let centre = cube.low.map(|x| x + cube.side * 0.5);
        let is_nearest = self.isa().run(NearestVertices { packet, centre: &centre, half });
        let mut kept = candidate.lanes;
        for (v, lanes) in is_nearest.into_iter().enumerate() {
            let mut rest = u32::from(kept) & lanes;
            while rest != 0 {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let (corners, count) = packet.vertices_of(lane);
                if v >= count || self.lowest_owners[corners[v]] >= packet.ids()[lane] {
                    continue;
                }
                let vertex = |v: usize| self.tree.leaves.vertices[corners[v]];
                let nearest = vertex(v);
                let ties = (0..count).filter(|&w| w != v).all(|w| {
                    let other = vertex(w);
                    let edge: V3 = std::array::from_fn(|k| other[k] - nearest[k]);
                    let to: V3 = std::array::from_fn(|k| centre[k] - nearest[k]);
                    let size = (0..3).map(|k| to[k].abs() + half + edge[k].abs()).fold(0.0, f64::max);
                    // This is the largest value of (q - nearest) . edge in the cell.
                    let largest: f64 = (0..3).map(|k| to[k] * edge[k] + half * edge[k].abs()).sum();
                    largest < -MARGIN * size * size
                });
                if ties {
                    kept &= !(1 << lane);
                }
            }
        }
        kept
    }
}
