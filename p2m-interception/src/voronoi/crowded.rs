//! The choice of sites that are added because of crowded balls.

use crate::voronoi::budget::Limits;
use crate::voronoi::corners::{CellCorner, CellCorners};
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
    pub(crate) corners: &'a CellCorners,
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
        // Each cluster is stored as its first corner and the number of its corners.
        let mut clusters: FxHashMap<GridCell, (usize, usize)> = FxHashMap::default();
        for (number, corner) in self.corners.all.iter().enumerate() {
            if corner.is_crowded
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
        let mut occupied_cells: FxHashSet<GridCell> = FxHashSet::default();
        let mut added = Vec::new();
        for (number, count) in clusters {
            if added.len() >= budget || self.limits.budget.is_exceeded() {
                break;
            }
            let corner = &self.corners.all[number];
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
