//! A ray and the slabs of a node.

use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// Directions that grow by less per length are parallel to a slab: from one side of a scene to the other that makes less
/// than what positions may be off in the frame. Also some room for rounding.
pub const SLIGHT: f64 = power_of_two(-40);

/// A ray and a pair of opposite planes: a product with a normal, turned so that it grows along the ray.
#[derive(Clone, Copy, Debug)]
pub struct SlabRay {
    /// The product of the base, rounded up and down.
    high: f32,
    low: f32,
    /// By how much it grows per length; infinite if by nothing worth mentioning.
    inverse: f32,
    /// Whether it was turned.
    turned: bool,
}

impl SlabRay {
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards, and margins have room")]
    #[inline]
    pub fn new(product: f64, growth: f64, margin: f64) -> Self {
        let turned = growth < 0.0;
        let product = if turned { -product } else { product };
        let parallel = growth.abs() < SLIGHT;
        Self {
            high: ((product + margin) as f32).next_up(),
            low: ((product - margin) as f32).next_down(),
            inverse: if parallel { f32::INFINITY } else { growth.abs().recip() as f32 },
            turned,
        }
    }
}

/// The piece of a ray that lies in some slabs, lane by lane.
#[derive(Clone, Copy)]
pub struct Piece<L> {
    near: L,
    far: L,
}

impl<L: Lanes> Piece<L> {
    #[inline(always)]
    pub fn new() -> Self {
        Self { near: L::splat(0.0), far: L::splat(f32::INFINITY) }
    }

    /// Cuts it to the slabs between two planes each.
    #[inline(always)]
    pub fn clip(&mut self, ray: &SlabRay, min: L, max: L) {
        let zero = L::splat(0.0);
        // NaN, which is the product of nothing and an infinite inverse, leaves the piece as it is.
        let (near, far) = if ray.turned { (zero.sub(max), zero.sub(min)) } else { (min, max) };
        let inverse = L::splat(ray.inverse);
        self.near = near.sub(L::splat(ray.high)).mul(inverse).max(self.near);
        self.far = far.sub(L::splat(ray.low)).mul(inverse).min(self.far);
    }

    /// Where it begins; infinite if it is empty.
    #[inline(always)]
    pub fn entry(self) -> L {
        // Either end is good to 2^-22.
        let far = self.far.mul(L::splat(1.0 + 8.0 * f32::EPSILON));
        far.if_below(self.near, L::splat(f32::INFINITY), self.near)
    }
}
