//! Vector products in any arithmetic, such as f64 and double-double.

#![allow(clippy::inline_always, reason = "one expression; calls would hide it from the optimiser")]

use std::ops::{Add, Mul, Sub};

/// A number type with sums, differences and products.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Number for T {}

/// Returns the cross product.
#[inline(always)]
pub fn cross<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the dot product.
#[inline(always)]
pub fn dot<T: Number>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
