//! Feet of perpendiculars on edges. Segments and triangles use the same code, so their feet have the same bits.

use super::vector::{V3, add_scaled, bounds, clamp, dot, lexicographically_less, norm_squared, sub};
use crate::Feature;

/// The line of an edge, and a first estimate of the foot of the perpendicular from the origin.
pub(super) struct EdgeLine {
    /// The index, 0 or 1, of the end that is nearer to the origin.
    pub(super) near: usize,
    /// The vector from the nearer to the farther end.
    pub(super) direction: V3,
    /// The number 1 / |direction|^2.
    pub(super) inverse: f64,
    /// The position of the foot: 0 at the nearer end, 1 at the farther one.
    pub(super) t: f64,
    /// The squared length of the foot.
    pub(super) square: f64,
}

impl EdgeLine {
    /// Projects the origin onto the line through `ends`, whose squared lengths are `squares`.
    ///
    /// Projecting from the nearer end keeps t |direction| below the distance to that end.
    #[inline(always)]
    pub(super) fn new(ends: [V3; 2], squares: [f64; 2]) -> Self {
        let is_second_nearer =
            squares[1] < squares[0] || (squares[1] == squares[0] && lexicographically_less(ends[1], ends[0]));
        let near = usize::from(is_second_nearer);
        let (n, f) = if is_second_nearer { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
        let nn = if is_second_nearer { squares[1] } else { squares[0] };
        let direction = sub(f, n);
        let inverse = 1.0 / norm_squared(direction);
        let projected = dot(n, direction);
        let t = -(projected * inverse);
        Self { near, direction, inverse, t, square: nn + t * projected }
    }

    /// Returns the foot if it lies strictly inside of the edge between `ends`, and `None` otherwise or for NaN.
    ///
    /// The foot of the first estimate is projected again, which removes the errors of the first division and of the
    /// first sum along the line.
    #[inline(always)]
    pub(super) fn foot(&self, ends: [V3; 2]) -> Option<Foot<2>> {
        let foot = add_scaled(ends[self.near], self.t, self.direction);
        let correction = -(dot(foot, self.direction) * self.inverse);
        let t = self.t + correction;
        if !(self.t > 0.0 && t > 0.0 && t < 1.0) {
            return None;
        }
        let offset = {
            let [low, high] = bounds(&ends);
            clamp(add_scaled(foot, correction, self.direction), low, high)
        };
        let weights = if self.near == 0 { [1.0 - t, t] } else { [t, 1.0 - t] };
        Some(Foot { offset, square: norm_squared(offset), weights })
    }
}

/// The foot of the perpendicular from the origin on an edge or a face, in its interior.
#[derive(Clone, Copy)]
pub(super) struct Foot<const N: usize> {
    /// The vector from the origin to the foot.
    pub(super) offset: V3,
    /// The squared length of the offset.
    pub(super) square: f64,
    /// The weights of the vertices of the edge or the face.
    pub(super) weights: [f64; N],
}

/// The vertices of the edges of a triangle: edge i runs from vertex i to vertex i + 1.
pub(super) const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Returns whether edge i of a triangle precedes a feature with the same key: it precedes another edge if its ends come
/// first in lexicographic order, and never a vertex.
#[cold]
pub(super) fn edge_precedes(vertices: &[V3; 3], i: usize, other: Feature) -> bool {
    let Feature::Edge(j) = other else { return false };
    let sorted = |i: usize| {
        let [a, b] = EDGES[i].map(|k| vertices[k]);
        if lexicographically_less(b, a) { [b, a] } else { [a, b] }
    };
    sorted(i) < sorted(usize::from(j))
}
