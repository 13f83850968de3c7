//! Certificates: proofs that a feature of a primitive contains its point nearest to a query.
//!
//! The basic idea is to verify the claim of the kernel instead of computing the feature again: whether a given feature
//! contains the nearest point depends only on the signs of a few dot products and determinants. A sign is certain if
//! the magnitude of the computed number exceeds a bound on its error. If all signs are certain and right, the claim is
//! proved; otherwise nothing is known, and the caller tries a more precise arithmetic.
//!
//! All positions are relative to the query. A point F of a convex set is nearest to the origin if and only if F . (W -
//! F) is not negative for any point W of the set; it suffices to test the vertices. Let A, B and C be the vertices, D =
//! B - A, and N = (B - A) x (C - B) the normal. The conditions are
//!
//! - for a vertex A: A . (W - A) >= 0 for the other vertices W;
//! - for an edge from A to B, on which F = A - (A . D / D . D) D, so that F . D = 0: F is on the edge if A . (A - B) >=
//!   0 and B . (B - A) >= 0; and F . (C - F) = F . (C - A) is, times D . D, (A . (C - A)) (D . D) - (A . D) (D . (C -
//!   A)) = (A x D) . ((C - A) x D), which is -N . (A x D);
//! - for a face with N /= 0: the weight of C is N . (A x B) / N . N, where A x B = A x D, and has to be >= 0; likewise
//!   the weights of A and B.
//!
//! So the signs of two kinds of numbers are needed: dot products, and *sides* N . (A x D). Where such a number is zero,
//! two neighbouring features contain the nearest point, and a claim of either can be proved.
//!
//! # Errors
//!
//! The *size* of a vector is the magnitude of its largest component. For vectors of sizes a and d, a dot product is a
//! sum of three products below a d. Each takes 3 operations up to the result, and 2 more for the differences in its
//! factors. Operations have relative errors below u, so the error is below 3 a d ((1 + u)^5 - 1) < 15.1 u a d in f64.
//! A side is a sum of twelve products of four components, below a d e f. Each takes 2 operations in either cross
//! product, 3 in their dot product and 4 for the differences, so the error is below 12 a d e f ((1 + u)^11 - 1) <
//! 132.1 u a d e f.
//!
//! In double-double, differences are exact and operations have relative errors below 7 u^2 \[Joldes2017\]. So the
//! errors are below 3 a d ((1 + 7 u^2)^3 - 1) < 63.1 u^2 a d and 12 a d e f ((1 + 7 u^2)^7 - 1) < 588.1 u^2 a d e f.
//! The constants below exceed all these by a fifth or more. That covers the rounding of sizes and bounds, and the lower
//! half of a double-double number, which is not compared.
//!
//! Sizes are within 2^-100..2^100, or zero. Products of four components are then above 2^-400 and errors above 2^-500.
//! A term of a side that underflows is below 2^-1070, and is multiplied by at most 2^203, which is negligible beside
//! that. Nothing overflows. A difference that rounds to zero is zero, so a vector of size zero is exactly zero, and so
//! are its products and their bounds.

use super::feature::{U, ends, exists};
use crate::Feature;
use crate::kernel::arithmetic::{Number, cross, dot};
use crate::kernel::double_double::Double;
use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, larger};

/// The sizes of vectors for which the error bounds cover underflow and no product overflows.
pub(super) const PLAIN_SIZES: std::ops::RangeInclusive<f64> = power_of_two(-100)..=power_of_two(100);

/// An arithmetic with error bounds, so that some signs are certain.
trait BoundedArithmetic: Number {
    /// A bound on the error of a dot product, relative to the product of the sizes of its factors.
    const DOT_ERROR: f64;
    /// A bound on the error of a side, relative to the product of the sizes of its four vectors.
    const SIDE_ERROR: f64;
    /// Returns a - b.
    fn difference(a: f64, b: f64) -> Self;
    /// Returns the number rounded to f64.
    fn leading(self) -> f64;
}

impl BoundedArithmetic for f64 {
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

impl BoundedArithmetic for Double {
    const DOT_ERROR: f64 = 80.0 * U * U;
    const SIDE_ERROR: f64 = 720.0 * U * U;
    fn difference(a: f64, b: f64) -> Self {
        Self::difference(a, b)
    }
    fn leading(self) -> f64 {
        self.high
    }
}

/// The vector from one point to another.
struct Offset<T> {
    vector: [T; 3],
    /// The magnitude of the largest component.
    size: f64,
}

impl<T: BoundedArithmetic> Offset<T> {
    #[inline(always)]
    #[allow(clippy::inline_always, reason = "a few instructions")]
    fn new(from: &V3, to: &V3) -> Self {
        let vector: [T; 3] = std::array::from_fn(|k| T::difference(to[k], from[k]));
        let [x, y, z] = vector.map(|x| x.leading().abs());
        Self { vector, size: larger(larger(x, y), z) }
    }

    /// Returns whether the dot product with another vector is certainly not negative.
    #[inline]
    fn has_nonnegative_dot(&self, other: &Self) -> bool {
        let bound = T::DOT_ERROR * (self.size * other.size);
        // The comparison is false for NaN.
        dot(self.vector, other.vector).leading() >= bound && self.has_plain_size() && other.has_plain_size()
            || self.has_zero_dot(other)
    }

    /// Returns whether the dot product is exactly zero because the two vectors have no common axis with a nonzero
    /// component. This is common for queries above a vertex of a box or a grid.
    fn has_zero_dot(&self, other: &Self) -> bool {
        (0..3).all(|k| self.vector[k].leading() == 0.0 || other.vector[k].leading() == 0.0)
    }

    fn has_plain_size(&self) -> bool {
        self.size == 0.0 || PLAIN_SIZES.contains(&self.size)
    }
}

/// The normal of a triangle, with the two edges whose cross product it is.
struct Normal<T> {
    vector: [T; 3],
    edges: [Offset<T>; 2],
}

impl<T: BoundedArithmetic> Normal<T> {
    #[inline]
    fn new(vertices: &[V3]) -> Self {
        let edges = [Offset::new(&vertices[0], &vertices[1]), Offset::new(&vertices[1], &vertices[2])];
        Self { vector: cross(edges[0].vector, edges[1].vector), edges }
    }

    /// Returns whether the side of an edge is certainly not negative. The edge has a positive length.
    #[inline]
    fn has_nonnegative_side(&self, query: &V3, [from, to]: [V3; 2]) -> bool {
        let (offset, edge) = (Offset::<T>::new(query, &from), Offset::new(&from, &to));
        let side = dot(cross(offset.vector, edge.vector), self.vector);
        let bound = T::SIDE_ERROR * (offset.size * edge.size) * (self.edges[0].size * self.edges[1].size);
        let is_plain = offset.has_plain_size()
            && PLAIN_SIZES.contains(&edge.size)
            && self.edges.iter().all(Offset::has_plain_size);
        // The comparison is false for NaN.
        side.leading() >= bound && is_plain
    }
}

/// Returns whether a feature is proved to contain the nearest point of a primitive.
///
/// The proof implies that the ends of an edge differ, and that a face has an area: none of its edges is zero, so at
/// least one side has a bound above zero, and N is not zero.
#[inline]
pub(super) fn is_proved(query: V3, vertices: &[V3], feature: Feature) -> bool {
    exists(feature, vertices.len())
        && (is_proved_in::<f64>(query, vertices, feature) || is_proved_in_double_double(query, vertices, feature))
}

#[cold]
#[inline(never)]
fn is_proved_in_double_double(query: V3, vertices: &[V3], feature: Feature) -> bool {
    is_proved_in::<Double>(query, vertices, feature)
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for two arithmetics, each with one caller")]
fn is_proved_in<T: BoundedArithmetic>(query: V3, vertices: &[V3], feature: Feature) -> bool {
    match feature {
        Feature::Vertex(i) => {
            let a = &vertices[usize::from(i)];
            let offset = Offset::<T>::new(&query, a);
            vertices.iter().all(|w| offset.has_nonnegative_dot(&Offset::new(a, w)))
        }
        Feature::Edge(i) => {
            let [a, b] = ends(i, vertices);
            is_between::<T>(&query, &a, &b) && is_nearest_on_edge::<T>(&query, vertices, [a, b])
        }
        Feature::Face => {
            let normal = Normal::<T>::new(vertices);
            (0..3).all(|i| normal.has_nonnegative_side(&query, ends(i, vertices)))
        }
    }
}

/// Returns whether the projection onto a line lies certainly between two distinct points of the line.
#[inline]
fn is_between<T: BoundedArithmetic>(query: &V3, a: &V3, b: &V3) -> bool {
    let edge = Offset::<T>::new(a, b);
    PLAIN_SIZES.contains(&edge.size)
        && Offset::new(query, b).has_nonnegative_dot(&edge)
        && Offset::<T>::new(query, a).has_nonnegative_dot(&Offset::new(b, a))
}

/// Returns whether certainly no point of the triangle is nearer than the foot on an edge, if the foot lies on that
/// edge. It is `true` for a segment.
#[inline]
fn is_nearest_on_edge<T: BoundedArithmetic>(query: &V3, vertices: &[V3], [a, b]: [V3; 2]) -> bool {
    // The reversed edge has a side of the opposite sign. A triangle with a repeated vertex equals its edge, and the
    // side is zero.
    vertices.len() < 3
        || Normal::<T>::new(vertices).has_nonnegative_side(query, [b, a])
        || has_repeated_vertex(vertices)
}

/// Returns whether a triangle has two equal vertices. Such a triangle is equal to each of its edges that has a length.
#[allow(clippy::float_cmp, reason = "equal vertices, not near ones")]
fn has_repeated_vertex(vertices: &[V3]) -> bool {
    (0..3).any(|i| vertices[i] == vertices[(i + 1) % 3])
}
