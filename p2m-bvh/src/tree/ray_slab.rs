//! The intersection of a ray with slabs. A slab is the space between two parallel planes.

use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::power_of_two;

/// The growth of the product with the normal per unit of length below which a ray counts as parallel to a slab. From
/// one side of a scene to the other that is less than the error of positions in the frame, and the margins for rounding
/// include it.
pub(crate) const MIN_SLAB_GROWTH: f64 = power_of_two(-40);

/// The dot product of a ray with the normal of a slab. Its sign is chosen so that it grows along the ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct SlabRay {
    /// The product at the base of the ray, rounded up.
    high: f32,
    /// The product at the base of the ray, rounded down.
    low: f32,
    /// The inverse of the growth of the product per unit of length; infinite if the ray is parallel to the slab.
    inverse: f32,
    /// Whether the sign of the product was changed.
    is_negated: bool,
}

impl SlabRay {
    /// Creates the slab ray from the product with the normal at the base, the growth of the product per unit of length,
    /// and a bound on the error of the product.
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards, and the margins allow for it")]
    #[inline(always)]
    pub fn new(product: f64, growth: f64, margin: f64) -> Self {
        let is_negated = growth < 0.0;
        let product = if is_negated { -product } else { product };
        let is_parallel = growth.abs() < MIN_SLAB_GROWTH;
        Self {
            high: ((product + margin) as f32).next_up(),
            low: ((product - margin) as f32).next_down(),
            inverse: if is_parallel { f32::INFINITY } else { growth.abs().recip() as f32 },
            is_negated,
        }
    }
}

/// The piece of a ray that lies in the slabs of each lane, as an interval of lengths from the base of the ray.
#[derive(Clone, Copy)]
pub struct RayInterval<L> {
    near: L,
    far: L,
}

impl<L: Lanes> RayInterval<L> {
    /// Returns the interval of the complete ray.
    #[inline(always)]
    pub fn complete() -> Self {
        Self { near: L::splat(0.0), far: L::splat(f32::INFINITY) }
    }

    /// Cuts the interval to the slab between two planes in each lane.
    #[inline(always)]
    pub fn clip(&mut self, ray: &SlabRay, min: L, max: L) {
        let zero = L::splat(0.0);
        // NaN, the product of zero and an infinite inverse, leaves the interval unchanged.
        let (near, far) = if ray.is_negated { (zero.sub(max), zero.sub(min)) } else { (min, max) };
        let inverse = L::splat(ray.inverse);
        self.near = near.sub(L::splat(ray.high)).mul(inverse).max(self.near);
        self.far = far.sub(L::splat(ray.low)).mul(inverse).min(self.far);
    }

    /// Returns the length at which each interval begins, or infinity for an empty interval.
    #[inline(always)]
    pub fn entry(self) -> L {
        // Both ends have a relative error of at most 2^-22.
        let far = self.far.mul(L::splat(1.0 + 8.0 * f32::EPSILON));
        far.if_below(self.near, L::splat(f32::INFINITY), self.near)
    }
}
