//! Signs of determinants, exact for all finite input.
//!
//! Signs that decide topology cannot be left to rounding: on which side of a line or a plane a point lies, or whether
//! in a sphere. Where nothing can over- or underflow stages of growing precision decide, the last of which are the
//! adaptive predicates of Shewchuk \[Shewchuk1997\] (crate robust); elsewhere integers of any length do (crate
//! dashu-int), for every finite f64 is an integer times 2^-1074.
//!
//! ```
//! use p2m_core::predicates::orientation_2d;
//! use std::cmp::Ordering;
//!
//! // 0.1 + 0.2 is not 0.3, and the difference decides; so it does at a scale whose products underflow.
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

/// Coordinates of this size are left to robust: their lowest bit is at least 2^-352, so products of three differences
/// are multiples of 2^-1056, and they are below 2^910.
const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-300)..=power_of_two(300);

fn is_plain<const N: usize>(points: &[[f64; N]]) -> bool {
    points.as_flattened().iter().all(|x| *x == 0.0 || PLAIN.contains(&x.abs()))
}

/// The sign of (b - a) x (c - a): [`Ordering::Greater`] if `c` is to the left of the line from `a` to `b`, `Equal` if
/// the three are collinear. All finite.
///
/// # Complexity
/// A few multiplications, but some microseconds for coordinates beyond 2^-300..2^300.
///
/// # References
/// \[Shewchuk1997\]
#[must_use]
pub fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
    if is_plain(&[a, b, c]) {
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        return sign(orient2d(coord(a), coord(b), coord(c)));
    }
    let exponent = common_exponent([a, b, c].as_flattened());
    let [b, c] = [b, c].map(|p| difference(p, a, exponent));
    (&b[0] * &c[1]).cmp(&(&b[1] * &c[0]))
}

/// The sign of the determinant of b - a, c - a, d - a: [`Ordering::Greater`] if `d` is on the side of the plane to
/// which (b - a) x (c - a) points, `Equal` if the four are coplanar. All finite.
///
/// # Complexity
/// As [`orientation_2d`].
///
/// # References
/// \[Shewchuk1997\]
#[must_use]
pub fn orientation_3d(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Ordering {
    if is_plain(&[a, b, c, d]) {
        let coord = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
        // Positive below the plane, there.
        return sign(orient3d(coord(a), coord(b), coord(c), coord(d))).reverse();
    }
    let exponent = common_exponent([a, b, c, d].as_flattened());
    let [b, c, d] = [b, c, d].map(|p| difference(p, a, exponent));
    exact::sign(&exact::dot(&exact::cross(&b, &c), &d))
}

/// Whether `e` is inside the sphere through the other four ([`Ordering::Greater`]), on it (`Equal`), or outside, if
/// `orientation_3d(a, b, c, d)` is `Greater`. The other way round if it is `Less`; if the four are coplanar, it is
/// `Equal` only if the five are on a common sphere or plane, or the four on a common circle. All finite.
///
/// # Complexity
/// Some tens of multiplications, a few hundred where the point is very near the sphere or on it, some microseconds for
/// coordinates beyond 2^-161..2^190 and on the rare occasions that need adaptive arithmetic.
///
/// # References
/// \[Shewchuk1997\]
#[must_use]
pub fn insphere(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3], e: [f64; 3]) -> Ordering {
    let in_range = |x: &f64| *x == 0.0 || adaptive::RANGE.contains(&x.abs());
    if [a, b, c, d, e].as_flattened().iter().all(in_range) {
        let points = [a, b, c, d];
        return adaptive::sphere_filter(points, e).sign().unwrap_or_else(|| adaptive::sphere_exact(points, e).0);
    }
    integers_insphere([a, b, c, d], e)
}

/// The same for any exponents.
fn integers_insphere(points: [[f64; 3]; 4], e: [f64; 3]) -> Ordering {
    let exponent = common_exponent(points.as_flattened().iter().chain(&e));
    let rows = points.map(|p| difference(p, e, exponent));
    let mut sum = IBig::ZERO;
    for (i, row) in rows.iter().enumerate() {
        let [p, q, r] = [1, 2, 3].map(|k| &rows[(i + k) % 4]);
        let term = exact::dot(row, row) * exact::dot(&exact::cross(p, q), r);
        // A cyclic shift of four rows is odd.
        sum += if i % 2 == 0 { term } else { -term };
    }
    exact::sign(&sum)
}

fn sign(x: f64) -> Ordering {
    x.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
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

    /// Cyclic shifts keep the sign, swaps turn it: both ways of computing have to know that, on the edge of what they
    /// can tell, and have to say the same as each other on either side of the border between them.
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
