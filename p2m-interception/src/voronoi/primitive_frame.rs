//! The directions and proportions of primitives, which the tests of feature relevance need.

use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The directions and proportions of a primitive that the tests need.
#[derive(Clone, Copy, Default)]
pub(crate) struct PrimitiveFrame {
    /// The directions from each vertex to the next one.
    pub(crate) edge_directions: [V3; 3],
    /// The directions from each side into the triangle.
    pub(crate) inward_normals: [V3; 3],
    /// The least height of a triangle or the length of a segment. It is infinite for a point, which cannot be thin.
    pub(crate) height: f64,
    /// The height as a part of the longest edge. It is 1 for segments and points.
    pub(crate) sine: f64,
}

impl PrimitiveFrame {
    /// Computes the frame of a primitive with one to three vertices.
    pub(crate) fn from_vertices(vertices: &[V3]) -> Self {
        let mut frame = Self { height: f64::INFINITY, sine: 1.0, ..Self::default() };
        if vertices.len() < 2 {
            return frame;
        }
        let offset = |i: usize| sub(vertices[(i + 1) % vertices.len()], vertices[i]);
        (0..vertices.len()).for_each(|i| frame.edge_directions[i] = normalized(offset(i)));
        let length = |i: usize| norm_squared(offset(i)).sqrt();
        if vertices.len() == 2 {
            frame.height = length(0);
            return frame;
        }
        let normal = cross(offset(0), sub(vertices[2], vertices[0]));
        frame.height = norm_squared(normal).sqrt() / length(0).max(length(1)).max(length(2));
        frame.sine = frame.height / length(0).max(length(1)).max(length(2));
        (0..3).for_each(|i| frame.inward_normals[i] = cross(normalized(normal), frame.edge_directions[i]));
        frame
    }
}

/// Returns the direction of a vector, or zero if the vector is zero.
pub(crate) fn normalized(d: V3) -> V3 {
    let length = norm_squared(d).sqrt();
    if length > 0.0 { d.map(|x| x / length) } else { [0.0; 3] }
}
