//! Lanes without any instruction set in particular: arrays, which compilers turn into what every processor has.

#![allow(clippy::needless_range_loop, reason = "several arrays side by side")]

use super::{Doubles, EightLanes, InstructionSet, Lanes};

/// Eight lanes in an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eight([f32; 8]);

/// Eight f64 in an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EightDoubles([f64; 8]);

/// The reference that other instruction sets are tested against, and what runs where there is no other.
pub(crate) struct Portable;

impl InstructionSet for Portable {
    type Eight = Eight;
    type Wide = Eight;
    type Doubles = EightDoubles;
}

impl Eight {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut result = [0.0; 8];
        for i in 0..8 {
            result[i] = f(self.0[i], other.0[i]);
        }
        Self(result)
    }
}

impl Lanes for Eight {
    const LEN: usize = 8;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let mut lanes = [0.0; 8];
        lanes.copy_from_slice(&from[..8]);
        Self(lanes)
    }
    #[inline(always)]
    fn load_u16(from: &[u16]) -> Self {
        let mut lanes = [0.0; 8];
        for (lane, x) in lanes.iter_mut().zip(&from[..8]) {
            *lane = f32::from(*x);
        }
        Self(lanes)
    }
    #[inline(always)]
    fn load_u8(from: &[u8]) -> Self {
        let mut lanes = [0.0; 8];
        for (lane, x) in lanes.iter_mut().zip(&from[..8]) {
            *lane = f32::from(*x);
        }
        Self(lanes)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..8].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        // Rounded twice: a fused operation would be a call where the processor has none.
        self.mul(factor).add(summand)
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest, as promised")]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let mut result = [0.0; 8];
        for i in 0..8 {
            let [a, b, c, d] = [a.0[i], b.0[i], c.0[i], d.0[i]].map(f64::from);
            // Products of two f32 are exact, and so is the difference under the condition of the trait.
            result[i] = (a * b - c * d) as f32;
        }
        Self(result)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        self.zip(self, |a, _| 1.0 / a)
    }
    #[inline(always)]
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self {
        let mut result = [0.0; 8];
        for i in 0..8 {
            result[i] = if self.0[i] < limit.0[i] { yes.0[i] } else { no.0[i] };
        }
        Self(result)
    }
    #[inline(always)]
    fn at_most(self, limit: Self) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(self.0[i] <= limit.0[i]) << i)
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, |a, b| if b < a { b } else { a })
    }
}

impl EightLanes for Eight {
    #[inline(always)]
    fn sorted_keys(self, limit: f32, keys: &mut [u32; 8]) -> usize {
        *keys = [0; 8];
        let mut count = 0;
        for (lane, x) in (0u32..).zip(self.0) {
            if x <= limit {
                let key = x.to_bits() & !15 | 8 | lane;
                let mut place = count;
                while place > 0 && keys[place - 1] < key {
                    keys[place] = keys[place - 1];
                    place -= 1;
                }
                keys[place] = key;
                count += 1;
            }
        }
        count
    }
}

impl EightDoubles {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = [0.0; 8];
        for i in 0..8 {
            result[i] = f(self.0[i], other.0[i]);
        }
        Self(result)
    }
}

impl Doubles for EightDoubles {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let mut lanes = [0.0; 8];
        lanes.copy_from_slice(&from[..8]);
        Self(lanes)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[..8].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self.mul(factor).zip(summand, |a, b| a + b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.zip(self, |a, _| a.sqrt())
    }
    #[inline(always)]
    fn if_at_most(self, limit: Self, yes: Self, no: Self) -> Self {
        let mut result = [0.0; 8];
        for i in 0..8 {
            result[i] = if self.0[i] <= limit.0[i] { yes.0[i] } else { no.0[i] };
        }
        Self(result)
    }
    #[inline(always)]
    fn at_most(self, limit: Self) -> u8 {
        (0..8).fold(0, |mask, i| mask | u8::from(self.0[i] <= limit.0[i]) << i)
    }
}
