//! The list of a cell that is not split.

use crate::list::block::{Block, BoundKind, Entry, round_reference};
use crate::list::corner_test::NearestVertices;
use crate::octree::candidate::Candidate;
use crate::octree::cube::Cube;
use crate::octree::lattice::{BoundFromCorners, KnownDistances};
use crate::octree::scene_tree::SceneTree;
use crate::octree::split_rule::CellCentre;
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The list of a cell before it is stored.
pub(crate) struct CellList {
    /// The packets, the nearest ones to the cell first.
    pub(crate) entries: Vec<Entry>,
    /// The kind of the bounds of the entries.
    bounds: BoundKind,
}

impl CellList {
    /// Lists the candidates of a cell, whose centre was sampled before.
    pub(crate) fn new(
        scene: &SceneTree<'_>,
        cube: &Cube,
        candidates: &[Candidate],
        known: KnownDistances<'_>,
        centre: &CellCentre,
    ) -> Self {
        let frame = &scene.tree.frame;
        let y = round_reference(frame.place(&centre.y));
        let squares = cube.corners.map(|corner| norm_squared(sub(frame.place(&corner.x), y)));
        // The margin covers the rounding in f64 of these squares and of positions in the frame, and the error of the
        // cell in which a query is located. Values of f matter only below zero, where f changes by at most twice the
        // distance to y for each unit of displacement.
        let largest = squares.iter().fold(1.0, |a: f64, x| a.max(*x));
        let margin = largest * 2f64.powi(-46) + 4.0 * scene.slack * frame.per_unit * largest.sqrt();
        let has_boxes = centre.prefers_boxes();
        // The keys are sorted, and the entries follow, because an entry is four times as large as its key.
        let (mut entries, mut keys) = (Vec::with_capacity(candidates.len()), Vec::with_capacity(candidates.len()));
        let mut bounds = Vec::with_capacity(1);
        for (candidate, from_corners) in candidates.iter().zip(&centre.from_corners) {
            let number = candidate.child.number();
            let packet = &scene.tree.leaves.packets[number];
            let lanes = lanes_without_ties(scene, cube, candidate);
            if lanes == 0 {
                continue;
            }
            bounds.clear();
            if lanes == candidate.lanes {
                bounds.push(*from_corners);
            } else {
                bound_from_corners(scene, &[Candidate { lanes, ..*candidate }], known, &mut bounds);
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
        keys.sort_unstable();
        let entries = keys.iter().map(|(_, _, entry)| entries[*entry]).collect();
        Self { entries, bounds: if has_boxes { BoundKind::Boxes } else { BoundKind::Corners { level: cube.level, y } } }
    }

    /// Returns the packet and the lane of the only primitive, if there is only one.
    pub(crate) fn single(&self) -> Option<(u32, u8)> {
        match self.entries[..] {
            [Entry { packet, lanes, .. }] if lanes.is_power_of_two() => {
                Some((packet, u8::try_from(lanes.trailing_zeros()).expect("sixteen lanes")))
            }
            _ => None,
        }
    }

    /// Returns the blocks of the list, as they are stored.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = Block> {
        Block::from_list(&self.entries, self.bounds)
    }
}

/// Appends lower bounds of the distances from the corners of a cell to candidates.
pub(crate) fn bound_from_corners(
    scene: &SceneTree<'_>,
    candidates: &[Candidate],
    known: KnownDistances<'_>,
    bounds: &mut Vec<[f64; 8]>,
) {
    scene.isa().run(BoundFromCorners { packets: &scene.tree.leaves.packets, candidates, known, bounds });
}

/// Returns the lanes of a candidate, except those that can only tie with a primitive of a lower id. Such a lane has one
/// vertex as its nearest point everywhere in the cell, with a margin that makes the kernel return exactly the distance
/// to this vertex, and a primitive with a lower id has the same vertex.
fn lanes_without_ties(scene: &SceneTree<'_>, cube: &Cube, candidate: &Candidate) -> u16 {
    /// The relative margin by which a vertex has to be the nearest point. The kernel needs 2^-38.
    const MARGIN: f64 = 1.0 / (1u64 << 36) as f64;
    let packet = &scene.tree.leaves.packets[candidate.child.number()];
    // The slack is added because rounding may put a query beside its cell.
    let half = cube.side * 0.5 + scene.slack;
    let centre = cube.low.map(|x| x + cube.side * 0.5);
    let is_nearest = scene.isa().run(NearestVertices { packet, centre: &centre, half });
    let mut kept = candidate.lanes;
    for (v, lanes) in is_nearest.into_iter().enumerate() {
        let mut rest = u32::from(kept) & lanes;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let (corners, count) = packet.vertices_of(lane);
            if v >= count || scene.lowest_owners[corners[v]] >= packet.ids()[lane] {
                continue;
            }
            let vertex = |v: usize| scene.tree.leaves.vertices[corners[v]];
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
