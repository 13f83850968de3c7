//! Deviations: how far the points of a scan are from a scene, with statistics, counts and filters.
//!
//! A deviation is a distance, which is positive outside and negative inside where the scene has signs. So the module is
//! beside [`sign`](crate::sign), which decides them: [`SignedDistance::closest_points`] answers the points of a scan as
//! a batch, and [`Signed::distance`] is the deviation of each. Without signs, deviations are the distances of
//! [`p2m_core::batch::distances`]. Scenes of points have signs by [`LocalPlanes`].
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_core::BruteForce;
//! use p2m_field::deviation::{DeviationStatistics, outside};
//! use p2m_field::sign::{Signed, SignedDistance};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//!
//! let ball = ico_sphere(&IcoSphere { frequency: 6 }).unwrap();
//! let signed = SignedDistance::new(BruteForce::new(&ball).unwrap(), &ball)?;
//! // The scan is a little larger than the ball.
//! let scan: Vec<Point3<f64>> = ball.positions().iter().map(|point| point * 1.01).collect();
//! let answers = signed.closest_points(&scan, &Default::default(), &Default::default());
//! let deviation = |answer: &Option<Signed>| answer.and_then(|answer| answer.distance()).unwrap_or(f64::NAN);
//! let deviations: Vec<f64> = answers.iter().map(deviation).collect();
//! let statistics = DeviationStatistics::of(&deviations);
//! assert!((statistics.mean - 0.01).abs() < 1e-4 && statistics.standard_deviation < 1e-4);
//! assert_eq!(outside(&deviations, 0.005).above, scan.len());
//! # Ok::<(), p2m_field::sign::SignError>(())
//! ```
//!
//! [`SignedDistance::closest_points`]: crate::sign::SignedDistance::closest_points
//! [`Signed::distance`]: crate::sign::Signed::distance

mod counts;
mod isolated;
mod planes;
mod vertices;

pub use counts::{HistogramBin, OutsideTolerance, bands, histogram, outside};
pub use isolated::isolated_points;
pub use planes::LocalPlanes;
pub use vertices::{on_vertices, primitives_of_positions};

use p2m_core::Real;
use p2m_core::engine::double_double::Double;

/// The percentiles in [`DeviationStatistics`], in per cent.
pub const PERCENTILES: [u8; 7] = [1, 5, 25, 50, 75, 95, 99];

/// The statistics of some deviations, in their unit. Values that are not finite count as missing: a point has no
/// deviation if it has no closest point, or if the sign of the point is not defined.
///
/// Without any deviation, all numbers but the counts are NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DeviationStatistics {
    /// The number of deviations.
    pub count: usize,
    /// The number of values that are not finite, which nothing else here includes.
    pub missing: usize,
    /// The mean of the deviations.
    pub mean: f64,
    /// The mean of the absolute values.
    pub mean_absolute: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The root of the mean square of the differences from the mean, with the count as the divisor.
    pub standard_deviation: f64,
    /// The smallest value, which is the deepest one inside.
    pub min: f64,
    /// The largest value.
    pub max: f64,
    /// The values at [`PERCENTILES`], interpolated linearly between the two nearest in order: the p-th percentile of n
    /// values has the rank (n - 1) p / 100 from 0.
    pub percentiles: [f64; 7],
    /// The percentiles of the absolute values.
    pub absolute_percentiles: [f64; 7],
}

/// One of the numbers of [`DeviationStatistics`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NamedStatistic {
    /// The name for programs, such as `mean_absolute` or `absolute_percentile_95`.
    pub key: String,
    /// The name for people, such as `mean of absolute values`.
    pub label: String,
    /// The number, in the unit of the deviations.
    pub value: f64,
}

impl DeviationStatistics {
    /// Computes the statistics of deviations in any order.
    ///
    /// # Accuracy
    /// Sums are in double-double arithmetic of values that a power of two scales, so nothing overflows. Means and the
    /// root mean square have a relative error of a few u, the mean relative to the mean of absolute values times 2^-80
    /// where that is larger. The standard deviation is as accurate unless it is below 2^-30 of the root mean square.
    ///
    /// # Complexity
    /// O(n log n) time and 16 bytes per value.
    #[must_use]
    pub fn of<T: Real>(deviations: &[T]) -> Self {
        let mut sorted: Vec<f64> = deviations.iter().map(|x| x.to_f64()).filter(|x| x.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let missing = deviations.len() - sorted.len();
        let [min, max] = [sorted.first(), sorted.last()].map(|end| end.copied().unwrap_or(f64::NAN));
        // Absolute values of ascending numbers are a descending run and an ascending one, which this sort merges.
        let mut absolute: Vec<f64> = sorted.iter().map(|x| x.abs()).collect();
        absolute.sort_by(f64::total_cmp);
        let scale = power_of_two_below(absolute.last().copied().unwrap_or(0.0));
        let zero = Double::difference(0.0, 0.0);
        let (mut sum, mut sum_of_absolutes, mut sum_of_squares) = (zero, zero, zero);
        for value in &sorted {
            let value = value / scale;
            sum = sum + Double::difference(value, 0.0);
            sum_of_absolutes = sum_of_absolutes + Double::difference(value.abs(), 0.0);
            sum_of_squares = sum_of_squares + Double::product(value, value);
        }
        // Quotients of nothing are NaN.
        let count = Double::difference(sorted.len() as f64, 0.0);
        let (mean, mean_square) = (sum / count, sum_of_squares / count);
        let variance = (mean_square - mean * mean).round();
        Self {
            count: sorted.len(),
            missing,
            mean: mean.round() * scale,
            mean_absolute: (sum_of_absolutes / count).round() * scale,
            rms: mean_square.round().sqrt() * scale,
            standard_deviation: if variance <= 0.0 { 0.0 } else { variance.sqrt() * scale },
            min,
            max,
            percentiles: PERCENTILES.map(|percent| percentile(&sorted, percent)),
            absolute_percentiles: PERCENTILES.map(|percent| percentile(&absolute, percent)),
        }
    }

    /// Returns all numbers but the counts with their names, in the order in which tables have them.
    #[must_use]
    pub fn named(&self) -> Vec<NamedStatistic> {
        let named =
            |key: &str, label: &str, value| NamedStatistic { key: key.to_owned(), label: label.to_owned(), value };
        let mut all = vec![
            named("mean", "mean", self.mean),
            named("mean_absolute", "mean of absolute values", self.mean_absolute),
            named("rms", "root mean square", self.rms),
            named("standard_deviation", "standard deviation", self.standard_deviation),
            named("min", "smallest", self.min),
            named("max", "largest", self.max),
        ];
        for (name, values) in [("", &self.percentiles), ("absolute", &self.absolute_percentiles)] {
            for (percent, value) in PERCENTILES.into_iter().zip(values) {
                let key = format!("{name}{}percentile_{percent}", if name.is_empty() { "" } else { "_" });
                let label = format!("{percent}{} percentile", if percent == 1 { "st" } else { "th" });
                let label = if name.is_empty() { label } else { format!("{label} of {name} values") };
                all.push(NamedStatistic { key, label, value: *value });
            }
        }
        all
    }

    /// Returns the 95th percentile of the absolute values, which limits colours by default.
    #[must_use]
    pub fn usual_limit(&self) -> f64 {
        self.absolute_percentiles[5]
    }
}

/// Returns the largest power of two that is at most a finite number, or the smallest normal one.
fn power_of_two_below(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits(x.to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}

/// Returns a percentile of values in ascending order, which is NaN if there are none.
fn percentile(sorted: &[f64], percent: u8) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let hundredths = last * usize::from(percent);
    let (rank, part) = (hundredths / 100, (hundredths % 100) as f64 / 100.0);
    let low = sorted[rank];
    let high = sorted[(rank + 1).min(last)];
    let step = high - low;
    // The difference of two finite numbers may overflow.
    if step.is_finite() { low + step * part } else { low * (1.0 - part) + high * part }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::{Signed, SignedDistance};
    use dashu_int::IBig;
    use nalgebra::{Point3, Vector3};
    use p2m_bvh::AabbTree;
    use p2m_core::Soup;
    use p2m_core::engine::exact::{common_exponent, integer};
    use p2m_mixed::generate::{IcoSphere, ico_sphere};
    use p2m_testkit::{cases, normal_number, rng};
    use rand::RngExt;

    /// Checks the means of some finite values against exact integers, and the percentiles against their definition.
    fn check(values: &[f64]) {
        let found = DeviationStatistics::of(values);
        let means = [found.mean, found.mean_absolute, found.rms, found.standard_deviation];
        // All numbers are multiples of one power of two.
        let exponent = common_exponent(values.iter().chain(&means));
        let [mean, mean_absolute, rms, deviation] = means.map(|x| integer(x, exponent));
        let number = |x: f64| integer(x, 0);
        let n = number(values.len() as f64);
        let (mut sum, mut absolutes, mut squares) = (number(0.0), number(0.0), number(0.0));
        for value in values {
            let [value, absolute] = [*value, value.abs()].map(|x| integer(x, exponent));
            sum += &value;
            absolutes += absolute;
            squares += &value * &value;
        }
        // The error may be 2^-50 of the exact number and 2^-80 of another one.
        let is_near = |found: IBig, exact: &IBig, scale: &IBig| {
            let size = |x: IBig| if x < number(0.0) { -x } else { x };
            size(found - exact) * number(2f64.powi(80)) <= size(exact.clone()) * number(2f64.powi(30)) + scale
        };
        assert!(is_near(mean * &n, &sum, &absolutes), "mean of {values:?}: {found:?}");
        assert!(is_near(mean_absolute * &n, &absolutes, &number(0.0)), "mean of absolutes of {values:?}: {found:?}");
        assert!(is_near(&rms * &rms * &n, &squares, &number(0.0)), "rms of {values:?}: {found:?}");
        let variance = &n * &squares - &sum * &sum;
        let is_right = is_near(&deviation * &deviation * &n * &n, &variance, &(&n * &squares));
        assert!(is_right, "standard deviation of {values:?}: {found:?}");
        let quantile = |of: fn(&f64) -> f64, percent: u8| {
            let mut sorted: Vec<f64> = values.iter().map(of).collect();
            sorted.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let rank = f64::from(percent) / 100.0 * (sorted.len() - 1) as f64;
            let [low, high] = [rank.floor(), rank.ceil()].map(|rank| sorted[rank as usize]);
            low + (high - low) * rank.fract()
        };
        let size = values.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        for (i, percent) in PERCENTILES.into_iter().enumerate() {
            let pairs = [
                (found.percentiles[i], quantile(|x| *x, percent)),
                (found.absolute_percentiles[i], quantile(|x| x.abs(), percent)),
            ];
            for (found, expected) in pairs {
                assert!((found - expected).abs() <= 1e-12 * size, "{percent} % of {values:?}: {found}, {expected}");
            }
        }
        assert_eq!(found.min, values.iter().copied().fold(f64::INFINITY, f64::min));
        assert_eq!(found.max, values.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    }

    #[test]
    fn statistics_are_those_of_exact_integers() {
        for case in cases(2000, 60) {
            let mut rng = rng("deviation statistics", case);
            let count = rng.random_range(1..60);
            let (offset, spread) = (10f64.powi(rng.random_range(-20..20)), 10f64.powi(rng.random_range(-20..20)));
            let offset = if rng.random() { offset } else { 0.0 };
            check(&(0..count).map(|_| offset + spread * normal_number(&mut rng)).collect::<Vec<f64>>());
        }
        check(&[1.0]);
        check(&[-0.0, 0.0]);
        // In f64 the sum of these numbers is 0.
        check(&[1e17, 1.0, -1e17]);
        check(&[3e-200, -1e-200, 2e-200]);
        check(&[3e200, -1e200, 2e200]);
    }

    #[test]
    fn the_largest_and_the_smallest_numbers_have_finite_statistics() {
        for x in [f64::MAX, f64::MIN_POSITIVE, 5e-324, 0.0] {
            let found = DeviationStatistics::of(&[x, -x, x, -x]);
            assert_eq!((found.mean, found.mean_absolute, found.min, found.max), (0.0, x, -x, x));
            assert!((found.rms - x).abs() <= x * 1e-15 && found.standard_deviation == found.rms, "{found:?}");
            assert!(found.percentiles.iter().chain(&found.absolute_percentiles).all(|x| x.is_finite()), "{found:?}");
        }
    }

    #[test]
    fn what_is_not_finite_is_missing() {
        let values = [f64::NAN, 1.0, f64::INFINITY, -3.0, f64::NEG_INFINITY];
        let found = DeviationStatistics::of(&values);
        assert_eq!((found.count, found.missing, found.mean, found.min, found.max), (2, 3, -1.0, -3.0, 1.0));
        let nothing = DeviationStatistics::of::<f64>(&[]);
        assert!(nothing.count == 0 && nothing.mean.is_nan() && nothing.percentiles[3].is_nan());
        assert_eq!(DeviationStatistics::of(&[0.5f32, 0.25]).mean, 0.375);
    }

    /// Returns the deviations of points from a closed surface.
    fn deviations(soup: &Soup<f64>, scan: &[Point3<f64>]) -> Vec<f64> {
        let index = AabbTree::new(soup).unwrap();
        let signed = SignedDistance::new(index, soup).unwrap();
        let answers = signed.closest_points(scan, &Default::default(), &Default::default());
        let deviation = |answer: &Option<Signed>| answer.and_then(|answer| answer.distance()).unwrap_or(f64::NAN);
        answers.iter().map(deviation).collect()
    }

    #[test]
    fn statistics_of_a_noisy_ball_are_those_of_the_noise() {
        for offset in [0.0, 1e6] {
            let mut ball = ico_sphere(&IcoSphere::default()).unwrap();
            ball.map_positions(|p| p + Vector3::repeat(offset)).unwrap();
            // The noise is far smaller than the triangles, and it is along the normals of faces at their centres.
            let mut rng = rng("noisy ball", 0);
            let sigma = 1e-3;
            let mut noise = Vec::new();
            let scan: Vec<Point3<f64>> = ball
                .triangles()
                .iter()
                .flat_map(|t| std::iter::repeat_n(t, 40))
                .map(|t| {
                    let [a, b, c] = t.map(|i| ball.positions()[i as usize]);
                    noise.push(sigma * normal_number(&mut rng));
                    let centre = a + ((b - a) + (c - a)) / 3.0;
                    centre + (b - a).cross(&(c - a)).normalize() * noise[noise.len() - 1]
                })
                .collect();
            let found = deviations(&ball, &scan);
            let rounding = 1e-15 * (1.0 + 4.0 * offset);
            for (found, noise) in found.iter().zip(&noise) {
                assert!((found - noise).abs() <= rounding, "{offset}: {found} for {noise}");
            }
            let (found, noise) = (DeviationStatistics::of(&found), DeviationStatistics::of(&noise));
            let error = sigma / (scan.len() as f64).sqrt();
            assert!((found.mean - noise.mean).abs() <= rounding && found.mean.abs() < 4.0 * error, "{found:?}");
            assert!((found.rms - noise.rms).abs() <= rounding && (found.rms - sigma).abs() < 4.0 * error, "{found:?}");
            // A scan that is the mesh has no deviations.
            let found = DeviationStatistics::of(&deviations(&ball, ball.positions()));
            assert_eq!((found.count, found.max, found.min, found.rms), (ball.positions().len(), 0.0, 0.0, 0.0));
        }
    }
}
