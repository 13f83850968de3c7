//! Squared distances to points, segments and triangles, lane by lane.
//!
//! `distance_filter` states the band of their errors; the proof is in [docs/proofs/filter.md].
//!
//! [docs/proofs/filter.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/filter.md

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
    pub(super) fn dot(&self, other: &Self) -> L {
        self.z.mul_add(other.z, self.y.mul_add(other.y, self.x.mul(other.x)))
    }
    #[inline(always)]
    pub(super) fn square(&self) -> L {
        self.dot(self)
    }
    /// Returns the cross product of orthogonal vectors, which cancellation cannot make inaccurate.
    #[inline(always)]
    fn cross(&self, other: &Self) -> Self {
        let zero = L::splat(0.0);
        Self {
            x: self.y.mul_add(other.z, zero.sub(self.z).mul(other.y)),
            y: self.z.mul_add(other.x, zero.sub(self.x).mul(other.z)),
            z: self.x.mul_add(other.y, zero.sub(self.y).mul(other.x)),
        }
    }
    /// Returns the cross product of integer vectors, or of integer vectors times one power of two. Only the last bits
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

/// Returns the squared distance from the origin to the segment from `a` along `e`, given 1 / |e|^2.
#[inline(always)]
pub(super) fn square_from_edge<L: Lanes>(a: &V3<L>, e: &V3<L>, inverse_square: L) -> L {
    let t = L::splat(0.0).sub(a.dot(e)).mul(inverse_square);
    // An edge without length gives NaN, which `max` replaces by 0.
    let t = t.max(L::splat(0.0)).min(L::splat(1.0));
    let p = V3 { x: t.mul_add(e.x, a.x), y: t.mul_add(e.y, a.y), z: t.mul_add(e.z, a.z) };
    p.square()
}

/// Decoded triangles, shared by all query points.
pub(super) struct Triangles<L> {
    vertices: [V3<L>; 3],
    edges: [EdgeOfTriangle<L>; 3],
    normal: V3<L>,
    /// The number 1 / |normal|^2.
    inverse_square: L,
    /// The squared length of the normal.
    normal_squared: L,
}

/// An edge of triangles.
struct EdgeOfTriangle<L> {
    /// The vector from the vertex with the same number to the next vertex.
    vector: V3<L>,
    length_squared: L,
    /// The number 1 / |vector|^2.
    inverse_square: L,
    /// A vector in the plane that is perpendicular to the edge and leads out of the triangle.
    outwards: V3<L>,
}

impl<L: Lanes> EdgeOfTriangle<L> {
    #[inline(always)]
    fn new(vector: V3<L>, normal: &V3<L>) -> Self {
        let length_squared = vector.square();
        let outwards = vector.cross(normal);
        Self { length_squared, inverse_square: length_squared.reciprocal(), outwards, vector }
    }
}

impl<L: Lanes> Triangles<L> {
    /// Decodes triangles whose vertices are whole numbers, so that their edges are exact.
    #[inline(always)]
    pub(super) fn new(vertices: [V3<L>; 3]) -> Self {
        let [a, b, c] = &vertices;
        let vectors = [b.sub(a), c.sub(b), a.sub(c)];
        // The scale prevents overflow of all the squares below.
        let normal = vectors[0].scaled(L::splat(EDGE_SCALE)).cross_of_integers(&vectors[1]);
        let normal_squared = normal.square();
        let [e, f, g] = vectors;
        let edges = [EdgeOfTriangle::new(e, &normal), EdgeOfTriangle::new(f, &normal), EdgeOfTriangle::new(g, &normal)];
        Self { edges, inverse_square: normal_squared.reciprocal(), normal_squared, normal, vertices }
    }

    /// Returns the squared distances from a query point.
    #[inline(always)]
    pub(super) fn squares(&self, query: &V3<L>, margin_squared: f32) -> L {
        let margin = L::splat(margin_squared).mul(self.normal_squared);
        let mut nearest = L::splat(f32::INFINITY);
        // The value is below zero if the projection onto the plane is inside of all three edges by more than the
        // margin.
        let mut outside = L::splat(f32::NEG_INFINITY);
        let mut height = L::splat(0.0);
        for i in 0..3 {
            let (edge, a) = (&self.edges[i], self.vertices[i].sub(query));
            nearest = square_from_edge(&a, &edge.vector, edge.inverse_square).min(nearest);
            // If the query is inside, the vertex is ahead of it in the direction that leaves the triangle across this
            // edge.
            let ahead = a.dot(&edge.outwards);
            let beyond = margin.mul(edge.length_squared).sub(ahead.mul(ahead.max(L::splat(0.0))));
            outside = beyond.max(outside);
            if i == 0 {
                height = a.dot(&self.normal);
            }
        }
        let face = height.mul(height).mul(self.inverse_square);
        outside.if_below(L::splat(0.0), face, nearest)
    }
}

/// Returns one bit per lane: whether a vertex of its triangle is not behind a plane. The plane is orthogonal to
/// `normal`, and `offset` is the dot product of the normal with the vector from the query point to a point of the
/// plane.
#[inline(always)]
pub(super) fn lanes_before_plane<L: Lanes>(vertices: &[V3<L>; 3], query: &V3<L>, normal: [f32; 3], offset: f32) -> u32 {
    let normal = V3::splat(normal);
    let [a, b, c] = vertices;
    let [a, b, c] = [a.sub(query).dot(&normal), b.sub(query).dot(&normal), c.sub(query).dot(&normal)];
    a.min(b).min(c).at_most(L::splat(offset))
}

/// The scale of edges, 2^-34, with which products of two edges are at most about 1.
#[allow(clippy::cast_possible_truncation, reason = "a power of two")]
const EDGE_SCALE: f32 = power_of_two(-34) as f32;
