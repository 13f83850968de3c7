//! Counts of deviations: outside of a tolerance, in bands, and in the bins of a histogram.

use p2m_core::Real;

/// The numbers of deviations outside of a tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct OutsideTolerance {
    /// The number of deviations above the tolerance.
    pub above: usize,
    /// The number of deviations below the negative tolerance.
    pub below: usize,
}

impl OutsideTolerance {
    /// Returns the part of `count` deviations that are within the tolerance, in per cent; NaN for none.
    #[must_use]
    pub fn percent_within(&self, count: usize) -> f64 {
        100.0 * (count - self.above - self.below) as f64 / count as f64
    }
}

/// Counts the deviations outside of a tolerance, which itself is inside. NaN is on no side.
#[must_use]
pub fn outside<T: Real>(deviations: &[T], tolerance: f64) -> OutsideTolerance {
    let [far_below, below, _, above, far_above] = bands(deviations, tolerance, f64::INFINITY);
    OutsideTolerance { above: above + far_above, below: far_below + below }
}

/// Counts the deviations in five bands: below `-limit`, from there to `-tolerance`, within the tolerance, from there to
/// `limit`, and above it. Each band has its inner end only. Values that are not finite are in no band.
///
/// ```
/// use p2m_field::deviation::bands;
///
/// assert_eq!(bands(&[-9.0, -2.0, -1.0, 0.0, 1.0, 3.0, 3.5, f64::NAN], 1.0, 3.0), [1, 1, 3, 1, 1]);
/// ```
#[must_use]
pub fn bands<T: Real>(deviations: &[T], tolerance: f64, limit: f64) -> [usize; 5] {
    let mut counts = [0; 5];
    for value in deviations.iter().map(|x| x.to_f64()).filter(|x| x.is_finite()) {
        let size = usize::from(value.abs() > tolerance) + usize::from(value.abs() > limit.max(tolerance));
        counts[if value > 0.0 { 2 + size } else { 2 - size }] += 1;
    }
    counts
}

/// A bin of a [`histogram`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HistogramBin {
    /// The lower end, which the bin has.
    pub low: f64,
    /// The upper end, which the bin does not have, apart from the last one of equal width.
    pub high: f64,
    /// The number of deviations in the bin.
    pub count: usize,
}

/// Counts deviations in `bins` bins of equal width between two numbers, after a bin for values below `low` and before a
/// bin for values above `high`. Values that are not finite are in no bin.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of a bin")]
pub fn histogram<T: Real>(deviations: &[T], low: f64, high: f64, bins: usize) -> Vec<HistogramBin> {
    let width = (high - low) / bins as f64;
    // The outer ends are the given numbers, to the last bit.
    let end = |i: usize| if i == bins { high } else { low + width * i as f64 };
    let bin = |low, high| HistogramBin { low, high, count: 0 };
    let inner = (0..bins).map(|i| bin(end(i), end(i + 1)));
    let mut all: Vec<HistogramBin> =
        [bin(f64::NEG_INFINITY, low)].into_iter().chain(inner).chain([bin(high, f64::INFINITY)]).collect();
    for value in deviations.iter().map(|x| x.to_f64()).filter(|x| x.is_finite()) {
        let number = match value {
            value if value < low => 0,
            value if value > high => bins + 1,
            value => {
                // Rounding may miss by one bin.
                let guess = (((value - low) / width) as usize).min(bins - 1);
                let lower = usize::from(guess > 0 && value < end(guess));
                let higher = usize::from(guess + 1 < bins && value >= end(guess + 1));
                1 + guess + higher - lower
            }
        };
        all[number].count += 1;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_testkit::{cases, normal_number, rng};
    use rand::RngExt;

    #[test]
    fn tolerances_are_inside_and_nan_is_nowhere() {
        let values = [f64::NAN, 1.0, f64::INFINITY, -3.0, f64::NEG_INFINITY];
        assert_eq!(outside(&values, 1.0), OutsideTolerance { above: 0, below: 1 });
        assert_eq!(outside(&values, 0.5), OutsideTolerance { above: 1, below: 1 });
        assert_eq!(outside(&values, 1.0).percent_within(2), 50.0);
        assert!(outside::<f64>(&[], 1.0).percent_within(0).is_nan());
        // A limit below the tolerance has no band of its own.
        assert_eq!(bands(&[0.5, 2.0, -2.0], 1.0, 0.1), [1, 0, 1, 0, 1]);
    }

    #[test]
    fn each_value_is_in_the_bin_that_has_it() {
        for case in cases(2000, 60) {
            let mut rng = rng("histogram", case);
            let (bins, scale) = (rng.random_range(1..70), 10f64.powi(rng.random_range(-9..9)));
            let (low, high) = (-scale * rng.random_range(0.0..2.0), scale * rng.random_range(0.1..2.0));
            let mut values: Vec<f64> = (0..50).map(|_| scale * normal_number(&mut rng)).collect();
            // The ends of bins are the hard cases.
            values.extend(histogram::<f64>(&[], low, high, bins).iter().flat_map(|bin| [bin.low, bin.high]));
            let found = histogram(&values, low, high, bins);
            assert_eq!(found.len(), bins + 2);
            for (i, bin) in found.iter().enumerate() {
                let is_in = |x: &&f64| {
                    let is_last = i == bins && **x == high;
                    let is_beyond = i == bins + 1 && **x == high;
                    x.is_finite() && **x >= bin.low && (**x < bin.high || is_last) && !is_beyond
                };
                assert_eq!(bin.count, values.iter().filter(is_in).count(), "{bin:?} of {low} to {high}");
                assert!(i == 0 || bin.low == found[i - 1].high);
            }
        }
    }
}
