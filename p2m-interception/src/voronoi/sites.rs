//! Where the sites of a Voronoi partition are: at the vertices, and at points that are added until few primitives meet
//! the ball of a corner.
//!
//! Where many primitives are about as far from a position as the nearest vertices (around the centre of a sphere, on the
//! axis of a cylinder, between long edges), every cell nearby has all of them in its list. A site in such a ball ends
//! it: its corner is no corner any more. If the scene itself reaches well into the ball, points of it are added, which
//! bound the answer as vertices do. If not, the ball is empty but for its border, and its centre is added: an
//! *auxiliary* site, in whose cell the tree answers, from the bound that a point of the scene gives.
//!
//! CellCorners are the centres of the spheres through Delaunay tetrahedra, whose balls have no site inside; so points are
//! added in rounds, each with new tetrahedra, until no ball meets too much, a round does not help, or the budget is
//! spent.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::progress::{BuildStage, ProgressReporter};
use crate::voronoi::budget::{Limits, max_tetrahedra};
use crate::voronoi::corners::{CellCorners, ReusedCorners};
use crate::voronoi::crowded::{AddedSite, CrowdedClusters};
use p2m_bvh::PacketTree;
use p2m_core::Aabb;
use p2m_core::engine::vector::V3;

/// The distance of the bounding sites, in halves of the widest side: none of them is nearest in the domain, nor nearly
/// (docs/proofs/p2m.md).
pub(crate) const BOUNDING_DISTANCE: f64 = 300.0;
/// As many rounds of added points.
const MAX_ROUNDS: usize = 6;

/// The sites and the corners of their cells.
pub(crate) struct Sites {
    pub(crate) delaunay: Delaunay,
    pub(crate) corners: CellCorners,
    /// Of each auxiliary site a point of the scene that is near.
    pub(crate) anchors: Vec<(usize, V3)>,
    /// How many points of the scene were added.
    pub(crate) added: usize,
}

impl Sites {
    /// Those of the vertices of a tree, which lie in `bounds`, and more; `None` where that takes too much. `reporter` is told of
    /// its stages.
    pub(crate) fn new(
        tree: &PacketTree,
        bounds: &Aabb<f64>,
        limits: Limits<'_>,
        reporter: &ProgressReporter<'_>,
    ) -> Option<Self> {
        let progress = |done, all| reporter.advance([5.0, 30.0], done, all);
        let triangulated = |points: &[V3]| {
            reporter.begin_stage(BuildStage::Delaunay);
            let delaunay = Delaunay::within(points, BOUNDING_DISTANCE, max_tetrahedra(points.len())).ok();
            reporter.begin_stage(BuildStage::Balls);
            delaunay
        };
        let vertices = &tree.leaves.vertices;
        let mut points = vertices.to_vec();
        let mut added: Vec<AddedSite> = Vec::new();
        let mut delaunay = triangulated(&points)?;
        let mut corners = CellCorners::new(tree, &delaunay, limits, None, &progress);
        for _ in 0..MAX_ROUNDS {
            let more = CrowdedClusters { tree, corners: &corners, bounds, limits }
                .choose_sites(limits.max_added_sites - added.len());
            if limits.budget.is_exceeded() {
                return None;
            }
            if more.is_empty() {
                break;
            }
            points.extend(more.iter().map(|a| a.position));
            let before = points.len() - more.len();
            let Some(next) = triangulated(&points) else {
                points.truncate(before);
                break;
            };
            let reused = ReusedCorners::new(&delaunay, &corners, &next, before);
            let all = CellCorners::new(tree, &next, limits, Some(&reused), &progress);
            let (crowded_count, rest) = (corners.crowded_count(), all.crowded_count());
            added.extend(more);
            (delaunay, corners) = (next, all);
            // Points do not help everywhere: between long thin triangles there would have to be too many.
            if rest * 8 > crowded_count * 7 && rest * 16 > corners.all.len() {
                break;
            }
        }
        let corners = corners.with_packets_of_crowded(tree, limits);
        if limits.budget.is_exceeded() {
            return None;
        }
        // A site at a point of the scene is no auxiliary one.
        let mut anchors: Vec<(usize, V3)> = Vec::new();
        let mut own = vec![false; delaunay.sites().len()];
        let of_scene = |i: usize| i < vertices.len() || added[i - vertices.len()].anchor.is_none();
        (0..points.len()).filter(|i| of_scene(*i)).for_each(|i| own[delaunay.site_of(i)] = true);
        for (i, point) in (vertices.len()..).zip(&added) {
            let site = delaunay.site_of(i);
            if let Some(anchor) = point.anchor.filter(|_| !own[site]) {
                own[site] = true;
                anchors.push((site, anchor));
            }
        }
        anchors.sort_unstable_by_key(|(site, _)| *site);
        let added = added.iter().filter(|point| point.anchor.is_none()).count();
        Some(Self { delaunay, corners, anchors, added })
    }

    /// How many cells have a corner that is crowded_count.
    pub(crate) fn fallback_cells(&self) -> usize {
        let mut left = vec![false; self.delaunay.sites().len()];
        for (tetrahedron, corner) in self.delaunay.tetrahedra().iter().zip(&self.corners.all) {
            tetrahedron.iter().for_each(|v| left[*v as usize] |= corner.is_crowded);
        }
        left[BOUNDING..].iter().filter(|left| **left).count()
    }

    /// Which of the anchors is that of a site, if it is an auxiliary one.
    pub(crate) fn anchor_of(&self, site: usize) -> Option<usize> {
        self.anchors.binary_search_by_key(&site, |(site, _)| *site).ok()
    }
}
