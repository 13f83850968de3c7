//! Medians and running statistics of measured numbers.

use serde::Serialize;
use std::fmt;

/// The median, the minimum and the maximum of some measurements.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MedianRange {
    /// The median; for an even number of values the mean of the two in the middle.
    pub median: f64,
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
}

impl MedianRange {
    /// Computes the quantiles of values in any order. Returns `None` if there are none.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len();
        Some(Self { median: (sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0, min, max })
    }
}

/// The factor 2^-64, which keeps the scaled sum of [`RunningStats`] in the range of f64.
const SUM_SCALE: f64 = 1.0 / (1u128 << 64) as f64;

/// The minimum, the maximum and the mean of numbers that are added one by one, in constant memory.
///
/// The mean is finite for any finite numbers, even if their sum is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunningStats {
    count: u64,
    min: f64,
    max: f64,
    sum: f64,
    /// The sum of the numbers times [`SUM_SCALE`]. It replaces a sum that overflows.
    scaled_sum: f64,
}

impl Default for RunningStats {
    fn default() -> Self {
        Self { count: 0, min: f64::INFINITY, max: f64::NEG_INFINITY, sum: 0.0, scaled_sum: 0.0 }
    }
}

impl RunningStats {
    /// Adds a number.
    pub fn add(&mut self, x: f64) {
        self.count += 1;
        self.min = self.min.min(x);
        self.max = self.max.max(x);
        self.sum += x;
        self.scaled_sum += x * SUM_SCALE;
    }

    /// The number of numbers so far.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The smallest number so far; infinity if there are none.
    #[must_use]
    pub fn min(&self) -> f64 {
        self.min
    }

    /// The largest number so far; minus infinity if there are none.
    #[must_use]
    pub fn max(&self) -> f64 {
        self.max
    }

    /// The mean of the numbers so far; NaN if there are none.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "more numbers than 2^53 are out of reach")]
    pub fn mean(&self) -> f64 {
        let count = self.count as f64;
        if self.sum.is_finite() { self.sum / count } else { self.scaled_sum / count / SUM_SCALE }
    }
}

impl fmt::Display for RunningStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "min {:?}, max {:?}, mean {:?}", self.min, self.max, self.mean())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_right() {
        let of = |values: &[f64]| MedianRange::of(values);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[3.0]), Some(MedianRange { median: 3.0, min: 3.0, max: 3.0 }));
        assert_eq!(of(&[5.0, 1.0, 2.0]), Some(MedianRange { median: 2.0, min: 1.0, max: 5.0 }));
        assert_eq!(of(&[4.0, 1.0, 2.0, 9.0]), Some(MedianRange { median: 3.0, min: 1.0, max: 9.0 }));
    }
}
