//! The check of a triangulation by exact predicates.

use crate::delaunay::tetrahedron::{BOUNDING, FACES};
use crate::delaunay::triangulation::Delaunay;
use p2m_core::predicates::{insphere, orientation_3d};
use std::cmp::Ordering;

/// The first fault of a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Invalid {
    /// The lists of tetrahedra and of neighbours have different lengths.
    #[error("{tetrahedra} tetrahedra, but the neighbours of {neighbours}")]
    Length {
        /// The number of tetrahedra.
        tetrahedra: usize,
        /// The number of entries in the list of neighbours.
        neighbours: usize,
    },
    /// A vertex is not a site, or the volume is not positive.
    #[error("tetrahedron {tetrahedron} is not positively oriented")]
    Orientation {
        /// The number of the tetrahedron.
        tetrahedron: usize,
    },
    /// A neighbour does not exist, does not have the same face, or has another neighbour there.
    #[error("tetrahedron {tetrahedron} and its neighbour opposite to vertex {vertex} do not share a face")]
    Neighbour {
        /// The number of the tetrahedron.
        tetrahedron: usize,
        /// The index of the vertex, from 0 to 3.
        vertex: usize,
    },
    /// A vertex of a neighbour is inside of the circumsphere.
    #[error("the neighbour of tetrahedron {tetrahedron} opposite to vertex {vertex} reaches into its sphere")]
    Sphere {
        /// The number of the tetrahedron.
        tetrahedron: usize,
        /// The index of the vertex, from 0 to 3.
        vertex: usize,
    },
    /// The outer faces are not the eight faces of the octahedron.
    #[error("the outer faces are not those of the bounding sites")]
    CellPolytope,
    /// A site is not a vertex of any tetrahedron.
    #[error("site {site} is not a vertex of any tetrahedron")]
    Unused {
        /// The number of the site.
        site: usize,
    },
}

impl Delaunay {
    /// Checks exactly whether this is the Delaunay triangulation of the sites. All tetrahedra have to be positively
    /// oriented, neighbours have to share faces, no vertex of a neighbour may be inside of a sphere, the outer faces
    /// have to be the faces of the octahedron, and every site has to be a vertex.
    ///
    /// These conditions suffice. Consider the number of tetrahedra over a point that is on no face. It does not change
    /// across inner faces, which have one tetrahedron on either side, so it is the same everywhere in the octahedron.
    /// It is one next to an outer face, as no outer face occurs twice. So the tetrahedra fill the octahedron without
    /// overlap, and the numbers of faces, edges and vertices satisfy Euler's formula. Where every face is locally
    /// Delaunay, all spheres are empty \[Delaunay1934\].
    ///
    /// # Errors
    ///
    /// It returns the first fault that it finds.
    ///
    /// # Complexity
    ///
    /// The time is linear, and about as long as building the triangulation takes.
    pub fn check(&self) -> Result<(), Invalid> {
        if self.tetrahedra.len() != self.neighbours.len() {
            let (tetrahedra, neighbours) = (self.tetrahedra.len(), self.neighbours.len());
            return Err(Invalid::Length { tetrahedra, neighbours });
        }
        let mut used = vec![false; self.sites().len()];
        let mut outer = [false; 8];
        for (i, vertices) in self.tetrahedra.iter().enumerate() {
            let orientation = Invalid::Orientation { tetrahedron: i };
            for v in vertices {
                *used.get_mut(*v as usize).ok_or(orientation)? = true;
            }
            let [a, b, c, d] = vertices.map(|v| self.sites()[v as usize]);
            if orientation_3d(a, b, c, d) != Ordering::Greater {
                return Err(orientation);
            }
            for (k, next) in self.neighbours[i].into_iter().enumerate() {
                let face = FACES[k].map(|v| vertices[v]);
                if next == Self::NONE {
                    let octant = octant(face).ok_or(Invalid::CellPolytope)?;
                    if std::mem::replace(&mut outer[octant], true) {
                        return Err(Invalid::CellPolytope);
                    }
                    continue;
                }
                let apex = self.apex(i, face, next).ok_or(Invalid::Neighbour { tetrahedron: i, vertex: k })?;
                if insphere(a, b, c, d, self.sites()[apex as usize]) == Ordering::Greater {
                    return Err(Invalid::Sphere { tetrahedron: i, vertex: k });
                }
            }
        }
        if outer.contains(&false) {
            return Err(Invalid::CellPolytope);
        }
        used.iter().position(|used| !used).map_or(Ok(()), |site| Err(Invalid::Unused { site }))
    }

    /// Returns the vertex of the neighbour `next` of `i` that is not on the face. It is `None` if `next` does not have
    /// the whole face, or does not have `i` opposite to that vertex.
    fn apex(&self, i: usize, face: [u32; 3], next: u32) -> Option<u32> {
        let vertices = self.tetrahedra.get(next as usize)?;
        let mut others = (0..4).filter(|&k| !face.contains(&vertices[k]));
        let k = others.next()?;
        let shared = face.iter().all(|v| vertices.contains(v));
        (shared && others.next().is_none() && self.neighbours[next as usize][k] as usize == i).then(|| vertices[k])
    }
}

/// Returns which face of the octahedron has these vertices. Bit k is set for the upper site of axis k. It is `None` if
/// the face does not have a bounding site of each axis.
fn octant(face: [u32; 3]) -> Option<usize> {
    let mut axes = [None; 3];
    for v in face {
        if v as usize >= BOUNDING {
            return None;
        }
        axes[v as usize / 2] = Some(v as usize % 2);
    }
    Some(axes[0]? | axes[1]? << 1 | axes[2]? << 2)
}
