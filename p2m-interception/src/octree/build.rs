//! From a cube and the tree to cells with their lists.
//!
//! A cell starts with what its parent could not rule out. While these are many, they are nodes of the tree, which are
//! opened and tested by their boxes (*coarse*). Once they are few packets, the filters of packets are computed at the
//! corners (*fine*): 19 new lattice points for the eight children of a cell, whose nearest points give the new
//! dominators.
//!
//! # What is split
//!
//! A split costs memory and saves time where queries are. The share of queries that a cell gets (its *mass*) is taken
//! to be a mixture: even in the whole domain, even in smaller boxes around the scene, and on the surface. What a list
//! costs is how many of its packets the bounds of its blocks let pass in the middle of the cell, and its blocks. A cell
//! is split if mass times cost is worth it. Whether a budget is exceeded does not depend on the order in which cells
//! are made, so a refinement that exceeds one is given up at once and another one made that asks for more worth: the
//! result is the same on any number of threads.

use crate::list::block::{DEEPEST, WIDTH};
use crate::list::corner_test::{AtPoints, Corner, Dominators, Found, Keep};
use crate::octree::cell::{BETWEEN, Cube, LATTICE, LATTICE_OF, MIDDLE, corner_on};
use crate::octree::code::Row;
use crate::octree::refinement::{
    Candidate, Cell, Item, NANOSECONDS_A_BLOCK, NANOSECONDS_A_PACKET, Nearest, Refinement, Searched,
};
use crate::options::Domain;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Isa};
use std::sync::atomic::Ordering;

/// Fine cells have at most this many packets.
const FINE: usize = 256;
/// Fine cells with fewer packets are left to one thread.
const FORK: usize = 48;
/// Searches of more packets and primitives are work of their own.
const USUAL: usize = 512;
/// Nanoseconds that a query gains by a list in the place of a search of the tree.
const NANOSECONDS_A_SEARCH: f64 = 300.0;
/// Part of its cost that a cell loses by a split.
const GAIN: f64 = 0.5;
/// What codes take of each split at most: eight rows for a node of two levels, which stands for five splits at least.
const SPLIT_BYTES: u64 = (8 * size_of::<Row>()).div_ceil(5) as u64;
/// Nanoseconds that a split has to save each query in a cell that has as many queries as there are for a packet.
const NANOSECONDS_WORTH_A_SPLIT: f64 = 100.0;

impl Refinement<'_> {
    /// A search of the tree. A usual one is part of what splits count; where most of the scene is about as near, it takes as
    /// long as the scene is large.
    pub(crate) fn search(&self, x: V3) -> Searched {
        let searched = (self.search)(x);
        let tests = searched.packets + searched.primitives;
        self.done.add_work(if tests > USUAL { tests } else { 0 });
        searched
    }

    /// The nearest point of the scene.
    pub(crate) fn nearest(&self, x: V3) -> V3 {
        self.search(x).nearest
    }

    /// The cells of the cube.
    pub(crate) fn cells(&self, low: V3, side: f64) -> Cell {
        let at = |c: usize| -> V3 { std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }) };
        let corners = std::array::from_fn(|c| Corner { x: at(c), y: self.nearest(at(c)) });
        let root = Candidate { child: self.tree.root, bounds: *self.tree.bounds() };
        self.coarse(&Cube { low, side, level: 0, corners }, vec![root], 1.0)
    }

    /// Whether a cell may have queries.
    fn is_asked(&self, cube: &Cube) -> bool {
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

    /// The share of queries in a cell, of which these boxes are near; each stands for as many packets.
    fn mass<'a>(&self, cube: &Cube, near: impl Iterator<Item = (&'a Aabb<f64>, f64)>) -> f64 {
        let own = cube.bounds();
        let mut mass = 0.0;
        for (whole, density) in self.even {
            let part = (0..3).map(|k| own.max[k].min(whole.max[k]) - own.min[k].max(whole.min[k]));
            mass += part.map(|x| x.max(0.0)).product::<f64>() * density;
        }
        for (bounds, packets) in near {
            if bounds.meets(&own) {
                let size = (bounds.max - bounds.min).max();
                // Of something larger than the cell a part lies in it.
                let part = if size > cube.side { (cube.side / size).powi(2) } else { 1.0 };
                mass += self.per_packet * packets * part;
            }
        }
        mass
    }

    /// Whether a split pays.
    fn splits(&self, cube: &Cube, mass: f64, cost: f64) -> bool {
        let worth = mass * cost * GAIN * self.resolution >= NANOSECONDS_WORTH_A_SPLIT * self.per_packet;
        worth && cube.level < DEEPEST && !self.done.is_over()
    }

    fn end(&self, cell: Cell, share: f64) -> Cell {
        self.done.add_share(share);
        if let Cell::Blocks(blocks) = &cell {
            self.done.bytes.fetch_add(size_of_val(blocks.as_slice()) as u64, Ordering::Relaxed);
        }
        cell
    }

    fn coarse(&self, cube: &Cube, mut candidates: Vec<Candidate>, share: f64) -> Cell {
        if cube.level > 0 && !self.is_asked(cube) {
            return self.end(Cell::Tree, share);
        }
        let dominators = Dominators::of(&cube.corners, self.slack);
        candidates.retain(|c| dominators.keeps_box(&cube.corners, &c.bounds));
        // Opened until they are packets or too many.
        let mut open = 1;
        while open > 0 && candidates.len() <= FINE {
            open = 0;
            let mut opened = Vec::with_capacity(2 * candidates.len());
            for candidate in &candidates {
                if candidate.child.is_packet() {
                    opened.push(*candidate);
                } else {
                    open += 1;
                    let children = self.tree.child_boxes(candidate.child);
                    let children = children.map(|(bounds, child)| Candidate { child, bounds });
                    opened.extend(children.filter(|c| dominators.keeps_box(&cube.corners, &c.bounds)));
                }
            }
            candidates = opened;
        }
        if open == 0 && candidates.len() <= FINE {
            self.done.add_work(8 * candidates.len());
            let items: Vec<Item> = candidates.iter().filter_map(|c| self.item(cube, &dominators, c)).collect();
            return self.fine(cube, items, share);
        }
        // What is not a packet has eight of them at least.
        let near = |c: &Candidate| if c.child.is_packet() { 1.0 } else { 8.0 };
        let mass = self.mass(cube, candidates.iter().map(|c| (&c.bounds, near(c))));
        if !self.splits(cube, mass, NANOSECONDS_A_SEARCH) {
            return self.end(Cell::Tree, share);
        }
        // Searches of the tree for 19 corners, each of some packets.
        self.done.add_work(19 * 8);
        let lattice: [Corner; LATTICE] = std::array::from_fn(|at| match corner_on(at) {
            Some(corner) => cube.corners[corner],
            None => Corner { x: cube.point(at), y: self.nearest(cube.point(at)) },
        });
        self.split(cube.children(&lattice).map(|child| (child, ())), true, |child, ()| {
            self.coarse(child, candidates.clone(), share * 0.125)
        })
    }

    /// The cells of the children, on all threads if asked to and they are large.
    fn split<P: Send>(
        &self,
        children: [(Cube, P); 8],
        large: bool,
        cell: impl Fn(&Cube, P) -> Cell + Sync + Send,
    ) -> Cell {
        self.done.bytes.fetch_add(SPLIT_BYTES, Ordering::Relaxed);
        #[cfg(feature = "rayon")]
        if self.parallel && large {
            use rayon::prelude::*;
            let children = Vec::from(children).into_par_iter();
            let cells: Vec<Cell> = children.map(|(cube, own)| cell(&cube, own)).collect();
            let cells: [Cell; 8] = cells.try_into().unwrap_or_else(|_| unreachable!("eight children"));
            return Cell::Split(Box::new(cells));
        }
        let _ = (large, self.parallel);
        Cell::Split(Box::new(children.map(|(cube, own)| cell(&cube, own))))
    }

    /// The packet of a candidate at the corners of a cell; `None` if no lane passes the corner test.
    fn item(&self, cube: &Cube, dominators: &Dominators, candidate: &Candidate) -> Option<Item> {
        let number = candidate.child.number();
        let packet = &self.tree.leaves.packets[number];
        let points = cube.corners.map(|c| c.x);
        let mut found = [Found::NOTHING; 8];
        let at = AtPoints { packet, points: &points, found: &mut found, nearest: &mut [None; 8] };
        self.isa().run(at);
        let lanes = self.isa().run(Keep { packet, dominators, found: &found, corners: &[0, 1, 2, 3, 4, 5, 6, 7] });
        let packet = u32::try_from(number).expect("packets have numbers");
        (lanes != 0).then_some(Item { packet, lanes, bounds: candidate.bounds, found })
    }

    pub(crate) fn isa(&self) -> Isa {
        self.tree.isa()
    }

    fn fine(&self, cube: &Cube, items: Vec<Item>, share: f64) -> Cell {
        if cube.level > 0 && !self.is_asked(cube) {
            return self.end(Cell::Tree, share);
        }
        let middle = self.middle(cube, &items);
        let mass = self.mass(cube, items.iter().map(|item| (&item.bounds, 1.0)));
        let tests = middle.boxes.min(middle.corners) as f64;
        let blocks = items.len() as f64 / WIDTH as f64;
        let cost = NANOSECONDS_A_PACKET * (tests - 1.0) + NANOSECONDS_A_BLOCK * (blocks - 1.0).max(0.0);
        if !self.splits(cube, mass, cost) {
            return self.end(self.list(cube, &items, &middle), share);
        }
        self.done.add_work(BETWEEN.len() * items.len());
        // All filters at all lattice points; those at the corners and in the middle are known.
        let points = BETWEEN.map(|at| cube.point(at));
        let mut all: Vec<[Found; LATTICE]> = Vec::with_capacity(items.len());
        let mut nearest = [Nearest::NONE; LATTICE];
        for (item, in_middle) in items.iter().zip(&middle.found) {
            let packet = &self.tree.leaves.packets[item.packet as usize];
            let mut found_new = [Found::NOTHING; BETWEEN.len()];
            let mut nearest_new = [None; BETWEEN.len()];
            self.isa().run(AtPoints { packet, points: &points, found: &mut found_new, nearest: &mut nearest_new });
            let mut found = [Found::NOTHING; LATTICE];
            for corner in 0..8 {
                found[2 * LATTICE_OF[0][corner]] = item.found[corner];
            }
            found[MIDDLE] = *in_middle;
            for ((at, own), near) in BETWEEN.into_iter().zip(found_new).zip(nearest_new) {
                found[at] = own;
                nearest[at].add(near, item.packet);
            }
            all.push(found);
        }
        let lattice: [Corner; LATTICE] = std::array::from_fn(|at| match corner_on(at) {
            Some(corner) => cube.corners[corner],
            None if at == MIDDLE => Corner { x: cube.point(at), y: middle.y },
            None => Corner { x: cube.point(at), y: self.nearest_of(&nearest[at], middle.whole, cube.point(at)) },
        });
        let mut number = 0;
        let children = cube.children(&lattice).map(|child| {
            let corners = &LATTICE_OF[number];
            number += 1;
            let dominators = Dominators::of(&child.corners, self.slack);
            let mut own = Vec::with_capacity(items.len());
            for (item, found) in items.iter().zip(&all) {
                let packet = &self.tree.leaves.packets[item.packet as usize];
                let lanes = item.lanes & self.isa().run(Keep { packet, dominators: &dominators, found, corners });
                if lanes != 0 {
                    own.push(Item { lanes, found: corners.map(|at| found[at]), ..*item });
                }
            }
            (child, own)
        });
        drop(all);
        self.split(children, items.len() >= FORK, |child, own| self.fine(child, own, share * 0.125))
    }
}
