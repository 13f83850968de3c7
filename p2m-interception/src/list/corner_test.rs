//! The corner test: it excludes primitives that cannot beat a dominator anywhere in a convex cell.
//!
//! Let C be a convex cell with corners x_i, y a point of the scene (a *dominator*), t a closed set and s >= 0. If
//! d(x_i, t) > |x_i - y| + s at all corners, then d(q, t) > |q - y| + s for every q in C. The reason is that the
//! difference of the squares, `d(q, t)^2 - (|q - y| + s)^2`, is concave, as an infimum of affine functions minus a
//! convex function, so its minimum over C is at a corner (docs/proofs/octree.md). Therefore t is never the answer in C:
//! the primitive that y belongs to is nearer, by more than all rounding if s is large enough. The same y has to serve
//! at all corners, but several dominators may be tried in turn.
//!
//! The filters of packets and boxes bound the distances from corners to primitives, so the test keeps too many
//! primitives rather than too few.

use nalgebra::Point3;
use p2m_bvh::engine::packet::{LANES, Packet, at_most, smallest};
use p2m_core::Aabb;
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// A corner of a cell with a dominator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// The position of the corner.
    pub(crate) x: V3,
    /// The point of the scene that is nearest to the corner, or nearly so. It is infinite if the scene has no points.
    pub(crate) y: V3,
}

/// The eight corners of a cell with their distances to all dominators.
pub(crate) struct Dominators {
    /// The distances, rounded up and increased by the slack s: one row of eight corners for each dominator.
    pub(crate) rows: [[f64; 8]; 8],
    /// The number of dominators, which is the number of rows in use.
    pub(crate) count: usize,
}

/// A factor that exceeds the rounding of a distance in f64 by far.
const DISTANCE_ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

impl Dominators {
    /// Collects the dominators at eight corners, each once. `slack` is the s of the corner test.
    pub(crate) fn from_corners(corners: &[Corner; 8], slack: f64) -> Self {
        let mut points: [V3; 8] = [[0.0; 3]; 8];
        let mut count = 0;
        for corner in corners {
            if corner.y[0].is_finite() && !points[..count].contains(&corner.y) {
                points[count] = corner.y;
                count += 1;
            }
        }
        let mut rows = [[f64::INFINITY; 8]; 8];
        for (row, y) in rows.iter_mut().zip(&points[..count]) {
            for (to, corner) in row.iter_mut().zip(corners) {
                *to = norm_squared(sub(corner.x, *y)).sqrt() * DISTANCE_ROUND_UP + slack;
            }
        }
        Self { rows, count }
    }

    /// Returns whether anything in a box can be nearer than all dominators somewhere in the cell.
    pub(crate) fn keeps_box(&self, corners: &[Corner; 8], bounds: &Aabb<f64>) -> bool {
        let squared = corners.map(|c| bounds.lower_bound(&Point3::from(c.x)));
        // The lower bound of a box is too large by a few roundings at most. A loop without branches is vectorized.
        let is_near =
            |row: &[f64; 8]| (0..8).fold(false, |near, i| near | (squared[i] <= row[i] * row[i] * DISTANCE_ROUND_UP));
        self.rows[..self.count].iter().all(is_near)
    }
}

/// The distances from one point to the lanes of a packet, as the filter of the packet finds them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneDistances {
    /// The squared distances in the unit of the packet, lane by lane. All are zero if the filter cannot be used
    /// at the point.
    pub(crate) squared: [f32; LANES],
    /// The amount by which the filter may exceed the true distance, in the unit of the packet
    /// ([`Local`](p2m_bvh::engine::packet::Local)).
    pub(crate) error_above: f32,
}

impl LaneDistances {
    /// The distances from a point at which the filter cannot be used.
    pub(crate) const UNKNOWN: Self = Self { squared: [0.0; LANES], error_above: f32::INFINITY };
}

/// A SIMD kernel that runs the filter of a packet at a point. It returns the distances, and an upper bound of the
/// distance to the nearest lane with that lane. The latter is `None` if the filter cannot be used.
pub(crate) struct DistancesAtPoint<'a> {
    /// The packet whose lanes are tested.
    pub(crate) packet: &'a Packet,
    /// The point, in coordinates of the scene.
    pub(crate) point: &'a V3,
}

impl SimdKernel for DistancesAtPoint<'_> {
    type Output = (LaneDistances, Option<(f64, usize)>);

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Self::Output {
        let Self { packet, point } = self;
        let Some(local) = packet.local(point) else { return (LaneDistances::UNKNOWN, None) };
        let mut squared = [0.0; LANES];
        packet.squares::<I>(&local, f32::INFINITY, &mut squared);
        let mut nearest = None;
        if packet.has_vertices() {
            let least = smallest::<I::Wide>(&squared);
            let lane = (at_most::<I::Wide>(&squared, least)).trailing_zeros() as usize;
            nearest = Some((f64::from(least.sqrt() + local.deficit) * packet.unit(), lane));
        }
        (LaneDistances { squared, error_above: local.excess }, nearest)
    }
}

/// A SIMD kernel that calls [`Packet::lanes_of_nearest_vertices`].
pub(crate) struct NearestVertices<'a> {
    pub(crate) packet: &'a Packet,
    pub(crate) centre: &'a V3,
    pub(crate) half: f64,
}

impl SimdKernel for NearestVertices<'_> {
    type Output = [u32; 3];

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [u32; 3] {
        self.packet.lanes_of_nearest_vertices::<I>(self.centre, self.half)
    }
}

/// Returns a lower bound of the distance to the nearest of some lanes of a packet, in its unit, given the squared
/// distances that the filter finds and the amount by which they may exceed the true ones. `exclusion` is zero for these
/// lanes and infinite for the others.
#[inline(always)]
pub(crate) fn least_of_lanes<I: InstructionSet>(
    squared: &[f32; LANES],
    error_above: f32,
    exclusion: &[f32; LANES],
) -> f64 {
    let mut sums = [0.0; LANES];
    for lane in 0..LANES {
        sums[lane] = squared[lane] + exclusion[lane];
    }
    // The factor lowers the bound by the rounding of the root.
    let distance = f64::from(smallest::<I::Wide>(&sums)).sqrt() * (1.0 - 4.0 * f64::EPSILON);
    (distance - f64::from(error_above)).max(0.0)
}

/// Returns zero for each lane that has a bit, and infinity for the others.
#[inline(always)]
pub(crate) fn exclusion_of(lanes: u16) -> [f32; LANES] {
    let mut exclusion = [0.0; LANES];
    for (lane, other) in exclusion.iter_mut().enumerate() {
        *other = if lanes >> lane & 1 == 1 { 0.0 } else { f32::INFINITY };
    }
    exclusion
}

/// A SIMD kernel that calls [`least_of_lanes`] for some lanes.
pub(crate) struct LeastOfLanes<'a> {
    pub(crate) distances: &'a LaneDistances,
    pub(crate) lanes: u16,
}

impl SimdKernel for LeastOfLanes<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> f64 {
        let Self { distances: LaneDistances { squared, error_above }, lanes } = self;
        least_of_lanes::<I>(squared, *error_above, &exclusion_of(lanes))
    }
}
