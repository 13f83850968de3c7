//! Double-double arithmetic: a value as the unevaluated sum of two f64, with about 104 bits.
//!
//! Used where a sliver triangle needs its height to full relative accuracy. The error-free transformations are those
//! of [Knuth1997] (sum) and [Dekker1971] (product), the compound operations follow [Joldes2017]. No fused
//! multiply-add, so the bits are the same on every machine. Exact as long as nothing overflows (|x| < 2^990) and the
//! error terms stay above the subnormals; the kernel scales its input to guarantee both.

use super::power_of_two;
use std::ops::{Add, Div, Mul, Sub};

/// What sums of a few products of double-double numbers may be off, in parts of the sizes of what is summed: 2^-95, where
/// less than 2^-98 can be shown.
pub const ROUNDING: f64 = power_of_two(-95);

#[derive(Clone, Copy)]
pub struct Double {
    pub high: f64,
    pub low: f64,
}

/// a + b without error.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let b_part = high - a;
    let a_part = high - b_part;
    Double { high, low: (a - a_part) + (b - b_part) }
}

/// a + b without error if |a| >= |b| or a = 0.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// a b without error.
#[inline(always)]
fn two_product(a: f64, b: f64) -> Double {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1: halves of at most 26 bits
    let split = |x: f64| {
        let c = SPLITTER * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    Double { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
}

impl Double {
    /// a - b without error.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        two_sum(a, -b)
    }

    /// a b without error.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        two_product(a, b)
    }

    /// The value rounded to f64.
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
        let high = two_product(self.high, other.high);
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
        let product = sum * sum; // 1 + 2 tiny + tiny^2
        assert_eq!((product - one).round(), 2.0 * tiny);
        assert_eq!(((sum / product) - one).round(), -tiny);
        assert_eq!(two_product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON).low, f64::EPSILON * f64::EPSILON);
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
