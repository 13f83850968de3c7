//! Where a line meets the plane of a triangle, and with which weights: rounded to nearest, by double-double numbers where
//! these leave no doubt.

use crate::kernel::arithmetic::{cross, dot};
use crate::kernel::double_double::{Double, ROUNDING as DOUBLE};
use crate::kernel::power_of_two;
use crate::kernel::vector::V3;

/// u of f64.
pub(super) const U: f64 = f64::EPSILON / 2.0;
/// Magnitudes for which products of three underflow nowhere that matters, and overflow nowhere.
pub(super) const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-250)..=power_of_two(250);

/// Where a line meets the plane of a triangle, in double-double arithmetic.
pub(super) struct Plane {
    /// From the first vertex to the others, and from the origin of the line to it.
    edges: [[Double; 3]; 2],
    offset: [Double; 3],
    direction: [Double; 3],
    normal: [Double; 3],
    parameter: Double,
    /// Of the parameter.
    error: f64,
}

impl Plane {
    /// `None` where products might over- or underflow, or the line is nearly parallel.
    pub(super) fn new(origin: &V3, direction: &V3, [a, b, c]: &[V3; 3]) -> Option<Self> {
        let minus = |p: &V3, q: &V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(p[k], q[k])) };
        let (e, f, offset) = (minus(b, a), minus(c, a), minus(a, origin));
        let direction = direction.map(|x| Double { high: x, low: 0.0 });
        let sizes = [size(&e), size(&f), size(&offset), size(&direction)];
        if !sizes.iter().all(|x| PLAIN.contains(x)) {
            return None;
        }
        let normal = cross(e, f);
        let (height, speed) = (dot(normal, offset), dot(normal, direction));
        let parameter = height / speed;
        let [height_error, speed_error] = [sizes[2], sizes[3]].map(|x| DOUBLE * sizes[0] * sizes[1] * x);
        let error = quotient_error(parameter, height_error, speed, speed_error)?;
        Some(Self { edges: [e, f], offset, direction, normal, parameter, error })
    }

    /// The parameter, rounded to nearest.
    pub(super) fn parameter(&self) -> Option<f64> {
        rounded(self.parameter, self.error)
    }

    /// The weights of the vertices, rounded to nearest: with x for the way from the first vertex to the point,
    /// x = v e + w f, so v = (x x f) / (e x f) and w = (e x x) / (e x f), on the axis where e x f is largest.
    pub(super) fn weights(&self) -> Option<V3> {
        let Self { edges: [e, f], offset, direction, normal, parameter, error } = self;
        let x: [Double; 3] = std::array::from_fn(|k| *parameter * direction[k] - offset[k]);
        let reach = size(direction);
        let x_error = DOUBLE * (size(offset) + parameter.high.abs() * reach) + error * reach;
        let largest = |i: usize, j: usize| if normal[j].high.abs() > normal[i].high.abs() { j } else { i };
        let k = largest(largest(0, 1), 2);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (e_size, f_size) = (size(e), size(f));
        let weight = |numerator: Double, other: f64| {
            let quotient = numerator / normal[k];
            let numerator_error = other * (DOUBLE * size(&x) + 2.0 * x_error);
            quotient_error(quotient, numerator_error, normal[k], DOUBLE * e_size * f_size)
                .map(|error| (quotient, error))
        };
        let (v, v_error) = weight(x[i] * f[j] - x[j] * f[i], f_size)?;
        let (w, w_error) = weight(e[i] * x[j] - e[j] * x[i], e_size)?;
        let one = Double { high: 1.0, low: 0.0 };
        let u = one - v - w;
        let u_error = v_error + w_error + DOUBLE * (1.0 + v.high.abs() + w.high.abs());
        Some([rounded(u, u_error)?, rounded(v, v_error)?, rounded(w, w_error)?])
    }
}

/// The largest component.
fn size(x: &[Double; 3]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.high.abs()))
}

/// What a quotient is off, given the errors of what is divided and of the divisor; `None` if that could be zero.
fn quotient_error(quotient: Double, error: f64, divisor: Double, divisor_error: f64) -> Option<f64> {
    let least = divisor.high.abs() - divisor_error;
    let t = quotient.high.abs();
    let error = (error + t * divisor_error) / least * (1.0 + 16.0 * U) + t * DOUBLE;
    (least > 0.0).then_some(error)
}

/// A number rounded to nearest, if its error leaves no doubt. Not for zero, nor where rounding might underflow.
fn rounded(x: Double, error: f64) -> Option<f64> {
    let [low, high] = [x.high + (x.low - error), x.high + (x.low + error)];
    (low == high && PLAIN.contains(&low.abs())).then_some(low)
}
