//! Feet of perpendiculars on the faces of triangles, slivers included.

use super::double::{self, Double};
use super::line::{Foot, Line};
use super::vector::{
    V3, add, add_scaled, clamp, combine, dot, lexicographically_less, norm_squared, power_of_two, smaller, sub,
};

/// Triangles whose height is below 2^-10 of their longest edge get that height in double-double.
const SLIVER_SINE_SQUARED: f64 = power_of_two(-20);
/// Triangles whose height is below 2^-57 of their longest edge are their edges: no face point is further from the
/// edges than that height, which is at most u M / 8.
const NEEDLE_SINE_SQUARED: f64 = power_of_two(-114);
/// Weights below 2^-49 may owe their sign to rounding.
const UNDECIDED_WEIGHT: f64 = power_of_two(-49);
/// First weights of ordinary faces err by less than 2^-38 of the offsets' size over the height; this is the square of a
/// wider margin.
const REJECT_MARGIN_SQUARED: f64 = power_of_two(-72);

/// Edge i runs from vertex i to vertex i + 1.
pub(super) const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// An orthogonal frame of a triangle, and a first estimate of the foot of the perpendicular from the origin.
///
/// The longest edge and the height over it are the axes. The weights decouple there, so a sliver's error is not
/// multiplied by the inverse of its sine; the height alone needs care, see [`sliver_height`].
pub(super) struct Plane {
    /// Nearer and farther end of the longest edge, and the vertex opposite to it.
    corners: [usize; 3],
    direction: V3,
    inverse: f64,
    /// From the nearer end to the apex.
    side: V3,
    /// From the longest edge to the apex.
    height: V3,
    inverse_height: f64,
    /// Where the height stands on the edge: 0 at the nearer end.
    along: f64,
    /// First weights of the corners.
    pub(super) weights: [f64; 3],
    /// The squared length of the foot, or 0 where a sliver makes it unreliable.
    pub(super) square: f64,
    pub(super) sliver: bool,
}

impl Plane {
    /// `None` if the foot is certainly not inside, or if the triangle is but its edges.
    #[inline(always)]
    pub(super) fn new(vertices: [V3; 3], lines: &[Line; 3], size: f64) -> Option<Self> {
        let base = longest_edge(vertices, lines);
        let line = &lines[base];
        let near = EDGES[base][line.near];
        let far = EDGES[base][1 - line.near];
        let apex = 3 - near - far;
        let (n, f, a) = (vertices[near], vertices[far], vertices[apex]);

        let side = sub(a, n);
        let mut along = dot(side, line.direction) * line.inverse;
        let mut height = add_scaled(side, -along, line.direction);
        let mut height_squared = norm_squared(height);
        let sliver = height_squared * line.inverse < SLIVER_SINE_SQUARED;
        if sliver {
            (along, height) = sliver_height(n, f, a);
            height_squared = norm_squared(height);
            if height_squared * line.inverse < NEEDLE_SINE_SQUARED {
                return None;
            }
        }
        let inverse_height = 1.0 / height_squared;
        let projected = dot(n, height);
        let wa = -(projected * inverse_height);
        let wf = line.t - along * wa;
        let wn = (1.0 - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        if least < 0.0 && !sliver && least * least * height_squared > REJECT_MARGIN_SQUARED * (size * size) {
            return None;
        }
        let square = if sliver { 0.0 } else { line.square + wa * projected };
        Some(Self {
            corners: [near, far, apex],
            direction: line.direction,
            inverse: line.inverse,
            side,
            height,
            inverse_height,
            along,
            weights: [wn, wf, wa],
            square,
            sliver,
        })
    }

    /// The foot, if it lies strictly inside: the point of the first weights, and one step on its residual.
    #[inline(always)]
    pub(super) fn foot(&self, vertices: [V3; 3], [low, high]: [V3; 2]) -> Option<Foot<3>> {
        let [n, f, a] = self.corners.map(|i| vertices[i]);
        let [_, wf, wa] = self.weights;
        let point = add(n, combine(wf, self.direction, wa, self.side));
        let step_d = -(dot(point, self.direction) * self.inverse);
        let step_h = -(dot(point, self.height) * self.inverse_height);
        let wa = wa + step_h;
        let wf = wf + (step_d - self.along * step_h);
        let wn = (1.0 - wf) - wa;
        let least = smaller(smaller(wn, wf), wa);
        let inside = least > 0.0 && (least >= UNDECIDED_WEIGHT || self.sliver || strictly_inside(n, f, a));
        if !inside {
            return None;
        }
        let point = add(point, combine(step_d, self.direction, step_h, self.height));
        let offset = clamp(point, low, high);
        let mut weights = [0.0; 3];
        for (corner, weight) in self.corners.into_iter().zip([wn, wf, wa]) {
            weights[corner] = weight;
        }
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

/// The height of the triangle over its base `n`-`f`, as the vector from the base line to the apex `a`, and the
/// position of its foot on the base, both rounded from double-double: relative error below 2^-44 of the height for
/// every height that is not a needle's.
#[cold]
fn sliver_height(n: V3, f: V3, a: V3) -> (f64, V3) {
    let d: [Double; 3] = std::array::from_fn(|k| Double::difference(f[k], n[k]));
    let side: [Double; 3] = std::array::from_fn(|k| Double::difference(a[k], n[k]));
    let along = double::dot(side, d) / double::dot(d, d);
    (along.round(), std::array::from_fn(|k| (side[k] - along * d[k]).round()))
}

/// Whether the foot on the face has three positive weights, in double-double: a foot exactly on an edge belongs to the
/// edge, which rounding of the weights alone would not show.
#[cold]
fn strictly_inside(n: V3, f: V3, a: V3) -> bool {
    let edge = |to: V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(to[k], n[k])) };
    let (e, s) = (edge(f), edge(a));
    let to_query = n.map(|x| Double::difference(0.0, x));
    let [ee, es, ss] = [double::dot(e, e), double::dot(e, s), double::dot(s, s)];
    let [qe, qs] = [double::dot(to_query, e), double::dot(to_query, s)];
    // Cramer's rule; every weight times the determinant.
    let wf = ss * qe - es * qs;
    let wa = ee * qs - es * qe;
    let wn = (ee * ss - es * es) - (wf + wa);
    // Products of four lengths, of which `e` is the longest edge, with at least 95 good bits.
    let noise = power_of_two(-95) * ee.round() * (ee.round() + (ee.round() * norm_squared(n)).sqrt());
    wn.round() > noise && wf.round() > noise && wa.round() > noise
}
