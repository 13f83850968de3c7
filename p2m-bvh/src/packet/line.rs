//! The line of a ray in f64, scaled so that lengths along it can be bounded.

use p2m_core::Ray;
use p2m_core::engine::ray::{UNDERFLOW_MARGIN, project_onto_ray};
use p2m_core::engine::vector::power_of_two;

/// The line of a ray, scaled so that the largest component of its direction is 1 or -1.
#[derive(Clone, Copy, Debug)]
pub struct RayLine {
    /// The origin of the line: the origin of the ray, or a point of the ray's line near the scene.
    pub origin: [f64; 3],
    /// The direction of the ray, divided by `divisor`.
    pub direction: [f64; 3],
    /// The axis along which the component of the direction is 1 or -1.
    pub axis: usize,
    /// The magnitude of the largest component of the ray's direction.
    pub divisor: f64,
    /// The length from the origin of the ray to the origin of the line.
    pub origin_length: f64,
    /// The distance, in units of the scene, at which the line still hits segments and points.
    pub radius: f64,
    /// A bound on the error of the origin, in units of the scene.
    pub origin_error: f64,
}

/// A bound on the relative error of lengths along a line: 2^-50.
const LENGTH_ROUNDING: f64 = power_of_two(-50);

impl RayLine {
    /// Returns the line of a ray that hits segments and points within `radius`.
    #[inline(always)]
    pub fn from_ray(ray: &Ray, radius: f64) -> Self {
        let d = ray.direction;
        let axis = if d[0].abs() >= d[1].abs() && d[0].abs() >= d[2].abs() {
            0
        } else if d[1].abs() >= d[2].abs() {
            1
        } else {
            2
        };
        let divisor = d[axis].abs();
        let direction = [d[0] / divisor, d[1] / divisor, d[2] / divisor];
        Self {
            origin: ray.origin,
            direction,
            axis,
            divisor,
            origin_length: 0.0,
            radius,
            origin_error: ray.origin_error,
        }
    }

    /// Returns the line of a ray whose origin is the projection of a point.
    ///
    /// It serves rays whose origin is so far away that f64 could not resolve the scene from there. The projection is
    /// rounded once.
    #[cold]
    #[inline(never)]
    pub fn from_afar(ray: &Ray, radius: f64, point: &[f64; 3]) -> Self {
        let line = Self::from_ray(ray, radius);
        let (origin, origin_length) = project_onto_ray(ray, point, line.axis);
        let origin_error = origin.iter().fold(0.0, |a: f64, x| a.max(x.abs())) * LENGTH_ROUNDING + UNDERFLOW_MARGIN;
        let origin_error = origin_error + ray.origin_error;
        Self { origin, origin_length, origin_error, ..line }
    }

    /// Returns the length from the origin of the line to a parameter of the ray, rounded down.
    #[inline(always)]
    pub fn length_below(&self, parameter: f64) -> f64 {
        let (length, error) = self.length(parameter);
        // Infinite parameters and lengths that overflow give NaN, for which the comparison is false.
        if length - error > f64::MIN { length - error } else { f64::NEG_INFINITY }
    }

    /// Returns the length from the origin of the line to a parameter of the ray, rounded up.
    #[inline(always)]
    pub fn length_above(&self, parameter: f64) -> f64 {
        let (length, error) = self.length(parameter);
        if length + error < f64::MAX { length + error } else { f64::INFINITY }
    }

    /// Returns the length from the origin of the line to a parameter of the ray, and a bound on its error.
    #[inline(always)]
    fn length(&self, parameter: f64) -> (f64, f64) {
        let length = parameter * self.divisor;
        (
            length - self.origin_length,
            (length.abs() + self.origin_length.abs()) * LENGTH_ROUNDING
                + self.divisor * UNDERFLOW_MARGIN
                + self.origin_error,
        )
    }
}
