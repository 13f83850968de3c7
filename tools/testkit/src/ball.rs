//! A primitive that a user of the library might define.

use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Feature, Primitive, Projection, Ray, RayHit};

/// A solid ball, which has no vertices.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// The centre of the ball.
    pub centre: Point3<f64>,
    /// The radius of the ball.
    pub radius: f64,
}

impl Primitive<f64> for Ball {
    fn aabb(&self) -> Aabb<f64> {
        let r = Vector3::repeat(self.radius);
        Aabb::from_points(&[self.centre - r, self.centre + r])
    }
    fn project(&self, query: &Point3<f64>) -> Projection {
        let v = query - self.centre;
        let outside = v.norm() > self.radius;
        let point = if outside { self.centre + v * (self.radius / v.norm()) } else { *query };
        let error = 1e-14 * (v.norm() + self.radius);
        Projection::new(query, self.aabb().clamp(point), Feature::Face, [1.0, 0.0, 0.0], error)
    }
    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        unreachable!("tests cast no rays at balls")
    }
}
