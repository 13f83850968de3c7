//! Where a ray meets a primitive: decided exactly, in f64 where that is enough.
//!
//! Everything is relative to the origin of the ray. A, B, C are the vertices of a triangle, D is the direction. The
//! line passes the edge from A to B on the side that the sign of the moment D . (A x B) says; it meets the triangle if
//! no two of the three moments have opposite signs, and lies in its plane if all are zero. The parameter of the plane is
//! n . A / n . D with n = (B - A) x (C - A). docs/proofs/rays.md bounds the errors.

use super::TINY;
use super::exact::Exact;
use super::line::Ray;
use super::plane::{PLAIN, Plane, U};
use crate::kernel::vector::{V3, dot, sub};
use crate::real::to_f64_array;
use crate::{Primitive, PrimitiveId, Real};
use nalgebra::Point3;
use std::cmp::Ordering;

/// From where a ray meets a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// From the side to which the normal (b - a) x (c - a) of the triangle points.
    Front,
    /// From the other side.
    Back,
    /// In the plane of a triangle; and all that segments, points and triangles without area know.
    Along,
}

/// A hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The primitive.
    pub primitive: PrimitiveId,
    /// The parameter of the ray, in lengths of its direction: the exact one rounded to the nearest f64, for every
    /// primitive of this project; infinite beyond the range of f64. The least one in the range of the ray where it meets
    /// the primitive in a stretch; where it is nearest to a segment or a point, if it has a radius.
    pub parameter: f64,
    /// From where.
    pub side: Side,
    /// What the rest is computed from when asked for.
    origin: V3,
    direction: V3,
    source: Source,
}

impl Hit {
    /// Weights of the primitive's vertices, each rounded to nearest; within 4 u where the range of the ray begins inside
    /// of a triangle or segment that it runs along. Unused ones are 0.
    #[must_use]
    pub fn barycentric(&self) -> [f64; 3] {
        match &self.source {
            Source::Face(vertices, _) => self.weights(vertices),
            Source::Known(hit) => hit.barycentric,
        }
    }

    /// The point of the primitive: the sum of its vertices with these weights, rounded, in its box; a vertex verbatim.
    /// The point of the ray is [`Ray::at`], which errs differently.
    #[must_use]
    pub fn point(&self) -> Point3<f64> {
        match &self.source {
            Source::Face(vertices, _) => weighted(vertices, &self.weights(vertices)),
            Source::Known(hit) => hit.point,
        }
    }

    fn weights(&self, vertices: &[V3; 3]) -> V3 {
        let plane = Plane::new(&self.origin, &self.direction, vertices);
        plane
            .and_then(|plane| plane.weights())
            .unwrap_or_else(|| Exact::new(&self.origin, &self.direction, 0.0, vertices).face().1)
    }
}

/// What a primitive of your own answers to a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The parameter, in lengths of the direction.
    pub parameter: f64,
    /// From where.
    pub side: Side,
    /// Weights, as the primitive understands them.
    pub barycentric: [f64; 3],
    /// The point.
    pub point: Point3<f64>,
}

/// The point of a ray on a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) parameter: f64,
    pub(super) weights: V3,
}

/// A hit of which the parameter is known between bounds, and exactly when asked for.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<'a> {
    ray: &'a Ray,
    low: f64,
    high: f64,
    source: Source,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// A triangle that is crossed, and from where.
    Face([V3; 3], Side),
    /// Anything else.
    Known(RayHit),
}

/// What sums of three products of differences may be off, given the sizes of what is summed in each component of the
/// first factor and the second factor.
#[inline(always)]
fn rounding(sizes: &V3, x: &V3) -> f64 {
    let [a, b, c] = [x[0].abs(), x[1].abs(), x[2].abs()];
    10.0 * U * (a * sizes[0] + b * sizes[1] + c * sizes[2]) + TINY * (1.0 + a + b + c)
}

/// The cross product of two vectors, and the sizes of what is summed in it.
#[inline(always)]
fn cross_with_sizes(a: &V3, b: &V3) -> (V3, V3) {
    let [p, q, r] = [[a[1] * b[2], a[2] * b[1]], [a[2] * b[0], a[0] * b[2]], [a[0] * b[1], a[1] * b[0]]];
    let sum = |[x, y]: [f64; 2]| x.abs() + y.abs();
    ([p[0] - p[1], q[0] - q[1], r[0] - r[1]], [sum(p), sum(q), sum(r)])
}

impl<'a> Crossing<'a> {
    /// Where a ray meets a primitive, for a backend of your own: `None` for a miss, and where the parameter is out of the
    /// range of the ray or certainly exceeds `limit`. `only_crossings` as [`RayCollector`](super::RayCollector) says.
    #[must_use]
    pub fn of<T: Real>(primitive: &impl Primitive<T>, ray: &'a Ray, limit: f64, only_crossings: bool) -> Option<Self> {
        match primitive.vertices() {
            [] => Self::of_hit(ray, primitive.intersect_ray(ray).filter(|_| !only_crossings)?),
            [a] => Self::of_vertices(ray, &[to_f64_array(a)], limit, only_crossings),
            [a, b] => Self::of_vertices(ray, &[to_f64_array(a), to_f64_array(b)], limit, only_crossings),
            [a, b, c, ..] => {
                Self::of_vertices(ray, &[to_f64_array(a), to_f64_array(b), to_f64_array(c)], limit, only_crossings)
            }
        }
    }

    /// What a primitive of your own answered, if it is in the range of the ray.
    #[must_use]
    pub fn of_hit(ray: &'a Ray, hit: RayHit) -> Option<Self> {
        // Never -0.
        let t = hit.parameter + 0.0;
        let hit = RayHit { parameter: t, ..hit };
        ray.contains(t).then_some(Self { ray, low: t, high: t, source: Source::Known(hit) })
    }

    /// One of this project, by its vertices.
    #[inline(always)]
    pub fn of_vertices(ray: &'a Ray, vertices: &[V3], limit: f64, only_crossings: bool) -> Option<Self> {
        match vertices {
            [a, b, c] => Self::of_triangle(ray, [*a, *b, *c], limit, only_crossings),
            _ if only_crossings => None,
            _ => Self::of_wire(ray, vertices),
        }
    }

    /// Segments and points.
    fn of_wire(ray: &'a Ray, vertices: &[V3]) -> Option<Self> {
        if passes_by(ray, vertices) {
            return None;
        }
        let found = exact(ray, vertices).wire(ray)?;
        Self::of_found(ray, vertices, &found)
    }

    fn of_found(ray: &'a Ray, vertices: &[V3], found: &Found) -> Option<Self> {
        let Found { parameter, weights } = *found;
        let point = weighted(vertices, &weights);
        Self::of_hit(ray, RayHit { parameter, side: Side::Along, barycentric: weights, point })
    }

    /// A triangle; `None` also if its parameter certainly exceeds `limit`.
    #[inline(always)]
    fn of_triangle(ray: &'a Ray, vertices: [V3; 3], limit: f64, only_crossings: bool) -> Option<Self> {
        let offsets = vertices.map(|v| sub(v, ray.origin));
        let [bc, ca, ab] =
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| certain_sign(&ray.direction, &offsets[i], &offsets[j]));
        let (above, below) = (bc > 0 || ca > 0 || ab > 0, bc < 0 || ca < 0 || ab < 0);
        if above && below {
            return None;
        }
        let front = if bc != 0 && ca != 0 && ab != 0 {
            below
        } else {
            match exact_side(ray, &vertices, [bc, ca, ab], only_crossings)? {
                Ordering::Less => true,
                Ordering::Greater => false,
                Ordering::Equal => {
                    return Self::of_found(ray, &vertices, &exact(ray, &vertices).flat(ray)?);
                }
            }
        };
        let side = if front { Side::Front } else { Side::Back };
        let [low, high] = parameter_bounds(ray, &vertices, &offsets[0]);
        if low > limit || low > ray.max || high < ray.min {
            return None;
        }
        let found = Self { ray, low, high, source: Source::Face(vertices, side) };
        if ray.min <= low && high <= ray.max {
            return Some(found);
        }
        let t = found.parameter();
        ray.contains(t).then_some(Self { low: t, high: t, ..found })
    }

    /// Two numbers between which the parameter lies.
    #[inline(always)]
    pub fn bounds(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// The parameter.
    #[inline]
    #[must_use]
    pub fn parameter(&self) -> f64 {
        match &self.source {
            _ if self.low == self.high => self.low,
            Source::Known(hit) => hit.parameter,
            Source::Face(vertices, _) => {
                let plane = Plane::new(&self.ray.origin, &self.ray.direction, vertices);
                plane.and_then(|plane| plane.parameter()).unwrap_or_else(|| exact(self.ray, vertices).face().0)
            }
        }
    }

    /// The same crossing with bounds that are equal.
    #[must_use]
    pub(super) fn resolved(self) -> Self {
        let t = self.parameter();
        Self { low: t, high: t, ..self }
    }

    /// All there is to know.
    #[must_use]
    pub fn hit(&self, primitive: PrimitiveId) -> Hit {
        let side = match &self.source {
            Source::Face(_, side) => *side,
            Source::Known(hit) => hit.side,
        };
        let Ray { origin, direction, .. } = *self.ray;
        Hit { primitive, parameter: self.parameter(), side, origin, direction, source: self.source }
    }
}

/// The integers of a ray and some vertices.
#[cold]
fn exact(ray: &Ray, vertices: &[V3]) -> Exact {
    Exact::new(&ray.origin, &ray.direction, ray.radius, vertices)
}

/// The sum of some vertices with weights, in the box of the vertices; a vertex verbatim.
fn weighted(vertices: &[V3], weights: &V3) -> Point3<f64> {
    if let Some(vertex) = weights.iter().position(|w| *w == 1.0) {
        return Point3::from(vertices[vertex]);
    }
    let coordinate = |k: usize| {
        let sum: f64 = vertices.iter().zip(weights).map(|(v, w)| v[k] * w).sum();
        let low = vertices.iter().map(|v| v[k]).fold(f64::INFINITY, f64::min);
        let high = vertices.iter().map(|v| v[k]).fold(f64::NEG_INFINITY, f64::max);
        sum.max(low).min(high)
    };
    Point3::from([0, 1, 2].map(coordinate))
}

/// 1 or -1 if the moment D . (A x B) is certainly above or below zero, from offsets that are rounded; else 0.
#[inline(always)]
fn certain_sign(d: &V3, a: &V3, b: &V3) -> i32 {
    let (minors, sizes) = cross_with_sizes(a, b);
    let (moment, error) = (dot(*d, minors), rounding(&sizes, d));
    i32::from(moment > error) - i32::from(moment < -error)
}

/// On which side of all edges a line passes that f64 could not tell: `None` for a miss, `Equal` in the plane.
#[cold]
#[inline(never)]
fn exact_side(ray: &Ray, vertices: &[V3; 3], known: [i32; 3], only_crossings: bool) -> Option<Ordering> {
    let exact = exact(ray, vertices);
    let mut all = Ordering::Equal;
    for (known, (i, j)) in known.into_iter().zip([(1, 2), (2, 0), (0, 1)]) {
        let side = match known {
            0 if only_crossings => exact.perturbed_side(i, j),
            0 => exact.side(i, j),
            known => known.cmp(&0),
        };
        if only_crossings && side == Ordering::Equal || side == all.reverse() && all != Ordering::Equal {
            return None;
        }
        all = all.then(side);
    }
    Some(all)
}

/// Between which numbers the parameter of the plane of a triangle lies that the line is not parallel to, given its first
/// vertex as seen from the origin.
#[inline(always)]
fn parameter_bounds(ray: &Ray, vertices: &[V3; 3], a: &V3) -> [f64; 2] {
    let [e, f] = [sub(vertices[1], vertices[0]), sub(vertices[2], vertices[0])];
    let (normal, sizes) = cross_with_sizes(&e, &f);
    let (height, speed) = (dot(normal, *a), dot(normal, ray.direction));
    let (height_error, speed_error) = (rounding(&sizes, a), rounding(&sizes, &ray.direction));
    let t = height / speed;
    let margin =
        (height_error + t.abs() * speed_error) / (speed.abs() - speed_error) * (1.0 + 16.0 * U) + t.abs() * (4.0 * U);
    // Not for NaN, nor where underflow matters to the quotient.
    if speed.abs() > 2.0 * speed_error && margin < f64::MAX && margin > TINY {
        [t - margin, t + margin]
    } else {
        let t = exact(ray, vertices).face().0;
        [t, t]
    }
}

/// Whether a ray certainly passes a segment or a point by more than its radius.
#[inline(always)]
fn passes_by(ray: &Ray, vertices: &[V3]) -> bool {
    let size = |x: &V3| x[0].abs().max(x[1].abs()).max(x[2].abs());
    // Across the ray, of which only the direction matters: at least its largest component is 1 now.
    let d = ray.direction.map(|x| x / size(&ray.direction));
    let square = dot(d, d);
    let across = |v: &V3| {
        let offset = sub(*v, ray.origin);
        let along = dot(offset, d) / square;
        (std::array::from_fn::<f64, 3, _>(|k| offset[k] - along * d[k]), size(&offset))
    };
    let ((a, reach_a), (b, reach_b)) = (across(&vertices[0]), across(&vertices[vertices.len() - 1]));
    let edge = sub(b, a);
    let share = (-dot(a, edge) / dot(edge, edge)).clamp(0.0, 1.0);
    let share = if share.is_nan() { 0.0 } else { share };
    let nearest = std::array::from_fn::<f64, 3, _>(|k| a[k] + share * edge[k]);
    let distance = dot(nearest, nearest).sqrt();
    // Not for NaN, nor for squares that underflow or overflow.
    let error = 256.0 * U * (reach_a + reach_b);
    distance > ray.radius * (1.0 + 16.0 * U) + error && PLAIN.contains(&distance)
}
