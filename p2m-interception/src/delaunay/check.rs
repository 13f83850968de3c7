//! Whether tetrahedra are a Delaunay triangulation, by exact predicates.

use crate::delaunay::tetrahedron::{BOUNDING, FACES};
use crate::delaunay::triangulation::Delaunay;
use p2m_core::predicates::{insphere, orientation_3d};
use std::cmp::Ordering;

/// What is wrong with a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Invalid {
    /// The lists of tetrahedra and of neighbours differ in length.
    #[error("{tetrahedra} tetrahedra, but the neighbours of {neighbours}")]
    Length {
        /// The length of one.
        tetrahedra: usize,
        /// And of the other.
        neighbours: usize,
    },
    /// A vertex that is no site, or no positive volume.
    #[error("tetrahedron {tetrahedron} is not positively oriented")]
    Orientation {
        /// The tetrahedron.
        tetrahedron: usize,
    },
    /// A neighbour that does not exist, has not the same face, or another neighbour there.
    #[error("tetrahedron {tetrahedron} and its neighbour opposite to vertex {vertex} do not share a face")]
    Neighbour {
        /// The tetrahedron.
        tetrahedron: usize,
        /// From 0 to 3.
        vertex: usize,
    },
    /// The vertex of a neighbour is inside the circumsphere.
    #[error("the neighbour of tetrahedron {tetrahedron} opposite to vertex {vertex} reaches into its sphere")]
    Sphere {
        /// The tetrahedron.
        tetrahedron: usize,
        /// From 0 to 3.
        vertex: usize,
    },
    /// The outer faces are not the eight of the octahedron.
    #[error("the outer faces are not those of the bounding sites")]
    CellPolytope,
    /// A site that is no vertex.
    #[error("site {site} is not a vertex of any tetrahedron")]
    Unused {
        /// The site.
        site: usize,
    },
}

impl Delaunay {
    /// Whether this is the Delaunay triangulation of the sites, exactly: all tetrahedra are positively oriented,
    /// neighbours share faces, no vertex of a neighbour is inside a sphere, the outer faces are those of the
    /// octahedron, and every site is a vertex.
    ///
    /// That is enough. The number of tetrahedra over a point off all faces does not change opposite_triangles inner faces, which
    /// have one on either side, so it is the same everywhere in the octahedron: one, as it is one next to an outer
    /// face, of which there are not two. So they fill it without overlap, and numbers of faces, edges and vertices obey
    /// Euler's formula. And where every face is locally Delaunay, all spheres are empty \[Delaunay1934\].
    ///
    /// # Errors
    /// The first thing that is wrong.
    ///
    /// # Complexity
    /// Linear, about as long as to build it.
    pub fn check(&self) -> Result<(), Invalid> {
        if self.tetrahedra.len() != self.neighbours.len() {
            let (tetrahedra, neighbours) = (self.tetrahedra.len(), self.neighbours.len());
            return Err(Invalid::Length { tetrahedra, neighbours });
        }
        let mut used = vec![false; self.sites.len()];
        let mut outer = [false; 8];
        for (i, vertices) in self.tetrahedra.iter().enumerate() {
            let orientation = Invalid::Orientation { tetrahedron: i };
            for v in vertices {
                *used.get_mut(*v as usize).ok_or(orientation)? = true;
            }
            let [a, b, c, d] = vertices.map(|v| self.sites[v as usize]);
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
                if insphere(a, b, c, d, self.sites[apex as usize]) == Ordering::Greater {
                    return Err(Invalid::Sphere { tetrahedron: i, vertex: k });
                }
            }
        }
        if outer.contains(&false) {
            return Err(Invalid::CellPolytope);
        }
        used.iter().position(|used| !used).map_or(Ok(()), |site| Err(Invalid::Unused { site }))
    }

    /// The vertex of the neighbour `next` of `i` that is not on the face, if it has the other three and `i` opposite.
    fn apex(&self, i: usize, face: [u32; 3], next: u32) -> Option<u32> {
        let vertices = self.tetrahedra.get(next as usize)?;
        let mut others = (0..4).filter(|&k| !face.contains(&vertices[k]));
        let k = others.next()?;
        let shared = face.iter().all(|v| vertices.contains(v));
        (shared && others.next().is_none() && self.neighbours[next as usize][k] as usize == i).then(|| vertices[k])
    }
}

/// Which face of the octahedron it is, if it has a site of each axis: bit k is set for the second one of axis k.
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
