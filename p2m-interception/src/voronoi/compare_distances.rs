//! The exact comparison of the distances from a query point to two other points.
//!
//! The sign is that of |q - v|^2 - |q - w|^2 = (w - v) . (2 q - v - w). It is computed in f64. If the result does not
//! exceed its error bound, it is computed in double-double arithmetic, where the differences are exact, and finally in
//! integers.

use p2m_core::engine::arithmetic::dot;
use p2m_core::engine::double_double::{self, Double};
use p2m_core::engine::exact::{self, common_exponent, integer};
use p2m_core::engine::vector::V3;
use std::cmp::Ordering;

/// The relative error bound of a sum of three products in f64, in units of the sum of their absolute values. It covers
/// seven roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Compares the distance from `q` to `v` with the distance from `q` to `w`. All coordinates have to be zero or between
/// 2^-161 and 2^100 in size, so that products that underflow are negligible.
pub(crate) fn compare(q: &V3, v: &V3, w: &V3) -> Ordering {
    let offset: V3 = std::array::from_fn(|k| w[k] - v[k]);
    let sum: V3 = std::array::from_fn(|k| (q[k] - v[k]) + (q[k] - w[k]));
    let (mut s, mut size) = (0.0, 0.0);
    for k in 0..3 {
        s += offset[k] * sum[k];
        // The two terms of the sum may cancel, so the bound uses their sizes.
        size += offset[k].abs() * ((q[k] - v[k]).abs() + (q[k] - w[k]).abs());
    }
    if s.abs() > ROUNDING * size {
        return s.total_cmp(&0.0);
    }
    let offset: [Double; 3] = std::array::from_fn(|k| Double::difference(w[k], v[k]));
    let sum: [Double; 3] = std::array::from_fn(|k| Double::difference(q[k], v[k]) + Double::difference(q[k], w[k]));
    let s = dot(offset, sum).round();
    if s.abs() > double_double::ROUNDING * size {
        return s.total_cmp(&0.0);
    }
    let exponent = common_exponent([*q, *v, *w].as_flattened());
    let [q, v, w] = [q, v, w].map(|p| p.map(|x| integer(x, exponent)));
    let offset = std::array::from_fn(|k| &w[k] - &v[k]);
    let sum = std::array::from_fn(|k| &q[k] + &q[k] - &v[k] - &w[k]);
    exact::sign(&exact::dot(&offset, &sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_int::IBig;
    use rand::RngExt;

    /// The queries are on the plane between two points, next to it by some bits, and anywhere.
    #[test]
    fn the_sign_is_that_of_the_integers() {
        let mut ties = 0;
        let cases = p2m_testkit::cases(20_000, 10_000);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("nearer", case);
            let scale = 2f64.powi(rng.random_range(-60..1));
            let mut point = || -> V3 {
                let bits = 1 << rng.random_range(2..30);
                std::array::from_fn(|_| f64::from(rng.random_range(-bits..=bits)) / f64::from(bits) * scale)
            };
            let (v, w, beside) = (point(), point(), point());
            // Swapping the offset from the middle on two axes keeps the distance if the ends differ by a swap as well.
            let w = if rng.random() { [v[1], v[0], v[2]] } else { w };
            let mut q = if rng.random() { [beside[0], beside[0], beside[2]] } else { beside };
            if rng.random_range(0..3) == 0 {
                q[0] += q[0] * f64::EPSILON * f64::from(rng.random_range(-2..=2));
            }
            let square = |p: &V3| -> IBig {
                let exponent = common_exponent([q, *p, [2f64.powi(-200); 3]].as_flattened());
                let d = exact::difference(q, *p, exponent);
                exact::dot(&d, &d)
            };
            let expected = square(&v).cmp(&square(&w));
            assert_eq!(compare(&q, &v, &w), expected, "{q:?} {v:?} {w:?}");
            assert_eq!(compare(&q, &w, &v), expected.reverse());
            ties += usize::from(expected == Ordering::Equal);
        }
        assert!(cases.have_more_than(1000, ties), "{ties}");
    }
}
