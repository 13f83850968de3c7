//! Rigid motions of a scene, applied to vertices and boxes.

use crate::Aabb;
use crate::kernel::vector::V3;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// The most iterations from a nearly orthogonal matrix to the nearest rotation. Two or three suffice.
const MAX_ITERATIONS: usize = 100;
/// The largest difference from a whole number, 8 u, that the roundings of a rotation leave.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The largest entry of M M^T - 1 for which a matrix M counts as a rotation.
const ROTATION_TOLERANCE: f64 = 1e-6;

/// Returns whether the first twelve numbers of a matrix, row by row, are finite, and the first three columns are a
/// rotation to within 1e-6.
///
/// # Panics
/// Panics if there are fewer than twelve numbers.
#[must_use]
pub fn is_rotation_and_translation(matrix: &[f64]) -> bool {
    let rotation = Matrix3::from_fn(|row, column| matrix[4 * row + column]);
    let deviation = (rotation * rotation.transpose() - Matrix3::identity()).amax();
    // The comparison is false for NaN.
    deviation <= ROTATION_TOLERANCE && rotation.determinant() > 0.0 && matrix[..12].iter().all(|x| x.is_finite())
}

/// Returns the isometry of a matrix of 12 numbers, row by row, whose first three columns are nearly a rotation. The
/// rotation of the isometry is the nearest one to the matrix.
///
/// # Panics
/// Panics if there are fewer than twelve numbers. Further numbers are ignored.
#[must_use]
pub fn isometry_of_matrix(matrix: &[f64]) -> Isometry3<f64> {
    let rotation = Matrix3::from_fn(|row, column| matrix[4 * row + column]);
    let translation = Vector3::from_fn(|row, _| matrix[4 * row + 3]);
    // The iteration may stop at a guess that is half a turn away, so it starts at the rotation of the matrix itself.
    let guess = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    let guess = UnitQuaternion::new_normalize(guess.into_inner());
    let rotation = UnitQuaternion::from_matrix_eps(&rotation, f64::EPSILON, MAX_ITERATIONS, guess);
    Isometry3::from_parts(Translation3::from(translation), rotation)
}

/// A rotation and a translation, in the form in which they are applied to coordinates.
///
/// # Accuracy
/// A moved vertex differs from the exact one by at most 32 u (|v| + |t|), where v is the original vertex and t the
/// translation. The rotation is normalised first, so the entries of its matrix are within 8 u (5 u were observed). If
/// all entries are within 8 u of whole numbers, they are rounded to these, so quarter turns and half turns about the
/// axes are exact. A coordinate errs by 16 u sqrt(3) |v| for both and by 3 u (|v| + |t|) for the roundings of its sum.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    matrix: Matrix3<f64>,
    translation: Vector3<f64>,
}

impl Motion {
    /// Creates the motion of an isometry.
    #[must_use]
    pub fn new(isometry: &Isometry3<f64>) -> Self {
        let rotation = UnitQuaternion::new_normalize(isometry.rotation.into_inner());
        let matrix = rotation.to_rotation_matrix().into_inner();
        let whole = matrix.map(f64::round);
        let matrix = if (matrix - whole).amax() <= ROUNDING { whole } else { matrix };
        Self { matrix, translation: isometry.translation.vector }
    }

    /// Returns the moved vertex, each coordinate rounded.
    #[must_use]
    pub fn apply(&self, vertex: V3) -> V3 {
        let m = &self.matrix;
        std::array::from_fn(|k| {
            m[(k, 0)] * vertex[0] + m[(k, 1)] * vertex[1] + m[(k, 2)] * vertex[2] + self.translation[k]
        })
    }

    /// Returns a turned vector.
    #[doc(hidden)]
    #[must_use]
    pub fn turn(&self, vector: V3) -> V3 {
        (self.matrix * Vector3::from(vector)).into()
    }

    /// Returns the vertex that the motion moves to `point`, each coordinate rounded. It differs from the exact one by
    /// at most 32 u (|p| + |t|), where p is the point and t the translation.
    #[must_use]
    pub fn apply_inverse(&self, point: V3) -> V3 {
        let t = &self.translation;
        self.apply_inverse_to_vector([point[0] - t[0], point[1] - t[1], point[2] - t[2]])
    }

    /// Returns the vector that the motion turns into `vector`, each component rounded. The translation has no effect on
    /// vectors. The result differs from the exact one by at most 32 u |v|.
    #[must_use]
    pub fn apply_inverse_to_vector(&self, vector: V3) -> V3 {
        let m = &self.matrix;
        std::array::from_fn(|k| m[(0, k)] * vector[0] + m[(1, k)] * vector[1] + m[(2, k)] * vector[2])
    }

    /// Returns the translation.
    #[must_use]
    pub fn translation(&self) -> V3 {
        self.translation.into()
    }

    /// Returns whether the rotation and the translation are finite. The rotation of a zero quaternion is not finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.matrix.iter().chain(&self.translation).all(|x| x.is_finite())
    }

    /// Returns the smallest box around the moved vertices of a box, as [`apply`](Self::apply) rounds them.
    #[must_use]
    pub fn apply_to_box(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        let [low, high] = turned_box([bounds.min.coords, bounds.max.coords], |k, j| self.matrix[(k, j)]);
        Aabb { min: (low + self.translation).into(), max: (high + self.translation).into() }
    }

    /// Returns the smallest box around the vertices of a box after the inverse of the motion, as
    /// [`apply_inverse`](Self::apply_inverse) rounds them.
    #[must_use]
    pub fn apply_inverse_to_box(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        let corners = [bounds.min.coords - self.translation, bounds.max.coords - self.translation];
        let [low, high] = turned_box(corners, |k, j| self.matrix[(j, k)]);
        Aabb { min: low.into(), max: high.into() }
    }
}

/// Returns the least and the largest coordinates of the images of the points of a box.
///
/// Coordinate k of an image is the sum of products with the factors (k, j), each rounded. Rounding is monotone, so the
/// least sum consists of the least products. The least product is at one end of the box or the other, depending on the
/// sign of the factor. There is no margin.
fn turned_box([low, high]: [Vector3<f64>; 2], factor: impl Fn(usize, usize) -> f64) -> [Vector3<f64>; 2] {
    let product = |k: usize, j: usize| {
        let factor = factor(k, j);
        let (a, b) = (factor * low[j], factor * high[j]);
        if factor >= 0.0 { (a, b) } else { (b, a) }
    };
    let sum = |k: usize| {
        let ((a, b), (c, d), (e, f)) = (product(k, 0), product(k, 1), product(k, 2));
        (a + c + e, b + d + f)
    };
    let ((a, b), (c, d), (e, f)) = (sum(0), sum(1), sum(2));
    [Vector3::new(a, c, e), Vector3::new(b, d, f)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Returns the largest difference between the entries of a matrix and of its motion.
    fn difference(matrix: &Matrix3<f64>) -> f64 {
        let numbers: Vec<f64> = (0..12).map(|i| if i % 4 == 3 { 0.0 } else { matrix[(i / 4, i % 4)] }).collect();
        (Motion::new(&isometry_of_matrix(&numbers)).matrix - matrix).amax()
    }

    #[test]
    fn every_rotation_is_the_rotation_of_its_matrix() {
        for i in 0..10_000u32 {
            // The axes have all directions. Two thirds of the angles are half a turn, and the others go from 0 to 10
            // radians.
            let [x, y, z] = [0.618_034, 0.754_877, 0.569_840].map(|step: f64| (f64::from(i) * step).fract() - 0.5);
            let axis = nalgebra::Unit::new_normalize(Vector3::new(x, y, z));
            let angle = if i % 3 == 0 { f64::from(i) * 1e-3 } else { PI };
            let matrix = Rotation3::from_axis_angle(&axis, angle).into_inner();
            let found = difference(&matrix);
            assert!(found < 4e-15, "{found} {axis:?} {angle}");
            // The rotation nearest to a nearly orthogonal matrix is at least as near to it as the rotation that was
            // sheared.
            let sheared = matrix + Matrix3::new(0.0, 1e-9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
            assert!(difference(&sheared) < 1e-9, "{axis:?} {angle}");
        }
    }

    #[test]
    fn turns_that_permute_the_axes_are_exact() {
        let mut turns = 0;
        for permutation in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]] {
            for signs in 0..8 {
                let sign = |row: usize| if signs >> row & 1 == 1 { -1.0 } else { 1.0 };
                let matrix = Matrix3::from_fn(|row, column| if permutation[row] == column { sign(row) } else { 0.0 });
                if matrix.determinant() > 0.0 {
                    assert_eq!(difference(&matrix), 0.0, "{matrix}");
                    turns += 1;
                }
            }
        }
        assert_eq!(turns, 24);
    }
}
