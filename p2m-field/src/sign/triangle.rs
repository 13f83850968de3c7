//! The geometry of one triangle of a surface.

use p2m_core::Soup;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, dot, largest, length, scaled, sub};

/// The bound on two rounding errors, 32 u: of an offset, in units of the magnitude of the numbers from which it was
/// computed, and of a solid angle over 4 pi, where the terms of its tangent do not cancel.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// The smallest sine of a triangle that is no sliver: 2^-16. It is the length of the cross product of two edges,
/// relative to the square of their largest component.
pub(super) const MIN_SINE: f64 = 1.0 / (1 << 16) as f64;

pub(super) fn corners(soup: &Soup<f64>, triangle: [u32; 3]) -> [V3; 3] {
    triangle.map(|i| soup.positions()[i as usize].into())
}

/// Returns the unit normal of a triangle, or `None` if the triangle is a sliver.
pub(super) fn unit_normal(corners: [V3; 3]) -> Option<V3> {
    let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
    let size = largest(&edges);
    let normal = cross(edges[0], edges[1]);
    let length = dot(normal, normal).sqrt();
    // A length of NaN is not above the smallest sine, so it gives `None`.
    (length > MIN_SINE * size * size).then(|| scaled(normal, 1.0 / length))
}

/// Returns the angle at corner `i` of a triangle.
pub(super) fn angle(corners: [V3; 3], i: usize) -> f64 {
    let [e, f] = [1, 2].map(|k| unit(sub(corners[(i + k) % 3], corners[i])));
    length(cross(e, f)).atan2(dot(e, f))
}

/// Returns a vector with the length 1, or zero for zero and for vectors without a finite length.
pub(super) fn unit(vector: V3) -> V3 {
    let length = length(vector);
    if length > 0.0 && length.is_finite() { vector.map(|x| x / length) } else { [0.0; 3] }
}
