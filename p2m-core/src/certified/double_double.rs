//! Squared distances of features in double-double, with bounds on their errors, and their roots.
//!
//! Everything is relative to the query. Offsets and edges are exact as double-double numbers, their largest components
//! a, d, e are within [`PLAIN`]; operations have relative errors below 7 u^2 \[Joldes2017\], a quotient below 11 u^2: its
//! first digit times the divisor errs by 7 u^2 of the dividend, the last sum by 3 u^2, all else is of third order. A
//! squared length, of a vector as it is, errs by less than (1 + 7 u^2)^3 - 1 < 22 u^2 of itself. Squares of what is
//! computed, and quotients of two such squares, err by less than 22 + 22 + 11 = 55 u^2: [`RELATIVE_ERROR`] is 64 u^2.
//!
//! - A vertex: |A|^2, and nothing else.
//! - An edge: |A x D|^2 / |D|^2. A component of the cross product is two products below a d, of which each takes two
//!   operations: it errs by less than x = 28.1 u^2 a d ([`CROSS_ERROR`]), the length of the vector by less than
//!   sqrt(3) x, and its square by less than (2 |X| + sqrt(3) x) sqrt(3) x <= (6 m + 3 x) x, if m is its largest component.
//! - A face: (N . A)^2 / |N|^2 with N = D x E. The height N . A is six products below a d e, of which each takes five
//!   operations: it errs by less than h = 6 * 35.1 u^2 a d e ([`HEIGHT_ERROR`]), and its square by less than
//!   (2 |N . A| + h) h. The length of N errs by less than sqrt(3) n with n = 28.1 u^2 d e; with the largest component m of
//!   N at least 2^20 n the square of the length is off by a factor between (1 -+ sqrt(3) n / m)^2, and the quotient by
//!   less than 3.5 n / m of itself.
//!
//! The constants exceed these by an eighth (the relative one by a seventh), which is more than the rounding of the bounds,
//! errors of errors, and what underflows: squares of errors are above 2^-800.

use super::feature_certificate::PLAIN;
use super::{Rounded, U, ends};
use crate::Feature;
use crate::kernel::arithmetic::{cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger};
use std::cmp::Ordering;

/// Of squares and quotients of squares.
const RELATIVE_ERROR: f64 = 64.0 * U * U;
/// Of a component of a cross product, in parts of the sizes of the factors.
const CROSS_ERROR: f64 = 32.0 * U * U;
/// Of the product of the normal and an offset, in parts of the sizes of the three.
const HEIGHT_ERROR: f64 = 240.0 * U * U;
/// The largest component of a normal is at least its error times this.
const CLEAR: f64 = power_of_two(20);

type Vector = [Double; 3];

/// A squared distance, within `error` of `value`.
#[derive(Clone, Copy)]
pub(super) struct Square {
    value: Double,
    error: f64,
}

fn between(from: &V3, to: &V3) -> Vector {
    std::array::from_fn(|k| Double::difference(to[k], from[k]))
}

/// The largest component.
#[inline(always)]
#[allow(clippy::inline_always, reason = "a few instructions")]
fn size(x: &Vector) -> f64 {
    larger(larger(x[0].high.abs(), x[1].high.abs()), x[2].high.abs())
}

/// The same where it is an offset's, which may be zero, if it is in range.
fn offset_size(x: &Vector) -> Option<f64> {
    let size = size(x);
    (size == 0.0 || PLAIN.contains(&size)).then_some(size)
}

fn edge_size(x: &Vector) -> Option<f64> {
    let size = size(x);
    PLAIN.contains(&size).then_some(size)
}

impl Square {
    /// Of a feature that is proved to hold the nearest point; `None` out of range, and for faces that hardly have an area.
    #[inline]
    pub(super) fn new(query: V3, vertices: &[V3], feature: Feature) -> Option<Self> {
        match feature {
            Feature::Vertex(i) => Self::of_vertex(&between(&query, &vertices[usize::from(i)])),
            Feature::Edge(i) => Self::of_edge(query, ends(i, vertices)),
            Feature::Face => Self::of_face(query, vertices),
        }
    }

    /// Of a length; `None` out of range.
    pub(super) fn of_length(x: f64) -> Option<Self> {
        (x == 0.0 || PLAIN.contains(&x)).then(|| Self { value: Double::product(x, x), error: 0.0 })
    }

    fn of_vertex(offset: &Vector) -> Option<Self> {
        offset_size(offset)?;
        let value = dot(*offset, *offset);
        Some(Self { value, error: RELATIVE_ERROR * value.high })
    }

    fn of_edge(query: V3, [from, to]: [V3; 2]) -> Option<Self> {
        let edge = between(&from, &to);
        // From the nearer end less is lost.
        let [a, b] = [between(&query, &from), between(&query, &to)];
        let offset = if size(&a) < size(&b) { a } else { b };
        let error = CROSS_ERROR * (offset_size(&offset)? * edge_size(&edge)?);
        let moment = cross(offset, edge);
        let length = dot(edge, edge);
        let value = dot(moment, moment) / length;
        let error = (6.0 * size(&moment) + 3.0 * error) * error / length.high;
        Some(Self { value, error: error + RELATIVE_ERROR * value.high })
    }

    fn of_face(query: V3, vertices: &[V3]) -> Option<Self> {
        let edges = [between(&vertices[0], &vertices[1]), between(&vertices[1], &vertices[2])];
        let offset = between(&query, &vertices[1]);
        let normal = cross(edges[0], edges[1]);
        let area = edge_size(&edges[0])? * edge_size(&edges[1])?;
        let (clear, normal_error) = (size(&normal), CROSS_ERROR * area);
        if clear < CLEAR * normal_error {
            return None;
        }
        let height = dot(normal, offset);
        let height_error = HEIGHT_ERROR * (offset_size(&offset)? * area);
        let length = dot(normal, normal);
        let value = height * height / length;
        let of_height = (2.0 * height.high.abs() + height_error) * height_error / length.high;
        let relative = RELATIVE_ERROR + 4.0 * (normal_error / clear);
        Some(Self { value, error: of_height + relative * value.high })
    }

    /// Rounded, for a choice that need not be right.
    pub(super) fn rough(&self) -> f64 {
        self.value.high
    }

    /// Which one is less, if that is certain.
    #[inline]
    pub(super) fn compare(&self, other: &Self) -> Option<Ordering> {
        /// For the rounding of the sum and of the difference that is compared with it.
        const SLACK: f64 = 1.0 + 8.0 * U;
        let difference = (self.value - other.value).high;
        let doubt = (self.error + other.error) * SLACK;
        // Not for NaN.
        if difference > doubt {
            Some(Ordering::Greater)
        } else if difference < -doubt {
            Some(Ordering::Less)
        } else {
            None
        }
    }

    /// The distance, if it is certain how it is rounded.
    ///
    /// Let y be the root of the upper half, S the true square, R its root, so that R - y = (S - y^2) / (R + y). With
    /// 2 y in the place of R + y that is off by (R - y)^2 / 2 y. Here y is within u of its own number, that within u / 2
    /// of the root of the value, and that within 2^-61 of R: |R - y| < 2 u y, and the quotient is off by less than
    /// 2 u^2 y. S - y^2 is below 4 u y^2 and rounded three times on the way to the quotient, which is off by less than
    /// 3.1 u * 2 u y for that. Adding a bound to it costs 2.1 u^2 y at most, or u of the bound. Altogether below
    /// 12 u^2 y, apart from the error of the value.
    #[inline]
    pub(super) fn distance(&self) -> Option<Rounded> {
        /// Errors of squares, relative to the square, for which the above holds.
        const SMALL: f64 = power_of_two(-60);
        const ROOT_ERROR: f64 = 16.0 * U * U;
        /// 2^-8: more than rounding and R - y make the quotient of the error wrong by.
        const SLACK: f64 = 1.0 + power_of_two(-8);
        let square = self.value.high;
        if square == 0.0 && self.error == 0.0 {
            return Some(Rounded { nearest: 0.0, lower: 0.0 });
        }
        if self.error > SMALL * square {
            return None;
        }
        let y = square.sqrt();
        let half = 0.5 / y;
        let step = (self.value - Double::product(y, y)).high * half;
        let doubt = self.error * half * SLACK + ROOT_ERROR * y;
        let [low, high] = [step - doubt, step + doubt];
        let (nearest, last) = (y + low, y + high);
        // The difference of two neighbours, at most, is exact.
        let lower = if low >= nearest - y { nearest } else { nearest.next_down() };
        #[allow(clippy::float_cmp, reason = "whether both ends are rounded to the same")]
        (nearest == last).then_some(Rounded { nearest, lower })
    }
}
