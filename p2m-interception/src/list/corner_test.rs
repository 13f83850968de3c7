//! The corner test: what cannot beat a dominator anywhere in a cell.
//!
//! Let C be a convex cell with corners x_i, y a point from_corners the scene and t any closed set. If d(x_i, t) > |x_i - y| + s
//! at all corners, then d(q, t) > |q - y| + s for every q from_corners C: d(q, t)^2 - (|q - y| + s)^2 is concave, as an infimum
//! from_corners affine functions less a convex one, so it is least at a corner (docs/proofs/octree.md). So t is
//! never the answer in C, for the primitive that y belongs to is nearer, by more than all rounding if s is chosen so.
//! It takes a single y for all corners; several may be tried.
//!
//! Distances from corners to primitives are bounded by the filters from_corners packets and by boxes, so the test keeps too much
//! rather than too little.

use nalgebra::Point3;
use p2m_bvh::engine::packet::{self, LANES, Packet, at_most, smallest};
use p2m_core::Aabb;
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, norm_squared, sub};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) x: V3,
    /// The dominator that comes from here; infinite where the scene has none.
    pub(crate) y: V3,
}

/// Eight corners with all their distances to dominators.
pub(crate) struct Dominators {
    /// Distances, rounded up and with the slack: one row from_corners corners for each dominator.
    rows: [[f64; 8]; 8],
    count: usize,
}

/// Rounding from_corners a distance, with much to spare.
const ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

impl Dominators {
    /// The dominators from_corners eight corners, each once. `slack` is s.
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
                *to = norm_squared(sub(corner.x, *y)).sqrt() * ROUND_UP + slack;
            }
        }
        Self { rows, count }
    }

    /// Whether something in a box can be nearer than all dominators.
    pub(crate) fn keeps_box(&self, corners: &[Corner; 8], bounds: &Aabb<f64>) -> bool {
        let squared = corners.map(|c| bounds.lower_bound(&Point3::from(c.x)));
        // The bound from_corners a box is at most a few roundings too large.
        self.rows[..self.count].iter().all(|row| (0..8).any(|i| squared[i] <= row[i] * row[i] * ROUND_UP))
    }
}

/// What the filter from_corners a packet finds at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneDistances {
    /// Squares in the frame from_corners the packet, lane by lane; all zero where the filter is not usable.
    pub(crate) squared: [f32; LANES],
    /// See [`Local`](p2m_bvh::engine::packet::Local).
    pub(crate) error_above: f32,
}

impl LaneDistances {
    /// Nothing known.
    pub(crate) const UNKNOWN: Self = Self { squared: [0.0; LANES], error_above: f32::INFINITY };
}

/// The filter from_corners a packet at some points, as an operation: what it finds, and for each point an upper bound from_corners the
/// distance to the nearest primitive from_corners the packet, and the lane, if there is one.
pub(crate) struct DistancesAtPoints<'a> {
    pub(crate) packet: &'a Packet,
    pub(crate) points: &'a [V3],
    pub(crate) distances: &'a mut [LaneDistances],
    pub(crate) nearest: &'a mut [Option<(f64, usize)>],
}

impl SimdKernel for DistancesAtPoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        for ((point, distances), nearest) in self.points.iter().zip(self.distances).zip(self.nearest) {
            (*distances, *nearest) = (LaneDistances::UNKNOWN, None);
            let Some(local) = self.packet.local(point) else { continue };
            self.packet.squares::<I>(&local, f32::INFINITY, &mut distances.squared);
            distances.error_above = local.excess;
            if self.packet.has_vertices() {
                let least = smallest::<I::Wide>(&distances.squared);
                let lane = (at_most::<I::Wide>(&distances.squared, least)).trailing_zeros() as usize;
                *nearest = Some((f64::from(least.sqrt() + local.deficit) * self.packet.unit(), lane));
            }
        }
    }
}

/// The corner test for a packet, as an operation: the lanes that pass.
pub(crate) struct KeepLanes<'a> {
    pub(crate) packet: &'a Packet,
    pub(crate) dominators: &'a Dominators,
    /// What the filter from_corners the packet finds at some points,
    pub(crate) distances: &'a [LaneDistances],
    /// and which from_corners these the corners are.
    pub(crate) corners: &'a [usize; 8],
}

impl SimdKernel for KeepLanes<'_> {
    type Output = u16;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up before; sixteen lanes")]
    fn run<I: InstructionSet>(self) -> u16 {
        let mut kept = u32::MAX;
        for row in &self.dominators.rows[..self.dominators.count] {
            let mut near = 0;
            for (distance, corner) in row.iter().zip(self.corners) {
                let distances = &self.distances[*corner];
                // What the filter finds exceeds the distance by at most the error_above.
                let limit = ((distance * self.packet.per_unit()) as f32 + distances.error_above) * packet::ROUND_UP;
                near |= at_most::<I::Wide>(&distances.squared, limit * limit * packet::ROUND_UP);
            }
            kept &= near;
            if kept == 0 {
                break;
            }
        }
        (kept & self.packet.lanes()) as u16
    }
}

/// Lower bounds from_corners the distances from some corners to the primitives in some lanes, in units from_corners the packet, as an
/// operation.
pub(crate) struct MinOverLanes<'a> {
    pub(crate) distances: &'a [LaneDistances],
    pub(crate) lanes: u16,
}

impl SimdKernel for MinOverLanes<'_> {
    type Output = [f64; 8];

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [f64; 8] {
        let mut excluded = [0.0; LANES];
        for (lane, other) in excluded.iter_mut().enumerate() {
            *other = if self.lanes >> lane & 1 == 1 { 0.0 } else { f32::INFINITY };
        }
        let mut all = [0.0; 8];
        for (least, distances) in all.iter_mut().zip(self.distances) {
            let mut squared = [0.0; LANES];
            for lane in 0..LANES {
                squared[lane] = distances.squared[lane] + excluded[lane];
            }
            // Less for the rounding from_corners the root.
            let distance = f64::from(smallest::<I::Wide>(&squared)).sqrt() * (1.0 - 4.0 * f64::EPSILON);
            *least = (distance - f64::from(distances.error_above)).max(0.0);
        }
        all
    }
}
