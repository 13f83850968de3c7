//! The final order of the tetrahedra.

use crate::delaunay::tetrahedron::{NO_NEIGHBOUR, Tetrahedron};

/// The vertices and the neighbours of tetrahedra, and the numbers that they had before.
pub(crate) type CompactTetrahedra = (Vec<[u32; 4]>, Vec<[u32; 4]>, Vec<u32>);

/// Removes the gaps of removed tetrahedra and sorts the others by the last of their vertices, so that tetrahedra near
/// each other on the curve are near in memory. It returns their vertices and neighbours.
///
/// `kept` has the vertices of the tetrahedra that existed before others were removed and created. The last vector has,
/// for each tetrahedron, its number among those, or [`NO_NEIGHBOUR`] if it is new. It is empty if `kept` is.
pub(crate) fn compact(tetrahedra: Vec<Tetrahedron>, sites: usize, kept: &[[u32; 4]]) -> CompactTetrahedra {
    let last_vertex = |t: &Tetrahedron| t.vertices.into_iter().fold(0, u32::max) as usize;
    let is_alive = |t: &Tetrahedron| t.vertices[0] != NO_NEIGHBOUR;
    // The vector first counts the tetrahedra of each last vertex, then has the number of the next one.
    let mut next = vec![0u32; sites];
    for t in tetrahedra.iter().filter(|t| is_alive(t)) {
        next[last_vertex(t)] += 1;
    }
    let mut total = 0;
    for n in &mut next {
        (*n, total) = (total, total + *n);
    }
    let mut new_numbers = vec![NO_NEIGHBOUR; tetrahedra.len()];
    let mut vertices = vec![[0; 4]; total as usize];
    for (new_number, t) in new_numbers.iter_mut().zip(&tetrahedra).filter(|(_, t)| is_alive(t)) {
        let next = &mut next[last_vertex(t)];
        *new_number = *next;
        vertices[*next as usize] = t.vertices;
        *next += 1;
    }
    let mut neighbours = vec![[NO_NEIGHBOUR; 4]; total as usize];
    for (new_number, t) in new_numbers.iter().zip(&tetrahedra).filter(|(_, t)| is_alive(t)) {
        neighbours[*new_number as usize] =
            t.neighbours.map(|n| new_numbers.get(n as usize).copied().unwrap_or(NO_NEIGHBOUR));
    }
    // A tetrahedron that was removed is never created again, because a site is inside of its sphere. So one with the
    // same number and the same vertices is the one of before.
    let mut old_numbers = vec![NO_NEIGHBOUR; if kept.is_empty() { 0 } else { total as usize }];
    for (old_number, (new_number, (t, old))) in (0..).zip(new_numbers.iter().zip(tetrahedra.iter().zip(kept))) {
        if t.vertices == *old {
            old_numbers[*new_number as usize] = old_number;
        }
    }
    (vertices, neighbours, old_numbers)
}
