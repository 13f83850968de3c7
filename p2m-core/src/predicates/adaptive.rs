//! Determinants in stages: f64 with a bound on its error, then whole numbers, then double-double, then robust.
//!
//! For points whose coordinates are 0 or of a size in [`RANGE`]: then every coordinate is a multiple of 2^-213,
//! products of k differences and all that rounding makes of them are multiples of 2^-213k, at least 2^-1065, and
//! nothing underflows in any stage but the bounds themselves. Nothing overflows either: sums of products of five stay
//! below 2^962.

#![allow(clippy::inline_always, reason = "one expression; calls would hide it from the optimiser")]

use super::fixed_point;
use crate::kernel::arithmetic::{Number, cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger, sub};
use robust::{Coord3D, insphere, orient3d};
use std::cmp::Ordering;

/// Sizes of coordinates for which the stages are exact; 0 is as well.
pub const RANGE: std::ops::RangeInclusive<f64> = power_of_two(-161)..=power_of_two(190);

/// What decided a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PredicateStage {
    /// Whole numbers, of a common power of two.
    Whole,
    /// Double-double arithmetic.
    Double,
    /// The adaptive predicates of \[Shewchuk1997\].
    Adaptive,
}

/// The unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// Of [`determinant`] in f64, see there. A ninth of it is for the rounding of the bound.
const ORIENTATION_ERROR: f64 = 54.0 * U;
/// Of [`sphere`] in f64, see there. A seventeenth of it is for the rounding of the bound.
const SPHERE_ERROR: f64 = 408.0 * U;
/// Of [`sphere`] in double-double, see there. A tenth of it is for the rounding of the bound.
const DOUBLE_SPHERE_ERROR: f64 = 2048.0 * U * U;

/// The determinant of three rows, a x b . c.
///
/// It has six products of three, each below XYZ for entries below X, Y and Z in the three columns. On the way to the
/// result a product takes 5 operations, 8 with the differences in its factors: with relative errors below u each, the
/// error is below 6 XYZ ((1 + u)^8 - 1).
#[inline(always)]
fn determinant<T: Number>([a, b, c]: [[T; 3]; 3]) -> T {
    dot(cross(a, b), c)
}

/// Above zero if the origin is inside the sphere of four points with determinant(b - a, c - a, d - a) > 0.
///
/// It is the sum of 24 products of a squared length and three coordinates, each below L X Y Z for squared lengths below
/// L. On the way to the result a product takes 11 operations (3 for the squared length, 2 for a difference of
/// multiples, 2 for a cross product, which is its other factor, 1 + 2 for the product of the two, 1 for the sum), 16
/// with the differences in its five factors. So the error is below 24 XYZL ((1 + u)^16 - 1) in f64. In double-double,
/// with exact differences, operations have errors below 7 u^2 \[Joldes2017\], and it is below 24 XYZL ((1 + 7u^2)^11 -
/// 1).
#[inline(always)]
fn sphere<T: Number>([a, b, c, d]: [[T; 3]; 4], [a2, b2, c2, d2]: [T; 4]) -> T {
    let combine = |s: T, p: [T; 3], t: T, q: [T; 3]| [s * p[0] - t * q[0], s * p[1] - t * q[1], s * p[2] - t * q[2]];
    dot(cross(a, b), combine(c2, d, d2, c)) + dot(cross(c, d), combine(a2, b, b2, a))
}

#[inline(always)]
fn squares<T: Number>(rows: [[T; 3]; 4]) -> [T; 4] {
    rows.map(|r| dot(r, r))
}

/// The largest sizes in the columns, multiplied.
#[inline(always)]
fn columns<const N: usize>(rows: &[V3; N]) -> f64 {
    let mut size = rows[0].map(f64::abs);
    for row in &rows[1..] {
        for k in 0..3 {
            size[k] = larger(row[k].abs(), size[k]);
        }
    }
    size[0] * size[1] * size[2]
}

/// A number near another one.
#[derive(Clone, Copy)]
pub struct Estimate {
    pub value: f64,
    /// Above the distance of the two.
    bound: f64,
}

impl Estimate {
    #[inline(always)]
    fn new(value: f64, bound: f64) -> Self {
        // Where the bound has underflowed, it is below that, by less than that.
        Self { value, bound: bound + f64::MIN_POSITIVE }
    }

    /// Whether the value has the sign of the other one, which is not 0.
    #[inline(always)]
    pub fn is_certain(self) -> bool {
        self.value.abs() > self.bound
    }

    /// The sign of the other one.
    #[inline(always)]
    pub fn sign(self) -> Option<Ordering> {
        self.is_certain().then_some(if self.value > 0.0 { Ordering::Greater } else { Ordering::Less })
    }
}

/// Of the determinant of the differences that these rows are rounded from.
#[inline(always)]
pub fn orientation_filter(rows: [V3; 3]) -> Estimate {
    Estimate::new(determinant(rows), ORIENTATION_ERROR * columns(&rows))
}

/// The sign of the determinant of a - origin, b - origin, c - origin, where the filter could not tell.
#[cold]
pub fn orientation_exact([a, b, c]: [V3; 3], origin: V3) -> (Ordering, PredicateStage) {
    if let Some(rows) = fixed_point::rows(&[a, b, c], origin) {
        return (fixed_point::orientation(rows), PredicateStage::Whole);
    }
    // The sign that is documented there, for points below the plane.
    let sign = orient3d(coord(a), coord(b), coord(c), coord(origin));
    (super::sign(sign), PredicateStage::Adaptive)
}

/// Of a number above 0 if e is inside the sphere through the other four, which are positively oriented.
#[inline(always)]
pub fn sphere_filter([a, b, c, d]: [V3; 4], e: V3) -> Estimate {
    let rows = [sub(a, e), sub(b, e), sub(c, e), sub(d, e)];
    let lengths = squares(rows);
    let longest = larger(larger(lengths[0], lengths[1]), larger(lengths[2], lengths[3]));
    Estimate::new(sphere(rows, lengths), SPHERE_ERROR * columns(&rows) * longest)
}

/// Whether e is inside (`Greater`), on or outside (`Less`) that sphere, where the filter could not tell.
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

/// The same by the adaptive predicate.
pub(super) fn sphere_adaptive(points: [V3; 4], e: V3) -> Ordering {
    let [a, b, c, d] = points.map(coord);
    // Positive inside for points that are oriented the other way, there.
    super::sign(insphere(a, b, c, d, coord(e))).reverse()
}

/// [`sphere`] in double-double.
pub(super) fn sphere_double(points: [V3; 4], e: V3) -> Option<Ordering> {
    let rows = points.map(|p| std::array::from_fn(|k| Double::difference(p[k], e[k])));
    let lengths = squares(rows);
    let longest = lengths.iter().fold(0.0, |m, l| larger(l.round(), m));
    let bound = DOUBLE_SPHERE_ERROR * columns(&rows.map(|row| row.map(Double::round))) * longest;
    Estimate::new(sphere(rows, lengths).round(), bound).sign()
}

fn coord([x, y, z]: V3) -> Coord3D<f64> {
    Coord3D { x, y, z }
}
