//! Segments of a scene.

use super::interface::Primitive;
use super::projection::Projection;
use crate::real::to_f64_array;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// A line segment. It is a point if its vertices are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<T: Real> {
    /// The two end points.
    pub vertices: [Point3<T>; 2],
}

impl<T: Real> Segment<T> {
    /// Creates the segment from `a` to `b`.
    #[must_use]
    pub fn new(a: Point3<T>, b: Point3<T>) -> Self {
        Self { vertices: [a, b] }
    }
}

impl<T: Real> Primitive<T> for Segment<T> {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        Aabb::from_points(&self.vertices)
    }

    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        self.project_within(query, f64::INFINITY).expect("no key exceeds infinity")
    }

    #[inline(always)]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        Projection::onto_segment(to_f64_array(query), &self.vertices.each_ref().map(to_f64_array), square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        &self.vertices
    }

    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        None
    }
}
