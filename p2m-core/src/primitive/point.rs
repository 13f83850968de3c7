use super::{Primitive, Projection};
use crate::kernel::scalar;
use crate::real::wide;
use crate::{Aabb, Real};
use nalgebra::Point3;

/// A point of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<T: Real> {
    /// Where it is.
    pub position: Point3<T>,
}

impl<T: Real> Point<T> {
    /// The point at `position`.
    #[must_use]
    pub fn new(position: Point3<T>) -> Self {
        Self { position }
    }
}

impl<T: Real> Primitive<T> for Point<T> {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        Aabb::of_points(&[self.position])
    }

    /// # Accuracy
    /// The distance has a relative error of at most 4 u (+ eta).
    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        let (q, v) = (wide(query), wide(&self.position));
        Projection::from_nearest(&scalar::point(q, v), q, &[v])
    }
}
