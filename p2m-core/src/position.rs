//! Positions in space, for vertices of scenes and for query points.

use crate::Real;
use nalgebra::Point3;

/// Three coordinates in the scalar type `T`: a point or an array. Points and arrays of f32 are positions in f64 as
/// well, since they convert exactly. Cargo features add the types of the crates glam and mint.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, Point};
///
/// let index = BruteForce::new([Point::new(Point3::new(0.0, 3.0, 4.0))])?; // in f64
/// let distance = |answer: Option<p2m_core::Closest<f64>>| answer.map(|answer| answer.distance);
/// assert_eq!(distance(index.closest_point(&[0.0, 0.0, 0.0])), Some(5.0));
/// assert_eq!(distance(index.closest_point(&[0.0f32; 3])), Some(5.0));
/// assert_eq!(distance(index.closest_point(&Point3::<f64>::origin())), Some(5.0));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a position in space with coordinates of type `{T}`",
    note = "positions are `Point3<{T}>`, `[{T}; 3]`, and for `f64` also those of `f32`",
    note = "for points of the plane append the coordinate z = 0"
)]
pub trait Position<T: Real>: Sync {
    /// Returns the position as a point.
    fn point(&self) -> Point3<T>;
}

impl<T: Real> Position<T> for Point3<T> {
    #[inline(always)]
    fn point(&self) -> Self {
        *self
    }
}

impl<T: Real, P: Position<T> + ?Sized> Position<T> for &P {
    #[inline(always)]
    fn point(&self) -> Point3<T> {
        (**self).point()
    }
}

impl<T: Real> Position<T> for [T; 3] {
    #[inline(always)]
    fn point(&self) -> Point3<T> {
        Point3::from(*self)
    }
}

impl Position<f64> for [f32; 3] {
    #[inline(always)]
    fn point(&self) -> Point3<f64> {
        Point3::from(self.map(f64::from))
    }
}

impl Position<f64> for Point3<f32> {
    #[inline(always)]
    fn point(&self) -> Point3<f64> {
        self.map(f64::from)
    }
}

/// Implements the trait for a type with the fields x, y and z.
#[cfg(any(feature = "glam", feature = "mint"))]
macro_rules! position_of_fields {
    ($type:ty, $scalar:ty) => {
        impl Position<$scalar> for $type {
            #[inline(always)]
            fn point(&self) -> Point3<$scalar> {
                Point3::new(self.x.into(), self.y.into(), self.z.into())
            }
        }
    };
}

#[cfg(feature = "glam")]
position_of_fields!(glam::Vec3, f32);
#[cfg(feature = "glam")]
position_of_fields!(glam::Vec3, f64);
#[cfg(feature = "glam")]
position_of_fields!(glam::DVec3, f64);
#[cfg(feature = "mint")]
position_of_fields!(mint::Point3<f32>, f32);
#[cfg(feature = "mint")]
position_of_fields!(mint::Point3<f32>, f64);
#[cfg(feature = "mint")]
position_of_fields!(mint::Point3<f64>, f64);

#[cfg(all(test, feature = "glam", feature = "mint"))]
mod tests {
    use super::*;

    #[test]
    fn positions_of_other_crates_are_points() {
        let point = Point3::new(1.0, 2.0, 3.0);
        assert_eq!(Position::<f64>::point(&glam::Vec3::new(1.0, 2.0, 3.0)), point);
        assert_eq!(Position::<f64>::point(&glam::DVec3::new(1.0, 2.0, 3.0)), point);
        assert_eq!(Position::<f64>::point(&mint::Point3 { x: 1.0f32, y: 2.0, z: 3.0 }), point);
        assert_eq!(Position::<f32>::point(&mint::Point3 { x: 1.0f32, y: 2.0, z: 3.0 }), point.cast());
    }
}
