//! Feet of perpendiculars on the faces of triangles, including slivers.

use super::arithmetic;
use super::double_double::Double;
use super::edge::{EDGES, EdgeLine, Foot};
use super::vector::{
    V3, add, add_scaled, clamp, combine, dot, exponent, larger, largest, lexicographically_less, norm_squared,
    power_of_two, scale_by_power, smaller, sub,
};

/// The greatest ratio, 2^-10, of height and longest edge of a sliver. The height of a sliver is computed in
/// double-double, which takes longer.
pub const SLIVER_SINE: f64 = 1.0 / 1024.0;
/// The square of [`SLIVER_SINE`].
const SLIVER_SINE_SQUARED: f64 = power_of_two(-20);
/// The square of 2^-57, the greatest ratio of height and longest edge of a needle. A needle is replaced by its edges:
/// no point of its face is farther from them than the height, which is at most u M / 8.
const NEEDLE_SINE_SQUARED: f64 = power_of_two(-114);
/// The weight 2^-49 below which the sign of a weight may be due to rounding.
const MIN_CERTAIN_WEIGHT: f64 = power_of_two(-49);
/// The square of the margin by which a face is rejected. First weights of ordinary faces have errors below 2^-38 of the
/// size of the offsets over the height, and the margin is wider. The errors of a sliver are larger by the ratio of
/// [`SLIVER_SINE`] and its own sine.
const REJECT_MARGIN_SQUARED: f64 = power_of_two(-72);
/// The largest factor of error with which a face is estimated: that of a height of 2^-22 of the longest edge.
const MAX_ERROR_FACTOR: f64 = power_of_two(24);

/// The axes of a triangle: the longest edge and the height over it.
///
/// They are orthogonal, so the weights are independent, and the error of a sliver is not multiplied by the inverse of
/// its sine. Only the height needs more precision, see [`sliver_axes`].
#[derive(Clone, Copy)]
struct Axes {
    /// The vector from the nearer end of the longest edge to the farther one.
    direction: V3,
    /// The number 1 / |direction|^2.
    inverse: f64,
    /// The vector from the longest edge to the apex, perpendicular to the edge.
    height: V3,
    /// The number 1 / |height|^2.
    inverse_height: f64,
    /// The position of the height on the edge: 0 at the nearer end, 1 at the farther one.
    along: f64,
}

impl Axes {
    /// Returns first weights of the foot for the nearer end `n`, the farther one and the apex, and n . height. `t` is
    /// the position of the foot on the longest edge.
    #[inline(always)]
    fn weights(&self, n: V3, t: f64) -> ([f64; 3], f64) {
        let projected = dot(n, self.height);
        let wa = -(projected * self.inverse_height);
        let wf = t - self.along * wa;
        ([(1.0 - wf) - wa, wf, wa], projected)
    }
}

/// The plane of a face, and a first estimate of the foot of the perpendicular from the origin.
pub(super) struct FacePlane {
    /// The nearer and the farther end of the longest edge, and the apex opposite to it.
    corners: [usize; 3],
    /// The axes in f64. They suffice for estimates, and for the foot unless the triangle is a sliver.
    axes: Axes,
    /// The vector from the nearer end to the apex.
    side: V3,
    /// The position of the foot on the longest edge.
    t: f64,
    /// First weights of the foot, in the order of `corners`.
    weights: [f64; 3],
    /// A first estimate of the squared length of the foot.
    square: f64,
    /// The factor by which errors of the estimates exceed those of ordinary faces: 1, or for slivers the square of the
    /// ratio of [`SLIVER_SINE`] and their own sine.
    error_factor: f64,
}

impl FacePlane {
    /// Estimates the foot, or returns `None` if it is certainly not inside of the face.
    #[inline(always)]
    pub(super) fn new(vertices: [V3; 3], lines: &[EdgeLine; 3], size: f64) -> Option<Self> {
        let base = longest_edge(vertices, lines);
        let line = &lines[base];
        let near = EDGES[base][line.near];
        let far = EDGES[base][1 - line.near];
        let apex = 3 - near - far;
        let n = vertices[near];

        let side = sub(vertices[apex], n);
        let along = dot(side, line.direction) * line.inverse;
        let height = add_scaled(side, -along, line.direction);
        let height_squared = norm_squared(height);
        let error_factor = larger(SLIVER_SINE_SQUARED / (height_squared * line.inverse), 1.0);
        let axes = Axes {
            direction: line.direction,
            inverse: line.inverse,
            height,
            inverse_height: 1.0 / height_squared,
            along,
        };
        let (weights, projected) = axes.weights(n, line.t);
        let least = smaller(smaller(weights[0], weights[1]), weights[2]);
        let plane = Self {
            corners: [near, far, apex],
            axes,
            side,
            t: line.t,
            weights,
            square: line.square + weights[2] * projected,
            error_factor,
        };
        let is_outside = plane.can_estimate()
            && least < 0.0
            && least * least * height_squared > REJECT_MARGIN_SQUARED * error_factor * (size * size);
        (!is_outside).then_some(plane)
    }

    /// Returns whether weights and square are usable estimates. They are not if the height may be rounding error alone.
    #[inline(always)]
    fn can_estimate(&self) -> bool {
        self.error_factor <= MAX_ERROR_FACTOR
    }

    /// Returns the estimated squared length of the foot, which is infinite if the foot seems to be outside, and
    /// the factor by which margins have to be wider than those of ordinary faces. Without an estimate the foot
    /// may be anywhere.
    #[inline(always)]
    pub(super) fn estimate(&self) -> (f64, f64) {
        if !self.can_estimate() {
            return (0.0, f64::INFINITY);
        }
        let is_inside = smaller(smaller(self.weights[0], self.weights[1]), self.weights[2]) > 0.0;
        (if is_inside { self.square } else { f64::INFINITY }, self.error_factor)
    }

    /// Returns whether the squared length of the foot may be at most `limit`.
    #[inline(always)]
    pub(super) fn may_be_within(&self, limit: f64) -> bool {
        self.square <= limit || !self.can_estimate()
    }

    /// Returns the foot if it lies strictly inside of the face: the point of the first weights, improved by one step
    /// along its residual.
    #[inline(always)]
    pub(super) fn foot(&self, vertices: [V3; 3], [low, high]: [V3; 2]) -> Option<Foot<3>> {
        let [n, f, a] = [vertices[self.corners[0]], vertices[self.corners[1]], vertices[self.corners[2]]];
        let is_sliver = self.error_factor > 1.0;
        let axes = if is_sliver { sliver_axes(&self.axes, n, f, a)? } else { self.axes };
        // The first weights of a sliver have large errors, since its height is small. Along the sides of the triangle
        // they would give large vectors that cancel; along the orthogonal axes nothing cancels.
        let (t, [_, wf, wa]) = (self.t, if is_sliver { axes.weights(n, self.t).0 } else { self.weights });
        let (first, second) = if is_sliver { (t, axes.height) } else { (wf, self.side) };
        let point = add(n, combine(first, axes.direction, wa, second));
        let step_d = -(dot(point, axes.direction) * axes.inverse);
        let step_h = -(dot(point, axes.height) * axes.inverse_height);
        let corrected_wa = wa + step_h;
        let wf = if is_sliver { (t + step_d) - axes.along * corrected_wa } else { wf + (step_d - axes.along * step_h) };
        let wa = corrected_wa;
        let wn = (1.0 - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        let is_inside = least > 0.0 && (least >= MIN_CERTAIN_WEIGHT || is_sliver || is_strictly_inside(n, f, a));
        if !is_inside {
            return None;
        }
        let point = add(point, combine(step_d, axes.direction, step_h, axes.height));
        let offset = clamp(point, low, high);
        let mut weights = [0.0; 3];
        (weights[self.corners[0]], weights[self.corners[1]], weights[self.corners[2]]) = (wn, wf, wa);
        Some(Foot { offset, square: norm_squared(offset), weights })
    }
}

/// Returns the longest edge. Of equal edges it is the one whose opposite vertex comes first in lexicographic order, so
/// that the choice does not depend on the order of the vertices.
#[inline(always)]
fn longest_edge(vertices: [V3; 3], lines: &[EdgeLine; 3]) -> usize {
    let mut best = 0;
    for i in 1..3 {
        // The longer edge has the smaller inverse square.
        let (x, y) = (lines[i].inverse, lines[best].inverse);
        if x < y || (x == y && lexicographically_less(vertices[(i + 2) % 3], vertices[(best + 2) % 3])) {
            best = i;
        }
    }
    best
}

/// Returns the axes with a height that is computed in double-double, or `None` for a needle, which is replaced by its
/// edges. The relative error of the height is below 2^-43.
#[cold]
fn sliver_axes(plain: &Axes, n: V3, f: V3, a: V3) -> Option<Axes> {
    let d: [Double; 3] = std::array::from_fn(|k| Double::difference(f[k], n[k]));
    let side: [Double; 3] = std::array::from_fn(|k| Double::difference(a[k], n[k]));
    let along = arithmetic::dot(side, d) / arithmetic::dot(d, d);
    let height = std::array::from_fn(|k| (side[k] - along * d[k]).round());
    let height_squared = norm_squared(height);
    let is_needle = height_squared * plain.inverse < NEEDLE_SINE_SQUARED;
    (!is_needle).then_some(Axes { height, inverse_height: 1.0 / height_squared, along: along.round(), ..*plain })
}

/// Returns whether the foot on the face has three positive weights, by double-double arithmetic. A foot exactly on an
/// edge belongs to the edge, which rounded weights might not show.
#[cold]
fn is_strictly_inside(n: V3, f: V3, a: V3) -> bool {
    // The weights are products of four lengths, which stay in range at the scale of the triangle.
    let scale = -exponent(largest(&[sub(f, n)]));
    let [n, f, a] = [n, f, a].map(|v| v.map(|x| scale_by_power(x, scale)));
    let edge = |to: V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(to[k], n[k])) };
    let (e, s) = (edge(f), edge(a));
    let to_query = n.map(|x| Double::difference(0.0, x));
    let [ee, es, ss] = [arithmetic::dot(e, e), arithmetic::dot(e, s), arithmetic::dot(s, s)];
    let [qe, qs] = [arithmetic::dot(to_query, e), arithmetic::dot(to_query, s)];
    // Cramer's rule gives every weight times the determinant.
    let wf = ss * qe - es * qs;
    let wa = ee * qs - es * qe;
    let wn = (ee * ss - es * es) - (wf + wa);
    // The products of four lengths have at least 95 correct bits, and `e` is the longest edge.
    let error = power_of_two(-95) * ee.round() * (ee.round() + (ee.round() * norm_squared(n)).sqrt());
    wn.round() > error && wf.round() > error && wa.round() > error
}
