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
//! rounds, each with new tetrahedra, until no ball is crowded, a round does not help, or the budget is spent. Each
//! round extends the triangulation of the one before.

use crate::delaunay::{BOUNDING, Delaunay, DelaunayError};
use crate::progress::{BuildStage, ProgressReporter};
use crate::voronoi::adjacency::{EdgeAdjacency, SiteTopology};
use crate::voronoi::budget::{Limits, max_tetrahedra};
use crate::voronoi::corner::CellCorner;
use crate::voronoi::corners::{CellCorners, ReusedCorners};
use crate::voronoi::crowded::{AddedSite, CrowdedClusters};
use p2m_bvh::PacketTree;
use p2m_core::Aabb;
use p2m_core::engine::parallel::run_beside;
use p2m_core::engine::vector::V3;

/// The distance of the bounding sites from the centre, in halves of the longest side of the box of all sites. It is so
/// large that no bounding site is the nearest site in the domain, or nearly the nearest ([docs/proofs/p2m.md]).
///
/// [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md
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

/// The sites while points are added.
struct GrowingSites<'a> {
    tree: &'a PacketTree,
    bounds: &'a Aabb<f64>,
    limits: Limits<'a>,
    reporter: &'a ProgressReporter<'a>,
    /// The vertices, then the added points.
    points: Vec<V3>,
    /// The points that were added.
    added: Vec<AddedSite>,
    /// The triangulation of the points.
    delaunay: Delaunay,
    /// The topology of the triangulation, if another thread collected it while the balls were searched. Otherwise it is
    /// collected at the end, because only the topology of the last triangulation is needed.
    topology: Option<SiteTopology>,
    /// The corners of the triangulation, with the packets of their balls. There are none until these are known.
    corners: CellCorners,
}

impl<'a> GrowingSites<'a> {
    /// Triangulates the vertices of a tree and finds the packets of all balls. It returns `None` if there are too many
    /// tetrahedra, or if the budget is exceeded.
    ///
    /// Floods are given up where very many balls are crowded. Then sites are added before all packets are known,
    /// because most of these balls vanish.
    fn new(
        tree: &'a PacketTree,
        bounds: &'a Aabb<f64>,
        limits: Limits<'a>,
        reporter: &'a ProgressReporter<'a>,
    ) -> Option<Self> {
        let points = tree.leaves.vertices.to_vec();
        reporter.begin_stage(BuildStage::Delaunay);
        let Triangulated { delaunay, adjacency, .. } = triangulate(tree, &points, None, limits).ok()?;
        reporter.begin_stage(BuildStage::Balls);
        let (added, corners) = (Vec::new(), CellCorners::default());
        let mut sites = Self { tree, bounds, limits, reporter, points, added, delaunay, topology: None, corners };
        let (topology, flooded) = collect_topology_beside(adjacency, &sites.delaunay, limits, || {
            CellCorners::flood(tree, &sites.delaunay, limits, &sites.progress())
        });
        sites.topology = topology;
        match flooded {
            Ok(corners) => sites.corners = corners,
            Err(all) => {
                let probable = sites.clusters(&all).choose_probable_sites(sites.count_left());
                if limits.budget.is_exceeded() {
                    return None;
                }
                if probable.is_empty() || !sites.add(probable) {
                    sites.corners = CellCorners::search(tree, limits, &all, None, &sites.progress());
                }
            }
        }
        Some(sites)
    }

    /// Adds points, and finds the packets of all balls. Balls that remain keep their packets, if there are corners
    /// already. Returns `false` and adds nothing if there would be too many tetrahedra.
    fn add(&mut self, new_sites: Vec<AddedSite>) -> bool {
        let count_before = self.points.len();
        self.points.extend(new_sites.iter().map(|site| site.position));
        self.reporter.begin_stage(BuildStage::Delaunay);
        let extended = triangulate(self.tree, &self.points, Some(&self.delaunay), self.limits);
        self.reporter.begin_stage(BuildStage::Balls);
        let Ok(Triangulated { delaunay: next, old_numbers, adjacency }) = extended else {
            self.points.truncate(count_before);
            return false;
        };
        self.added.extend(new_sites);
        self.corners.list_packets_of_balls(self.tree);
        let reused = ReusedCorners { corners: &self.corners, old_numbers: &old_numbers };
        let reused = (!self.corners.all.is_empty()).then_some(&reused);
        let (topology, corners) = collect_topology_beside(adjacency, &next, self.limits, || {
            CellCorners::new(self.tree, &next, self.limits, reused, &self.progress())
        });
        (self.delaunay, self.topology, self.corners) = (next, topology, corners);
        true
    }

    /// Returns the number of points that may still be added.
    fn count_left(&self) -> usize {
        self.limits.max_added_sites - self.added.len()
    }

    fn clusters<'b>(&'b self, corners: &'b [CellCorner]) -> CrowdedClusters<'b> {
        CrowdedClusters { tree: self.tree, corners, bounds: self.bounds, limits: self.limits }
    }

    fn progress(&self) -> impl Fn(usize, usize) + use<'a> {
        let reporter = self.reporter;
        move |done, all| reporter.advance([5.0, 30.0], done, all)
    }
}

/// A triangulation of the points, with results that come with it.
struct Triangulated {
    delaunay: Delaunay,
    /// For each tetrahedron its number in the earlier triangulation, as [`Delaunay::extend`] returns it.
    old_numbers: Vec<u32>,
    /// The edges of the primitives, if there were threads to collect them meanwhile.
    adjacency: Option<EdgeAdjacency>,
}

/// Triangulates points, beginning with an earlier triangulation of the first ones if there is one.
fn triangulate(
    tree: &PacketTree,
    points: &[V3],
    earlier: Option<&Delaunay>,
    limits: Limits<'_>,
) -> Result<Triangulated, DelaunayError> {
    let (parallel, max_tetrahedra) = (limits.parallel, max_tetrahedra(points.len()));
    let collect_edges = |sites: &_| parallel.then(|| EdgeAdjacency::from_tree(tree, sites));
    let (delaunay, old_numbers, adjacency) =
        Delaunay::build_beside(points, BOUNDING_DISTANCE, max_tetrahedra, earlier, parallel, collect_edges)?;
    Ok(Triangulated { delaunay, old_numbers, adjacency })
}

/// Completes the topology of a triangulation beside another task, if the edges of the primitives are known already.
fn collect_topology_beside<R>(
    adjacency: Option<EdgeAdjacency>,
    delaunay: &Delaunay,
    limits: Limits<'_>,
    other: impl FnOnce() -> R,
) -> (Option<SiteTopology>, R) {
    run_beside(limits.parallel, || adjacency.map(|adjacency| SiteTopology::new(adjacency, delaunay)), other)
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
        let mut growing = GrowingSites::new(tree, bounds, limits, reporter)?;
        for _ in 0..MAX_ROUNDS {
            let new_sites = growing.clusters(&growing.corners.all).choose_sites(growing.count_left());
            if limits.budget.is_exceeded() {
                return None;
            }
            let (crowded_before, ball_count) = (growing.corners.count_crowded(), growing.corners.all.len());
            if new_sites.is_empty() || !growing.add(new_sites) {
                break;
            }
            let crowded_after = growing.corners.count_crowded();
            // Added points do not help everywhere: between long thin triangles there would have to be too many.
            if crowded_after * 8 > crowded_before * 7 && crowded_after * 16 > ball_count {
                break;
            }
        }
        let GrowingSites { points, added, delaunay, topology, mut corners, .. } = growing;
        corners.find_packets_of_crowded(tree, limits);
        if limits.budget.is_exceeded() {
            return None;
        }
        // A site at a point of the scene is not an auxiliary one.
        let mut anchors: Vec<(usize, V3)> = Vec::new();
        let mut is_known = vec![false; delaunay.sites().len()];
        let vertex_count = tree.leaves.vertices.len();
        let is_on_scene = |i: usize| i < vertex_count || added[i - vertex_count].anchor.is_none();
        (0..points.len()).filter(|i| is_on_scene(*i)).for_each(|i| is_known[delaunay.site_of(i)] = true);
        for (i, point) in (vertex_count..).zip(&added) {
            let site = delaunay.site_of(i);
            if let Some(anchor) = point.anchor.filter(|_| !is_known[site]) {
                is_known[site] = true;
                anchors.push((site, anchor));
            }
        }
        anchors.sort_unstable_by_key(|(site, _)| *site);
        let added = added.iter().filter(|point| point.anchor.is_none()).count();
        let topology =
            topology.unwrap_or_else(|| SiteTopology::new(EdgeAdjacency::from_tree(tree, &delaunay.scaled), &delaunay));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::P2mOptions;
    use crate::voronoi::budget::BuildBudget;
    use crate::voronoi::vertex_bounds;
    use nalgebra::Point3;
    use p2m_core::Triangle;
    use p2m_testkit::{rng, vector};

    /// Each of these needles is as long as the scene, so every ball meets very many.
    #[test]
    fn needles_are_given_up_within_the_budget() {
        let mut rng = rng("needles", 0);
        let needles: Vec<Triangle<f64>> = (0..10_000)
            .map(|_| {
                let (centre, along) = (vector(&mut rng) * 0.5, vector(&mut rng).normalize());
                let [a, b] = [centre - along, centre + along].map(Point3::from);
                Triangle::new(a, b, b + vector(&mut rng) * 1e-3)
            })
            .collect();
        let options = P2mOptions::default();
        let tree = PacketTree::build(&needles[..], &options.splits);
        let budget = &BuildBudget::new(options.memory, options.work, needles.len());
        let (slack, max_list_packets, max_added_sites) = (1e-9, options.max_list_packets, 15_000);
        let limits = Limits { parallel: false, slack, max_list_packets, max_added_sites, budget };
        let reporter = ProgressReporter::new(&|_| {}, BuildStage::Tree);
        assert!(Sites::new(&tree, &vertex_bounds(&tree), limits, &reporter).is_none());
        let charged = budget.charged();
        println!("{charged} tests");
        assert!(budget.is_exceeded() && charged < 2_100 * 10_000, "{charged} tests");
    }
}
