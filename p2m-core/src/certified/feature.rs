//! Features of primitives, which are given by their vertices.

use crate::Feature;
use crate::kernel::vector::V3;

/// The unit roundoff of f64.
pub(super) const U: f64 = f64::EPSILON / 2.0;

/// Returns the two ends of edge i of a primitive.
pub(super) fn ends(i: u8, vertices: &[V3]) -> [V3; 2] {
    let i = usize::from(i);
    [vertices[i], vertices[(i + 1) % vertices.len()]]
}

/// Returns whether a primitive with this number of vertices has this feature.
pub(super) fn exists(feature: Feature, vertex_count: usize) -> bool {
    match feature {
        Feature::Vertex(i) => usize::from(i) < vertex_count,
        Feature::Edge(i) => usize::from(i) + 1 < vertex_count || vertex_count == 3 && i == 2,
        Feature::Face => vertex_count == 3,
    }
}
