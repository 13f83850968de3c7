//! Squared distances of features in double-double arithmetic, with error bounds, and their square roots.
//!
//! All positions are relative to the query. Offsets and edges are exact as double-double numbers, and their sizes (the
//! largest magnitudes of a component) a, d and e are within [`PLAIN_SIZES`]. Operations have relative errors below 7
//! u^2 \[Joldes2017\]. A quotient has a relative error below 11 u^2: the product of its first digit and the divisor
//! contributes 7 u^2 of the dividend, the last sum contributes 3 u^2, and the rest is of third order. The squared
//! length of an exact vector has a relative error below (1 + 7 u^2)^3 - 1 < 22 u^2. The quotient of two such squares,
//! and the square of a computed vector, have relative errors below 22 + 22 + 11 = 55 u^2, apart from the error of the
//! vector itself; [`RELATIVE_ERROR`] is 64 u^2.
//!
//! - The squared distance of a vertex is |A|^2.
//! - The squared distance of an edge is |A x D|^2 / |D|^2. A component of the cross product consists of two products
//!   below a d, each of two operations, so its error is below x = 28.1 u^2 a d ([`CROSS_ERROR`]). The error of the
//!   length of the vector is below sqrt(3) x, and the error of its square is below (2 |X| + sqrt(3) x) sqrt(3) x <= (6
//!   m + 3 x) x, where m is its size.
//! - The squared distance of a face is (N . A)^2 / |N|^2 with N = D x E. The height N . A consists of six products
//!   below a d e, each of five operations, so its error is below h = 6 * 35.1 u^2 a d e ([`HEIGHT_ERROR`]), and the
//!   error of its square is below (2 |N . A| + h) h. The error of the length of N is below sqrt(3) n with n = 28.1 u^2
//!   d e. If the size m of N is at least 2^20 n, the square of the length is wrong by a factor between (1 -+ sqrt(3) n
//!   / m)^2, and the quotient has a relative error below 3.5 n / m.
//!
//! The constants exceed these bounds by an eighth, the relative one by a seventh. That covers the rounding of the
//! bounds, errors of errors, and underflow, since squares of errors are above 2^-800.

use super::feature::{U, ends};
use super::feature_certificate::PLAIN_SIZES;
use super::rounded::RoundedDistance;
use crate::Feature;
use crate::kernel::arithmetic::{cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger};
use std::cmp::Ordering;

/// A bound on the relative error of squares and of quotients of squares.
const RELATIVE_ERROR: f64 = 64.0 * U * U;
/// A bound on the error of a component of a cross product, relative to the product of the sizes of its factors.
const CROSS_ERROR: f64 = 32.0 * U * U;
/// A bound on the error of the product of the normal and an offset, relative to the product of the three sizes.
const HEIGHT_ERROR: f64 = 240.0 * U * U;
/// The least ratio of the size of a normal to its error.
const MIN_NORMAL_PER_ERROR: f64 = power_of_two(20);

type Vector = [Double; 3];

/// A squared distance, which differs from `value` by at most `error`.
#[derive(Clone, Copy)]
pub(super) struct Square {
    value: Double,
    error: f64,
}

/// Returns the exact vector from one point to another.
fn between(from: &V3, to: &V3) -> Vector {
    std::array::from_fn(|k| Double::difference(to[k], from[k]))
}

/// Returns the magnitude of the largest component.
#[inline(always)]
#[allow(clippy::inline_always, reason = "a few instructions")]
fn size(x: &Vector) -> f64 {
    larger(larger(x[0].high.abs(), x[1].high.abs()), x[2].high.abs())
}

/// Returns the size of an offset, which may be zero. It is `None` if the size is out of range.
fn offset_size(x: &Vector) -> Option<f64> {
    let size = size(x);
    (size == 0.0 || PLAIN_SIZES.contains(&size)).then_some(size)
}

/// Returns the size of an edge, or `None` if it is out of range.
fn edge_size(x: &Vector) -> Option<f64> {
    let size = size(x);
    PLAIN_SIZES.contains(&size).then_some(size)
}

impl Square {
    /// Computes the squared distance of a feature that is proved to contain the nearest point. Returns `None` if a size
    /// is out of range, and for a face whose area is little more than rounding error.
    #[inline]
    pub(super) fn new(query: V3, vertices: &[V3], feature: Feature) -> Option<Self> {
        match feature {
            Feature::Vertex(i) => Self::from_vertex(&between(&query, &vertices[usize::from(i)])),
            Feature::Edge(i) => Self::from_edge(query, ends(i, vertices)),
            Feature::Face => Self::from_face(query, vertices),
        }
    }

    /// Computes the square of a length, or returns `None` if it is out of range.
    pub(super) fn from_length(x: f64) -> Option<Self> {
        (x == 0.0 || PLAIN_SIZES.contains(&x)).then(|| Self { value: Double::product(x, x), error: 0.0 })
    }

    fn from_vertex(offset: &Vector) -> Option<Self> {
        offset_size(offset)?;
        let value = dot(*offset, *offset);
        Some(Self { value, error: RELATIVE_ERROR * value.high })
    }

    fn from_edge(query: V3, [from, to]: [V3; 2]) -> Option<Self> {
        let edge = between(&from, &to);
        // The error bound is smaller for the offset to the nearer end.
        let [a, b] = [between(&query, &from), between(&query, &to)];
        let offset = if size(&a) < size(&b) { a } else { b };
        let error = CROSS_ERROR * (offset_size(&offset)? * edge_size(&edge)?);
        let moment = cross(offset, edge);
        let length = dot(edge, edge);
        let value = dot(moment, moment) / length;
        let error = (6.0 * size(&moment) + 3.0 * error) * error / length.high;
        Some(Self { value, error: error + RELATIVE_ERROR * value.high })
    }

    fn from_face(query: V3, vertices: &[V3]) -> Option<Self> {
        let edges = [between(&vertices[0], &vertices[1]), between(&vertices[1], &vertices[2])];
        let offset = between(&query, &vertices[1]);
        let normal = cross(edges[0], edges[1]);
        let area = edge_size(&edges[0])? * edge_size(&edges[1])?;
        let (normal_size, normal_error) = (size(&normal), CROSS_ERROR * area);
        if normal_size < MIN_NORMAL_PER_ERROR * normal_error {
            return None;
        }
        let height = dot(normal, offset);
        let height_error = HEIGHT_ERROR * (offset_size(&offset)? * area);
        let length = dot(normal, normal);
        let value = height * height / length;
        let squared_height_error = (2.0 * height.high.abs() + height_error) * height_error / length.high;
        let relative = RELATIVE_ERROR + 4.0 * (normal_error / normal_size);
        Some(Self { value, error: squared_height_error + relative * value.high })
    }

    /// Returns the square rounded to f64, for choices that need not be right.
    pub(super) fn rough(&self) -> f64 {
        self.value.high
    }

    /// Compares two squares. Returns `None` if their errors leave the result open.
    #[inline]
    pub(super) fn compare(&self, other: &Self) -> Option<Ordering> {
        /// A factor that covers the rounding of the sum and of the difference that is compared with it.
        const SLACK: f64 = 1.0 + 8.0 * U;
        let difference = (self.value - other.value).high;
        let error = (self.error + other.error) * SLACK;
        // Both comparisons are false for NaN.
        if difference > error {
            Some(Ordering::Greater)
        } else if difference < -error {
            Some(Ordering::Less)
        } else {
            None
        }
    }

    /// Returns the distance, or `None` if the error admits two roundings.
    ///
    /// Let y be the computed root of the upper half, S the true square and R its root, so that R - y = (S - y^2) / (R +
    /// y). Replacing R + y by 2 y changes this quotient by (R - y)^2 / 2 y. In relative terms, y is within u of the
    /// exact root of the upper half. That root is within u / 2 of the root of the value, which is within 2^-61 of R. So
    /// |R - y| < 2 u y, and the quotient changes by less than 2 u^2 y. S - y^2 is below 4 u y^2 and is rounded three
    /// times up to the quotient, which adds less than 3.1 u * 2 u y. Adding a bound to it costs at most 2.1 u^2 y, or u
    /// of the bound. The sum of these errors is below 12 u^2 y, apart from the error of the value.
    #[inline]
    pub(super) fn distance(&self) -> Option<RoundedDistance> {
        /// The largest relative error of the square for which the bound above is valid.
        const MAX_RELATIVE_ERROR: f64 = power_of_two(-60);
        /// A bound on the relative error of the root, apart from the error of the square.
        const ROOT_ERROR: f64 = 16.0 * U * U;
        /// A factor that covers the effects of rounding and of R - y on the quotient of the error.
        const SLACK: f64 = 1.0 + power_of_two(-8);
        let square = self.value.high;
        if square == 0.0 && self.error == 0.0 {
            return Some(RoundedDistance { nearest: 0.0, lower: 0.0 });
        }
        if self.error > MAX_RELATIVE_ERROR * square {
            return None;
        }
        let y = square.sqrt();
        let half = 0.5 / y;
        let step = (self.value - Double::product(y, y)).high * half;
        let error = self.error * half * SLACK + ROOT_ERROR * y;
        let [low, high] = [step - error, step + error];
        let (nearest, last) = (y + low, y + high);
        // The difference is exact, since `nearest` is y or a neighbour of y.
        let lower = if low >= nearest - y { nearest } else { nearest.next_down() };
        #[allow(clippy::float_cmp, reason = "whether both ends are rounded to the same")]
        (nearest == last).then_some(RoundedDistance { nearest, lower })
    }
}
