//! Projections onto the faces of triangles, including slivers: feet of perpendiculars.

use super::arithmetic;
use super::double_double::Double;
use super::edge::{EDGES, EdgeLine};
use super::vector::{
    V3, add, add_scaled, clamp, combine, dot, exponent, larger, largest, lexicographically_less, norm_squared,
    power_of_two, scale_by_power, smaller, sub,
};
use crate::simd::Float;

/// The largest ratio of height to longest edge, 2^-10, at which a triangle counts as a sliver. The height of a sliver
/// is computed in double-double, which takes longer.
pub const SLIVER_SINE: f64 = 1.0 / 1024.0;
/// The square of [`SLIVER_SINE`].
const SLIVER_SINE_SQUARED: f64 = power_of_two(-20);
/// The square of 2^-57, the largest ratio of height to longest edge at which a triangle counts as a needle. A needle is
/// replaced by its edges: no point of its face is farther from them than the height, which is at most u M / 8.
const NEEDLE_SINE_SQUARED: f64 = power_of_two(-114);
/// The weight, 2^-49, below which rounding may change the sign of a weight.
pub(super) const MIN_CERTAIN_WEIGHT: f64 = power_of_two(-49);
/// The square of the margin by which a face is rejected. First weights of ordinary faces have errors below 2^-38 of the
/// size of the offsets over the height, and the margin is wider. The errors of a sliver are larger by the ratio of
/// [`SLIVER_SINE`] to its own sine.
const REJECT_MARGIN_SQUARED: f64 = power_of_two(-72);
/// The largest error factor for which a face is estimated. It belongs to a height of 2^-22 of the longest edge.
const MAX_ERROR_FACTOR: f64 = power_of_two(24);

/// The axes of a triangle: its longest edge and the height over it.
///
/// They are orthogonal, so the weights are independent, and the error of a sliver is not multiplied by the inverse of
/// its sine. Only the height needs more precision, see [`sliver_axes`].
#[derive(Clone, Copy)]
struct Axes<T> {
    /// The vector from the nearer end of the longest edge to the farther one.
    direction: [T; 3],
    /// The number 1 / |direction|^2.
    inverse: T,
    /// The vector from the longest edge to the apex, perpendicular to the edge.
    height: [T; 3],
    /// The number 1 / |height|^2.
    inverse_height: T,
    /// The position of the height on the edge: 0 at the nearer end, 1 at the farther one.
    along: T,
}

impl<T: Float> Axes<T> {
    /// Returns first estimates of the weights of the foot for the nearer end `n`, the farther end and the apex, and n .
    /// height. `t` is the position of the foot on the longest edge.
    #[inline(always)]
    fn weights(&self, n: [T; 3], t: T) -> ([T; 3], T) {
        let projected = dot(n, self.height);
        let wa = -(projected * self.inverse_height);
        let wf = t - self.along * wa;
        ([(T::splat(1.0) - wf) - wa, wf, wa], projected)
    }

    /// Returns the point n + first direction + wa second, and the steps along both axes from that point to the foot.
    #[inline(always)]
    fn improve(&self, n: [T; 3], first: T, wa: T, second: [T; 3]) -> ([T; 3], [T; 2]) {
        let point = add(n, combine(first, self.direction, wa, second));
        let step_d = -(dot(point, self.direction) * self.inverse);
        let step_h = -(dot(point, self.height) * self.inverse_height);
        (point, [step_d, step_h])
    }

    /// Returns the foot, given a nearby point and the steps from it to the foot.
    #[inline(always)]
    fn finish(
        &self,
        point: [T; 3],
        [step_d, step_h]: [T; 2],
        [low, high]: [[T; 3]; 2],
        weights: [T; 3],
    ) -> FaceFoot<T> {
        let point = add(point, combine(step_d, self.direction, step_h, self.height));
        let offset = clamp(point, low, high);
        FaceFoot { offset, square: norm_squared(offset), weights }
    }
}

/// The plane of a face, and a first estimate of the foot of the perpendicular from the origin.
///
/// Its vertices are in the order of [`Corners`]: the nearer end n and the farther end f of the longest edge, and
/// the apex a.
pub(super) struct FacePlane<T> {
    /// The axes in f64. They suffice for estimates, and for the foot unless the triangle is a sliver.
    axes: Axes<T>,
    /// The vector from the nearer end to the apex.
    side: [T; 3],
    /// The position of the foot on the longest edge.
    t: T,
    /// First estimates of the weights of the foot.
    weights: [T; 3],
    /// A first estimate of the squared length of the foot.
    square: T,
    /// The factor by which errors of the estimates exceed the errors of ordinary faces. It is 1, or for slivers the
    /// square of the ratio of [`SLIVER_SINE`] to their own sine.
    error_factor: T,
}

impl<T: Float> FacePlane<T> {
    /// Estimates the foot, given the longest edge, its nearer end and the apex. Also returns whether the foot is
    /// certainly outside of the face.
    #[inline(always)]
    pub(super) fn new(line: &EdgeLine<T>, n: [T; 3], apex: [T; 3], size: T) -> (Self, T::Mask) {
        let side = sub(apex, n);
        let along = dot(side, line.direction) * line.inverse;
        let height = add_scaled(side, -along, line.direction);
        let height_squared = norm_squared(height);
        let error_factor = larger(T::splat(SLIVER_SINE_SQUARED) / (height_squared * line.inverse), T::splat(1.0));
        let axes = Axes {
            direction: line.direction,
            inverse: line.inverse,
            height,
            inverse_height: T::splat(1.0) / height_squared,
            along,
        };
        let (weights, projected) = axes.weights(n, line.t);
        let least = smaller(smaller(weights[0], weights[1]), weights[2]);
        let square = line.square + weights[2] * projected;
        let plane = Self { axes, side, t: line.t, weights, square, error_factor };
        let margin = T::splat(REJECT_MARGIN_SQUARED) * error_factor * (size * size);
        let is_outside =
            plane.can_estimate() & least.is_below(T::splat(0.0)) & margin.is_below(least * least * height_squared);
        (plane, is_outside)
    }

    /// Returns whether the weights and the square are usable estimates. They are not if the height may be pure rounding
    /// error.
    #[inline(always)]
    fn can_estimate(&self) -> T::Mask {
        self.error_factor.is_at_most(T::splat(MAX_ERROR_FACTOR))
    }

    /// Returns whether the triangle is a sliver.
    #[inline(always)]
    pub(super) fn is_sliver(&self) -> T::Mask {
        T::splat(1.0).is_below(self.error_factor)
    }

    /// Returns the estimated squared length of the foot, and the factor by which margins have to be wider than for
    /// ordinary faces. The square is infinite if the foot seems to be outside. Without an estimate the foot may be
    /// anywhere.
    #[inline(always)]
    pub(super) fn estimate(&self) -> (T, T) {
        let is_inside = T::splat(0.0).is_below(smaller(smaller(self.weights[0], self.weights[1]), self.weights[2]));
        let square = T::select(is_inside, self.square, T::splat(f64::INFINITY));
        let can_estimate = self.can_estimate();
        (
            T::select(can_estimate, square, T::splat(0.0)),
            T::select(can_estimate, self.error_factor, T::splat(f64::INFINITY)),
        )
    }

    /// Returns whether the squared length of the foot may be at most `limit`.
    #[inline(always)]
    pub(super) fn may_be_within(&self, limit: T) -> T::Mask {
        self.square.is_at_most(limit) | !self.can_estimate()
    }

    /// Returns the foot on a face that is not a sliver: the point of the first weights, improved by one step along its
    /// residual. Also returns the least weight. Its sign tells whether the foot is inside of the face, unless the
    /// weight is below [`MIN_CERTAIN_WEIGHT`].
    #[inline(always)]
    pub(super) fn ordinary_foot(&self, n: [T; 3], bounds: [[T; 3]; 2]) -> (FaceFoot<T>, T) {
        let [_, wf, wa] = self.weights;
        let (point, [step_d, step_h]) = self.axes.improve(n, wf, wa, self.side);
        let wa = wa + step_h;
        let wf = wf + (step_d - self.axes.along * step_h);
        let wn = (T::splat(1.0) - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        (self.axes.finish(point, [step_d, step_h], bounds, [wn, wf, wa]), least)
    }
}

impl FacePlane<f64> {
    /// Returns the foot if it lies strictly inside of the face. `corners` are n, f and a.
    #[inline(always)]
    pub(super) fn foot(&self, corners: [V3; 3], bounds: [V3; 2]) -> Option<FaceFoot<f64>> {
        let [n, f, a] = corners;
        if self.is_sliver() {
            return self.sliver_foot(corners, bounds);
        }
        let (foot, least) = self.ordinary_foot(n, bounds);
        let is_inside = least > 0.0 && (least >= MIN_CERTAIN_WEIGHT || is_strictly_inside(n, f, a));
        is_inside.then_some(foot)
    }

    /// Returns the foot on a sliver if it lies strictly inside of the face. The first weights of a sliver have large
    /// errors, since its height is small. Along the sides of the triangle these errors would give large vectors that
    /// cancel; along the orthogonal axes nothing cancels.
    #[inline(always)]
    fn sliver_foot(&self, [n, f, a]: [V3; 3], bounds: [V3; 2]) -> Option<FaceFoot<f64>> {
        let axes = sliver_axes(&self.axes, n, f, a)?;
        let ([_, _, wa], _) = axes.weights(n, self.t);
        let (point, [step_d, step_h]) = axes.improve(n, self.t, wa, axes.height);
        let wa = wa + step_h;
        let wf = (self.t + step_d) - axes.along * wa;
        let wn = (1.0 - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        (least > 0.0).then(|| axes.finish(point, [step_d, step_h], bounds, [wn, wf, wa]))
    }
}

/// The foot of the perpendicular from the origin on a face.
#[derive(Clone, Copy)]
pub(super) struct FaceFoot<T> {
    /// The vector from the origin to the foot.
    pub(super) offset: [T; 3],
    /// The squared length of the offset.
    pub(super) square: T,
    /// The weights of the nearer and the farther end of the longest edge, and of the apex.
    pub(super) weights: [T; 3],
}

/// The vertices of a triangle in the order that [`FacePlane`] needs.
pub(super) struct Corners {
    /// The index of the longest edge.
    pub(super) base: usize,
    /// The indices of the nearer and the farther end of that edge, and of the apex opposite to it.
    pub(super) order: [usize; 3],
}

impl Corners {
    /// Returns the order for a triangle with these edge lines.
    #[inline(always)]
    pub(super) fn new(vertices: [V3; 3], lines: &[EdgeLine<f64>; 3]) -> Self {
        let base = longest_edge(vertices, lines);
        let second = usize::from(lines[base].is_second_nearer);
        let (near, far) = (EDGES[base][second], EDGES[base][1 - second]);
        Self { base, order: [near, far, 3 - near - far] }
    }

    /// Returns the weights of a foot in the order of the vertices.
    #[inline(always)]
    pub(super) fn in_order(&self, [wn, wf, wa]: [f64; 3]) -> V3 {
        let mut weights = [0.0; 3];
        (weights[self.order[0]], weights[self.order[1]], weights[self.order[2]]) = (wn, wf, wa);
        weights
    }
}

/// Returns the longest edge. Ties go to the edge whose opposite vertex comes first in lexicographic order, so that the
/// choice does not depend on the order of the vertices.
#[inline(always)]
fn longest_edge(vertices: [V3; 3], lines: &[EdgeLine<f64>; 3]) -> usize {
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

/// Returns the axes with a height computed in double-double, or `None` for a needle, which is replaced by its edges.
/// The relative error of the height is below 2^-43.
#[cold]
fn sliver_axes(plain: &Axes<f64>, n: V3, f: V3, a: V3) -> Option<Axes<f64>> {
    let d: [Double; 3] = std::array::from_fn(|k| Double::difference(f[k], n[k]));
    let side: [Double; 3] = std::array::from_fn(|k| Double::difference(a[k], n[k]));
    let along = arithmetic::dot(side, d) / arithmetic::dot(d, d);
    let height = std::array::from_fn(|k| (side[k] - along * d[k]).round());
    let height_squared = norm_squared(height);
    let is_needle = height_squared * plain.inverse < NEEDLE_SINE_SQUARED;
    (!is_needle).then_some(Axes { height, inverse_height: 1.0 / height_squared, along: along.round(), ..*plain })
}

/// Returns whether the foot on the face has three positive weights, in double-double arithmetic. A foot exactly on an
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
