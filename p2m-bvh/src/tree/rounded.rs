//! Query points rounded to f32, for nodes of boxes.

use p2m_core::engine::simd::Lanes;

/// A point of a frame in f32, rounded down and up.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rounded {
    /// The coordinates, rounded down.
    pub low: [f32; 3],
    /// The coordinates, rounded up.
    pub high: [f32; 3],
}

impl Rounded {
    /// Adds to `sum` the squares of the gaps between the point and some boxes along axis k.
    #[inline(always)]
    pub fn squared_gap<L: Lanes>(&self, k: usize, min: L, max: L, sum: L) -> L {
        let below = min.sub(L::splat(self.high[k]));
        let above = L::splat(self.low[k]).sub(max);
        let gap = below.max(above).max(L::splat(0.0));
        gap.mul_add(gap, sum)
    }

    /// Rounds a point of a frame.
    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounded both ways, which covers the rounding of the difference"
    )]
    pub fn of(point: [f64; 3]) -> Self {
        let mut result = Self { low: [0.0; 3], high: [0.0; 3] };
        for (k, x) in point.into_iter().enumerate() {
            let x = x as f32;
            // The margin is at least one unit in the last place, and the conversion errs by at most half of one.
            let margin = x.abs() * f32::EPSILON + f32::MIN_POSITIVE;
            (result.low[k], result.high[k]) = (x - margin, x + margin);
        }
        result
    }
}
