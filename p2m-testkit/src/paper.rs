//! The P2M paper's own route to its table \[Zong2023\], to hold interception lists against: the Voronoi cell of each
//! vertex is cut by the planes around each edge and face, the corners of what is left tell whether the vertex
//! intercepts the edge or face, and a flood over neighbouring cells finds all pairs.
//!
//! Written from the paper's text, section by section, for meshes of a few hundred triangles, none of them degenerate.
//! All is f64: places count as equal within [`TOUCHING`] and squared distances within [`NEARER`], far above rounding,
//! as no coordinate is above 70; the unit is half the widest side of the mesh. So a pair may be missing only if the
//! feature is nowhere in the cell nearer than the vertex by more than that.

use nalgebra::{Point3, Vector3};
use p2m_core::{PrimitiveSet, Soup};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// What is closer to a plane lies on it.
pub const TOUCHING: f64 = 1e-11;
/// By how much one squared distance has to be below another.
pub const NEARER: f64 = 1e-8;
/// The paper's M: queries lie in a cube so many times as wide as the mesh.
const REACH: f64 = 10.0;

/// Where `normal . x <= offset`.
#[derive(Clone, Copy, Debug)]
struct HalfSpace {
    /// A unit vector.
    normal: Vector3<f64>,
    offset: f64,
}

impl HalfSpace {
    /// Behind a plane through a point.
    fn behind(point: &Point3<f64>, normal: &Vector3<f64>) -> Self {
        let normal = normal.normalize();
        Self { normal, offset: normal.dot(&point.coords) }
    }

    /// Where `a` is at least as near as `b`.
    fn nearer(a: &Point3<f64>, b: &Point3<f64>) -> Self {
        Self::behind(&nalgebra::center(a, b), &(b - a))
    }

    fn height(&self, x: &Point3<f64>) -> f64 {
        self.normal.dot(&x.coords) - self.offset
    }
}

/// A bounded convex polytope: its faces, each with its corners in order. One that is flat, a line or a point has faces
/// of fewer corners; an empty one has no faces.
#[derive(Clone, Debug)]
pub struct Polytope {
    faces: Vec<Face>,
    touching: f64,
}

#[derive(Clone, Debug)]
struct Face {
    /// The vertex behind it.
    neighbour: Option<usize>,
    corners: Vec<Point3<f64>>,
}

impl Polytope {
    fn cube(centre: &Point3<f64>, half: f64, touching: f64) -> Self {
        let mut faces = Vec::new();
        for axis in 0..3 {
            for side in [-half, half] {
                let corner = |(i, j): (f64, f64)| {
                    let mut way = Vector3::zeros();
                    (way[axis], way[(axis + 1) % 3], way[(axis + 2) % 3]) = (side, i * half, j * half);
                    centre + way
                };
                let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec();
                faces.push(Face { neighbour: None, corners });
            }
        }
        Self { faces, touching }
    }

    /// The corners, some of them several times.
    pub fn corners(&self) -> impl Iterator<Item = &Point3<f64>> {
        self.faces.iter().flat_map(|face| &face.corners)
    }

    /// Section 4.4, *plane cutting*: leaves what is in a half-space. The new face gets the name `neighbour`.
    fn cut(&mut self, by: &HalfSpace, neighbour: Option<usize>) {
        if self.corners().all(|x| by.height(x) <= self.touching) {
            return;
        }
        let mut new: Vec<Point3<f64>> = Vec::new();
        for face in &mut self.faces {
            let mut rest = Vec::new();
            for (i, a) in face.corners.iter().enumerate() {
                let b = &face.corners[(i + 1) % face.corners.len()];
                let (ha, hb) = (by.height(a), by.height(b));
                if ha <= self.touching {
                    rest.push(*a);
                }
                if ha.min(hb) < -self.touching && ha.max(hb) > self.touching {
                    rest.push(a + (b - a) * (ha / (ha - hb)));
                }
            }
            new.extend(rest.iter().filter(|x| by.height(x).abs() <= self.touching));
            face.corners = rest;
        }
        self.faces.retain(|face| !face.corners.is_empty());
        if let Some(centre) = centre(&new) {
            // Around the normal; corners that several faces have come one after the other.
            let u = new.iter().map(|x| x - centre).max_by(|a, b| a.norm().total_cmp(&b.norm())).expect("not empty");
            let w = by.normal.cross(&u);
            let angle = |x: &Point3<f64>| (x - centre).dot(&w).atan2((x - centre).dot(&u));
            new.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            new.dedup_by(|a, b| (*a - *b).norm() <= self.touching);
            self.faces.push(Face { neighbour, corners: new });
        }
    }

    /// The vertices behind its faces, of which something has to be left.
    fn neighbours(&self) -> impl Iterator<Item = usize> {
        let has_area = |face: &&Face| {
            let first = face.corners[0];
            let fan = face.corners.windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first)));
            fan.sum::<Vector3<f64>>().norm() > self.touching
        };
        self.faces.iter().filter(has_area).filter_map(|face| face.neighbour)
    }
}

/// The mean of some points.
#[must_use]
pub fn centre(points: &[Point3<f64>]) -> Option<Point3<f64>> {
    let sum: Vector3<f64> = points.iter().map(|x| x.coords).sum();
    (!points.is_empty()).then(|| Point3::from(sum / points.len() as f64))
}

/// An edge or a face.
#[derive(Clone, Debug)]
pub struct Feature {
    /// The places of its two or three vertices, and their numbers.
    pub corners: Vec<Point3<f64>>,
    vertices: Vec<usize>,
    /// The triangles that have it, the first one first.
    pub owners: Vec<usize>,
    /// Its vertical space: no other point can have its nearest one inside of the feature (section 4.2).
    space: Vec<HalfSpace>,
}

impl Feature {
    /// The squared distance to its line or plane.
    fn distance_squared(&self, x: &Point3<f64>) -> f64 {
        let way = x - self.corners[0];
        let across = match self.corners[..] {
            [a, b] => way - (b - a) * (way.dot(&(b - a)) / (b - a).norm_squared()),
            _ => {
                let normal = normal(&self.corners);
                normal * way.dot(&normal)
            }
        };
        across.norm_squared()
    }
}

fn normal(corners: &[Point3<f64>]) -> Vector3<f64> {
    (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize()
}

/// A mesh with one copy of each vertex, and the Voronoi cells of these (section 4.1).
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The vertices that triangles have.
    pub vertices: Vec<Point3<f64>>,
    /// Edges and faces.
    pub features: Vec<Feature>,
    /// Of each vertex the first triangle with it,
    pub owners: Vec<usize>,
    /// and its cell.
    pub cells: Vec<Polytope>,
    centre: Point3<f64>,
    half: f64,
}

impl Mesh {
    /// Of a soup of triangles alone.
    #[must_use]
    pub fn new(soup: &Soup<f64>) -> Self {
        assert_eq!(soup.triangles().len(), soup.len(), "triangles alone");
        let (mut vertices, mut owners, mut numbers) = (Vec::new(), Vec::new(), BTreeMap::new());
        let mut triangles = Vec::new();
        for triangle in soup.triangles() {
            triangles.push(triangle.map(|corner| {
                let place = soup.positions()[corner as usize];
                // Zero has two signs.
                *numbers.entry(place.coords.data.0[0].map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    vertices.push(place);
                    owners.push(triangles.len());
                    vertices.len() - 1
                })
            }));
        }
        let bounds = soup.aabb();
        let half = (bounds.max - bounds.min).max() * 0.5;
        let features = features(&vertices, &triangles);
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        let mut mesh = Self { vertices, features, owners, cells: Vec::new(), centre, half };
        mesh.cells = (0..mesh.vertices.len()).map(|v| mesh.cell(v)).collect();
        mesh
    }

    /// Section 4.3, *Remark*: the Voronoi cell of a vertex among all others and eight virtual points at +-3 M, which
    /// bound it.
    fn cell(&self, v: usize) -> Polytope {
        let m = REACH * self.half;
        let own = self.vertices[v];
        // All such cells are in this cube. Let the vertex be p with |p_i| <= M, x the first coordinate. There are
        // weights of the four virtual points at x = 3 M whose mean is (3 M, p_y, p_z); the same mean of their
        // half-spaces is x (3 M - p_x) <= (27 M^2 - |p|^2) / 2 at most, so x <= (27 M^2 - p_x^2) / (2 (3 M - p_x)) <=
        // 6.5 M.
        let mut cell = Polytope::cube(&self.centre, 7.0 * m, self.half * TOUCHING);
        for i in 0..8 {
            let signs = Vector3::from_fn(|k, _| if i >> k & 1 == 1 { 3.0 * m } else { -3.0 * m });
            cell.cut(&HalfSpace::nearer(&own, &(self.centre + signs)), None);
        }
        let mut others: Vec<usize> = (0..self.vertices.len()).filter(|w| *w != v).collect();
        // The near ones first, for there are fewer corners then.
        others.sort_by(|a, b| {
            let distance = |w: usize| (self.vertices[w] - own).norm_squared();
            distance(*a).total_cmp(&distance(*b))
        });
        for w in others {
            cell.cut(&HalfSpace::nearer(&own, &self.vertices[w]), Some(w));
        }
        cell
    }

    /// `ConvexPoly(v, f)` of section 4.4: what the cell of a vertex has in common with the vertical space of a feature.
    #[must_use]
    pub fn common(&self, v: usize, feature: usize) -> Polytope {
        let mut common = self.cells[v].clone();
        for side in &self.features[feature].space {
            common.cut(side, None);
        }
        common
    }

    /// Cuts a polytope down to where queries are, from -M to M.
    pub fn cut_to_domain(&self, polytope: &mut Polytope) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let normal = Vector3::ith(axis, side);
                polytope.cut(&HalfSpace::behind(&(self.centre + normal * (REACH * self.half)), &normal), None);
            }
        }
    }

    /// By how much a feature's line or plane is nearer to a point than a vertex is, as a difference of squares.
    fn gain(&self, v: usize, feature: usize, x: &Point3<f64>) -> f64 {
        (x - self.vertices[v]).norm_squared() - self.features[feature].distance_squared(x)
    }

    /// Theorems 5 (edges) and 6 (faces), which state Theorems 3 and 4 for corners: a vertex does not intercept a
    /// feature to whose line or plane no corner of the common polytope is nearer.
    #[must_use]
    pub fn intercepts(&self, v: usize, feature: usize) -> bool {
        let least = NEARER * self.half * self.half;
        self.common(v, feature).corners().any(|x| self.gain(v, feature, x) > least)
    }

    /// Algorithm 1, for edges and faces alike: from the vertices of a feature on, the neighbours of every vertex that
    /// intercepts it are inspected.
    ///
    /// Theorem 7 says that this finds all pairs. The paper's proof rests on the cell of a feature being connected, and
    /// leaves that out; for the rule of Theorems 5 and 6 it is not needed, whatever the mesh is (proved): let x be a
    /// point of the cell of v in the vertical space of a feature, nearer to its line or plane than to v, and y its foot
    /// there, which is in the feature. All vertices are farther from x than y is. If z is between x and y, the ball
    /// around z through y is in that around x, so all vertices are farther from z than y is, too; and z is in the
    /// vertical space, with y as its foot. So every vertex intercepts the feature whose cell the way from x to y meets.
    /// So does every vertex whose cell a way in the feature from y to one of its own vertices meets, for that way is at
    /// no distance from it. And cells that meet in a point are neighbours, or joined by others that have the point.
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

    /// The same without a flood: every vertex with every feature.
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

/// Section 4.2: edges and faces with their vertical spaces.
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
    /// Of each vertex the features that it intercepts.
    pub intercepted: Vec<BTreeSet<usize>>,
    /// How many pairs were looked at.
    pub inspected: usize,
}

impl Table {
    fn new(count: usize) -> Self {
        Self { intercepted: vec![BTreeSet::new(); count], inspected: 0 }
    }

    /// How many pairs it has.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.intercepted.iter().map(BTreeSet::len).sum()
    }

    /// The triangles that a vertex intercepts, if edges and the vertex itself count as the first triangle that has
    /// them: that is the answer where they are nearest.
    #[must_use]
    pub fn triangles(&self, mesh: &Mesh, v: usize) -> BTreeSet<usize> {
        let features = self.intercepted[v].iter().map(|feature| mesh.features[*feature].owners[0]);
        features.chain([mesh.owners[v]]).collect()
    }

    /// Appendix A, the query, without its boxes: the squared distance to the mesh from a point whose nearest vertex is
    /// v.
    #[must_use]
    pub fn distance_squared(&self, mesh: &Mesh, v: usize, query: &Point3<f64>) -> f64 {
        let mut least = (query - mesh.vertices[v]).norm_squared();
        for feature in self.intercepted[v].iter().map(|number| &mesh.features[*number]) {
            // Of an edge only the planes at its ends, which come first.
            let sides = if feature.corners.len() == 2 { &feature.space[..2] } else { &feature.space };
            if sides.iter().all(|side| side.height(query) <= mesh.half * TOUCHING) {
                least = least.min(feature.distance_squared(query));
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_are_cut_at_edges_and_at_corners() {
        let cases = [(-0.1, 0), (0.0, 1), (0.5, 4), (1.0, 4), (1.5, 10), (2.0, 7), (2.5, 10), (3.0, 8), (4.0, 8)];
        for (height, expected) in cases {
            let mut cube = Polytope::cube(&Point3::new(0.5, 0.5, 0.5), 0.5, TOUCHING);
            let normal = Vector3::repeat(1.0);
            cube.cut(&HalfSpace::behind(&Point3::new(height, 0.0, 0.0), &normal), Some(7));
            let corners: BTreeSet<_> = cube.corners().map(|x| [0, 1, 2].map(|k| (x[k] * 1e6).round() as i64)).collect();
            assert_eq!(corners.len(), expected, "{height}");
            let is_cut = (0.1..2.9).contains(&height);
            assert_eq!(cube.neighbours().collect::<Vec<_>>(), if is_cut { vec![7] } else { vec![] }, "{height}");
        }
    }

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
                // Both faces and their common edge have the middle.
                let touches = feature.vertices.contains(&v) || feature.owners.len() == 2 || feature.vertices.len() == 3;
                assert_eq!(table.intercepted[v].contains(&number), touches, "{v} {:?}", feature.vertices);
            }
        }
    }
}
