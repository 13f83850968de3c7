//! Rays and primitives in integers of any length: what decides where rounding could.
//!
//! Everything is relative to the origin of the ray. A, B, C are the vertices, D is the direction; positions are
//! multiples of one power of two, the direction of another, and parameters of their quotient.

use super::crossing::Found;
use super::line::Ray;
use crate::exact::{Fraction, Vector, common_exponent, cross, cross_component, difference, dot, integer, sign};
use crate::kernel::vector::V3;
use dashu_int::IBig;
use std::cmp::Ordering;

/// A ray and some vertices.
pub(super) struct Exact {
    vertices: Vec<Vector>,
    direction: Vector,
    /// Of positions.
    unit: i32,
    /// Of the direction.
    direction_unit: i32,
    radius: IBig,
}

/// Where a line is nearest to a segment, or meets a triangle that it lies in the plane of: one point or a stretch.
struct Span {
    ends: [(Fraction, V3); 2],
}

/// The point of the line of a ray that is nearest to `point`, and how far from the origin of the ray it lies, measured
/// along `axis`, on which the direction is largest: each rounded once.
pub fn foot(ray: &Ray, point: &V3, axis: usize) -> (V3, f64) {
    let unit = common_exponent(ray.origin.iter().chain(point));
    let direction_unit = common_exponent(&ray.direction);
    let d = ray.direction.map(|x| integer(x, direction_unit));
    let (square, along) = (dot(&d, &d), dot(&d, &difference(*point, ray.origin, unit)));
    let over = |numerator: IBig| Fraction { numerator, denominator: square.clone() }.round(unit);
    let place = |k: usize| over(integer(ray.origin[k], unit) * &square + &along * &d[k]);
    let ahead = if ray.direction[axis] < 0.0 { -&d[axis] } else { d[axis].clone() };
    ([place(0), place(1), place(2)], over(along * ahead))
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

    /// The sign of D . (V_i x V_j): on which side of the line the edge from i to j passes.
    pub(super) fn side(&self, i: usize, j: usize) -> Ordering {
        sign(&self.moment(i, j))
    }

    fn moment(&self, i: usize, j: usize) -> IBig {
        dot(&self.direction, &cross(&self.vertices[i], &self.vertices[j]))
    }

    /// The same for the line that is moved by an infinitely small amount along x, by an infinitely smaller one along y
    /// and by a still smaller one along z. Moved by w, the moment changes by -w . ((V_j - V_i) x D). `Equal` only for an
    /// edge along the line.
    pub(super) fn perturbed_side(&self, i: usize, j: usize) -> Ordering {
        let edge: Vector = std::array::from_fn(|k| &self.vertices[j][k] - &self.vertices[i][k]);
        let change = |k| sign(&cross_component(&edge, &self.direction, k)).reverse();
        (0..3).map(change).fold(self.side(i, j), Ordering::then)
    }

    /// The parameter of the plane of a triangle that the line is not parallel to, and the weights of its vertices there,
    /// all rounded to nearest.
    pub(super) fn face(&self) -> (f64, V3) {
        let moments = [self.moment(1, 2), self.moment(2, 0), self.moment(0, 1)];
        let height = dot(&self.vertices[0], &cross(&self.vertices[1], &self.vertices[2]));
        let sum = &moments[0] + &moments[1] + &moments[2];
        let (sum, turn) = if sign(&sum) == Ordering::Less { (-sum, -IBig::ONE) } else { (sum, IBig::ONE) };
        let over = |x: IBig| Fraction { numerator: x * &turn, denominator: sum.clone() };
        let parameter = over(height).round(self.parameter_unit());
        (parameter, moments.map(|m| over(m).round(0)))
    }

    /// A triangle that the line lies in the plane of, or one that is no more than a segment or a point.
    pub(super) fn flat(&self, ray: &Ray) -> Option<Found> {
        let mut all: Option<Span> = None;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let Some(Span { ends: [from, to] }) = self.span(i, j, &IBig::ZERO) else { continue };
            all = Some(match all {
                None => Span { ends: [from, to] },
                Some(Span { ends: [first, last] }) => Span {
                    ends: [
                        if from.0.cmp(&first.0) == Ordering::Less { from } else { first },
                        if to.0.cmp(&last.0) == Ordering::Greater { to } else { last },
                    ],
                },
            });
        }
        self.in_range(ray, &all?)
    }

    /// A segment, or a point as one of two equal vertices: where the ray is nearest to it, if that is within its radius.
    pub(super) fn wire(&self, ray: &Ray) -> Option<Found> {
        self.in_range(ray, &self.span(0, self.vertices.len() - 1, &self.radius)?)
    }

    fn parameter_unit(&self) -> i32 {
        self.unit - self.direction_unit
    }

    /// The first parameter of a span that is in the range of the ray.
    fn in_range(&self, ray: &Ray, span: &Span) -> Option<Found> {
        let [(first, first_weights), (last, last_weights)] = &span.ends;
        let [t, end] = [first, last].map(|t| t.round(self.parameter_unit()));
        if t > ray.max || end < ray.min {
            return None;
        }
        if t >= ray.min {
            return Some(Found { parameter: t, weights: *first_weights });
        }
        // The range begins inside.
        let share = self.share(ray.min, first, last);
        let weights = std::array::from_fn(|k| first_weights[k] * (1.0 - share) + last_weights[k] * share);
        Some(Found { parameter: ray.min, weights })
    }

    /// How far between two parameters the range begins, from 0 to 1.
    fn share(&self, begin: f64, first: &Fraction, last: &Fraction) -> f64 {
        if begin.is_infinite() {
            return 1.0;
        }
        let unit = self.parameter_unit();
        let own = common_exponent([&begin]).min(unit);
        let begin = integer(begin, own);
        let lift = |t: &Fraction| (&t.numerator << (unit - own).unsigned_abs() as usize, t.denominator.clone());
        let ((n1, d1), (n2, d2)) = (lift(first), lift(last));
        // (begin - n1 / d1) / (n2 / d2 - n1 / d1)
        let share = Fraction { numerator: (begin * &d1 - &n1) * &d2, denominator: n2 * d1 - n1 * d2 };
        share.round(0).clamp(0.0, 1.0)
    }

    /// Where the line is nearest to the segment from vertex i to vertex j, if that is within `radius`.
    ///
    /// A point of the segment is P = A + s E. Its squared distance from the line is |P|^2 - (P . D)^2 / D^2; with
    /// a = D . D, b = D . E, c = E . E it is least at s = ((A . D) b - a (A . E)) / (a c - b^2).
    fn span(&self, i: usize, j: usize, radius: &IBig) -> Option<Span> {
        let (from, to, d) = (&self.vertices[i], &self.vertices[j], &self.direction);
        let edge: Vector = std::array::from_fn(|k| &to[k] - &from[k]);
        let [a, b, c] = [dot(d, d), dot(d, &edge), dot(&edge, &edge)];
        let along = dot(from, d);
        let steep = &a * &c - &b * &b;
        let parallel = sign(&steep) == Ordering::Equal;
        // s = n / q, clamped to the segment.
        let (n, q) = if parallel {
            (IBig::ZERO, IBig::ONE)
        } else {
            let n = &along * &b - &a * dot(from, &edge);
            (n.max(IBig::ZERO).min(steep.clone()), steep)
        };
        // q P
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
