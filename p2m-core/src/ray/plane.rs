//! The intersection of a line and the plane of a triangle, rounded to nearest if double-double arithmetic is certain.

use super::rounding::{PLAIN_MAGNITUDES, U};
use crate::kernel::arithmetic::{cross, dot};
use crate::kernel::double_double::{Double, ROUNDING as DOUBLE_ERROR};
use crate::kernel::vector::{V3, larger};

/// The intersection of a line and the plane of a triangle, in double-double arithmetic.
pub(super) struct PlaneIntersection {
    /// The vectors from the first vertex to the other two.
    edges: [[Double; 3]; 2],
    /// The vector from the origin of the line to the first vertex.
    offset: [Double; 3],
    direction: [Double; 3],
    normal: [Double; 3],
    parameter: Double,
    /// A bound on the error of the parameter.
    error: f64,
}

impl PlaneIntersection {
    /// Returns `None` if products might overflow or underflow, or if the line is nearly parallel to the plane.
    pub(super) fn new(origin: &V3, direction: &V3, [a, b, c]: &[V3; 3]) -> Option<Self> {
        let minus = |p: &V3, q: &V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(p[k], q[k])) };
        let (e, f, offset) = (minus(b, a), minus(c, a), minus(a, origin));
        let direction = direction.map(|x| Double { high: x, low: 0.0 });
        let sizes = [size(&e), size(&f), size(&offset), size(&direction)];
        if !sizes.iter().all(|x| PLAIN_MAGNITUDES.contains(x)) {
            return None;
        }
        let normal = cross(e, f);
        let (height, speed) = (dot(normal, offset), dot(normal, direction));
        let parameter = height / speed;
        let [height_error, speed_error] = [sizes[2], sizes[3]].map(|x| DOUBLE_ERROR * sizes[0] * sizes[1] * x);
        let error = quotient_error(parameter, height_error, speed, speed_error)?;
        Some(Self { edges: [e, f], offset, direction, normal, parameter, error })
    }

    /// Returns the parameter rounded to nearest, or `None` if its error admits two roundings.
    pub(super) fn parameter(&self) -> Option<f64> {
        rounded(self.parameter, self.error)
    }

    /// Returns the weights of the vertices rounded to nearest, or `None` if an error admits two roundings.
    ///
    /// Let p be the vector from the first vertex to the point, and e and f the edges. Then p = v e + w f, so that
    /// v = (p x f) / (e x f) and w = (e x p) / (e x f); the component in which e x f is largest is used.
    pub(super) fn weights(&self) -> Option<V3> {
        let Self { edges: [e, f], offset, direction, normal, parameter, error } = self;
        let p: [Double; 3] = std::array::from_fn(|k| *parameter * direction[k] - offset[k]);
        let speed = size(direction);
        let p_error = DOUBLE_ERROR * (size(offset) + parameter.high.abs() * speed) + error * speed;
        let largest = |i: usize, j: usize| if normal[j].high.abs() > normal[i].high.abs() { j } else { i };
        let k = largest(largest(0, 1), 2);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (e_size, f_size) = (size(e), size(f));
        let weight = |numerator: Double, other: f64| {
            let quotient = numerator / normal[k];
            let numerator_error = other * (DOUBLE_ERROR * size(&p) + 2.0 * p_error);
            quotient_error(quotient, numerator_error, normal[k], DOUBLE_ERROR * e_size * f_size)
                .map(|error| (quotient, error))
        };
        let (v, v_error) = weight(p[i] * f[j] - p[j] * f[i], f_size)?;
        let (w, w_error) = weight(e[i] * p[j] - e[j] * p[i], e_size)?;
        let one = Double { high: 1.0, low: 0.0 };
        let u = one - v - w;
        let u_error = v_error + w_error + DOUBLE_ERROR * (1.0 + v.high.abs() + w.high.abs());
        Some([rounded(u, u_error)?, rounded(v, v_error)?, rounded(w, w_error)?])
    }
}

/// Returns the largest magnitude of a component.
fn size(x: &[Double; 3]) -> f64 {
    larger(larger(x[0].high.abs(), x[1].high.abs()), x[2].high.abs())
}

/// Returns a bound on the error of a quotient, given bounds on the errors of the dividend and the divisor. It is `None`
/// if the divisor could be zero.
fn quotient_error(quotient: Double, error: f64, divisor: Double, divisor_error: f64) -> Option<f64> {
    let least = divisor.high.abs() - divisor_error;
    let t = quotient.high.abs();
    let error = (error + t * divisor_error) / least * (1.0 + 16.0 * U) + t * DOUBLE_ERROR;
    (least > 0.0).then_some(error)
}

/// Returns a number rounded to nearest. It is `None` if its error admits two roundings, for zero, and if rounding might
/// underflow.
fn rounded(x: Double, error: f64) -> Option<f64> {
    let [low, high] = [x.high + (x.low - error), x.high + (x.low + error)];
    (low == high && PLAIN_MAGNITUDES.contains(&low.abs())).then_some(low)
}
