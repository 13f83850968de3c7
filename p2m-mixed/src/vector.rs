//! Vectors of three numbers and their arithmetic.
//!
//! Only [`length`] works at any scale; the other functions may overflow or underflow.

/// A vector or a position.
pub type V3 = [f64; 3];

/// Returns a - b.
pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a + b.
pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns the vector multiplied by a number.
pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| x * s)
}

/// Returns the dot product.
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the cross product.
pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the squared length.
pub fn norm_squared(a: V3) -> f64 {
    dot(a, a)
}

/// Returns the largest magnitude of a component of any of the vectors.
pub fn largest(vectors: &[V3]) -> f64 {
    vectors.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()))
}

/// Returns the length, without overflow or underflow of intermediate results.
pub fn length(a: V3) -> f64 {
    let size = largest(&[a]);
    if size > 0.0 && size.is_finite() { size * norm_squared(a.map(|x| x / size)).sqrt() } else { size }
}
