//! The exact test whether two primitives intersect.
//!
//! A degenerate triangle is the segment between its outermost vertices, and a segment without length is a point. Two
//! hulls intersect if a vertex of one is on the other, if two edges cross, or if an edge of one pierces the face of the
//! other. Each case is a question of signs of determinants, which the exact predicates answer.

#![allow(clippy::float_cmp, reason = "equal coordinates are what is meant")]

use crate::kernel::arithmetic::cross;
use crate::kernel::double_double::Double;
use crate::kernel::vector::{V3, dot, exponent, largest, lexicographically_less, scale_by_power};
use crate::predicates::{orientation_2d, orientation_3d};
use std::cmp::Ordering;

/// Returns whether two hulls of one to three finite vertices each have a common point. It is exact.
///
/// # Panics
/// Panics if there are no vertices, or more than three.
///
/// # Complexity
/// It takes a few hundred multiplications for two triangles that intersect in their interiors, and more if signs are
/// uncertain in f64.
#[must_use]
pub fn do_intersect(a: &[V3], b: &[V3]) -> bool {
    let (a, b) = (Hull::new(a), Hull::new(b));
    match (a, b) {
        (Hull::Point(p), hull) | (hull, Hull::Point(p)) => hull.contains(p),
        (a, b) => {
            let contains_vertex = |hull: &Hull, other: &Hull| other.vertices().iter().any(|v| hull.contains(*v));
            let crosses = |edge: [V3; 2], hull: &Hull| hull.edges().iter().any(|other| cross_inside(&edge, other));
            let pierces = |from: &Hull, to: &Hull| from.edges().iter().any(|edge| to.is_pierced(edge));
            contains_vertex(&a, &b)
                || contains_vertex(&b, &a)
                || a.edges().iter().any(|edge| crosses(*edge, &b))
                || pierces(&a, &b)
                || pierces(&b, &a)
        }
    }
}

/// Returns the parameter at which an edge meets the plane of a triangle, if its ends are on different sides. It is
/// computed in double-double, which slivers need.
pub(super) fn piercing_parameter([p, q]: &[V3; 2], hull: &[V3]) -> Option<f64> {
    let [a, b, c] = hull else { return None };
    let size = largest(&[*p, *q, *a, *b, *c]);
    if size == 0.0 {
        return None;
    }
    // Products of three differences stay in range at the scale of 1.
    let scaled = |v: &V3| v.map(|x| scale_by_power(x, -exponent(size)));
    let [p, q, a, b, c] = [p, q, a, b, c].map(scaled);
    let from_a = |v: V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(v[k], a[k])) };
    let normal = cross(from_a(b), from_a(c));
    let (at_p, at_q) = (dot(normal, from_a(p)), dot(normal, from_a(q)));
    let t = (at_p / (at_p - at_q)).round();
    (t > 0.0 && t < 1.0).then_some(t)
}

/// The convex hull of some vertices, each of which is an extreme point.
enum Hull {
    Point(V3),
    Segment([V3; 2]),
    /// A triangle, and an axis along which its projection has an area.
    Triangle([V3; 3], usize),
}

impl Hull {
    fn new(vertices: &[V3]) -> Self {
        let segment = |a: V3, b: V3| if a == b { Self::Point(a) } else { Self::Segment([a, b]) };
        match *vertices {
            [a] => Self::Point(a),
            [a, b] => segment(a, b),
            [a, b, c] => match axis_of_area(a, b, c) {
                Some(axis) => Self::Triangle([a, b, c], axis),
                None => {
                    // The first and the last of collinear points in lexicographic order are the outermost.
                    let first = |a: V3, b: V3| if lexicographically_less(b, a) { b } else { a };
                    let last = |a: V3, b: V3| if lexicographically_less(b, a) { a } else { b };
                    segment(first(first(a, b), c), last(last(a, b), c))
                }
            },
            _ => panic!("a primitive has one to three vertices"),
        }
    }

    fn vertices(&self) -> &[V3] {
        match self {
            Self::Point(p) => std::slice::from_ref(p),
            Self::Segment(s) => s,
            Self::Triangle(t, _) => t,
        }
    }

    fn edges(&self) -> Vec<[V3; 2]> {
        match self {
            Self::Point(_) => Vec::new(),
            Self::Segment(edge) => vec![*edge],
            Self::Triangle([a, b, c], _) => vec![[*a, *b], [*b, *c], [*c, *a]],
        }
    }

    fn contains(&self, p: V3) -> bool {
        match self {
            Self::Point(q) => p == *q,
            Self::Segment([a, b]) => {
                let is_between = |a: V3, b: V3| a <= p && p <= b;
                axis_of_area(*a, *b, p).is_none() && (is_between(*a, *b) || is_between(*b, *a))
            }
            Self::Triangle([a, b, c], axis) => {
                let turn = |a: &V3, b: &V3, c: &V3| turn(*a, *b, *c, *axis);
                let outside = turn(a, b, c).reverse();
                orientation_3d(*a, *b, *c, p) == Ordering::Equal
                    && ![turn(a, b, &p), turn(b, c, &p), turn(c, a, &p)].contains(&outside)
            }
        }
    }

    /// Returns whether the ends of an edge are strictly on different sides of the triangle and the edge meets it.
    fn is_pierced(&self, [p, q]: &[V3; 2]) -> bool {
        let Self::Triangle([a, b, c], _) = self else { return false };
        let at_p = orientation_3d(*a, *b, *c, *p);
        if at_p == Ordering::Equal || orientation_3d(*a, *b, *c, *q) != at_p.reverse() {
            return false;
        }
        let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| orientation_3d(*p, *q, *from, *to));
        !(sides.contains(&Ordering::Less) && sides.contains(&Ordering::Greater))
    }
}

/// Returns whether two edges cross in a point that is an end of neither.
fn cross_inside([p, q]: &[V3; 2], [r, s]: &[V3; 2]) -> bool {
    let Some(axis) = axis_of_area(*p, *q, *r) else { return false };
    let are_opposite = |a: Ordering, b: Ordering| a != Ordering::Equal && a == b.reverse();
    let turn = |a: &V3, b: &V3, c: &V3| turn(*a, *b, *c, axis);
    orientation_3d(*p, *q, *r, *s) == Ordering::Equal
        && are_opposite(turn(p, q, r), turn(p, q, s))
        && are_opposite(turn(r, s, p), turn(r, s, q))
}

/// Returns an axis along which the projection of three points has an area; `None` if they are collinear.
fn axis_of_area(a: V3, b: V3, c: V3) -> Option<usize> {
    (0..3).find(|axis| turn(a, b, c, *axis) != Ordering::Equal)
}

/// Returns the orientation of three points that are projected along an axis.
fn turn(a: V3, b: V3, c: V3, axis: usize) -> Ordering {
    let projected = |v: V3| [v[(axis + 1) % 3], v[(axis + 2) % 3]];
    orientation_2d(projected(a), projected(b), projected(c))
}
