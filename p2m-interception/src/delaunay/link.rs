//! Neighbours of new tetrahedra.

use crate::delaunay::insert::{Insertion, PLACES};
use crate::delaunay::tetrahedron::{FACES, INSIDE, NO_NEIGHBOUR, position};

/// The edge between two places, in the table.
#[inline(always)]
fn edge(from: u8, to: u8) -> usize {
    usize::from(from) % PLACES * PLACES + usize::from(to) % PLACES
}

impl Insertion {
    /// two faces, which turn around it in opposite directions; whether there are places for all.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "at most 124 faces and 64 vertices")]
    pub(crate) fn link(&mut self, site: u32) -> bool {
        if self.created.len() > 2 * PLACES - 4 {
            return false;
        }
        let mut count = 0;
        // Of each created tetrahedron, the places of the vertices of its face.
        let mut places = [[0u8; 3]; 2 * PLACES - 4];
        for (i, (places, (&(_, face), &number))) in
            places.iter_mut().zip(self.boundary.iter().zip(&self.created)).enumerate()
        {
            let vertices = self.tetrahedra[number as usize].vertices;
            for (place, k) in places.iter_mut().zip(FACES[face as usize]) {
                let vertex = &mut self.sites[vertices[k] as usize];
                // Without branches.
                let new = vertex.round != site;
                vertex.place = if new { count } else { vertex.place };
                vertex.round = site;
                count += u32::from(new);
                *place = vertex.place as u8;
            }
            for k in 0..3 {
                self.edges[edge(places[k], places[(k + 1) % 3])] = i as u8;
            }
        }
        for (places, (&(_, face), &number)) in places.iter().zip(self.boundary.iter().zip(&self.created)) {
            for k in 0..3 {
                let other = self.edges[edge(places[(k + 1) % 3], places[k])];
                self.tetrahedra[number as usize].neighbours[FACES[face as usize][(k + 2) % 3]] =
                    self.created[usize::from(other)];
            }
        }
        true
    }

    /// The same for any number of faces, by turning around the edges through the old tetrahedra.
    pub(crate) fn link_by_turning(&mut self) {
        for (&(t, face), &number) in self.boundary.iter().zip(&self.created) {
            for side in (0..4).filter(|&side| side != face as usize) {
                if self.tetrahedra[number as usize].neighbours[side] != NO_NEIGHBOUR {
                    continue;
                }
                // The edge and the vertex `pivot` make the face that is crossed, opposite to vertex `exit`.
                let (mut at, mut exit, mut pivot) = (t, side, face as usize);
                let other = loop {
                    let old = &self.tetrahedra[at as usize];
                    let next = old.neighbours[exit];
                    let vertex = old.vertices[pivot] & !INSIDE;
                    let old = &self.tetrahedra[next as usize];
                    if old.vertices[0] & INSIDE == 0 {
                        break next;
                    }
                    (exit, pivot, at) = (position(&old.vertices, vertex), position(&old.neighbours, at), next);
                };
                self.tetrahedra[number as usize].neighbours[side] = other;
                self.tetrahedra[other as usize].neighbours[pivot] = number;
            }
        }
    }
}
