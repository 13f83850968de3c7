//! Medians and percentiles.

/// Median, least and greatest of some measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The median; of an even number the mean of the two in the middle.
    pub median: f64,
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
}

impl Spread {
    /// Of measurements in any order; `None` if there are none.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len();
        Some(Self { median: (sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0, min, max })
    }
}

/// The least of the increasing `sorted` that `parts` of `of` of them do not exceed (nearest rank); `None` if there are none.
///
/// ```
/// use p2m_tradeoff::percentile;
///
/// let sorted: Vec<u64> = (1..=2000).collect();
/// assert_eq!(percentile(&sorted, 999, 1000), Some(1998));
/// ```
#[must_use]
pub fn percentile<V: Copy>(sorted: &[V], parts: usize, of: usize) -> Option<V> {
    let rank = (sorted.len() * parts).div_ceil(of).max(1);
    sorted.get(rank.min(sorted.len()).checked_sub(1)?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_right() {
        let of = |values: &[f64]| Spread::of(values);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[3.0]), Some(Spread { median: 3.0, min: 3.0, max: 3.0 }));
        assert_eq!(of(&[5.0, 1.0, 2.0]), Some(Spread { median: 2.0, min: 1.0, max: 5.0 }));
        assert_eq!(of(&[4.0, 1.0, 2.0, 9.0]), Some(Spread { median: 3.0, min: 1.0, max: 9.0 }));
    }

    #[test]
    fn percentiles_are_of_the_nearest_rank() {
        let five = [10, 20, 30, 40, 50];
        let of = |parts| percentile(&five, parts, 100);
        assert_eq!([of(0), of(20), of(21), of(50), of(99), of(100)], [10, 10, 20, 30, 50, 50].map(Some));
        assert_eq!(percentile::<u32>(&[], 50, 100), None);
        // One in a thousand is above, and no more.
        let many: Vec<usize> = (0..3000).collect();
        let at = percentile(&many, 999, 1000).unwrap();
        assert_eq!(many.iter().filter(|value| **value > at).count(), 3);
    }
}
