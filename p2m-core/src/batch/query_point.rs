//! Query points of a batch.

use crate::Real;
use nalgebra::Point3;

/// A coordinate triple that is a query point in the scalar `T`: a point or an array of that scalar. Arrays of f32 are
/// query points in f64 as well, to which they convert exactly.
pub trait QueryPoint<T: Real>: Sync {
    /// Returns the query point.
    fn point(&self) -> Point3<T>;
}

impl<T: Real> QueryPoint<T> for Point3<T> {
    #[inline(always)]
    fn point(&self) -> Self {
        *self
    }
}

impl QueryPoint<f64> for [f64; 3] {
    #[inline(always)]
    fn point(&self) -> Point3<f64> {
        Point3::from(*self)
    }
}

impl QueryPoint<f32> for [f32; 3] {
    #[inline(always)]
    fn point(&self) -> Point3<f32> {
        Point3::from(*self)
    }
}

impl QueryPoint<f64> for [f32; 3] {
    #[inline(always)]
    fn point(&self) -> Point3<f64> {
        Point3::from(self.map(f64::from))
    }
}

impl QueryPoint<f64> for Point3<f32> {
    #[inline(always)]
    fn point(&self) -> Point3<f64> {
        self.map(f64::from)
    }
}
