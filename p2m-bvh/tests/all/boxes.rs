//! Compares box queries with exact rational arithmetic and brute force, and tests the leaf nearest to a point.
#![allow(clippy::float_cmp, reason = "exact results are what is tested")]

use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_bvh::SplitRule;
use p2m_core::{
    Aabb, BoxQuery, BruteForce, BuildIndex, ClosestPoint, Primitive, PrimitiveId, PrimitiveSet, Real, Shape, Soup,
};
use p2m_testkit::families::shape;
use p2m_testkit::scenes::{self, Kinds, LAYOUTS, kinds_and_layout};
use p2m_testkit::{amount, cases, oracle, rng};
use rand::{Rng, RngExt};

fn aabb([min, max]: [[f64; 3]; 2]) -> Aabb<f64> {
    Aabb { min: Point3::from(min), max: Point3::from(max) }
}

/// Sorts the coordinates of two corners.
fn sorted(a: [f64; 3], b: [f64; 3]) -> [[f64; 3]; 2] {
    [std::array::from_fn(|k| a[k].min(b[k])), std::array::from_fn(|k| a[k].max(b[k]))]
}

/// On a lattice of a few points, hulls often touch boxes at faces, edges and corners.
#[test]
fn primitives_meet_boxes_as_exact_arithmetic_says() {
    let (mut met, mut touched, mut missed) = (0, 0, 0);
    let cases = cases(60_000, 4_200);
    for case in cases.clone() {
        let mut rng = rng("boxes on a lattice", case);
        let side = rng.random_range(2..8);
        let mut lattice = || std::array::from_fn(|_| f64::from(rng.random_range(-side..=side)));
        let vertices: Vec<[f64; 3]> = (0..case % 3 + 1).map(|_| lattice()).collect();
        let corners = sorted(lattice(), lattice());
        let expected = oracle::intersects_box(&vertices, &corners);
        let e = [0, -1074, -600, -301, 290, 700, 1020][(case / 3 % 7) as usize];
        let scale = |p: [f64; 3]| p.map(|x| x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2));
        let found =
            shape(&vertices.iter().map(|v| scale(*v)).collect::<Vec<_>>()).intersects_box(&aabb(corners.map(scale)));
        assert_eq!(found, expected, "{vertices:?} {corners:?} at 2^{e}");
        // The box shrinks by less than the lattice spacing, so hulls that only touched it do not intersect it any more.
        let inner = [corners[0].map(|x| x + 1e-9), corners[1].map(|x| x - 1e-9)];
        let inside = (0..3).all(|k| inner[0][k] <= inner[1][k]) && oracle::intersects_box(&vertices, &inner);
        assert_eq!(shape(&vertices).intersects_box(&aabb(inner)), inside, "{vertices:?} {inner:?}");
        met += usize::from(inside);
        touched += usize::from(expected && !inside);
        missed += usize::from(!expected);
    }
    println!("{met} met, {touched} touched, {missed} missed");
    let rarest = met.min(touched).min(missed);
    assert!(cases.have_more_than(6000, rarest), "the lattice should have all three: {met} {touched} {missed}");
}

/// A box has one corner at the rounded point of a face or an edge, or one ulp beside it, so that the sign depends on
/// the last bit.
#[test]
fn the_last_bit_decides_whether_a_corner_touches() {
    let mut both = [0; 2];
    let cases = cases(20_000, 2_000);
    for case in cases.clone() {
        let mut rng = rng("corners near faces", case);
        let e: i32 = [0, -1000, 900, 30][(case % 4) as usize];
        let mut random = || std::array::from_fn(|_| (rng.random::<f64>() - 0.5) * 2f64.powi(e));
        let vertices: Vec<[f64; 3]> = (0..2 + case % 2).map(|_| random()).collect();
        let far = random();
        let weights: Vec<f64> = vertices.iter().map(|_| rng.random::<f64>()).collect();
        let sum: f64 = weights.iter().sum();
        let mut corner: [f64; 3] =
            std::array::from_fn(|k| vertices.iter().zip(&weights).map(|(v, w)| v[k] * w / sum).sum());
        for _ in 0..rng.random_range(0..3) {
            let k = rng.random_range(0..3);
            corner[k] = if rng.random() { corner[k].next_up() } else { corner[k].next_down() };
        }
        let corners = sorted(corner, far);
        let expected = oracle::intersects_box(&vertices, &corners);
        both[usize::from(expected)] += 1;
        assert_eq!(shape(&vertices).intersects_box(&aabb(corners)), expected, "{vertices:?} {corners:?}");
    }
    assert!(cases.have_more_than(4000, both[0].min(both[1])), "{both:?}");
}

#[test]
fn boxes_that_are_odd_have_stated_answers() {
    let t = shape(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
    let intersects = |corners| t.intersects_box(&aabb(corners));
    let inf = f64::INFINITY;
    assert!(intersects([[-inf; 3], [inf; 3]]));
    assert!(intersects([[2.0, 2.0, -inf], [inf, inf, inf]]) && !intersects([[2.1, 2.0, -inf], [inf, inf, inf]]));
    assert!(intersects([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]), "a box may be a point");
    assert!(!intersects([[1.0, 1.0, 1.0], [2.0, 2.0, -1.0]]), "empty on one axis");
    assert!(!intersects([[3.0, 3.0, -1.0], [1.0, 1.0, 1.0]]), "empty, although its corners enclose the face");
    for at in 0..6 {
        let mut corners = [[-1.0; 3], [1.0; 3]];
        corners[at / 3][at % 3] = f64::NAN;
        assert!(!intersects(corners), "NaN at {at}");
    }
    let empty = <AabbTree<f64, Vec<Shape<f64>>>>::build(Vec::new(), &Default::default()).unwrap();
    assert!(!empty.intersects_box(&aabb([[-inf; 3], [inf; 3]])));
    let tree = AabbTree::new([t]).unwrap();
    assert!(tree.intersects_box(&aabb([[-inf; 3], [inf; 3]])) && !tree.intersects_box(&aabb([[1.0; 3], [-1.0; 3]])));
}

/// Returns a box of any size, or of size zero, around or between the positions of a scene; most of them
/// touch a position.
fn random_box<R: Rng>(rng: &mut R, soup: &Soup<f64>, bounds: &Aabb<f64>) -> Aabb<f64> {
    let id = PrimitiveId::new(rng.random_range(0..soup.len()));
    let primitive = soup.get(id);
    let vertex = primitive.vertices()[rng.random_range(0..primitive.vertices().len())];
    let decades = rng.random_range(-5.0..0.5);
    let size = (bounds.max - bounds.min) * 10f64.powf(decades);
    // On each axis the box begins at the vertex, ends there, contains it, or begins an ulp beyond it.
    let ends: [[f64; 2]; 3] = std::array::from_fn(|k| {
        let (v, size) = (vertex[k], size[k] * rng.random::<f64>());
        match rng.random_range(0..6) {
            0 | 1 => [v, v + size],
            2 | 3 => [v - size, v],
            4 => [v - size * 0.3, v + size * 0.7],
            _ => [v.next_up(), v.next_up() + size],
        }
    });
    aabb([ends.map(|e| e[0]), ends.map(|e| e[1])])
}

/// The boxes of primitives, grouped by the cells of a grid, with a box around each group that is tested first.
struct Boxes<T: Real> {
    each: Vec<(PrimitiveId, Aabb<T>)>,
    runs: Vec<Aabb<T>>,
}

impl<T: Real> Boxes<T> {
    const RUN: usize = 64;
    /// The number of cells along an axis.
    const CELLS: f64 = 32.0;

    fn new(soup: &Soup<T>) -> Self {
        let ids = (0..soup.len()).map(PrimitiveId::new);
        let mut each: Vec<_> = ids.map(|id| (id, soup.get(id).aabb())).collect();
        let scene = soup.aabb().to_f64();
        let size = scene.max - scene.min;
        each.sort_by_cached_key(|(_, primitive_box)| {
            let at = primitive_box.to_f64().min - scene.min;
            // In a flat scene the quotient is NaN, which converts to 0.
            [0, 1, 2].map(|k: usize| (at[k] / size[k] * Self::CELLS) as u32)
        });
        let enclosing = |run: &[(PrimitiveId, Aabb<T>)]| {
            run.iter().fold(Aabb::empty(), |all, (_, primitive_box)| all.union(primitive_box))
        };
        let runs = each.chunks(Self::RUN).map(enclosing).collect();
        Self { each, runs }
    }

    /// Returns the ids of the primitives whose boxes intersect `bounds`.
    fn intersecting(&self, bounds: &Aabb<T>) -> Vec<PrimitiveId> {
        let runs = self.each.chunks(Self::RUN).zip(&self.runs).filter(|(_, run)| run.intersects(bounds));
        let members =
            runs.flat_map(|(members, _)| members).filter(|(_, primitive_box)| primitive_box.intersects(bounds));
        let mut found: Vec<_> = members.map(|(id, _)| *id).collect();
        found.sort_unstable();
        found
    }
}

/// Returns the candidates that intersect `bounds`.
fn intersecting<T: Real>(soup: &Soup<T>, candidates: &[PrimitiveId], bounds: &Aabb<T>) -> Vec<PrimitiveId> {
    candidates.iter().copied().filter(|id| soup.get(*id).intersects_box(bounds)).collect()
}

#[test]
fn trees_find_the_same_primitives_as_brute_force_in_random_scenes() {
    let rules = SplitRule::ALL;
    let count = 24 * rules.len() as u64;
    for case in cases(count, count) {
        let mut rng = rng("boxes in scenes", case);
        let ((kinds, layout), rule) = (kinds_and_layout(case), rules[(case / 24) as usize % rules.len()]);
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 120));
        let tree = AabbTree::build(&soup, &p2m_bvh::SplitOptions::default().with_rule(rule)).unwrap();
        let brute = BruteForce::new(&soup).unwrap();
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        for _ in 0..amount(100, 10) {
            let bounds = random_box(&mut rng, &soup, &soup.aabb());
            tree.primitives_in_box_into(&bounds, &mut found);
            brute.primitives_in_box_into(&bounds, &mut expected);
            assert_eq!(found, expected, "case {case}: {kinds:?} {layout:?} {rule:?} {bounds:?}");
            assert_eq!(tree.intersects_box(&bounds), !expected.is_empty());
        }
    }
}

/// Every split rule leads to exact answers; only the work differs.
#[test]
fn split_rules_change_no_answer() {
    for case in cases(6, 6) {
        let mut rng = rng("split rules", case);
        let layout = LAYOUTS[(case % 6) as usize];
        let soup = scenes::soup(&mut rng, Kinds::Mixed, layout, amount(500, 150));
        let brute = BruteForce::new(&soup).unwrap();
        for rule in SplitRule::ALL {
            let tree = AabbTree::build(&soup, &p2m_bvh::SplitOptions::default().with_rule(rule)).unwrap();
            for _ in 0..amount(50, 8) {
                let query = random_box(&mut rng, &soup, &soup.aabb()).min;
                let [a, b] = [tree.closest_point(&query).unwrap(), brute.closest_point(&query).unwrap()];
                assert_eq!((a.distance, a.primitive), (b.distance, b.primitive), "{layout:?} {rule:?} {query}");
            }
        }
    }
}

#[test]
fn trees_find_the_same_primitives_as_brute_force_in_every_model() {
    let boxes_of_each = amount(10_000, 60);
    for path in p2m_testkit::model_files() {
        let soup = p2m_mixed::read_scene(&path).expect("readable").soup;
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let tree = AabbTree::new(&soup).expect("valid");
        let boxes = Boxes::new(&soup);
        let counts: Vec<[usize; 2]> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..2)
                .map(|thread| {
                    let (soup, tree, boxes, name) = (&soup, &tree, &boxes, &name);
                    scope.spawn(move || {
                        let mut rng = rng("boxes in models", thread);
                        let scene = soup.aabb();
                        let mut found = Vec::new();
                        let (mut met, mut checked) = (0, 0);
                        for _ in 0..boxes_of_each / 2 {
                            let bounds = random_box(&mut rng, soup, &scene);
                            tree.primitives_in_box_into(&bounds, &mut found);
                            let candidates = boxes.intersecting(&bounds);
                            assert_eq!(found, intersecting(soup, &candidates, &bounds), "{name} {bounds:?}");
                            assert_eq!(tree.intersects_box(&bounds), !found.is_empty(), "{name} {bounds:?}");
                            met += found.len();
                            // Rational arithmetic checks a few of the candidates whose boxes intersect.
                            for id in candidates.into_iter().take(2) {
                                let primitive = soup.get(id);
                                let vertices: Vec<[f64; 3]> =
                                    primitive.vertices().iter().map(|v| v.coords.into()).collect();
                                let corners = [bounds.min.coords.into(), bounds.max.coords.into()];
                                assert_eq!(
                                    found.binary_search(&id).is_ok(),
                                    oracle::intersects_box(&vertices, &corners),
                                    "{name} {id} {bounds:?}"
                                );
                                checked += 1;
                            }
                        }
                        [met, checked]
                    })
                })
                .collect();
            threads.into_iter().map(|t| t.join().expect("no panic")).collect()
        });
        let sum = |k: usize| counts.iter().map(|c| c[k]).sum::<usize>();
        println!("{name}: {boxes_of_each} boxes, {} primitives found, {} checked exactly", sum(0), sum(1));
    }
}
