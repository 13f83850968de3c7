//! Points of a scene.

use super::interface::Primitive;
use super::projection::Projection;
use crate::real::to_f64_array;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// A point of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<T: Real> {
    /// The position of the point.
    pub position: Point3<T>,
}

impl<T: Real> Point<T> {
    /// Creates the point at `position`.
    #[must_use]
    pub fn new(position: Point3<T>) -> Self {
        Self { position }
    }
}

impl<T: Real> Primitive<T> for Point<T> {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        Aabb::from_points(&[self.position])
    }

    /// Returns the point itself.
    ///
    /// # Accuracy
    /// The distance has a relative error of at most 4 u, plus eta.
    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        self.project_within(query, f64::INFINITY).expect("no key exceeds infinity")
    }

    #[inline(always)]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        Projection::onto_point(to_f64_array(query), &[to_f64_array(&self.position)], square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        std::slice::from_ref(&self.position)
    }

    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        None
    }
}
