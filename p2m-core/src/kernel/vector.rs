//! Vectors of three f64, as arrays with a fixed order of operations.
//!
//! The contract fixes every rounding, so no expression of the kernel may depend on the order in which a library sums.

#![allow(clippy::inline_always, reason = "the kernels are one expression; calls would hide it from the optimiser")]

use super::arithmetic::Number;
use crate::simd::Float;

pub use super::arithmetic::dot;

/// A vector of three f64.
pub type V3 = [f64; 3];

/// Returns a - b.
#[inline(always)]
pub fn sub<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns the squared length.
#[inline(always)]
pub fn norm_squared<T: Number>(a: [T; 3]) -> T {
    dot(a, a)
}

/// Returns a + b.
#[inline(always)]
pub fn add<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns s a + t b.
#[inline(always)]
pub fn combine<T: Number>(s: T, a: [T; 3], t: T, b: [T; 3]) -> [T; 3] {
    [s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]]
}

/// Returns a + s b.
#[inline(always)]
pub fn add_scaled<T: Number>(a: [T; 3], s: T, b: [T; 3]) -> [T; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Returns s a.
pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| x * s)
}

/// Returns the length, without overflow or underflow of intermediate results.
pub fn length(a: V3) -> f64 {
    let size = largest(&[a]);
    if size > 0.0 && size.is_finite() { size * norm_squared(a.map(|x| x / size)).sqrt() } else { size }
}

/// Returns the smaller number by a comparison, which compiles to one instruction. The operands must not be NaN.
#[inline(always)]
pub fn smaller<T: Float>(a: T, b: T) -> T {
    a.min(b)
}

/// Returns the larger number by a comparison, which compiles to one instruction. The operands must not be NaN.
#[inline(always)]
pub fn larger<T: Float>(a: T, b: T) -> T {
    a.max(b)
}

/// Returns the point of the box from `low` to `high` that is nearest to `x`.
#[inline(always)]
pub fn clamp<T: Float>(x: [T; 3], low: [T; 3], high: [T; 3]) -> [T; 3] {
    let x = [smaller(x[0], high[0]), smaller(x[1], high[1]), smaller(x[2], high[2])];
    [larger(x[0], low[0]), larger(x[1], low[1]), larger(x[2], low[2])]
}

/// Returns the lower and the upper corner of the smallest box around several vectors.
#[inline(always)]
pub fn bounds<T: Float, const N: usize>(vectors: &[[T; 3]; N]) -> [[T; 3]; 2] {
    let (mut low, mut high) = (vectors[0], vectors[0]);
    for v in &vectors[1..] {
        for k in 0..3 {
            low[k] = smaller(v[k], low[k]);
            high[k] = larger(v[k], high[k]);
        }
    }
    [low, high]
}

/// Returns the largest magnitude of all components, none of which may be NaN.
#[inline(always)]
pub fn largest<T: Float>(vectors: &[[T; 3]]) -> T {
    let mut largest = T::splat(0.0);
    for x in vectors.as_flattened() {
        largest = larger(x.abs(), largest);
    }
    largest
}

/// Selects `yes` where a mask is true, and `no` elsewhere.
#[inline(always)]
pub fn select<T: Float>(mask: T::Mask, yes: [T; 3], no: [T; 3]) -> [T; 3] {
    [T::select(mask, yes[0], no[0]), T::select(mask, yes[1], no[1]), T::select(mask, yes[2], no[2])]
}

/// Returns whether `a` comes before `b` in lexicographic order. Neither has a NaN component.
pub fn lexicographically_less(a: V3, b: V3) -> bool {
    a < b
}

/// Returns 2^e, exactly.
///
/// # Panics
/// It panics unless -1022 <= e <= 1023.
#[must_use]
#[inline(always)]
pub const fn power_of_two(e: i32) -> f64 {
    assert!(e >= -1022 && e <= 1023);
    f64::from_bits(((1023 + e) as u64) << 52)
}

/// Returns floor(log2 |x|) for a finite x other than zero, which may be subnormal.
pub fn exponent(x: f64) -> i32 {
    let biased = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32;
    match biased(x) {
        0 => biased(x * power_of_two(64)) - 64 - 1023,
        b => b - 1023,
    }
}

/// Returns x 2^e for |e| < 5000, rounded once if the result is subnormal.
pub fn scale_by_power(x: f64, e: i32) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    // First x is scaled exactly into [1, 2), and then to its final exponent with at most one rounding.
    let from = exponent(x);
    let unit = if from >= -1000 {
        x * power_of_two((-from).max(-1022)) * if from == 1023 { 0.5 } else { 1.0 }
    } else {
        x * power_of_two(1000) * power_of_two(-from - 1000)
    };
    let target = from.saturating_add(e);
    if target > 1023 {
        unit * f64::INFINITY
    } else if target >= -1022 {
        unit * power_of_two(target)
    } else if target >= -1080 {
        unit * power_of_two(-1000) * power_of_two(target + 1000)
    } else {
        unit * power_of_two(-1022) * power_of_two(-1022)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_by_a_power_is_exact_and_rounds_once() {
        for x in
            [1.0, -1.5, 1.0 + f64::EPSILON, f64::MAX, f64::MIN_POSITIVE, f64::from_bits(1), f64::from_bits(0xf_ffff)]
        {
            let e = exponent(x);
            let unit = scale_by_power(x, -e);
            assert!((1.0..2.0).contains(&unit.abs()), "{x:e} {unit}");
            assert_eq!(scale_by_power(unit, e), x);
        }
        assert_eq!(scale_by_power(1.0, 1024), f64::INFINITY);
        assert_eq!(scale_by_power(-1.0, 3000), f64::NEG_INFINITY);
        assert_eq!(scale_by_power(1.0, -1074), f64::from_bits(1));
        assert_eq!(scale_by_power(1.5, -1074), f64::from_bits(2));
        assert_eq!(scale_by_power(1.0, -1075), 0.0);
        assert_eq!(scale_by_power(1.5, -1075), f64::from_bits(1));
        assert_eq!(scale_by_power(f64::MAX, -2100), 0.0);
        assert_eq!(scale_by_power(f64::from_bits(1), 2097), power_of_two(1023));
        // If this were rounded twice, the first rounding would make it a tie.
        let above_tie = 1.0 + f64::EPSILON;
        assert_eq!(scale_by_power(above_tie, -1075), f64::from_bits(1));
    }

    #[test]
    fn the_largest_component_is_that_of_largest_magnitude() {
        assert_eq!(largest(&[[1.0, -7.0, 2.0], [3.0; 3]]), 7.0);
        assert_eq!(largest(&[[1.0, f64::NEG_INFINITY, 2.0]]), f64::INFINITY);
    }
}
