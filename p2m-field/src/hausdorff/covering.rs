//! Bounds on the distances of a piece by several primitives together.
//!
//! A piece that lies on two neighbours of a plane is near neither of them as a whole. So it is divided by planes
//! through the edges of one primitive, perpendicular to that primitive: the part above the primitive is bounded by the
//! primitive, and the parts beside it by the others. Parts are convex, so the distances of their corners bound them. No
//! query is needed.
//!
//! A part is given by corners, which are combinations of the corners of the piece, rounded to f64. Where it is divided,
//! two points on its boundary are joined, which divides a convex polygon into two, whatever the points are. So rounding
//! of heights decides how good a bound is, and not whether it holds.

use nalgebra::{Point3, Vector3};
use p2m_core::engine::vector::{V3, dot, sub};
use p2m_core::{Primitive, Real, Shape};

/// The largest number of primitives that cover a piece.
pub(super) const MAX_SHAPES: usize = 4;
/// The largest number of corners of a part: each division adds one, and there is none by the last primitive.
const MAX_CORNERS: usize = 3 + 3 * (MAX_SHAPES - 1);

/// A convex polygon. Corners may repeat.
#[derive(Clone, Copy)]
pub(super) struct Part {
    corners: [Point3<f64>; MAX_CORNERS],
    len: usize,
    /// A bound on the distance of a corner from its exact place in the piece.
    drift: f64,
}

impl Part {
    /// Returns the part that is a whole piece.
    pub(super) fn whole<T: Real>(points: &[Point3<T>; 3]) -> Self {
        let points = points.map(|point| point.map(T::to_f64));
        let mut corners = [points[0]; MAX_CORNERS];
        corners[..3].copy_from_slice(&points);
        Self { corners, len: 3, drift: 0.0 }
    }

    fn corners(&self) -> &[Point3<f64>] {
        &self.corners[..self.len]
    }

    fn push(&mut self, corner: Point3<f64>) {
        self.corners[self.len] = corner;
        self.len += 1;
    }

    /// Bounds the distances of the part from some primitives, until a bound is at most `goal`. Each division adds
    /// `drift` to the distances of corners from their exact places. A few roundings are not counted.
    pub(super) fn cover(&self, shapes: &[Option<Shape<f64>>], goal: f64, drift: f64) -> f64 {
        let mut best = f64::INFINITY;
        for shape in shapes.iter().flatten() {
            best = best.min(self.cover_by_one(shape));
            if best <= goal {
                return best;
            }
        }
        let [Some(first), others @ ..] = shapes else { return best };
        if others.is_empty() {
            return best;
        }
        let mut above = Some(*self);
        let mut beside = [None; 3];
        for ((plane, normal), part) in walls(first).into_iter().flatten().zip(&mut beside) {
            if let Some(rest) = above {
                (above, *part) = rest.divide(&plane, &normal, drift);
            }
        }
        let Some(above) = above.filter(|_| beside.iter().any(Option::is_some)) else {
            return best.min(self.cover(others, goal, drift));
        };
        let mut all = above.cover_by_one(first);
        for part in beside.into_iter().flatten() {
            if all >= best {
                break;
            }
            all = all.max(part.cover(others, goal, drift));
        }
        best.min(all)
    }

    /// Bounds the distances of the part from one primitive.
    fn cover_by_one(&self, shape: &Shape<f64>) -> f64 {
        let upper = |corner: &Point3<f64>| {
            let projection = shape.project(corner);
            let upper = projection.key.distance() + (projection.error + self.drift);
            if upper.is_nan() { f64::INFINITY } else { upper }
        };
        self.corners().iter().map(upper).fold(0.0, f64::max)
    }

    /// Divides the part by a plane. Returns the part on the side of the normal, and the part on the other side.
    fn divide(&self, plane: &V3, normal: &V3, drift: f64) -> (Option<Self>, Option<Self>) {
        let mut heights = [0.0; MAX_CORNERS];
        for (height, corner) in heights.iter_mut().zip(self.corners()) {
            *height = dot(sub(corner.coords.into(), *plane), *normal);
        }
        let is_above = |i: usize| heights[i] >= 0.0;
        let next = |i: usize| (i + 1) % self.len;
        let crossings = (0..self.len).filter(|i| is_above(*i) != is_above(next(*i))).count();
        if crossings == 0 && is_above(0) {
            return (Some(*self), None);
        }
        // Rounding may let the boundary of a thin part cross the plane more than twice.
        if crossings != 2 || self.len == MAX_CORNERS {
            return (None, Some(*self));
        }
        let empty = Self { len: 0, drift: self.drift + drift, ..*self };
        let mut sides = [empty; 2];
        for i in 0..self.len {
            sides[usize::from(!is_above(i))].push(self.corners[i]);
            if is_above(i) != is_above(next(i)) {
                let t = heights[i] / (heights[i] - heights[next(i)]);
                if !(0.0..=1.0).contains(&t) {
                    return (None, Some(*self));
                }
                let [a, b] = [i, next(i)].map(|i| self.corners[i]);
                let crossing = Point3::from(a.coords * (1.0 - t) + b.coords * t);
                sides.iter_mut().for_each(|side| side.push(crossing));
            }
        }
        let [above, below] = sides;
        (Some(above), Some(below))
    }
}

/// Returns planes around a triangle or a segment, perpendicular to it: a point of each, and its normal, which points
/// inwards.
fn walls(shape: &Shape<f64>) -> [Option<(V3, V3)>; 3] {
    let vertex = |i: usize| -> V3 { shape.vertices()[i].coords.into() };
    let offset = |a: V3, b: V3| -> Vector3<f64> { sub(b, a).into() };
    match shape.vertices().len() {
        2 => {
            let [a, b] = [vertex(0), vertex(1)];
            [Some((a, sub(b, a))), Some((b, sub(a, b))), None]
        }
        3 => {
            let [a, b, c] = [vertex(0), vertex(1), vertex(2)];
            let normal = offset(a, b).cross(&offset(a, c));
            [(a, b), (b, c), (c, a)].map(|(from, to)| Some((from, normal.cross(&offset(from, to)).into())))
        }
        _ => [None; 3],
    }
}
