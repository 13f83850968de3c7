//! The list of a cell.

use crate::list::block::{Block, Bounds, Entry, WIDTH, reference};
use crate::list::corner_test::{AtPoints, Found, Least};
use crate::octree::cell::{Cube, MIDDLE};
use crate::octree::refinement::{
    Cell, Item, Middle, NANOSECONDS_A_BLOCK, NANOSECONDS_A_NODE, NANOSECONDS_A_PACKET, Nearest, Refinement, Searched,
};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Best, QueryOptions};

/// No list is longer, in packets.
const LONGEST: usize = 256;
/// Lists longer than this are held against the tree.
const LONG: usize = 24;

impl Refinement<'_> {
    /// The nearest point to `x`: of the primitive that seems nearest, or of the scene where filters do not tell of the
    /// `whole`.
    pub(crate) fn nearest_of(&self, near: &Nearest, whole: bool, x: V3) -> V3 {
        if !whole || near.distance == f64::INFINITY {
            return self.nearest(x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        let packet = &self.tree.leaves.packets[near.packet as usize];
        packet.offer(near.lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }

    /// What the filters find in the middle of a cell.
    pub(crate) fn middle(&self, cube: &Cube, items: &[Item]) -> Middle {
        let x = cube.point(MIDDLE);
        let mut middle = Middle { found: Vec::with_capacity(items.len()), whole: true, y: x, boxes: 0, corners: 0 };
        let mut nearest = Nearest::NONE;
        self.done.add_work(items.len());
        for item in items {
            let mut found = [Found::NOTHING];
            let mut near = [None];
            let packet = &self.tree.leaves.packets[item.packet as usize];
            middle.whole &= packet.has_vertices();
            self.isa().run(AtPoints { packet, points: &[x], found: &mut found, nearest: &mut near });
            middle.found.push(found[0]);
            nearest.add(near[0], item.packet);
        }
        middle.y = self.nearest_of(&nearest, middle.whole, x);
        // How many packets either kind of bounds lets pass there.
        let squares = cube.corners.map(|corner| norm_squared(sub(corner.x, middle.y)));
        let own = norm_squared(sub(x, middle.y));
        let f = items.iter().map(|item| {
            let unit = self.tree.leaves.packets[item.packet as usize].unit();
            let least = self.isa().run(Least { found: &item.found, lanes: item.lanes });
            std::array::from_fn(|i| (least[i] * unit) * (least[i] * unit) - squares[i])
        });
        let f: Vec<[f64; 8]> = f.collect();
        let top = f.as_flattened().iter().fold(0.0f64, |a, x| a.max(-x));
        let bound = |f: &[f64; 8]| own + f.iter().map(|f| f.min(top)).sum::<f64>() / 8.0 - top / 128.0;
        middle.corners = f.iter().filter(|f| bound(f) <= own).count();
        // Boxes are the exception, and only near the scene.
        middle.boxes = if middle.corners > 2 && own < 4.0 * cube.side * cube.side {
            let bound = |item: &Item| item.bounds.lower_bound(&nalgebra::Point3::from(x));
            items.iter().filter(|item| bound(item) <= own).count()
        } else {
            usize::MAX
        };
        middle
    }

    /// A list as it is kept.
    pub(crate) fn list(&self, cube: &Cube, items: &[Item], middle: &Middle) -> Cell {
        let frame = &self.tree.frame;
        let y = reference(frame.place(&middle.y));
        let squares = cube.corners.map(|corner| norm_squared(sub(frame.place(&corner.x), y)));
        // Rounding in f64, of places in the frame and of these squares, and of the cell that a query is taken to lie
        // in: where f is below zero, so that its value matters, it changes by twice the way to y for each step
        // at most.
        let largest = squares.iter().fold(1.0, |a: f64, x| a.max(*x));
        let margin = largest * 2f64.powi(-46) + 4.0 * self.slack * frame.per_unit * largest.sqrt();
        let mut entries: Vec<(f64, Entry)> = Vec::with_capacity(items.len());
        let mut single = None;
        let mut count = 0;
        for (item, found) in items.iter().zip(&middle.found) {
            let packet = &self.tree.leaves.packets[item.packet as usize];
            let lanes = self.without_ties(cube, item);
            if lanes == 0 {
                continue;
            }
            count += lanes.count_ones();
            single = Some((item.packet, lanes.trailing_zeros()));
            let bounds = frame.enclose(&packet.bounds_of(lanes));
            let length = packet.unit() * frame.per_unit;
            let least = self.isa().run(Least { found: &item.found, lanes });
            let f = std::array::from_fn(|i| (least[i] * length) * (least[i] * length) - squares[i] - margin);
            // Nearer packets in earlier blocks.
            let order = self.isa().run(Least { found: std::slice::from_ref(found), lanes })[0] * length;
            entries.push((order, Entry { packet: item.packet, lanes, bounds, f }));
        }
        match (count, single) {
            (1, Some((packet, lane))) => Cell::Single(packet, u8::try_from(lane).expect("sixteen lanes")),
            _ if entries.is_empty() || entries.len() > LONGEST || self.tree_is_faster(cube, entries.len(), middle) => {
                Cell::Tree
            }
            _ => {
                entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
                let entries: Vec<Entry> = entries.into_iter().map(|e| e.1).collect();
                let bounds = if middle.boxes < middle.corners {
                    Bounds::Boxes
                } else {
                    Bounds::Corners { level: cube.level, y }
                };
                Cell::Blocks(Block::of_list(&entries, bounds))
            }
        }
    }

    /// Whether the tree takes less in the middle of a cell than its list, if that is long.
    fn tree_is_faster(&self, cube: &Cube, len: usize, middle: &Middle) -> bool {
        if len <= LONG {
            return false;
        }
        let tests = middle.boxes.min(middle.corners) as f64;
        let list = NANOSECONDS_A_PACKET * tests + NANOSECONDS_A_BLOCK * len as f64 / WIDTH as f64;
        let Searched { nodes, packets, .. } = self.search(cube.point(MIDDLE));
        list > NANOSECONDS_A_PACKET * packets as f64 + NANOSECONDS_A_NODE * nodes as f64
    }

    /// The lanes of an item without those that can only tie with a lower primitive: where a vertex is the nearest point
    /// of a primitive in the whole cell, certainly enough for the kernel to give exactly the distance to it, the
    /// lowest primitive with that vertex is at least as near.
    fn without_ties(&self, cube: &Cube, item: &Item) -> u16 {
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
                if self.owners[corners[v]] >= packet.ids()[lane] {
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
