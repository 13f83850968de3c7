//! Feet of perpendiculars on the faces of triangles, slivers included.

use super::arithmetic;
use super::double_double::Double;
use super::edge::{Foot, Line};
use super::vector::{
    V3, add, add_scaled, clamp, combine, dot, exponent, larger, largest, lexicographically_less, norm_squared,
    power_of_two, scale_by_power, smaller, sub,
};

/// The square of [`SLIVER_SINE`](super::SLIVER_SINE).
const SLIVER_SINE_SQUARED: f64 = power_of_two(-20);
/// Triangles whose height is below 2^-57 of their longest edge are their edges: no face point is further from the
/// edges than that height, which is at most u M / 8.
const NEEDLE_SINE_SQUARED: f64 = power_of_two(-114);
/// Weights below 2^-49 may owe their sign to rounding.
const UNDECIDED_WEIGHT: f64 = power_of_two(-49);
/// First weights of ordinary faces err by less than 2^-38 of the offsets' size over the height; this is the square of a
/// wider margin. A sliver's errors are as many times larger as its height is too small.
const REJECT_MARGIN_SQUARED: f64 = power_of_two(-72);
/// Below a height of 2^-22 of the longest edge nothing is estimated.
const UNKNOWN_DOUBT: f64 = power_of_two(24);
/// Edge i runs from vertex i to vertex i + 1.
pub(super) const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The axes of a triangle: the longest edge and the height over it.
///
/// They are orthogonal, so the weights decouple and a sliver's error is not multiplied by the inverse of its sine; the
/// height alone needs care, see [`sliver_axes`].
#[derive(Clone, Copy)]
struct Axes {
    /// From the nearer end of the longest edge to the farther one.
    direction: V3,
    /// 1 / |direction|^2
    inverse: f64,
    /// From the longest edge to the apex.
    height: V3,
    /// 1 / |height|^2
    inverse_height: f64,
    /// Where the height stands on the edge: 0 at the nearer end.
    along: f64,
}

impl Axes {
    /// First weights of the foot for the nearer end `n`, the farther one and the apex, `t` being the position of the
    /// foot on the longest edge; and n . height.
    #[inline(always)]
    fn weights(&self, n: V3, t: f64) -> ([f64; 3], f64) {
        let projected = dot(n, self.height);
        let wa = -(projected * self.inverse_height);
        let wf = t - self.along * wa;
        ([(1.0 - wf) - wa, wf, wa], projected)
    }
}

/// The plane of a triangle, and a first estimate of the foot of the perpendicular from the origin.
pub(super) struct Plane {
    /// Nearer and farther end of the longest edge, and the vertex opposite to it.
    corners: [usize; 3],
    /// As plain arithmetic has them: good enough for estimates, and for the foot unless the triangle is a sliver.
    axes: Axes,
    /// From the nearer end to the apex.
    side: V3,
    /// Position of the foot on the longest edge.
    t: f64,
    weights: [f64; 3],
    square: f64,
    /// 1, for slivers the square of how many times their height is too small: the factor by which estimates are worse.
    doubt: f64,
}

impl Plane {
    /// `None` if the foot is certainly not inside.
    #[inline(always)]
    pub(super) fn new(vertices: [V3; 3], lines: &[Line; 3], size: f64) -> Option<Self> {
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
        let doubt = larger(SLIVER_SINE_SQUARED / (height_squared * line.inverse), 1.0);
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
            doubt,
        };
        let outside = plane.can_estimate()
            && least < 0.0
            && least * least * height_squared > REJECT_MARGIN_SQUARED * doubt * (size * size);
        (!outside).then_some(plane)
    }

    /// Whether weights and square are estimates at all: a height that is rounding error alone gives none.
    #[inline(always)]
    fn can_estimate(&self) -> bool {
        self.doubt <= UNKNOWN_DOUBT
    }

    /// The squared length of the foot, infinite if it seems to be outside, and the factor by which margins have to be
    /// wider than usual. Without an estimate the foot may be anywhere.
    #[inline(always)]
    pub(super) fn estimate(&self) -> (f64, f64) {
        if !self.can_estimate() {
            return (0.0, f64::INFINITY);
        }
        let inside = smaller(smaller(self.weights[0], self.weights[1]), self.weights[2]) > 0.0;
        (if inside { self.square } else { f64::INFINITY }, self.doubt)
    }

    /// Whether the foot, inside or not, may have a square up to `limit`.
    #[inline(always)]
    pub(super) fn may_be_within(&self, limit: f64) -> bool {
        self.square <= limit || !self.can_estimate()
    }

    /// The foot, if it lies strictly inside: the point of the first weights, and one step on its residual.
    #[inline(always)]
    pub(super) fn foot(&self, vertices: [V3; 3], [low, high]: [V3; 2]) -> Option<Foot<3>> {
        let [n, f, a] = [vertices[self.corners[0]], vertices[self.corners[1]], vertices[self.corners[2]]];
        let sliver = self.doubt > 1.0;
        let axes = if sliver { sliver_axes(&self.axes, n, f, a)? } else { self.axes };
        // The first weights of a sliver are as uncertain as its height is small, and by the sides of the triangle they
        // would add up to large vectors that cancel; along the orthogonal axes nothing cancels.
        let (t, [_, wf, wa]) = (self.t, if sliver { axes.weights(n, self.t).0 } else { self.weights });
        let (first, second) = if sliver { (t, axes.height) } else { (wf, self.side) };
        let point = add(n, combine(first, axes.direction, wa, second));
        let step_d = -(dot(point, axes.direction) * axes.inverse);
        let step_h = -(dot(point, axes.height) * axes.inverse_height);
        let last = wa + step_h;
        let wf = if sliver { (t + step_d) - axes.along * last } else { wf + (step_d - axes.along * step_h) };
        let wa = last;
        let wn = (1.0 - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        let inside = least > 0.0 && (least >= UNDECIDED_WEIGHT || sliver || strictly_inside(n, f, a));
        if !inside {
            return None;
        }
        let point = add(point, combine(step_d, axes.direction, step_h, axes.height));
        let offset = clamp(point, low, high);
        let mut weights = [0.0; 3];
        (weights[self.corners[0]], weights[self.corners[1]], weights[self.corners[2]]) = (wn, wf, wa);
        Some(Foot { offset, square: norm_squared(offset), weights })
    }
}

/// Ties go to the edge whose opposite vertex comes first in lexicographic order, so that the choice does not depend
/// on how the vertices are numbered.
#[inline(always)]
fn longest_edge(vertices: [V3; 3], lines: &[Line; 3]) -> usize {
    let mut best = 0;
    for i in 1..3 {
        // The longer edge has the smaller inverse.
        let (x, y) = (lines[i].inverse, lines[best].inverse);
        if x < y || (x == y && lexicographically_less(vertices[(i + 2) % 3], vertices[(best + 2) % 3])) {
            best = i;
        }
    }
    best
}

/// The axes with the height from double-double: relative error below 2^-43 for every height that is not a needle's.
/// `None` for a needle, which is its edges.
#[cold]
fn sliver_axes(plain: &Axes, n: V3, f: V3, a: V3) -> Option<Axes> {
    let d: [Double; 3] = std::array::from_fn(|k| Double::difference(f[k], n[k]));
    let side: [Double; 3] = std::array::from_fn(|k| Double::difference(a[k], n[k]));
    let along = arithmetic::dot(side, d) / arithmetic::dot(d, d);
    let height = std::array::from_fn(|k| (side[k] - along * d[k]).round());
    let height_squared = norm_squared(height);
    let needle = height_squared * plain.inverse < NEEDLE_SINE_SQUARED;
    (!needle).then_some(Axes { height, inverse_height: 1.0 / height_squared, along: along.round(), ..*plain })
}

/// Whether the foot on the face has three positive weights, in double-double: a foot exactly on an edge belongs to the
/// edge, which rounding of the weights alone would not show.
#[cold]
fn strictly_inside(n: V3, f: V3, a: V3) -> bool {
    // Products of four lengths: at the scale of the triangle they cannot leave the range.
    let scale = -exponent(largest(&[sub(f, n)]));
    let [n, f, a] = [n, f, a].map(|v| v.map(|x| scale_by_power(x, scale)));
    let edge = |to: V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(to[k], n[k])) };
    let (e, s) = (edge(f), edge(a));
    let to_query = n.map(|x| Double::difference(0.0, x));
    let [ee, es, ss] = [arithmetic::dot(e, e), arithmetic::dot(e, s), arithmetic::dot(s, s)];
    let [qe, qs] = [arithmetic::dot(to_query, e), arithmetic::dot(to_query, s)];
    // Cramer's rule; every weight times the determinant.
    let wf = ss * qe - es * qs;
    let wa = ee * qs - es * qe;
    let wn = (ee * ss - es * es) - (wf + wa);
    // Products of four lengths, of which `e` is the longest edge, with at least 95 good bits.
    let noise = power_of_two(-95) * ee.round() * (ee.round() + (ee.round() * norm_squared(n)).sqrt());
    wn.round() > noise && wf.round() > noise && wa.round() > noise
}
