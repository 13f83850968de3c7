//! Feet of perpendiculars on edges: of segments, and of triangles with the same bits.

use super::vector::{V3, add_scaled, bounds, clamp, dot, lexicographically_less, norm_squared, sub};

/// The line through two points, and a first estimate of the foot of the perpendicular from the origin.
pub(super) struct Line {
    /// The end that is nearer to the origin: 0 or 1.
    pub(super) near: usize,
    /// From the nearer to the farther end.
    pub(super) direction: V3,
    /// 1 / |direction|^2
    pub(super) inverse: f64,
    /// Position of the foot: 0 at the nearer end, 1 at the farther one.
    pub(super) t: f64,
    /// The squared length of the foot.
    pub(super) square: f64,
}

impl Line {
    /// `squares` are the squared lengths of `ends`. Projecting from the nearer end keeps t |direction| below the
    /// distance to it.
    #[inline(always)]
    pub(super) fn new(ends: [V3; 2], squares: [f64; 2]) -> Self {
        let second_nearer =
            squares[1] < squares[0] || (squares[1] == squares[0] && lexicographically_less(ends[1], ends[0]));
        let near = usize::from(second_nearer);
        let (n, f) = if second_nearer { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
        let nn = if second_nearer { squares[1] } else { squares[0] };
        let direction = sub(f, n);
        let inverse = 1.0 / norm_squared(direction);
        let projected = dot(n, direction);
        let t = -(projected * inverse);
        Self { near, direction, inverse, t, square: nn + t * projected }
    }

    /// The foot, if it lies strictly inside the edge between `ends`. NaN is not inside.
    ///
    /// The foot of the first estimate is projected again, which removes the error of the first division and of the
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

/// A foot inside an edge or a face: offset, its square, and the weights of the vertices it was computed from.
#[derive(Clone, Copy)]
pub(super) struct Foot<const N: usize> {
    pub(super) offset: V3,
    pub(super) square: f64,
    pub(super) weights: [f64; N],
}
