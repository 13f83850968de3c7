//! Compares the lists of the P2M index with the paper's own table ([`p2m_testkit::paper`]) on small meshes.
//!
//! Our lists have every pair of a vertex and a triangle that the paper's rule keeps, whether it is nearest somewhere or
//! not. If a feature is nearer than the vertex at a point of its vertical space in the cell, the point is in the region
//! of the triangle (docs/proofs/p2m.md), and no side of that space has the whole region behind it. Our cells contain
//! the paper's, because bounding sites are farther away. Both tables have every pair whose triangle is the answer of
//! brute force at some point of the cell; such points are searched for in the intersections of cells and vertical
//! spaces.
#![cfg(feature = "interception")]

use nalgebra::{Point3, Vector3};
use p2m::interception::Partition;
use p2m::{BruteForce, BuildIndex, ClosestPoint, P2mIndex, PrimitiveId, PrimitiveSet, Soup};
use p2m_testkit::paper::{Mesh, NEARER_BY, Polytope, Table, centre};
use p2m_testkit::scenes::{self, Kinds, Layout};
use p2m_testkit::{amount, is_deep, rng, vector};
use rand::{Rng, RngExt};
use std::collections::{BTreeMap, BTreeSet};

/// Numbers of pairs of a vertex and a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pairs {
    all: usize,
    /// The number of pairs in our lists.
    ours: usize,
    /// The number of pairs in the paper's table, all of which are in our lists.
    paper: usize,
    /// The number of pairs whose triangle is the answer somewhere in the cell of the vertex, all of which are in both.
    nearest: usize,
}

struct Scene {
    name: &'static str,
    soup: Soup<f64>,
    mesh: Mesh,
    table: Table,
    /// For each vertex, the triangles of our list.
    lists: Vec<BTreeSet<usize>>,
    brute: BruteForce<Soup<f64>>,
    index: P2mIndex<f64, Soup<f64>>,
}

impl Scene {
    fn new(name: &'static str, soup: Soup<f64>) -> Self {
        let mesh = Mesh::new(&soup);
        let table = mesh.flood();
        let brute = BruteForce::new(soup.clone()).expect("valid");
        let index = P2mIndex::build(soup.clone(), &Default::default()).expect("valid");
        let lists = mesh.vertices.iter().map(|v| list(&index, v)).collect();
        Self { name, soup, mesh, table, lists, brute, index }
    }

    /// Checks Theorems 2 and 7.
    fn check_table(&self) {
        let Self { name, mesh, table, .. } = self;
        assert_eq!(table.intercepted, mesh.inspect_all().intercepted, "{name}: the flood finds all pairs");
        for (v, position) in mesh.vertices.iter().enumerate() {
            let vertex = (0..mesh.features.len()).filter(|feature| mesh.features[*feature].corners.contains(position));
            assert!(vertex.into_iter().all(|feature| table.intercepted[v].contains(&feature)), "{name}: {v}");
        }
    }

    /// Checks all answers at a point of the cell of a vertex, and returns the nearest triangle; `None` if another
    /// vertex is equally near.
    fn check_point(&self, v: usize, query: &Point3<f64>) -> Option<usize> {
        let Self { name, mesh, .. } = self;
        let square = |position: &Point3<f64>| (query - position).norm_squared();
        let vertex = square(&mesh.vertices[v]);
        if mesh.vertices.iter().filter(|w| square(w) < vertex + ROUNDING).count() > 1 {
            return None;
        }
        let closest = self.brute.closest_point(query).expect("not empty");
        let id = closest.primitive.index();
        assert!(self.lists[v].contains(&id), "{name}: {id} is not in the list of {v}, at {query:?}");
        assert_eq!(list(&self.index, query), self.lists[v], "{name}: the cell of {v} has {query:?}");
        let error = self.table.distance_squared(mesh, v, query) - closest.distance * closest.distance;
        assert!(error.abs() <= 2.0 * NEARER_BY, "{name}: the paper errs by {error} in the cell of {v}, at {query:?}");
        Some(id)
    }

    fn count(&self) -> Pairs {
        let Self { name, mesh, table, .. } = self;
        let mut rng = rng(name, 0);
        let mut pairs = Pairs { all: self.soup.len() * mesh.vertices.len(), ..Pairs::default() };
        for (v, list) in self.lists.iter().enumerate() {
            let paper = table.triangles(mesh, v);
            let lost: Vec<_> = paper.difference(list).collect();
            assert!(lost.is_empty(), "{name}: {lost:?} are not in the list of {v}");
            let mut cell = mesh.cells[v].clone();
            mesh.cut_to_domain(&mut cell);
            let mut queries = inside(&mut rng, &cell, amount(30, 3));
            for feature in 0..mesh.features.len() {
                if !mesh.features[feature].owners.iter().any(|owner| list.contains(owner)) {
                    continue;
                }
                let mut common = mesh.common(v, feature);
                mesh.cut_to_domain(&mut common);
                queries.extend(inside(&mut rng, &common, amount(4, 1)));
                queries.push(towards(&mut rng, mesh, v, &mesh.features[feature].corners));
            }
            let nearest: BTreeSet<usize> = queries.iter().filter_map(|query| self.check_point(v, query)).collect();
            let lost: Vec<_> = nearest.difference(&paper).collect();
            assert!(lost.is_empty(), "{name}: {lost:?} are not in the paper's list of {v}");
            pairs.ours += list.len();
            pairs.paper += paper.len();
            pairs.nearest += nearest.len();
        }
        pairs
    }
}

/// Squared distances to vertices that differ by less may be equal. The meshes are about two wide.
const ROUNDING: f64 = 1e-10;

fn list(index: &P2mIndex<f64, Soup<f64>>, query: &Point3<f64>) -> BTreeSet<usize> {
    index.partition().list(query).expect("no cell of the tree").into_iter().map(PrimitiveId::index).collect()
}

/// Returns points of a polytope: its middle, corners moved a little inwards, and random convex combinations
/// of its corners.
fn inside(rng: &mut impl Rng, polytope: &Polytope, count: usize) -> Vec<Point3<f64>> {
    let corners: Vec<_> = polytope.corners().copied().collect();
    let Some(middle) = centre(&corners) else { return Vec::new() };
    let mut points = vec![middle];
    for _ in 0..count {
        let [a, b, c] = [(); 3].map(|()| corners[rng.random_range(0..corners.len())]);
        let [s, t] = [(); 2].map(|()| rng.random_range(0.0..1.0));
        for point in [a, a + (b - a) * s + (c - a) * (t * (1.0 - s))] {
            points.push(point + (middle - point) * 10f64.powi(-rng.random_range(1..6)));
        }
    }
    points
}

/// Returns a point of the cell of v on the segment to a point of a feature, as far as possible along it.
fn towards(rng: &mut impl Rng, mesh: &Mesh, v: usize, corners: &[Point3<f64>]) -> Point3<f64> {
    let weights: Vec<f64> = corners.iter().map(|_| rng.random_range(0.01..1.0f64).powi(3)).collect();
    let sum: f64 = weights.iter().sum();
    let point: Vector3<f64> = corners.iter().zip(&weights).map(|(x, weight)| x.coords * (weight / sum)).sum();
    let vertex = mesh.vertices[v];
    let direction = Point3::from(point) - vertex;
    // The bisector with each other vertex limits the segment.
    let others = mesh.vertices.iter().map(|w| w - vertex).filter(|w| w.dot(&direction) > 0.0);
    let end = others.map(|w| w.norm_squared() / w.dot(&direction) / 2.0).fold(1.0, f64::min);
    vertex + direction * (end * 0.999)
}

/// Divides each triangle into four, `times` times.
fn subdivided(mut corners_of_mesh: Vec<Point3<f64>>, mut triangles: Vec<[u32; 3]>, times: usize) -> Soup<f64> {
    for _ in 0..times {
        let mut halves: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut middle_of = |a: u32, b: u32| {
            *halves.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                corners_of_mesh.push(nalgebra::center(&corners_of_mesh[a as usize], &corners_of_mesh[b as usize]));
                u32::try_from(corners_of_mesh.len() - 1).expect("few")
            })
        };
        let split = |[a, b, c]: [u32; 3]| {
            let [d, e, f] = [middle_of(a, b), middle_of(b, c), middle_of(c, a)];
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    Soup::from_triangles(corners_of_mesh, triangles).expect("valid")
}

fn octahedron(times: usize) -> Soup<f64> {
    let corners_of_mesh =
        (0..6).map(|i| Point3::from(Vector3::ith(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 }))).collect();
    let triangles = (0..8u32).map(|i| [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)]).collect();
    subdivided(corners_of_mesh, triangles, times)
}

fn cube(times: usize) -> Soup<f64> {
    let position = |i: u32| Point3::from([0, 1, 2].map(|k| f64::from(i >> k & 1)));
    let triangles = [0, 1, 2].into_iter().flat_map(|axis| {
        let [u, v] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        [0, 1u32 << axis].into_iter().flat_map(move |o| [[o, o + u, o + u + v], [o, o + u + v, o + v]])
    });
    subdivided((0..8).map(position).collect(), triangles.collect(), times)
}

fn torus(around: u32, across: u32) -> Soup<f64> {
    let position = |i: u32| {
        let angle = |i: u32, n: u32| (f64::from(i) * std::f64::consts::TAU / f64::from(n)).sin_cos();
        let ((s, c), (z, r)) = (angle(i / across, around), angle(i % across, across));
        Point3::new((1.0 + 0.4 * r) * c, (1.0 + 0.4 * r) * s, 0.4 * z)
    };
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    let triangles = (0..around).flat_map(|i| (0..across).map(move |j| (i, j))).flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Soup::from_triangles((0..around * across).map(position).collect(), triangles.collect()).expect("valid")
}

/// Returns the soup with all vertices moved.
fn moved(soup: &Soup<f64>, to: impl FnMut(&Point3<f64>) -> Point3<f64>) -> Soup<f64> {
    Soup::from_triangles(soup.positions().iter().map(to).collect(), soup.triangles().to_vec()).expect("valid")
}

fn shaken(soup: &Soup<f64>, by: f64) -> Soup<f64> {
    let mut rng = rng("paper shaken", 0);
    moved(soup, |x| x + vector(&mut rng) * by)
}

#[test]
fn lists_have_all_pairs_of_the_paper_and_all_that_can_be_nearest() {
    let sphere = |times| moved(&octahedron(times), |x| Point3::from(x.coords.normalize()));
    let random = |layout, len| scenes::soup(&mut rng("paper soups", 0), Kinds::Triangles, layout, len);
    let terrain = random(Layout::Sheet, amount(100, 50));
    let scenes = [
        ("sphere", sphere(1)),
        ("shaken sphere", shaken(&sphere(amount(2, 1)), 0.1)),
        ("octahedron", octahedron(1)),
        ("torus", torus(amount(12, 7), amount(6, 4))),
        ("shaken torus", shaken(&torus(amount(12, 7), amount(6, 4)), 0.1)),
        ("terrain", terrain.clone()),
        ("shaken terrain", shaken(&terrain, 0.1)),
        ("cube", cube(1)),
        ("shaken cube", shaken(&cube(1), 0.1)),
        ("gear", scenes::skewed_gear(amount(5, 3))),
        ("strewn", random(Layout::Strewn, amount(40, 16))),
        ("crossing", random(Layout::Uniform, amount(30, 10))),
    ];
    let mut sum = Pairs::default();
    for (name, soup) in scenes {
        // Shallow tests use few of the meshes.
        if !is_deep() && !["sphere", "shaken torus", "shaken cube", "strewn"].contains(&name) {
            continue;
        }
        let scene = Scene::new(name, soup);
        scene.check_table();
        let pairs = scene.count();
        let table = &scene.table;
        println!(
            "{name}: {pairs:?}; the flood looked at {} vertices and features for {}",
            table.inspected,
            table.pairs()
        );
        assert!(pairs.nearest > scene.soup.len() && pairs.paper * 2 > pairs.nearest, "{name}");
        if name == "sphere" {
            // All cells contain the middle ("each vertex intercepts any triangle", section 6).
            assert_eq!((pairs.paper, pairs.ours), (pairs.all, pairs.all));
            continue;
        }
        assert!(pairs.ours < pairs.all * 4 / 5 && pairs.ours < pairs.paper * 5 / 2, "{name}: lists are long");
        sum = Pairs {
            all: sum.all + pairs.all,
            ours: sum.ours + pairs.ours,
            paper: sum.paper + pairs.paper,
            nearest: sum.nearest + pairs.nearest,
        };
    }
    println!("all but the sphere: {sum:?}");
}
