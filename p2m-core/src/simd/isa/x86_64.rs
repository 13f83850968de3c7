//! The instruction sets AVX2 with FMA, and AVX-512.
//!
//! The types are private to this folder. Their methods are called only by a [`SimdKernel`] that is run by `run_avx2` or
//! `run_avx512`, whose callers have checked the processor. That makes every `unsafe` block below sound.

use crate::simd::lanes::{Doubles, EightLanes, Float, InstructionSet, Lanes, SimdKernel};
use crate::simd::operators::{float_operators, mask_operators};
use std::arch::x86_64::*;

/// Returns whether the processor has the instructions for [`run_avx2`].
pub(super) fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

/// Returns whether the processor has the instructions for [`run_avx512`].
pub(super) fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
}

/// Runs a kernel with AVX2.
///
/// # Safety
/// The processor must have AVX2, FMA, BMI1, BMI2, LZCNT and POPCNT.
#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) unsafe fn run_avx2<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

/// Runs a kernel with AVX-512.
///
/// # Safety
/// The processor must have AVX2, FMA, BMI1, BMI2, LZCNT, POPCNT, and AVX-512 F and VL.
#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl")]
pub(super) unsafe fn run_avx512<K: SimdKernel>(kernel: K) -> K::Output {
    kernel.run::<Avx512>()
}

/// Prefetches the cache line at an address, which every x86-64 processor can do.
#[inline(always)]
pub(super) fn prefetch(at: *const u8) {
    // SAFETY: a prefetch reads nothing, whatever the address.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) }
}

/// Eight lanes in a 256-bit register.
#[derive(Clone, Copy)]
pub(super) struct F32x8(__m256);

/// Sixteen lanes in a 512-bit register.
#[derive(Clone, Copy)]
pub(super) struct F32x16(__m512);

/// Eight f64 in two 256-bit registers.
#[derive(Clone, Copy)]
pub(super) struct Pair(__m256d, __m256d);

/// Eight f64 in a 512-bit register.
#[derive(Clone, Copy)]
pub(super) struct EightDoubles(__m512d);

/// The instruction set AVX2 with FMA.
pub(super) struct Avx2;
/// The instruction set AVX-512 F and VL.
pub(super) struct Avx512;

impl InstructionSet for Avx2 {
    #[inline(always)]
    fn call<K: SimdKernel>(kernel: K) -> K::Output {
        // SAFETY: the processor has the instructions, see the head of the file.
        unsafe { run_avx2(kernel) }
    }

    type F32x8 = F32x8;
    type Wide = F32x8;
    type Doubles = Pair;
}

impl InstructionSet for Avx512 {
    #[inline(always)]
    fn call<K: SimdKernel>(kernel: K) -> K::Output {
        // SAFETY: the processor has the instructions, see the head of the file.
        unsafe { run_avx512(kernel) }
    }

    type F32x8 = F32x8;
    type Wide = F32x16;
    type Doubles = EightDoubles;
}

/// Defines methods whose body is one expression of intrinsics.
macro_rules! intrinsics {
    ($($name:ident($($arg:ident: $type:ty),*) -> $result:ty { $body:expr })*) => {
        $(
            #[inline(always)]
            fn $name($($arg: $type),*) -> $result {
                // SAFETY: the processor has the instructions, see the head of the file.
                unsafe { $body }
            }
        )*
    };
}

impl Lanes for F32x8 {
    const LEN: usize = 8;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from: &[f32; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to read.
        Self(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u16(from: &[u16]) -> Self {
        let from: &[u16; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 16 bytes to read.
        Self(unsafe { _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(from.as_ptr().cast()))) })
    }
    #[inline(always)]
    fn load_u8(from: &[u8]) -> Self {
        let from: &[u8; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 8 bytes to read.
        Self(unsafe { _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(from.as_ptr().cast()))) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to: &mut [f32; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to write.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    intrinsics! {
        splat(x: f32) -> Self { Self(_mm256_set1_ps(x)) }
        add(self: Self, other: Self) -> Self { Self(_mm256_add_ps(self.0, other.0)) }
        sub(self: Self, other: Self) -> Self { Self(_mm256_sub_ps(self.0, other.0)) }
        mul(self: Self, other: Self) -> Self { Self(_mm256_mul_ps(self.0, other.0)) }
        mul_add(self: Self, factor: Self, summand: Self) -> Self { Self(_mm256_fmadd_ps(self.0, factor.0, summand.0)) }
        sqrt(self: Self) -> Self { Self(_mm256_sqrt_ps(self.0)) }
        min(self: Self, other: Self) -> Self { Self(_mm256_min_ps(self.0, other.0)) }
        max(self: Self, other: Self) -> Self { Self(_mm256_max_ps(self.0, other.0)) }
        difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {{
            // Kahan's method adds the rounding error of the second product to the difference.
            let product = _mm256_mul_ps(c.0, d.0);
            let error = _mm256_fnmadd_ps(c.0, d.0, product);
            Self(_mm256_add_ps(_mm256_fmsub_ps(a.0, b.0, product), error))
        }}
        reciprocal(self: Self) -> Self {{
            // The estimate has a relative error of 2^-11, which one Newton step squares.
            let estimate = _mm256_rcp_ps(self.0);
            let rest = _mm256_fnmadd_ps(self.0, estimate, _mm256_set1_ps(1.0));
            Self(_mm256_fmadd_ps(rest, estimate, estimate))
        }}
        if_below(self: Self, limit: Self, yes: Self, no: Self) -> Self {
            Self(_mm256_blendv_ps(no.0, yes.0, _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, limit.0)))
        }
        at_most(self: Self, limit: Self) -> u32 {
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, limit.0)).cast_unsigned()
        }
        smallest(self: Self) -> f32 {{
            let four = _mm_min_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            let two = _mm_min_ps(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)))
        }}
    }
}

impl EightLanes for F32x8 {
    #[inline(always)]
    fn sorted_keys(self, limit: f32, keys: &mut [u32; 8]) -> usize {
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to write.
        unsafe {
            let within = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, _mm256_set1_ps(limit)));
            let bits = _mm256_andnot_si256(_mm256_set1_epi32(15), _mm256_castps_si256(self.0));
            let lanes = _mm256_setr_epi32(8, 9, 10, 11, 12, 13, 14, 15);
            let x = _mm256_and_si256(within, _mm256_or_si256(bits, lanes));
            let count = _mm256_movemask_ps(_mm256_castsi256_ps(within)).count_ones() as usize;
            // Batcher's bitonic network. Each line compares lanes with their partners, and keeps the smaller value
            // where the mask has a bit and the larger one elsewhere. Bits of non-negative numbers are ordered as signed
            // integers.
            let x = exchange::<0b1001_1001>(x, _mm256_shuffle_epi32::<0b10_11_00_01>(x));
            let x = exchange::<0b1100_0011>(x, _mm256_shuffle_epi32::<0b01_00_11_10>(x));
            let x = exchange::<0b1010_0101>(x, _mm256_shuffle_epi32::<0b10_11_00_01>(x));
            let x = exchange::<0b1111_0000>(x, _mm256_permute2x128_si256::<1>(x, x));
            let x = exchange::<0b1100_1100>(x, _mm256_shuffle_epi32::<0b01_00_11_10>(x));
            let x = exchange::<0b1010_1010>(x, _mm256_shuffle_epi32::<0b10_11_00_01>(x));
            _mm256_storeu_si256(keys.as_mut_ptr().cast(), x);
            count
        }
    }
}

/// Returns the larger value of `x` and its partner in each lane, or the smaller one in the lanes whose bit in `SMALLER`
/// is set.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn exchange<const SMALLER: i32>(x: __m256i, partner: __m256i) -> __m256i {
    // SAFETY: the processor has AVX2, which the caller guarantees.
    unsafe { _mm256_blend_epi32::<SMALLER>(_mm256_max_epi32(x, partner), _mm256_min_epi32(x, partner)) }
}

impl Lanes for F32x16 {
    const LEN: usize = 16;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from: &[f32; 16] = from[..16].try_into().expect("sixteen numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 64 bytes to read.
        Self(unsafe { _mm512_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u16(from: &[u16]) -> Self {
        let from: &[u16; 16] = from[..16].try_into().expect("sixteen numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to read.
        Self(unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256(from.as_ptr().cast()))) })
    }
    #[inline(always)]
    fn load_u8(from: &[u8]) -> Self {
        let from: &[u8; 16] = from[..16].try_into().expect("sixteen numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 16 bytes to read.
        Self(unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(from.as_ptr().cast()))) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to: &mut [f32; 16] = (&mut to[..16]).try_into().expect("sixteen numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 64 bytes to write.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    intrinsics! {
        splat(x: f32) -> Self { Self(_mm512_set1_ps(x)) }
        add(self: Self, other: Self) -> Self { Self(_mm512_add_ps(self.0, other.0)) }
        sub(self: Self, other: Self) -> Self { Self(_mm512_sub_ps(self.0, other.0)) }
        mul(self: Self, other: Self) -> Self { Self(_mm512_mul_ps(self.0, other.0)) }
        mul_add(self: Self, factor: Self, summand: Self) -> Self { Self(_mm512_fmadd_ps(self.0, factor.0, summand.0)) }
        sqrt(self: Self) -> Self { Self(_mm512_sqrt_ps(self.0)) }
        min(self: Self, other: Self) -> Self { Self(_mm512_min_ps(self.0, other.0)) }
        max(self: Self, other: Self) -> Self { Self(_mm512_max_ps(self.0, other.0)) }
        difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {{
            let product = _mm512_mul_ps(c.0, d.0);
            let error = _mm512_fnmadd_ps(c.0, d.0, product);
            Self(_mm512_add_ps(_mm512_fmsub_ps(a.0, b.0, product), error))
        }}
        reciprocal(self: Self) -> Self {{
            // The estimate has a relative error of 2^-14, which one Newton step squares.
            let estimate = _mm512_rcp14_ps(self.0);
            let rest = _mm512_fnmadd_ps(self.0, estimate, _mm512_set1_ps(1.0));
            Self(_mm512_fmadd_ps(rest, estimate, estimate))
        }}
        if_below(self: Self, limit: Self, yes: Self, no: Self) -> Self {
            Self(_mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, limit.0), no.0, yes.0))
        }
        at_most(self: Self, limit: Self) -> u32 { u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, limit.0)) }
        smallest(self: Self) -> f32 { _mm512_reduce_min_ps(self.0) }
    }
}

/// A mask of eight f64 lanes. All bits of a lane are one or zero.
#[derive(Clone, Copy)]
pub(super) struct PairMask(__m256d, __m256d);

/// A mask of eight f64 lanes, with one bit per lane.
#[derive(Clone, Copy)]
pub(super) struct BitMask(__mmask8);

/// Makes an expression of intrinsics safe.
macro_rules! intrinsic {
    ($body:expr) => {
        // SAFETY: the processor has the instructions, see the head of the file.
        unsafe { $body }
    };
}

float_operators!(Pair, |a, b| {
    add: intrinsic!(Self(_mm256_add_pd(a.0, b.0), _mm256_add_pd(a.1, b.1))),
    sub: intrinsic!(Self(_mm256_sub_pd(a.0, b.0), _mm256_sub_pd(a.1, b.1))),
    mul: intrinsic!(Self(_mm256_mul_pd(a.0, b.0), _mm256_mul_pd(a.1, b.1))),
    div: intrinsic!(Self(_mm256_div_pd(a.0, b.0), _mm256_div_pd(a.1, b.1))),
    neg: intrinsic!({
        let sign = _mm256_set1_pd(-0.0);
        Self(_mm256_xor_pd(a.0, sign), _mm256_xor_pd(a.1, sign))
    }),
});

mask_operators!(PairMask, |a, b| {
    and: intrinsic!(Self(_mm256_and_pd(a.0, b.0), _mm256_and_pd(a.1, b.1))),
    or: intrinsic!(Self(_mm256_or_pd(a.0, b.0), _mm256_or_pd(a.1, b.1))),
    not: intrinsic!({
        let ones = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
        Self(_mm256_xor_pd(a.0, ones), _mm256_xor_pd(a.1, ones))
    }),
});

float_operators!(EightDoubles, |a, b| {
    add: intrinsic!(Self(_mm512_add_pd(a.0, b.0))),
    sub: intrinsic!(Self(_mm512_sub_pd(a.0, b.0))),
    mul: intrinsic!(Self(_mm512_mul_pd(a.0, b.0))),
    div: intrinsic!(Self(_mm512_div_pd(a.0, b.0))),
    neg: intrinsic!({
        let sign = _mm512_castpd_si512(_mm512_set1_pd(-0.0));
        Self(_mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(a.0), sign)))
    }),
});

mask_operators!(BitMask, |a, b| {
    and: Self(a.0 & b.0),
    or: Self(a.0 | b.0),
    not: Self(!a.0),
});

impl Float for Pair {
    type Mask = PairMask;
    intrinsics! {
        splat(x: f64) -> Self { Self(_mm256_set1_pd(x), _mm256_set1_pd(x)) }
        abs(self: Self) -> Self {{
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_andnot_pd(sign, self.0), _mm256_andnot_pd(sign, self.1))
        }}
        min(self: Self, b: Self) -> Self { Self(_mm256_min_pd(self.0, b.0), _mm256_min_pd(self.1, b.1)) }
        max(self: Self, b: Self) -> Self { Self(_mm256_max_pd(self.0, b.0), _mm256_max_pd(self.1, b.1)) }
        is_below(self: Self, b: Self) -> PairMask {
            PairMask(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, b.0), _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, b.1))
        }
        is_at_most(self: Self, b: Self) -> PairMask {
            PairMask(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, b.0), _mm256_cmp_pd::<_CMP_LE_OQ>(self.1, b.1))
        }
        equals(self: Self, b: Self) -> PairMask {
            PairMask(_mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, b.0), _mm256_cmp_pd::<_CMP_EQ_OQ>(self.1, b.1))
        }
        select(mask: PairMask, yes: Self, no: Self) -> Self {
            Self(_mm256_blendv_pd(no.0, yes.0, mask.0), _mm256_blendv_pd(no.1, yes.1, mask.1))
        }
    }
}

impl Doubles for Pair {
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from: &[f64; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has twice 32 bytes to read.
        unsafe { Self(_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from[4..].as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to: &mut [f64; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has twice 32 bytes to write.
        unsafe {
            _mm256_storeu_pd(to.as_mut_ptr(), self.0);
            _mm256_storeu_pd(to[4..].as_mut_ptr(), self.1);
        }
    }
    #[inline(always)]
    fn load_f32(from: &[f32]) -> Self {
        let from: &[f32; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has twice 16 bytes to read.
        unsafe { Self(_mm256_cvtps_pd(_mm_loadu_ps(from.as_ptr())), _mm256_cvtps_pd(_mm_loadu_ps(from[4..].as_ptr()))) }
    }
    #[inline(always)]
    fn store_f32(self, to: &mut [f32]) {
        let to: &mut [f32; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has twice 16 bytes to write.
        unsafe {
            _mm_storeu_ps(to.as_mut_ptr(), _mm256_cvtpd_ps(self.0));
            _mm_storeu_ps(to[4..].as_mut_ptr(), _mm256_cvtpd_ps(self.1));
        }
    }
    intrinsics! {
        mul_add(self: Self, b: Self, c: Self) -> Self {
            Self(_mm256_fmadd_pd(self.0, b.0, c.0), _mm256_fmadd_pd(self.1, b.1, c.1))
        }
        sqrt(self: Self) -> Self { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
        bits(mask: PairMask) -> u8 {
            (_mm256_movemask_pd(mask.0) | _mm256_movemask_pd(mask.1) << 4).to_le_bytes()[0]
        }
    }
}

impl Float for EightDoubles {
    type Mask = BitMask;
    intrinsics! {
        splat(x: f64) -> Self { Self(_mm512_set1_pd(x)) }
        abs(self: Self) -> Self { Self(_mm512_abs_pd(self.0)) }
        min(self: Self, other: Self) -> Self { Self(_mm512_min_pd(self.0, other.0)) }
        max(self: Self, other: Self) -> Self { Self(_mm512_max_pd(self.0, other.0)) }
        is_below(self: Self, other: Self) -> BitMask { BitMask(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)) }
        is_at_most(self: Self, other: Self) -> BitMask { BitMask(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)) }
        equals(self: Self, other: Self) -> BitMask { BitMask(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, other.0)) }
        select(mask: BitMask, yes: Self, no: Self) -> Self { Self(_mm512_mask_blend_pd(mask.0, no.0, yes.0)) }
    }
}

impl Doubles for EightDoubles {
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from: &[f64; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 64 bytes to read.
        Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to: &mut [f64; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 64 bytes to write.
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn load_f32(from: &[f32]) -> Self {
        let from: &[f32; 8] = from[..8].try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to read.
        Self(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(from.as_ptr())) })
    }
    #[inline(always)]
    fn store_f32(self, to: &mut [f32]) {
        let to: &mut [f32; 8] = (&mut to[..8]).try_into().expect("eight numbers");
        // SAFETY: the processor has the instructions, see the head of the file; the array has 32 bytes to write.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), _mm512_cvtpd_ps(self.0)) }
    }
    #[inline(always)]
    fn bits(mask: BitMask) -> u8 {
        mask.0
    }
    intrinsics! {
        mul_add(self: Self, factor: Self, summand: Self) -> Self { Self(_mm512_fmadd_pd(self.0, factor.0, summand.0)) }
        sqrt(self: Self) -> Self { Self(_mm512_sqrt_pd(self.0)) }
    }
}
