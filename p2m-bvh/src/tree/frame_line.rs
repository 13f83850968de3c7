//! The line of a ray in the frame of a tree.
//!
//! The line is cut to the box of the scene and begins where it enters that box. So nodes can be clipped in f32 wherever
//! the ray comes from. [docs/proofs/rays.md] has the proofs.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use crate::packet::RayLine;
use crate::tree::frame::Frame;
use crate::tree::ray_slab::MIN_SLAB_GROWTH;
use p2m_core::engine::ray::UNDERFLOW_MARGIN;
use p2m_core::engine::vector::power_of_two;
use p2m_core::{Aabb, Ray};

/// A bound on the relative error of a few sums and products in f64.
const ROUNDING: f64 = power_of_two(-48);
/// A margin for further errors of positions in the frame, which is small compared with the rounding to f32.
const POSITION_MARGIN: f64 = power_of_two(-30);
/// The largest distance of an origin from the scene, in units of the frame, that f64 resolves well enough.
const MAX_ORIGIN_UNITS: f64 = power_of_two(30);
/// The largest radius of a ray, in units of the frame, for which the tree is searched.
const MAX_RADIUS_UNITS: f64 = 64.0;
/// The margin by which the box of the scene is enlarged on each side, in units of the frame.
const BOX_MARGIN: f64 = power_of_two(-20);

/// Returns whether a ray certainly misses the box of a scene with this half extent.
///
/// It does if it begins outside and moves away, or if the box lies on one side of its projection along an axis. Most
/// rays from far away end here.
#[inline(always)]
pub fn misses_scene(ray: &Ray, radius: f64, frame: &Frame, half_extent: &[f64; 3]) -> bool {
    let (o, d, c) = (&ray.origin, &ray.direction, &frame.centre);
    let towards = [c[0] - o[0], c[1] - o[1], c[2] - o[2]];
    // The half extent is enlarged for the rounding in this function and for parameters that underflow to zero. The
    // rounding of the centre is already included.
    let half =
        [0, 1, 2].map(|k: usize| half_extent[k] + o[k].abs() * ROUNDING + d[k].abs() * UNDERFLOW_MARGIN + radius);
    // All conditions are combined into one branch, because several branches would be mispredicted.
    let away = |k: usize| (towards[k] > half[k]) & (d[k] <= 0.0) | (towards[k] < -half[k]) & (d[k] >= 0.0);
    let goes_away = (ray.min >= 0.0) & (away(0) | away(1) | away(2));
    let is_beside = |i: usize, j: usize| {
        let offset = (towards[i] * d[j] - towards[j] * d[i]).abs();
        let least = half[i] * d[j].abs() + half[j] * d[i].abs();
        // An offset that overflowed excludes nothing.
        (offset > least + UNDERFLOW_MARGIN) & (offset <= f64::MAX)
    };
    goes_away | is_beside(0, 1) | is_beside(1, 2) | is_beside(2, 0)
}

/// Returns half of the extent of a scene along each axis, enlarged for the rounding of its centre and of
/// [`misses_scene`].
pub fn half_extent(frame: &Frame, bounds: &Aabb<f64>) -> [f64; 3] {
    let half = |k: usize| (bounds.max[k] * 0.5 - bounds.min[k] * 0.5) * (1.0 + MIN_SLAB_GROWTH);
    std::array::from_fn(|k| half(k) + frame.centre[k].abs() * ROUNDING + UNDERFLOW_MARGIN)
}

/// The piece of a line that lies in the box of a scene, in the frame of its nodes.
pub struct FrameLine {
    /// A point of the line where it begins, or before it enters the box.
    pub base: [f64; 3],
    /// The direction of the line, whose largest component is 1 or -1.
    pub direction: [f64; 3],
    /// A bound on the error of the base plus the radius of the ray.
    pub margin: f64,
    /// The length from the origin of the line to the base.
    base_length: f64,
    /// The length from the base to a point beyond the box.
    exit_length: f64,
    per_unit: f64,
}

impl FrameLine {
    /// Returns the line of a ray, with an origin near the scene.
    #[inline(always)]
    pub fn line_of(frame: &Frame, ray: &Ray, radius: f64) -> RayLine {
        let [x, y, z] = frame.place(&ray.origin).map(f64::abs);
        if x.max(y).max(z) <= MAX_ORIGIN_UNITS {
            RayLine::from_ray(ray, radius)
        } else {
            RayLine::from_afar(ray, radius, &frame.centre)
        }
    }

    /// Cuts a line to the box of the scene. The line begins at the length `from` from its origin.
    ///
    /// The result is `None` if f32 cannot represent the piece with enough accuracy, and `Some(None)` if no part of the
    /// line lies in the box.
    #[inline(always)]
    pub fn new(frame: &Frame, half_extent: &[f64; 3], line: &RayLine, from: f64) -> Option<Option<Self>> {
        let q = frame.place(&line.origin);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        let (origin_error, radius) = (line.origin_error * frame.per_unit, line.radius * frame.per_unit);
        if !(frame.is_plain() && radius <= MAX_RADIUS_UNITS) {
            return None;
        }
        // The origin is the projection of the centre of the scene onto a line that passes at a large distance. Rounding
        // moves it by much more than the size of the scene, but by less than that distance.
        if largest - origin_error > MAX_ORIGIN_UNITS {
            return Some(None);
        }
        let radius = radius + origin_error;
        if !(radius <= MAX_RADIUS_UNITS && largest <= MAX_ORIGIN_UNITS) {
            return None;
        }
        let from = from * frame.per_unit;
        let (mut enter, mut exit) = (from - from.abs() * ROUNDING - BOX_MARGIN, f64::INFINITY);
        for k in 0..3 {
            let d = line.direction[k];
            // The box is symmetric about the centre of the frame.
            let half = half_extent[k] * frame.per_unit + radius + BOX_MARGIN;
            // The scene is so far from the origin along this axis that the rounding of its centre exceeds its size.
            if half > 2.0 * MAX_RADIUS_UNITS {
                return None;
            }
            let [low, high] = [-half - q[k], half - q[k]];
            if d == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return Some(None);
                }
                continue;
            }
            let (near, far) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
            enter = enter.max(near);
            exit = exit.min(far);
        }
        if enter > exit {
            return Some(None);
        }
        let base = std::array::from_fn(|k| q[k] + enter * line.direction[k]);
        let margin = ROUNDING * (largest + enter.abs()) + POSITION_MARGIN + radius;
        Some(Some(Self {
            base,
            direction: line.direction,
            margin,
            base_length: enter,
            exit_length: exit - enter,
            per_unit: frame.per_unit,
        }))
    }

    /// Converts a length from the origin of the line to one from the base, in the frame, and rounds it up.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    pub fn limit(&self, length: f64) -> f32 {
        let length = length * self.per_unit;
        let from_base = length - self.base_length + (length.abs() + self.base_length.abs()) * ROUNDING;
        // An infinite length gives NaN, for which the comparison is false.
        let length = if from_base < self.exit_length { from_base } else { self.exit_length };
        // Bounds of nodes have a relative error of at most 2^-22.
        (length as f32) * (1.0 + 16.0 * f32::EPSILON) + f32::EPSILON
    }
}
