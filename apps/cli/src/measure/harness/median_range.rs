//! Medians of measured numbers.

use serde::Serialize;

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
