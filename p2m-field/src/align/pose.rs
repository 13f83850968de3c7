//! Poses of a scan: rotations about its centre, with translations.

use nalgebra::{Matrix4, Point3, Quaternion, UnitQuaternion, Vector3};

/// A similarity that maps x to `to + scale * rotation * (x - from)`.
///
/// Its parts stay accurate far from the origin, where a matrix does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) rotation: UnitQuaternion<f64>,
    pub(super) scale: f64,
    /// The centre of the scan.
    pub(super) from: Point3<f64>,
    /// The image of the centre.
    pub(super) to: Point3<f64>,
    /// The distance from which on points have no weight in the next round.
    pub(super) limit: f64,
}

impl Pose {
    /// Returns the pose that moves nothing, about a centre.
    pub(super) fn identity(centre: Point3<f64>) -> Self {
        let rotation = UnitQuaternion::identity();
        Self { rotation, scale: 1.0, from: centre, to: centre, limit: f64::INFINITY }
    }

    /// Moves a point.
    pub(super) fn apply(&self, point: &Point3<f64>) -> Point3<f64> {
        self.to + self.rotation * (point - self.from) * self.scale
    }

    /// Returns the pose followed by a small motion about the image of the centre: by a rotation vector, a translation
    /// and a relative change of the scale.
    ///
    /// The rotation by the vector w is the rotation of the quaternion (1, w / 2), so it needs no functions that differ
    /// between platforms, and never exceeds half a turn.
    pub(super) fn then(&self, rotation: Vector3<f64>, translation: Vector3<f64>, growth: f64) -> Self {
        let turn = UnitQuaternion::new_normalize(Quaternion::from_parts(1.0, rotation / 2.0));
        Self {
            rotation: UnitQuaternion::new_normalize((turn * self.rotation).into_inner()),
            scale: self.scale * (1.0 + growth),
            from: self.from,
            to: self.to + translation,
            limit: self.limit,
        }
    }

    /// Returns the matrix for column vectors (x, y, z, 1).
    pub(super) fn matrix(&self) -> Matrix4<f64> {
        let linear = self.rotation.to_rotation_matrix().into_inner() * self.scale;
        let translation = self.to - linear * self.from.coords;
        let mut matrix = linear.to_homogeneous();
        matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&translation.coords);
        matrix
    }
}
