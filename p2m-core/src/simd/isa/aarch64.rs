//! The instruction set NEON, which every AArch64 processor has.
//!
//! This file is compiled only if the compiler may use NEON everywhere. That makes every `unsafe` block below sound that
//! accesses no memory.

use crate::simd::lanes::{Doubles, EightLanes, Float, InstructionSet, Lanes, SimdKernel};
use crate::simd::operators::{float_operators, mask_operators};
use std::arch::aarch64::*;
use std::array::from_fn;

/// Runs a kernel with NEON. It is not inlined, so that each kernel is compiled once and not at every call.
#[inline(never)]
pub(super) fn run_neon<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<Neon>()
}

/// Eight lanes in two 128-bit registers.
#[derive(Clone, Copy)]
pub(super) struct F32x8([float32x4_t; 2]);

/// Eight f64 in four 128-bit registers.
#[derive(Clone, Copy)]
pub(super) struct EightDoubles([float64x2_t; 4]);

/// A mask of eight f64 lanes. All bits of a lane are one or zero.
#[derive(Clone, Copy)]
pub(super) struct EightMasks([uint64x2_t; 4]);

/// The instruction set NEON.
pub(super) struct Neon;

impl InstructionSet for Neon {
    #[inline(always)]
    fn call<K: SimdKernel>(kernel: K) -> K::Output {
        run_neon(kernel)
    }

    type F32x8 = F32x8;
    type Wide = F32x8;
    type Doubles = EightDoubles;
}

/// Creates a value register by register, by an expression of intrinsics that may use the number `i` of the register.
macro_rules! registers {
    ($result:ident, $i:ident: $body:expr) => {
        $result(from_fn(
            #[inline(always)]
            // SAFETY: the processor has the instructions, see the head of the file.
            |$i| unsafe { $body },
        ))
    };
}

/// Defines methods that compute each register on its own. The expression may use the number `i` of the register.
macro_rules! for_each_register {
    ($i:ident: $($name:ident($($arg:ident: $type:ty),*) -> $result:ident { $body:expr })*) => {
        $(
            #[inline(always)]
            fn $name($($arg: $type),*) -> $result {
                registers!($result, $i: $body)
            }
        )*
    };
}

impl F32x8 {
    #[inline(always)]
    fn from_u16(from: uint16x8_t) -> Self {
        // SAFETY: the processor has the instructions, see the head of the file.
        unsafe { Self([vcvtq_f32_u32(vmovl_u16(vget_low_u16(from))), vcvtq_f32_u32(vmovl_high_u16(from))]) }
    }
}

/// Returns one bit per lane. In each lane all bits are one or all are zero.
#[inline(always)]
fn bits_of_lanes(lanes: uint16x8_t) -> u16 {
    const WEIGHTS: [u16; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
    // SAFETY: the processor has the instructions, see the head of the file; the array has 16 bytes to read.
    unsafe { vaddvq_u16(vandq_u16(lanes, vld1q_u16(WEIGHTS.as_ptr()))) }
}

/// Returns the lower half of each lane.
#[inline(always)]
fn lower_halves(a: uint32x4_t, b: uint32x4_t) -> uint16x8_t {
    // SAFETY: the processor has the instructions, see the head of the file.
    unsafe { vuzp1q_u16(vreinterpretq_u16_u32(a), vreinterpretq_u16_u32(b)) }
}

impl Lanes for F32x8 {
    const LEN: usize = 8;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from: &[f32; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the array has twice 16 bytes to read.
        unsafe { Self([vld1q_f32(from.as_ptr()), vld1q_f32(from[4..].as_ptr())]) }
    }
    #[inline(always)]
    fn load_u16(from: &[u16]) -> Self {
        let from: &[u16; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the array has 16 bytes to read.
        Self::from_u16(unsafe { vld1q_u16(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u8(from: &[u8]) -> Self {
        let from: &[u8; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the array has 8 bytes to read.
        Self::from_u16(unsafe { vmovl_u8(vld1_u8(from.as_ptr())) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to: &mut [f32; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the array has twice 16 bytes to write.
        unsafe {
            vst1q_f32(to.as_mut_ptr(), self.0[0]);
            vst1q_f32(to[4..].as_mut_ptr(), self.0[1]);
        }
    }
    for_each_register! { i:
        splat(x: f32) -> Self { { let _ = i; vdupq_n_f32(x) } }
        add(self: Self, b: Self) -> Self { vaddq_f32(self.0[i], b.0[i]) }
        sub(self: Self, b: Self) -> Self { vsubq_f32(self.0[i], b.0[i]) }
        mul(self: Self, b: Self) -> Self { vmulq_f32(self.0[i], b.0[i]) }
        mul_add(self: Self, factor: Self, summand: Self) -> Self { vfmaq_f32(summand.0[i], self.0[i], factor.0[i]) }
        sqrt(self: Self) -> Self { vsqrtq_f32(self.0[i]) }
        // The instructions for minima treat NaN differently.
        min(self: Self, b: Self) -> Self { vbslq_f32(vcltq_f32(self.0[i], b.0[i]), self.0[i], b.0[i]) }
        max(self: Self, b: Self) -> Self { vbslq_f32(vcgtq_f32(self.0[i], b.0[i]), self.0[i], b.0[i]) }
        difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {{
            // Kahan's method adds the rounding error of the second product to the difference.
            let product = vmulq_f32(c.0[i], d.0[i]);
            let error = vfmsq_f32(product, c.0[i], d.0[i]);
            vaddq_f32(vfmaq_f32(vnegq_f32(product), a.0[i], b.0[i]), error)
        }}
        // A division is one instruction; an estimate has only 8 bits and would need two Newton steps.
        reciprocal(self: Self) -> Self { vdivq_f32(vdupq_n_f32(1.0), self.0[i]) }
        if_below(self: Self, limit: Self, yes: Self, no: Self) -> Self {
            vbslq_f32(vcltq_f32(self.0[i], limit.0[i]), yes.0[i], no.0[i])
        }
    }
    #[inline(always)]
    fn at_most(self, limit: Self) -> u32 {
        // SAFETY: the processor has the instructions, see the head of the file.
        let [a, b] = unsafe { [vcleq_f32(self.0[0], limit.0[0]), vcleq_f32(self.0[1], limit.0[1])] };
        u32::from(bits_of_lanes(lower_halves(a, b)))
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        // SAFETY: the processor has the instructions, see the head of the file.
        unsafe { vminvq_f32(vminq_f32(self.0[0], self.0[1])) }
    }
}

impl EightLanes for F32x8 {
    #[inline(always)]
    fn sorted_keys(self, limit: f32, keys: &mut [u32; 8]) -> usize {
        const LANES: [u32; 8] = [8, 9, 10, 11, 12, 13, 14, 15];
        // SAFETY: the processor has the instructions, see the head of the file; the arrays have twice 16 bytes.
        unsafe {
            let limit = vdupq_n_f32(limit);
            let within = [vcleq_f32(self.0[0], limit), vcleq_f32(self.0[1], limit)];
            let key = |i: usize| {
                let bits = vbicq_u32(vreinterpretq_u32_f32(self.0[i]), vdupq_n_u32(15));
                vandq_u32(within[i], vorrq_u32(bits, vld1q_u32(LANES[4 * i..].as_ptr())))
            };
            let (a, b) = (key(0), key(1));
            let count = vaddvq_u32(vaddq_u32(within[0], within[1])).wrapping_neg() as usize;
            // Batcher's bitonic network. In each step the lanes of `a` are compared with the lanes of `b`, and keep the
            // larger ones. The comments list the positions in the sorted sequence for which the lanes then stand. Bits
            // of non-negative numbers are ordered as integers.
            let (a, b) = exchange(a, b); // 0 2 4 6, 1 3 5 7
            let (a, b) = exchange(vtrn1q_u32(a, b), vtrn2q_u32(b, a)); // 0 1 4 5, 3 2 7 6
            let (a, b) = exchange(vtrn1q_u32(a, b), vtrn2q_u32(a, b)); // 0 2 4 6, 1 3 5 7
            let reversed = vrev64q_u32(b);
            let (a, b) = exchange(a, vextq_u32::<2>(reversed, reversed)); // 0 2 3 1, 7 5 4 6
            let (a, b) = exchange(vuzp1q_u32(a, b), vuzp2q_u32(a, b)); // 0 1 5 4, 2 3 7 6
            let (a, b) = exchange(vuzp1q_u32(a, b), vuzp2q_u32(a, b)); // 0 4 2 6, 1 5 3 7
            vst1q_u32(keys.as_mut_ptr(), vtrn1q_u32(a, b));
            vst1q_u32(keys[4..].as_mut_ptr(), vtrn2q_u32(a, b));
            count
        }
    }
}

/// Returns the larger and the smaller value of each lane.
#[inline(always)]
fn exchange(a: uint32x4_t, b: uint32x4_t) -> (uint32x4_t, uint32x4_t) {
    // SAFETY: the processor has the instructions, see the head of the file.
    unsafe { (vmaxq_u32(a, b), vminq_u32(a, b)) }
}

float_operators!(EightDoubles, |a, b| {
    add: registers!(Self, i: vaddq_f64(a.0[i], b.0[i])),
    sub: registers!(Self, i: vsubq_f64(a.0[i], b.0[i])),
    mul: registers!(Self, i: vmulq_f64(a.0[i], b.0[i])),
    div: registers!(Self, i: vdivq_f64(a.0[i], b.0[i])),
    neg: registers!(Self, i: vnegq_f64(a.0[i])),
});

mask_operators!(EightMasks, |a, b| {
    and: registers!(Self, i: vandq_u64(a.0[i], b.0[i])),
    or: registers!(Self, i: vorrq_u64(a.0[i], b.0[i])),
    not: registers!(Self, i: vreinterpretq_u64_u32(vmvnq_u32(vreinterpretq_u32_u64(a.0[i])))),
});

impl Float for EightDoubles {
    type Mask = EightMasks;
    for_each_register! { i:
        splat(x: f64) -> Self { { let _ = i; vdupq_n_f64(x) } }
        abs(self: Self) -> Self { vabsq_f64(self.0[i]) }
        min(self: Self, b: Self) -> Self { vbslq_f64(vcltq_f64(self.0[i], b.0[i]), self.0[i], b.0[i]) }
        max(self: Self, b: Self) -> Self { vbslq_f64(vcgtq_f64(self.0[i], b.0[i]), self.0[i], b.0[i]) }
        is_below(self: Self, b: Self) -> EightMasks { vcltq_f64(self.0[i], b.0[i]) }
        is_at_most(self: Self, b: Self) -> EightMasks { vcleq_f64(self.0[i], b.0[i]) }
        equals(self: Self, b: Self) -> EightMasks { vceqq_f64(self.0[i], b.0[i]) }
        select(mask: EightMasks, yes: Self, no: Self) -> Self { vbslq_f64(mask.0[i], yes.0[i], no.0[i]) }
    }
}

impl Doubles for EightDoubles {
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from: &[f64; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the array has four times 16 bytes to read.
        Self(from_fn(|i| unsafe { vld1q_f64(from[2 * i..].as_ptr()) }))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to: &mut [f64; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        for (i, x) in self.0.into_iter().enumerate() {
            // SAFETY: the array has four times 16 bytes to write.
            unsafe { vst1q_f64(to[2 * i..].as_mut_ptr(), x) }
        }
    }
    #[inline(always)]
    fn load_f32(from: &[f32]) -> Self {
        let [a, b] = F32x8::load(from).0;
        // SAFETY: the processor has the instructions, see the head of the file.
        let [[a, b], [c, d]] = [a, b].map(|x| unsafe { [vcvt_f64_f32(vget_low_f32(x)), vcvt_high_f64_f32(x)] });
        Self([a, b, c, d])
    }
    #[inline(always)]
    fn store_f32(self, to: &mut [f32]) {
        let [a, b, c, d] = self.0;
        // SAFETY: the processor has the instructions, see the head of the file.
        let halves = unsafe { [vcvt_high_f32_f64(vcvt_f32_f64(a), b), vcvt_high_f32_f64(vcvt_f32_f64(c), d)] };
        F32x8(halves).store(to);
    }
    for_each_register! { i:
        mul_add(self: Self, b: Self, c: Self) -> Self { vfmaq_f64(c.0[i], self.0[i], b.0[i]) }
        sqrt(self: Self) -> Self { vsqrtq_f64(self.0[i]) }
    }
    #[inline(always)]
    fn bits(mask: EightMasks) -> u8 {
        // SAFETY: the processor has the instructions, see the head of the file.
        let [a, b] = [[mask.0[0], mask.0[1]], [mask.0[2], mask.0[3]]]
            .map(|[x, y]| unsafe { vuzp1q_u32(vreinterpretq_u32_u64(x), vreinterpretq_u32_u64(y)) });
        bits_of_lanes(lower_halves(a, b)).to_le_bytes()[0]
    }
}
