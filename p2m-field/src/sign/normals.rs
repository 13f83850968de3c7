//! The normals of a surface at its closest points.

use super::surface::Surface;
use super::triangle::{angle, corners, unit};
use nalgebra::Vector3;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, add, dot, scaled, sub};
use p2m_core::{Feature, PrimitiveId, Soup};

/// The normals of the triangles of a scene at their faces, edges and vertices.
///
/// The normal of a face is (b - a) x (c - a). The normal of an edge is the sum of the normals of its triangles. The
/// normal of a vertex is the sum of the normals of all triangles around it, each multiplied by its angle there. All of
/// them are scaled to the length 1; they are the pseudonormals of \[Baerentzen2005\]. Vertices are welded where they
/// have the same coordinates. Triangles without area count as nothing.
///
/// ```
/// use p2m_core::{Feature, PrimitiveId, Soup};
/// use p2m_field::sign::Normals;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let soup: Soup<f64> = Soup::from_arrays(&corners, &[[0u32, 1, 2]])?;
/// let normals = Normals::new(&soup);
/// assert_eq!(normals.at(PrimitiveId::new(0), Feature::Face), Some([0.0, 0.0, 1.0].into()));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Normals {
    faces: Vec<V3>,
    /// The normals at the edges of each triangle.
    edges: Vec<[V3; 3]>,
    /// The vertices of each triangle.
    triangles: Vec<[u32; 3]>,
    vertices: Vec<V3>,
}

impl Normals {
    /// Computes the normals of all triangles of a scene.
    ///
    /// # Accuracy
    /// Some units of roundoff divided by the smallest sine of the triangles (observed).
    ///
    /// # Complexity
    /// O(n log n) time; 150 bytes per triangle.
    #[must_use]
    pub fn new(soup: &Soup<f64>) -> Self {
        let surface = Surface::new(soup);
        let faces: Vec<V3> = soup.triangles().iter().map(|triangle| face_normal(corners(soup, *triangle))).collect();
        let mut edges = vec![[[0.0; 3]; 3]; faces.len()];
        surface.for_each_edge(soup, |half_edges| {
            let at = |half_edge: &u32| (*half_edge as usize / 3, *half_edge as usize % 3);
            let normal = unit(half_edges.iter().fold([0.0; 3], |sum, half_edge| add(sum, faces[at(half_edge).0])));
            for (triangle, edge) in half_edges.iter().map(at) {
                edges[triangle][edge] = normal;
            }
        });
        let triangles: Vec<[u32; 3]> = soup.triangles().iter().map(|corners| surface.welder.weld(*corners)).collect();
        let mut vertices = vec![[0.0; 3]; surface.welder.vertex_count];
        for (t, triangle) in triangles.iter().enumerate() {
            let corners = corners(soup, soup.triangles()[t]);
            for (i, vertex) in triangle.iter().enumerate() {
                let sum = &mut vertices[*vertex as usize];
                *sum = add(*sum, scaled(faces[t], angle(corners, i)));
            }
        }
        let vertices = vertices.into_iter().map(unit).collect();
        Self { faces, edges, triangles, vertices }
    }

    /// Returns the normal at a feature of a primitive, or `None` for a segment, a point, and where the triangles have
    /// no area or cancel each other.
    #[must_use]
    pub fn at(&self, primitive: PrimitiveId, feature: Feature) -> Option<Vector3<f64>> {
        let triangle = primitive.index();
        let face = self.faces.get(triangle)?;
        let normal = match feature {
            Feature::Face => *face,
            Feature::Edge(i) => self.edges[triangle][usize::from(i)],
            Feature::Vertex(i) => self.vertices[self.triangles[triangle][usize::from(i)] as usize],
        };
        (dot(normal, normal) > 0.0).then(|| normal.into())
    }
}

/// Returns the unit normal of a triangle, or zero if it has no area apart from underflow.
fn face_normal(corners: [V3; 3]) -> V3 {
    let [e, f] = [1, 2].map(|k| unit(sub(corners[k], corners[0])));
    unit(cross(e, f))
}
