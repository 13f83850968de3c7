//! The P2M paper's vertex construction of its table \[Zong2023\], as a reference for interception lists.
//!
//! The Voronoi cell of each vertex is cut by the planes around each edge and face. The corners of the remaining
//! polytope decide whether the vertex intercepts the edge or face, and a flood over neighbouring cells finds all pairs.
//!
//! The code follows the paper's text section by section, for meshes of a few hundred triangles without degenerate ones.
//! All numbers are f64. Points count as equal within [`EQUAL_WITHIN`] and squared distances within [`NEARER_BY`], which
//! is far above rounding because no coordinate exceeds 70; the unit of length is half the widest side of the mesh. A
//! pair may therefore be missing only if the feature is nowhere in the cell nearer than the vertex by more than that.

mod polytope;

pub use polytope::{Polytope, centre};

use nalgebra::{Point3, Vector3};
use p2m_core::{PrimitiveSet, Soup};
use polytope::HalfSpace;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Points at most this far from a plane count as points of the plane.
pub const EQUAL_WITHIN: f64 = 1e-11;
/// The difference from which on one squared distance counts as smaller than another.
pub const NEARER_BY: f64 = 1e-8;
/// The paper's M: queries lie in a cube that is this many times as wide as the mesh.
const DOMAIN_HALF_WIDTHS: f64 = 10.0;

/// An edge or a face.
#[derive(Clone, Debug)]
pub struct Feature {
    /// The positions of the two or three vertices.
    pub corners: Vec<Point3<f64>>,
    vertices: Vec<usize>,
    /// The triangles that have the feature, the first one first.
    pub owners: Vec<usize>,
    /// The vertical space of the feature: no point outside of it has its nearest point inside of the feature (section
    /// 4.2).
    space: Vec<HalfSpace>,
}

impl Feature {
    /// Returns the squared distance to the line or plane of the feature.
    fn distance_squared(&self, x: &Point3<f64>) -> f64 {
        let offset = x - self.corners[0];
        let across = match self.corners[..] {
            [a, b] => offset - (b - a) * (offset.dot(&(b - a)) / (b - a).norm_squared()),
            _ => {
                let normal = normal(&self.corners);
                normal * offset.dot(&normal)
            }
        };
        across.norm_squared()
    }
}

fn normal(corners: &[Point3<f64>]) -> Vector3<f64> {
    (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize()
}

/// A mesh with one copy of each vertex, and the Voronoi cells of the vertices (section 4.1).
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The positions of the vertices that triangles have.
    pub vertices: Vec<Point3<f64>>,
    /// The edges and faces.
    pub features: Vec<Feature>,
    /// For each vertex, the first triangle that has it.
    pub owners: Vec<usize>,
    /// For each vertex, its Voronoi cell.
    pub cells: Vec<Polytope>,
    centre: Point3<f64>,
    half_width: f64,
}

impl Mesh {
    /// Builds the mesh of a soup of triangles.
    #[must_use]
    pub fn new(soup: &Soup<f64>) -> Self {
        assert_eq!(soup.triangles().len(), soup.len(), "triangles alone");
        let (mut vertices, mut owners, mut numbers) = (Vec::new(), Vec::new(), BTreeMap::new());
        let mut triangles = Vec::new();
        for triangle in soup.triangles() {
            triangles.push(triangle.map(|corner| {
                let position = soup.positions()[corner as usize];
                // Adding 0.0 makes the two zeros equal.
                *numbers.entry(position.coords.data.0[0].map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    vertices.push(position);
                    owners.push(triangles.len());
                    vertices.len() - 1
                })
            }));
        }
        let bounds = soup.aabb();
        let half_width = (bounds.max - bounds.min).max() * 0.5;
        let features = features(&vertices, &triangles);
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        let mut mesh = Self { vertices, features, owners, cells: Vec::new(), centre, half_width };
        mesh.cells = (0..mesh.vertices.len()).map(|v| mesh.cell(v)).collect();
        mesh
    }

    /// Returns the Voronoi cell of a vertex among all others and eight virtual points at +-3 M, which bound it (section
    /// 4.3, *Remark*).
    fn cell(&self, v: usize) -> Polytope {
        let m = DOMAIN_HALF_WIDTHS * self.half_width;
        let vertex = self.vertices[v];
        // All such cells are in this cube. Let the vertex be p with |p_i| <= M, and x the first coordinate. There are
        // weights of the four virtual points at x = 3 M whose mean is (3 M, p_y, p_z). The same mean of their
        // half-spaces is x (3 M - p_x) <= (27 M^2 - |p|^2) / 2 at most, so x <= (27 M^2 - p_x^2) / (2 (3 M - p_x)) <=
        // 6.5 M.
        let mut cell = Polytope::cube(&self.centre, 7.0 * m, self.half_width * EQUAL_WITHIN);
        for i in 0..8 {
            let signs = Vector3::from_fn(|k, _| if i >> k & 1 == 1 { 3.0 * m } else { -3.0 * m });
            cell.cut(&HalfSpace::nearer_to(&vertex, &(self.centre + signs)), None);
        }
        let mut others: Vec<usize> = (0..self.vertices.len()).filter(|w| *w != v).collect();
        // Near vertices come first, because the polytope then has fewer corners.
        others.sort_by(|a, b| {
            let distance = |w: usize| (self.vertices[w] - vertex).norm_squared();
            distance(*a).total_cmp(&distance(*b))
        });
        for w in others {
            cell.cut(&HalfSpace::nearer_to(&vertex, &self.vertices[w]), Some(w));
        }
        cell
    }

    /// Returns the intersection of the cell of a vertex with the vertical space of a feature (`ConvexPoly(v, f)` of
    /// section 4.4).
    #[must_use]
    pub fn common(&self, v: usize, feature: usize) -> Polytope {
        let mut common = self.cells[v].clone();
        for side in &self.features[feature].space {
            common.cut(side, None);
        }
        common
    }

    /// Cuts a polytope down to the domain of queries, from -M to M.
    pub fn cut_to_domain(&self, polytope: &mut Polytope) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let normal = Vector3::ith(axis, side);
                polytope.cut(
                    &HalfSpace::behind(&(self.centre + normal * (DOMAIN_HALF_WIDTHS * self.half_width)), &normal),
                    None,
                );
            }
        }
    }

    /// Returns by how much the line or plane of a feature is nearer to a point than a vertex is, as a difference
    /// of squared distances.
    fn gain(&self, v: usize, feature: usize, x: &Point3<f64>) -> f64 {
        (x - self.vertices[v]).norm_squared() - self.features[feature].distance_squared(x)
    }

    /// Returns whether a vertex intercepts a feature: some corner of the common polytope is nearer to its line or plane
    /// (Theorems 5 and 6, which state Theorems 3 and 4 for corners).
    #[must_use]
    pub fn intercepts(&self, v: usize, feature: usize) -> bool {
        let threshold = NEARER_BY * self.half_width * self.half_width;
        self.common(v, feature).corners().any(|x| self.gain(v, feature, x) > threshold)
    }

    /// Finds the interceptions of edges and faces (Algorithm 1): beginning with the vertices of a feature, the
    /// neighbours of every vertex that intercepts it are inspected.
    ///
    /// Theorem 7 says that this finds all pairs. The paper's proof assumes without proof that the cell of a feature is
    /// connected. The rule of Theorems 5 and 6 does not need that, for any mesh (proved here). Let x be a point of the
    /// cell of v in the vertical space of a feature that is nearer to the line or plane of the feature than to v, and
    /// let y be its projection, which is in the feature. All vertices are farther from x than y is. If z is between x
    /// and y, the ball around z through y is in the ball around x through y, so all vertices are farther from z than y
    /// is. Also, z is in the vertical space and has the projection y. So every vertex whose cell the segment from x to
    /// y intersects intercepts the feature. The same holds for a path in the feature from y to one of its vertex
    /// vertices, because that path has distance zero from the feature. Finally, cells that share a point are
    /// neighbours, or are joined by others that have the point.
    #[must_use]
    pub fn flood(&self) -> Table {
        let mut table = Table::new(self.vertices.len());
        let neighbours: Vec<Vec<usize>> = self.cells.iter().map(|cell| cell.neighbours().collect()).collect();
        for (number, feature) in self.features.iter().enumerate() {
            let mut queue = VecDeque::from(feature.vertices.clone());
            let mut seen: BTreeSet<usize> = queue.iter().copied().collect();
            while let Some(v) = queue.pop_front() {
                table.inspected += 1;
                if self.intercepts(v, number) {
                    table.intercepted[v].insert(number);
                    queue.extend(neighbours[v].iter().copied().filter(|w| seen.insert(*w)));
                }
            }
        }
        table
    }

    /// Finds the interceptions without a flood, by inspecting every vertex with every feature.
    #[must_use]
    pub fn inspect_all(&self) -> Table {
        let mut table = Table::new(self.vertices.len());
        for v in 0..self.vertices.len() {
            table.inspected += self.features.len();
            table.intercepted[v].extend((0..self.features.len()).filter(|feature| self.intercepts(v, *feature)));
        }
        table
    }
}

/// Returns the edges and faces with their vertical spaces (section 4.2).
fn features(vertices: &[Point3<f64>], triangles: &[[usize; 3]]) -> Vec<Feature> {
    let mut features = Vec::new();
    let mut edges: BTreeMap<[usize; 2], Feature> = BTreeMap::new();
    for (owner, triangle) in triangles.iter().enumerate() {
        let corners = triangle.map(|v| vertices[v]);
        let normal = normal(&corners);
        assert!(normal.norm() > 0.5, "triangle {owner} is degenerate");
        let mut face =
            Feature { corners: corners.to_vec(), vertices: triangle.to_vec(), owners: vec![owner], space: Vec::new() };
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let outside = (b - a).cross(&normal);
            face.space.push(HalfSpace::behind(&a, &outside));
            let mut name = [triangle[i], triangle[(i + 1) % 3]];
            name.sort_unstable();
            let edge = edges.entry(name).or_insert_with(|| Feature {
                corners: vec![a, b],
                vertices: name.to_vec(),
                owners: Vec::new(),
                space: vec![HalfSpace::behind(&a, &(a - b)), HalfSpace::behind(&b, &(b - a))],
            });
            edge.owners.push(owner);
            edge.space.push(HalfSpace::behind(&a, &-outside));
        }
        features.push(face);
    }
    features.extend(edges.into_values());
    features
}

/// The interception table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// For each vertex, the features that it intercepts.
    pub intercepted: Vec<BTreeSet<usize>>,
    /// The number of pairs that were inspected.
    pub inspected: usize,
}

impl Table {
    fn new(count: usize) -> Self {
        Self { intercepted: vec![BTreeSet::new(); count], inspected: 0 }
    }

    /// Returns the number of pairs in the table.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.intercepted.iter().map(BTreeSet::len).sum()
    }

    /// Returns the triangles that a vertex intercepts, where an edge and the vertex itself count as the first triangle
    /// that has them. That triangle is the answer where they are nearest.
    #[must_use]
    pub fn triangles(&self, mesh: &Mesh, v: usize) -> BTreeSet<usize> {
        let features = self.intercepted[v].iter().map(|feature| mesh.features[*feature].owners[0]);
        features.chain([mesh.owners[v]]).collect()
    }

    /// Returns the squared distance to the mesh from a point whose nearest vertex is `v` (Appendix A, the query,
    /// without its boxes).
    #[must_use]
    pub fn distance_squared(&self, mesh: &Mesh, v: usize, query: &Point3<f64>) -> f64 {
        let mut square = (query - mesh.vertices[v]).norm_squared();
        for feature in self.intercepted[v].iter().map(|number| &mesh.features[*number]) {
            // For an edge only the planes at its ends count, which come first.
            let sides = if feature.corners.len() == 2 { &feature.space[..2] } else { &feature.space };
            if sides.iter().all(|side| side.height(query) <= mesh.half_width * EQUAL_WITHIN) {
                square = square.min(feature.distance_squared(query));
            }
        }
        square
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_of_a_square_intercept_what_touches_their_quarter() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let soup = Soup::from_triangles(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("valid");
        let mesh = Mesh::new(&soup);
        assert_eq!((mesh.vertices.len(), mesh.features.len()), (4, 7));
        let table = mesh.flood();
        assert_eq!(table.intercepted, mesh.inspect_all().intercepted);
        for v in 0..4 {
            let neighbours: BTreeSet<_> = mesh.cells[v].neighbours().collect();
            assert_eq!(neighbours, BTreeSet::from([(v + 1) % 4, (v + 3) % 4]));
            for (number, feature) in mesh.features.iter().enumerate() {
                // Both faces and their common edge contain the middle.
                let touches = feature.vertices.contains(&v) || feature.owners.len() == 2 || feature.vertices.len() == 3;
                assert_eq!(table.intercepted[v].contains(&number), touches, "{v} {:?}", feature.vertices);
            }
        }
    }
}
