//! Neighbours of new tetrahedra.

use crate::delaunay::insert::{Insertion, MAX_LINKED_VERTICES};
use crate::delaunay::tetrahedron::{FACES, IN_CAVITY, NO_NEIGHBOUR, index_in};

/// The edge_index between two positions, in the table.
#[inline(always)]
fn edge_index(from: u8, to: u8) -> usize {
    usize::from(from) % MAX_LINKED_VERTICES * MAX_LINKED_VERTICES + usize::from(to) % MAX_LINKED_VERTICES
}

impl Insertion {
    /// two faces, which turn around it in opposite directions; whether there are positions for all.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "at most 124 faces and 64 vertices")]
    pub(crate) fn link(&mut self, site: u32) -> bool {
        if self.created.len() > 2 * MAX_LINKED_VERTICES - 4 {
            return false;
        }
        let mut count = 0;
        // Of each created tetrahedron, the positions of the vertices of its face.
        let mut positions = [[0u8; 3]; 2 * MAX_LINKED_VERTICES - 4];
        for (i, (positions, (&(_, face), &number))) in
            positions.iter_mut().zip(self.boundary.iter().zip(&self.created)).enumerate()
        {
            let vertices = self.tetrahedra[number as usize].vertices;
            for (boundary_index, k) in positions.iter_mut().zip(FACES[face as usize]) {
                let vertex = &mut self.sites[vertices[k] as usize];
                // Without branches.
                let new = vertex.last_insertion != site;
                vertex.boundary_index = if new { count } else { vertex.boundary_index };
                vertex.last_insertion = site;
                count += u32::from(new);
                *boundary_index = vertex.boundary_index as u8;
            }
            for k in 0..3 {
                self.edge_owners[edge_index(positions[k], positions[(k + 1) % 3])] = i as u8;
            }
        }
        for (positions, (&(_, face), &number)) in positions.iter().zip(self.boundary.iter().zip(&self.created)) {
            for k in 0..3 {
                let other = self.edge_owners[edge_index(positions[(k + 1) % 3], positions[k])];
                self.tetrahedra[number as usize].neighbours[FACES[face as usize][(k + 2) % 3]] =
                    self.created[usize::from(other)];
            }
        }
        true
    }

    /// The same for any number of faces, by turning around the edge_owners through the old tetrahedra.
    pub(crate) fn link_by_turning(&mut self) {
        for (&(t, face), &number) in self.boundary.iter().zip(&self.created) {
            for side in (0..4).filter(|&side| side != face as usize) {
                if self.tetrahedra[number as usize].neighbours[side] != NO_NEIGHBOUR {
                    continue;
                }
                // The edge_index and the vertex `pivot` make the face that is crossed, opposite to vertex `exit`.
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
