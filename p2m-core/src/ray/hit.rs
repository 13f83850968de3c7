//! Reported hits of rays.

use super::exact::Exact;
use super::plane::PlaneIntersection;
use crate::PrimitiveId;
use crate::kernel::vector::V3;
use nalgebra::Point3;

/// The side from which a ray hits a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The ray comes from the side to which the normal (b - a) x (c - a) of the triangle points.
    Front,
    /// The ray comes from the side opposite to the normal.
    Back,
    /// The ray runs in the plane of the triangle, or the primitive is a segment, a point or a triangle without area.
    Along,
}

/// A hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The primitive that is hit.
    pub primitive: PrimitiveId,
    /// The parameter of the ray, in lengths of its direction. For the primitives of this project it is the exact
    /// parameter rounded to the nearest f64, and infinite beyond the range of f64. If the ray runs along the primitive,
    /// it is the least parameter in the ray's range. If the ray has a radius, it is the parameter nearest to a segment
    /// or point.
    pub parameter: f64,
    /// The side from which the primitive is hit.
    pub side: Side,
    /// The origin of the ray, from which weights are computed on demand.
    pub(super) origin: V3,
    /// The direction of the ray, from which weights are computed on demand.
    pub(super) direction: V3,
    pub(super) source: HitSource,
}

impl Hit {
    /// Returns the weights of the vertices of the primitive, each rounded to nearest; unused ones are 0.
    ///
    /// They are only within 4 u if the ray runs along a triangle or segment and its range begins inside of it.
    #[must_use]
    pub fn barycentric(&self) -> [f64; 3] {
        match &self.source {
            HitSource::Face(vertices, _) => self.weights(vertices),
            HitSource::Known(hit) => hit.barycentric,
        }
    }

    /// Returns the point of the primitive: the rounded sum of its vertices with the [weights](Self::barycentric), which
    /// lies in its box. A vertex is returned verbatim. [`Ray::at`](crate::Ray::at) returns the point of the ray, which
    /// has a different error.
    #[must_use]
    pub fn point(&self) -> Point3<f64> {
        match &self.source {
            HitSource::Face(vertices, _) => weighted_sum(vertices, &self.weights(vertices)),
            HitSource::Known(hit) => hit.point,
        }
    }

    fn weights(&self, vertices: &[V3; 3]) -> V3 {
        let plane = PlaneIntersection::new(&self.origin, &self.direction, vertices);
        plane
            .and_then(|plane| plane.weights())
            .unwrap_or_else(|| Exact::new(&self.origin, &self.direction, 0.0, vertices).face().1)
    }
}

/// The hit on a primitive of your own, as [`Primitive::intersect_ray`](crate::Primitive::intersect_ray) returns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The parameter, in lengths of the direction.
    pub parameter: f64,
    /// The side from which the primitive is hit.
    pub side: Side,
    /// The barycentric weights, as the primitive defines them.
    pub barycentric: [f64; 3],
    /// The point of the primitive.
    pub point: Point3<f64>,
}

/// The data from which the fields of a hit are computed on demand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HitSource {
    /// The vertices of the triangle that is crossed, and the side from which it is crossed.
    Face([V3; 3], Side),
    /// A hit that has already been computed.
    Known(RayHit),
}

/// Returns the weighted sum of several vertices, clamped to the box of the vertices. A vertex of weight 1 is returned
/// verbatim.
pub(super) fn weighted_sum(vertices: &[V3], weights: &V3) -> Point3<f64> {
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
