//! Determinants in stages: f64 with a bound on its error, then small integers, then double-double, then robust.
//!
//! For points whose coordinates are 0 or of a size in [`RANGE`]: then every coordinate is a multiple of 2^-213, products
//! of k differences and all that rounding makes of them are multiples of 2^-213k, at least 2^-1065, and nothing
//! underflows in any stage but the bounds themselves. Nothing overflows either: products of five stay below 2^960.

#![allow(clippy::float_cmp, reason = "whether a difference is exact is equality")]
#![allow(clippy::inline_always, reason = "one expression; calls would hide it from the optimiser")]

use crate::kernel::double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, dot, exponent, larger, largest, sub};
use robust::{Coord3D, insphere, orient3d};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// Sizes of coordinates for which the stages are exact; 0 is as well.
pub(crate) const RANGE: std::ops::RangeInclusive<f64> = power_of_two(-161)..=power_of_two(190);

/// What decided a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Differences that are multiples of a common power of two, below 2^24 of it, or points of a box: no rounding.
    Small,
    /// Double-double arithmetic.
    Double,
    /// The adaptive predicates of \[Shewchuk1997\].
    Adaptive,
}

/// The unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// Of [`orientation`] in f64, see there. A ninth of it is for the rounding of the bound.
const ORIENTATION_ERROR: f64 = 54.0 * U;
/// Of [`sphere`] in f64, see there. A seventeenth of it is for the rounding of the bound.
const SPHERE_ERROR: f64 = 408.0 * U;
/// Of [`sphere`] in double-double, see there. A tenth of it is for the rounding of the bound.
const DOUBLE_SPHERE_ERROR: f64 = 2048.0 * U * U;

trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Number for T {}

/// The determinant of three rows, a x b . c.
///
/// It has six products of three, each below XYZ for entries below X, Y and Z in the three columns. On the way to the
/// result a product takes 5 operations, 8 with the differences in its factors: with relative errors below u each, the error is
/// below 6 XYZ ((1 + u)^8 - 1).
#[inline(always)]
fn determinant<T: Number>([a, b, c]: [[T; 3]; 3]) -> T {
    (a[0] * b[1] - a[1] * b[0]) * c[2] - (a[0] * c[1] - a[1] * c[0]) * b[2] + (b[0] * c[1] - b[1] * c[0]) * a[2]
}

/// Above zero if the origin is inside the sphere of four points with determinant(b - a, c - a, d - a) > 0.
///
/// It is the sum of 24 products of a squared length and three coordinates, each below L X Y Z for squared lengths below
/// L. On the way to the result a product takes 11 operations (3 for the squared length, 5 for a determinant, 3 together),
/// 16 with the differences in its five factors. So the error is below 24 XYZL ((1 + u)^16 - 1) in f64. In double-double,
/// with exact differences, operations have errors below 7 u^2 \[Joldes2017\], and it is below 24 XYZL ((1 + 7u^2)^11 - 1).
#[inline(always)]
fn sphere<T: Number>([a, b, c, d]: [[T; 3]; 4], [a2, b2, c2, d2]: [T; 4]) -> T {
    let minor = |p: [T; 3], q: [T; 3]| p[0] * q[1] - q[0] * p[1];
    let (ab, bc, cd, da, ac, bd) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a), minor(a, c), minor(b, d));
    let abc = a[2] * bc - b[2] * ac + c[2] * ab;
    let bcd = b[2] * cd - c[2] * bd + d[2] * bc;
    let cda = c[2] * da + d[2] * ac + a[2] * cd;
    let dab = d[2] * ab + a[2] * bd + b[2] * da;
    (a2 * bcd - b2 * cda) + (c2 * dab - d2 * abc)
}

#[inline(always)]
fn squares<T: Number>(rows: [[T; 3]; 4]) -> [T; 4] {
    rows.map(|r| r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
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

/// The sign of x, if it is that of every number within the bound.
#[inline(always)]
fn certain(x: f64, bound: f64) -> Option<Ordering> {
    // The bound has underflowed if it is below that, by less than that.
    let bound = bound + f64::MIN_POSITIVE;
    if x > bound {
        Some(Ordering::Greater)
    } else if x < -bound {
        Some(Ordering::Less)
    } else {
        None
    }
}

/// The sign of the determinant of the differences that these rows are rounded from.
#[inline(always)]
pub(crate) fn orientation_filter(rows: [V3; 3]) -> Option<Ordering> {
    certain(determinant(rows), ORIENTATION_ERROR * columns(&rows))
}

/// The sign of the determinant of a - origin, b - origin, c - origin, where the filter could not tell.
#[cold]
pub(crate) fn orientation_exact([a, b, c]: [V3; 3], origin: V3) -> (Ordering, Stage) {
    if let Some(rows) = small(&[a, b, c], origin) {
        return (determinant(rows).cmp(&0), Stage::Small);
    }
    // The sign that is documented there, for points below the plane.
    let sign = orient3d(coord(a), coord(b), coord(c), coord(origin));
    (super::sign(sign), Stage::Adaptive)
}

/// Whether e is inside (`Greater`), on or outside (`Less`) the sphere through the other four, which are positively
/// oriented.
#[inline(always)]
pub(crate) fn sphere_filter([a, b, c, d]: [V3; 4], e: V3) -> Option<Ordering> {
    let rows = [sub(a, e), sub(b, e), sub(c, e), sub(d, e)];
    let lengths = rows.map(|r| dot(r, r));
    let longest = larger(larger(lengths[0], lengths[1]), larger(lengths[2], lengths[3]));
    certain(sphere(rows, lengths), SPHERE_ERROR * columns(&rows) * longest)
}

/// The same, where the filter could not tell.
#[cold]
pub(crate) fn sphere_exact(points: [V3; 4], e: V3) -> (Ordering, Stage) {
    if corners_of_a_box(&points, e) {
        return (Ordering::Equal, Stage::Small);
    }
    if let Some(rows) = small(&points, e) {
        return (sphere(rows, squares(rows)).cmp(&0), Stage::Small);
    }
    if let Some(sign) = sphere_double(points, e) {
        return (sign, Stage::Double);
    }
    (sphere_adaptive(points, e), Stage::Adaptive)
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
    certain(sphere(rows, lengths).round(), bound)
}

/// Whether each coordinate takes at most two values: then the points are corners of a box, and on its sphere. That is
/// so all the time in grids whose coordinates were rounded.
fn corners_of_a_box(points: &[V3; 4], e: V3) -> bool {
    (0..3).all(|k| {
        let other = points.iter().map(|p| p[k]).find(|x| *x != e[k]).unwrap_or(e[k]);
        points.iter().all(|p| p[k] == e[k] || p[k] == other)
    })
}

/// The differences p - origin as multiples of a common power of two, if they are below 2^24 of it: then a product of
/// five, 72 of which bound [`sphere`], has at most 120 bits.
fn small<const N: usize>(points: &[V3; N], origin: V3) -> Option<[[i128; 3]; N]> {
    let mut rows = [[0.0; 3]; N];
    for (row, p) in rows.iter_mut().zip(points) {
        for k in 0..3 {
            let difference = Double::difference(p[k], origin[k]);
            if difference.low != 0.0 {
                return None;
            }
            row[k] = difference.high;
        }
    }
    let size = largest(&rows);
    if size == 0.0 {
        return Some([[0; 3]; N]);
    }
    let unit = exponent(size) - 23;
    // Adding this rounds to multiples of the unit.
    let rounder = 1.5 * power_of_two(52 + unit);
    let scale = power_of_two(-unit);
    let mut whole = [[0; 3]; N];
    for (row, p) in whole.iter_mut().zip(&rows) {
        for k in 0..3 {
            if (p[k] + rounder) - rounder != p[k] {
                return None;
            }
            #[allow(clippy::cast_possible_truncation, reason = "a whole number below 2^24")]
            let n = (p[k] * scale) as i64;
            row[k] = i128::from(n);
        }
    }
    Some(whole)
}

fn coord([x, y, z]: V3) -> Coord3D<f64> {
    Coord3D { x, y, z }
}
