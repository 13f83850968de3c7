//! SIMD vectors of the crate `wide`, for all processors. They use the vector instructions that every processor of an
//! architecture has (SSE2, NEON), or arrays.

use super::lanes::{Doubles, EightLanes, Float, InstructionSet, Lanes, SimdKernel};
use super::operators::{float_operators, mask_operators};
use wide::{f32x8, f64x4};

/// Eight f32 in a vector of the crate `wide`.
#[derive(Clone, Copy)]
pub struct F32x8(f32x8);

/// Eight f64, stored as two vectors of four.
#[derive(Clone, Copy)]
pub struct EightDoubles(f64x4, f64x4);

/// The portable instruction set, which every processor has. The others are tested against it.
pub struct Portable;

/// Runs a kernel with portable instructions. It is not inlined, so that each kernel is compiled once and not at every
/// call.
#[inline(never)]
pub(super) fn run_portable<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

impl InstructionSet for Portable {
    #[inline(always)]
    fn call<K: SimdKernel>(kernel: K) -> K::Output {
        run_portable(kernel)
    }

    type F32x8 = F32x8;
    type Wide = F32x8;
    type Doubles = EightDoubles;
}

impl F32x8 {
    #[inline(always)]
    fn convert<A: Copy + Into<f32>>(from: &[A]) -> Self {
        let from: &[A; 8] = from[..8].try_into().expect("eight numbers");
        let [a, b, c, d, e, f, g, h] = *from;
        Self(f32x8::new([a.into(), b.into(), c.into(), d.into(), e.into(), f.into(), g.into(), h.into()]))
    }

    #[inline(always)]
    fn widen(self) -> [f64x4; 2] {
        let [a, b, c, d, e, f, g, h] = self.0.to_array();
        [f64x4::new([a.into(), b.into(), c.into(), d.into()]), f64x4::new([e.into(), f.into(), g.into(), h.into()])]
    }
}

impl Lanes for F32x8 {
    const LEN: usize = 8;
    const INLINES: bool = !cfg!(any(target_arch = "x86_64", all(target_arch = "aarch64", target_feature = "neon")));

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(f32x8::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Self::convert(from)
    }
    #[inline(always)]
    fn load_u16(from: &[u16]) -> Self {
        Self::convert(from)
    }
    #[inline(always)]
    fn load_u8(from: &[u8]) -> Self {
        Self::convert(from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..8].copy_from_slice(&self.0.to_array());
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        // The result is rounded twice, since a fused operation would be a function call on processors without one.
        Self(self.0 * factor.0 + summand.0)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest, as promised")]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let ([a, e], [b, f], [c, g], [d, h]) = (a.widen(), b.widen(), c.widen(), d.widen());
        // Products of two f32 are exact in f64, and so is their difference under the condition of the trait.
        let ([a, b, c, d], [e, f, g, h]) = ((a * b - c * d).to_array(), (e * f - g * h).to_array());
        Self(f32x8::new([a as f32, b as f32, c as f32, d as f32, e as f32, f as f32, g as f32, h as f32]))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.simd_lt(other.0).bitselect(self.0, other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(other.0.simd_lt(self.0).bitselect(self.0, other.0))
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        Self(f32x8::ONE / self.0)
    }
    #[inline(always)]
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Self(self.0.simd_lt(limit.0).bitselect(yes.0, no.0))
    }
    #[inline(always)]
    fn at_most(self, limit: Self) -> u32 {
        self.0.simd_le(limit.0).to_bitmask()
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        let [a, b, c, d, e, f, g, h] = self.0.to_array();
        let min = |a: f32, b: f32| if a < b { a } else { b };
        min(min(min(a, e), min(b, f)), min(min(c, g), min(d, h)))
    }
}

impl EightLanes for F32x8 {
    #[inline(always)]
    fn sorted_keys(self, limit: f32, keys: &mut [u32; 8]) -> usize {
        *keys = [0; 8];
        let mut count = 0;
        for (lane, x) in (0u32..).zip(self.0.to_array()) {
            if x <= limit {
                let key = x.to_bits() & !15 | 8 | lane;
                let mut position = count;
                while position > 0 && keys[position - 1] < key {
                    keys[position] = keys[position - 1];
                    position -= 1;
                }
                keys[position] = key;
                count += 1;
            }
        }
        count
    }
}

float_operators!(EightDoubles, |a, b| {
    add: Self(a.0 + b.0, a.1 + b.1),
    sub: Self(a.0 - b.0, a.1 - b.1),
    mul: Self(a.0 * b.0, a.1 * b.1),
    div: Self(a.0 / b.0, a.1 / b.1),
    neg: Self(-a.0, -a.1),
});

/// A mask of eight f64 lanes. All bits of a lane are one or zero.
#[derive(Clone, Copy)]
pub struct EightMasks(f64x4, f64x4);

mask_operators!(EightMasks, |a, b| {
    and: Self(a.0 & b.0, a.1 & b.1),
    or: Self(a.0 | b.0, a.1 | b.1),
    not: Self(!a.0, !a.1),
});

impl Float for EightDoubles {
    type Mask = EightMasks;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(f64x4::splat(x), f64x4::splat(x))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.is_below(other), self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.is_below(self), self, other)
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> EightMasks {
        EightMasks(self.0.simd_lt(other.0), self.1.simd_lt(other.1))
    }
    #[inline(always)]
    fn is_at_most(self, other: Self) -> EightMasks {
        EightMasks(self.0.simd_le(other.0), self.1.simd_le(other.1))
    }
    #[inline(always)]
    fn equals(self, other: Self) -> EightMasks {
        EightMasks(self.0.simd_eq(other.0), self.1.simd_eq(other.1))
    }
    #[inline(always)]
    fn select(mask: EightMasks, yes: Self, no: Self) -> Self {
        Self(mask.0.bitselect(yes.0, no.0), mask.1.bitselect(yes.1, no.1))
    }
}

impl Doubles for EightDoubles {
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from: &[f64; 8] = from[..8].try_into().expect("eight numbers");
        let [a, b, c, d, e, f, g, h] = *from;
        Self(f64x4::new([a, b, c, d]), f64x4::new([e, f, g, h]))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[..4].copy_from_slice(&self.0.to_array());
        to[4..8].copy_from_slice(&self.1.to_array());
    }
    #[inline(always)]
    fn load_f32(from: &[f32]) -> Self {
        let [a, b] = F32x8::load(from).widen();
        Self(a, b)
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest, as promised")]
    fn store_f32(self, to: &mut [f32]) {
        let to: &mut [f32; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        let ([a, b, c, d], [e, f, g, h]) = (self.0.to_array(), self.1.to_array());
        *to = [a as f32, b as f32, c as f32, d as f32, e as f32, f as f32, g as f32, h as f32];
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "eight bits")]
    fn bits(mask: EightMasks) -> u8 {
        (mask.0.to_bitmask() | mask.1.to_bitmask() << 4) as u8
    }
}
