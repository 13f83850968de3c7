//! Where lines meet primitives, in exact rational arithmetic.
//!
//! Nothing here is clever. A point of a primitive is known by the weights of its vertices. The line is where the three
//! components of (P - O) x D are zero, two of which are enough where the third component of D is not zero, since
//! D . ((P - O) x D) = 0. So the primitive is clipped by four half-spaces; what is left is a point or a stretch. Crossings are found by moving the line, by a number that is small enough, and solving for where it then
//! meets the plane. Rounding looks for the f64 whose neighbours are farther.

#![allow(clippy::float_cmp, reason = "nothing here has a tolerance")]

use crate::oracle::{V, cross, dot, integer, lowest_bit, sub};
use dashu_int::IBig;
use dashu_int::ops::{BitTest, UnsignedAbs};
use p2m_core::{Hit, Ray, Side};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Sub};

/// A fraction; the denominator is above zero.
#[derive(Clone, Debug)]
pub struct Ratio {
    numerator: IBig,
    denominator: IBig,
}

fn shifted(x: &IBig, by: i64) -> IBig {
    x << usize::try_from(by).expect("not negative")
}

impl Ratio {
    /// numerator / denominator, which is not zero.
    #[must_use]
    pub fn new(numerator: IBig, denominator: IBig) -> Self {
        assert!(denominator != IBig::ZERO);
        if denominator > IBig::ZERO {
            Self { numerator, denominator }
        } else {
            Self { numerator: -numerator, denominator: -denominator }
        }
    }

    fn times_power_of_two(self, exponent: i64) -> Self {
        if exponent >= 0 {
            Self { numerator: shifted(&self.numerator, exponent), ..self }
        } else {
            Self { denominator: shifted(&self.denominator, -exponent), ..self }
        }
    }

    fn abs(&self) -> Self {
        if self.numerator < IBig::ZERO { Self::from(0.0) - self.clone() } else { self.clone() }
    }

    /// Compares by value.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }

    fn is_below(&self, other: &Self) -> bool {
        self.compare(other) == Ordering::Less
    }

    /// The nearest f64, of two the even one; infinite from the middle between the largest one and 2^1024 on. Never -0.
    #[must_use]
    pub fn round(&self) -> f64 {
        if self.numerator < IBig::ZERO {
            return match self.abs().round() {
                0.0 => 0.0,
                x => -x,
            };
        }
        // By division of f64, a few units off; then step by step.
        let mut x = self.estimate();
        while x.is_finite() {
            let up = self.compare(&middle(x));
            if up == Ordering::Greater || up == Ordering::Equal && x.to_bits() & 1 == 1 {
                x = x.next_up();
                continue;
            }
            let down = if x > 0.0 { self.compare(&middle(x.next_down())) } else { Ordering::Greater };
            if down == Ordering::Less || down == Ordering::Equal && x.to_bits() & 1 == 1 {
                x = x.next_down();
                continue;
            }
            break;
        }
        x
    }

    /// A finite number near a fraction that is not negative.
    fn estimate(&self) -> f64 {
        let leading = |x: &IBig| {
            let drop = x.unsigned_abs().bit_len().saturating_sub(60);
            let top = i64::try_from(x >> drop).expect("60 bits") as f64;
            (top, i32::try_from(drop).expect("short enough"))
        };
        let ((n, n_exponent), (d, d_exponent)) = (leading(&self.numerator), leading(&self.denominator));
        let exponent = n_exponent - d_exponent;
        let step = |e: i32| 2f64.powi(e.clamp(-1000, 1000));
        let x = n / d * step(exponent / 2) * step(exponent - exponent / 2);
        x.min(f64::MAX)
    }
}

/// Between a finite x >= 0 and the next larger f64, or 2^1024.
fn middle(x: f64) -> Ratio {
    let next =
        if x == f64::MAX { Ratio::from(2f64.powi(1023)) + Ratio::from(2f64.powi(1023)) } else { x.next_up().into() };
    (Ratio::from(x) + next) * Ratio::from(0.5)
}

impl From<f64> for Ratio {
    fn from(x: f64) -> Self {
        let unit = if x == 0.0 { 0 } else { lowest_bit(x) };
        Self { numerator: integer(x, unit), denominator: IBig::ONE }.times_power_of_two(unit)
    }
}

impl Add for Ratio {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let numerator = self.numerator * &other.denominator + other.numerator * &self.denominator;
        Self::new(numerator, self.denominator * other.denominator)
    }
}

impl Sub for Ratio {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { numerator: -other.numerator, ..other }
    }
}

impl Mul for Ratio {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.numerator * other.numerator, self.denominator * other.denominator)
    }
}

impl Div for Ratio {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::new(self.numerator * other.denominator, self.denominator * other.numerator)
    }
}

/// A ray and a primitive in integers: positions as multiples of 2^unit, seen from the origin; the direction of another.
struct Exact {
    offsets: Vec<V>,
    direction: V,
    radius: IBig,
    /// Of positions over that of the direction: parameters are multiples of this power of two.
    unit: i64,
}

impl Exact {
    fn new(ray: &Ray, vertices: &[[f64; 3]]) -> Self {
        let (origin, direction): ([f64; 3], [f64; 3]) = (ray.origin().coords.into(), ray.direction().into());
        let lowest = |x: &mut dyn Iterator<Item = &f64>| x.map(|x| lowest_bit(*x)).min().expect("some");
        let unit = lowest(&mut vertices.as_flattened().iter().chain(&origin).chain([&ray.radius()]));
        let direction_unit = lowest(&mut direction.iter());
        let exact = |p: [f64; 3]| p.map(|x| integer(x, unit));
        Self {
            offsets: vertices.iter().map(|v| sub(&exact(*v), &exact(origin))).collect(),
            direction: direction.map(|x| integer(x, direction_unit)),
            radius: integer(ray.radius(), unit),
            unit: unit - direction_unit,
        }
    }

    /// The part of the primitive that is on the line, as weights: corners of a polygon in the triangle of all weights.
    fn common(&self) -> Vec<V> {
        let aside: Vec<V> = self.offsets.iter().map(|v| cross(v, &self.direction)).collect();
        let corner = |i: usize| std::array::from_fn(|k| IBig::from(u8::from(i == k)));
        let mut polygon: Vec<V> = (0..self.offsets.len()).map(corner).collect();
        let rest = self.direction.iter().position(|x| *x != IBig::ZERO).expect("a direction");
        for k in (0..3).filter(|k| *k != rest) {
            for sign in [1, -1] {
                if polygon.is_empty() {
                    return polygon;
                }
                polygon = clip(&polygon, |w| aside.iter().zip(w).map(|(a, w)| &a[k] * w).sum::<IBig>() * sign);
            }
        }
        polygon
    }

    /// The part of a segment or a point that is nearest to the line, if that is within the radius.
    fn nearest(&self) -> Vec<V> {
        let aside: Vec<V> = self.offsets.iter().map(|v| cross(v, &self.direction)).collect();
        let (zero, first, last) = (IBig::ZERO, &aside[0], &aside[aside.len() - 1]);
        // |first + s change| is least at s = - first . change / change^2.
        let change = sub(last, first);
        let square = dot(&change, &change);
        let parts: Vec<V> = if square == zero {
            let ends = [[IBig::ONE, zero.clone(), zero.clone()], [zero.clone(), IBig::ONE, zero.clone()]];
            ends.into_iter().take(aside.len()).collect()
        } else {
            let part = (-dot(first, &change)).clamp(zero.clone(), square.clone());
            vec![[&square - &part, part, zero]]
        };
        let reach = &self.radius * &self.radius * dot(&self.direction, &self.direction);
        let within = |w: &V| {
            let all = &w[0] + &w[1];
            let far: V = std::array::from_fn(|k| &first[k] * &w[0] + &last[k] * &w[1]);
            dot(&far, &far) <= &reach * &all * &all
        };
        parts.into_iter().filter(within).collect()
    }

    fn place(&self, weights: &V) -> Place {
        let all = weights.iter().sum::<IBig>();
        let along: IBig = self.offsets.iter().zip(weights).map(|(v, w)| dot(v, &self.direction) * w).sum();
        let parameter = Ratio::new(along, dot(&self.direction, &self.direction) * &all).times_power_of_two(self.unit);
        Place { parameter, weights: weights.each_ref().map(|w| Ratio::new(w.clone(), all.clone())) }
    }
}

/// The part of a convex polygon on which `height`, which is linear, is not negative.
fn clip(polygon: &[V], height: impl Fn(&V) -> IBig) -> Vec<V> {
    let heights: Vec<IBig> = polygon.iter().map(height).collect();
    let mut rest = Vec::new();
    for (i, p) in polygon.iter().enumerate() {
        let j = (i + 1) % polygon.len();
        let (here, there) = (&heights[i], &heights[j]);
        if *here >= IBig::ZERO {
            rest.push(p.clone());
        }
        if *here > IBig::ZERO && *there < IBig::ZERO {
            rest.push(std::array::from_fn(|k| &polygon[j][k] * here - &p[k] * there));
        }
        if *here < IBig::ZERO && *there > IBig::ZERO {
            rest.push(std::array::from_fn(|k| &p[k] * there - &polygon[j][k] * here));
        }
    }
    rest
}

fn determinant([a, b, c]: [&V; 3]) -> IBig {
    let even = &a[0] * &b[1] * &c[2] + &a[1] * &b[2] * &c[0] + &a[2] * &b[0] * &c[1];
    let odd = &a[0] * &b[2] * &c[1] + &a[1] * &b[0] * &c[2] + &a[2] * &b[1] * &c[0];
    even - odd
}

/// The point of the line of a ray that is nearest to a position, rounded.
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

/// A point of a primitive on a line.
#[derive(Clone, Debug)]
struct Place {
    parameter: Ratio,
    weights: [Ratio; 3],
}

/// Where a whole line meets a primitive.
#[derive(Clone, Debug)]
pub struct Meeting {
    /// The ends of the stretch, or twice the same.
    ends: [Place; 2],
    parameters: [f64; 2],
    side: Side,
    /// Whether its weights are the only ones of a point: the vertices are no more than a segment or a point otherwise.
    unique: bool,
    vertices: Vec<[f64; 3]>,
}

/// How well weights are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Known {
    /// Each rounded to nearest.
    Rounded,
    /// Within 4 u.
    Near,
    /// Any that give the point.
    Any,
}

/// What a hit has to be.
#[derive(Clone, Debug)]
pub struct Expected<'a> {
    /// The parameter, to the last bit.
    pub parameter: f64,
    /// From where.
    pub side: Side,
    weights: [Ratio; 3],
    known: Known,
    vertices: &'a [[f64; 3]],
}

impl Meeting {
    /// Where the whole line of a ray meets a primitive of one to three vertices; segments and points within its radius.
    #[must_use]
    pub fn new(ray: &Ray, vertices: &[[f64; 3]]) -> Option<Self> {
        let exact = Exact::new(ray, vertices);
        let parts = if vertices.len() < 3 && ray.radius() > 0.0 { exact.nearest() } else { exact.common() };
        let mut places: Vec<Place> = parts.iter().map(|w| exact.place(w)).collect();
        places.sort_by(|a, b| a.parameter.compare(&b.parameter));
        let ends = [places.first()?.clone(), places.last()?.clone()];
        let o = &exact.offsets;
        let (side, unique) = match vertices.len() {
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
        Some(Self { ends, parameters, side, unique, vertices: vertices.to_vec() })
    }

    /// The least and the largest parameter, rounded.
    #[must_use]
    pub fn parameters(&self) -> [f64; 2] {
        self.parameters
    }

    /// The hit of a range.
    #[must_use]
    pub fn in_range(&self, [min, max]: [f64; 2]) -> Option<Expected<'_>> {
        let [first, last] = self.parameters;
        if first > max || last < min {
            return None;
        }
        let known = if self.unique { Known::Rounded } else { Known::Any };
        let expected = |parameter: f64, weights, known| Expected {
            parameter: parameter + 0.0,
            side: self.side,
            weights,
            known,
            vertices: &self.vertices,
        };
        let [from, to] = &self.ends;
        if first >= min {
            return Some(expected(first, from.weights.clone(), known));
        }
        // The range begins inside: how far along, from 0 to 1?
        let [zero, one] = [0.0, 1.0].map(Ratio::from);
        let share = if min.is_finite() {
            let length = to.parameter.clone() - from.parameter.clone();
            let share = (Ratio::from(min) - from.parameter.clone()) / length;
            if share.is_below(&zero) {
                zero
            } else if one.is_below(&share) {
                one.clone()
            } else {
                share
            }
        } else {
            one.clone()
        };
        let rest = one - share.clone();
        let weights =
            std::array::from_fn(|k| from.weights[k].clone() * rest.clone() + to.weights[k].clone() * share.clone());
        Some(expected(min, weights, if self.unique { Known::Near } else { Known::Any }))
    }
}

/// u of f64.
const U: f64 = f64::EPSILON / 2.0;

impl Expected<'_> {
    /// What is wrong with a hit.
    ///
    /// # Errors
    /// A word about it.
    pub fn check(&self, hit: &Hit) -> Result<(), String> {
        if hit.parameter.to_bits() != self.parameter.to_bits() {
            return Err(format!("parameter {:e}, not {:e}", hit.parameter, self.parameter));
        }
        if hit.side != self.side {
            return Err(format!("side {:?}, not {:?}", hit.side, self.side));
        }
        for (k, (found, exact)) in hit.barycentric().iter().zip(&self.weights).enumerate() {
            let right = match self.known {
                _ if k >= self.vertices.len() => found.to_bits() == 0,
                Known::Rounded => found.to_bits() == exact.round().to_bits(),
                Known::Near => {
                    *found >= 0.0 && !Ratio::from(4.0 * U).is_below(&(Ratio::from(*found) - exact.clone()).abs())
                }
                Known::Any => (0.0..=1.0).contains(found),
            };
            if !right {
                return Err(format!("weight {k} is {found:e}, not {:e} ({:?})", exact.round(), self.known));
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
            // Four roundings of the sum, three of the weights, and underflow; more where weights are known less well.
            let factor = if self.known == Known::Rounded { 8.0 } else { 16.0 };
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

/// From which side the line of a ray crosses a triangle, and at which parameter of its plane, once it is moved by e
/// along x, by e^2 along y and by e^3 along z. The number e is one: so small that no smaller one decides otherwise.
#[must_use]
pub fn crossing(ray: &Ray, vertices: &[[f64; 3]]) -> Option<(Side, f64)> {
    if vertices.len() < 3 {
        return None;
    }
    let Exact { offsets: o, direction, unit, .. } = Exact::new(&ray.with_radius(0.0).expect("zero"), vertices);
    // A + u E + v F = O + t D, where O is zero; for O moved, the right side is scaled to integers.
    let (e, f) = (sub(&o[1], &o[0]), sub(&o[2], &o[0]));
    let back: V = direction.each_ref().map(|x| -x);
    let all = determinant([&e, &f, &back]);
    if all == IBig::ZERO {
        return None;
    }
    let side = if all > IBig::ZERO { Side::Front } else { Side::Back };
    let right: V = o[0].each_ref().map(|x| -x);
    let turn = if all > IBig::ZERO { IBig::ONE } else { -IBig::ONE };
    // u, v and 1 - u - v, times something above zero, for a right side that is scaled by 2^scale.
    let weights = |right: &V, scale: usize| {
        let (u, v) = (determinant([right, &f, &back]) * &turn, determinant([&e, right, &back]) * &turn);
        let rest = ((&all * &turn) << scale) - &u - &v;
        [u, v, rest]
    };
    let zero = IBig::ZERO;
    let mut inside = weights(&right, 0);
    // Only on an edge or a vertex does it matter that the line moves.
    if inside.iter().all(|x| *x >= zero) && inside.contains(&zero) {
        // Determinants are below 2^(3 bits + 5), and zero or at least 1: beside them 2^-(3 bits + 8) is nothing.
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

    /// Parameters of the stretch and weights of its beginning.
    fn meeting(origin: [f64; 3], direction: [f64; 3], vertices: &[[f64; 3]]) -> Option<([f64; 2], [f64; 3], Side)> {
        let meeting = Meeting::new(&ray(origin, direction), vertices)?;
        let weights = meeting.ends[0].weights.each_ref().map(Ratio::round);
        Some((meeting.parameters(), weights, meeting.side))
    }

    #[test]
    fn lines_meet_a_triangle_in_closed_forms() {
        let down = [0.0, 0.0, -2.0];
        assert_eq!(meeting([1.0, 1.0, 3.0], down, &T), Some(([1.5; 2], [0.5, 0.25, 0.25], Side::Front)));
        assert_eq!(meeting([1.0, 1.0, -3.0], down, &T), Some(([-1.5; 2], [0.5, 0.25, 0.25], Side::Front)));
        assert_eq!(meeting([1.0, 1.0, -3.0], [0.0, 0.0, 1.0], &T), Some(([3.0; 2], [0.5, 0.25, 0.25], Side::Back)));
        assert_eq!(meeting([2.0, 2.0, 3.0], down, &T), Some(([1.5; 2], [0.0, 0.5, 0.5], Side::Front)));
        assert_eq!(meeting([2.0, 2f64.next_up(), 3.0], down, &T), None);
        assert_eq!(meeting([0.0, 4.0, 3.0], down, &T), Some(([1.5; 2], [0.0, 0.0, 1.0], Side::Front)));
        // In the plane: across, along an edge, touching a vertex, beside.
        let across = [1.0, 0.0, 0.0];
        assert_eq!(meeting([-1.0, 1.0, 0.0], across, &T), Some(([1.0, 4.0], [0.75, 0.0, 0.25], Side::Along)));
        assert_eq!(meeting([9.0, 0.0, 0.0], across, &T), Some(([-9.0, -5.0], [1.0, 0.0, 0.0], Side::Along)));
        assert_eq!(meeting([9.0, 4.0, 0.0], across, &T), Some(([-9.0; 2], [0.0, 0.0, 1.0], Side::Along)));
        assert_eq!(meeting([9.0, 5.0, 0.0], across, &T), None);
        assert_eq!(meeting([9.0, 4.0, 1e-300], across, &T), None);
    }

    #[test]
    fn ranges_take_the_least_parameter_of_a_stretch() {
        let line = ray([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        let meeting = Meeting::new(&line, &T).expect("met");
        let at = |min, max| meeting.in_range([min, max]).map(|e| (e.parameter, e.weights.each_ref().map(Ratio::round)));
        assert_eq!(at(0.0, 9.0), Some((1.0, [0.75, 0.0, 0.25])));
        assert_eq!(at(0.0, 1.0), Some((1.0, [0.75, 0.0, 0.25])));
        assert_eq!(at(2.5, 2.5), Some((2.5, [0.375, 0.375, 0.25])));
        assert_eq!(at(4.0, 9.0), Some((4.0, [0.0, 0.75, 0.25])));
        assert_eq!(at(0.0, 1f64.next_down()), None);
        assert_eq!(at(4f64.next_up(), 9.0), None);
    }

    #[test]
    fn segments_are_met_where_the_line_is_nearest() {
        let segment = [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0]];
        let near = |origin: [f64; 3], direction: [f64; 3], radius| {
            let meeting = Meeting::new(&ray(origin, direction).with_radius(radius).expect("valid"), &segment)?;
            Some((meeting.parameters(), meeting.ends[0].weights.each_ref().map(Ratio::round)))
        };
        let x = [2.0, 0.0, 0.0];
        assert_eq!(near([-4.0, 3.0, 1.0], x, 3.0), Some(([2.0; 2], [0.75, 0.25, 0.0])));
        assert_eq!(near([-4.0, 3f64.next_up(), 1.0], x, 3.0), None);
        assert_eq!(near([-4.0, 3.0, 8.0], x, 5.0), Some(([2.0; 2], [0.0, 1.0, 0.0])));
        assert_eq!(near([-4.0, 3.0, 8.0], x, 5f64.next_down()), None);
        assert_eq!(near([3.0, 4.0, 9.0], [0.0, 0.0, -1.0], 5.0), Some(([5.0, 9.0], [0.0, 1.0, 0.0])));
        assert_eq!(near([3.0, 4.0, 9.0], [0.0, 0.0, -1.0], 4.999), None);
        // Without a radius, the way of triangles says the same.
        let mut rng = crate::rng("nearest of radius 0", 0);
        let mut met = 0;
        for _ in 0..2000 {
            use rand::RngExt;
            let mut lattice = || std::array::from_fn(|_| f64::from(rng.random_range(-2..=2)));
            let (vertices, origin, direction) = ([lattice(), lattice()], lattice(), lattice());
            if direction == [0.0; 3] {
                continue;
            }
            let exact = Exact::new(&ray(origin, direction), &vertices);
            let ends = |parts: Vec<V>| {
                let mut all: Vec<f64> = parts.iter().map(|w| exact.place(w).parameter.round()).collect();
                all.sort_by(f64::total_cmp);
                all.first().copied().zip(all.last().copied())
            };
            let (common, nearest) = (ends(exact.common()), ends(exact.nearest()));
            assert_eq!(common, nearest, "{vertices:?} {origin:?} {direction:?}");
            met += usize::from(common.is_some());
        }
        assert!(met > 100, "{met}");
    }

    #[test]
    fn lines_on_edges_cross_beside_them() {
        let cross = |x: f64, y: f64, vertices: [[f64; 3]; 3]| {
            crossing(&ray([x, y, 3.0], [0.0, 0.0, -2.0]), &vertices).map(|(side, t)| (side == Side::Front, t))
        };
        let turned = [T[0], T[2], T[1]];
        assert_eq!(cross(1.0, 1.0, T), Some((true, 1.5)));
        assert_eq!(cross(1.0, 1.0, turned), Some((false, 1.5)));
        // Moved to larger x and y: off the long side, onto the others.
        assert_eq!(cross(2.0, 2.0, T), None);
        assert_eq!(cross(2.0, 0.0, T), Some((true, 1.5)));
        assert_eq!(cross(0.0, 2.0, turned), Some((false, 1.5)));
        assert_eq!(cross(0.0, 0.0, T), Some((true, 1.5)));
        assert_eq!(cross(4.0, 0.0, T), None);
        // x goes before y: past a corner whose inside is to the left, and into one whose inside lies along x.
        assert_eq!(cross(0.0, 4.0, T), None);
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]), None);
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0]]), Some((true, 1.5)));
        assert_eq!(cross(0.0, 0.0, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), None, "along the plane");
    }

    #[test]
    fn fractions_round_as_the_processor_does() {
        let round = |n: f64, d: f64| (Ratio::from(n) / Ratio::from(d)).round();
        for case in crate::cases(20_000, 5_000) {
            use rand::RngExt;
            let (i, mut rng) = (case as usize, crate::rng("fractions", case));
            // Of few bits, so that ties are common, or of many; of all magnitudes.
            let bits = [3, 53][i % 2];
            let mut number = || {
                let mantissa = (rng.random::<u64>() >> (64 - bits)) as f64 + 1.0;
                let e: i32 = rng.random_range(-540..480);
                mantissa * 2f64.powi(e)
            };
            let (n, d) = (number(), number());
            assert_eq!(round(n, d).to_bits(), (n / d).to_bits(), "{n:e} / {d:e}");
            assert_eq!(round(-n, d).to_bits(), (-n / d + 0.0).to_bits(), "-{n:e} / {d:e}");
            let (sum, exact) = (Ratio::from(n) + Ratio::from(d), n + d);
            assert_eq!(sum.round().to_bits(), exact.to_bits(), "{n:e} + {d:e}");
        }
        let tiny = f64::from_bits(1);
        assert_eq!(round(tiny, 2.0), 0.0);
        assert_eq!(round(3.0 * tiny, 2.0), 2.0 * tiny);
        assert_eq!(round(f64::MAX, 0.5), f64::INFINITY);
        assert_eq!((Ratio::from(f64::MAX) + Ratio::from(2f64.powi(969))).round(), f64::MAX);
        assert_eq!((Ratio::from(f64::MAX) + Ratio::from(2f64.powi(970))).round(), f64::INFINITY);
        assert_eq!(round(-tiny, 4.0).to_bits(), 0);
    }
}
