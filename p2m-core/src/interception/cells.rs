//! Lists of Voronoi cells.
//!
//! The corner test says which primitives can beat the site v somewhere in its cell; with its function's values at the
//! corners more can be said. Along an edge of the cell, where a primitive t may beat v at one end and not at the other,
//! the function d(q, t)^2 - (|q - v| + s)^2 is concave and lies above its chord, so t cannot beat v beyond the zero of
//! the chord. The corners and these zeros span all places where t may be the answer (the *region* of t, docs/p2m.md).
//!
//! A feature of t matters only if it can be nearest in the region. If all that matter belong to a primitive of a lower
//! id as well, t is never the answer: the other one is as near, by the same bits, and the lower id wins.

use super::block::{Block, Bounds, Entry};
use super::corner::{AtPoints, Found, Least};
use super::fan::{Fans, Outside};
use super::features::{Features, Incidences, NONE, Shared};
use super::hull::Hull;
use super::options::P2mReport;
use super::sphere;
use super::voronoi::TREE;
use crate::delaunay::{BOUNDING, Delaunay};
use crate::hierarchy::PacketTree;
use crate::hierarchy::wide::ball::Selection;
use crate::kernel::number::cross;
use crate::kernel::vector::{V3, dot, norm_squared, sub};
use crate::packet::{LANES, Packet};
use crate::simd::{InstructionSet, Operation};
use crate::{Best, QueryOptions};

/// What is needed to make lists.
pub(super) struct Cells<'a> {
    pub(super) tree: &'a PacketTree,
    pub(super) delaunay: &'a Delaunay,
    /// By how much a dominator has to be nearer.
    pub(super) slack: f64,
    /// Packets of a list.
    pub(super) most: usize,
    /// Told how many of all steps are done: one for each corner, and four for each cell.
    pub(super) progress: &'a dyn Fn(usize),
}

/// A corner of Voronoi cells, in coordinates of the scene, and what meets its ball.
#[derive(Clone, Copy)]
struct Corner {
    place: V3,
    /// How far it may be from where it is.
    error: f64,
    /// Its selections begin here.
    first: u32,
    /// Whether it is unknown, or meets too much.
    full: bool,
}

/// The corners of all cells: one for each tetrahedron, and one more for the end.
pub(super) struct Corners {
    all: Vec<Corner>,
    packets: Vec<u32>,
}

impl Cells<'_> {
    /// A ball for each tetrahedron.
    pub(super) fn corners(&self) -> Corners {
        let sites = self.delaunay.sites();
        let unit = self.delaunay.unit();
        let mut corners =
            Corners { all: Vec::with_capacity(self.delaunay.tetrahedra().len() + 1), packets: Vec::new() };
        let mut met: Vec<Selection> = Vec::new();
        for (number, tetrahedron) in self.delaunay.tetrahedra().iter().enumerate() {
            (self.progress)(number);
            let first = corners.packets.len();
            let mut corner = Corner {
                place: [0.0; 3],
                error: 0.0,
                first: u32::try_from(first).expect("fewer than 2^32"),
                full: true,
            };
            let own = tetrahedron.iter().map(|v| *v as usize).find(|v| *v >= BOUNDING);
            if let (Some(own), Some(centre)) = (own, sphere::centre(&tetrahedron.map(|v| sites[v as usize]))) {
                corner.place = centre.place.map(|x| x * unit);
                corner.error = centre.error * unit;
                let radius = norm_squared(sub(centre.place, sites[own])).sqrt() * unit * (1.0 + 8.0 * f64::EPSILON);
                met.clear();
                corner.full =
                    !self.tree.ball(corner.place, radius + 2.0 * corner.error + self.slack, self.most, &mut met);
                if !corner.full {
                    corners.packets.extend(met.iter().map(|s| s.packet));
                }
            }
            corners.all.push(corner);
        }
        let first = u32::try_from(corners.packets.len()).expect("fewer than 2^32");
        corners.all.push(Corner { place: [0.0; 3], error: 0.0, first, full: true });
        corners
    }

    /// The sites with their neighbours and the blocks of their lists: the first one of each at its own number.
    pub(super) fn lists(&self, corners: &Corners, report: &mut P2mReport) -> (Fans, Vec<Block>) {
        let sites = self.delaunay.sites();
        let tetrahedra = self.delaunay.tetrahedra();
        let around = Incidences::new(
            sites.len(),
            (0..).zip(tetrahedra).flat_map(|(number, tetrahedron)| tetrahedron.iter().map(move |v| (*v, number))),
        );
        let features = Features::of(self.tree, self.delaunay);
        let slack = self.slack / self.delaunay.unit();
        let mut fans = Fans::new(sites, BOUNDING, slack, |site, all, edges| {
            let neighbours = around.of(site).iter().flat_map(|t| tetrahedra[*t as usize]);
            all.extend(neighbours.filter(|v| *v as usize >= BOUNDING && *v as usize != site));
            edges.extend_from_slice(features.edges.of(site));
        });
        let nothing =
            Block::of_list(&[Entry { packet: 0, lanes: 0, bounds: [[0.0; 3]; 2], f: [0.0; 8] }], Bounds::Boxes);
        let mut blocks = vec![nothing[0]; sites.len()];
        let mut cell = Cell::default();
        for site in 0..sites.len() {
            (self.progress)(tetrahedra.len() + 4 * site);
            let to = &mut fans.sites[site];
            (to.owner, to.list) = (features.owners[site], TREE);
            let own = around.of(site);
            if site < BOUNDING || own.iter().any(|t| corners.all[*t as usize].full) {
                report.trees += usize::from(site >= BOUNDING);
                continue;
            }
            cell.gather(self, corners, site, own);
            let entries =
                if cell.packets.len() <= self.most { cell.entries(self, &features, report) } else { Vec::new() };
            if entries.is_empty() {
                report.trees += 1;
                continue;
            }
            if let Some(outside) = cell.outside(self, &features, &entries) {
                to.outside = outside;
            }
            report.lists += 1;
            report.entries += entries.len();
            let list = Block::of_list(&entries, Bounds::Boxes);
            to.list = u32::try_from(blocks.len()).expect("numbers of 32 bits");
            blocks[site] = list[0];
            blocks.extend_from_slice(&list[1..]);
        }
        (fans, blocks)
    }
}

/// From so many units of a packet on, filters are not precise enough.
const FAR: f64 = (1u64 << 19) as f64;

/// A cell at work.
#[derive(Default)]
struct Cell {
    /// The vertex.
    y: V3,
    site: usize,
    whole: Hull,
    /// The part of it that is far out, as it gets less.
    part: [Hull; 2],
    /// The packets that meet some ball.
    packets: Vec<u32>,
    /// Numbers of the tetrahedra, for the search of pairs.
    own: Vec<u32>,
    values: Known,
}

/// What is known about a packet and a hull.
#[derive(Default)]
struct Known {
    /// Of each corner the values of the function for the lanes of a packet, rounded down, in squares of its unit.
    values: Vec<[f32; LANES]>,
    /// The lanes that are not above zero at some corner.
    near: u16,
    /// The region of a lane.
    region: Vec<V3>,
}

impl Cell {
    fn gather(&mut self, cells: &Cells<'_>, corners: &Corners, site: usize, own: &[u32]) {
        let unit = cells.delaunay.unit();
        self.site = site;
        self.y = cells.delaunay.sites()[site].map(|x| x * unit);
        self.whole.clear();
        self.packets.clear();
        self.own.clear();
        self.own.extend_from_slice(own);
        self.own.sort_unstable();
        for (i, &number) in (0u32..).zip(&self.own) {
            let t = number as usize;
            let corner = &corners.all[t];
            let tetrahedron = &cells.delaunay.tetrahedra()[t];
            let mut faces = [0; 3];
            let others = tetrahedron.iter().filter(|v| **v as usize != site);
            faces.iter_mut().zip(others).for_each(|(to, v)| *to = *v);
            self.whole.push(corner.place, corner.error, faces, &self.y, cells.slack);
            self.packets.extend_from_slice(&corners.packets[corner.first as usize..corners.all[t + 1].first as usize]);
            for (v, other) in tetrahedron.iter().zip(&cells.delaunay.neighbours()[t]) {
                // Each pair once.
                let joined = *v as usize != site && number < *other;
                if let Some(Ok(j)) = joined.then(|| self.own.binary_search(other)) {
                    self.whole.edges.push([i, u32::try_from(j).expect("few corners")]);
                }
            }
        }
        self.packets.sort_unstable();
        self.packets.dedup();
    }

    fn entries(&mut self, cells: &Cells<'_>, features: &Features, report: &mut P2mReport) -> Vec<Entry> {
        let tree = cells.tree;
        let mut entries: Vec<(f64, Entry)> = Vec::with_capacity(self.packets.len());
        let packets = std::mem::take(&mut self.packets);
        for &number in &packets {
            let packet = &tree.leaves.packets[number as usize];
            self.values.compute(&self.whole, packet, tree);
            let near = self.values.near;
            let mut lanes = near;
            for lane in (0..LANES).filter(|lane| near >> lane & 1 == 1) {
                if !self.keeps(cells, packet, lane, features.shared[number as usize][lane]) {
                    lanes &= !(1 << lane);
                }
            }
            if lanes != 0 {
                report.primitives += lanes.count_ones() as usize;
                let order = FromPlace::new(tree, packet, &self.y).least(lanes) * packet.unit();
                let bounds = tree.frame.enclose(&packet.bounds_of(lanes));
                entries.push((order, Entry { packet: number, lanes, bounds, f: [0.0; 8] }));
            }
        }
        self.packets = packets;
        entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
        entries.into_iter().map(|e| e.1).collect()
    }

    /// Whether the primitive in a lane may be the answer.
    fn keeps(&mut self, cells: &Cells<'_>, packet: &Packet, lane: usize, shared: Shared) -> bool {
        let (places, count) = packet.vertices_of(lane);
        // One of your own.
        if count == 0 {
            return true;
        }
        let mut own = [[0.0; 3]; 3];
        for (to, place) in own.iter_mut().zip(&places[..count]) {
            *to = cells.tree.leaves.vertices[*place];
        }
        let vertices = &own[..count];
        let size = vertices.iter().flat_map(|v| sub(*v, self.y)).fold(0.0f64, |a, x| a.max(x.abs()));
        // Rounding of the kernel near the borders of features, and of what is computed here.
        let margin = MARGIN * (self.whole.reach + size);
        let (height, sine) = slimness(vertices);
        if self.whole.error >= margin * 0.25 || height.is_nan() || height < margin {
            return true;
        }
        self.values.find_region(&self.whole, lane);
        matters(vertices, &self.values.region, margin, margin / sine, shared)
    }

    /// The half-space far from the site in which only primitives with it can be the answer, if it is the nearest point of
    /// all of these and other sites are farther away by some part.
    #[allow(clippy::cast_possible_truncation, reason = "rounded, and margins have room")]
    fn outside(&mut self, cells: &Cells<'_>, features: &Features, entries: &[Entry]) -> Option<Outside> {
        let tree = cells.tree;
        let sites = cells.delaunay.sites();
        let unit = cells.delaunay.unit();
        let others = features.edges.of(self.site).iter();
        let ways: Vec<V3> = others
            .map(|w| sub(sites[*w as usize], sites[self.site]))
            .map(|way| way.map(|x| x / norm_squared(way).sqrt()))
            .collect();
        let sum = ways.iter().fold([0.0; 3], |sum, way| sub(sum, *way));
        let length = norm_squared(sum).sqrt();
        if features.owners[self.site] == NONE || ways.len() > MOST_WAYS || length < 1e-3 {
            return None;
        }
        let normal = sum.map(|x| (x / length) as f32);
        let along = normal.map(f64::from);
        let bounds = tree.bounds();
        let from = (bounds.max - bounds.min).max() * OUTSIDE;
        let height = |x: &V3| dot(sub(*x, self.y), along) - from;
        if self.whole.corners.iter().all(|x| height(x) < 0.0) {
            return None;
        }
        let (y, slack) = (self.y, cells.slack);
        let [part, next] = &mut self.part;
        part.clip(&self.whole, height, u32::MAX, &y, slack);
        // Planes are moved outwards by more than corners may be off, so that what is left has corners where it is not.
        let margin = 4.0 * self.whole.error + 1e-12 * self.whole.reach;
        for (way, face) in ways.iter().zip((0..u32::MAX).rev()) {
            next.clip(part, |x| margin - dot(sub(*x, y), *way), face, &y, slack);
            std::mem::swap(part, next);
        }
        // The largest part of the way to another site by which that one has to be left behind.
        let mut most = 0.0f64;
        for entry in entries {
            let packet = &tree.leaves.packets[entry.packet as usize];
            self.values.compute(part, packet, tree);
            let lanes = self.values.near & entry.lanes;
            let from_site = FromPlace::new(tree, packet, &y);
            for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
                let (places, count) = packet.vertices_of(lane);
                if places[..count].iter().any(|place| cells.delaunay.site_of(*place) == self.site) {
                    continue;
                }
                let distance = from_site.least(1 << lane);
                // So the slack does not matter to the function at the site.
                if distance * packet.unit() < 64.0 * slack {
                    return None;
                }
                let lack = self.values.values.iter().fold(0.0f64, |a, v| a.max(-f64::from(v[lane])));
                let part = lack * 1.001 / (distance * distance);
                if part.is_nan() || part > PART {
                    return None;
                }
                most = most.max(part);
            }
        }
        let scaled = (from + margin) / unit * (1.0 + 1e-6);
        Some(Outside { normal, from: scaled as f32, part: (most * (1.0 + 1e-6)) as f32 })
    }
}

/// How far at least the nearest of some lanes of a packet is from a place, in the unit of the packet.
struct FromPlace<'a> {
    tree: &'a PacketTree,
    found: [Found; 1],
}

impl<'a> FromPlace<'a> {
    fn new(tree: &'a PacketTree, packet: &Packet, place: &V3) -> Self {
        let mut found = [Found::NOTHING];
        tree.isa().run(AtPoints { packet, points: &[*place], found: &mut found, nearest: &mut [None] });
        Self { tree, found }
    }

    fn least(&self, lanes: u16) -> f64 {
        self.tree.isa().run(Least { found: &self.found, lanes })[0]
    }
}

impl Known {
    /// The values of a packet at the corners of a hull.
    fn compute(&mut self, hull: &Hull, packet: &Packet, tree: &PacketTree) {
        self.values.clear();
        self.near = tree.isa().run(Values { hull, packet, values: &mut self.values });
        self.refine(hull, packet, tree);
    }

    /// Evaluates what the filter is too coarse for: corners from which the packet is small.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn refine(&mut self, hull: &Hull, packet: &Packet, tree: &PacketTree) {
        let per_unit = packet.per_unit();
        if !packet.has_vertices() || hull.reach * per_unit < FAR {
            return;
        }
        for (i, values) in self.values.iter_mut().enumerate() {
            let reach = hull.reaches[i];
            if reach * per_unit < FAR {
                continue;
            }
            for lane in (0..LANES).filter(|lane| self.near >> lane & 1 == 1) {
                if values[lane] > 0.0 {
                    continue;
                }
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &tree.leaves.vertices, hull.corners[i], f64::INFINITY, &mut best);
                let Some(closest) = best.finish() else { continue };
                // Less for the rounding of the kernel.
                let least = closest.distance * (1.0 - 1e-14) - reach * 1e-14 - hull.errors[i];
                let value = (least - reach) * (least + reach) * per_unit * per_unit;
                values[lane] = values[lane].max((value as f32).next_down());
            }
        }
        let lanes = self.near;
        self.near = 0;
        for values in &self.values {
            for (lane, value) in values.iter().enumerate() {
                self.near |= u16::from(*value <= 0.0) << lane;
            }
        }
        self.near &= lanes;
    }

    /// The points that span the region of a lane.
    fn find_region(&mut self, hull: &Hull, lane: usize) {
        self.region.clear();
        for (corner, values) in hull.corners.iter().zip(&self.values) {
            if values[lane] <= 0.0 {
                self.region.push(*corner);
            }
        }
        for [i, j] in hull.edges.iter().map(|e| e.map(|i| i as usize)) {
            let (a, b) = (self.values[i][lane], self.values[j][lane]);
            if (a <= 0.0) == (b <= 0.0) {
                continue;
            }
            let (a, b) = (f64::from(a), f64::from(b));
            // The part of the way from i, a little farther than the zero of the chord.
            let t = a / (a - b) + if a <= 0.0 { 1e-6 } else { -1e-6 };
            let (from, to) = (hull.corners[i], hull.corners[j]);
            self.region.push(std::array::from_fn(|k| from[k] + t * (to[k] - from[k])));
        }
    }
}

/// A vertex of more edges, like the tip of a cone, is not worth it.
const MOST_WAYS: usize = 64;
/// The largest part that is worth a look.
pub(super) const PART: f64 = 0.85;
/// A half-space begins so many sizes of the scene from the site.
const OUTSIDE: f64 = 0.15;

/// Part of the largest length by which a feature has to be missed.
const MARGIN: f64 = 1.0 / (1u64 << 22) as f64;

/// The least height of a primitive, or its length, and what part that is of the longest edge; no point is slim.
fn slimness(vertices: &[V3]) -> (f64, f64) {
    let length = |a: &V3, b: &V3| norm_squared(sub(*a, *b)).sqrt();
    match vertices {
        [a, b, c] => {
            let longest = length(a, b).max(length(b, c)).max(length(c, a));
            let (e, f) = (sub(*b, *a), sub(*c, *a));
            let height = norm_squared(cross(e, f)).sqrt() / longest;
            (height, height / longest)
        }
        [a, b] => (length(a, b), 1.0),
        _ => (f64::INFINITY, 1.0),
    }
}

/// Whether a feature matters that is not shared. It has to be missed by `margin` along an edge, by `across` across one.
fn matters(vertices: &[V3], region: &[V3], margin: f64, across: f64, shared: Shared) -> bool {
    let n = vertices.len();
    let all = |test: &dyn Fn(&V3) -> bool| region.iter().all(test);
    // The direction of a length, zero for none; products with it are lengths.
    let unit = |d: V3| -> V3 {
        let length = norm_squared(d).sqrt();
        if length > 0.0 { d.map(|x| x / length) } else { [0.0; 3] }
    };
    let mut inside = [[0.0; 3]; 3];
    if n == 3 {
        let [a, b, c] = [vertices[0], vertices[1], vertices[2]];
        let (e, f) = (sub(b, a), sub(c, a));
        let normal = unit(cross(e, f));
        let mut outside = false;
        for i in 0..3 {
            let (p, q) = (vertices[i], vertices[(i + 1) % 3]);
            let d = unit(sub(q, p));
            // Into the triangle.
            inside[i] = cross(normal, d);
            outside |= all(&|h| dot(sub(*h, p), inside[i]) < -across);
        }
        if !outside {
            return true;
        }
    }
    let edge_count = if n == 3 { 3 } else { n - 1 };
    for i in 0..edge_count {
        if shared >> (3 + i) & 1 == 1 {
            continue;
        }
        let (p, q) = (vertices[i], vertices[(i + 1) % n]);
        let d = unit(sub(q, p));
        let missed = all(&|h| dot(sub(*h, p), d) < -margin)
            || all(&|h| dot(sub(*h, q), d) > margin)
            || (n == 3 && all(&|h| dot(sub(*h, p), inside[i]) > across));
        if !missed {
            return true;
        }
    }
    for i in 0..n {
        if shared >> i & 1 == 1 {
            continue;
        }
        let missed = (0..n).filter(|j| *j != i).any(|j| {
            let d = unit(sub(vertices[j], vertices[i]));
            all(&|h| dot(sub(*h, vertices[i]), d) > margin)
        });
        if !missed {
            return true;
        }
    }
    false
}

/// The function at all corners of a hull for the lanes of a packet, as an operation: which lanes are not above zero at
/// all of them.
struct Values<'a> {
    hull: &'a Hull,
    packet: &'a Packet,
    values: &'a mut Vec<[f32; LANES]>,
}

impl Operation for Values<'_> {
    type Output = u16;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded down; sixteen lanes")]
    fn run<I: InstructionSet>(self) -> u16 {
        let Self { hull, packet, values } = self;
        let mut near = 0;
        let per_unit = packet.per_unit();
        for (i, corner) in hull.corners.iter().enumerate() {
            // Nothing is known where f32 cannot place the corner.
            let mut own = [f32::NEG_INFINITY; LANES];
            if let Some(local) = packet.local(corner) {
                let mut squares = [0.0; LANES];
                packet.squares::<I>(&local, f32::INFINITY, &mut squares);
                let less = local.excess + ((hull.errors[i] * per_unit) as f32) * 1.001;
                let reach = (hull.reaches[i] * per_unit) as f32 * (1.0 + 4.0 * f32::EPSILON);
                for (value, square) in own.iter_mut().zip(squares) {
                    let least = (square.sqrt() * (1.0 - 4.0 * f32::EPSILON) - less).max(0.0);
                    // Of two squares, whose difference may be much less.
                    *value = (least - reach) * (least + reach);
                }
            }
            for (lane, value) in own.iter().enumerate() {
                near |= u32::from(*value <= 0.0) << lane;
            }
            values.push(own);
        }
        (near & packet.lanes()) as u16
    }
}
