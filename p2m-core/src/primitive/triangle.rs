use super::{Primitive, Projection, UNBOUNDED, in_box};
use crate::real::to_f64_array;
use crate::{Aabb, Real};
use nalgebra::Point3;

/// A triangle with its inside. Three collinear vertices make it a segment, three equal ones a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<T: Real> {
    /// Its vertices. Their order numbers the features and does not change the distance or the nearest point.
    pub vertices: [Point3<T>; 3],
}

impl<T: Real> Triangle<T> {
    /// The triangle of `a`, `b` and `c`.
    #[must_use]
    pub fn new(a: Point3<T>, b: Point3<T>, c: Point3<T>) -> Self {
        Self { vertices: [a, b, c] }
    }
}

impl<T: Real> Primitive<T> for Triangle<T> {
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
        Projection::of_triangle(to_f64_array(query), &self.vertices.each_ref().map(to_f64_array), square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        &self.vertices
    }

    fn meets_box(&self, bounds: &Aabb<T>) -> bool {
        in_box::meets(&self.vertices, bounds)
    }
}
