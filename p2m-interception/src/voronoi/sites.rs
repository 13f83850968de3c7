//! The sites of a Voronoi partition: the vertices of the scene, and points that are added until few primitives
//! intersect the ball of any corner.
//!
//! Near some points many primitives are about as far as the nearest vertices: around the centre of a sphere, on the
//! axis of a cylinder, between long edges. All of these primitives are in the list of every cell nearby. A new site in
//! such a ball removes its tetrahedron, and with it this corner. If the scene reaches well into the ball, points of
//! the scene are added, which bound the answer as vertices do. If it does not, only the border of the ball has points
//! of the scene. Then its centre is added as an *auxiliary* site, in whose cell the tree answers, from the bound that
//! a point of the scene gives.
//!
//! The corners are the circumcentres of Delaunay tetrahedra, whose balls have no site inside. So points are added in
//! rounds, each with new tetrahedra, until no ball is crowded, a round does not help, or the budget is spent.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::parallel_chunks::run_both;
use crate::progress::{BuildStage, ProgressReporter};
use crate::voronoi::adjacency::SiteTopology;
use crate::voronoi::budget::{Limits, max_tetrahedra};
use crate::voronoi::corners::{CellCorners, ReusedCorners};
use crate::voronoi::crowded::{AddedSite, CrowdedClusters};
use p2m_bvh::PacketTree;
use p2m_core::Aabb;
use p2m_core::engine::vector::V3;

/// The distance of the bounding sites from the centre, in halves of the longest side of the box of all sites. So none
/// of them is the nearest site in the domain, or nearly the nearest (docs/proofs/p2m.md).
pub(crate) const BOUNDING_DISTANCE: f64 = 300.0;
/// The largest number of rounds in which points are added.
const MAX_ROUNDS: usize = 6;

/// The sites of a partition and the corners of their cells.
pub(crate) struct Sites {
    /// The Delaunay tetrahedra of the sites.
    pub(crate) delaunay: Delaunay,
    /// The corners of the cells.
    pub(crate) corners: CellCorners,
    /// The topology of the triangulation.
    pub(crate) topology: SiteTopology,
    /// The auxiliary sites, sorted, each with a point of the scene near it.
    pub(crate) anchors: Vec<(usize, V3)>,
    /// The number of points of the scene that were added.
    pub(crate) added: usize,
}

impl Sites {
    /// Chooses the sites of the vertices of a tree, which lie in `bounds`, and of added points. It returns `None` if
    /// that exceeds the budget.
    pub(crate) fn new(
        tree: &PacketTree,
        bounds: &Aabb<f64>,
        limits: Limits<'_>,
        reporter: &ProgressReporter<'_>,
    ) -> Option<Self> {
        let progress = |done, all| reporter.advance([5.0, 30.0], done, all);
        let triangulate = |points: &[V3]| {
            reporter.begin_stage(BuildStage::Delaunay);
            let delaunay = Delaunay::within(points, BOUNDING_DISTANCE, max_tetrahedra(points.len())).ok();
            reporter.begin_stage(BuildStage::Balls);
            delaunay
        };
        let vertices = &tree.leaves.vertices;
        let mut points = vertices.to_vec();
        let mut added: Vec<AddedSite> = Vec::new();
        let mut delaunay = triangulate(&points)?;
        // The topology is collected beside the balls if there are threads for it, and at the end otherwise, because
        // only that of the last triangulation is needed.
        let parallel = limits.parallel;
        let early_topology = |delaunay: &Delaunay| parallel.then(|| SiteTopology::new(tree, delaunay));
        let (mut topology, mut corners) = run_both(
            parallel,
            || early_topology(&delaunay),
            || CellCorners::new(tree, &delaunay, limits, None, &progress),
        );
        for _ in 0..MAX_ROUNDS {
            let new_sites = CrowdedClusters { tree, corners: &corners, bounds, limits }
                .choose_sites(limits.max_added_sites - added.len());
            if limits.budget.is_exceeded() {
                return None;
            }
            if new_sites.is_empty() {
                break;
            }
            points.extend(new_sites.iter().map(|a| a.position));
            let count_before = points.len() - new_sites.len();
            let Some(next) = triangulate(&points) else {
                points.truncate(count_before);
                break;
            };
            corners.list_packets_of_balls(tree);
            let reused = ReusedCorners::new(&delaunay, &corners, &next, count_before);
            let (next_topology, all) = run_both(
                parallel,
                || early_topology(&next),
                || CellCorners::new(tree, &next, limits, Some(&reused), &progress),
            );
            let (crowded_before, crowded_after) = (corners.count_crowded(), all.count_crowded());
            added.extend(new_sites);
            (delaunay, corners, topology) = (next, all, next_topology);
            // Points do not help everywhere. Between long thin triangles there would have to be too many.
            if crowded_after * 8 > crowded_before * 7 && crowded_after * 16 > corners.all.len() {
                break;
            }
        }
        corners.find_packets_of_crowded(tree, limits);
        if limits.budget.is_exceeded() {
            return None;
        }
        // A site at a point of the scene is not an auxiliary one.
        let mut anchors: Vec<(usize, V3)> = Vec::new();
        let mut is_known = vec![false; delaunay.sites().len()];
        let is_on_scene = |i: usize| i < vertices.len() || added[i - vertices.len()].anchor.is_none();
        (0..points.len()).filter(|i| is_on_scene(*i)).for_each(|i| is_known[delaunay.site_of(i)] = true);
        for (i, point) in (vertices.len()..).zip(&added) {
            let site = delaunay.site_of(i);
            if let Some(anchor) = point.anchor.filter(|_| !is_known[site]) {
                is_known[site] = true;
                anchors.push((site, anchor));
            }
        }
        anchors.sort_unstable_by_key(|(site, _)| *site);
        let added = added.iter().filter(|point| point.anchor.is_none()).count();
        let topology = topology.unwrap_or_else(|| SiteTopology::new(tree, &delaunay));
        Some(Self { delaunay, corners, topology, anchors, added })
    }

    /// Returns the number of cells that have a crowded corner, which leaves them to the tree.
    pub(crate) fn count_fallback_cells(&self) -> usize {
        let mut is_fallback = vec![false; self.delaunay.sites().len()];
        for (tetrahedron, corner) in self.delaunay.tetrahedra().iter().zip(&self.corners.all) {
            tetrahedron.iter().for_each(|v| is_fallback[*v as usize] |= corner.is_crowded);
        }
        is_fallback[BOUNDING..].iter().filter(|is_fallback| **is_fallback).count()
    }

    /// Returns the index of the anchor of a site, if it is an auxiliary one.
    pub(crate) fn anchor_of(&self, site: usize) -> Option<usize> {
        self.anchors.binary_search_by_key(&site, |(site, _)| *site).ok()
    }
}
