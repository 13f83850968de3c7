//! Turning, scaling and moving scenes.

use super::error::GenerateError;
use super::portable::rotation;
use nalgebra::{Matrix3, Point3, Vector3};
use p2m_core::Soup;

/// A similarity: rotations, scalings and translations, one after the other in the order in which they are added.
///
/// The same on every platform. Turns by multiples of 90 degrees and scalings by powers of two are exact.
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
    /// The first step that makes no sense.
    error: Option<GenerateError>,
}

impl Default for Transform {
    /// The one that changes nothing.
    fn default() -> Self {
        Self { linear: Matrix3::identity(), translation: Vector3::zeros(), error: None }
    }
}

impl Transform {
    /// Then rotates by that many degrees about the x axis, counter-clockwise seen from its positive end.
    #[must_use]
    pub fn rotated_x(self, degrees: f64) -> Self {
        self.rotated(0, degrees)
    }

    /// Then rotates by that many degrees about the y axis.
    #[must_use]
    pub fn rotated_y(self, degrees: f64) -> Self {
        self.rotated(1, degrees)
    }

    /// Then rotates by that many degrees about the z axis.
    #[must_use]
    pub fn rotated_z(self, degrees: f64) -> Self {
        self.rotated(2, degrees)
    }

    fn rotated(self, axis: usize, degrees: f64) -> Self {
        if !degrees.is_finite() {
            return self.refuse(GenerateError::OutOfRange { option: "angle", value: degrees, range: "finite" });
        }
        let matrix = rotation(axis, degrees);
        Self { linear: matrix * self.linear, translation: matrix * self.translation, ..self }
    }

    /// Then scales about the origin by a positive factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        if !(factor > 0.0 && factor.is_finite()) {
            let range = "above 0 and finite";
            return self.refuse(GenerateError::OutOfRange { option: "scale", value: factor, range });
        }
        Self { linear: self.linear * factor, translation: self.translation * factor, ..self }
    }

    /// Then moves by that vector.
    #[must_use]
    pub fn translated(self, by: [f64; 3]) -> Self {
        if let Some(&value) = by.iter().find(|x| !x.is_finite()) {
            return self.refuse(GenerateError::OutOfRange { option: "translation", value, range: "finite" });
        }
        Self { translation: self.translation + Vector3::from(by), ..self }
    }

    fn refuse(self, error: GenerateError) -> Self {
        Self { error: self.error.or(Some(error)), ..self }
    }

    /// The scene with its positions changed, and nothing else.
    ///
    /// # Errors
    /// [`GenerateError::OutOfRange`] for an angle, a translation or a factor that is not finite or a factor that is not
    /// positive, whenever it was added; [`GenerateError::Build`] if a coordinate overflows.
    pub fn apply(&self, scene: &Soup<f64>) -> Result<Soup<f64>, GenerateError> {
        if let Some(error) = self.error {
            return Err(error);
        }
        let positions = scene.positions().iter().map(|p| self.apply_to(p)).collect();
        Ok(Soup::new(positions, scene.elements())?)
    }

    fn apply_to(&self, p: &Point3<f64>) -> Point3<f64> {
        let m = &self.linear;
        // Spelled out: the order of the operations decides the last bit. Adding zero turns -0 into 0.
        Point3::from(Vector3::from_fn(|i, _| {
            m[(i, 0)] * p.x + m[(i, 1)] * p.y + m[(i, 2)] * p.z + self.translation[i] + 0.0
        }))
    }
}
