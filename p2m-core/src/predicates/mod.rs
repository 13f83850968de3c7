//! Signs of determinants, exact for all finite input.
//!
//! A predicate returns the side of a line or a plane on which a point lies, or whether a point is inside of a sphere.
//! Such signs decide topology, so they must not depend on rounding. Stages of increasing precision compute them while
//! nothing can overflow or underflow; the last stage is the adaptive predicate of Shewchuk \[Shewchuk1997\] (crate
//! robust). For other magnitudes big integers decide (crate dashu-int), since every finite f64 is an integer times
//! 2^-1074.
//!
//! ```
//! use p2m_core::predicates::orientation_2d;
//! use std::cmp::Ordering;
//!
//! // 0.1 + 0.2 is not 0.3, and the difference decides the sign, even at a scale where products underflow.
//! for scale in [1.0, 2f64.powi(-1000)] {
//!     let [a, b, c] = [[0.0, 0.0], [1.0, 1.0], [0.1 + 0.2, 0.3]].map(|p: [f64; 2]| p.map(|x| x * scale));
//!     assert_eq!(orientation_2d(a, b, c), Ordering::Less);
//! }
//! ```

pub(crate) mod adaptive;
mod fixed_point;
#[cfg(test)]
mod tests;

use crate::exact::{self, common_exponent, difference};
use crate::kernel::power_of_two;
use dashu_int::IBig;
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::cmp::Ordering;

/// The magnitudes of coordinates for which the crate robust is exact. The lowest bit of a coordinate is at least
/// 2^-352, so products of three differences are multiples of 2^-1056, and they are below 2^910.
const PLAIN_MAGNITUDES: std::ops::RangeInclusive<f64> = power_of_two(-300)..=power_of_two(300);

/// Returns whether all coordinates are 0 or in the plain range.
fn is_plain<const N: usize>(points: &[[f64; N]]) -> bool {
    points.as_flattened().iter().all(|x| *x == 0.0 || PLAIN_MAGNITUDES.contains(&x.abs()))
}

/// Returns the sign of (b - a) x (c - a): [`Ordering::Greater`] if `c` is to the left of the line from `a` to `b`, and
/// `Equal` if the three points are collinear. All coordinates are finite.
///
/// # Complexity
/// It takes a few multiplications, and some microseconds for coordinates beyond 2^-300..2^300.
///
/// # References
/// The adaptive predicate is by Shewchuk \[Shewchuk1997\].
#[must_use]
pub fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
    if is_plain(&[a, b, c]) {
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        return adaptive::sign(orient2d(coord(a), coord(b), coord(c)));
    }
    let exponent = common_exponent([a, b, c].as_flattened());
    let [b, c] = [b, c].map(|p| difference(p, a, exponent));
    (&b[0] * &c[1]).cmp(&(&b[1] * &c[0]))
}

/// Returns the sign of the determinant of b - a, c - a and d - a: [`Ordering::Greater`] if `d` is on the side of the
/// plane to which (b - a) x (c - a) points, and `Equal` if the four points are coplanar. All coordinates are finite.
///
/// # Complexity
/// It takes some tens of multiplications, and some microseconds for coordinates beyond 2^-300..2^300.
///
/// # References
/// The adaptive predicate is by Shewchuk \[Shewchuk1997\].
#[must_use]
pub fn orientation_3d(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Ordering {
    if is_plain(&[a, b, c, d]) {
        let coord = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
        // The crate robust returns a positive sign below the plane.
        return adaptive::sign(orient3d(coord(a), coord(b), coord(c), coord(d))).reverse();
    }
    let exponent = common_exponent([a, b, c, d].as_flattened());
    let [b, c, d] = [b, c, d].map(|p| difference(p, a, exponent));
    exact::sign(&exact::dot(&exact::cross(&b, &c), &d))
}

/// Returns whether `e` is inside the sphere through the other four points ([`Ordering::Greater`]), on it (`Equal`), or
/// outside (`Less`), provided that `orientation_3d(a, b, c, d)` is `Greater`.
///
/// The result is reversed if that orientation is `Less`. If the four points are coplanar, the result is `Equal` only if
/// all five are on a common sphere or plane, or the four on a common circle. All coordinates are finite.
///
/// # Complexity
/// It takes some tens of multiplications, or a few hundred if `e` is very near the sphere or on it. It takes some
/// microseconds for coordinates beyond 2^-161..2^190, and in rare cases that need adaptive arithmetic.
///
/// # References
/// The adaptive predicate is by Shewchuk \[Shewchuk1997\].
#[must_use]
pub fn insphere(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3], e: [f64; 3]) -> Ordering {
    let in_range = |x: &f64| *x == 0.0 || adaptive::RANGE.contains(&x.abs());
    if [a, b, c, d, e].as_flattened().iter().all(in_range) {
        let points = [a, b, c, d];
        return adaptive::sphere_filter(points, e).sign().unwrap_or_else(|| adaptive::sphere_exact(points, e).0);
    }
    insphere_by_integers([a, b, c, d], e)
}

/// Computes [`insphere`] in big integers, for coordinates with any exponents.
fn insphere_by_integers(points: [[f64; 3]; 4], e: [f64; 3]) -> Ordering {
    let exponent = common_exponent(points.as_flattened().iter().chain(&e));
    let rows = points.map(|p| difference(p, e, exponent));
    let mut sum = IBig::ZERO;
    for (i, row) in rows.iter().enumerate() {
        let [p, q, r] = [1, 2, 3].map(|k| &rows[(i + k) % 4]);
        let term = exact::dot(row, row) * exact::dot(&exact::cross(p, q), r);
        // A cyclic shift of four rows is an odd permutation.
        sum += if i % 2 == 0 { term } else { -term };
    }
    exact::sign(&sum)
}

#[cfg(test)]
mod orientations {
    use super::*;
    use Ordering::{Equal, Greater, Less};

    #[test]
    fn left_is_greater_and_so_is_the_side_of_the_normal() {
        for scale in [1.0, 2f64.powi(-700), 2f64.powi(-1060), 2f64.powi(1000)] {
            let at = |x: f64, y: f64| [x * scale, y * scale];
            assert_eq!(orientation_2d(at(0.0, 0.0), at(4.0, 0.0), at(1.0, 1.0)), Greater);
            assert_eq!(orientation_2d(at(0.0, 0.0), at(4.0, 0.0), at(1.0, -1.0)), Less);
            assert_eq!(orientation_2d(at(1.0, 1.0), at(2.0, 3.0), at(5.0, 9.0)), Equal);
            let at = |p: [f64; 3]| p.map(|x| x * scale);
            let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(at);
            assert_eq!(orientation_3d(a, b, c, at([5.0, 5.0, 2.0])), Greater);
            assert_eq!(orientation_3d(a, b, c, at([5.0, 5.0, -2.0])), Less);
            assert_eq!(orientation_3d(a, b, c, at([-7.0, 3.0, 0.0])), Equal);
        }
    }

    /// Cyclic shifts keep the sign and swaps reverse it. Both arithmetics have to comply in cases that one bit decides,
    /// and have to agree with each other.
    #[test]
    fn one_bit_decides_and_both_ways_agree() {
        let [a, b] = [[0.5, 0.5], [12.0, 12.0]];
        for i in 0..32 {
            for j in 0..32 {
                let c = [0.5 + f64::from(i) * f64::EPSILON, 0.5 + f64::from(j) * f64::EPSILON];
                let expected = j.cmp(&i);
                assert_eq!(orientation_2d(a, b, c), expected);
                assert_eq!(orientation_2d(b, c, a), expected);
                assert_eq!(orientation_2d(b, a, c), expected.reverse());
                let small = |p: [f64; 2]| p.map(|x| x * 2f64.powi(-900));
                assert_eq!(orientation_2d(small(a), small(b), small(c)), expected);
                let lift = |p: [f64; 2], z: f64| [p[0], p[1], z];
                let (p, q, r, s) = (lift(a, 0.0), lift(b, 0.0), lift(a, 1.0), lift(c, 3.0));
                assert_eq!(orientation_3d(p, q, r, s), expected.reverse());
                let small = |p: [f64; 3]| p.map(|x| x * 2f64.powi(-900));
                assert_eq!(orientation_3d(small(p), small(q), small(r), small(s)), expected.reverse());
            }
        }
    }

    #[test]
    fn exponents_of_the_whole_range_may_meet() {
        let tiny = f64::from_bits(1);
        assert_eq!(orientation_2d([0.0, 0.0], [f64::MAX, 0.0], [-f64::MAX, tiny]), Greater);
        assert_eq!(orientation_2d([-f64::MAX, -tiny], [f64::MAX, tiny], [0.0, 0.0]), Equal);
        assert_eq!(orientation_3d([0.0; 3], [f64::MAX, 0.0, 0.0], [0.0, tiny, 0.0], [1.0, 1.0, -tiny]), Less);
    }
}
