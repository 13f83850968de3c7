//! Hausdorff distances against closed forms and dense samples.

use super::*;
use nalgebra::Vector3;
use p2m_bvh::AabbTree;
use p2m_core::{Aabb, BruteForce, Element, Feature, Primitive, PrimitiveSet, Projection, QueryOptions, Ray, RayHit};
use p2m_testkit::scenes::{self, extreme_soups, kinds_and_layout, narrow};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;
use rand::seq::SliceRandom;

fn go_on<T: Real>(_: &HausdorffProgress<T>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn both<T: Real>(a: &Soup<T>, b: &Soup<T>, options: &HausdorffOptions<T>) -> Option<HausdorffDistance<T>> {
    let [index_a, index_b] = [a, b].map(|soup| AabbTree::new(soup).expect("valid"));
    hausdorff_distance((a, &index_a), (b, &index_b), options, &mut go_on).expect("vertices")
}

fn one_sided<T: Real>(a: &Soup<T>, b: &Soup<T>, options: &HausdorffOptions<T>) -> Option<HausdorffDistance<T>> {
    let index = AabbTree::new(b).expect("valid");
    one_sided_hausdorff_distance(a, &index, options, &mut go_on).expect("vertices")
}

fn soup(positions: &[[f64; 3]], elements: impl IntoIterator<Item = Element>) -> Soup<f64> {
    Soup::new(positions.iter().copied().map(Point3::from).collect(), elements).expect("valid")
}

/// The surface of a box around the origin with edges of twice this length.
fn cube(half: f64) -> Soup<f64> {
    let corner = |i: u32| [0, 1, 2].map(|k| if i >> k & 1 == 1 { half } else { -half });
    let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    soup(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner), halves.map(Element::Triangle))
}

fn assert_contains(found: Option<HausdorffDistance<f64>>, expected: f64, tolerance: f64) {
    let found = found.expect("no scene is empty");
    // The expected value is rounded itself.
    let rounding = 4.0 * f64::EPSILON * expected;
    let is_between = found.lower_bound <= expected + rounding && expected - rounding <= found.upper_bound;
    assert!(is_between && found.upper_bound - found.lower_bound <= tolerance + rounding, "{found:?} {expected}");
}

/// Returns whether a lower bound belongs to a vertex: it is at most one unit in the last place below the distance.
fn is_last_digit(lower: f64, distance: f64) -> bool {
    lower <= distance && distance <= lower.next_up()
}

#[test]
fn a_convex_surface_is_as_far_from_its_copy_as_that_was_moved() {
    for by in [[0.25, 0.0, 0.0], [0.5, -0.25, 3.0]] {
        let cube = cube(1.0);
        let mut moved = cube.clone();
        moved.map_positions(|p| p + Vector3::from(by)).expect("finite");
        let expected = Vector3::from(by).norm();
        assert_contains(both(&cube, &moved, &HausdorffOptions::new(1e-6)), expected, 1e-6);
        assert_contains(one_sided(&moved, &cube, &HausdorffOptions::new(1e-6)), expected, 1e-6);
    }
}

#[test]
fn nested_boxes_are_as_far_as_their_corners() {
    let (inner, outer) = (cube(1.0), cube(2.0));
    let options = HausdorffOptions::new(1e-9);
    assert_contains(one_sided(&inner, &outer, &options), 1.0, 1e-9);
    assert_contains(one_sided(&outer, &inner, &options), 3f64.sqrt(), 1e-9);
    let found = both(&inner, &outer, &options).expect("boxes");
    assert_contains(Some(found), 3f64.sqrt(), 1e-9);
    assert_eq!(found.direction, Direction::SecondToFirst);
    assert_eq!(found.points, [Point3::new(-1.0, -1.0, -1.0), Point3::new(-2.0, -2.0, -2.0)]);
    assert_eq!(both(&outer, &inner, &options).expect("boxes").direction, Direction::FirstToSecond);
}

#[test]
fn the_farthest_point_may_be_inside_of_a_triangle() {
    // The circumcentre of an equilateral triangle.
    let height = 0.75f64.sqrt();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]];
    let triangle = soup(&corners, [Element::Triangle([0, 1, 2])]);
    let points = soup(&corners, [0, 1, 2].map(Element::Point));
    assert_contains(one_sided(&triangle, &points, &HausdorffOptions::new(1e-10)), 1.0 / 3f64.sqrt(), 1e-10);
    let found = one_sided(&triangle, &points, &HausdorffOptions::new(1e-10)).expect("a triangle");
    assert!((found.points[0] - Point3::new(0.5, height / 3.0, 0.0)).norm() < 1e-9, "{found:?}");
}

#[test]
fn segments_and_points_count_beside_triangles() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.5, 0.0, 5.0]];
    let floor = soup(&positions, [Element::Triangle([0, 1, 2])]);
    let with_pole = soup(&positions, [Element::Triangle([0, 1, 2]), Element::Segment([0, 3])]);
    let with_lamp = soup(&positions, [Element::Triangle([0, 1, 2]), Element::Segment([0, 3]), Element::Point(4)]);
    let options = HausdorffOptions::new(1e-6);
    let expected = [(&floor, 0.0, [0, 0]), (&with_pole, 2.0, [1, 0]), (&with_lamp, 5.0, [2, 0])];
    for (scene, distance, primitives) in expected {
        assert_contains(both(scene, &floor, &options), distance, 1e-6);
        let found = both(scene, &floor, &options).expect("scenes");
        assert_eq!(found.primitives.map(PrimitiveId::index), primitives);
        assert!(is_last_digit(found.lower_bound, distance), "{found:?}");
    }
}

#[test]
fn point_sets_are_as_far_as_the_largest_of_the_smallest_distances() {
    for case in cases(2_000, 100) {
        let mut rng = rng("hausdorff of points", case);
        let layout = kinds_and_layout(case).1;
        let [a, b] = [40, 25].map(|len| scenes::soup(&mut rng, scenes::Kinds::Points, layout, len));
        let expected = farthest_vertex(&a, &b).max(farthest_vertex(&b, &a));
        let found = both(&a, &b, &HausdorffOptions::new(0.0)).expect("points");
        assert!(found.lower_bound <= expected && expected <= found.upper_bound, "{case}: {found:?} {expected}");
        let size = a.positions().iter().chain(b.positions()).map(|p| p.coords.amax()).fold(0.0, f64::max);
        assert!(found.upper_bound - found.lower_bound <= 40.0 * f64::EPSILON * size, "{case}: {found:?}");
    }
}

/// Returns the largest certified distance of a vertex of `a` from `b`, without an index.
fn farthest_vertex(a: &Soup<f64>, b: &Soup<f64>) -> f64 {
    let vertices = (0..a.len()).flat_map(|i| a.get(PrimitiveId::new(i)).vertices().to_vec());
    vertices.map(|v| certified(b, &v).distance).fold(0.0, f64::max)
}

fn certified<T: Real>(scene: &Soup<T>, query: &Point3<T>) -> p2m_core::Closest<T> {
    let index = BruteForce::new(scene).expect("valid");
    index.certified_closest_point(query, &QueryOptions::default()).expect("vertices").expect("not empty")
}

/// Returns points of all primitives of a scene, by weights that are multiples of 1 / `steps`, and a bound on the
/// distance of any point of the scene from them.
fn samples<T: Real>(scene: &Soup<T>, steps: u32) -> (Vec<Point3<T>>, f64) {
    let (mut all, mut reach) = (Vec::new(), 0.0f64);
    for i in 0..scene.len() {
        let primitive = scene.get(PrimitiveId::new(i));
        let vertices: Vec<_> = primitive.vertices().iter().map(|v| v.map(T::to_f64)).collect();
        let corner = |k: usize| vertices[k.min(vertices.len() - 1)];
        for (i, j) in (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| (i, j))) {
            let weights = [i, j, steps - i - j].map(|n| f64::from(n) / f64::from(steps));
            let sum = (0..3).map(|k| corner(k).coords * weights[k]).sum::<Vector3<f64>>();
            all.push(Point3::from(sum.map(T::round_from_f64)));
        }
        let longest = vertices.iter().flat_map(|v| vertices.iter().map(move |w| (v - w).norm())).fold(0.0, f64::max);
        reach = reach.max(longest / f64::from(steps));
    }
    (all, reach)
}

/// Checks the bounds of a one-sided distance against dense samples.
fn check_by_samples<T: Real>(case: u64, a: &Soup<T>, b: &Soup<T>, tolerance: f64) {
    let options = HausdorffOptions::new(T::round_from_f64(tolerance)).with_max_queries(200_000);
    let Some(found) = one_sided(a, b, &options) else {
        assert!(a.is_empty() || b.is_empty(), "{case}");
        return;
    };
    let (points, reach) = samples(a, amount(12, 6));
    let sampled = points.iter().map(|p| certified(b, p).distance.to_f64()).fold(0.0, f64::max);
    let size = a.positions().iter().chain(b.positions()).map(|p| p.coords.amax().to_f64()).fold(0.0, f64::max);
    let rounding = 8.0 * T::UNIT_ROUNDOFF * size;
    let (lower, upper) = (found.lower_bound.to_f64(), found.upper_bound.to_f64());
    let text = || format!("{case}: {found:?}, sampled {sampled} and at most {reach} more");
    assert!(lower <= upper, "{}", text());
    assert!(sampled <= upper + rounding, "{}", text());
    assert!(lower <= sampled + reach + rounding, "{}", text());
    assert!(upper - lower <= tolerance + 100.0 * rounding, "{}", text());
    // The points are on the primitives, and as far apart as they are said to be.
    let on = |scene: &Soup<T>, k: usize| {
        let projection = scene.get(found.primitives[k]).project(&found.points[k]);
        assert!(projection.key.distance() <= 100.0 * rounding, "{}", text());
    };
    on(a, 0);
    on(b, 1);
    let closest = certified(b, &found.points[0]);
    assert!(closest.primitive == found.primitives[1] && found.lower_bound <= closest.lower_bound, "{}", text());
    assert!(closest.distance.to_f64() - lower <= 100.0 * rounding, "{}", text());
}

#[test]
fn bounds_agree_with_dense_samples() {
    for case in cases(4_000, 150) {
        let (mut rng, (kinds, layout)) = (rng("hausdorff", case), kinds_and_layout(case));
        let other = kinds_and_layout(rng.random()).0;
        let lens = [rng.random_range(0..12), rng.random_range(0..40)];
        let [a, b] = [scenes::soup(&mut rng, kinds, layout, lens[0]), scenes::soup(&mut rng, other, layout, lens[1])];
        check_by_samples(case, &a, &b, 0.01);
        if let [Some(a), Some(b)] = [narrow(&a), narrow(&b)] {
            // In f32 a scene far from the origin has a resolution of 1/16.
            check_by_samples(case, &a, &b, 0.02);
        }
    }
}

#[test]
fn neither_threads_nor_the_order_of_primitives_matter() {
    for case in cases(1_000, 60) {
        let (mut rng, (kinds, layout)) = (rng("orders of hausdorff", case), kinds_and_layout(case));
        let [a, b] = [30, 50].map(|len| scenes::soup(&mut rng, kinds, layout, len));
        let options = HausdorffOptions::new(1e-3).with_max_queries(200_000);
        let found = both(&a, &b, &options).expect("not empty");
        assert_eq!(both(&a, &b, &options.with_parallel(false)), Some(found), "{case}");
        let [a, b] = [&a, &b].map(|soup| {
            let mut elements: Vec<_> = soup.elements().collect();
            elements.shuffle(&mut rng);
            Soup::new(soup.positions().to_vec(), elements).expect("valid")
        });
        let shuffled = both(&b, &a, &options).expect("not empty");
        assert!(
            shuffled.lower_bound <= found.upper_bound && found.lower_bound <= shuffled.upper_bound,
            "{case}: {found:?} {shuffled:?}"
        );
    }
}

#[test]
fn a_scene_has_no_distance_from_itself() {
    let ball = p2m_mixed::generate::ico_sphere(&p2m_mixed::generate::IcoSphere { frequency: 8 }).expect("valid");
    let found = both(&ball, &ball, &HausdorffOptions::new(0.0)).expect("a ball");
    assert!(found.lower_bound == 0.0 && found.upper_bound < 20.0 * f64::EPSILON, "{found:?}");
}

#[test]
fn scales_do_not_matter() {
    for (case, a, _) in extreme_soups("scales of hausdorff") {
        if a.is_empty() {
            continue;
        }
        let b = soup_of_first(&a);
        let found = one_sided(&a, &b, &HausdorffOptions::new(0.0).with_max_queries(5_000)).expect("not empty");
        let expected = farthest_vertex(&a, &b);
        // The scene b is convex, so a vertex is farthest.
        assert!(found.lower_bound <= expected && expected <= found.upper_bound, "{case}: {found:?} {expected:e}");
        if expected < f64::MAX {
            let size = a.positions().iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
            let rounding = 60.0 * (f64::EPSILON * size + f64::from_bits(1));
            assert!(found.upper_bound - found.lower_bound <= rounding, "{case}: {found:?}");
        }
    }
}

/// Returns the scene of the first primitive of a scene.
fn soup_of_first(a: &Soup<f64>) -> Soup<f64> {
    Soup::new(a.positions().to_vec(), a.elements().take(1)).expect("valid")
}

#[test]
fn every_tolerance_ends() {
    // The plates are equally far everywhere, and their diagonals differ.
    let at = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let plate = soup(&at(0.0), [Element::Triangle([0, 1, 2]), Element::Triangle([0, 2, 3])]);
    let other = soup(&at(1.0), [Element::Triangle([0, 1, 3]), Element::Triangle([1, 2, 3])]);
    for tolerance in [0.0, -1.0, f64::NAN, 1e-300] {
        let found = both(&plate, &other, &HausdorffOptions::new(tolerance).with_max_queries(50_000)).expect("plates");
        assert!(is_last_digit(found.lower_bound, 1.0) && (1.0..1.0 + 1e-3).contains(&found.upper_bound), "{found:?}");
        assert!(found.queries <= 50_008, "{found:?}");
    }
    let found = both(&plate, &other, &HausdorffOptions::new(f64::INFINITY)).expect("plates");
    assert!(found.queries == 8 && is_last_digit(found.lower_bound, 1.0) && found.upper_bound >= 1.0, "{found:?}");
    assert_contains(both(&plate, &other, &HausdorffOptions::new(1e-6)), 1.0, 1e-6);
}

#[test]
fn empty_scenes_have_no_distance() {
    let (cube, empty) = (cube(1.0), Soup::default());
    let options = HausdorffOptions::new(1e-3);
    for [a, b] in [[&cube, &empty], [&empty, &cube], [&empty, &empty]] {
        assert_eq!(both(a, b, &options), None);
        assert_eq!(one_sided(a, b, &options), None);
    }
}

/// A primitive without vertices: the point at the origin.
struct Origin;

impl Primitive<f64> for Origin {
    fn aabb(&self) -> Aabb<f64> {
        Aabb::from_points(&[Point3::origin()])
    }
    fn project(&self, query: &Point3<f64>) -> Projection {
        Projection::new(query, Point3::origin(), Feature::Vertex(0), [1.0, 0.0, 0.0], 0.0)
    }
    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        None
    }
}

#[test]
fn primitives_without_vertices_are_an_error() {
    let index = BruteForce::new([Origin]).expect("valid");
    let found = one_sided_hausdorff_distance(&cube(1.0), &index, &HausdorffOptions::new(0.1), &mut go_on);
    assert_eq!(found, Err(CertifyError::NoVertices { id: PrimitiveId::new(0) }));
}

#[test]
fn positions_that_no_primitive_uses_do_not_count() {
    let with_far = soup(&[[9.0; 3], [0.0; 3], [f64::NAN; 3], [1.0, 0.0, 0.0]], [Element::Segment([1, 3])]);
    let point = soup(&[[0.0; 3]], [Element::Point(0)]);
    let found = both(&with_far, &point, &HausdorffOptions::new(0.0)).expect("not empty");
    assert!(is_last_digit(found.lower_bound, 1.0) && found.queries == 3, "{found:?}");
}

#[test]
fn a_search_that_is_ended_has_the_bounds_so_far() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let triangle = soup(&corners, [Element::Triangle([0, 1, 2])]);
    let points = soup(&corners, [0, 1, 2].map(Element::Point));
    let index = BruteForce::new(&points).expect("valid");
    let options = HausdorffOptions::new(0.0);
    let mut finite = 0;
    for reports in 1..200 {
        let (mut left, mut last) = (reports, (0.0, f64::INFINITY, 0));
        let mut stop = |progress: &HausdorffProgress<f64>| {
            let HausdorffProgress { lower_bound, upper_bound, queries } = *progress;
            assert!(last.0 <= lower_bound && upper_bound <= last.1 && last.2 <= queries, "{last:?} {progress:?}");
            last = (lower_bound, upper_bound, queries);
            left -= 1;
            if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let found = one_sided_hausdorff_distance(&triangle, &index, &options, &mut stop).expect("vertices");
        let found = found.expect("not empty");
        // The middle of the longest edge is farthest.
        assert!(found.lower_bound <= 0.5f64.sqrt() && 0.5f64.sqrt() <= found.upper_bound, "{found:?}");
        if left > 0 {
            assert!(finite > 2, "{reports} reports, of which {finite} have an upper bound");
            return;
        }
        assert_eq!((found.lower_bound, found.upper_bound, found.queries), last);
        finite += usize::from(found.upper_bound < f64::INFINITY);
    }
    panic!("the search has more reports than expected");
}

/// The surface of the cube from 0 to 1, whose faces are divided into squares, turned.
fn divided_cube<T: Real>(count: u32) -> Soup<T> {
    let turn = nalgebra::Rotation3::new(Vector3::new(0.3, -0.2, 0.5));
    let (mut positions, mut elements) = (Vec::new(), Vec::new());
    for (axis, end) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        let first = u32::try_from(positions.len()).expect("few");
        for (i, j) in (0..=count).flat_map(|i| (0..=count).map(move |j| (i, j))) {
            let mut at = Vector3::zeros();
            (at[axis], at[(axis + 1) % 3]) = (end, f64::from(i) / f64::from(count));
            at[(axis + 2) % 3] = f64::from(j) / f64::from(count);
            positions.push(Point3::from((turn * at).map(T::round_from_f64)));
            if i < count && j < count {
                let a = first + i * (count + 1) + j;
                let (b, c, d) = (a + 1, a + count + 1, a + count + 2);
                elements.extend([Element::Triangle([a, c, d]), Element::Triangle([a, d, b])]);
            }
        }
    }
    Soup::new(positions, elements).expect("valid")
}

/// Pieces lie on several triangles of a plane, or nearly of one, and on none alone.
#[test]
fn the_same_surface_with_other_triangles_takes_few_queries() {
    for (counts, most) in [([1, 7], 60_000), ([16, 7], 150_000), ([5, 5], 20_000)] {
        let [a, b] = counts.map(divided_cube::<f64>);
        for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
            let found = both(&a, &b, &HausdorffOptions::new(tolerance)).expect("cubes");
            println!("{counts:?} {tolerance:e}: {} queries, {:e}", found.queries, found.upper_bound);
            assert!(found.is_tolerance_reached && found.upper_bound <= 2.0 * tolerance, "{counts:?}: {found:?}");
            assert!(found.queries < most, "{counts:?}, {tolerance}: {} queries", found.queries);
        }
        let [a, b] = counts.map(divided_cube::<f32>);
        let found = both(&a, &b, &HausdorffOptions::new(1e-4)).expect("cubes");
        assert!(found.is_tolerance_reached && found.queries < most, "{counts:?}: {found:?}");
    }
}

#[test]
fn a_divided_convex_surface_is_as_far_from_its_copy_as_that_was_moved() {
    for counts in [[1, 7], [4, 3]] {
        let [a, mut b] = counts.map(divided_cube::<f64>);
        let by = Vector3::new(0.25, -0.5, 0.125);
        b.map_positions(|p| p + by).expect("finite");
        let found = both(&a, &b, &HausdorffOptions::new(1e-9));
        assert_contains(found, by.norm(), 1e-9);
        assert!(found.expect("cubes").queries < 5_000, "{found:?}");
    }
}

#[test]
fn lines_with_other_vertices_are_the_same() {
    let line = |count: u32| {
        let at = |i: u32| [1.0, 0.3, 0.7].map(|x| x * f64::from(i) / f64::from(count));
        soup(&(0..=count).map(at).collect::<Vec<_>>(), (0..count).map(|i| Element::Segment([i, i + 1])))
    };
    let found = both(&line(7), &line(16), &HausdorffOptions::new(1e-12)).expect("lines");
    assert!(found.is_tolerance_reached && found.upper_bound <= 2e-12 && found.queries < 1_000, "{found:?}");
}

#[test]
fn a_tolerance_that_is_not_reached_is_said() {
    let [a, b] = [1, 7].map(divided_cube::<f64>);
    let found = both(&a, &b, &HausdorffOptions::new(1e-6).with_max_queries(3)).expect("cubes");
    assert!(!found.is_tolerance_reached && found.upper_bound > found.lower_bound + 1e-6, "{found:?}");
}
