//! Upper bounds on the heights of moved k-DOPs.
//!
//! A k-DOP that is moved has faces of other directions. Let a direction be a combination of three normals with weights
//! that are not negative. The height along it is then at most the same combination of the heights along these normals.
//! The combinations depend on the movement alone, so they are computed once.

use crate::{Directions, Kdop};
use nalgebra::{Isometry3, Matrix3, Vector3};

/// A combination of three normals that equals a direction, apart from rounding.
#[derive(Clone, Copy, Debug)]
struct Combination {
    /// The indices of the normals with their weights, which are not negative.
    terms: [(usize, f64); 3],
    /// A bound on the error of the sum, relative to the largest height.
    error: f64,
}

/// Upper bounds on the heights of moved k-DOPs along other directions.
pub(crate) struct MovedHeights<const K: usize, const L: usize> {
    /// The combinations for each of the L directions.
    combinations: Vec<Vec<Combination>>,
    /// The heights that the translation adds.
    shift: [f64; L],
    /// A bound on the error of these.
    shift_error: f64,
}

/// The number of combinations that are kept for a direction. The narrowest are kept, because others are rarely better.
const MAX_COMBINATIONS: usize = 4;
/// The least volume that three normals span if they are combined: 2^-21. The first three of any directions span at
/// least twice as much.
const MIN_VOLUME: f64 = 1.0 / (1u32 << 21) as f64;
/// A bound on the relative error of movements and products: 2^-46.
const ROUNDING: f64 = 1.0 / (1u64 << 46) as f64;

impl<const K: usize, const L: usize> MovedHeights<K, L> {
    /// Computes the combinations for k-DOPs of directions `from`, moved by `motion`, along directions `to`.
    ///
    /// Let A be the linear map of the motion's quaternion and t its translation. Let m be a direction, d = A^T m, and x
    /// a point of a k-DOP whose heights h_i have magnitudes of at most s. Then m . (A x + t) = d . x + m . t. For
    /// weights w_i >= 0 and r = d - sum w_i n_i, d . x is at most sum w_i h_i + |r| |x|. Here |x| is at most s times
    /// the norm of the vector that the inverse of the first three normals, with absolute values, makes of (1, 1, 1).
    /// Any weights are therefore valid if the computed |r| is added.
    ///
    /// Let u = 2^-53. The error of d is at most 25 u, that of r at most 4 u (1 + sum w_i) more, that of sum w_i h_i at
    /// most 4 u s sum w_i, and that of m . t at most 3 u |t|. The computed position of a point after the motion or its
    /// inverse errs by at most 57 u (|x| + |t|). All of these together and the sums are less than 2^-46 = 128 u of (1 +
    /// sum w_i) |x| and of |t|. If the square of the quaternion is 1 + e, the computed inverse of the motion errs by at
    /// most 5 e.
    pub(crate) fn new(from: &Directions<K>, motion: &Isometry3<f64>, to: &Directions<L>) -> Self {
        let normals = from.normals();
        let first = Matrix3::from_rows(&[0, 2, 4].map(|i: usize| normals[i].transpose()));
        let inverse = first.try_inverse().expect("directions do not lie in a plane");
        let point_ratio = (inverse.abs() * Vector3::repeat(1.0)).norm() * (1.0 + MIN_VOLUME);
        let rounding = ROUNDING + 5.0 * (motion.rotation.quaternion().norm_squared() - 1.0).abs();
        let combinations = to.normals().iter().map(|normal| {
            let direction = motion.rotation.inverse() * normal;
            let mut candidates = Vec::new();
            for a in 0..K {
                for b in a + 1..K {
                    for c in b + 1..K {
                        let columns = Matrix3::from_columns(&[normals[a], normals[b], normals[c]]);
                        if columns.determinant().abs() < MIN_VOLUME {
                            continue;
                        }
                        let Some(inverse) = columns.try_inverse() else { continue };
                        let weights: Vector3<f64> = inverse * direction;
                        // A weight that may be negative by rounding alone becomes 0, and the remainder allows for it.
                        if weights.min() >= -1e-12 {
                            let weights = weights.map(|x| x.max(0.0));
                            let remainder = (direction - columns * weights).norm();
                            let error = (remainder + rounding * (1.0 + weights.sum())) * point_ratio;
                            let terms = [(a, weights.x), (b, weights.y), (c, weights.z)];
                            candidates.push((weights.sum(), Combination { terms, error }));
                        }
                    }
                }
            }
            // The sum of the weights is 1 for a normal itself, and grows with the angles between the normals
            // and the direction.
            candidates.sort_by(|x, y| x.0.total_cmp(&y.0));
            candidates.into_iter().take(MAX_COMBINATIONS).map(|(_, combination)| combination).collect()
        });
        let translation = &motion.translation.vector;
        Self {
            combinations: combinations.collect(),
            shift: std::array::from_fn(|i| to.normals()[i].dot(translation)),
            // The last term is for underflow.
            shift_error: rounding * translation.abs().sum() + f64::MIN_POSITIVE,
        }
    }

    /// Returns a k-DOP of the other directions around a moved one.
    pub(crate) fn around(&self, moved: &Kdop<K>) -> Kdop<L> {
        let size = moved.heights.iter().fold(0.0, |a: f64, h| a.max(h.abs()));
        let height = |i: usize| {
            let height_by = |c: &Combination| {
                c.terms.iter().map(|(i, weight)| weight * moved.heights[*i]).sum::<f64>() + c.error * size
            };
            let least =
                self.combinations[i].iter().map(|c| infinite_if_overflowed(height_by(c))).fold(f64::INFINITY, f64::min);
            infinite_if_overflowed(least + self.shift[i] + self.shift_error)
        };
        Kdop { heights: std::array::from_fn(height) }
    }
}

/// Replaces a height that is NaN or infinite, because terms of it overflowed, by infinity.
fn infinite_if_overflowed(height: f64) -> f64 {
    if height.is_finite() { height } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_testkit::{cases, rng};
    use rand::RngExt;

    #[test]
    fn bounds_of_moved_heights_hold_and_are_exact_without_movement() {
        let (from, to) = (Directions::<14>::default(), Directions::<18>::default());
        for case in cases(200, 60) {
            let mut rng = rng("moved heights", case);
            let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0));
            let motion = Isometry3::new(vector(), vector());
            let points: Vec<_> = (0..5).map(|_| Point3::from(vector())).collect();
            let around = MovedHeights::new(&from, &motion, &to).around(&Kdop::from_points(&from, &points));
            let moved: Vec<_> = points.iter().map(|p| motion * p).collect();
            let exact = Kdop::from_points(&to, &moved);
            assert!(around.contains(&exact), "{around:?} {exact:?}");
            let kdop = Kdop::from_points(&from, &points);
            let same = MovedHeights::new(&from, &Isometry3::identity(), &from).around(&kdop);
            assert!(same.heights.iter().zip(&kdop.heights).all(|(a, b)| a >= b && a - b < 1e-12), "{same:?} {kdop:?}");
        }
    }
}
