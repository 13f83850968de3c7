//! Three numbers and what is computed from them, without care for the range but in [`length`].

pub type V3 = [f64; 3];

pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| x * s)
}

pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm_squared(a: V3) -> f64 {
    dot(a, a)
}

/// The magnitude of the largest component of several.
pub fn largest(vectors: &[V3]) -> f64 {
    vectors.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()))
}

/// The length at any scale.
pub fn length(a: V3) -> f64 {
    let size = largest(&[a]);
    if size > 0.0 && size.is_finite() { size * norm_squared(a.map(|x| x / size)).sqrt() } else { size }
}
