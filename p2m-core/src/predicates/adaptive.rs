//! Signs of determinants, computed in stages of increasing precision.
//!
//! The basic idea: compute the determinant in f64 together with a bound on its error. If the magnitude of the value
//! exceeds the bound, the sign is certain; this decides nearly all cases. Otherwise try fixed-point integers (exact for
//! grids), then double-double with its own error bound, and finally the adaptive arithmetic of the crate robust, which
//! is always exact.
//!
//! The coordinates of all points are 0 or of a magnitude in [`RANGE`]. So every coordinate is a multiple of 2^-213, and
//! products of k differences, rounded or not, are multiples of 2^-213k, at least 2^-1065. Nothing underflows in any
//! stage except the bounds themselves, and nothing overflows: sums of products of five factors stay below 2^962.

#![allow(clippy::inline_always, reason = "one expression; calls would hide it from the optimiser")]

use super::fixed_point;
use crate::kernel::arithmetic::{Number, cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger, sub};
use robust::{Coord3D, insphere, orient3d};
use std::cmp::Ordering;

/// The magnitudes of coordinates for which all stages are valid. A coordinate may also be 0.
pub const RANGE: std::ops::RangeInclusive<f64> = power_of_two(-161)..=power_of_two(190);

/// The stage that decided a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PredicateStage {
    /// Fixed-point numbers: integers in units of a common power of two.
    Whole,
    /// Double-double arithmetic.
    Double,
    /// The adaptive predicates of \[Shewchuk1997\].
    Adaptive,
}

/// The unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// A bound on the relative error of [`determinant`] in f64, derived there. A ninth of it covers the rounding of the
/// bound.
const ORIENTATION_ERROR: f64 = 54.0 * U;
/// A bound on the relative error of [`sphere`] in f64, derived there. A seventeenth of it covers the rounding of the
/// bound.
const SPHERE_ERROR: f64 = 408.0 * U;
/// A bound on the relative error of [`sphere`] in double-double, derived there. A tenth of it covers the rounding of
/// the bound.
const DOUBLE_SPHERE_ERROR: f64 = 2048.0 * U * U;

/// Returns the determinant of three rows, a x b . c.
///
/// It consists of six products of three factors, each below XYZ for entries below X, Y and Z in the three columns. A
/// product takes 5 operations, and 8 including the differences in its factors. Each operation has a relative error
/// below u, so the error is below 6 XYZ ((1 + u)^8 - 1).
#[inline(always)]
fn determinant<T: Number>([a, b, c]: [[T; 3]; 3]) -> T {
    dot(cross(a, b), c)
}

/// Returns a number above zero if the origin is inside the sphere of four points for which determinant(b - a, c - a, d
/// - a) is positive.
///
/// It is a sum of 24 products of a squared length and three coordinates, each below L X Y Z for squared lengths below
/// L. A product takes 11 operations: 3 for the squared length, 2 for a difference of multiples, 2 for the cross product
/// that is its other factor, 1 + 2 for the product of the two, and 1 for the sum. With the differences in its five
/// factors there are 16. So the error is below 24 XYZL ((1 + u)^16 - 1) in f64. In double-double, differences are exact
/// and operations have relative errors below 7 u^2 \[Joldes2017\], so the error is below 24 XYZL ((1 + 7u^2)^11 - 1).
#[inline(always)]
fn sphere<T: Number>([a, b, c, d]: [[T; 3]; 4], [a2, b2, c2, d2]: [T; 4]) -> T {
    let combine = |s: T, p: [T; 3], t: T, q: [T; 3]| [s * p[0] - t * q[0], s * p[1] - t * q[1], s * p[2] - t * q[2]];
    dot(cross(a, b), combine(c2, d, d2, c)) + dot(cross(c, d), combine(a2, b, b2, a))
}

/// Returns the squared lengths of four rows.
#[inline(always)]
fn squares<T: Number>(rows: [[T; 3]; 4]) -> [T; 4] {
    rows.map(|r| dot(r, r))
}

/// Returns the product of the largest magnitudes of the three columns.
#[inline(always)]
fn product_of_columns<const N: usize>(rows: &[V3; N]) -> f64 {
    let mut size = rows[0].map(f64::abs);
    for row in &rows[1..] {
        for k in 0..3 {
            size[k] = larger(row[k].abs(), size[k]);
        }
    }
    size[0] * size[1] * size[2]
}

/// A computed value with a bound on its error.
#[derive(Clone, Copy)]
pub struct Estimate {
    /// The computed value.
    pub value: f64,
    /// A bound on the error of the value.
    bound: f64,
}

impl Estimate {
    #[inline(always)]
    fn new(value: f64, bound: f64) -> Self {
        // The added number covers a bound that has underflowed.
        Self { value, bound: bound + f64::MIN_POSITIVE }
    }

    /// Returns whether the value certainly has the sign of the true number, which is then not 0.
    #[inline(always)]
    pub fn is_certain(self) -> bool {
        self.value.abs() > self.bound
    }

    /// Returns the sign of the true number, or `None` if the error bound leaves it open.
    #[inline(always)]
    pub fn sign(self) -> Option<Ordering> {
        self.is_certain().then_some(if self.value > 0.0 { Ordering::Greater } else { Ordering::Less })
    }
}

/// Estimates the determinant of three differences, whose rounded values are `rows`.
#[inline(always)]
pub fn orientation_filter(rows: [V3; 3]) -> Estimate {
    Estimate::new(determinant(rows), ORIENTATION_ERROR * product_of_columns(&rows))
}

/// Returns the sign of the determinant of a - origin, b - origin and c - origin, for cases that the filter cannot
/// decide.
#[cold]
pub fn orientation_exact([a, b, c]: [V3; 3], origin: V3) -> (Ordering, PredicateStage) {
    if let Some(rows) = fixed_point::rows(&[a, b, c], origin) {
        return (fixed_point::orientation(rows), PredicateStage::Whole);
    }
    // The crate robust returns a positive sign for points below the plane.
    let below = orient3d(coord(a), coord(b), coord(c), coord(origin));
    (sign(below), PredicateStage::Adaptive)
}

/// Estimates a number that is above 0 if e is inside the sphere through the other four points, which are positively
/// oriented.
#[inline(always)]
pub fn sphere_filter([a, b, c, d]: [V3; 4], e: V3) -> Estimate {
    let rows = [sub(a, e), sub(b, e), sub(c, e), sub(d, e)];
    let lengths = squares(rows);
    let longest = larger(larger(lengths[0], lengths[1]), larger(lengths[2], lengths[3]));
    Estimate::new(sphere(rows, lengths), SPHERE_ERROR * product_of_columns(&rows) * longest)
}

/// Returns whether e is inside (`Greater`), on (`Equal`) or outside (`Less`) the sphere through four points that are
/// positively oriented, for cases that the filter cannot decide.
#[cold]
pub fn sphere_exact(points: [V3; 4], e: V3) -> (Ordering, PredicateStage) {
    if let Some(rows) = fixed_point::rows(&points, e) {
        return (fixed_point::sphere(rows), PredicateStage::Whole);
    }
    if let Some(sign) = sphere_double(points, e) {
        return (sign, PredicateStage::Double);
    }
    (sphere_adaptive(points, e), PredicateStage::Adaptive)
}

/// Computes the sign of [`sphere_exact`] by the adaptive predicate of the crate robust.
pub(super) fn sphere_adaptive(points: [V3; 4], e: V3) -> Ordering {
    let [a, b, c, d] = points.map(coord);
    // The crate robust uses the opposite orientation, so its sign is reversed.
    sign(insphere(a, b, c, d, coord(e))).reverse()
}

/// Computes the sign of [`sphere_exact`] in double-double, or returns `None` if the error bound leaves it open.
pub(super) fn sphere_double(points: [V3; 4], e: V3) -> Option<Ordering> {
    let rows = points.map(|p| std::array::from_fn(|k| Double::difference(p[k], e[k])));
    let lengths = squares(rows);
    let longest = lengths.iter().fold(0.0, |m, l| larger(l.round(), m));
    let bound = DOUBLE_SPHERE_ERROR * product_of_columns(&rows.map(|row| row.map(Double::round))) * longest;
    Estimate::new(sphere(rows, lengths).round(), bound).sign()
}

fn coord([x, y, z]: V3) -> Coord3D<f64> {
    Coord3D { x, y, z }
}

/// Returns the sign of a number that is not NaN.
pub(super) fn sign(x: f64) -> Ordering {
    x.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}
