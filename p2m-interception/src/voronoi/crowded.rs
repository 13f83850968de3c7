//! The choice of sites that are added because of crowded balls.

use crate::voronoi::budget::Limits;
use crate::voronoi::corner::CellCorner;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, exponent, scale_by_power};
use p2m_core::{Aabb, Best, QueryOptions};
use rustc_hash::{FxHashMap, FxHashSet};

/// The centre of a ball becomes an auxiliary site only if this many crowded balls form a cluster.
const MIN_BALLS_FOR_AUXILIARY_SITE: usize = 3;
/// A point of the scene is added if it is nearer to the centre than this part of the radius.
const DEEP_RADIUS_PART: f64 = 0.9;
/// The largest number of packets of a ball in which such points are looked for.
const MAX_EXAMINED_PACKETS: usize = 64;
/// Added points lie in the box of the vertices, enlarged on all sides by this part of its longest side.
const BOX_PADDING_PART: f64 = 0.5;
/// The size of a cluster: centres are in one cluster if their distance is below about this part of the radius.
const CLUSTER_RADIUS_PART: f64 = 0.25;
/// A corner is ignored if its error is more than this part of its radius.
const MAX_ERROR_RADIUS_PART: f64 = 1e-3;
/// The spacing of added points, as a part of their distance from the centre of the ball.
const SPACING_DISTANCE_PART: f64 = 0.5;
/// The smallest distance that the spacing is computed from, as a part of the radius.
const MIN_SPACING_RADIUS_PART: f64 = 0.1;

/// A point that becomes a site.
pub(crate) struct AddedSite {
    /// The position of the site.
    pub(crate) position: V3,
    /// A point of the scene near an auxiliary site. It is `None` if the point is on the scene itself.
    pub(crate) anchor: Option<V3>,
}

/// The crowded balls of a triangulation.
pub(crate) struct CrowdedClusters<'a> {
    /// The tree over the packets.
    pub(crate) tree: &'a PacketTree,
    /// The corners of all cells.
    pub(crate) corners: &'a [CellCorner],
    /// The box of the vertices.
    pub(crate) bounds: &'a Aabb<f64>,
    /// The limits of the build.
    pub(crate) limits: Limits<'a>,
}

/// A cell of a grid: the exponent of its side, and its coordinates.
type GridCell = (i32, [i64; 3]);

/// Returns the grid cell that contains a position. Its side is about `size`.
#[allow(clippy::cast_possible_truncation, reason = "rounded down; a cube that is too far away is another one")]
fn grid_cell(position: &V3, size: f64) -> GridCell {
    let exponent = exponent(size);
    (exponent, position.map(|x| (scale_by_power(x, -exponent)).floor() as i64))
}

impl CrowdedClusters<'_> {
    /// Chooses points for the crowded balls, at most `budget` of them.
    pub(crate) fn choose_sites(&self, budget: usize) -> Vec<AddedSite> {
        self.choose_sites_of_clusters(&self.clusters(|corner| corner.is_crowded), budget)
    }

    /// Chooses points, at most `budget` of them, when it is not known yet which balls are crowded. A cluster counts as
    /// crowded if its first ball is. This takes one search for each cluster instead of one for each ball, and later
    /// triangulations show what it misses.
    pub(crate) fn choose_probable_sites(&self, budget: usize) -> Vec<AddedSite> {
        let mut clusters = self.clusters(|_| true);
        let max_packets = self.limits.max_uncrowded_packets();
        let mut selections = Vec::new();
        clusters.retain(|(number, count)| {
            selections.clear();
            *count >= MIN_BALLS_FOR_AUXILIARY_SITE
                && !self.limits.budget.is_exceeded()
                && !self.corners[*number].collect_ball(self.tree, self.limits, max_packets, &mut selections)
        });
        self.choose_sites_of_clusters(&clusters, budget)
    }

    /// Returns the clusters of the corners for which `is_member` is true. Each is its first corner, and the
    /// number of its corners.
    fn clusters(&self, is_member: impl Fn(&CellCorner) -> bool) -> Vec<(usize, usize)> {
        let mut clusters: FxHashMap<GridCell, (usize, usize)> = FxHashMap::default();
        for (number, corner) in self.corners.iter().enumerate() {
            if is_member(corner)
                && corner.radius > 0.0
                && self.is_near_scene(&corner.position)
                && corner.error < corner.radius * MAX_ERROR_RADIUS_PART
            {
                clusters
                    .entry(grid_cell(&corner.position, corner.radius * CLUSTER_RADIUS_PART))
                    .or_insert((number, 0))
                    .1 += 1;
            }
        }
        let mut clusters: Vec<(usize, usize)> = clusters.into_values().collect();
        clusters.sort_unstable();
        clusters
    }

    fn choose_sites_of_clusters(&self, clusters: &[(usize, usize)], budget: usize) -> Vec<AddedSite> {
        let mut occupied_cells: FxHashSet<GridCell> = FxHashSet::default();
        let mut added = Vec::new();
        for &(number, count) in clusters {
            if added.len() >= budget || self.limits.budget.is_exceeded() {
                break;
            }
            let corner = &self.corners[number];
            let nearest_points = self.nearest_points(corner);
            let deep_count =
                nearest_points.partition_point(|(distance, _)| *distance < corner.radius * DEEP_RADIUS_PART);
            if let Some((_, anchor)) =
                nearest_points.first().filter(|_| deep_count == 0 && count >= MIN_BALLS_FOR_AUXILIARY_SITE)
            {
                added.push(AddedSite { position: corner.position, anchor: Some(*anchor) });
            }
            for &(distance, position) in &nearest_points[..deep_count] {
                if added.len() < budget
                    && occupied_cells.insert(grid_cell(
                        &position,
                        distance.max(corner.radius * MIN_SPACING_RADIUS_PART) * SPACING_DISTANCE_PART,
                    ))
                {
                    added.push(AddedSite { position, anchor: None });
                }
            }
        }
        added
    }

    /// Returns whether a position is in the enlarged box of the vertices.
    fn is_near_scene(&self, position: &V3) -> bool {
        let Aabb { min, max } = self.bounds;
        let pad = (max - min).max() * BOX_PADDING_PART;
        (0..3).all(|k| position[k] >= min[k] - pad && position[k] <= max[k] + pad)
    }

    /// Returns for some primitives that intersect the ball of a corner the point nearest to the corner, with its
    /// distance, the nearest first.
    fn nearest_points(&self, corner: &CellCorner) -> Vec<(f64, V3)> {
        let leaves = &self.tree.leaves;
        let (mut selections, mut tests) = (Vec::new(), 0);
        self.tree.ball(
            corner.position,
            corner.radius + 2.0 * corner.error,
            MAX_EXAMINED_PACKETS,
            &mut selections,
            &mut tests,
        );
        let mut points = Vec::new();
        for Selection { packet, lanes } in selections {
            let packet = &leaves.packets[packet as usize];
            for lane in (0..LANES).filter(|lane| packet.has_vertices() && lanes >> lane & 1 == 1) {
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &leaves.vertices, corner.position, f64::INFINITY, &mut best);
                points.extend(best.finish().map(|closest| (closest.distance, closest.point.coords.into())));
            }
        }
        self.limits.budget.charge(tests + points.len());
        points.sort_by(|a: &(f64, V3), b| a.0.total_cmp(&b.0));
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delaunay::Delaunay;
    use crate::voronoi::budget::BuildBudget;
    use crate::voronoi::corner::compute_corners;
    use nalgebra::Point3;
    use p2m_bvh::SplitOptions;
    use p2m_core::engine::vector::norm_squared;
    use p2m_core::{Segment, Shape};
    use p2m_testkit::{rng, vector};

    /// Sites are added in the middle of a sphere before any ball is known to be crowded, and none are added
    /// over a plane.
    #[test]
    fn probable_sites_are_where_balls_are_crowded() {
        for is_sphere in [true, false] {
            let mut rng = rng("probable sites", 0);
            let shapes: Vec<Shape<f64>> = (0..3000)
                .map(|_| {
                    let [a, b] = [(); 2].map(|()| vector(&mut rng));
                    let [a, b] = if is_sphere {
                        [a.normalize(), (a.normalize() + b * 1e-3).normalize()]
                    } else {
                        [a, a + b * 1e-3].map(|mut p| {
                            p.z = 0.0;
                            p
                        })
                    };
                    Segment::new(Point3::from(a), Point3::from(b)).into()
                })
                .collect();
            let tree: PacketTree = PacketTree::build(&shapes[..], &SplitOptions::default());
            let delaunay = Delaunay::new(&tree.leaves.vertices, 300.0).expect("finite");
            let budget = &BuildBudget::new(1e6, 1e6, shapes.len());
            let limits = Limits { slack: 1e-9, max_list_packets: 256, max_added_sites: 100, parallel: false, budget };
            let bounds = Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) };
            let corners = compute_corners(&delaunay, false);
            let clusters = CrowdedClusters { tree: &tree, corners: &corners, bounds: &bounds, limits };
            let sites = clusters.choose_probable_sites(100);
            assert_eq!(!sites.is_empty(), is_sphere, "{}", sites.len());
            assert!(sites.iter().all(|site| site.anchor.is_some() && norm_squared(site.position).sqrt() < 0.5));
        }
    }
}
