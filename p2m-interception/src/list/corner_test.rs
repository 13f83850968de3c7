//! The corner test: it excludes primitives that cannot beat a dominator anywhere in a convex cell.
//!
//! Let C be a convex cell with corners x_i, y a point of the scene (a *dominator*), t a closed set and s >= 0. If
//! d(x_i, t) > |x_i - y| + s at all corners, then d(q, t) > |q - y| + s for every q in C. The reason is that the
//! difference of the squares, `d(q, t)^2 - (|q - y| + s)^2`, is concave, as an infimum of affine functions minus a
//! convex function, so its minimum over C is at a corner ([docs/proofs/octree.md]). Therefore t is never the answer in
//! C: the primitive that y belongs to is nearer, by more than all rounding if s is large enough. The same y has to
//! serve at all corners, but several dominators may be tried in turn.
//!
//! The filters of packets and boxes bound the distances from corners to primitives, so the test keeps too many
//! primitives rather than too few.
//!
//! [docs/proofs/octree.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/octree.md

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
}

/// The corner test of boxes in a cube.
pub(crate) struct BoxTest {
    /// The corners of the cube with the lowest and with the highest coordinates.
    ends: [V3; 2],
    /// The squared distances up to which a box is kept: one row of eight corners for each dominator.
    limits: [[f64; 8]; 8],
    /// The number of dominators.
    count: usize,
}

impl BoxTest {
    /// Prepares the test, given the corners of a cube. A corner has the higher coordinate on axis k if bit k of its
    /// number is set.
    pub(crate) fn new(dominators: &Dominators, corners: &[Corner; 8]) -> Self {
        // The lower bound of a box is too large by at most a few roundings.
        let limits = dominators.rows.map(|row| row.map(|distance| distance * distance * DISTANCE_ROUND_UP));
        Self { ends: [corners[0].x, corners[7].x], limits, count: dominators.count }
    }

    /// Returns whether anything in a box can be nearer than all dominators somewhere in the cube.
    pub(crate) fn keeps(&self, bounds: &Aabb<f64>) -> bool {
        // Corners share their coordinates, so there are only two distances on each axis.
        let square = |k: usize, x: f64| {
            let outside = (bounds.min[k] - x).max(x - bounds.max[k]).max(0.0);
            outside * outside
        };
        let squares: [V3; 2] = self.ends.map(|end| std::array::from_fn(|k| square(k, end[k])));
        let squared: [f64; 8] =
            std::array::from_fn(|i| squares[i & 1][0] + squares[i >> 1 & 1][1] + squares[i >> 2][2]);
        // A loop without branches is vectorized.
        let is_near = |row: &[f64; 8]| (0..8).fold(false, |near, i| near | (squared[i] <= row[i]));
        self.limits[..self.count].iter().all(is_near)
    }
}

/// The distances from one point to the lanes of a packet, computed by the filter of the packet.
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

/// A SIMD kernel that runs the filter of a packet at a point. It returns the distances, and the lane with the least
/// upper bound on its distance, with that bound. The latter is `None` if the filter cannot be used.
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

/// Returns a lower bound on the distance from a point to the nearest of some lanes of a packet, in the unit of the
/// packet. It takes the squared distances that the filter computed, and the amount by which they may exceed the true
/// ones. `exclusion` is zero for these lanes and infinite for the others.
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};
    use p2m_testkit::rng;
    use rand::RngExt;

    #[test]
    fn boxes_are_kept_by_the_definition() {
        let mut rng = rng("boxes in cubes", 0);
        let (mut kept, mut tests) = (0, 0);
        for round in 0..2_000 {
            let (low, side) = ([0; 3].map(|_| rng.random_range(-1.0..1.0)), rng.random_range(0.1..1.0));
            let corners: [Corner; 8] = std::array::from_fn(|c| Corner {
                x: std::array::from_fn(|k| low[k] + if c >> k & 1 == 1 { side } else { 0.0 }),
                y: if round % 9 == c { [f64::INFINITY; 3] } else { [0; 3].map(|_| rng.random_range(-1.5..1.5)) },
            });
            let dominators = Dominators::from_corners(&corners, 1e-3);
            let test = BoxTest::new(&dominators, &corners);
            for _ in 0..20 {
                let min = Point3::from([0; 3].map(|_| rng.random_range(-3.0..3.0)));
                let bounds = Aabb { min, max: min + Vector3::from([0; 3].map(|_| rng.random_range(0.0..0.5))) };
                let is_near = |y: &V3| {
                    let limit = |x: &V3| norm_squared(sub(*x, *y)).sqrt() + 1e-3;
                    corners.iter().any(|c| bounds.lower_bound(&Point3::from(c.x)).sqrt() <= limit(&c.x) * (1.0 + 1e-14))
                };
                let expected = corners.iter().filter(|c| c.y[0].is_finite()).all(|c| is_near(&c.y));
                assert_eq!(test.keeps(&bounds), expected, "{corners:?} {bounds:?}");
                (kept, tests) = (kept + usize::from(expected), tests + 1);
            }
        }
        assert!(kept * 10 > tests && kept * 10 < 9 * tests, "{kept} of {tests}");
    }
}
