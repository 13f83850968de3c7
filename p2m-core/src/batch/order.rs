//! The order of the queries of a batch: along a Hilbert curve through their box.

use crate::curve;

/// The most bits of a coordinate on the curve. The largest part of a batch, 2^20 queries, uses them all. With 7 bits,
/// times change by -1 to +3 % (docs/decisions/rejected.md).
const MAX_BITS_PER_AXIS: u32 = 8;

/// Returns the positions of the queries, sorted along the curve. The order of queries that are not finite is
/// unspecified.
///
/// The basic idea is to sort queries by cells and not by exact positions: the curve runs through a grid of 8 to 64
/// cells per query, and queries of one cell keep their order, since no order makes them any nearer to each other. The
/// keys are then so short that two passes of a counting sort, by the low half and by the high half of a key, sort them
/// in O(n).
#[allow(clippy::cast_possible_truncation, reason = "a part of a batch has at most 2^32 queries")]
pub(super) fn sorted_along_curve<Q>(queries: &[Q], position: impl Fn(&Q) -> [f64; 3]) -> Vec<u32> {
    let bits = (queries.len().max(1).ilog2() / 3 + 2).min(MAX_BITS_PER_AXIS);
    let cells = CurveCells::around(queries.iter().map(&position), bits);
    // The sort uses two digits, which together hold all bits of a key.
    let digit_bits = (3 * bits).div_ceil(2);
    let digits = |key: u32| [(key & ((1 << digit_bits) - 1)) as usize, (key >> digit_bits) as usize];
    let mut starts = [vec![0u32; 1 << digit_bits], vec![0u32; 1 << digit_bits]];
    let mut keys = Vec::with_capacity(queries.len());
    for query in queries {
        let key = cells.position(&position(query));
        let [low, high] = digits(key);
        starts[0][low] += 1;
        starts[1][high] += 1;
        keys.push(key);
    }
    for starts in &mut starts {
        let mut sum = 0;
        for start in starts {
            sum += std::mem::replace(start, sum);
        }
    }
    // The passes are stable, so sorting by the low digit and then by the high digit sorts by both.
    let mut by_low_digit = vec![(0u32, 0u32); keys.len()];
    for (position, key) in keys.into_iter().enumerate() {
        let [low, high] = digits(key);
        let to = &mut starts[0][low];
        by_low_digit[*to as usize] = (high as u32, position as u32);
        *to += 1;
    }
    let mut sorted = vec![0; by_low_digit.len()];
    for (high, position) in by_low_digit {
        let to = &mut starts[1][high as usize];
        sorted[*to as usize] = position;
        *to += 1;
    }
    sorted
}

/// A grid of cells over the box of the queries, numbered along the curve.
struct CurveCells {
    low: [f64; 3],
    scale: [f64; 3],
    bits: u32,
}

impl CurveCells {
    /// Divides the box around the finite positions into 2^bits cells on each axis.
    fn around(positions: impl Iterator<Item = [f64; 3]>, bits: u32) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for query in positions {
            if query.iter().all(|x| x.is_finite()) {
                for k in 0..3 {
                    low[k] = if query[k] < low[k] { query[k] } else { low[k] };
                    high[k] = if query[k] > high[k] { query[k] } else { high[k] };
                }
            }
        }
        // Coordinates are halved first, since the difference of two finite numbers may be infinite.
        let scale = [0, 1, 2].map(|k: usize| f64::from(1u32 << bits) / (high[k] * 0.5 - low[k] * 0.5));
        Self { low, scale, bits }
    }

    /// Returns the position on the curve of the cell that contains a query.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which keeps the order")]
    fn position(&self, query: &[f64; 3]) -> u32 {
        // NaN becomes 0. It also arises on an axis along which the box has no extent.
        let cell = |k: usize| (((query[k] * 0.5 - self.low[k] * 0.5) * self.scale[k]) as u32).min((1 << self.bits) - 1);
        curve::position([cell(0), cell(1), cell(2)], self.bits) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn the_curve_contains_every_query_once_and_neighbours_together() {
        let queries: Vec<Point3<f64>> =
            (0..4096u32).map(|i| Point3::new(f64::from(i % 16), f64::from(i / 16 % 16), f64::from(i / 256))).collect();
        let mut positions = sorted_along_curve(&queries, |query| query.coords.into());
        let steps: f64 = positions.windows(2).map(|w| (queries[w[0] as usize] - queries[w[1] as usize]).norm()).sum();
        assert!(steps / 4095.0 < 1.7, "{steps}");
        positions.sort_unstable();
        assert!(positions.into_iter().eq(0..4096));
    }

    #[test]
    fn queries_of_all_kinds_have_a_position() {
        let queries = [f64::NAN, f64::INFINITY, f64::MAX, -f64::MAX, 0.0].map(|x| Point3::new(x, x, 1.0));
        let mut positions = sorted_along_curve(&queries, |query| query.coords.into());
        positions.sort_unstable();
        assert_eq!(positions, [0, 1, 2, 3, 4]);
        assert!(sorted_along_curve(&[[0.0; 3]; 0], |query| *query).is_empty());
    }
}
