//! Caps that close a surface along its boundary.
//!
//! The boundary of a set of triangles consists of closed polygons, since as many of its directed edges end at a vertex
//! as start there. Triangles are spanned in each polygon, with the boundary run through in the other direction. The
//! surface and its caps are closed together. So their winding number is an integer, which a ray decides without
//! rounding, and the winding number of the surface is that integer less the winding number of the caps:
//!
//! ```text
//! w(surface) = crossings(surface) + crossings(caps) - w(caps)
//! ```
//!
//! A mesh with holes has few caps. A soup of separate triangles has as many caps as triangles, namely the triangles
//! themselves, turned over. The identity holds for caps of any shape, also where they intersect the surface.

use super::surface::Surface;
use nalgebra::Point3;
use p2m_core::Soup;

/// Marks a vertex that is not on the path.
const NONE: u32 = u32::MAX;

/// Returns the triangles that close a surface, or none if it is closed.
#[allow(clippy::cast_possible_truncation, reason = "the boundary has at most three edges for each triangle")]
pub(super) fn caps(soup: &Soup<f64>, surface: &Surface) -> Soup<f64> {
    // The vertices of the boundary get numbers of their own.
    let mut vertices: Vec<u32> = surface.boundary.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let number = |vertex: u32| vertices.binary_search(&vertex).map_or(NONE, |i| i as u32);
    let mut positions = vec![Point3::origin(); vertices.len()];
    for (position, vertex) in soup.positions().iter().zip(&surface.welder.vertex_ids) {
        if let Ok(i) = vertices.binary_search(vertex) {
            positions[i] = *position;
        }
    }
    // Caps run through the boundary in the other direction.
    let mut edges: Vec<[u32; 2]> = surface.boundary.iter().map(|[from, to]| [number(*to), number(*from)]).collect();
    edges.sort_unstable();
    let mut triangles = Vec::with_capacity(edges.len());
    for polygon in polygons(vertices.len(), &edges) {
        span(&polygon, &mut triangles);
    }
    Soup::from_triangles(positions, triangles).expect("the vertices are those of the positions")
}

/// Divides sorted directed edges, of which as many end at each vertex as start there, into closed
/// polygons without repeated vertices.
#[allow(clippy::cast_possible_truncation, reason = "the boundary has at most three edges for each triangle")]
fn polygons(vertex_count: usize, edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    // The unused edges of each vertex are `next[vertex]..ends[vertex]`.
    let mut next: Vec<usize> =
        (0..vertex_count).map(|v| edges.partition_point(|edge| (edge[0] as usize) < v)).collect();
    let ends: Vec<usize> = next.iter().skip(1).copied().chain([edges.len()]).collect();
    let mut step_of = vec![NONE; vertex_count];
    let (mut polygons, mut path) = (Vec::new(), Vec::new());
    for start in 0..vertex_count {
        let mut vertex = start;
        // A path that cannot go on has returned to its start.
        while next[vertex] < ends[vertex] {
            step_of[vertex] = path.len() as u32;
            path.push(vertex as u32);
            let edge = edges[next[vertex]];
            next[vertex] += 1;
            vertex = edge[1] as usize;
            if step_of[vertex] != NONE {
                let polygon = path.split_off(step_of[vertex] as usize);
                polygon.iter().for_each(|v| step_of[*v as usize] = NONE);
                polygons.push(polygon);
            }
        }
    }
    polygons
}

/// Triangulates a polygon by halving it again and again, so that most triangles are small and near the boundary.
fn span(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [first, .., last] = *polygon
        && polygon.len() > 2
    {
        let middle = polygon.len() / 2;
        triangles.push([first, polygon[middle], last]);
        span(&polygon[..=middle], triangles);
        span(&polygon[middle..], triangles);
    }
}
