//! Hits of rays, as they are reported.

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
    /// The ray comes from the side opposite of the normal.
    Back,
    /// The ray runs in the plane of the triangle, or the primitive is a segment, a point or a triangle without area.
    Along,
}

/// A hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The primitive that is hit.
    pub primitive: PrimitiveId,
    /// The parameter of the ray, in lengths of its direction. For the primitives of this project it is the exact one
    /// rounded to the nearest f64, and infinite beyond the range of f64. If the ray runs along the primitive, it is the
    /// least parameter in its range. If the ray has a radius, it is the one nearest to a segment or point.
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
    /// They are within 4 u where the range of the ray begins inside of a triangle or segment that it runs along.
    #[must_use]
    pub fn barycentric(&self) -> [f64; 3] {
        match &self.source {
            HitSource::Face(vertices, _) => self.weights(vertices),
            HitSource::Known(hit) => hit.barycentric,
        }
    }

    /// Returns the point of the primitive: the rounded sum of its vertices with the [weights](Self::barycentric),
    /// which lies in its box. A vertex is returned verbatim. [`Ray::at`](crate::Ray::at) is the point of the ray,
    /// whose error differs.
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

/// The hit of a primitive of your own, as it answers [`Primitive::intersect_ray`](crate::Primitive::intersect_ray).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The parameter, in lengths of the direction.
    pub parameter: f64,
    /// The side from which the primitive is hit.
    pub side: Side,
    /// The weights, as the primitive defines them.
    pub barycentric: [f64; 3],
    /// The point of the primitive.
    pub point: Point3<f64>,
}

/// The data that a hit is computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HitSource {
    /// The vertices of a triangle that is crossed, and the side from which it is.
    Face([V3; 3], Side),
    /// A hit that is computed already.
    Known(RayHit),
}

/// Returns the sum of some vertices with weights, clamped to the box of the vertices. A vertex of weight 1
/// is returned verbatim.
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
