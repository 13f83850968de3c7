//! Three-vectors as arrays, with the order of operations spelled out: the contract fixes every rounding, so no
//! expression of the kernel may depend on how a library sums.

#![allow(clippy::inline_always, reason = "the kernels are one expression; calls would hide it from the optimiser")]

pub type V3 = [f64; 3];

#[inline(always)]
pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// (a0 b0 + a1 b1) + a2 b2, in this order everywhere.
#[inline(always)]
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub fn norm_squared(a: V3) -> f64 {
    dot(a, a)
}

#[inline(always)]
pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// s a + t b
#[inline(always)]
pub fn combine(s: f64, a: V3, t: f64, b: V3) -> V3 {
    [s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]]
}

/// a + s b
#[inline(always)]
pub fn add_scaled(a: V3, s: f64, b: V3) -> V3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Smaller and larger by comparison, which compile to one instruction each; the operands are never NaN.
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `x` moved into the box from `low` to `high`.
#[inline(always)]
pub fn clamp(x: V3, low: V3, high: V3) -> V3 {
    let x = [smaller(x[0], high[0]), smaller(x[1], high[1]), smaller(x[2], high[2])];
    [larger(x[0], low[0]), larger(x[1], low[1]), larger(x[2], low[2])]
}

/// The corners of the smallest box around some vectors.
#[inline(always)]
pub fn bounds<const N: usize>(vectors: &[V3; N]) -> [V3; 2] {
    let (mut low, mut high) = (vectors[0], vectors[0]);
    for v in &vectors[1..] {
        for k in 0..3 {
            low[k] = smaller(v[k], low[k]);
            high[k] = larger(v[k], high[k]);
        }
    }
    [low, high]
}

/// The largest magnitude of any component; components are never NaN.
#[inline(always)]
pub fn largest(vectors: &[V3]) -> f64 {
    let mut largest = 0.0;
    for x in vectors.as_flattened() {
        largest = larger(x.abs(), largest);
    }
    largest
}

/// Lexicographic order of two vectors without NaN.
pub fn lexicographically_less(a: V3, b: V3) -> bool {
    a < b
}

/// 2^e, exactly.
///
/// # Panics
/// Unless -1022 <= e <= 1023.
#[must_use]
#[inline(always)]
pub const fn power_of_two(e: i32) -> f64 {
    assert!(e >= -1022 && e <= 1023);
    f64::from_bits(((1023 + e) as u64) << 52)
}

/// floor(log2 |x|) for finite x other than zero, subnormal ones included.
pub fn exponent(x: f64) -> i32 {
    let biased = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32;
    match biased(x) {
        0 => biased(x * power_of_two(64)) - 64 - 1023,
        b => b - 1023,
    }
}

/// x 2^e, rounded once if the result is subnormal, for any e that occurs (|e| < 5000).
pub fn scale_by_power(x: f64, e: i32) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    // Bring x into [1, 2) exactly, then place it with at most one rounding.
    let own = exponent(x);
    let unit = if own >= -1000 {
        x * power_of_two((-own).max(-1022)) * if own == 1023 { 0.5 } else { 1.0 }
    } else {
        x * power_of_two(1000) * power_of_two(-own - 1000)
    };
    let target = own.saturating_add(e);
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
        // Twice rounded, 1 + 2^-52 at the last place of a subnormal would move the tie.
        let above_tie = 1.0 + f64::EPSILON;
        assert_eq!(scale_by_power(above_tie, -1075), f64::from_bits(1));
    }

    #[test]
    fn the_largest_component_is_that_of_largest_magnitude() {
        assert_eq!(largest(&[[1.0, -7.0, 2.0], [3.0; 3]]), 7.0);
        assert_eq!(largest(&[[1.0, f64::NEG_INFINITY, 2.0]]), f64::INFINITY);
    }
}
