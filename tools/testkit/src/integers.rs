//! Coordinates as integers of any length, in units of a power of two.

use dashu_int::IBig;

/// A vector of three integers.
pub(crate) type V = [IBig; 3];

/// Splits a finite f64 into mantissa and exponent.
fn decompose(x: f64) -> (i64, i64) {
    let bits = x.to_bits();
    let exponent = i64::try_from((bits >> 52) & 0x7ff).expect("eleven bits");
    let fraction = i64::try_from(bits & ((1 << 52) - 1)).expect("52 bits");
    let (mantissa, exponent) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    (if x.is_sign_negative() { -mantissa } else { mantissa }, exponent)
}

/// Returns the exponent of the lowest set bit, and a large number for zero.
pub(crate) fn lowest_bit(x: f64) -> i64 {
    let (mantissa, exponent) = decompose(x);
    if mantissa == 0 { 2000 } else { exponent + i64::from(mantissa.trailing_zeros()) }
}

/// Returns x as a multiple of 2^unit, which has to divide it.
pub(crate) fn integer(x: f64, unit: i64) -> IBig {
    let (mantissa, exponent) = decompose(x);
    let shift = exponent - unit;
    let up = |n: i64| usize::try_from(n).expect("not negative");
    if shift >= 0 { IBig::from(mantissa) << up(shift) } else { IBig::from(mantissa) >> up(-shift) }
}

pub(crate) fn sub(a: &V, b: &V) -> V {
    std::array::from_fn(|k| &a[k] - &b[k])
}

pub(crate) fn dot(a: &V, b: &V) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &V, b: &V) -> V {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

/// Returns the part of a convex polygon, segment or point in which the linear function `height` is not negative. Points
/// have homogeneous coordinates.
pub(crate) fn clip<const N: usize>(hull: &[[IBig; N]], height: impl Fn(&[IBig; N]) -> IBig) -> Vec<[IBig; N]> {
    let heights: Vec<IBig> = hull.iter().map(height).collect();
    let mut rest = Vec::new();
    for (i, p) in hull.iter().enumerate() {
        let j = (i + 1) % hull.len();
        let (at_p, at_q) = (&heights[i], &heights[j]);
        if *at_p >= IBig::ZERO {
            rest.push(p.clone());
        }
        if (*at_p > IBig::ZERO && *at_q < IBig::ZERO) || (*at_p < IBig::ZERO && *at_q > IBig::ZERO) {
            // The sign makes both weights positive, and so keeps the last coordinate positive.
            let sign = if *at_p > IBig::ZERO { IBig::ONE } else { -IBig::ONE };
            rest.push(std::array::from_fn(|k| (&hull[j][k] * at_p - &p[k] * at_q) * &sign));
        }
    }
    rest
}
