//! The links between the new tetrahedra of an insertion.

use crate::delaunay::insert::{Insertion, MAX_LINKED_VERTICES};
use crate::delaunay::tetrahedron::{FACES, IN_CAVITY, NO_NEIGHBOUR, index_in};

/// Returns the index of an edge in the table, given the boundary indices of its ends.
#[inline(always)]
fn edge_index(from: u8, to: u8) -> usize {
    usize::from(from) % MAX_LINKED_VERTICES * MAX_LINKED_VERTICES + usize::from(to) % MAX_LINKED_VERTICES
}

impl Insertion {
    /// Links the new tetrahedra that share an edge of faces around the cavity. Every such edge belongs to two faces,
    /// which run along it in opposite directions. The result is `false`, and nothing is linked, if the faces have more
    /// vertices than the table.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "at most 124 faces and 64 vertices")]
    pub(crate) fn link(&mut self, site: u32) -> bool {
        if self.created.len() > 2 * MAX_LINKED_VERTICES - 4 {
            return false;
        }
        let mut count = 0;
        // For each created tetrahedron the boundary indices of the vertices of its face.
        let mut boundary_indices = [[0u8; 3]; 2 * MAX_LINKED_VERTICES - 4];
        for (i, (boundary_indices, (&(_, face), &number))) in
            boundary_indices.iter_mut().zip(self.boundary.iter().zip(&self.created)).enumerate()
        {
            let vertices = self.tetrahedra[number as usize].vertices;
            for (boundary_index, k) in boundary_indices.iter_mut().zip(FACES[face as usize]) {
                let vertex = &mut self.sites[vertices[k] as usize];
                // The branch-free form is faster, because new vertices cannot be predicted.
                let is_new = vertex.last_insertion != site;
                vertex.boundary_index = if is_new { count } else { vertex.boundary_index };
                vertex.last_insertion = site;
                count += u32::from(is_new);
                *boundary_index = vertex.boundary_index as u8;
            }
            for k in 0..3 {
                self.edge_owners[edge_index(boundary_indices[k], boundary_indices[(k + 1) % 3])] = i as u8;
            }
        }
        for (boundary_indices, (&(_, face), &number)) in
            boundary_indices.iter().zip(self.boundary.iter().zip(&self.created))
        {
            for k in 0..3 {
                let other = self.edge_owners[edge_index(boundary_indices[(k + 1) % 3], boundary_indices[k])];
                self.tetrahedra[number as usize].neighbours[FACES[face as usize][(k + 2) % 3]] =
                    self.created[usize::from(other)];
            }
        }
        true
    }

    /// Links the new tetrahedra for any number of faces, by turning around each edge through the old tetrahedra.
    pub(crate) fn link_by_turning(&mut self) {
        for (&(t, face), &number) in self.boundary.iter().zip(&self.created) {
            for side in (0..4).filter(|&side| side != face as usize) {
                if self.tetrahedra[number as usize].neighbours[side] != NO_NEIGHBOUR {
                    continue;
                }
                // The edge and the vertex `pivot` span the face that is crossed next, which is opposite to vertex
                // `exit`.
                let (mut at, mut exit, mut pivot) = (t, side, face as usize);
                let other = loop {
                    let old = &self.tetrahedra[at as usize];
                    let next = old.neighbours[exit];
                    let vertex = old.vertices[pivot] & !IN_CAVITY;
                    let old = &self.tetrahedra[next as usize];
                    if old.vertices[0] & IN_CAVITY == 0 {
                        break next;
                    }
                    (exit, pivot, at) = (index_in(&old.vertices, vertex), index_in(&old.neighbours, at), next);
                };
                self.tetrahedra[number as usize].neighbours[side] = other;
                self.tetrahedra[other as usize].neighbours[pivot] = number;
            }
        }
    }
}
