//! Traits of SIMD vectors, of instruction sets, and of the kernels that are compiled for each instruction set.

use crate::kernel::arithmetic::Number;
use std::ops::{BitAnd, BitOr, Div, Neg, Not};

/// A SIMD vector of `f32`.
///
/// Addition, subtraction and multiplication round to nearest; [`mul_add`](Self::mul_add) rounds once or twice.
pub trait Lanes: Copy {
    /// The number of lanes.
    const LEN: usize;
    /// Whether long computations are inlined into each search. The portable lanes are compiled out of line instead on
    /// processors with faster lanes, because their code is several times as long as the others'.
    const INLINES: bool = true;
    /// Returns `x` in every lane.
    fn splat(x: f32) -> Self;
    /// Loads the first [`LEN`](Self::LEN) values of a slice, which must have at least that many.
    fn load(from: &[f32]) -> Self;
    /// Loads the first [`LEN`](Self::LEN) u16 values of a slice, converted to f32.
    fn load_u16(from: &[u16]) -> Self;
    /// Loads the first [`LEN`](Self::LEN) u8 values of a slice, converted to f32.
    fn load_u8(from: &[u8]) -> Self;
    /// Writes the lanes to the front of a slice.
    fn store(self, to: &mut [f32]);
    /// Returns self + other.
    fn add(self, other: Self) -> Self;
    /// Returns self - other.
    fn sub(self, other: Self) -> Self;
    /// Returns self * other.
    fn mul(self, other: Self) -> Self;
    /// Returns self * factor + summand.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Returns the square root, rounded to nearest.
    fn sqrt(self) -> Self;
    /// Returns a b - c d with a relative error of at most 2^-22, provided that both products are integers times the
    /// same power of two, and below 2^48 times that power.
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// Returns the smaller value, or `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the larger value, or `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// Returns 1 / self with a relative error of at most 2^-22 for normal results. For 0 and for numbers that are not
    /// finite the result is unspecified.
    fn reciprocal(self) -> Self;
    /// Selects `yes` where self < limit, and `no` where it is not or either is NaN.
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Returns one bit per lane, the first lane lowest: whether self <= limit. It is 0 if either is NaN.
    fn at_most(self, limit: Self) -> u32;
    /// Returns the smallest value of all lanes, none of which may be NaN.
    fn smallest(self) -> f32;
}

/// A SIMD vector of eight `f32`, which can be sorted.
pub trait EightLanes: Lanes {
    /// Sorts the lanes that are at most `limit`: writes them as keys in descending order to the front of `keys`, sets
    /// the other keys to 0, and returns the number of these lanes. No lane may be negative.
    ///
    /// A key consists of the bits of the value, with the lowest four replaced by 8 + lane. So keys are ordered as their
    /// values are, and [`value_of_key`] is at most 15 units in the last place too small.
    fn sorted_keys(self, limit: f32, keys: &mut [u32; 8]) -> usize;
}

/// A scalar `f64` or a SIMD vector of them.
///
/// The operators and methods of this trait round every lane to nearest, as those of `f64` do. So a formula that is
/// generic over this trait has the same bits in a lane as for a single number.
pub trait Float: Number + Div<Output = Self> + Neg<Output = Self> {
    /// A mask: a truth value for each lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;
    /// Returns `x` in every lane.
    fn splat(x: f64) -> Self;
    /// Returns the magnitude.
    fn abs(self) -> Self;
    /// Returns self where self < other, and `other` where it is not or either is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns self where self > other, and `other` where it is not or either is NaN.
    fn max(self, other: Self) -> Self;
    /// Returns whether self < other. It is false if either is NaN.
    fn is_below(self, other: Self) -> Self::Mask;
    /// Returns whether self <= other. It is false if either is NaN.
    fn is_at_most(self, other: Self) -> Self::Mask;
    /// Returns whether self == other. It is false if either is NaN.
    fn equals(self, other: Self) -> Self::Mask;
    /// Selects `yes` where the mask is true, and `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

impl Float for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn is_at_most(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "ties are equality of bits")]
    fn equals(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// A SIMD vector of eight `f64`.
pub trait Doubles: Float {
    /// Loads the first eight values of a slice, which must have at least that many.
    fn load(from: &[f64]) -> Self;
    /// Writes the lanes to the front of a slice.
    fn store(self, to: &mut [f64]);
    /// Loads the first eight values of a slice of f32, which must have at least that many.
    fn load_f32(from: &[f32]) -> Self;
    /// Writes the lanes to the front of a slice, rounded to f32.
    fn store_f32(self, to: &mut [f32]);
    /// Returns self * factor + summand, rounded once or twice.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Returns the square root, rounded to nearest.
    fn sqrt(self) -> Self;
    /// Selects `yes` where self <= limit, and `no` where it is not or either is NaN.
    #[inline(always)]
    fn if_at_most(self, limit: Self, yes: Self, no: Self) -> Self {
        Self::select(self.is_at_most(limit), yes, no)
    }
    /// Returns one bit per lane, the first lane lowest: whether self <= limit. It is 0 if either is NaN.
    #[inline(always)]
    fn at_most(self, limit: Self) -> u8 {
        Self::bits(self.is_at_most(limit))
    }
    /// Returns one bit per lane of a mask, the first lane lowest.
    fn bits(mask: Self::Mask) -> u8;
}

/// Returns a lower bound on the value of a key.
#[inline(always)]
pub fn value_of_key(key: u32) -> f32 {
    f32::from_bits(key & !15)
}

/// Returns the lane of a key.
#[inline(always)]
pub fn lane_of_key(key: u32) -> usize {
    (key & 7) as usize
}

/// An instruction set, as a set of SIMD vector types.
pub trait InstructionSet {
    /// The type of eight f32.
    type F32x8: EightLanes;
    /// The type of eight or sixteen f32, whichever is faster with the instruction set.
    type Wide: Lanes;
    /// The type of eight f64.
    type Doubles: Doubles;
    /// Runs a kernel from another one, out of line. Only a kernel that is run with this instruction set may call it.
    fn call<K: SimdKernel>(kernel: K) -> K::Output;
}

/// A computation that is compiled for each instruction set.
///
/// [`run`](Self::run) and everything that it calls must be `#[inline(always)]`, since a function that is not inlined is
/// compiled without the instruction set.
pub trait SimdKernel {
    /// The type of the result.
    type Output;
    /// Runs the computation with the vector types of an instruction set.
    fn run<I: InstructionSet>(self) -> Self::Output;
}

/// Runs a function that is not inlined into the caller.
#[inline(never)]
pub fn out_of_line<R>(run: impl FnOnce() -> R) -> R {
    run()
}
