//! Rays, lines and segments of lines.

use crate::Real;
use crate::kernel::vector::V3;
use crate::real::to_f64_array;
use nalgebra::{Point3, Vector3};

/// The error of an invalid ray.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RayError {
    /// A coordinate of the origin or of the direction is NaN or infinite.
    #[error("a coordinate of the ray is not finite")]
    NonFinite,
    /// The direction is zero.
    #[error("the direction of the ray is zero")]
    ZeroDirection,
    /// The lower end of the range exceeds the upper one, or an end is NaN.
    #[error("no parameter lies between {min} and {max}")]
    EmptyRange {
        /// The lower end.
        min: f64,
        /// The upper end.
        max: f64,
    },
    /// The radius is negative, infinite or NaN.
    #[error("{0} is no radius")]
    Radius(f64),
}

/// A ray, a line, or a part of a line: the points origin + t direction for all parameters t of a range. A ray has the
/// range from 0 to infinity, and a line has the range from minus infinity to infinity.
///
/// The direction has any length but zero. Parameters are measured in lengths of the direction, so they are distances
/// only if its length is 1. All numbers are stored in f64, in which the coordinates of an f32 scene are exact.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_core::{Ray, RayError};
///
/// let ray = Ray::new(&Point3::new(0.0, 0.0, 3.0), &Vector3::new(0.0, 0.0, -2.0))?;
/// assert_eq!(ray.at(1.5), Point3::origin());
/// assert_eq!(ray.with_range(0.0, 1.0)?.range(), [0.0, 1.0]);
/// assert_eq!(Ray::new(&Point3::origin(), &Vector3::<f32>::zeros()), Err(RayError::ZeroDirection));
/// # Ok::<(), RayError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at the parameter 0.
    #[doc(hidden)]
    pub origin: V3,
    /// The direction, which is not zero.
    #[doc(hidden)]
    pub direction: V3,
    /// The least parameter, inclusive.
    #[doc(hidden)]
    pub min: f64,
    /// The largest parameter, inclusive.
    #[doc(hidden)]
    pub max: f64,
    /// The radius within which segments and points are hit, in units of the scene.
    #[doc(hidden)]
    pub radius: f64,
    /// A bound on the error of the origin, for which [`RayQuery::visit_ray_candidates`](super::RayQuery) allows.
    #[doc(hidden)]
    pub origin_error: f64,
}

impl Ray {
    /// Creates the ray from a point into a direction.
    ///
    /// # Errors
    /// It returns [`RayError::NonFinite`] and [`RayError::ZeroDirection`].
    pub fn new<T: Real>(origin: &Point3<T>, direction: &Vector3<T>) -> Result<Self, RayError> {
        let (origin, direction) = (to_f64_array(origin), to_f64_array(&Point3::from(*direction)));
        if !origin.iter().chain(&direction).all(|x| x.is_finite()) {
            return Err(RayError::NonFinite);
        }
        if direction == [0.0; 3] {
            return Err(RayError::ZeroDirection);
        }
        Ok(Self { origin, direction, min: 0.0, max: f64::INFINITY, radius: 0.0, origin_error: 0.0 })
    }

    /// Creates the ray from a point through a target. The target has the parameter 1, up to the rounding of the
    /// difference of the two points.
    ///
    /// # Errors
    /// It returns [`RayError::ZeroDirection`] for equal points and [`RayError::NonFinite`] if a coordinate or the
    /// difference is not finite.
    pub fn through<T: Real>(origin: &Point3<T>, target: &Point3<T>) -> Result<Self, RayError> {
        let [origin, target] = [to_f64_array(origin), to_f64_array(target)].map(Point3::from);
        Self::new(&origin, &(target - origin))
    }

    /// Extends the ray to a line, whose parameters range from minus infinity to infinity.
    #[must_use]
    pub fn line(self) -> Self {
        Self { min: f64::NEG_INFINITY, max: f64::INFINITY, ..self }
    }

    /// Sets the range of parameters from `min` to `max`, both included; they may be infinite.
    ///
    /// # Errors
    /// It returns [`RayError::EmptyRange`] if `min > max` or an end is NaN.
    pub fn with_range(self, min: f64, max: f64) -> Result<Self, RayError> {
        // The sums turn -0 into 0, so that equal parameters have equal bits.
        if min <= max {
            Ok(Self { min: min + 0.0, max: max + 0.0, ..self })
        } else {
            Err(RayError::EmptyRange { min, max })
        }
    }

    /// Sets the radius within which segments and points are hit, in units of the scene. It does not affect triangles.
    ///
    /// # Errors
    /// It returns [`RayError::Radius`] if the radius is negative or not finite.
    pub fn with_radius(self, radius: f64) -> Result<Self, RayError> {
        if radius >= 0.0 && radius.is_finite() { Ok(Self { radius, ..self }) } else { Err(RayError::Radius(radius)) }
    }

    /// Sets a bound on the error of the origin, in units of the scene.
    /// [`visit_ray_candidates`](super::RayQuery::visit_ray_candidates) allows for it, and hits do not depend on it.
    #[must_use]
    pub fn with_origin_error(self, origin_error: f64) -> Self {
        Self { origin_error, ..self }
    }

    /// Returns the point at the parameter 0.
    #[must_use]
    pub fn origin(&self) -> Point3<f64> {
        Point3::from(self.origin)
    }

    /// Returns the direction.
    #[must_use]
    pub fn direction(&self) -> Vector3<f64> {
        Vector3::from(self.direction)
    }

    /// Returns the least and the largest parameter.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.min, self.max]
    }

    /// Returns the radius within which segments and points are hit.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the bound on the error of the origin.
    #[must_use]
    pub fn origin_error(&self) -> f64 {
        self.origin_error
    }

    /// Returns the point at a parameter, rounded. It is NaN if the parameter is infinite and the direction has a zero.
    #[must_use]
    pub fn at(&self, parameter: f64) -> Point3<f64> {
        self.origin() + self.direction() * parameter
    }

    /// Returns whether a parameter is in the range.
    #[inline(always)]
    pub(super) fn contains(&self, parameter: f64) -> bool {
        self.min <= parameter && parameter <= self.max
    }
}
