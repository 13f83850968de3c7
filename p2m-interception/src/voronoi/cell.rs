//! One Voronoi cell and its list.

use crate::list::block::Entry;
use crate::voronoi::adjacency::{EdgeAdjacency, NO_PRIMITIVE};
use crate::voronoi::budget::Limits;
use crate::voronoi::cell_polytope::CellPolytope;
use crate::voronoi::corner_values::{CornerValues, SiteDistances};
use crate::voronoi::corners::CellCorners;
use crate::voronoi::feature_relevance::{CellInfo, ExcludedFeatures, PrimitiveFrames, PrimitiveView, RelevanceContext};
use crate::voronoi::list_filter::{BuildListFilter, Region};
use crate::voronoi::site::FarHalfSpace;
use crate::voronoi::sites::Sites;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::{V3, dot, norm_squared, sub};

/// A vertex of more edges, like the tip of a cone, is not worth it.
const MAX_EDGES_FOR_HALF_SPACE: usize = 64;
/// The largest far_parts that is worth a look.
pub(crate) const MAX_RELATIVE_LEAD: f64 = 0.85;
/// A half-space begins so many sizes of the scene from the site.
const HALF_SPACE_SCENE_SIZES: f64 = 0.15;

/// What is needed to make lists.
pub(crate) struct CellContext<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) sites: &'a Sites,
    pub(crate) limits: Limits<'a>,
    /// Makes a filter for each list of more primitives than the number, if there are filters.
    pub(crate) filter: Option<(usize, BuildListFilter)>,
}

/// A cell at work.
#[derive(Default)]
pub(crate) struct CellBuilder {
    /// The site.
    pub(crate) y: V3,
    pub(crate) site: usize,
    pub(crate) polytope: CellPolytope,
    /// The far_parts of it that is far out, as it gets less.
    pub(crate) far_parts: [CellPolytope; 2],
    /// The packets that meet some ball.
    pub(crate) packets: Vec<u32>,
    /// Numbers of the tetrahedra, for the search of pairs.
    pub(crate) tetrahedra: Vec<u32>,
    pub(crate) values: CornerValues,
    pub(crate) excluded: ExcludedFeatures,
}

impl CellBuilder {
    pub(crate) fn collect(&mut self, cells: &CellContext<'_>, corners: &CellCorners, site: usize, tetrahedra: &[u32]) {
        let unit = cells.sites.delaunay.unit();
        self.site = site;
        self.y = cells.sites.delaunay.sites()[site].map(|x| x * unit);
        self.polytope.clear();
        self.packets.clear();
        self.tetrahedra.clear();
        self.tetrahedra.extend_from_slice(tetrahedra);
        self.tetrahedra.sort_unstable();
        for (i, &number) in (0u32..).zip(&self.tetrahedra) {
            let t = number as usize;
            let corner = &corners.all[t];
            let tetrahedron = &cells.sites.delaunay.tetrahedra()[t];
            let mut faces = [0; 3];
            let others = tetrahedron.iter().filter(|v| **v as usize != site);
            faces.iter_mut().zip(others).for_each(|(to, v)| *to = *v);
            self.polytope.push(corner.position, corner.error, faces, &self.y, cells.limits.slack);
            self.packets.extend_from_slice(corners.packets(t));
            for (v, other) in tetrahedron.iter().zip(&cells.sites.delaunay.neighbours()[t]) {
                // Each pair once.
                let joined = *v as usize != site && number < *other;
                if let Some(Ok(j)) = joined.then(|| self.tetrahedra.binary_search(other)) {
                    self.polytope.edges.push([i, u32::try_from(j).expect("few corners")]);
                }
            }
        }
        self.packets.sort_unstable();
        self.packets.dedup();
    }

    pub(crate) fn list_entries(
        &mut self,
        cells: &CellContext<'_>,
        adjacency: &EdgeAdjacency,
        frames: &PrimitiveFrames,
    ) -> Vec<Entry> {
        let tree = cells.tree;
        let scene =
            RelevanceContext { tree, delaunay: &cells.sites.delaunay, adjacency, frames, slack: cells.limits.slack };
        let CellPolytope { max_upper_bound: max_distance, max_error, .. } = self.polytope;
        let cell_info = CellInfo { site: self.site, position: self.y, max_distance, max_error };
        let mut list_entries: Vec<(f64, Entry)> = Vec::with_capacity(self.packets.len());
        let packets = std::mem::take(&mut self.packets);
        for &number in &packets {
            let packet = &tree.leaves.packets[number as usize];
            self.values.compute(&self.polytope, packet, tree);
            let near_lanes = self.values.near_lanes;
            let mut lanes = near_lanes;
            for lane in (0..LANES).filter(|lane| near_lanes >> lane & 1 == 1) {
                if let Some(view) = PrimitiveView::new(scene, cell_info, number as usize, lane) {
                    self.values.find_region(&self.polytope, lane);
                    lanes &= !(u16::from(!view.is_relevant(&self.values.region, &mut self.excluded)) << lane);
                }
            }
            if lanes != 0 {
                let order = SiteDistances::new(tree, packet, &self.y).least(lanes) * packet.unit();
                let bounds = tree.frame.enclose(&packet.bounds_of(lanes));
                list_entries.push((order, Entry { packet: number, lanes, bounds, f: [0.0; 8] }));
            }
        }
        self.packets = packets;
        list_entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
        list_entries.into_iter().map(|e| e.1).collect()
    }

    /// Boxes cell_info the regions of all primitives of a list.
    pub(crate) fn regions(&mut self, cells: &CellContext<'_>, list_entries: &[Entry]) -> Vec<Region> {
        let tree = cells.tree;
        let mut regions = Vec::new();
        for entry in list_entries {
            self.values.compute(&self.polytope, &tree.leaves.packets[entry.packet as usize], tree);
            for lane in (0..LANES).filter(|lane| entry.lanes >> lane & 1 == 1) {
                self.values.find_region(&self.polytope, lane);
                regions.push(Region::from_points(&self.values.region, self.margin(), entry.packet, lane));
            }
        }
        regions
    }

    /// By more than corners may be off.
    fn margin(&self) -> f64 {
        4.0 * self.polytope.max_error + 1e-12 * self.polytope.max_upper_bound
    }

    /// The half-space far from the site in which only primitives with it can be the answer, if it is the nearest point
    /// of all of these and other sites are farther away by some far_parts.
    #[allow(clippy::cast_possible_truncation, reason = "rounded, and margins have room")]
    pub(crate) fn far_half_space(
        &mut self,
        cells: &CellContext<'_>,
        adjacency: &EdgeAdjacency,
        list_entries: &[Entry],
    ) -> Option<FarHalfSpace> {
        let tree = cells.tree;
        let sites = cells.sites.delaunay.sites();
        let unit = cells.sites.delaunay.unit();
        let others = adjacency.edges.of(self.site).iter();
        let directions: Vec<V3> = others
            .map(|w| sub(sites[*w as usize], sites[self.site]))
            .map(|direction| direction.map(|x| x / norm_squared(direction).sqrt()))
            .collect();
        let sum = directions.iter().fold([0.0; 3], |sum, direction| sub(sum, *direction));
        let length = norm_squared(sum).sqrt();
        if adjacency.owners[self.site] == NO_PRIMITIVE || directions.len() > MAX_EDGES_FOR_HALF_SPACE || length < 1e-3 {
            return None;
        }
        let normal = sum.map(|x| (x / length) as f32);
        let along = normal.map(f64::from);
        let bounds = tree.bounds();
        let from = (bounds.max - bounds.min).max() * HALF_SPACE_SCENE_SIZES;
        let height = |x: &V3| dot(sub(*x, self.y), along) - from;
        if self.polytope.corners.iter().all(|x| height(x) < 0.0) {
            return None;
        }
        // Planes are moved outwards, so that what is left has corners where it is not.
        let margin = self.margin();
        let (y, slack) = (self.y, cells.limits.slack);
        let [far_parts, next] = &mut self.far_parts;
        far_parts.clip(&self.polytope, height, u32::MAX, &y, slack);
        for (direction, face) in directions.iter().zip((0..u32::MAX).rev()) {
            next.clip(far_parts, |x| margin - dot(sub(*x, y), *direction), face, &y, slack);
            std::mem::swap(far_parts, next);
            if !far_parts.is_simple() {
                return None;
            }
        }
        // The largest far_parts of the direction to another site by which that one has to be left behind.
        let mut max_lead = 0.0f64;
        for entry in list_entries {
            let packet = &tree.leaves.packets[entry.packet as usize];
            self.values.compute(far_parts, packet, tree);
            let lanes = self.values.near_lanes & entry.lanes;
            let from_site = SiteDistances::new(tree, packet, &y);
            for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
                let (positions, count) = packet.vertices_of(lane);
                if positions[..count].iter().any(|place| cells.sites.delaunay.site_of(*place) == self.site) {
                    continue;
                }
                let distance = from_site.least(1 << lane);
                // So the slack does not matter to the function at the site.
                if distance * packet.unit() < 64.0 * slack {
                    return None;
                }
                let lack = self.values.values.iter().fold(0.0f64, |a, v| a.max(-f64::from(v[lane])));
                let far_parts = lack * 1.001 / (distance * distance);
                if far_parts.is_nan() || far_parts > MAX_RELATIVE_LEAD {
                    return None;
                }
                max_lead = max_lead.max(far_parts);
            }
        }
        let scaled = (from + margin) / unit * (1.0 + 1e-6);
        Some(FarHalfSpace { normal, height: scaled as f32, relative_lead: (max_lead * (1.0 + 1e-6)) as f32 })
    }
}
