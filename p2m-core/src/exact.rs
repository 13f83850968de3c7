//! Exact arithmetic: floats as big integers in units of a common power of two, and fractions of them.
//!
//! It decides whenever the rounding of floats could change an answer.

use crate::kernel::power_of_two;
use dashu_int::ops::{BitTest, UnsignedAbs};
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;

/// A vector of three integers.
pub type Vector = [IBig; 3];

/// Returns the signed mantissa of a finite f64, and the exponent of its lowest bit.
fn decompose(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let (mantissa, exponent) = match (bits >> 52) & 0x7ff {
        0 => (fraction, -1074),
        #[allow(clippy::cast_possible_truncation, reason = "eleven bits")]
        biased => (fraction | 1 << 52, biased as i32 - 1075),
    };
    (if x.is_sign_negative() { -mantissa } else { mantissa }, exponent)
}

/// Returns the largest e such that all these finite numbers are multiples of 2^e, or 0 if all are zero.
pub fn common_exponent<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> i32 {
    let lowest = |x: &f64| {
        let (mantissa, exponent) = decompose(*x);
        (mantissa != 0).then(|| exponent + mantissa.trailing_zeros().cast_signed())
    };
    numbers.into_iter().filter_map(lowest).min().unwrap_or(0)
}

/// Returns x / 2^exponent. `x` has to be a multiple of 2^exponent.
pub fn integer(x: f64, exponent: i32) -> IBig {
    let (mantissa, lowest_bit) = decompose(x);
    let shift = (lowest_bit - exponent).unsigned_abs() as usize;
    if lowest_bit >= exponent { IBig::from(mantissa) << shift } else { IBig::from(mantissa) >> shift }
}

/// Returns (p - a) / 2^exponent. All coordinates have to be multiples of 2^exponent.
pub fn difference<const N: usize>(p: [f64; N], a: [f64; N], exponent: i32) -> [IBig; N] {
    std::array::from_fn(|k| integer(p[k], exponent) - integer(a[k], exponent))
}

/// Returns the dot product of two vectors.
pub fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Returns component k of the cross product of two vectors.
pub fn cross_component(a: &Vector, b: &Vector, k: usize) -> IBig {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    &a[i] * &b[j] - &a[j] * &b[i]
}

/// Returns the cross product of two vectors.
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| cross_component(a, b, k))
}

/// Returns the sign of an integer, as the comparison with zero.
pub fn sign(x: &IBig) -> Ordering {
    x.cmp(&IBig::ZERO)
}

/// A fraction with a positive denominator.
#[derive(Clone, Debug)]
pub struct Fraction {
    /// The numerator, of either sign.
    pub numerator: IBig,
    /// The denominator, which is positive.
    pub denominator: IBig,
}

impl Fraction {
    /// Compares two fractions.
    pub fn compare(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }

    /// Returns the fraction times 2^exponent, rounded to the nearest f64 with ties to even. It is infinite beyond the
    /// range of f64, and never -0.
    ///
    /// # Panics
    /// If a number has 2^63 bits or more.
    pub fn round(&self, exponent: i32) -> f64 {
        let negative = sign(&self.numerator) == Ordering::Less;
        let numerator = (&self.numerator).unsigned_abs();
        let denominator = (&self.denominator).unsigned_abs();
        if numerator == UBig::ZERO {
            return 0.0;
        }
        let bits = |x: &UBig| i64::try_from(x.bit_len()).expect("far fewer");
        // The quotient lies between 2^(top - 1) and 2^(top + 1). The unit of the integer quotient is 2^-55 of 2^top,
        // two bits below the last bit of the result, or more if that is subnormal.
        let top = bits(&numerator) - bits(&denominator) + i64::from(exponent);
        let unit = (top - 55).max(-1076);
        let shift = i64::from(exponent) - unit;
        let by = usize::try_from(shift.unsigned_abs()).expect("far fewer");
        let (numerator, denominator) =
            if shift >= 0 { (numerator << by, denominator) } else { (numerator, denominator << by) };
        let quotient = &numerator / &denominator;
        let exact = &quotient * &denominator == numerator;
        // The quotient has at most 56 bits. One more bit is set if the division is not exact.
        let quotient = u64::try_from(quotient).expect("56 bits") << 1 | u64::from(!exact);
        let x = round_bits(quotient, unit - 1);
        if negative && x != 0.0 { -x } else { x }
    }
}

/// Returns mantissa 2^unit, rounded once to the nearest f64, ties to even. `unit` is at least -1077.
pub fn round_bits(mantissa: u64, unit: i64) -> f64 {
    let length = i64::from(64 - mantissa.leading_zeros());
    // The number of bits below the last bit of the result.
    let extra = (length - 53).max(-1074 - unit).max(0);
    let half = if extra > 0 { 1u64 << (extra - 1) } else { 0 };
    let (kept, rest) = (mantissa >> extra, mantissa & ((1u64 << extra) - 1));
    let up = extra > 0 && (rest > half || rest == half && kept & 1 == 1);
    let kept = kept + u64::from(up);
    let exponent = unit + extra;
    if exponent > 1023 {
        return f64::INFINITY;
    }
    // The conversion of 53 bits is exact, and so is the scaling unless the result is infinite.
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    let kept = kept as f64;
    #[allow(clippy::cast_possible_truncation, reason = "from -1074 to 1023")]
    match exponent as i32 {
        e if e < -1022 => kept * power_of_two(e + 100) * power_of_two(-100),
        e => kept * power_of_two(e),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fraction(n: i64, d: i64) -> Fraction {
        Fraction { numerator: n.into(), denominator: d.into() }
    }

    #[test]
    fn quotients_of_small_integers_round_as_the_processor_does() {
        for n in -200..200 {
            for d in 1..200 {
                let expected = n as f64 / d as f64 + 0.0;
                assert_eq!(fraction(n, d).round(0).to_bits(), expected.to_bits(), "{n} / {d}");
                // The result is exact, since it is far above the subnormal numbers.
                let scaled = expected * power_of_two(-1000);
                assert_eq!(fraction(n, d).round(-1000), scaled);
                // A subnormal result is rounded once, not twice.
                let expected = integer_round(n, d);
                assert_eq!(fraction(n, d).round(-1074), expected * f64::from_bits(1), "{n} / {d}");
            }
        }
        assert_eq!(fraction(1, 1).round(1023), power_of_two(1023));
        assert_eq!(fraction(-2, 1).round(1023), f64::NEG_INFINITY);
        assert_eq!(fraction((1 << 54) - 1, 1).round(1023 - 53), f64::INFINITY);
        assert_eq!(fraction((1 << 53) - 1, 1).round(1023 - 52), f64::MAX);
        assert_eq!(fraction(i64::MAX, 1).round(5000), f64::INFINITY);
        assert_eq!(fraction(1, i64::MAX).round(-5000), 0.0);
    }

    /// Returns n / d rounded to an integer, ties to even.
    fn integer_round(n: i64, d: i64) -> f64 {
        let (floor, rest) = (n.div_euclid(d), n.rem_euclid(d));
        let up = rest * 2 > d || rest * 2 == d && floor & 1 == 1;
        (floor + i64::from(up)) as f64
    }

    #[test]
    fn numbers_are_integers_of_a_common_unit() {
        let numbers = [0.75, -6.0, 0.0];
        let e = common_exponent(&numbers);
        assert_eq!(e, -2);
        assert_eq!(numbers.map(|x| integer(x, e)), [3, -24, 0].map(IBig::from));
        let tiny = f64::from_bits(1);
        assert_eq!(common_exponent(&[tiny, f64::MAX]), -1074);
        assert_eq!(integer(-tiny, -1074), -IBig::ONE);
        assert_eq!(integer(4.0, -1074) - integer(2.0, -1074), integer(2.0, -1074));
        assert_eq!(integer(f64::MIN_POSITIVE, -1074) - integer(f64::MIN_POSITIVE.next_down(), -1074), IBig::ONE);
    }
}
