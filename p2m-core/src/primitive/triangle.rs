//! Triangles of a scene.

use super::interface::Primitive;
use super::projection::Projection;
use crate::real::to_f64_array;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// A triangle with its interior. It is a segment if its vertices are collinear, and a point if they are equal.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{Feature, Primitive, Triangle};
///
/// let triangle = Triangle::new(Point3::origin(), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0));
/// let nearest = triangle.project(&Point3::new(1.0, -1.0, 0.0));
/// assert_eq!((nearest.point, nearest.feature), (Point3::new(1.0, 0.0, 0.0), Feature::Edge(0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<T: Real> {
    /// The vertices. Their order numbers the features, and does not change the distance or the nearest point.
    pub vertices: [Point3<T>; 3],
}

impl<T: Real> Triangle<T> {
    /// Creates the triangle of `a`, `b` and `c`.
    #[must_use]
    pub fn new(a: Point3<T>, b: Point3<T>, c: Point3<T>) -> Self {
        Self { vertices: [a, b, c] }
    }
}

impl<T: Real> Primitive<T> for Triangle<T> {
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
        Projection::onto_triangle(to_f64_array(query), &self.vertices.each_ref().map(to_f64_array), square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        &self.vertices
    }

    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        None
    }
}
