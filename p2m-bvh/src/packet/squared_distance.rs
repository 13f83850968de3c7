//! Squared distances to points, segments and triangles, lane by lane.
//!
//! The band within which they are right is stated in `distance_filter`; its proof is in docs/proofs/filter.md.

use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// A vector in each lane.
#[derive(Clone, Copy)]
pub(super) struct V3<L> {
    pub(super) x: L,
    pub(super) y: L,
    pub(super) z: L,
}

impl<L: Lanes> V3<L> {
    #[inline(always)]
    pub(super) fn splat([x, y, z]: [f32; 3]) -> Self {
        Self { x: L::splat(x), y: L::splat(y), z: L::splat(z) }
    }
    #[inline(always)]
    pub(super) fn sub(&self, other: &Self) -> Self {
        Self { x: self.x.sub(other.x), y: self.y.sub(other.y), z: self.z.sub(other.z) }
    }
    #[inline(always)]
    pub(super) fn max(&self, other: &Self) -> Self {
        Self { x: self.x.max(other.x), y: self.y.max(other.y), z: self.z.max(other.z) }
    }
    #[inline(always)]
    fn scaled(&self, factor: L) -> Self {
        Self { x: self.x.mul(factor), y: self.y.mul(factor), z: self.z.mul(factor) }
    }
    #[inline(always)]
    fn dot(&self, other: &Self) -> L {
        self.z.mul_add(other.z, self.y.mul_add(other.y, self.x.mul(other.x)))
    }
    #[inline(always)]
    pub(super) fn square(&self) -> L {
        self.dot(self)
    }
    /// The cross product of orthogonal vectors, for which no cancellation makes the result inaccurate.
    #[inline(always)]
    fn cross(&self, other: &Self) -> Self {
        let zero = L::splat(0.0);
        Self {
            x: self.y.mul_add(other.z, zero.sub(self.z).mul(other.y)),
            y: self.z.mul_add(other.x, zero.sub(self.x).mul(other.z)),
            z: self.x.mul_add(other.y, zero.sub(self.y).mul(other.x)),
        }
    }
    /// The cross product of vectors of whole numbers, or of multiples of them by one power of two. Only the last bits
    /// are rounded, however nearly parallel the vectors are.
    #[inline(always)]
    fn cross_of_integers(&self, other: &Self) -> Self {
        Self {
            x: L::difference_of_products(self.y, other.z, self.z, other.y),
            y: L::difference_of_products(self.z, other.x, self.x, other.z),
            z: L::difference_of_products(self.x, other.y, self.y, other.x),
        }
    }
}

/// The squared distance from the origin to the segment from `a` along `e`, and |e|^2.
#[inline(always)]
pub(super) fn edge<L: Lanes>(a: &V3<L>, e: &V3<L>) -> (L, L) {
    let length_squared = e.square();
    let t = L::splat(0.0).sub(a.dot(e)).mul(length_squared.reciprocal());
    // An edge without length gives NaN, which `max` replaces by 0.
    let t = t.max(L::splat(0.0)).min(L::splat(1.0));
    let p = V3 { x: t.mul_add(e.x, a.x), y: t.mul_add(e.y, a.y), z: t.mul_add(e.z, a.z) };
    (p.square(), length_squared)
}

/// Whether all triangles are certainly farther than `limit`: all vertices lie behind the plane that is orthogonal to
/// `towards` at this distance.
#[inline(always)]
pub(super) fn is_beyond_plane<L: Lanes>(offsets: &[V3<L>; 3], towards: [f32; 3], limit: f32) -> bool {
    let [x, y, z] = towards;
    let length = (x * x + y * y + z * z).sqrt();
    let towards = V3::splat(towards);
    let [a, b, c] = offsets;
    // Vectors shorter than a unit exclude little, and their squares may underflow.
    let threshold = if length >= 1.0 { length * limit } else { f32::INFINITY };
    a.dot(&towards).min(b.dot(&towards)).min(c.dot(&towards)).at_most(L::splat(threshold)) == 0
}

/// The squared distance from the origin to triangles. `offsets` are the vertices as seen from the query point, and the
/// second argument has the same vertices as whole numbers, of which exact edges are made.
#[inline(always)]
pub(super) fn triangle<L: Lanes>(offsets: [V3<L>; 3], [a, b, c]: [V3<L>; 3], margin_squared: f32) -> L {
    let edges = [b.sub(&a), c.sub(&b), a.sub(&c)];
    // The scale keeps all the squares below from overflowing.
    let normal = edges[0].scaled(L::splat(EDGE_SCALE)).cross_of_integers(&edges[1]);
    let normal_squared = normal.square();
    let margin = L::splat(margin_squared).mul(normal_squared);
    let mut nearest = L::splat(f32::INFINITY);
    // This is below zero where the projection onto the plane is inside of all three edges by more than the margin.
    let mut outside = L::splat(f32::NEG_INFINITY);
    for (a, e) in offsets.iter().zip(&edges) {
        let (square, length_squared) = edge(a, e);
        nearest = square.min(nearest);
        // If the query is inside, the vertex lies ahead in the direction that leaves the triangle across this edge.
        let ahead = a.dot(&e.cross(&normal));
        let beyond = margin.mul(length_squared).sub(ahead.mul(ahead.max(L::splat(0.0))));
        outside = beyond.max(outside);
    }
    let height = offsets[0].dot(&normal);
    let face = height.mul(height).mul(normal_squared.reciprocal());
    outside.if_below(L::splat(0.0), face, nearest)
}

/// A scale of edges, 2^-34, with which products of two edges are about 1 at most.
#[allow(clippy::cast_possible_truncation, reason = "a power of two")]
const EDGE_SCALE: f32 = power_of_two(-34) as f32;
