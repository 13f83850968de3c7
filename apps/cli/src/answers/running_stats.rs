//! Statistics of numbers that are added one by one.

use p2m_mixed::statistics::figure::Length;
use std::fmt;

/// The factor 2^-64, which keeps the scaled sum of [`RunningStats`] in the range of f64.
const SUM_SCALE: f64 = 1.0 / (1u128 << 64) as f64;

/// The minimum, the maximum and the mean of numbers that are added one by one, in constant memory.
///
/// The mean is finite for any finite numbers, even if their sum is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RunningStats {
    /// The number of numbers so far.
    pub(crate) count: u64,
    /// The smallest number so far; infinity if there are none.
    pub(crate) min: f64,
    /// The largest number so far; minus infinity if there are none.
    pub(crate) max: f64,
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
    pub(crate) fn add(&mut self, x: f64) {
        self.count += 1;
        self.min = self.min.min(x);
        self.max = self.max.max(x);
        self.sum += x;
        self.scaled_sum += x * SUM_SCALE;
    }

    /// The mean of the numbers so far; NaN if there are none.
    #[allow(clippy::cast_precision_loss, reason = "more numbers than 2^53 are out of reach")]
    pub(crate) fn mean(&self) -> f64 {
        let count = self.count as f64;
        if self.sum.is_finite() { self.sum / count } else { self.scaled_sum / count / SUM_SCALE }
    }
}

impl fmt::Display for RunningStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "min {}, max {}, mean {}", Length(self.min), Length(self.max), Length(self.mean()))
    }
}
