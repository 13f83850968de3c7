//! Rotation, scaling and translation of scenes.

use super::error::{GenerateError, in_range};
use super::portable::rotation;
use nalgebra::{Matrix3, Point3, Vector3};
use p2m_core::Soup;

/// A similarity transformation: rotations, scalings and translations in the order in which they are added.
///
/// The result is the same on every platform. Rotations by multiples of 90 degrees and scalings by powers of
/// two are exact.
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, Transform, ico_sphere};
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// let far = Transform::default().rotated_z(30.0).scaled(0.5).translated([0.0, 0.0, 1e6]).apply(&ball).unwrap();
/// assert!(far.positions().iter().all(|p| (p.z - 1e6).abs() <= 0.5));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    linear: Matrix3<f64>,
    translation: Vector3<f64>,
    /// The error of the first invalid step.
    error: Option<GenerateError>,
}

impl Default for Transform {
    /// Returns the identity.
    fn default() -> Self {
        Self { linear: Matrix3::identity(), translation: Vector3::zeros(), error: None }
    }
}

impl Transform {
    /// Adds a rotation by an angle in degrees about the x axis, counter-clockwise seen from its positive end.
    #[must_use]
    pub fn rotated_x(self, degrees: f64) -> Self {
        self.rotated(0, degrees)
    }

    /// Adds a rotation by an angle in degrees about the y axis, counter-clockwise seen from its positive end.
    #[must_use]
    pub fn rotated_y(self, degrees: f64) -> Self {
        self.rotated(1, degrees)
    }

    /// Adds a rotation by an angle in degrees about the z axis, counter-clockwise seen from its positive end.
    #[must_use]
    pub fn rotated_z(self, degrees: f64) -> Self {
        self.rotated(2, degrees)
    }

    fn rotated(self, axis: usize, degrees: f64) -> Self {
        let matrix = rotation(axis, degrees);
        let error = self.error.or(in_range(degrees.is_finite(), "angle", degrees, "finite").err());
        Self { linear: matrix * self.linear, translation: matrix * self.translation, error }
    }

    /// Adds a scaling about the origin by a positive factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let is_valid = factor > 0.0 && factor.is_finite();
        let error = self.error.or(in_range(is_valid, "scale", factor, "above 0 and finite").err());
        Self { linear: self.linear * factor, translation: self.translation * factor, error }
    }

    /// Adds a translation by a vector.
    #[must_use]
    pub fn translated(self, by: [f64; 3]) -> Self {
        let mut checks = by.iter().map(|x| in_range(x.is_finite(), "translation", *x, "finite"));
        let error = self.error.or(checks.find_map(Result::err));
        Self { translation: self.translation + Vector3::from(by), error, ..self }
    }

    /// Returns the scene with transformed positions.
    ///
    /// # Errors
    /// [`GenerateError::OutOfRange`] if any step has an angle, a translation or a factor that is not finite, or a
    /// factor that is not positive. [`GenerateError::Build`] if a coordinate overflows.
    pub fn apply(&self, scene: &Soup<f64>) -> Result<Soup<f64>, GenerateError> {
        if let Some(error) = self.error {
            return Err(error);
        }
        let positions = scene.positions().iter().map(|p| self.apply_to(p)).collect();
        Ok(Soup::new(positions, scene.elements())?)
    }

    fn apply_to(&self, p: &Point3<f64>) -> Point3<f64> {
        let m = &self.linear;
        // The order of operations is written out, because it determines the last bit. The sum of -0 and 0 is 0.
        Point3::from(Vector3::from_fn(|i, _| {
            m[(i, 0)] * p.x + m[(i, 1)] * p.y + m[(i, 2)] * p.z + self.translation[i] + 0.0
        }))
    }
}
