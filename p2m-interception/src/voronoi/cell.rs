//! One Voronoi cell and its list.

use crate::list::block::Entry;
use crate::voronoi::adjacency::{Features, NONE};
use crate::voronoi::budget::Limits;
use crate::voronoi::cell_polytope::Hull;
use crate::voronoi::corner_values::{FromPlace, Known};
use crate::voronoi::corners::Corners;
use crate::voronoi::feature_relevance::{Around, Missed, Outlines, Scene, Seen};
use crate::voronoi::list_filter::{BuildListFilter, Region};
use crate::voronoi::site::Outside;
use crate::voronoi::sites::Sites;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::{V3, dot, norm_squared, sub};

/// A vertex of more edges, like the tip of a cone, is not worth it.
const MOST_WAYS: usize = 64;
/// The largest part that is worth a look.
pub(crate) const PART: f64 = 0.85;
/// A half-space begins so many sizes of the scene from the site.
const OUTSIDE: f64 = 0.15;

/// What is needed to make lists.
pub(crate) struct Cells<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) sites: &'a Sites,
    pub(crate) limits: Limits<'a>,
    /// Makes a filter for each list of more primitives than the number, if there are filters.
    pub(crate) filter: Option<(usize, BuildListFilter)>,
}

/// A cell at work.
#[derive(Default)]
pub(crate) struct Cell {
    /// The site.
    pub(crate) y: V3,
    pub(crate) site: usize,
    pub(crate) whole: Hull,
    /// The part of it that is far out, as it gets less.
    pub(crate) part: [Hull; 2],
    /// The packets that meet some ball.
    pub(crate) packets: Vec<u32>,
    /// Numbers of the tetrahedra, for the search of pairs.
    pub(crate) own: Vec<u32>,
    pub(crate) values: Known,
    pub(crate) missed: Missed,
}

impl Cell {
    pub(crate) fn gather(&mut self, cells: &Cells<'_>, corners: &Corners, site: usize, own: &[u32]) {
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

    pub(crate) fn entries(&mut self, cells: &Cells<'_>, features: &Features, outlines: &Outlines) -> Vec<Entry> {
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
    pub(crate) fn regions(&mut self, cells: &Cells<'_>, entries: &[Entry]) -> Vec<Region> {
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
    pub(crate) fn outside(&mut self, cells: &Cells<'_>, features: &Features, entries: &[Entry]) -> Option<Outside> {
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
