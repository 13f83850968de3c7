//! Squared distances to points, segments and triangles, lane by lane, within the band of the module above.

use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// Three coordinates, lane by lane.
#[derive(Clone, Copy)]
pub struct V3<L> {
    pub x: L,
    pub y: L,
    pub z: L,
}

impl<L: Lanes> V3<L> {
    #[inline(always)]
    pub fn splat([x, y, z]: [f32; 3]) -> Self {
        Self { x: L::splat(x), y: L::splat(y), z: L::splat(z) }
    }
    #[inline(always)]
    pub fn sub(&self, other: &Self) -> Self {
        Self { x: self.x.sub(other.x), y: self.y.sub(other.y), z: self.z.sub(other.z) }
    }
    #[inline(always)]
    pub fn max(&self, other: &Self) -> Self {
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
    pub fn square(&self) -> L {
        self.dot(self)
    }
    /// Of orthogonal vectors, for which nothing cancels badly.
    #[inline(always)]
    fn cross(&self, other: &Self) -> Self {
        let zero = L::splat(0.0);
        Self {
            x: self.y.mul_add(other.z, zero.sub(self.z).mul(other.y)),
            y: self.z.mul_add(other.x, zero.sub(self.x).mul(other.z)),
            z: self.x.mul_add(other.y, zero.sub(self.y).mul(other.x)),
        }
    }
    /// Of vectors of whole numbers, up to a power of two: exact but for its last bits, however nearly parallel they
    /// are.
    #[inline(always)]
    fn cross_of_whole(&self, other: &Self) -> Self {
        Self {
            x: L::difference_of_products(self.y, other.z, self.z, other.y),
            y: L::difference_of_products(self.z, other.x, self.x, other.z),
            z: L::difference_of_products(self.x, other.y, self.y, other.x),
        }
    }
}

/// The squared distance from the origin to the segment from `a` along `e`, and |e|^2.
#[inline(always)]
pub fn edge<L: Lanes>(a: &V3<L>, e: &V3<L>) -> (L, L) {
    let length_squared = e.square();
    let t = L::splat(0.0).sub(a.dot(e)).mul(length_squared.reciprocal());
    // NaN, for an edge without length, becomes 0.
    let t = t.max(L::splat(0.0)).min(L::splat(1.0));
    let p = V3 { x: t.mul_add(e.x, a.x), y: t.mul_add(e.y, a.y), z: t.mul_add(e.z, a.z) };
    (p.square(), length_squared)
}

/// Whether all triangles are farther than `limit`: a plane that many units away, across `towards`, leaves all vertices
/// behind it.
#[inline(always)]
pub fn beyond<L: Lanes>(offsets: &[V3<L>; 3], towards: [f32; 3], limit: f32) -> bool {
    let [x, y, z] = towards;
    let length = (x * x + y * y + z * z).sqrt();
    let towards = V3::splat(towards);
    let [a, b, c] = offsets;
    // Shorter ways than a unit are not worth it, and may underflow.
    let reached = if length >= 1.0 { length * limit } else { f32::INFINITY };
    a.dot(&towards).min(b.dot(&towards)).min(c.dot(&towards)).at_most(L::splat(reached)) == 0
}

/// The squared distance from the origin to triangles of whole numbers, of which `offsets` are the places.
#[inline(always)]
pub fn triangle<L: Lanes>(offsets: [V3<L>; 3], [a, b, c]: [V3<L>; 3], margin_squared: f32) -> L {
    let edges = [b.sub(&a), c.sub(&b), a.sub(&c)];
    // Scaled so that no square of what follows overflows.
    let normal = edges[0].scaled(L::splat(SCALE)).cross_of_whole(&edges[1]);
    let normal_squared = normal.square();
    let margin = L::splat(margin_squared).mul(normal_squared);
    let mut nearest = L::splat(f32::INFINITY);
    // Below zero where the foot on the plane is inside of all three edges by more than the margin.
    let mut outside = L::splat(f32::NEG_INFINITY);
    for (a, e) in offsets.iter().zip(&edges) {
        let (square, length_squared) = edge(a, e);
        nearest = square.min(nearest);
        // The vertex lies ahead in the direction out of the triangle, if the query is inside.
        let ahead = a.dot(&e.cross(&normal));
        let beyond = margin.mul(length_squared).sub(ahead.mul(ahead.max(L::splat(0.0))));
        outside = beyond.max(outside);
    }
    let height = offsets[0].dot(&normal);
    let face = height.mul(height).mul(normal_squared.reciprocal());
    outside.if_below(L::splat(0.0), face, nearest)
}

/// 2^-34: products of two edges are then about 1 at most.
#[allow(clippy::cast_possible_truncation, reason = "a power of two")]
const SCALE: f32 = power_of_two(-34) as f32;
