//! Intersections of rays and primitives in big integers, for cases that f64 cannot decide.
//!
//! All positions are relative to the origin of the ray. A, B and C are the vertices and D is the direction. Positions
//! are multiples of one power of two, the direction is a multiple of another one, and parameters are multiples of their
//! quotient.

use super::line::Ray;
use crate::exact::{Fraction, Vector, common_exponent, cross, cross_component, difference, dot, integer, sign};
use crate::kernel::vector::V3;
use dashu_int::IBig;
use std::cmp::Ordering;

/// A ray and the vertices of a primitive, as integers.
pub(super) struct Exact {
    vertices: Vec<Vector>,
    direction: Vector,
    /// The exponent of two that is the unit of positions.
    unit: i32,
    /// The exponent of two that is the unit of the direction.
    direction_unit: i32,
    radius: IBig,
}

/// The point of a primitive at the parameter of a hit, as weights of its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineHit {
    pub(super) parameter: f64,
    pub(super) weights: V3,
}

/// The part of a line that is nearest to a segment, or inside of a triangle whose plane contains the line. It is one
/// point or an interval of parameters. Each end has its parameter and the weights of the vertices.
struct Span {
    ends: [(Fraction, V3); 2],
}

/// Returns the projection of `point` onto the line of a ray, and the coordinate of the projection along `axis`,
/// measured from the origin of the ray in the sense of the direction. `axis` is the axis of the direction's largest
/// component. Each number is rounded once.
pub fn project_onto_ray(ray: &Ray, point: &V3, axis: usize) -> (V3, f64) {
    let unit = common_exponent(ray.origin.iter().chain(point));
    let direction_unit = common_exponent(&ray.direction);
    let d = ray.direction.map(|x| integer(x, direction_unit));
    let (square, along) = (dot(&d, &d), dot(&d, &difference(*point, ray.origin, unit)));
    let over = |numerator: IBig| Fraction { numerator, denominator: square.clone() }.round(unit);
    let coordinate = |k: usize| over(integer(ray.origin[k], unit) * &square + &along * &d[k]);
    let ahead = if ray.direction[axis] < 0.0 { -&d[axis] } else { d[axis].clone() };
    ([coordinate(0), coordinate(1), coordinate(2)], over(along * ahead))
}

impl Exact {
    pub(super) fn new(origin: &V3, direction: &V3, radius: f64, vertices: &[V3]) -> Self {
        let unit = common_exponent(vertices.as_flattened().iter().chain(origin).chain([&radius]));
        let direction_unit = common_exponent(direction);
        Self {
            vertices: vertices.iter().map(|v| difference(*v, *origin, unit)).collect(),
            direction: direction.map(|x| integer(x, direction_unit)),
            unit,
            direction_unit,
            radius: integer(radius, unit),
        }
    }

    /// Returns the sign of D . (V_i x V_j), which is the side on which the line passes the edge from i to j.
    pub(super) fn side(&self, i: usize, j: usize) -> Ordering {
        sign(&self.moment(i, j))
    }

    fn moment(&self, i: usize, j: usize) -> IBig {
        dot(&self.direction, &cross(&self.vertices[i], &self.vertices[j]))
    }

    /// Returns the side of an edge after a symbolic perturbation of the line: a move by an infinitely small amount
    /// along x, by an infinitely smaller one along y and by a still smaller one along z. A move by w changes the moment
    /// by -w . ((V_j - V_i) x D). The result is `Equal` only for an edge along the line.
    pub(super) fn perturbed_side(&self, i: usize, j: usize) -> Ordering {
        let edge: Vector = std::array::from_fn(|k| &self.vertices[j][k] - &self.vertices[i][k]);
        let change = |k| sign(&cross_component(&edge, &self.direction, k)).reverse();
        (0..3).map(change).fold(self.side(i, j), Ordering::then)
    }

    /// Returns the parameter of the plane of a triangle that is not parallel to the line, and the weights of the
    /// vertices there. All numbers are rounded to nearest.
    pub(super) fn face(&self) -> (f64, V3) {
        let moments = [self.moment(1, 2), self.moment(2, 0), self.moment(0, 1)];
        let height = dot(&self.vertices[0], &cross(&self.vertices[1], &self.vertices[2]));
        let sum = &moments[0] + &moments[1] + &moments[2];
        let (sum, orientation) = if sign(&sum) == Ordering::Less { (-sum, -IBig::ONE) } else { (sum, IBig::ONE) };
        let over = |x: IBig| Fraction { numerator: x * &orientation, denominator: sum.clone() };
        let parameter = over(height).round(self.parameter_unit());
        (parameter, moments.map(|m| over(m).round(0)))
    }

    /// Returns the hit on a triangle whose plane contains the line, or on a triangle without area.
    pub(super) fn coplanar(&self, ray: &Ray) -> Option<LineHit> {
        let mut all: Option<Span> = None;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let Some(Span { ends: [from, to] }) = self.span(i, j, &IBig::ZERO) else { continue };
            all = Some(match all {
                None => Span { ends: [from, to] },
                Some(Span { ends: [first, last] }) => Span {
                    ends: [
                        if from.0.compare(&first.0) == Ordering::Less { from } else { first },
                        if to.0.compare(&last.0) == Ordering::Greater { to } else { last },
                    ],
                },
            });
        }
        self.in_range(ray, &all?)
    }

    /// Returns the hit on a segment or a point, if it is within the radius: the parameter at which the line is nearest
    /// to it.
    pub(super) fn segment(&self, ray: &Ray) -> Option<LineHit> {
        self.in_range(ray, &self.span(0, self.vertices.len() - 1, &self.radius)?)
    }

    fn parameter_unit(&self) -> i32 {
        self.unit - self.direction_unit
    }

    /// Returns the first parameter of a span that is within the range of the ray.
    fn in_range(&self, ray: &Ray, span: &Span) -> Option<LineHit> {
        let [(first, first_weights), (last, last_weights)] = &span.ends;
        let [t, end] = [first, last].map(|t| t.round(self.parameter_unit()));
        if t > ray.max || end < ray.min {
            return None;
        }
        if t >= ray.min {
            return Some(LineHit { parameter: t, weights: *first_weights });
        }
        // The range of the ray begins inside the span.
        let fraction = self.fraction_between(ray.min, first, last);
        let weights = std::array::from_fn(|k| first_weights[k] * (1.0 - fraction) + last_weights[k] * fraction);
        Some(LineHit { parameter: ray.min, weights })
    }

    /// Returns the position of `begin` between two parameters, from 0 to 1.
    fn fraction_between(&self, begin: f64, first: &Fraction, last: &Fraction) -> f64 {
        if begin.is_infinite() {
            return 1.0;
        }
        let unit = self.parameter_unit();
        let finer = common_exponent([&begin]).min(unit);
        let begin = integer(begin, finer);
        let lift = |t: &Fraction| (&t.numerator << (unit - finer).unsigned_abs() as usize, t.denominator.clone());
        let ((n1, d1), (n2, d2)) = (lift(first), lift(last));
        // The position is (begin - n1 / d1) / (n2 / d2 - n1 / d1).
        let fraction = Fraction { numerator: (begin * &d1 - &n1) * &d2, denominator: n2 * d1 - n1 * d2 };
        fraction.round(0).clamp(0.0, 1.0)
    }

    /// Returns the span in which the line is nearest to the segment from vertex i to vertex j, if the segment is within
    /// `radius`.
    ///
    /// A point of the segment is P = A + s E. Its squared distance from the line is |P|^2 - (P . D)^2 / D^2; with
    /// a = D . D, b = D . E, c = E . E it is least at s = ((A . D) b - a (A . E)) / (a c - b^2).
    fn span(&self, i: usize, j: usize, radius: &IBig) -> Option<Span> {
        let (from, to, d) = (&self.vertices[i], &self.vertices[j], &self.direction);
        let edge: Vector = std::array::from_fn(|k| &to[k] - &from[k]);
        let [a, b, c] = [dot(d, d), dot(d, &edge), dot(&edge, &edge)];
        let along = dot(from, d);
        let determinant = &a * &c - &b * &b;
        let parallel = sign(&determinant) == Ordering::Equal;
        // The position on the segment is s = n / q, clamped to its ends.
        let (n, q) = if parallel {
            (IBig::ZERO, IBig::ONE)
        } else {
            let n = &along * &b - &a * dot(from, &edge);
            (n.max(IBig::ZERO).min(determinant.clone()), determinant)
        };
        // The point P of the segment, times q.
        let point: Vector = std::array::from_fn(|k| &from[k] * &q + &edge[k] * &n);
        let ahead = dot(&point, d);
        let limit = radius * &q;
        if &a * dot(&point, &point) - &ahead * &ahead > &limit * &limit * &a {
            return None;
        }
        let weights = |n: IBig, q: &IBig| {
            let rest = Fraction { numerator: q - &n, denominator: q.clone() };
            let mut weights = [0.0; 3];
            weights[i] = rest.round(0);
            weights[j] += Fraction { numerator: n, denominator: q.clone() }.round(0);
            weights
        };
        let first = (Fraction { numerator: ahead, denominator: &a * &q }, weights(n, &q));
        if !parallel {
            return Some(Span { ends: [first.clone(), first] });
        }
        let last = (Fraction { numerator: along + &b, denominator: a }, weights(IBig::ONE, &IBig::ONE));
        Some(Span { ends: if sign(&b) == Ordering::Less { [last, first] } else { [first, last] } })
    }
}
