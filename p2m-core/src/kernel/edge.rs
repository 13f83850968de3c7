//! Projections onto edges: feet of perpendiculars. Segments and triangles share this code, so their feet have the same
//! bits.
//!
//! The code is generic over a single edge and several edges side by side ([`Float`]), so a lane has the same bits as a
//! single edge.

use super::vector::{V3, add_scaled, bounds, clamp, dot, lexicographically_less, norm_squared, select, sub};
use crate::Feature;
use crate::simd::Float;

/// The line of an edge, and a first estimate of the foot of the perpendicular from the origin.
pub(super) struct EdgeLine<T: Float> {
    /// Whether the second end is nearer to the origin than the first.
    pub(super) is_second_nearer: T::Mask,
    /// The vector from the nearer to the farther end.
    pub(super) direction: [T; 3],
    /// The number 1 / |direction|^2.
    pub(super) inverse: T,
    /// The position of the foot: 0 at the nearer end, 1 at the farther one.
    pub(super) t: T,
    /// The squared length of the foot.
    pub(super) square: T,
}

impl EdgeLine<f64> {
    /// Projects the origin onto the line through `ends`, whose squared lengths are `squares`. If both ends are equally
    /// near, the first in lexicographic order counts as the nearer one.
    #[inline(always)]
    pub(super) fn new(ends: [V3; 2], squares: [f64; 2]) -> Self {
        let is_second_nearer =
            squares[1] < squares[0] || (squares[1] == squares[0] && lexicographically_less(ends[1], ends[0]));
        Self::from_nearer_end(ends, squares, is_second_nearer)
    }
}

impl<T: Float> EdgeLine<T> {
    /// Projects the origin onto the line through `ends`, given which end is nearer.
    ///
    /// Projecting from the nearer end keeps t |direction| below the distance to that end.
    #[inline(always)]
    pub(super) fn from_nearer_end(ends: [[T; 3]; 2], squares: [T; 2], is_second_nearer: T::Mask) -> Self {
        let n = select(is_second_nearer, ends[1], ends[0]);
        let f = select(is_second_nearer, ends[0], ends[1]);
        let nn = T::select(is_second_nearer, squares[1], squares[0]);
        let direction = sub(f, n);
        let inverse = T::splat(1.0) / norm_squared(direction);
        let projected = dot(n, direction);
        let t = -(projected * inverse);
        Self { is_second_nearer, direction, inverse, t, square: nn + t * projected }
    }

    /// Returns the foot, and whether it lies strictly inside of the edge between `ends`. It never does for NaN.
    ///
    /// The foot of the first estimate is projected again, which removes the errors of the first division and of the
    /// first sum along the line.
    #[inline(always)]
    pub(super) fn foot(&self, ends: [[T; 3]; 2]) -> (EdgeFoot<T>, T::Mask) {
        let (zero, one) = (T::splat(0.0), T::splat(1.0));
        let foot = add_scaled(select(self.is_second_nearer, ends[1], ends[0]), self.t, self.direction);
        let correction = -(dot(foot, self.direction) * self.inverse);
        let t = self.t + correction;
        let is_inside = zero.is_below(self.t) & zero.is_below(t) & t.is_below(one);
        let offset = {
            let [low, high] = bounds(&ends);
            clamp(add_scaled(foot, correction, self.direction), low, high)
        };
        (EdgeFoot { offset, square: norm_squared(offset), t }, is_inside)
    }
}

impl EdgeLine<f64> {
    /// Returns the weights of the two ends for a foot at `t`.
    #[inline(always)]
    pub(super) fn weights(&self, t: f64) -> [f64; 2] {
        if self.is_second_nearer { [t, 1.0 - t] } else { [1.0 - t, t] }
    }
}

/// The foot of the perpendicular from the origin on an edge.
#[derive(Clone, Copy)]
pub(super) struct EdgeFoot<T> {
    /// The vector from the origin to the foot.
    pub(super) offset: [T; 3],
    /// The squared length of the offset.
    pub(super) square: T,
    /// The position of the foot: 0 at the nearer end, 1 at the farther one.
    pub(super) t: T,
}

/// The vertices of the edges of a triangle: edge i runs from vertex i to vertex i + 1.
pub(super) const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Returns whether edge i of a triangle precedes a feature with the same key. It precedes another edge if its ends come
/// first in lexicographic order, and never precedes a vertex.
#[cold]
pub(super) fn edge_precedes(vertices: &[V3; 3], i: usize, other: Feature) -> bool {
    let Feature::Edge(j) = other else { return false };
    let sorted = |i: usize| {
        let [a, b] = EDGES[i].map(|k| vertices[k]);
        if lexicographically_less(b, a) { [b, a] } else { [a, b] }
    };
    sorted(i) < sorted(usize::from(j))
}
