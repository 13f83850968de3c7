use super::{Primitive, Projection, UNBOUNDED, in_box};
use crate::real::to_f64_array;
use crate::{Aabb, Real};
use nalgebra::Point3;

/// A line segment. Two equal vertices make it a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<T: Real> {
    /// Its end points.
    pub vertices: [Point3<T>; 2],
}

impl<T: Real> Segment<T> {
    /// The segment from `a` to `b`.
    #[must_use]
    pub fn new(a: Point3<T>, b: Point3<T>) -> Self {
        Self { vertices: [a, b] }
    }
}

impl<T: Real> Primitive<T> for Segment<T> {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        Aabb::of_points(&self.vertices)
    }

    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        self.project_within(query, f64::INFINITY).expect(UNBOUNDED)
    }

    #[inline(always)]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        Projection::of_segment(to_f64_array(query), &self.vertices.each_ref().map(to_f64_array), square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        &self.vertices
    }

    fn meets_box(&self, bounds: &Aabb<T>) -> bool {
        in_box::meets(&self.vertices, bounds)
    }
}
