//! Points that are added to crowded balls.

use crate::voronoi::budget::Limits;
use crate::voronoi::corners::{Corner, Corners};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, exponent, scale_by_power};
use p2m_core::{Aabb, Best, QueryOptions};
use std::collections::{HashMap, HashSet};

/// Centres of so many balls beside each other are worth an auxiliary site.
const CLUSTER: usize = 3;
/// Points of the scene that are nearer to a centre than this part of the radius are added.
const DEEP: f64 = 0.9;
/// Packets of a ball that are looked at for such points.
const LOOKED_AT: usize = 64;
/// Added points lie in the box of the vertices, widened by this part of its widest side.
const BESIDE: f64 = 0.5;
/// Centres that are nearer to each other than about this part of the radius are one cluster.
const CLOSE: f64 = 0.25;
/// Those that are not known so well are left alone.
const BARELY: f64 = 1e-3;
/// Added points are apart by about this part of their distance to the centre of a ball, or of this part of its radius.
const APART: f64 = 0.5;
const LEAST: f64 = 0.1;

/// A point that is added.
pub(crate) struct Added {
    pub(crate) place: V3,
    /// For an auxiliary one a point of the scene.
    pub(crate) anchor: Option<V3>,
}

/// Balls that meet too much.
pub(crate) struct Crowds<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) corners: &'a Corners,
    pub(crate) bounds: &'a Aabb<f64>,
    pub(crate) limits: Limits<'a>,
}

/// A cube of a grid: the exponent of its side, and its place.
type Cube = (i32, [i64; 3]);

/// The cube that has a place, of about `size`.
#[allow(clippy::cast_possible_truncation, reason = "rounded down; a cube that is too far away is another one")]
fn cube(place: &V3, size: f64) -> Cube {
    let exponent = exponent(size);
    (exponent, place.map(|x| (scale_by_power(x, -exponent)).floor() as i64))
}

impl Crowds<'_> {
    /// Points for them, at most `budget`.
    pub(crate) fn added(&self, budget: usize) -> Vec<Added> {
        // Where their centres are, each time the first one and how many there are.
        let mut clusters: HashMap<Cube, (usize, usize)> = HashMap::new();
        for (number, corner) in self.corners.all.iter().enumerate() {
            if corner.full
                && corner.radius > 0.0
                && self.is_near(&corner.place)
                && corner.error < corner.radius * BARELY
            {
                clusters.entry(cube(&corner.place, corner.radius * CLOSE)).or_insert((number, 0)).1 += 1;
            }
        }
        let mut clusters: Vec<(usize, usize)> = clusters.into_values().collect();
        clusters.sort_unstable();
        let mut taken: HashSet<Cube> = HashSet::new();
        let mut added = Vec::new();
        for (number, count) in clusters {
            if added.len() >= budget || self.limits.allowance.is_over() {
                break;
            }
            let corner = &self.corners.all[number];
            let near = self.near(corner);
            let deep = near.partition_point(|(distance, _)| *distance < corner.radius * DEEP);
            if let Some((_, anchor)) = near.first().filter(|_| deep == 0 && count >= CLUSTER) {
                added.push(Added { place: corner.place, anchor: Some(*anchor) });
            }
            for &(distance, place) in &near[..deep] {
                if added.len() < budget && taken.insert(cube(&place, distance.max(corner.radius * LEAST) * APART)) {
                    added.push(Added { place, anchor: None });
                }
            }
        }
        added
    }

    /// Whether a place is in the box of the vertices, or a little beside it.
    fn is_near(&self, place: &V3) -> bool {
        let Aabb { min, max } = self.bounds;
        let pad = (max - min).max() * BESIDE;
        (0..3).all(|k| place[k] >= min[k] - pad && place[k] <= max[k] + pad)
    }

    /// The points of primitives that are nearest to a corner, with their distances, the nearest one first: of some that
    /// meet its ball.
    fn near(&self, corner: &Corner) -> Vec<(f64, V3)> {
        let leaves = &self.tree.leaves;
        let (mut met, mut tests) = (Vec::new(), 0);
        self.tree.ball(corner.place, corner.radius + 2.0 * corner.error, LOOKED_AT, &mut met, &mut tests);
        let mut points = Vec::new();
        for Selection { packet, lanes } in met {
            let packet = &leaves.packets[packet as usize];
            for lane in (0..LANES).filter(|lane| packet.has_vertices() && lanes >> lane & 1 == 1) {
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &leaves.vertices, corner.place, f64::INFINITY, &mut best);
                points.extend(best.finish().map(|closest| (closest.distance, closest.point.coords.into())));
            }
        }
        self.limits.allowance.spend(tests + points.len());
        points.sort_by(|a: &(f64, V3), b| a.0.total_cmp(&b.0));
        points
    }
}
