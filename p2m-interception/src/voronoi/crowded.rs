//! The choice of sites that are added because of crowded balls.
//!
//! The basic idea is to look at clusters of balls instead of single ones, because around the centre of a round shape
//! thousands of balls are nearly the same. A hash grid, whose cells are about a quarter of the radius wide, groups the
//! corners into clusters. For the first corner of each cluster, the points of the scene in its ball are found:
//!
//! - If some points lie deep inside the ball, they become sites. A second hash grid, whose cells grow with the distance
//!   from the corner, keeps only one of those that are close together.
//! - If no point lies deep inside and the cluster has several balls, the corner itself becomes an auxiliary site.
//!
//! No record exists of the scenes on which the constants below were chosen; docs/decisions/018-added-sites.md has the
//! rule.

use crate::voronoi::budget::Limits;
use crate::voronoi::corner::CellCorner;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, exponent, scale_by_power};
use p2m_core::{Aabb, Best, QueryOptions};
use rustc_hash::{FxHashMap, FxHashSet};

/// The least number of crowded balls in a cluster whose centre becomes an auxiliary site.
const MIN_BALLS_FOR_AUXILIARY_SITE: usize = 3;
/// The fraction of the radius within which a point of the scene lies deep inside a ball, and is added.
const DEEP_RADIUS_PART: f64 = 0.9;
/// The largest number of packets of a ball in which deep points are looked for.
const MAX_EXAMINED_PACKETS: usize = 64;
/// The padding of the box in which points are added, as a fraction of the longest side of the box of the vertices.
const BOX_PADDING_PART: f64 = 0.5;
/// The size of a cluster, as a fraction of the radius: centres closer than about this are in one cluster.
const CLUSTER_RADIUS_PART: f64 = 0.25;
/// The largest error of a corner that is used, as a fraction of its radius.
const MAX_ERROR_RADIUS_PART: f64 = 1e-3;
/// The spacing of added points, as a fraction of their distance from the centre of the ball.
const SPACING_DISTANCE_PART: f64 = 0.5;
/// The smallest distance from which the spacing is computed, as a fraction of the radius.
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

    /// Chooses points, at most `budget` of them, before it is known which balls are crowded. A cluster counts as
    /// crowded if its first ball is. This takes one search per cluster instead of one per ball, and later
    /// triangulations show which balls it missed.
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

    /// Returns the nearest point of each of some primitives that intersect the ball of a corner, with its distance from
    /// the corner, nearest first.
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
