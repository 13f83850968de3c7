//! Proofs that a feature of a primitive holds its point nearest to a query.
//!
//! Everything is relative to the query. A point F of a convex set is nearest to the origin if and only if F . (W - F) is
//! not negative for any point W of the set, for which the vertices stand. With A, B, C for the vertices, D = B - A and
//! the normal N = (B - A) x (C - B) that says
//!
//! - of a vertex A: A . (W - A) >= 0 for the other vertices W;
//! - of an edge from A to B, on which F = A - (A . D / D . D) D, so that F . D = 0: F is on the edge if A . (A - B) >= 0
//!   and B . (B - A) >= 0; and F . (C - F) = F . (C - A) is, times D . D,
//!   (A . (C - A)) (D . D) - (A . D) (D . (C - A)) = (A x D) . ((C - A) x D), which is -N . (A x D);
//! - of a face with N /= 0: the weight of C is N . (A x B) / N . N, and A x B = A x D; likewise those of A and B.
//!
//! So there are two kinds of numbers of which the sign is asked, dot products and *sides* N . (A x D). At zero both
//! neighbouring features hold the nearest point, hence a claim may be proved where the kernel would rather have another.
//!
//! # Errors
//!
//! For vectors with largest components a, d, e and f a dot product is a sum of three products below a d. On the way to
//! the result a product takes 3 operations, and 2 more for the differences in its factors: with relative errors below u
//! each, the error is below 3 a d ((1 + u)^5 - 1) < 15.1 u a d in f64. A side is the sum of twelve products of four below
//! a d e f; each takes 2 operations in either cross product, 3 in their dot product and 4 for the differences: the error
//! is below 12 a d e f ((1 + u)^11 - 1) < 132.1 u a d e f. In double-double differences are exact and operations err by
//! less than 7 u^2 \[Joldes2017\]: below 3 a d ((1 + 7 u^2)^3 - 1) < 63.1 u^2 a d and
//! 12 a d e f ((1 + 7 u^2)^7 - 1) < 588.1 u^2 a d e f. The constants exceed these by a fifth or more, which is more than
//! sizes and bounds are off by their own rounding, and a number by the lower half that is not looked at.
//!
//! Sizes are within 2^-100..2^100, or zero. Products of four are then above 2^-400 and errors above 2^-500; what
//! underflows on the way to a side is below 2^-1070, times at most 2^203 before it arrives: nothing beside that. Nothing
//! overflows. A difference that rounds to zero is zero. So a vector of size zero is exactly zero, and so are its products
//! and their bounds.

use super::{U, ends, exists};
use crate::Feature;
use crate::kernel::arithmetic::{Number, cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger};

/// Sizes of vectors for which no product of six over- or underflows where it matters.
pub(super) const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-100)..=power_of_two(100);

/// In which a sign may be certain.
trait Arithmetic: Number {
    /// Bound on the error of a dot product, in parts of the sizes of its factors.
    const DOT_ERROR: f64;
    /// The same of a side.
    const SIDE_ERROR: f64;
    fn difference(a: f64, b: f64) -> Self;
    /// Within u of it.
    fn leading(self) -> f64;
}

impl Arithmetic for f64 {
    const DOT_ERROR: f64 = 20.0 * U;
    const SIDE_ERROR: f64 = 160.0 * U;
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "one instruction")]
    fn difference(a: f64, b: f64) -> Self {
        a - b
    }
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "no instruction")]
    fn leading(self) -> f64 {
        self
    }
}

impl Arithmetic for Double {
    const DOT_ERROR: f64 = 80.0 * U * U;
    const SIDE_ERROR: f64 = 720.0 * U * U;
    fn difference(a: f64, b: f64) -> Self {
        Self::difference(a, b)
    }
    fn leading(self) -> f64 {
        self.high
    }
}

/// A vector between two points.
struct Way<T> {
    vector: [T; 3],
    /// The largest component.
    size: f64,
}

impl<T: Arithmetic> Way<T> {
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "a few instructions")]
    fn new(from: &V3, to: &V3) -> Self {
        let vector: [T; 3] = std::array::from_fn(|k| T::difference(to[k], from[k]));
        let [x, y, z] = vector.map(|x| x.leading().abs());
        Self { vector, size: larger(larger(x, y), z) }
    }

    /// Whether its dot product with another one is certainly not negative.
    #[inline]
    fn leads_along(&self, other: &Self) -> bool {
        let bound = T::DOT_ERROR * (self.size * other.size);
        // Not for NaN.
        dot(self.vector, other.vector).leading() >= bound && self.is_plain() && other.is_plain()
            || self.is_across(other)
    }

    /// Whether no axis has a component of both, so that the product is exactly zero: above a vertex of boxes and grids.
    fn is_across(&self, other: &Self) -> bool {
        (0..3).all(|k| self.vector[k].leading() == 0.0 || other.vector[k].leading() == 0.0)
    }

    fn is_plain(&self) -> bool {
        self.size == 0.0 || PLAIN.contains(&self.size)
    }
}

/// The normal of a triangle.
struct Normal<T> {
    vector: [T; 3],
    edges: [Way<T>; 2],
}

impl<T: Arithmetic> Normal<T> {
    #[inline]
    fn new(vertices: &[V3]) -> Self {
        let edges = [Way::new(&vertices[0], &vertices[1]), Way::new(&vertices[1], &vertices[2])];
        Self { vector: cross(edges[0].vector, edges[1].vector), edges }
    }

    /// Whether the side of an edge, which has a length, is certainly not negative.
    #[inline]
    fn is_beside(&self, query: &V3, [from, to]: [V3; 2]) -> bool {
        let (way, edge) = (Way::<T>::new(query, &from), Way::new(&from, &to));
        let side = dot(cross(way.vector, edge.vector), self.vector);
        let bound = T::SIDE_ERROR * (way.size * edge.size) * (self.edges[0].size * self.edges[1].size);
        let is_plain = way.is_plain() && PLAIN.contains(&edge.size) && self.edges.iter().all(Way::is_plain);
        // Not for NaN.
        side.leading() >= bound && is_plain
    }
}

/// Whether a feature is proved to hold the nearest point of a primitive. The ends of an edge then differ, and a face has
/// an area: no edge of it is zero, so one side at least has a bound above zero, and N is not zero.
#[inline]
pub(super) fn is_proved(query: V3, vertices: &[V3], feature: Feature) -> bool {
    exists(feature, vertices.len())
        && (holds::<f64>(query, vertices, feature) || holds_in_double(query, vertices, feature))
}

#[cold]
#[inline(never)]
fn holds_in_double(query: V3, vertices: &[V3], feature: Feature) -> bool {
    holds::<Double>(query, vertices, feature)
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for two arithmetics, each in one place")]
fn holds<T: Arithmetic>(query: V3, vertices: &[V3], feature: Feature) -> bool {
    match feature {
        Feature::Vertex(i) => {
            let a = &vertices[usize::from(i)];
            let offset = Way::<T>::new(&query, a);
            vertices.iter().all(|w| offset.leads_along(&Way::new(a, w)))
        }
        Feature::Edge(i) => {
            let [a, b] = ends(i, vertices);
            is_between::<T>(&query, &a, &b) && is_outside::<T>(&query, vertices, [a, b])
        }
        Feature::Face => {
            let normal = Normal::<T>::new(vertices);
            (0..3).all(|i| normal.is_beside(&query, ends(i, vertices)))
        }
    }
}

/// Whether the foot on a line is between two points of it, which differ.
#[inline]
fn is_between<T: Arithmetic>(query: &V3, a: &V3, b: &V3) -> bool {
    let edge = Way::<T>::new(a, b);
    PLAIN.contains(&edge.size)
        && Way::new(query, b).leads_along(&edge)
        && Way::<T>::new(query, a).leads_along(&Way::new(b, a))
}

/// Whether the foot on an edge is where the triangle, if it is one, ends.
#[inline]
fn is_outside<T: Arithmetic>(query: &V3, vertices: &[V3], [a, b]: [V3; 2]) -> bool {
    // Seen along the edge the other way round, the sign is the other one. With a repeated vertex the edge is all there
    // is, and the side zero.
    vertices.len() < 3 || Normal::<T>::new(vertices).is_beside(query, [b, a]) || is_repeated(vertices)
}

/// Whether a triangle has two equal vertices; an edge of it that has a length is then the whole of it.
#[allow(clippy::float_cmp, reason = "equal vertices, not near ones")]
fn is_repeated(vertices: &[V3]) -> bool {
    (0..3).any(|i| vertices[i] == vertices[(i + 1) % 3])
}
