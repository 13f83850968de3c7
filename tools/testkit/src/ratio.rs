//! Fractions of integers of any length, and their rounding to the nearest f64.
//!
//! The leading bits are divided in f64. The result is then moved to a neighbouring f64 until both neighbours are
//! farther.

use crate::integers::{integer, lowest_bit};
use dashu_int::IBig;
use dashu_int::ops::{BitTest, UnsignedAbs};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Sub};

/// A fraction with a positive denominator.
#[derive(Clone, Debug)]
pub(crate) struct Ratio {
    pub(crate) numerator: IBig,
    pub(crate) denominator: IBig,
}

fn shifted(x: &IBig, by: i64) -> IBig {
    x << usize::try_from(by).expect("not negative")
}

impl Ratio {
    /// Returns numerator / denominator, which must not be zero.
    #[must_use]
    pub(crate) fn new(numerator: IBig, denominator: IBig) -> Self {
        assert!(denominator != IBig::ZERO);
        if denominator > IBig::ZERO {
            Self { numerator, denominator }
        } else {
            Self { numerator: -numerator, denominator: -denominator }
        }
    }

    pub(crate) fn times_power_of_two(self, exponent: i64) -> Self {
        if exponent >= 0 {
            Self { numerator: shifted(&self.numerator, exponent), ..self }
        } else {
            Self { denominator: shifted(&self.denominator, -exponent), ..self }
        }
    }

    pub(crate) fn abs(&self) -> Self {
        if self.numerator < IBig::ZERO { Self::from(0.0) - self.clone() } else { self.clone() }
    }

    /// Compares two fractions by value.
    #[must_use]
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }

    pub(crate) fn is_below(&self, other: &Self) -> bool {
        self.compare(other) == Ordering::Less
    }

    /// Returns the nearest f64, the even one in a tie. The result is infinite from the midpoint of the largest f64 and
    /// 2^1024 on, and never -0.
    #[must_use]
    pub(crate) fn round(&self) -> f64 {
        if self.numerator < IBig::ZERO {
            return match self.abs().round() {
                0.0 => 0.0,
                x => -x,
            };
        }
        // The quotient in f64 is a few units off, so it is corrected step by step.
        let mut x = self.estimate();
        while x.is_finite() {
            let up = self.compare(&middle(x));
            if up == Ordering::Greater || up == Ordering::Equal && x.to_bits() & 1 == 1 {
                x = x.next_up();
                continue;
            }
            let down = if x > 0.0 { self.compare(&middle(x.next_down())) } else { Ordering::Greater };
            if down == Ordering::Less || down == Ordering::Equal && x.to_bits() & 1 == 1 {
                x = x.next_down();
                continue;
            }
            break;
        }
        x
    }

    /// Returns a finite number near a non-negative fraction.
    fn estimate(&self) -> f64 {
        let leading = |x: &IBig| {
            let drop = x.unsigned_abs().bit_len().saturating_sub(60);
            let top = i64::try_from(x >> drop).expect("60 bits") as f64;
            (top, i32::try_from(drop).expect("short enough"))
        };
        let ((n, n_exponent), (d, d_exponent)) = (leading(&self.numerator), leading(&self.denominator));
        let exponent = n_exponent - d_exponent;
        let step = |e: i32| 2f64.powi(e.clamp(-1000, 1000));
        let x = n / d * step(exponent / 2) * step(exponent - exponent / 2);
        x.min(f64::MAX)
    }
}

/// Returns the midpoint of a finite x >= 0 and the next larger f64, or 2^1024.
#[allow(clippy::float_cmp, reason = "exactly the largest number is meant")]
fn middle(x: f64) -> Ratio {
    let next =
        if x == f64::MAX { Ratio::from(2f64.powi(1023)) + Ratio::from(2f64.powi(1023)) } else { x.next_up().into() };
    (Ratio::from(x) + next) * Ratio::from(0.5)
}

impl From<f64> for Ratio {
    fn from(x: f64) -> Self {
        let unit = if x == 0.0 { 0 } else { lowest_bit(x) };
        Self { numerator: integer(x, unit), denominator: IBig::ONE }.times_power_of_two(unit)
    }
}

impl Add for Ratio {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let numerator = self.numerator * &other.denominator + other.numerator * &self.denominator;
        Self::new(numerator, self.denominator * other.denominator)
    }
}

impl Sub for Ratio {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { numerator: -other.numerator, ..other }
    }
}

impl Mul for Ratio {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.numerator * other.numerator, self.denominator * other.denominator)
    }
}

impl Div for Ratio {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::new(self.numerator * other.denominator, self.denominator * other.numerator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_round_as_the_processor_does() {
        let round = |n: f64, d: f64| (Ratio::from(n) / Ratio::from(d)).round();
        for case in crate::cases(20_000, 5_000) {
            use rand::RngExt;
            let (i, mut rng) = (case as usize, crate::rng("fractions", case));
            // Coordinates have few bits, so that ties are common, or many bits, at all magnitudes.
            let bits = [3, 53][i % 2];
            let mut number = || {
                let mantissa = (rng.random::<u64>() >> (64 - bits)) as f64 + 1.0;
                let e: i32 = rng.random_range(-540..480);
                mantissa * 2f64.powi(e)
            };
            let (n, d) = (number(), number());
            assert_eq!(round(n, d).to_bits(), (n / d).to_bits(), "{n:e} / {d:e}");
            assert_eq!(round(-n, d).to_bits(), (-n / d + 0.0).to_bits(), "-{n:e} / {d:e}");
            let (sum, exact) = (Ratio::from(n) + Ratio::from(d), n + d);
            assert_eq!(sum.round().to_bits(), exact.to_bits(), "{n:e} + {d:e}");
        }
        let tiny = f64::from_bits(1);
        assert_eq!(round(tiny, 2.0), 0.0);
        assert_eq!(round(3.0 * tiny, 2.0), 2.0 * tiny);
        assert_eq!(round(f64::MAX, 0.5), f64::INFINITY);
        assert_eq!((Ratio::from(f64::MAX) + Ratio::from(2f64.powi(969))).round(), f64::MAX);
        assert_eq!((Ratio::from(f64::MAX) + Ratio::from(2f64.powi(970))).round(), f64::INFINITY);
        assert_eq!(round(-tiny, 4.0).to_bits(), 0);
    }
}
