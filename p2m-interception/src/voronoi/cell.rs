//! One Voronoi cell: its corners and edges, and its far half-space.

use crate::list::block::Entry;
use crate::voronoi::adjacency::{EdgeAdjacency, NO_PRIMITIVE};
use crate::voronoi::budget::Limits;
use crate::voronoi::cell_polytope::CellPolytope;
use crate::voronoi::corner_values::{CornerValues, SiteDistances};
use crate::voronoi::list_filter::BuildListFilter;
use crate::voronoi::site::FarHalfSpace;
use crate::voronoi::sites::Sites;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::{V3, dot, norm_squared, sub};

/// The largest number of edges at a site with a far half-space. The tip of a cone, for example, has more.
///
/// No record exists of the scenes on which this and the next two constants were chosen;
/// docs/decisions/022-far-queries-read-no-list.md has the method.
const MAX_EDGES_FOR_HALF_SPACE: usize = 64;
/// The largest relative lead over other sites with which a far half-space is of use.
pub(crate) const MAX_RELATIVE_LEAD: f64 = 0.85;
/// The distance of a far half-space from its site, in sizes of the scene.
const HALF_SPACE_SCENE_SIZES: f64 = 0.15;

/// The data that all cells of a build share.
pub(crate) struct CellContext<'a> {
    /// The tree over the packets.
    pub(crate) tree: &'a PacketTree,
    /// The sites with the corners of their cells.
    pub(crate) sites: &'a Sites,
    /// The limits of the build.
    pub(crate) limits: Limits<'a>,
    /// The function that builds filters, if there are any, and the number of primitives above which a list gets one.
    pub(crate) filter: Option<(usize, BuildListFilter)>,
}

/// The cell whose far half-space is computed. Its vectors are reused for the next cell.
#[derive(Default)]
pub(crate) struct FarPartBuilder {
    /// The corners and edges of the cell.
    polytope: CellPolytope,
    /// The part of the cell in the far half-space, and the polytope that it is clipped into.
    far_parts: [CellPolytope; 2],
    /// The numbers of the tetrahedra at the site, sorted. Tetrahedron i has corner i of the cell.
    tetrahedra: Vec<u32>,
    /// The values of the corner test at the corners of a polytope.
    pub(crate) values: CornerValues,
}

impl FarPartBuilder {
    /// Begins the cell of a site at the position `y`, which has these tetrahedra: collects its corners and its edges.
    fn begin(&mut self, cells: &CellContext<'_>, site: usize, y: &V3, tetrahedra: &[u32]) {
        self.polytope.clear();
        self.tetrahedra.clear();
        self.tetrahedra.extend_from_slice(tetrahedra);
        self.tetrahedra.sort_unstable();
        for (i, &number) in (0u32..).zip(&self.tetrahedra) {
            let t = number as usize;
            let corner = &cells.sites.corners.all[t];
            let tetrahedron = &cells.sites.delaunay.tetrahedra()[t];
            let mut faces = [0; 3];
            let others = tetrahedron.iter().filter(|v| **v as usize != site);
            faces.iter_mut().zip(others).for_each(|(to, v)| *to = *v);
            self.polytope.push(corner.position, corner.error, faces, y, cells.limits.slack);
            for (v, other) in tetrahedron.iter().zip(&cells.sites.delaunay.neighbours()[t]) {
                // Each pair of tetrahedra is joined once.
                let is_joined = *v as usize != site && number < *other;
                if let Some(Ok(j)) = is_joined.then(|| self.tetrahedra.binary_search(other)) {
                    self.polytope.edges.push([i, u32::try_from(j).expect("few corners")]);
                }
            }
        }
    }

    /// Computes the far half-space of the site, or returns `None` if there is none that is of use.
    ///
    /// The basic idea is that far from the scene the nearest point is mostly a vertex. The half-space faces away from
    /// the edges at the site and begins at a fixed distance from it. The cell is clipped to this half-space, and to the
    /// points to which no edge at the site is nearer than the site. The corner test of the clipped polytope shows by
    /// how much other primitives of the list could beat the site there. This lack, relative to the squared distance of
    /// a primitive from the site, becomes the lead over the other sites that a query needs for the site to be the
    /// answer.
    #[allow(clippy::cast_possible_truncation, reason = "rounded, and margins have room")]
    pub(crate) fn half_space(
        &mut self,
        cells: &CellContext<'_>,
        adjacency: &EdgeAdjacency,
        site: usize,
        tetrahedra: &[u32],
        entries: &[Entry],
    ) -> Option<FarHalfSpace> {
        let tree = cells.tree;
        let sites = cells.sites.delaunay.sites();
        let unit = cells.sites.delaunay.unit();
        let y = sites[site].map(|x| x * unit);
        let others = adjacency.edges.get(site).iter();
        let directions: Vec<V3> = others
            .map(|w| sub(sites[*w as usize], sites[site]))
            .map(|direction| direction.map(|x| x / norm_squared(direction).sqrt()))
            .collect();
        let sum = directions.iter().fold([0.0; 3], |sum, direction| sub(sum, *direction));
        let length = norm_squared(sum).sqrt();
        if adjacency.owners[site] == NO_PRIMITIVE || directions.len() > MAX_EDGES_FOR_HALF_SPACE || length < 1e-3 {
            return None;
        }
        let normal = sum.map(|x| (x / length) as f32);
        let along = normal.map(f64::from);
        let bounds = tree.bounds();
        let start = (bounds.max - bounds.min).max() * HALF_SPACE_SCENE_SIZES;
        let height = |x: &V3| dot(sub(*x, y), along) - start;
        if tetrahedra.iter().all(|t| height(&cells.sites.corners.all[*t as usize].position) < 0.0) {
            return None;
        }
        self.begin(cells, site, &y, tetrahedra);
        // The planes are moved outwards, so that rounding does not remove corners of the part that is left.
        let margin = self.polytope.corners.margin();
        let slack = cells.limits.slack;
        let [part, clipped] = &mut self.far_parts;
        part.clip(&self.polytope, height, u32::MAX, &y, slack);
        for (direction, face) in directions.iter().zip((0..u32::MAX).rev()) {
            clipped.clip(part, |x| margin - dot(sub(*x, y), *direction), face, &y, slack);
            std::mem::swap(part, clipped);
            if !part.is_simple() {
                return None;
            }
        }
        // The lead over another site that a query needs, as a fraction of half the squared distance between the two
        // sites.
        let mut max_lead = 0.0f64;
        for entry in entries {
            let packet = &tree.leaves.packets[entry.packet as usize];
            let is_at_site = |lane: usize| {
                let (positions, count) = packet.vertices_of(lane);
                positions[..count].iter().any(|position| cells.sites.delaunay.site_of(*position) == site)
            };
            let others = (0..LANES).filter(|lane| entry.lanes >> lane & 1 == 1 && !is_at_site(*lane));
            let others = others.fold(0, |lanes, lane| lanes | 1 << lane);
            if others == 0 {
                continue;
            }
            self.values.compute(&part.corners, packet, others, tree);
            let lanes = self.values.near_lanes;
            let from_site = SiteDistances::new(tree, packet, &y);
            for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
                let distance = from_site.least(1 << lane);
                // The distance has to be so large that the slack is negligible in the function at the site.
                if distance * packet.unit() < 64.0 * slack {
                    return None;
                }
                let lack = self.values.values.iter().fold(0.0f64, |a, v| a.max(-f64::from(v[lane])));
                let lead = lack * 1.001 / (distance * distance);
                if lead.is_nan() || lead > MAX_RELATIVE_LEAD {
                    return None;
                }
                max_lead = max_lead.max(lead);
            }
        }
        let height_in_units = (start + margin) / unit * (1.0 + 1e-6);
        Some(FarHalfSpace { normal, height: height_in_units as f32, relative_lead: (max_lead * (1.0 + 1e-6)) as f32 })
    }
}
