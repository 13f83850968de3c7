//! Double-double arithmetic: a value as the unevaluated sum of two f64, with about 104 bits.
//!
//! The kernel uses it to compute the heights of sliver triangles to full relative accuracy. Predicates and certified
//! queries use it if f64 cannot decide. The error-free transformations are by \[Knuth1997\] (sum) and \[Dekker1971\]
//! (product), and the compound operations follow \[Joldes2017\]. There is no fused multiply-add, so the bits are the
//! same on every machine. The transformations are exact as long as nothing overflows (|x| < 2^990) and their error
//! terms are not subnormal. The callers guarantee both by the range of their input.

use super::power_of_two;
use std::ops::{Add, Div, Mul, Sub};

/// A bound on the error of a sum of a few products of double-double numbers, relative to the sizes of the products. It
/// is 2^-95; an error below 2^-98 can be proved.
pub const ROUNDING: f64 = power_of_two(-95);

/// A double-double number: the sum of its two parts.
#[derive(Clone, Copy)]
pub struct Double {
    /// The sum, rounded to f64.
    pub high: f64,
    /// The rest of the sum.
    pub low: f64,
}

/// Returns a + b without error.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let b_part = high - a;
    let a_part = high - b_part;
    Double { high, low: (a - a_part) + (b - b_part) }
}

/// Returns a + b without error if |a| >= |b| or a = 0.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

impl Double {
    /// Returns a - b without error.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        two_sum(a, -b)
    }

    /// Returns a b without error.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        // The factor 2^27 + 1 splits a number into two parts of at most 26 bits.
        const SPLITTER: f64 = 134_217_729.0;
        let split = |x: f64| {
            let c = SPLITTER * x;
            let high = c - (c - x);
            (high, x - high)
        };
        let high = a * b;
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        Self { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
    }

    /// Returns the number rounded to f64.
    pub fn round(self) -> f64 {
        self.high
    }
}

impl Add for Double {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let high = two_sum(self.high, other.high);
        let low = two_sum(self.low, other.low);
        let sum = fast_two_sum(high.high, high.low + low.high);
        fast_two_sum(sum.high, low.low + sum.low)
    }
}

impl Sub for Double {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for Double {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        fast_two_sum(high.high, high.low + cross)
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self { high: first, low: 0.0 };
        let second = rest.high / other.high;
        let rest = rest - other * Self { high: second, low: 0.0 };
        fast_two_sum(first, second) + Self { high: rest.high / other.high, low: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_keep_what_f64_drops() {
        let tiny = 2f64.powi(-80);
        let one = Double { high: 1.0, low: 0.0 };
        let sum = one + Double { high: tiny, low: 0.0 };
        assert_eq!((sum - one).round(), tiny);
        // The product is 1 + 2 tiny + tiny^2.
        let product = sum * sum;
        assert_eq!((product - one).round(), 2.0 * tiny);
        assert_eq!(((sum / product) - one).round(), -tiny);
        assert_eq!(Double::product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON).low, f64::EPSILON * f64::EPSILON);
    }

    #[test]
    fn a_quotient_times_its_divisor_is_the_dividend_to_a_hundred_bits() {
        for k in 1..1000 {
            let a = Double { high: f64::from(k), low: 1e-20 };
            let b = Double { high: f64::from(k * k % 97 + 3) / 7.0, low: 3e-19 };
            let error = (a / b * b - a).round();
            assert!(error.abs() <= a.high * 2f64.powi(-100), "{k}: {error:e}");
        }
    }
}
