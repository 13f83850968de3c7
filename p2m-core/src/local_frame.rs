//! The local frame of a primitive, in which its distance from many points is fast to compute.

use crate::kernel::arithmetic::cross;
use crate::kernel::vector::{V3, add_scaled, dot, larger, norm_squared, power_of_two, sub};

/// The square of 2^-450, below which a vector counts as zero, because its square loses digits to underflow.
const MIN_SQUARED_LENGTH: f64 = power_of_two(-900);

/// The local frame of a point, a segment or a triangle.
///
/// The longest edge lies on the first axis, and a triangle lies in the plane of the first two axes. The axes are
/// orthonormal within a few u for any shape. If the third vertex is too near to the longest edge to determine a
/// direction, it is as near to the plane of any direction.
#[derive(Clone, Copy, Debug)]
pub struct LocalFrame {
    /// The vertex that is the origin of the frame.
    pub origin: V3,
    /// The axes, of length 1.
    pub axes: [V3; 3],
    /// The length of the longest edge, which runs from the origin along the first axis; 0 if all vertices are equal.
    pub length: f64,
    /// The third vertex of a triangle in the plane of the first two axes; the origin for other primitives.
    pub apex: [f64; 2],
}

impl LocalFrame {
    /// Returns the frame of a primitive with one to three vertices.
    ///
    /// # Panics
    /// Panics if there are no vertices.
    #[must_use]
    pub fn new(vertices: &[V3]) -> Self {
        let n = vertices.len();
        let edge = |i: usize| sub(vertices[(i + 1) % n], vertices[i]);
        // A segment has one edge, from its first vertex.
        let edges = if n == 3 { 3 } else { 1 };
        let longest = (0..edges).max_by(|i, j| norm_squared(edge(*i)).total_cmp(&norm_squared(edge(*j)))).unwrap_or(0);
        let origin = vertices[longest];
        let Some(first) = normalized(edge(longest)) else {
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            return Self { origin, axes, length: 0.0, apex: [0.0; 2] };
        };
        let third = if n == 3 { sub(vertices[(longest + 2) % 3], origin) } else { [0.0; 3] };
        // The component of the third vertex perpendicular to the first axis is accurate to a few u of the vertex, so
        // its direction leaves the vertex in the plane within a few u. A second projection makes it perpendicular to a
        // few u as well. If it is far from perpendicular at first, it consists of rounding errors, and any direction
        // will do.
        let height = add_scaled(third, -dot(third, first), first);
        let second = normalized(height)
            .filter(|v| dot(*v, first).abs() < 0.5)
            .and_then(|v| normalized(add_scaled(v, -dot(v, first), first)))
            .unwrap_or_else(|| perpendicular(first));
        let apex = [dot(third, first), larger(dot(third, second), 0.0)];
        let length = norm_squared(edge(longest)).sqrt();
        Self { origin, axes: [first, second, cross(first, second)], length, apex }
    }
}

/// Returns a unit vector that is perpendicular to a unit vector.
fn perpendicular(axis: V3) -> V3 {
    let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    normalized(add_scaled(other, -dot(other, axis), axis)).unwrap_or(other)
}

/// Returns a vector scaled to unit length, or `None` if it counts as zero.
fn normalized(v: V3) -> Option<V3> {
    let square = norm_squared(v);
    (square >= MIN_SQUARED_LENGTH).then(|| v.map(|x| x / square.sqrt()))
}
