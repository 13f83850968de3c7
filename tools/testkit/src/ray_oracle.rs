//! The intersections of lines with primitives in exact rational arithmetic.
//!
//! The intersection of a line and a primitive is a point or a segment, whose ends have exact parameters and weights.
//! Crossings are decided by moving the line by a sufficiently small number and intersecting it with the plane.

#![allow(clippy::float_cmp, reason = "nothing here has a tolerance")]

use crate::integers::{V, cross, dot, sub};
use crate::line_and_primitive::{LineAndPrimitive, LinePoint};
use crate::ratio::Ratio;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, UnsignedAbs};
use p2m_core::{Hit, Ray, Side};
use std::cmp::Ordering;

/// Returns the rounded point of the line of a ray that is nearest to a position.
#[must_use]
pub fn nearest_to(ray: &Ray, position: [f64; 3]) -> [f64; 3] {
    let vector = |p: [f64; 3]| p.map(Ratio::from);
    let (o, d, p) = (vector(ray.origin().coords.into()), vector(ray.direction().into()), vector(position));
    let dot = |a: &[Ratio; 3], b: &[Ratio; 3]| {
        a.iter().zip(b).map(|(a, b)| a.clone() * b.clone()).reduce(|a, b| a + b).expect("three")
    };
    let offset = std::array::from_fn(|k| p[k].clone() - o[k].clone());
    let t = dot(&offset, &d) / dot(&d, &d);
    std::array::from_fn(|k| (o[k].clone() + t.clone() * d[k].clone()).round())
}

/// The intersection of a whole line with a primitive.
#[derive(Clone, Debug)]
pub struct LineIntersection {
    /// The ends of the common segment. Both are equal for a common point.
    ends: [LinePoint; 2],
    parameters: [f64; 2],
    side: Side,
    /// Whether a point has unique weights. It has not if three vertices only span a segment or a point.
    has_unique_weights: bool,
    vertices: Vec<[f64; 3]>,
}

/// The accuracy that is required of the weights of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WeightAccuracy {
    /// Each weight is the exact one, rounded to nearest.
    Rounded,
    /// Each weight is within 4 u of the exact one.
    Near,
    /// Any weights that give the point are allowed.
    Any,
}

/// The exact hit, which an answer has to equal.
#[derive(Clone, Debug)]
pub struct ExpectedHit<'a> {
    /// The parameter, to the last bit.
    pub parameter: f64,
    /// The side from which the ray comes.
    pub side: Side,
    weights: [Ratio; 3],
    accuracy: WeightAccuracy,
    vertices: &'a [[f64; 3]],
}

impl LineIntersection {
    /// Intersects the whole line of a ray with a primitive of one to three vertices. Segments and points count within
    /// the radius of the ray.
    #[must_use]
    pub fn new(ray: &Ray, vertices: &[[f64; 3]]) -> Option<Self> {
        let exact = LineAndPrimitive::new(ray, vertices);
        let parts = if vertices.len() < 3 && ray.radius() > 0.0 { exact.nearest_part() } else { exact.clip_to_line() };
        let mut points: Vec<LinePoint> = parts.iter().map(|w| exact.line_point(w)).collect();
        points.sort_by(|a, b| a.parameter.compare(&b.parameter));
        let ends = [points.first()?.clone(), points.last()?.clone()];
        let o = &exact.offsets;
        let (side, has_unique_weights) = match vertices.len() {
            1 => (Side::Along, true),
            2 => (Side::Along, o[0] != o[1]),
            _ => {
                let normal = cross(&sub(&o[1], &o[0]), &sub(&o[2], &o[0]));
                let side = match dot(&normal, &exact.direction).cmp(&IBig::ZERO) {
                    Ordering::Less => Side::Front,
                    Ordering::Equal => Side::Along,
                    Ordering::Greater => Side::Back,
                };
                (side, normal.iter().any(|x| *x != IBig::ZERO))
            }
        };
        let parameters = ends.each_ref().map(|end| end.parameter.round());
        Some(Self { ends, parameters, side, has_unique_weights, vertices: vertices.to_vec() })
    }

    /// Returns the smallest and the largest parameter, rounded.
    #[must_use]
    pub fn parameters(&self) -> [f64; 2] {
        self.parameters
    }

    /// Returns the hit of a ray that is restricted to a range.
    #[must_use]
    pub fn in_range(&self, [min, max]: [f64; 2]) -> Option<ExpectedHit<'_>> {
        let [first, last] = self.parameters;
        if first > max || last < min {
            return None;
        }
        let accuracy = if self.has_unique_weights { WeightAccuracy::Rounded } else { WeightAccuracy::Any };
        let expected = |parameter: f64, weights, accuracy| ExpectedHit {
            parameter: parameter + 0.0,
            side: self.side,
            weights,
            accuracy,
            vertices: &self.vertices,
        };
        let [from, to] = &self.ends;
        if first >= min {
            return Some(expected(first, from.weights.clone(), accuracy));
        }
        // The range begins inside of the segment, at this fraction of its length from 0 to 1.
        let [zero, one] = [0.0, 1.0].map(Ratio::from);
        let fraction = if min.is_finite() {
            let length = to.parameter.clone() - from.parameter.clone();
            let fraction = (Ratio::from(min) - from.parameter.clone()) / length;
            if fraction.is_below(&zero) {
                zero
            } else if one.is_below(&fraction) {
                one.clone()
            } else {
                fraction
            }
        } else {
            one.clone()
        };
        let rest = one - fraction.clone();
        let weights =
            std::array::from_fn(|k| from.weights[k].clone() * rest.clone() + to.weights[k].clone() * fraction.clone());
        Some(expected(min, weights, if self.has_unique_weights { WeightAccuracy::Near } else { WeightAccuracy::Any }))
    }
}

/// The unit roundoff u of f64.
const U: f64 = f64::EPSILON / 2.0;

impl ExpectedHit<'_> {
    /// Compares a hit with the exact one.
    ///
    /// # Errors
    /// Returns a description of the first difference.
    pub fn check(&self, hit: &Hit) -> Result<(), String> {
        if hit.parameter.to_bits() != self.parameter.to_bits() {
            return Err(format!("parameter {:e}, not {:e}", hit.parameter, self.parameter));
        }
        if hit.side != self.side {
            return Err(format!("side {:?}, not {:?}", hit.side, self.side));
        }
        for (k, (found, exact)) in hit.barycentric().iter().zip(&self.weights).enumerate() {
            let right = match self.accuracy {
                _ if k >= self.vertices.len() => found.to_bits() == 0,
                WeightAccuracy::Rounded => found.to_bits() == exact.round().to_bits(),
                WeightAccuracy::Near => {
                    *found >= 0.0 && !Ratio::from(4.0 * U).is_below(&(Ratio::from(*found) - exact.clone()).abs())
                }
                WeightAccuracy::Any => (0.0..=1.0).contains(found),
            };
            if !right {
                return Err(format!("weight {k} is {found:e}, not {:e} ({:?})", exact.round(), self.accuracy));
            }
        }
        let point: [f64; 3] = hit.point().coords.into();
        let vertex = hit.barycentric().iter().position(|w| *w == 1.0);
        if vertex.is_some_and(|vertex| point.map(f64::to_bits) != self.vertices[vertex].map(f64::to_bits)) {
            return Err(format!("point {:?} is not vertex {vertex:?}", hit.point()));
        }
        for k in 0..3 {
            let at = |weights: &[Ratio; 3]| {
                let terms = self.vertices.iter().zip(weights).map(|(v, w)| Ratio::from(v[k]) * w.clone());
                terms.fold(Ratio::from(0.0), |a, b| a + b)
            };
            // The rounding errors are 4 u for the sum and 3 u for the weights, and 8 u with underflow. Less accurate
            // weights allow more.
            let factor = if self.accuracy == WeightAccuracy::Rounded { 8.0 } else { 16.0 };
            let size = self.vertices.iter().fold(0.0, |m: f64, v| m.max(v[k].abs()));
            let slack = Ratio::from(factor * U) * Ratio::from(size) + Ratio::from(3.0 * f64::from_bits(1));
            let far = |x: Ratio, y: &Ratio| slack.is_below(&(x - y.clone()).abs());
            let exact = at(&self.weights);
            if !hit.point()[k].is_finite() || far(Ratio::from(hit.point()[k]), &exact) {
                return Err(format!("coordinate {k} of the point is {:e}, not {:e}", hit.point()[k], exact.round()));
            }
            if far(at(&hit.barycentric().map(Ratio::from)), &exact) {
                return Err(format!("weights {:?} make another point", hit.barycentric()));
            }
        }
        Ok(())
    }
}

fn determinant([a, b, c]: [&V; 3]) -> IBig {
    let even = &a[0] * &b[1] * &c[2] + &a[1] * &b[2] * &c[0] + &a[2] * &b[0] * &c[1];
    let odd = &a[0] * &b[2] * &c[1] + &a[1] * &b[0] * &c[2] + &a[2] * &b[1] * &c[0];
    even - odd
}

/// Returns the side from which the line of a ray crosses a triangle, and the parameter of its plane. The line is moved
/// by e along x, by e^2 along y and by e^3 along z, where e is positive and arbitrarily small, so that it never runs
/// through an edge or a vertex (simulation of simplicity).
#[must_use]
pub fn crossing(ray: &Ray, vertices: &[[f64; 3]]) -> Option<(Side, f64)> {
    if vertices.len() < 3 {
        return None;
    }
    let LineAndPrimitive { offsets: o, direction, unit, .. } =
        LineAndPrimitive::new(&ray.with_radius(0.0).expect("zero"), vertices);
    // A + u E + v F = O + t D, where O is zero. For a moved O, the right side is scaled to integers.
    let (e, f) = (sub(&o[1], &o[0]), sub(&o[2], &o[0]));
    let back: V = direction.each_ref().map(|x| -x);
    let all = determinant([&e, &f, &back]);
    if all == IBig::ZERO {
        return None;
    }
    let side = if all > IBig::ZERO { Side::Front } else { Side::Back };
    let right: V = o[0].each_ref().map(|x| -x);
    let turn = if all > IBig::ZERO { IBig::ONE } else { -IBig::ONE };
    // The weights u, v and 1 - u - v, times a positive number, for a right side that is scaled by 2^scale.
    let weights = |right: &V, scale: usize| {
        let (u, v) = (determinant([right, &f, &back]) * &turn, determinant([&e, right, &back]) * &turn);
        let rest = ((&all * &turn) << scale) - &u - &v;
        [u, v, rest]
    };
    let zero = IBig::ZERO;
    let mut inside = weights(&right, 0);
    // The move matters only if the line runs through an edge or a vertex.
    if inside.iter().all(|x| *x >= zero) && inside.contains(&zero) {
        // Determinants are below 2^(3 bits + 5), and zero or at least 1, so 2^-(3 bits + 8) is negligible beside them.
        let entries = [&e, &f, &back, &right].into_iter().flatten();
        let bits = entries.map(|x| x.unsigned_abs().bit_len()).max().expect("some");
        let fine = 3 * bits + 8;
        let moved: V = std::array::from_fn(|k| (&right[k] << (3 * fine)) + (IBig::ONE << ((2 - k) * fine)));
        inside = weights(&moved, 3 * fine);
        assert!(!inside.contains(&zero), "moved off all edges");
    }
    let parameter = || Ratio::new(determinant([&e, &f, &right]), all.clone()).times_power_of_two(unit).round();
    inside.iter().all(|x| *x > zero).then(|| (side, parameter()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    const T: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray::new(&Point3::from(origin), &Vector3::from(direction)).expect("a ray").line()
    }

    /// Returns the parameters of the common segment and the weights of its first end.
    fn intersection(
        origin: [f64; 3],
        direction: [f64; 3],
        vertices: &[[f64; 3]],
    ) -> Option<([f64; 2], [f64; 3], Side)> {
        let intersection = LineIntersection::new(&ray(origin, direction), vertices)?;
        let weights = intersection.ends[0].weights.each_ref().map(Ratio::round);
        Some((intersection.parameters(), weights, intersection.side))
    }

    #[test]
    fn lines_intersect_a_triangle_in_closed_forms() {
        let down = [0.0, 0.0, -2.0];
        assert_eq!(intersection([1.0, 1.0, 3.0], down, &T), Some(([1.5; 2], [0.5, 0.25, 0.25], Side::Front)));
        assert_eq!(intersection([1.0, 1.0, -3.0], down, &T), Some(([-1.5; 2], [0.5, 0.25, 0.25], Side::Front)));
        assert_eq!(
            intersection([1.0, 1.0, -3.0], [0.0, 0.0, 1.0], &T),
            Some(([3.0; 2], [0.5, 0.25, 0.25], Side::Back))
        );
        assert_eq!(intersection([2.0, 2.0, 3.0], down, &T), Some(([1.5; 2], [0.0, 0.5, 0.5], Side::Front)));
        assert_eq!(intersection([2.0, 2f64.next_up(), 3.0], down, &T), None);
        assert_eq!(intersection([0.0, 4.0, 3.0], down, &T), Some(([1.5; 2], [0.0, 0.0, 1.0], Side::Front)));
        // The line lies in the plane: across the triangle, along an edge, touching a vertex, beside the triangle.
        let across = [1.0, 0.0, 0.0];
        assert_eq!(intersection([-1.0, 1.0, 0.0], across, &T), Some(([1.0, 4.0], [0.75, 0.0, 0.25], Side::Along)));
        assert_eq!(intersection([9.0, 0.0, 0.0], across, &T), Some(([-9.0, -5.0], [1.0, 0.0, 0.0], Side::Along)));
        assert_eq!(intersection([9.0, 4.0, 0.0], across, &T), Some(([-9.0; 2], [0.0, 0.0, 1.0], Side::Along)));
        assert_eq!(intersection([9.0, 5.0, 0.0], across, &T), None);
        assert_eq!(intersection([9.0, 4.0, 1e-300], across, &T), None);
    }

    #[test]
    fn ranges_take_the_smallest_parameter_of_a_segment() {
        let line = ray([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        let intersection = LineIntersection::new(&line, &T).expect("an intersection");
        let at =
            |min, max| intersection.in_range([min, max]).map(|e| (e.parameter, e.weights.each_ref().map(Ratio::round)));
        assert_eq!(at(0.0, 9.0), Some((1.0, [0.75, 0.0, 0.25])));
        assert_eq!(at(0.0, 1.0), Some((1.0, [0.75, 0.0, 0.25])));
        assert_eq!(at(2.5, 2.5), Some((2.5, [0.375, 0.375, 0.25])));
        assert_eq!(at(4.0, 9.0), Some((4.0, [0.0, 0.75, 0.25])));
        assert_eq!(at(0.0, 1f64.next_down()), None);
        assert_eq!(at(4f64.next_up(), 9.0), None);
    }

    #[test]
    fn segments_are_hit_where_the_line_is_nearest() {
        let segment = [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0]];
        let near = |origin: [f64; 3], direction: [f64; 3], radius| {
            let intersection =
                LineIntersection::new(&ray(origin, direction).with_radius(radius).expect("valid"), &segment)?;
            Some((intersection.parameters(), intersection.ends[0].weights.each_ref().map(Ratio::round)))
        };
        let x = [2.0, 0.0, 0.0];
        assert_eq!(near([-4.0, 3.0, 1.0], x, 3.0), Some(([2.0; 2], [0.75, 0.25, 0.0])));
        assert_eq!(near([-4.0, 3f64.next_up(), 1.0], x, 3.0), None);
        assert_eq!(near([-4.0, 3.0, 8.0], x, 5.0), Some(([2.0; 2], [0.0, 1.0, 0.0])));
        assert_eq!(near([-4.0, 3.0, 8.0], x, 5f64.next_down()), None);
        assert_eq!(near([3.0, 4.0, 9.0], [0.0, 0.0, -1.0], 5.0), Some(([5.0, 9.0], [0.0, 1.0, 0.0])));
        assert_eq!(near([3.0, 4.0, 9.0], [0.0, 0.0, -1.0], 4.999), None);
    }

    #[test]
    fn lines_on_edges_cross_beside_them() {
        let cross = |x: f64, y: f64, vertices: [[f64; 3]; 3]| {
            crossing(&ray([x, y, 3.0], [0.0, 0.0, -2.0]), &vertices).map(|(side, t)| (side == Side::Front, t))
        };
        let turned = [T[0], T[2], T[1]];
        assert_eq!(cross(1.0, 1.0, T), Some((true, 1.5)));
        assert_eq!(cross(1.0, 1.0, turned), Some((false, 1.5)));
        // The line moves to larger x and y: off the long side, and onto the other sides.
        assert_eq!(cross(2.0, 2.0, T), None);
        assert_eq!(cross(2.0, 0.0, T), Some((true, 1.5)));
        assert_eq!(cross(0.0, 2.0, turned), Some((false, 1.5)));
        assert_eq!(cross(0.0, 0.0, T), Some((true, 1.5)));
        assert_eq!(cross(4.0, 0.0, T), None);
        // The x axis moves first: past a corner whose inside is to the left, and into one whose inside lies along x.
        assert_eq!(cross(0.0, 4.0, T), None);
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]), None);
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0]]), Some((true, 1.5)));
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), None, "along the plane");
    }
}
