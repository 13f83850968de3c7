//! Bounds on the rounding of determinants of three vectors in f64, which [docs/proofs/rays.md] derives.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use crate::kernel::power_of_two;
use crate::kernel::vector::V3;

/// The unit roundoff u of f64.
pub(super) const U: f64 = f64::EPSILON / 2.0;
/// The magnitudes for which products of three factors neither overflow nor lose more to underflow than their error
/// bounds cover.
pub(super) const PLAIN_MAGNITUDES: std::ops::RangeInclusive<f64> = power_of_two(-250)..=power_of_two(250);
/// An upper bound on the loss of products and parameters to underflow, relative to their other factors.
pub const UNDERFLOW_MARGIN: f64 = power_of_two(-1000);

/// Returns a bound on the error of a sum of three products of differences. `sizes` has the sum of magnitudes of each
/// component of the first factor, and `x` is the second factor.
#[inline(always)]
pub(super) fn determinant_error(sizes: &V3, x: &V3) -> f64 {
    let [a, b, c] = [x[0].abs(), x[1].abs(), x[2].abs()];
    10.0 * U * (a * sizes[0] + b * sizes[1] + c * sizes[2]) + UNDERFLOW_MARGIN * (1.0 + a + b + c)
}

/// Returns the cross product of two vectors, and for each component the sum of the magnitudes of its two products.
#[inline(always)]
pub(super) fn cross_with_sizes(a: &V3, b: &V3) -> (V3, V3) {
    let [p, q, r] = [[a[1] * b[2], a[2] * b[1]], [a[2] * b[0], a[0] * b[2]], [a[0] * b[1], a[1] * b[0]]];
    let sum = |[x, y]: [f64; 2]| x.abs() + y.abs();
    ([p[0] - p[1], q[0] - q[1], r[0] - r[1]], [sum(p), sum(q), sum(r)])
}
