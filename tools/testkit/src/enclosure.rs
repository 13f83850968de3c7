//! Lower and upper bounds of a distance, computed in about a microsecond: a filter in front of rational arithmetic.
//!
//! The convex hull of up to three vertices has a point of minimum norm, seen from the query. Any point of the hull
//! bounds the distance from above. Any direction n bounds it from below by the minimum of n . a / |n| over the
//! vertices a, because the hull lies beyond that plane. Neither bound depends on how the point was found, so a mistake
//! in finding it makes the bounds wide but never wrong. The check is therefore independent of every formula that it
//! checks. Where the bounds are too far apart, for slivers and beside edges, [`Distance`](crate::oracle::Distance)
//! decides.
//!
//! Numbers are unevaluated sums of two f64, with operations whose relative errors are below 2^-100, on offsets from the
//! query whose largest component is between 1 and 2. `SLACK` is about thirty times the largest sum of these errors.

use std::ops::{Add, Div, Mul, Sub};

/// The amount by which both bounds are widened, in units of the largest component of an offset.
const SLACK: f64 = f64::from_bits((1023 - 94) << 52);

/// An unevaluated sum of two f64, `high` and `low`, where |low| is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    high: f64,
    low: f64,
}

const ZERO: Pair = Pair { high: 0.0, low: 0.0 };

/// Returns a + b without rounding error (two-sum).
fn sum(a: f64, b: f64) -> Pair {
    let high = a + b;
    let b_part = high - a;
    Pair { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// Returns a + b without rounding error, if |a| is at least |b| (fast two-sum).
fn ordered(a: f64, b: f64) -> Pair {
    let high = a + b;
    Pair { high, low: b - (high - a) }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let middle = ordered(high.high, high.low + low.high);
        ordered(middle.high, middle.low + low.low)
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        ordered(high, low)
    }
}

impl Div for Pair {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let of = |x: f64| Self { high: x, low: 0.0 };
        let rest = self - other * of(first);
        let second = rest.high / other.high;
        let third = (rest - other * of(second)).high / other.high;
        ordered(first, second) + of(third)
    }
}

impl Pair {
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return ZERO;
        }
        let root = self.high.sqrt();
        let square = Self { high: root, low: 0.0 } * Self { high: root, low: 0.0 };
        ordered(root, (self - square).high / (2.0 * root))
    }

    fn is_below(self, other: Self) -> bool {
        (self.high, self.low) < (other.high, other.low)
    }
}

type V = [Pair; 3];

fn dot(a: &V, b: &V) -> Pair {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &V, b: &V) -> V {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn between(a: &V, b: &V) -> V {
    std::array::from_fn(|k| b[k] - a[k])
}

/// Returns x 2^e, multiplied in steps that stay in range if the result does.
pub(crate) fn scaled(x: f64, e: i32) -> f64 {
    let half_exponent = e / 2;
    x * 2f64.powi(half_exponent) * 2f64.powi(e - half_exponent)
}

/// Bounds on the distance from a query to the convex hull of one to three vertices.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    low: Pair,
    high: Pair,
    /// The largest distance from the query to a vertex, up to a few roundings.
    max_vertex_distance: f64,
    /// The exponent of the unit: lengths are multiples of 2^exponent.
    exponent: i32,
}

impl Enclosure {
    /// Returns `None` if some coordinates are near the end of the range of f64 and others are tiny.
    ///
    /// # Panics
    /// Panics unless there are one to three vertices.
    #[must_use]
    pub fn new(query: [f64; 3], vertices: &[[f64; 3]]) -> Option<Self> {
        let all = || vertices.as_flattened().iter().chain(&query);
        let largest = all().fold(0.0, |m: f64, x| m.max(x.abs()));
        // Differences must not overflow, and scaled coordinates must keep their bits.
        let down = largest >= 2f64.powi(1020);
        if down && all().any(|x| *x != 0.0 && x.abs() < 2f64.powi(-900)) {
            return None;
        }
        let to = if down { -8 } else { 0 };
        let scaled_down = |p: &[f64; 3]| if down { p.map(|x| x * 2f64.powi(-8)) } else { *p };
        let q = scaled_down(&query);
        let mut offsets = [[ZERO; 3]; 3];
        let offsets = &mut offsets[..vertices.len()];
        for (offset, vertex) in offsets.iter_mut().zip(vertices) {
            let v = scaled_down(vertex);
            *offset = std::array::from_fn(|k| sum(v[k], -q[k]));
        }
        let size = offsets.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.high.abs()));
        if size == 0.0 {
            return Some(Self { low: ZERO, high: ZERO, max_vertex_distance: 0.0, exponent: 0 });
        }
        // `log2` need not be exact: the largest component may also be 0.9 or 2.1.
        #[allow(clippy::cast_possible_truncation, reason = "at most 1024")]
        let exponent = size.log2().floor() as i32;
        for x in offsets.as_flattened_mut() {
            *x = Pair { high: scaled(x.high, -exponent), low: scaled(x.low, -exponent) };
        }
        let (nearest, direction) = nearest(offsets);
        let slack = Pair { high: SLACK, low: 0.0 };
        let high = dot(&nearest, &nearest).sqrt() + slack;
        let length = dot(&direction, &direction).sqrt();
        let mut low = ZERO;
        if length.high > 2f64.powi(-300) {
            let heights = offsets.iter().map(|a| dot(a, &direction));
            let minimum = heights.reduce(|a, b| if b.is_below(a) { b } else { a }).expect("a vertex");
            let bound = minimum / length - slack;
            if ZERO.is_below(bound) {
                low = bound;
            }
        }
        let max_vertex_distance = offsets.iter().map(|a| dot(a, a).high).fold(0.0, f64::max).sqrt();
        Some(Self { low, high, max_vertex_distance, exponent: exponent - to })
    }

    /// Returns [`Distance::error`](crate::oracle::Distance::error), or up to a thousandth more; `None` if the bounds
    /// are too far apart.
    #[must_use]
    pub fn error(&self, computed: f64, bits: u32, eta: f64) -> Option<f64> {
        self.error_per(computed, bits, eta, self.max_vertex_distance)
    }

    /// Returns [`Distance::relative_error`](crate::oracle::Distance::relative_error), or up to a thousandth more;
    /// `None` if the bounds are too far apart.
    #[must_use]
    pub fn relative_error(&self, computed: f64, bits: u32, eta: f64) -> Option<f64> {
        self.error_per(computed, bits, eta, self.low.high)
    }

    fn error_per(&self, computed: f64, bits: u32, eta: f64, per: f64) -> Option<f64> {
        let at = |x: f64| scaled(x, -self.exponent);
        let unit = per * 2f64.powi(-bits.cast_signed());
        let width = (self.high - self.low).high;
        let computed = Pair { high: at(computed), low: 0.0 };
        if !computed.high.is_finite() || !unit.is_normal() || width > unit * 2f64.powi(-10) {
            return None;
        }
        let (above, below) = ((computed - self.low).high, (self.high - computed).high);
        Some(((above.max(below) - at(eta)) / unit).max(0.0) * (1.0 + 2f64.powi(-40)))
    }

    /// Returns whether the distance is at least `bound`; `None` if `bound` lies between the two bounds.
    #[must_use]
    pub fn is_at_least(&self, bound: f64) -> Option<bool> {
        let there = scaled(bound, -self.exponent);
        if !there.is_finite() || (bound != 0.0 && !there.is_normal()) {
            return None;
        }
        let bound = Pair { high: there, low: 0.0 };
        if !self.low.is_below(bound) {
            Some(true)
        } else if self.high.is_below(bound) {
            Some(false)
        } else {
            None
        }
    }

    /// Returns `factor` times the largest distance from the query to a vertex, up to a few roundings.
    #[must_use]
    pub fn times_max_vertex_distance(&self, factor: f64) -> f64 {
        scaled(self.max_vertex_distance * factor, self.exponent)
    }
}

/// Returns approximately the point of the hull that is nearest to the origin, and a direction in which about the whole
/// hull lies beyond the plane through the point.
///
/// The candidates are the vertices, the projections onto the edges and the projection onto the face, with the offset
/// itself or the normal of the face as the direction. The nearest candidate wins.
fn nearest(a: &[V]) -> (V, V) {
    let mut best = (dot(&a[0], &a[0]), a[0], a[0]);
    let mut offer = |point: V, direction: V| {
        let square = dot(&point, &point);
        if square.is_below(best.0) {
            best = (square, point, direction);
        }
    };
    a[1..].iter().for_each(|v| offer(*v, *v));
    let edges: &[[usize; 2]] = match a.len() {
        1 => &[],
        2 => &[[0, 1]],
        _ => &[[0, 1], [1, 2], [2, 0]],
    };
    for [i, j] in edges {
        let edge = between(&a[*i], &a[*j]);
        let (along, length) = (ZERO - dot(&a[*i], &edge), dot(&edge, &edge));
        if ZERO.is_below(along) && along.is_below(length) {
            let part = along / length;
            let point = std::array::from_fn(|k| a[*i][k] + part * edge[k]);
            offer(point, point);
        }
    }
    if let [a, b, c] = a {
        let normal = cross(&between(a, b), &between(a, c));
        let weights = [(b, c), (c, a), (a, b)].map(|(x, y)| dot(&normal, &cross(x, y)));
        let all = weights[0] + weights[1] + weights[2];
        if all.high > 2f64.powi(-600) && weights.iter().all(|w| !w.is_below(ZERO)) {
            let [u, v] = [weights[1] / all, weights[2] / all];
            let w = Pair { high: 1.0, low: 0.0 } - u - v;
            if !w.is_below(ZERO) {
                let point = std::array::from_fn(|k| w * a[k] + u * b[k] + v * c[k]);
                let sign = dot(&normal, a).high < 0.0;
                offer(point, if sign { normal.map(|x| ZERO - x) } else { normal });
            }
        }
    }
    (best.1, best.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::{self, wild};
    use crate::oracle::Distance;
    use crate::rng;

    /// Checks that the bounds hold, and that errors are at most a thousandth above those of rational arithmetic.
    #[test]
    fn bounds_hold_and_errors_are_those_of_rationals() {
        let (mut decided, mut total, mut told) = (0, 0, 0);
        let cases = crate::cases(60_000, 10_000);
        for seed in cases.clone() {
            let mut rng = rng("enclosure", seed);
            let case = if seed % 5 == 0 { wild(&mut rng) } else { families::case(&mut rng) };
            let exact = Distance::new(case.query, &case.vertices);
            total += 1;
            let Some(enclosure) = Enclosure::new(case.query, &case.vertices) else { continue };
            let context = || format!("seed {seed}: {case:?} {enclosure:?}");
            let [near, far] = [enclosure.low, enclosure.high].map(|x| scaled(x.high, enclosure.exponent));
            // The bounds are rounded to f64, which changes them by a factor of at most 1 + 2^-53.
            let near = near.min(f64::MAX);
            assert!(exact.is_at_least(near * (1.0 - f64::EPSILON) - 2.0 * f64::from_bits(1)), "{}", context());
            let above = far * (1.0 + 4.0 * f64::EPSILON) + 4.0 * f64::from_bits(1);
            assert!(above == f64::INFINITY || !exact.is_at_least(above), "{}", context());
            for computed in [near, far, (near + 3.0 * enclosure.times_max_vertex_distance(f64::EPSILON)).min(f64::MAX)]
            {
                for (bits, eta) in [(53, f64::from_bits(1)), (24, f64::from(f32::from_bits(1)))] {
                    let Some(error) = enclosure.error(computed, bits, eta) else { continue };
                    let expected = exact.error(computed, bits, eta);
                    assert!(error >= expected * (1.0 - 1e-5) - 1e-5, "{error}, not {expected}, {}", context());
                    assert!(error <= expected * (1.0 + 2e-3) + 2e-3, "{error}, not {expected}, {}", context());
                    decided += usize::from(bits == 53 && computed == near);
                }
                for bound in [computed, computed.next_up(), computed.next_down()].into_iter().filter(|x| x.is_finite())
                {
                    if let Some(is) = enclosure.is_at_least(bound) {
                        assert_eq!(is, exact.is_at_least(bound), "{bound:e} {}", context());
                        told += 1;
                    }
                }
            }
        }
        println!("{decided} of {total} decided without rational arithmetic, {told} comparisons");
        assert!(cases.is_replay() || decided > total / 2 && told > total, "{decided}, {told}, {total}");
    }
}
