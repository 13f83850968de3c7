//! The exact intersection of a ray and a primitive, computed in f64 if that is certain.
//!
//! All positions are relative to the origin of the ray. A, B and C are the vertices of a triangle, and D is the
//! direction. The sign of the moment D . (A x B) is the side on which the line passes the edge from A to B. The line
//! hits the triangle if no two of the three moments have opposite signs, and lies in its plane if all are zero. The
//! parameter of the plane is n . A / n . D with n = (B - A) x (C - A). [docs/proofs/rays.md] bounds the errors.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use super::exact::{Exact, LineHit};
use super::hit::{Hit, HitSource, RayHit, Side, weighted_sum};
use super::line::Ray;
use super::plane::PlaneIntersection;
use super::rounding::{PLAIN_MAGNITUDES, U, UNDERFLOW_MARGIN, cross_with_sizes, determinant_error};
use crate::kernel::vector::{V3, dot, sub};
use crate::real::to_f64_array;
use crate::{Primitive, PrimitiveId, Real};
use std::cmp::Ordering;

/// A hit whose parameter lies between known bounds, and is computed exactly on demand.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<'a> {
    ray: &'a Ray,
    low: f64,
    high: f64,
    source: HitSource,
}

impl<'a> Crossing<'a> {
    /// Returns the hit of a ray on a primitive, for a backend of your own. It is `None` for a miss, and if the
    /// parameter is out of the range of the ray or certainly exceeds `limit`. `only_crossings` is the value of
    /// [`RayCollector::only_crossings`](super::RayCollector::only_crossings).
    #[must_use]
    pub fn from_primitive<T: Real>(
        primitive: &impl Primitive<T>,
        ray: &'a Ray,
        limit: f64,
        only_crossings: bool,
    ) -> Option<Self> {
        match primitive.vertices() {
            [] => Self::from_hit(ray, primitive.intersect_ray(ray).filter(|_| !only_crossings)?),
            [a] => Self::from_vertices(ray, &[to_f64_array(a)], limit, only_crossings),
            [a, b] => Self::from_vertices(ray, &[to_f64_array(a), to_f64_array(b)], limit, only_crossings),
            [a, b, c, ..] => {
                Self::from_vertices(ray, &[to_f64_array(a), to_f64_array(b), to_f64_array(c)], limit, only_crossings)
            }
        }
    }

    /// Converts the hit of a primitive of your own, if it is in the range of the ray.
    #[must_use]
    pub fn from_hit(ray: &'a Ray, hit: RayHit) -> Option<Self> {
        // The sum turns -0 into 0.
        let t = hit.parameter + 0.0;
        let hit = RayHit { parameter: t, ..hit };
        ray.contains(t).then_some(Self { ray, low: t, high: t, source: HitSource::Known(hit) })
    }

    /// Returns the hit on a primitive of this project, given its vertices. `limit` and `only_crossings` have the same
    /// meaning as for [`from_primitive`](Self::from_primitive).
    #[inline(always)]
    pub fn from_vertices(ray: &'a Ray, vertices: &[V3], limit: f64, only_crossings: bool) -> Option<Self> {
        match vertices {
            [_, _, _] => Self::from_triangle(ray, vertices.first_chunk()?, limit, only_crossings),
            _ if only_crossings => None,
            _ => Self::from_segment(ray, vertices),
        }
    }

    /// Returns the hit on a segment or a point.
    fn from_segment(ray: &'a Ray, vertices: &[V3]) -> Option<Self> {
        if certainly_misses(ray, vertices) {
            return None;
        }
        let hit = exact(ray, vertices).segment(ray)?;
        Self::from_line_hit(ray, vertices, &hit)
    }

    fn from_line_hit(ray: &'a Ray, vertices: &[V3], hit: &LineHit) -> Option<Self> {
        let LineHit { parameter, weights } = *hit;
        let point = weighted_sum(vertices, &weights);
        Self::from_hit(ray, RayHit { parameter, side: Side::Along, barycentric: weights, point })
    }

    /// Returns the hit on a triangle. It is also `None` if its parameter certainly exceeds `limit`.
    #[inline(always)]
    fn from_triangle(ray: &'a Ray, vertices: &[V3; 3], limit: f64, only_crossings: bool) -> Option<Self> {
        let [a, b, c] = vertices;
        let offsets = [sub(*a, ray.origin), sub(*b, ray.origin), sub(*c, ray.origin)];
        let sign = |i: usize, j: usize| certain_sign(&ray.direction, &offsets[i], &offsets[j]);
        let (bc, ca, ab) = (sign(1, 2), sign(2, 0), sign(0, 1));
        let (above, below) = (bc > 0 || ca > 0 || ab > 0, bc < 0 || ca < 0 || ab < 0);
        if above && below {
            return None;
        }
        let front = if bc != 0 && ca != 0 && ab != 0 {
            below
        } else {
            match exact_side(ray, vertices, [bc, ca, ab], only_crossings)? {
                Ordering::Less => true,
                Ordering::Greater => false,
                Ordering::Equal => {
                    return Self::from_line_hit(ray, vertices, &exact(ray, vertices).coplanar(ray)?);
                }
            }
        };
        let side = if front { Side::Front } else { Side::Back };
        let [mut low, mut high] = parameter_bounds(ray, vertices, &offsets[0]);
        if low > limit || low > ray.max || high < ray.min {
            return None;
        }
        if !(ray.min <= low && high <= ray.max) {
            low = Self { ray, low, high, source: HitSource::Face(*vertices, side) }.parameter();
            high = low;
            if !ray.contains(low) {
                return None;
            }
        }
        Some(Self { ray, low, high, source: HitSource::Face(*vertices, side) })
    }

    /// Returns a lower and an upper bound on the parameter.
    #[inline(always)]
    pub fn bounds(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Returns the parameter. Computing it takes time unless the bounds are equal.
    #[inline]
    #[must_use]
    pub fn parameter(&self) -> f64 {
        match &self.source {
            _ if self.low == self.high => self.low,
            HitSource::Known(hit) => hit.parameter,
            HitSource::Face(vertices, _) => {
                let plane = PlaneIntersection::new(&self.ray.origin, &self.ray.direction, vertices);
                plane.and_then(|plane| plane.parameter()).unwrap_or_else(|| exact(self.ray, vertices).face().0)
            }
        }
    }

    /// Returns the crossing with both bounds set to the parameter.
    #[must_use]
    pub(super) fn resolved(self) -> Self {
        let t = self.parameter();
        Self { low: t, high: t, ..self }
    }

    /// Returns the side of the primitive that the ray hits.
    #[inline]
    #[must_use]
    pub fn side(&self) -> Side {
        match &self.source {
            HitSource::Face(_, side) => *side,
            HitSource::Known(hit) => hit.side,
        }
    }

    /// Returns the hit with its parameter.
    #[must_use]
    pub fn hit(&self, primitive: PrimitiveId) -> Hit {
        let side = self.side();
        let Ray { origin, direction, .. } = *self.ray;
        Hit { primitive, parameter: self.parameter(), side, origin, direction, source: self.source }
    }
}

/// Converts a ray and a primitive's vertices to integers.
#[cold]
fn exact(ray: &Ray, vertices: &[V3]) -> Exact {
    Exact::new(&ray.origin, &ray.direction, ray.radius, vertices)
}

/// Returns 1 or -1 if the moment D . (A x B) is certainly above or below zero, and 0 otherwise. The offsets A and B are
/// rounded.
#[inline(always)]
fn certain_sign(d: &V3, a: &V3, b: &V3) -> i32 {
    let (minors, sizes) = cross_with_sizes(a, b);
    let (moment, error) = (dot(*d, minors), determinant_error(&sizes, d));
    i32::from(moment > error) - i32::from(moment < -error)
}

/// Returns the side on which a line passes all edges, if f64 could not decide. `known` has the signs that f64 found.
/// The result is `None` for a miss and `Equal` for a line in the plane.
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

/// Returns bounds on the parameter of the plane of a triangle that is not parallel to the line. `a` is the first vertex
/// relative to the origin of the ray.
#[inline(always)]
fn parameter_bounds(ray: &Ray, vertices: &[V3; 3], a: &V3) -> [f64; 2] {
    let [e, f] = [sub(vertices[1], vertices[0]), sub(vertices[2], vertices[0])];
    let (normal, sizes) = cross_with_sizes(&e, &f);
    let (height, speed) = (dot(normal, *a), dot(normal, ray.direction));
    let (height_error, speed_error) = (determinant_error(&sizes, a), determinant_error(&sizes, &ray.direction));
    let t = height / speed;
    let margin =
        (height_error + t.abs() * speed_error) / (speed.abs() - speed_error) * (1.0 + 16.0 * U) + t.abs() * (4.0 * U);
    // The comparisons are false for NaN and for a margin that underflow could exceed.
    if speed.abs() > 2.0 * speed_error && margin < f64::MAX && margin > UNDERFLOW_MARGIN {
        [t - margin, t + margin]
    } else {
        let t = exact(ray, vertices).face().0;
        [t, t]
    }
}

/// Returns whether a ray certainly misses a segment or a point by more than its radius.
#[inline(always)]
fn certainly_misses(ray: &Ray, vertices: &[V3]) -> bool {
    let size = |x: &V3| x[0].abs().max(x[1].abs()).max(x[2].abs());
    // Offsets are projected along the ray. Its direction is scaled so that the largest component is 1.
    let d = ray.direction.map(|x| x / size(&ray.direction));
    let square = dot(d, d);
    let project = |v: &V3| {
        let offset = sub(*v, ray.origin);
        let along = dot(offset, d) / square;
        (std::array::from_fn::<f64, 3, _>(|k| offset[k] - along * d[k]), size(&offset))
    };
    let ((a, size_a), (b, size_b)) = (project(&vertices[0]), project(&vertices[vertices.len() - 1]));
    let edge = sub(b, a);
    let t = (-dot(a, edge) / dot(edge, edge)).clamp(0.0, 1.0);
    let t = if t.is_nan() { 0.0 } else { t };
    let nearest = std::array::from_fn::<f64, 3, _>(|k| a[k] + t * edge[k]);
    let distance = dot(nearest, nearest).sqrt();
    // The comparisons are false for NaN and for squares that underflow or overflow.
    let error = 256.0 * U * (size_a + size_b);
    distance > ray.radius * (1.0 + 16.0 * U) + error && PLAIN_MAGNITUDES.contains(&distance)
}
