//! Points that are choose_sites to crowded balls.

use crate::voronoi::budget::Limits;
use crate::voronoi::corners::{CellCorner, CellCorners};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, exponent, scale_by_power};
use p2m_core::{Aabb, Best, QueryOptions};
use std::collections::{HashMap, HashSet};

/// Centres of so many balls beside each other are worth an auxiliary site.
const MIN_BALLS_FOR_AUXILIARY_SITE: usize = 3;
/// Points of the scene that are nearer to a centre than this part of the radius are choose_sites.
const DEEP_RADIUS_PART: f64 = 0.9;
/// Packets of a ball that are looked at for such points.
const MAX_EXAMINED_PACKETS: usize = 64;
/// AddedSite points lie in the box of the vertices, widened by this part of its widest side.
const BOX_PADDING_PART: f64 = 0.5;
/// Centres that are nearer to each other than about this part of the radius are one cluster.
const CLUSTER_RADIUS_PART: f64 = 0.25;
/// Those that are not known so well are left alone.
const MAX_ERROR_RADIUS_PART: f64 = 1e-3;
/// AddedSite points are apart by about this part of their distance to the centre of a ball, or of this part of its radius.
const SPACING_DISTANCE_PART: f64 = 0.5;
const MIN_SPACING_RADIUS_PART: f64 = 0.1;

/// A point that is choose_sites.
pub(crate) struct AddedSite {
    pub(crate) position: V3,
    /// For an auxiliary one a point of the scene.
    pub(crate) anchor: Option<V3>,
}

/// Balls that meet too much.
pub(crate) struct CrowdedClusters<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) corners: &'a CellCorners,
    pub(crate) bounds: &'a Aabb<f64>,
    pub(crate) limits: Limits<'a>,
}

/// A grid_cell of a grid: the exponent of its side, and its position.
type GridCell = (i32, [i64; 3]);

/// The grid_cell that has a position, of about `size`.
#[allow(clippy::cast_possible_truncation, reason = "rounded down; a cube that is too far away is another one")]
fn grid_cell(position: &V3, size: f64) -> GridCell {
    let exponent = exponent(size);
    (exponent, position.map(|x| (scale_by_power(x, -exponent)).floor() as i64))
}

impl CrowdedClusters<'_> {
    /// Points for them, at most `budget`.
    pub(crate) fn choose_sites(&self, budget: usize) -> Vec<AddedSite> {
        // Where their centres are, each time the first one and how many there are.
        let mut clusters: HashMap<GridCell, (usize, usize)> = HashMap::new();
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
        let mut taken: HashSet<GridCell> = HashSet::new();
        let mut choose_sites = Vec::new();
        for (number, count) in clusters {
            if choose_sites.len() >= budget || self.limits.budget.is_exceeded() {
                break;
            }
            let corner = &self.corners.all[number];
            let nearest_points = self.nearest_points(corner);
            let deep = nearest_points.partition_point(|(distance, _)| *distance < corner.radius * DEEP_RADIUS_PART);
            if let Some((_, anchor)) =
                nearest_points.first().filter(|_| deep == 0 && count >= MIN_BALLS_FOR_AUXILIARY_SITE)
            {
                choose_sites.push(AddedSite { position: corner.position, anchor: Some(*anchor) });
            }
            for &(distance, position) in &nearest_points[..deep] {
                if choose_sites.len() < budget
                    && taken.insert(grid_cell(
                        &position,
                        distance.max(corner.radius * MIN_SPACING_RADIUS_PART) * SPACING_DISTANCE_PART,
                    ))
                {
                    choose_sites.push(AddedSite { position, anchor: None });
                }
            }
        }
        choose_sites
    }

    /// Whether a position is in the box of the vertices, or a little beside it.
    fn is_near_scene(&self, position: &V3) -> bool {
        let Aabb { min, max } = self.bounds;
        let pad = (max - min).max() * BOX_PADDING_PART;
        (0..3).all(|k| position[k] >= min[k] - pad && position[k] <= max[k] + pad)
    }

    /// The points of primitives that are nearest to a corner, with their distances, the nearest one first: of some that
    /// meet its ball.
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
