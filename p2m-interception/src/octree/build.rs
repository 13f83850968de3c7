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

use crate::list::block::{Block, Bounds, Entry, WIDTH, reference};
use crate::list::corner_test::{AtPoints, Dominators, Found, Keep, Least};
use crate::octree::Row;
use crate::octree::cell::{BETWEEN, Corner, Cube, DEEPEST, LATTICE, LATTICE_OF, MIDDLE, corner_on};
use crate::options::Domain;
use crate::progress::{BuildStage, Progress};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Best, Isa, PrimitiveId, QueryOptions};
use std::sync::atomic::{AtomicU64, Ordering};

/// Fine cells have at most this many packets.
const FINE: usize = 256;
/// Fine cells with fewer packets are left to one thread.
const FORK: usize = 48;
/// No list is longer, in packets.
const LONGEST: usize = 256;
/// Lists longer than this are held against the tree.
const LONG: usize = 24;
/// Nanoseconds that a query takes to test a packet, of a list or of the tree of boxes (observed on one processor; of these costs only the
/// ratios matter, and the cells depend on each of them).
const NANOSECONDS_A_PACKET: f64 = 40.0;
/// Nanoseconds that a query takes to bound the packets of a block of a list.
const NANOSECONDS_A_BLOCK: f64 = 15.0;
/// Nanoseconds that a query takes to visit a node of the tree of boxes.
const NANOSECONDS_A_NODE: f64 = 30.0;
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

/// A cell that is done, or its eight children: child c lies above the middle on axis k if bit k of c is set.
pub(crate) enum Cell {
    /// The tree answers.
    Tree,
    /// One primitive: packet and lane.
    Single(u32, u8),
    /// The list.
    Blocks(Vec<Block>),
    Split(Box<[Cell; 8]>),
}

/// What a search of the tree finds, and visits.
pub(crate) struct Searched {
    /// The nearest point of the scene, of any primitive.
    pub(crate) nearest: V3,
    pub(crate) nodes: usize,
    pub(crate) packets: usize,
    pub(crate) primitives: usize,
}

/// What the refinement of all cells shares.
pub(crate) struct Refinement<'a> {
    pub(crate) tree: &'a PacketTree,
    /// For each vertex of the tree the lowest primitive that has it.
    pub(crate) owners: &'a [PrimitiveId],
    /// A search of the tree.
    pub(crate) search: &'a (dyn Fn(V3) -> Searched + Sync),
    pub(crate) domain: Domain,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Boxes with queries evenly in them, and how many for each unit of volume.
    pub(crate) even: &'a [(Aabb<f64>, f64)],
    /// Queries for each packet.
    pub(crate) per_packet: f64,
    pub(crate) resolution: f64,
    pub(crate) parallel: bool,
    pub(crate) done: Done<'a>,
}

/// What has been done so far, and what may be.
pub(crate) struct Done<'a> {
    pub(crate) bytes: AtomicU64,
    pub(crate) work: AtomicU64,
    /// No more than this.
    pub(crate) most: [u64; 2],
    /// Parts of 2^-40 of the whole, and the last percent that was reported.
    pub(crate) share: AtomicU64,
    pub(crate) percent: AtomicU64,
    pub(crate) progress: &'a (dyn Fn(Progress) + Sync),
}

impl Done<'_> {
    /// Whether a budget is exceeded: what is made is of no use then.
    pub(crate) fn is_over(&self) -> bool {
        self.bytes.load(Ordering::Relaxed) > self.most[0] || self.work.load(Ordering::Relaxed) > self.most[1]
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share is from 0 to 1")]
    fn add_share(&self, share: f64) {
        const ALL: f64 = (1u64 << 40) as f64;
        let part = (share * ALL) as u64;
        let all = self.share.fetch_add(part, Ordering::Relaxed) + part;
        let percent = (all as f64 / ALL * 100.0) as u64;
        if self.percent.fetch_max(percent, Ordering::Relaxed) < percent {
            let part = (percent as f64 / 100.0).min(1.0);
            (self.progress)(Progress { stage: BuildStage::Octree, part });
        }
    }

    fn add_work(&self, tests: usize) {
        self.work.fetch_add(tests as u64, Ordering::Relaxed);
    }
}

/// What a coarse cell cannot rule out.
#[derive(Clone, Copy)]
struct Candidate {
    child: NodeRef,
    bounds: Aabb<f64>,
}

/// A packet that a fine cell cannot rule out: its lanes, and what its filter finds at the corners.
#[derive(Clone, Copy)]
struct Item {
    packet: u32,
    lanes: u16,
    bounds: Aabb<f64>,
    found: [Found; 8],
}

/// The primitive that seems nearest to a point.
#[derive(Clone, Copy)]
struct Nearest {
    /// An upper bound.
    distance: f64,
    packet: u32,
    lane: usize,
}

impl Nearest {
    const NONE: Self = Self { distance: f64::INFINITY, packet: 0, lane: 0 };

    fn add(&mut self, near: Option<(f64, usize)>, packet: u32) {
        if let Some((distance, lane)) = near
            && distance < self.distance
        {
            *self = Self { distance, packet, lane };
        }
    }
}

/// The middle of a cell.
struct Middle {
    /// What the filters of its items find there.
    found: Vec<Found>,
    /// Whether filters tell how near all of the items are.
    whole: bool,
    /// The nearest point.
    y: V3,
    /// How many items bounds by boxes and by corners let pass.
    boxes: usize,
    corners: usize,
}

impl Refinement<'_> {
    /// A search of the tree. A usual one is part of what splits count; where most of the scene is about as near, it takes as
    /// long as the scene is large.
    fn search(&self, x: V3) -> Searched {
        let searched = (self.search)(x);
        let tests = searched.packets + searched.primitives;
        self.done.add_work(if tests > USUAL { tests } else { 0 });
        searched
    }

    /// The nearest point of the scene.
    fn nearest(&self, x: V3) -> V3 {
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

    fn isa(&self) -> Isa {
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

    /// The nearest point to `x`: of the primitive that seems nearest, or of the scene where filters do not tell of the
    /// `whole`.
    fn nearest_of(&self, near: &Nearest, whole: bool, x: V3) -> V3 {
        if !whole || near.distance == f64::INFINITY {
            return self.nearest(x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        let packet = &self.tree.leaves.packets[near.packet as usize];
        packet.offer(near.lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }

    /// What the filters find in the middle of a cell.
    fn middle(&self, cube: &Cube, items: &[Item]) -> Middle {
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
    fn list(&self, cube: &Cube, items: &[Item], middle: &Middle) -> Cell {
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
