//! Winding numbers of all points of a ball, by a polynomial.
//!
//! Off its edges, the solid angle of a triangle is smooth; where a path crosses the triangle, it is continued smoothly
//! from one side to the other. In a ball that no edge of the triangle meets, the continuation from the centre is one
//! function, because its gradient is the integral over the edges (the law of Biot and Savart). So it does not depend on
//! the path.
//!
//! [`Local`] is the sum of the polynomials of degree 1 of all nodes and triangles of a tree in the centre, with a bound
//! on the error (proved, docs/proofs/fields.md). A node has a polynomial where its box does not meet the ball, and a
//! triangle where its edges do not. While the bound is too large, the part with the largest error is replaced by its
//! children: a node by two nodes or by its triangles, and a triangle by nothing, so that it is evaluated at each point.

use super::solid_angles::{Estimate, HalfAngle, Node, Queue, SolidAngles};
use super::solid_angles::{INFLATION, MAX_RELATIVE_COORDINATE, centroid, normal};
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, add_scaled, dot, length, scaled, sub};
use std::f64::consts::PI;

/// A sum of solid angles over 4 pi, as a function of a point in a ball.
pub(super) struct Local {
    /// The centre and the radius, multiplied by the scale of the tree.
    centre: V3,
    radius: f64,
    polynomial: Polynomial,
    /// A bound on the error of the polynomial in the ball.
    pub(super) error: f64,
    /// The triangles that are not in the polynomial.
    pub(super) near: Vec<u32>,
    /// The terms of the polynomial.
    queue: Queue<Part>,
}

/// A polynomial of degree 1.
#[derive(Clone, Copy)]
struct Polynomial {
    /// The value in the centre.
    value: f64,
    /// The gradient times the radius of the ball.
    slope: V3,
}

/// A term of the sum that may be replaced.
#[derive(Clone, Copy)]
struct Part {
    polynomial: Polynomial,
    error: f64,
    number: u32,
    is_triangle: bool,
}

const ZERO: Polynomial = Polynomial { value: 0.0, slope: [0.0; 3] };
/// The largest length of an edge, in units of its distance from the ball, of a triangle that has a polynomial by its
/// solid angle. Longer edges lose too many digits (see [`POLYNOMIAL_ROUNDING`]).
const MAX_EDGE: f64 = 1e3;
/// The error below which the dipole of a triangle is not replaced by a polynomial by its solid angle.
///
/// No record exists of how this and the next constant were chosen. They decide the time, and not the bound on the
/// error.
const SMALL_ERROR: f64 = 1e-4;
/// The largest error of the polynomial of a triangle. A triangle with a larger one is evaluated at each point.
const MAX_ERROR: f64 = 0.25;
/// The bound on the rounding error of a polynomial. Values are solid angles over 4 pi, so it needs no scale.
///
/// The largest error comes from the gradient of a long edge, which divides by |a| |b| + a . b. For an edge of the
/// length l at the distance d, cancellation leaves about 8 (d / l)^2 of |a| |b| there. With l < 1000 d ([`MAX_EDGE`]),
/// the relative error is about 10^5 times a few u = 2^-53, which is below 1e-9 (docs/proofs/fields.md, "Balls").
const POLYNOMIAL_ROUNDING: f64 = 1e-9;

impl SolidAngles {
    /// Returns the sum in a ball. It is `None` far away from the triangles.
    pub(super) fn local(&self, centre: V3, radius: f64) -> Option<Local> {
        if centre.iter().any(|x| x.abs() > MAX_RELATIVE_COORDINATE) {
            return None;
        }
        let (radius, queue) = (radius * self.scale * INFLATION, Queue::new(self.unit));
        let mut local = Local { centre, radius, polynomial: ZERO, error: 0.0, near: Vec::new(), queue };
        if !self.nodes.is_empty() {
            local.push(self.node_part(0, &local));
        }
        Some(local)
    }

    /// Refines a sum until `is_enough` returns `true` or no part is left to refine.
    pub(super) fn refine(&self, local: &mut Local, is_enough: impl Fn(&Local) -> bool) {
        while !is_enough(local) {
            let Some(part) = local.pop() else { break };
            let node = &self.nodes[if part.is_triangle { 0 } else { part.number as usize }];
            if part.is_triangle {
                local.near.push(part.number);
            } else if node.children == 0 {
                for triangle in node.triangles.clone() {
                    local.push(self.triangle_part(triangle, local));
                }
            } else {
                for child in [node.children, node.children + 1] {
                    local.push(self.node_part(child, local));
                }
            }
        }
    }

    fn node_part(&self, number: u32, local: &Local) -> Part {
        let node = &self.nodes[number as usize];
        let count = f64::from(node.triangles.end - node.triangles.start);
        let (polynomial, error) = local.dipole(node);
        self.part(Part { polynomial, error, number, is_triangle: false }, count)
    }

    fn triangle_part(&self, number: u32, local: &Local) -> Part {
        let (polynomial, error) = local.triangle(&self.triangles[number as usize]);
        self.part(Part { polynomial, error, number, is_triangle: true }, 1.0)
    }

    /// Rounds a part of `count` triangles to multiples of the unit, so that sums are exact, and its error upwards.
    fn part(&self, part: Part, count: f64) -> Part {
        let Polynomial { value, slope } = part.polynomial;
        let is_small = |x: f64| x.abs() <= count;
        // No continued solid angle exceeds 4 pi. The comparisons are false for NaN.
        if part.error < count && is_small(value) && slope.into_iter().all(is_small) {
            let Estimate { value, error } = self.rounded(Estimate { value, error: part.error + POLYNOMIAL_ROUNDING });
            let slope = slope.map(|x| self.rounded(Estimate { value: x, error: 0.0 }).value);
            Part { polynomial: Polynomial { value, slope }, error, ..part }
        } else {
            Part { polynomial: ZERO, error: count, ..part }
        }
    }
}

impl Local {
    fn push(&mut self, part: Part) {
        self.add(&part, 1.0);
        self.queue.push(part.error, part);
    }

    fn pop(&mut self) -> Option<Part> {
        let part = self.queue.pop()?;
        self.add(&part, -1.0);
        Some(part)
    }

    fn add(&mut self, part: &Part, factor: f64) {
        self.polynomial.value += factor * part.polynomial.value;
        self.polynomial.slope = add_scaled(self.polynomial.slope, factor, part.polynomial.slope);
        self.error += factor * part.error;
    }

    /// Returns whether the polynomial is the whole sum, because no triangle is near.
    pub(super) fn is_whole(&self) -> bool {
        self.near.is_empty()
    }

    /// Returns the sum at a point of the ball, with the continued solid angles of the triangles that are not near.
    pub(super) fn at(&self, q: V3, near: Estimate) -> Estimate {
        let Polynomial { value, slope } = self.polynomial;
        let value = value + dot(slope, scaled(sub(q, self.centre), 1.0 / self.radius)) + near.value;
        Estimate { value, error: self.error + near.error + POLYNOMIAL_ROUNDING }
    }

    /// Returns the value in the centre, and a bound on how far the sum in the ball is from it.
    pub(super) fn estimate(&self) -> Estimate {
        let change = length(self.polynomial.slope) * INFLATION;
        Estimate { value: self.polynomial.value, error: self.error + change }
    }

    /// Returns the polynomial of the dipole of a node and of its moments, and the bound on its error.
    fn dipole(&self, node: &Node) -> (Polynomial, f64) {
        let reach = node.spread.sqrt() + self.radius * (1.5 * node.area).sqrt();
        let (value, gradient) = node.dipole(self.centre);
        let polynomial = Polynomial { value, slope: scaled(gradient, self.radius) };
        (polynomial, self.dipole_error(reach, node.square_from_box(self.centre).sqrt()))
    }

    /// Returns the bound on the error of a dipole whose triangles are at a distance from the centre.
    fn dipole_error(&self, reach: f64, beyond: f64) -> f64 {
        let rho = beyond * (1.0 / INFLATION) - self.radius;
        if rho > 0.0 { reach * reach * INFLATION / (rho * rho * rho * rho) } else { f64::INFINITY }
    }

    /// Returns the polynomial of a triangle and the bound on its error.
    fn triangle(&self, triangle: &[V3; 3]) -> (Polynomial, f64) {
        let corners = triangle.map(|corner| sub(corner, self.centre));
        let offset = centroid(&corners);
        let square = dot(offset, offset);
        let normal = scaled(normal(&corners), 0.25 / PI);
        let spread = corners.iter().map(|corner| sub(*corner, offset)).map(|o| dot(o, o)).fold(0.0, f64::max);
        // No point of the triangle is farther from its centroid than a corner.
        let (spread, distance) = (spread.sqrt(), square.sqrt());
        let reach = (spread + self.radius) * (3.0 * length(normal)).sqrt();
        let error = self.dipole_error(reach, distance - spread);
        // An error of NaN is not small.
        let is_small = error < SMALL_ERROR;
        let exact = if is_small { None } else { self.exact(triangle, &corners) };
        if let Some(exact) = exact.filter(|exact| error.is_nan() || exact.1 <= error) {
            return exact;
        }
        let (height, cube) = (dot(offset, normal), 1.0 / (square * distance));
        let slope = scaled(sub(scaled(offset, 3.0 * height / square), normal), cube * self.radius);
        (Polynomial { value: cube * height, slope }, error)
    }

    /// Returns the polynomial of a triangle by its solid angle in the centre, and the bound on its error.
    fn exact(&self, triangle: &[V3; 3], corners: &[V3; 3]) -> Option<(Polynomial, f64)> {
        let lengths = corners.map(length);
        let (mut gradient, mut error) = ([0.0; 3], 0.0);
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (a, b) = (corners[i], corners[j]);
            let edge = sub(b, a);
            let square = dot(edge, edge);
            let size = square.sqrt();
            let along = if square > 0.0 { (-dot(a, edge) / square).clamp(0.0, 1.0) } else { 0.0 };
            let rho = length(add_scaled(a, along, edge)) * (1.0 / INFLATION) - self.radius;
            // NaN is not within the bounds.
            if !(rho > 0.0 && size < MAX_EDGE * rho) {
                return None;
            }
            error += size.min(2.0 * rho) / (rho * rho * rho);
            let product = lengths[i] * lengths[j];
            let factor = (lengths[i] + lengths[j]) / (product * (product + dot(a, b)));
            gradient = add_scaled(gradient, factor * (0.25 / PI) * self.radius, cross(a, b));
        }
        let error = error * self.radius * self.radius * (0.25 / PI) * INFLATION;
        // A triangle with a large error would be replaced anyway. The comparison is false for NaN.
        let is_small = error < MAX_ERROR;
        if !is_small {
            return None;
        }
        let angle = HalfAngle::new(triangle, self.centre)?;
        let half = angle.value(triangle, self.centre)?;
        Some((Polynomial { value: half / (2.0 * PI), slope: gradient }, error + angle.error))
    }
}
