//! The list of a cell.

use crate::list::block::{BLOCK_WIDTH, Block, BoundKind, Entry, round_reference};
use crate::list::corner_test::{DistancesAtPoints, LaneDistances, MinOverLanes};
use crate::octree::cell::{Cube, LATTICE_CENTRE};
use crate::octree::refinement::{
    CellCentre, NS_PER_BLOCK, NS_PER_NODE, NS_PER_PACKET, NearestSample, PacketCandidate, RefinedCell, Refinement,
    TreeProbe,
};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Best, QueryOptions};

/// No list is longer, in packets.
const MAX_LIST_PACKETS: usize = 256;
/// VoronoiLists longer than this are held against the tree.
const COMPARE_WITH_TREE_ABOVE_PACKETS: usize = 24;

impl Refinement<'_> {
    /// The nearest point to `x`: of the primitive that seems nearest, or of the scene where filters do not tell of the
    /// `has_all_bounds`.
    pub(crate) fn nearest_of_sample(&self, near: &NearestSample, has_all_bounds: bool, x: V3) -> V3 {
        if !has_all_bounds || near.distance == f64::INFINITY {
            return self.nearest(x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        let packet = &self.tree.leaves.packets[near.packet as usize];
        packet.offer(near.lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }

    /// What the filters find in the centre of a cell.
    pub(crate) fn centre(&self, cube: &Cube, items: &[PacketCandidate]) -> CellCentre {
        let x = cube.point(LATTICE_CENTRE);
        let mut centre = CellCentre {
            distances: Vec::with_capacity(items.len()),
            has_all_bounds: true,
            y: x,
            passing_boxes: 0,
            passing_corners: 0,
        };
        let mut nearest = NearestSample::NONE;
        self.counters.charge_tests(items.len());
        for item in items {
            let mut distances = [LaneDistances::UNKNOWN];
            let mut near = [None];
            let packet = &self.tree.leaves.packets[item.packet as usize];
            centre.has_all_bounds &= packet.has_vertices();
            self.isa().run(DistancesAtPoints { packet, points: &[x], distances: &mut distances, nearest: &mut near });
            centre.distances.push(distances[0]);
            nearest.add(near[0], item.packet);
        }
        centre.y = self.nearest_of_sample(&nearest, centre.has_all_bounds, x);
        // How many packets either kind of bounds lets pass there.
        let squares = cube.corners.map(|corner| norm_squared(sub(corner.x, centre.y)));
        let own = norm_squared(sub(x, centre.y));
        let f = items.iter().map(|item| {
            let unit = self.tree.leaves.packets[item.packet as usize].unit();
            let least = self.isa().run(MinOverLanes { distances: &item.distances, lanes: item.lanes });
            std::array::from_fn(|i| (least[i] * unit) * (least[i] * unit) - squares[i])
        });
        let f: Vec<[f64; 8]> = f.collect();
        let top = f.as_flattened().iter().fold(0.0f64, |a, x| a.max(-x));
        let bound = |f: &[f64; 8]| own + f.iter().map(|f| f.min(top)).sum::<f64>() / 8.0 - top / 128.0;
        centre.passing_corners = f.iter().filter(|f| bound(f) <= own).count();
        // Boxes are the exception, and only near the scene.
        centre.passing_boxes = if centre.passing_corners > 2 && own < 4.0 * cube.side * cube.side {
            let bound = |item: &PacketCandidate| item.bounds.lower_bound(&nalgebra::Point3::from(x));
            items.iter().filter(|item| bound(item) <= own).count()
        } else {
            usize::MAX
        };
        centre
    }

    /// A list as it is kept.
    pub(crate) fn build_list(&self, cube: &Cube, items: &[PacketCandidate], centre: &CellCentre) -> RefinedCell {
        let frame = &self.tree.frame;
        let y = round_reference(frame.place(&centre.y));
        let squares = cube.corners.map(|corner| norm_squared(sub(frame.place(&corner.x), y)));
        // Rounding in f64, of positions in the frame and of these squares, and of the cell that a query is taken to lie
        // in: where f is below zero, so that its value matters, it changes by twice the way to y for each step
        // at most.
        let largest = squares.iter().fold(1.0, |a: f64, x| a.max(*x));
        let margin = largest * 2f64.powi(-46) + 4.0 * self.slack * frame.per_unit * largest.sqrt();
        let mut entries: Vec<(f64, Entry)> = Vec::with_capacity(items.len());
        let mut single = None;
        let mut count = 0;
        for (item, distances) in items.iter().zip(&centre.distances) {
            let packet = &self.tree.leaves.packets[item.packet as usize];
            let lanes = self.lanes_without_ties(cube, item);
            if lanes == 0 {
                continue;
            }
            count += lanes.count_ones();
            single = Some((item.packet, lanes.trailing_zeros()));
            let bounds = frame.enclose(&packet.bounds_of(lanes));
            let length = packet.unit() * frame.per_unit;
            let least = self.isa().run(MinOverLanes { distances: &item.distances, lanes });
            let f = std::array::from_fn(|i| (least[i] * length) * (least[i] * length) - squares[i] - margin);
            // Nearer packets in earlier blocks.
            let order = self.isa().run(MinOverLanes { distances: std::slice::from_ref(distances), lanes })[0] * length;
            entries.push((order, Entry { packet: item.packet, lanes, bounds, f }));
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
                    BoundKind::CellCorners { level: cube.level, y }
                };
                RefinedCell::Blocks(Block::from_list(&entries, bounds))
            }
        }
    }

    /// Whether the tree takes less in the centre of a cell than its list, if that is long.
    fn is_tree_faster(&self, cube: &Cube, len: usize, centre: &CellCentre) -> bool {
        if len <= COMPARE_WITH_TREE_ABOVE_PACKETS {
            return false;
        }
        let tests = centre.passing_boxes.min(centre.passing_corners) as f64;
        let list = NS_PER_PACKET * tests + NS_PER_BLOCK * len as f64 / BLOCK_WIDTH as f64;
        let TreeProbe { nodes, packets, .. } = self.probe_tree(cube.point(LATTICE_CENTRE));
        list > NS_PER_PACKET * packets as f64 + NS_PER_NODE * nodes as f64
    }

    /// The lanes of an item without those that can only tie with a lower primitive: where a vertex is the nearest point
    /// of a primitive in the has_all_bounds cell, certainly enough for the kernel to give exactly the distance to it, the
    /// lowest primitive with that vertex is at least as near.
    fn lanes_without_ties(&self, cube: &Cube, item: &PacketCandidate) -> u16 {
        /// The kernel is content with 2^-38.
        const MARGIN: f64 = 1.0 / (1u64 << 36) as f64;
        let packet = &self.tree.leaves.packets[item.packet as usize];
        // And in what rounding may add to it: a query may lie beside its cell.
        let half = cube.side * 0.5 + self.slack;
        let centre = cube.low.map(|x| x + cube.side * 0.5);
        let mut kept = item.lanes;
        for lane in (0..packet.ids().len()).filter(|lane| item.lanes >> lane & 1 == 1) {
            let (corners, count) = packet.vertices_of(lane);
            let corners = &corners[..count];
            let vertex = |v: usize| self.tree.leaves.vertices[corners[v]];
            let ties = (0..corners.len()).any(|v| {
                if self.lowest_owners[corners[v]] >= packet.ids()[lane] {
                    return false;
                }
                let own = vertex(v);
                (0..corners.len()).filter(|&w| w != v).all(|w| {
                    let other = vertex(w);
                    let edge: V3 = std::array::from_fn(|k| other[k] - own[k]);
                    let to: V3 = std::array::from_fn(|k| centre[k] - own[k]);
                    let size = (0..3).map(|k| to[k].abs() + half + edge[k].abs()).fold(0.0, f64::max);
                    // The largest value of (q - own) . edge in the cell.
                    let most: f64 = (0..3).map(|k| to[k] * edge[k] + half * edge[k].abs()).sum();
                    most < -MARGIN * size * size
                })
            });
            if ties {
                kept &= !(1 << lane);
            }
        }
        kept
    }
}
