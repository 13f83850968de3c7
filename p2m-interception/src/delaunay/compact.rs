//! The order of finished tetrahedra.

use crate::delaunay::tetrahedron::{NO_NEIGHBOUR, Tetrahedron};

/// Leaves out the positions of removed tetrahedra and sorts the others by the last of their vertices, so that what is near
/// on the curve is near in memory. Vertices and neighbours.
pub(crate) fn compact(tetrahedra: Vec<Tetrahedron>, sites: usize) -> (Vec<[u32; 4]>, Vec<[u32; 4]>) {
    let last_vertex = |t: &Tetrahedron| t.vertices.into_iter().fold(0, u32::max) as usize;
    let alive = |t: &Tetrahedron| t.vertices[0] != NO_NEIGHBOUR;
    // How many there are of each vertex, then where the next of them goes.
    let mut next = vec![0u32; sites];
    for t in tetrahedra.iter().filter(|t| alive(t)) {
        next[last_vertex(t)] += 1;
    }
    let mut total = 0;
    for n in &mut next {
        (*n, total) = (total, total + *n);
    }
    let mut positions = vec![NO_NEIGHBOUR; tetrahedra.len()];
    let mut vertices = vec![[0; 4]; total as usize];
    for (new_number, t) in positions.iter_mut().zip(&tetrahedra).filter(|(_, t)| alive(t)) {
        let next = &mut next[last_vertex(t)];
        *new_number = *next;
        vertices[*next as usize] = t.vertices;
        *next += 1;
    }
    let mut neighbours = vec![[NO_NEIGHBOUR; 4]; total as usize];
    for (new_number, t) in positions.iter().zip(&tetrahedra).filter(|(_, t)| alive(t)) {
        neighbours[*new_number as usize] =
            t.neighbours.map(|n| positions.get(n as usize).copied().unwrap_or(NO_NEIGHBOUR));
    }
    (vertices, neighbours)
}
