//! Vectors of three numbers and their arithmetic.
//!
//! Only [`length`] works at any scale; the other functions may overflow or underflow.

pub use p2m_core::engine::arithmetic::cross;
pub use p2m_core::engine::vector::{V3, add, dot, largest, norm_squared, sub};

/// Returns the vector multiplied by a number.
pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| x * s)
}

/// Returns the length, without overflow or underflow of intermediate results.
pub fn length(a: V3) -> f64 {
    let size = largest(&[a]);
    if size > 0.0 && size.is_finite() { size * norm_squared(a.map(|x| x / size)).sqrt() } else { size }
}
