//! Lists of Voronoi cells.
//!
//! The corner test says which primitives can beat the site v somewhere in its cell; with its function's values at the
//! corners more can be said. Along an edge of the cell, where a primitive t may beat v at one end and not at the other,
//! the function d(q, t)^2 - (|q - v| + s)^2 is concave and lies above its chord, so t cannot beat v beyond the zero of
//! the chord. The corners and these zeros span all places where t may be the answer (the *region* of t, docs/proofs/p2m.md).
//!
//! A feature of t matters only if it can be nearest in the region. If all that matter belong to a primitive of a lower
//! id as well, t is never the answer: the other one is as near, by the same bits, and the lower id wins.

use crate::delaunay::BOUNDING;
use crate::list::block::{Block, Bounds, Entry};
use crate::list::corner_test::{AtPoints, Found, Least};
use crate::options::P2mReport;
use crate::parallel_chunks::in_shares;
use crate::progress::{BuildStage, Teller};
use crate::voronoi::adjacency::{Features, Incidences, NONE};
use crate::voronoi::cell_polytope::Hull;
use crate::voronoi::feature_relevance::{Around, Missed, Outlines, Scene, Seen};
use crate::voronoi::list_filter::{BuildListFilter, Filters, ListFilter, Region};
use crate::voronoi::neighbours::{Fans, Outside};
use crate::voronoi::sites::{Corners, Limits, Sites};
use crate::voronoi::{AUXILIARY, TREE};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::{LANES, Packet};
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, dot, norm_squared, sub};
use p2m_core::{Best, QueryOptions};
use std::ops::Range;
use std::sync::Arc;

/// What is needed to make lists.
pub(crate) struct Cells<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) sites: &'a Sites,
    pub(crate) limits: Limits<'a>,
    /// Makes a filter for each list of more primitives than the number, if there are filters.
    pub(crate) filter: Option<(usize, BuildListFilter)>,
}

/// The sites with their neighbours, the blocks of their lists, the first one of each at its own number, and the filters
/// of long ones.
pub(crate) struct Lists {
    pub(crate) fans: Fans,
    pub(crate) blocks: Vec<Block>,
    pub(crate) filters: Filters,
}

impl Cells<'_> {
    /// The lists of all sites; `None` where these take too much. `teller` is told how many are done.
    pub(crate) fn lists(&self, report: &mut P2mReport, teller: &Teller<'_>) -> Option<Lists> {
        teller.begin(BuildStage::Lists);
        let sites = self.sites.delaunay.sites();
        let tetrahedra = self.sites.delaunay.tetrahedra();
        let around = Incidences::new(
            sites.len(),
            (0..).zip(tetrahedra).flat_map(|(number, tetrahedron)| tetrahedron.iter().map(move |v| (*v, number))),
        );
        let features = Features::of(self.tree, &self.sites.delaunay);
        let slack = self.limits.slack / self.sites.delaunay.unit();
        let mut fans = Fans::new(sites, BOUNDING, slack, |site, all, edges| {
            let neighbours = around.of(site).iter().flat_map(|t| tetrahedra[*t as usize]);
            all.extend(neighbours.filter(|v| *v as usize >= BOUNDING && *v as usize != site));
            edges.extend_from_slice(features.edges.of(site));
        });
        let nothing =
            Block::of_list(&[Entry { packet: 0, lanes: 0, bounds: [[0.0; 3]; 2], f: [0.0; 8] }], Bounds::Boxes);
        let mut blocks = vec![nothing[0]; sites.len()];
        let mut filters = if self.filter.is_some() { Filters::new(sites.len()) } else { Filters::default() };
        let mut records = fans.sites.edit(std::mem::take);
        report.added = self.sites.added;
        let outlines = Outlines::of(self.tree);
        let work = |share| self.share(share, &around, &features, &outlines);
        let allowance = self.limits.allowance;
        in_shares(sites.len(), self.limits.parallel, work, |share: Share| {
            if !allowance.holds::<Block>(blocks.len() + share.blocks.len()) {
                return;
            }
            for made in share.cells {
                let to = &mut records[made.site];
                (to.owner, to.list) = (features.owners[made.site], TREE);
                match made.list {
                    List::Tree => report.trees += usize::from(made.site >= BOUNDING),
                    List::Auxiliary(anchor) => {
                        (to.owner, to.list) = (anchor, AUXILIARY);
                        report.auxiliary += 1;
                    }
                    List::Blocks(own) => {
                        to.list = u32::try_from(blocks.len()).expect("numbers of 32 bits");
                        to.outside = made.outside.unwrap_or(to.outside);
                        blocks[made.site] = share.blocks[own.start];
                        blocks.extend_from_slice(&share.blocks[own.start + 1..own.end]);
                        if let Some(filter) = made.filter {
                            filters.add(made.site, filter);
                        }
                        report.lists += 1;
                    }
                }
                teller.reach([30.0, 100.0], made.site, sites.len());
            }
            report.entries += share.entries;
            report.candidates += share.candidates;
            report.most_candidates = report.most_candidates.max(share.most_candidates);
            report.primitives += share.primitives;
        });
        fans.sites = records.into();
        (!allowance.is_over()).then_some(Lists { fans, blocks, filters })
    }

    /// The lists of some sites.
    fn share(&self, sites: Range<usize>, around: &Incidences, features: &Features, outlines: &Outlines) -> Share {
        let corners = &self.sites.corners;
        let mut share = Share {
            cells: Vec::new(),
            blocks: Vec::new(),
            entries: 0,
            primitives: 0,
            candidates: 0,
            most_candidates: 0,
        };
        let mut cell = Cell::default();
        for site in sites {
            if self.limits.allowance.is_over() {
                break;
            }
            let own = around.of(site);
            let mut made = Made { site, list: List::Tree, outside: None, filter: None };
            if let Some(anchor) = self.sites.anchor_of(site) {
                made.list = List::Auxiliary(u32::try_from(anchor).expect("numbers of 32 bits"));
            } else if site >= BOUNDING && !own.iter().any(|t| corners.all[*t as usize].full) {
                cell.gather(self, corners, site, own);
                share.candidates += cell.packets.len();
                share.most_candidates = share.most_candidates.max(cell.packets.len());
                let few = cell.packets.len() <= self.limits.most;
                let entries = if few { cell.entries(self, features, outlines) } else { Vec::new() };
                if !entries.is_empty() {
                    let primitives: usize = entries.iter().map(|entry| entry.lanes.count_ones() as usize).sum();
                    share.primitives += primitives;
                    made.filter = self
                        .filter
                        .filter(|(above, _)| primitives > *above)
                        .map(|(_, build)| build(cell.regions(self, &entries)));
                    made.outside = cell.outside(self, features, &entries);
                    let first = share.blocks.len();
                    share.blocks.extend(Block::of_list(&entries, Bounds::Boxes));
                    share.entries += entries.len();
                    made.list = List::Blocks(first..share.blocks.len());
                }
            }
            self.limits.allowance.spend(std::mem::take(&mut cell.values.tests));
            share.cells.push(made);
        }
        share
    }
}

/// The lists of some sites.
struct Share {
    cells: Vec<Made>,
    blocks: Vec<Block>,
    entries: usize,
    primitives: usize,
    candidates: usize,
    most_candidates: usize,
}

/// What is known of a cell.
struct Made {
    site: usize,
    list: List,
    outside: Option<Outside>,
    filter: Option<Arc<dyn ListFilter>>,
}

enum List {
    /// The tree answers,
    Tree,
    /// from the bound of an anchor,
    Auxiliary(u32),
    /// or blocks of the share do.
    Blocks(Range<usize>),
}

/// From so many units of a packet on, filters are not precise enough.
const FAR: f64 = (1u64 << 19) as f64;

/// A cell at work.
#[derive(Default)]
struct Cell {
    /// The site.
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
    missed: Missed,
}

/// What is known about a packet and a hull.
#[derive(Default)]
struct Known {
    /// Of each corner the values of the function for the lanes of a packet, rounded down, in squares of its unit.
    values: Vec<[f32; LANES]>,
    /// The lanes that are not above zero at some corner.
    near: u16,
    /// Of each corner the lanes that are not above zero there; of each edge those that are at one end alone.
    below: Vec<u16>,
    crossed: Vec<u16>,
    /// The region of a lane.
    region: Vec<V3>,
    /// How many times packets were tested at a corner, and primitives evaluated.
    tests: usize,
}

impl Cell {
    fn gather(&mut self, cells: &Cells<'_>, corners: &Corners, site: usize, own: &[u32]) {
        let unit = cells.sites.delaunay.unit();
        self.site = site;
        self.y = cells.sites.delaunay.sites()[site].map(|x| x * unit);
        self.whole.clear();
        self.packets.clear();
        self.own.clear();
        self.own.extend_from_slice(own);
        self.own.sort_unstable();
        for (i, &number) in (0u32..).zip(&self.own) {
            let t = number as usize;
            let corner = &corners.all[t];
            let tetrahedron = &cells.sites.delaunay.tetrahedra()[t];
            let mut faces = [0; 3];
            let others = tetrahedron.iter().filter(|v| **v as usize != site);
            faces.iter_mut().zip(others).for_each(|(to, v)| *to = *v);
            self.whole.push(corner.place, corner.error, faces, &self.y, cells.limits.slack);
            self.packets.extend_from_slice(corners.packets(t));
            for (v, other) in tetrahedron.iter().zip(&cells.sites.delaunay.neighbours()[t]) {
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

    fn entries(&mut self, cells: &Cells<'_>, features: &Features, outlines: &Outlines) -> Vec<Entry> {
        let tree = cells.tree;
        let scene = Scene { tree, delaunay: &cells.sites.delaunay, features, outlines, slack: cells.limits.slack };
        let Self { site, y: place, whole: Hull { reach, error, .. }, .. } = *self;
        let around = Around { site, place, reach, error };
        let mut entries: Vec<(f64, Entry)> = Vec::with_capacity(self.packets.len());
        let packets = std::mem::take(&mut self.packets);
        for &number in &packets {
            let packet = &tree.leaves.packets[number as usize];
            self.values.compute(&self.whole, packet, tree);
            let near = self.values.near;
            let mut lanes = near;
            for lane in (0..LANES).filter(|lane| near >> lane & 1 == 1) {
                if let Some(seen) = Seen::new(scene, around, number as usize, lane) {
                    self.values.find_region(&self.whole, lane);
                    lanes &= !(u16::from(!seen.matters(&self.values.region, &mut self.missed)) << lane);
                }
            }
            if lanes != 0 {
                let order = FromPlace::new(tree, packet, &self.y).least(lanes) * packet.unit();
                let bounds = tree.frame.enclose(&packet.bounds_of(lanes));
                entries.push((order, Entry { packet: number, lanes, bounds, f: [0.0; 8] }));
            }
        }
        self.packets = packets;
        entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
        entries.into_iter().map(|e| e.1).collect()
    }

    /// Boxes around the regions of all primitives of a list.
    fn regions(&mut self, cells: &Cells<'_>, entries: &[Entry]) -> Vec<Region> {
        let tree = cells.tree;
        let mut regions = Vec::new();
        for entry in entries {
            self.values.compute(&self.whole, &tree.leaves.packets[entry.packet as usize], tree);
            for lane in (0..LANES).filter(|lane| entry.lanes >> lane & 1 == 1) {
                self.values.find_region(&self.whole, lane);
                regions.push(Region::around(&self.values.region, self.margin(), entry.packet, lane));
            }
        }
        regions
    }

    /// By more than corners may be off.
    fn margin(&self) -> f64 {
        4.0 * self.whole.error + 1e-12 * self.whole.reach
    }

    /// The half-space far from the site in which only primitives with it can be the answer, if it is the nearest point
    /// of all of these and other sites are farther away by some part.
    #[allow(clippy::cast_possible_truncation, reason = "rounded, and margins have room")]
    fn outside(&mut self, cells: &Cells<'_>, features: &Features, entries: &[Entry]) -> Option<Outside> {
        let tree = cells.tree;
        let sites = cells.sites.delaunay.sites();
        let unit = cells.sites.delaunay.unit();
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
        // Planes are moved outwards, so that what is left has corners where it is not.
        let margin = self.margin();
        let (y, slack) = (self.y, cells.limits.slack);
        let [part, next] = &mut self.part;
        part.clip(&self.whole, height, u32::MAX, &y, slack);
        for (way, face) in ways.iter().zip((0..u32::MAX).rev()) {
            next.clip(part, |x| margin - dot(sub(*x, y), *way), face, &y, slack);
            std::mem::swap(part, next);
            if !part.is_simple() {
                return None;
            }
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
                if places[..count].iter().any(|place| cells.sites.delaunay.site_of(*place) == self.site) {
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
        self.tests += hull.corners.len();
        self.near = tree.isa().run(Values { hull, packet, values: &mut self.values });
        self.refine(hull, packet, tree);
        self.below.clear();
        for values in &self.values {
            let mut lanes = 0;
            for (lane, value) in values.iter().enumerate() {
                lanes |= u16::from(*value <= 0.0) << lane;
            }
            self.below.push(lanes);
        }
        self.near &= self.below.iter().fold(0, |all, lanes| all | lanes);
        self.crossed.clear();
        let below = &self.below;
        self.crossed.extend(hull.edges.iter().map(|[i, j]| below[*i as usize] ^ below[*j as usize]));
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
                self.tests += 1;
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &tree.leaves.vertices, hull.corners[i], f64::INFINITY, &mut best);
                let Some(closest) = best.finish() else { continue };
                // Less for the rounding of the kernel.
                let least = closest.distance * (1.0 - 1e-14) - reach * 1e-14 - hull.errors[i];
                let value = (least - reach) * (least + reach) * per_unit * per_unit;
                values[lane] = values[lane].max((value as f32).next_down());
            }
        }
    }

    /// The points that span the region of a lane.
    fn find_region(&mut self, hull: &Hull, lane: usize) {
        self.region.clear();
        for (corner, _) in hull.corners.iter().zip(&self.below).filter(|(_, below)| **below >> lane & 1 == 1) {
            self.region.push(*corner);
        }
        for (edge, _) in hull.edges.iter().zip(&self.crossed).filter(|(_, crossed)| **crossed >> lane & 1 == 1) {
            let [i, j] = edge.map(|i| i as usize);
            let [a, b] = [i, j].map(|i| f64::from(self.values[i][lane]));
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
pub(crate) const PART: f64 = 0.85;
/// A half-space begins so many sizes of the scene from the site.
const OUTSIDE: f64 = 0.15;

/// The function at all corners of a hull for the lanes of a packet, as an operation: which lanes are not above zero at
/// all of them.
struct Values<'a> {
    hull: &'a Hull,
    packet: &'a Packet,
    values: &'a mut Vec<[f32; LANES]>,
}

impl SimdKernel for Values<'_> {
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
