//! Tests of the nearest pairs of scenes, and of scenes and shapes. All pairs, which p2m-core compares with rational
//! arithmetic, are the reference.
#![cfg(all(feature = "bvh", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Isometry3, Point3, Vector3};
use p2m::batch::Interruptible;
use p2m::pair::{ClosestPair, Motion, PairOptions, PairQuery};
use p2m::{AabbTree, BruteForce, Element, KdopTree, PrimitiveId, PrimitiveSet, Real, Shape, Soup, SplitOptions};
use p2m_testkit::scenes::{self, kinds_and_layout};
use p2m_testkit::{amount, cases, rng, vector};
use rand::{Rng, RngExt};
use std::cell::Cell;
use std::ops::ControlFlow;

/// Returns the answer for two scenes by evaluating all pairs.
fn by_all_pairs<T: Real>(a: &Soup<T>, b: &Soup<T>, options: &PairOptions<T>) -> Option<ClosestPair<T>> {
    let [a, b] = [a, b].map(|soup| BruteForce::new(soup).expect("valid"));
    a.closest_pair(&b, options)
}

/// Returns a motion: none, a translation, or a rotation with a translation; small, about as large as the scene, or far.
fn motion(rng: &mut impl Rng, size: f64) -> Option<Isometry3<f64>> {
    let far = [0.0, 0.01, 0.5, 1.0, 1.5, 30.0][rng.random_range(0..6)] * size;
    let turn = [Vector3::zeros(), vector(rng) * 3.0][rng.random_range(0..2)];
    (rng.random_range(0..4) > 0).then(|| Isometry3::new(vector(rng) * far, turn))
}

/// Asserts that two answers are equal except for their lower bounds, which depend on the pairs that a search evaluates.
fn assert_same<T: Real>(found: Option<ClosestPair<T>>, expected: Option<ClosestPair<T>>, text: &str) {
    let bits = |pair: &ClosestPair<T>| {
        (
            pair.distance.to_f64().to_bits(),
            pair.primitives,
            pair.points,
            pair.features,
            pair.barycentric,
            pair.is_intersecting,
        )
    };
    assert_eq!(found.as_ref().map(bits), expected.as_ref().map(bits), "{text}");
    if let (Some(found), Some(expected)) = (found, expected) {
        assert!(found.lower_bound <= expected.distance && found.lower_bound >= T::zero(), "{text}");
    }
}

fn check_scenes<T: Real>(case: u64, soups: [&Soup<T>; 2], moved: Option<Isometry3<f64>>, limit: T) -> bool {
    let [a, b] = soups;
    let mut options = PairOptions::default().with_max_distance(limit);
    options.motion = moved;
    let expected = by_all_pairs(a, b, &options);
    let [aabb_a, aabb_b] = soups.map(|soup| AabbTree::new(soup).expect("valid"));
    let kdop_b: KdopTree<T, _> = KdopTree::new(b).expect("valid");
    let text = format!("{case}: {options:?}");
    assert_same(aabb_a.closest_pair(&aabb_b, &options), expected, &text);
    assert_same(aabb_a.closest_pair(&kdop_b, &options), expected, &text);
    // Ids that a scene does not have are ignored.
    for hint in [[a.len() / 2, b.len() / 3], [a.len(), 0], [0, b.len()]] {
        let hinted = options.with_hint(hint.map(PrimitiveId::new));
        assert_same(aabb_a.closest_pair(&aabb_b, &hinted), expected, &text);
    }
    assert_eq!(aabb_a.is_any_pair_near(&aabb_b, &options), expected.is_some(), "{text}");
    // All pairs within a distance are the same as by brute force.
    if let Some(nearest) = expected {
        let factor = T::round_from_f64(1.05);
        let within = options.with_max_distance(nearest.distance * factor);
        let mut found = Vec::new();
        let _ = aabb_a.visit_pairs_within(&aabb_b, &within, &mut |pair| {
            found.push((pair.primitives, pair.distance.to_f64().to_bits()));
            ControlFlow::Continue(())
        });
        let mut all = Vec::new();
        let [brute_a, brute_b] = soups.map(|soup| BruteForce::new(soup).expect("valid"));
        let _ = brute_a.visit_pairs_within(&brute_b, &within, &mut |pair| {
            all.push((pair.primitives, pair.distance.to_f64().to_bits()));
            ControlFlow::Continue(())
        });
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all, "{text}");
    }
    expected.is_some_and(|pair| pair.is_intersecting)
}

#[test]
fn pairs_of_scenes_are_those_of_brute_force() {
    let mut intersecting = 0;
    let all = cases(10_000, 300);
    for case in all.clone() {
        let (mut rng, (kinds, layout)) = (rng("pairs of scenes", case), kinds_and_layout(case));
        let (other_kinds, other_layout) = kinds_and_layout(rng.random());
        let len = rng.random_range(1..90);
        let a = scenes::soup(&mut rng, kinds, layout, len);
        let b = match rng.random_range(0..3) {
            0 => a.clone(),
            1 => scenes::soup(&mut rng, kinds, layout, 40),
            _ => scenes::soup(&mut rng, other_kinds, other_layout, 60),
        };
        let bounds = a.aabb();
        let moved = motion(&mut rng, (bounds.max - bounds.min).amax());
        let limit = if rng.random_range(0..4) == 0 { (bounds.max - bounds.min).amax() * 0.3 } else { f64::INFINITY };
        intersecting += usize::from(check_scenes(case, [&a, &b], moved, limit));
    }
    assert!(all.have_more_than(50, intersecting), "{intersecting}");
}

#[test]
fn pairs_in_f32_are_those_of_brute_force() {
    for case in cases(1_000, 60) {
        let (mut rng, (kinds, layout)) = (rng("pairs in f32", case), kinds_and_layout(case));
        let [a, b] = [50, 70].map(|len| single(&scenes::soup(&mut rng, kinds, layout, len)));
        let bounds = a.aabb().to_f64();
        let moved = motion(&mut rng, (bounds.max - bounds.min).amax());
        check_scenes(case, [&a, &b], moved, f32::INFINITY);
    }
}

#[allow(clippy::cast_possible_truncation, reason = "a scene in f32")]
fn single(soup: &Soup<f64>) -> Soup<f32> {
    let positions = soup.positions().iter().map(|p| p.map(|x| x as f32)).collect();
    Soup::new(positions, (0..soup.len()).map(|i| soup.element(PrimitiveId::new(i)))).expect("valid")
}

#[test]
fn shapes_against_scenes_are_those_of_brute_force() {
    for case in cases(3_000, 200) {
        let (mut rng, (kinds, layout)) = (rng("shapes against scenes", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(400, 120));
        let other_kinds = kinds_and_layout(rng.random()).0;
        let shapes = scenes::soup(&mut rng, other_kinds, layout, 6);
        let bounds = soup.aabb();
        let size = (bounds.max - bounds.min).amax();
        let brute = BruteForce::new(&soup).expect("valid");
        let tree = AabbTree::new(&soup).expect("valid");
        let kdop: KdopTree<f64, _> = KdopTree::new(&soup).expect("valid");
        for id in (0..shapes.len()).map(PrimitiveId::new) {
            let shape: Shape<f64> = shapes.get(id);
            let mut options = PairOptions::default();
            options.motion = motion(&mut rng, size);
            let expected = brute.closest_to(&shape, &options);
            let text = format!("{case}: {shape:?}, {options:?}");
            assert!(expected.is_some(), "{text}");
            assert_same(tree.closest_to(&shape, &options), expected, &text);
            assert_same(kdop.closest_to(&shape, &options), expected, &text);
            let distance = expected.map_or(0.0, |pair| pair.distance);
            for limit in [distance, distance.next_down(), distance * 0.5] {
                let limited = options.with_max_distance(limit).with_hint([PrimitiveId::new(7), PrimitiveId::new(0)]);
                let is_within = distance <= limit;
                assert_eq!(tree.is_any_near(&shape, &limited), is_within, "{text} {limit:e}");
                assert_same(tree.closest_to(&shape, &limited), expected.filter(|_| is_within), &text);
            }
        }
    }
}

/// Returns a scene after a random deformation: stretched, flattened, put on a sphere or unchanged; scaled; and moved.
fn deformed(rng: &mut impl Rng, soup: &Soup<f64>) -> Soup<f64> {
    let scale = [[1.0; 3], [1000.0, 1.0, 1.0], [1.0, 1e-9, 1.0]][rng.random_range(0..3)];
    let is_round = rng.random_range(0..4) == 0;
    let size = [1.0, 1.0, 512.0, 4096.0, 2f64.powi(-12)][rng.random_range(0..5)];
    let place = vector(rng) * [0.0, 0.0, 1e3, 1e9][rng.random_range(0..4)];
    let mut soup = soup.clone();
    let image = |p: Point3<f64>| {
        let norm = p.coords.norm();
        let at = if is_round && norm > 0.0 { p.coords / norm } else { p.coords.component_mul(&Vector3::from(scale)) };
        Point3::from(at * size + place)
    };
    soup.map_positions(image).expect("finite");
    soup
}

/// The motion brings the second scene to the first.
#[test]
fn scenes_of_other_shapes_sizes_and_places_have_the_pairs_of_brute_force() {
    for case in cases(5_000, 200) {
        let mut rng = rng("deformed scenes", case);
        let [a, b] = [90, 60].map(|len| {
            let (kinds, layout) = kinds_and_layout(rng.random());
            let soup = scenes::soup(&mut rng, kinds, layout, len);
            deformed(&mut rng, &soup)
        });
        let size = (a.aabb().max - a.aabb().min).amax();
        let [centre_a, centre_b] = [&a, &b].map(|soup| nalgebra::center(&soup.aabb().min, &soup.aabb().max));
        let turn = Isometry3::rotation([Vector3::zeros(), vector(&mut rng) * 3.0][rng.random_range(0..2)]);
        let aside = vector(&mut rng) * size * [0.0, 0.1, 1.0, 2.5][rng.random_range(0..4)];
        let shift = centre_a - turn * centre_b + aside;
        check_scenes(case, [&a, &b], Some(Isometry3::from_parts(shift.into(), turn.rotation)), f64::INFINITY);
    }
}

/// The vertices of the second scene have rounding errors from where they were made, which far exceed the rounding of a
/// scene that is already in place. So of many about equally near pairs, any one may be the nearest.
#[test]
fn a_scene_that_comes_from_far_away_has_the_pairs_of_its_rounded_vertices() {
    for case in cases(300, 12) {
        let mut rng = rng("scenes from far away", case);
        let noise = [1e-9, 1e-6][rng.random_range(0..2)];
        let mut grid = || -> Vec<Point3<f64>> {
            let mut at = |i: u32| {
                let [x, y] = [i % 25, i / 25].map(|k| f64::from(k) * 0.125);
                [x, y, noise * rng.random_range(-1.0..1.0)]
            };
            (0..625).map(|i| at(i).into()).collect()
        };
        let [a, b] = [grid(), grid()];
        let turn = [Vector3::zeros(), Vector3::z(), Vector3::x() * std::f64::consts::PI][rng.random_range(0..3)];
        let far = vector(&mut rng) * [1e9, 3e10, 1e11][rng.random_range(0..3)];
        let moved = Isometry3::new(far, turn);
        let back = moved.inverse() * Isometry3::translation(0.0, 0.0, [0.1, 1.0, 5.0][rng.random_range(0..3)]);
        let [a, b] = [a, b.iter().map(|point| back * point).collect()]
            .map(|positions| Soup::new(positions, (0..625).map(Element::Point)).expect("valid"));
        let options = PairOptions::default().with_motion(moved);
        let expected = by_all_pairs(&a, &b, &options);
        let [tree_a, tree_b] = [&a, &b].map(|soup| AabbTree::new(soup).expect("valid"));
        assert_same(tree_a.closest_pair(&tree_b, &options), expected, &format!("{case}"));
    }
}

/// Two parallel sheets that are not axis-aligned are about equally far apart everywhere, and so are a sheet and a
/// triangle, so rounding decides which pair is nearest. A bound without its margin would leave the nearest pair out.
#[test]
fn parallel_sheets_have_the_pairs_of_brute_force() {
    for case in cases(10_000, 100) {
        let mut rng = rng("parallel sheets", case);
        let noise = [0.0, 1e-15, 1e-12, 1e-9, 1e-7][rng.random_range(0..5)];
        let (side, gap) = (rng.random_range(5..13), [1e-5, 1e-3, 1.0, 5.0][rng.random_range(0..4)]);
        let turn = Isometry3::rotation(vector(&mut rng) * 3.0);
        let place = vector(&mut rng) * [0.0, 1.0, 1e3, 1e9, 1e11][rng.random_range(0..5)];
        let is_surface = rng.random_range(0..2) == 0;
        let mut sheet = |level: f64| {
            let mut at = |i: u32| {
                let [x, y] = [i % side, i / side].map(|k| f64::from(k) * 0.125);
                turn * Point3::new(x, y, level + noise * rng.random_range(-1.0..1.0)) + place
            };
            let positions = (0..side * side).map(&mut at).collect();
            let corners = |i: u32| [i, i + 1, i + side].map(|k| k % (side * side));
            let element = |i| if is_surface { Element::Triangle(corners(i)) } else { Element::Point(i) };
            Soup::new(positions, (0..side * side).map(element)).expect("valid")
        };
        let [a, b] = [sheet(0.0), sheet(gap)];
        let corner = |x, y| turn * Point3::new(x, y, -gap) + place;
        let shape = p2m::Triangle::new(corner(-9.0, -7.0), corner(8.0, -6.0), corner(1.0, 9.0));
        let [brute, tree] = [
            BruteForce::new(&a).expect("valid").closest_to(&shape, &PairOptions::default()),
            AabbTree::new(&a).expect("valid").closest_to(&shape, &PairOptions::default()),
        ];
        assert_same(tree, brute, &format!("{case}: a shape"));
        if case % 2 == 0 {
            check_scenes(case, [&a, &b], None, f64::INFINITY);
        } else {
            // The second scene is moved to its place from elsewhere.
            let moved = Isometry3::new(vector(&mut rng) * 3.0, vector(&mut rng) * 3.0);
            let mut away = b.clone();
            away.map_positions(|p| moved.inverse() * p).expect("finite");
            check_scenes(case, [&a, &away], Some(moved), f64::INFINITY);
        }
    }
}

/// Returns a tree whose packets have one primitive each. The boxes of packets of points then have no extent, and bounds
/// between them are as tight as rounding allows.
fn finest_tree(soup: &Soup<f64>) -> AabbTree<f64, &Soup<f64>> {
    let mut options = SplitOptions::default();
    options.max_leaf = 1;
    AabbTree::build_with(soup, &options).expect("valid")
}

/// The points of one scene are about equally far from the points of the other one, each from its own point, or all in
/// one direction. A bound that exceeds a distance by no more than the rounding of f32 or of a motion leaves the nearest
/// pair out.
#[test]
fn points_at_about_equal_distances_have_the_pairs_of_brute_force() {
    for case in cases(20_000, 600) {
        let mut rng = rng("equal distances", case);
        let count = [40, 150][rng.random_range(0..2)];
        let gap = 2f64.powi(-rng.random_range(1..12));
        let noise = [0.0, 1e-12, 1e-9, 1e-8, 3e-8, 1e-7][rng.random_range(0..6)];
        // A translation of 2^36 rounds vertices by more than f32 rounds bounds.
        let far = vector(&mut rng) * [0.0, 1.0, 1e6, 2f64.powi(35), 2f64.powi(36)][rng.random_range(0..5)];
        let noise = if far.norm() > 1e9 { 1e-5 } else { noise };
        let (is_flat, is_aligned) = (rng.random_range(0..2) == 0, rng.random_range(0..2) == 0);
        let across = [Vector3::z(), vector(&mut rng).normalize()][rng.random_range(0..2)];
        let tilted = nalgebra::UnitQuaternion::rotation_between(&Vector3::z(), &across).unwrap_or_default();
        let moved = Isometry3::new(far, vector(&mut rng) * 3.0);
        let mut at = [Vec::new(), Vec::new()];
        for _ in 0..count {
            let mut place = vector(&mut rng);
            place.z *= if is_flat { noise } else { 1.0 };
            let along = if is_aligned { Vector3::z() } else { vector(&mut rng).normalize() };
            let other = place + along * (gap + noise * rng.random_range(-1.0..1.0));
            at[0].push(Point3::from(tilted * place));
            at[1].push(moved.inverse_transform_point(&Point3::from(tilted * other)));
        }
        let [a, b] = at.map(|positions| {
            let elements = (0..positions.len() as u32).map(Element::Point);
            Soup::new(positions, elements).expect("valid")
        });
        let options = PairOptions::default().with_motion(moved);
        let expected = by_all_pairs(&a, &b, &options);
        let [finest_a, finest_b] = [finest_tree(&a), finest_tree(&b)];
        let [tree_a, tree_b] = [&a, &b].map(|soup| AabbTree::new(soup).expect("valid"));
        let [kdop_a, kdop_b] = [&a, &b].map(|soup| KdopTree::<f64, _, 14>::new(soup).expect("valid"));
        let text = format!("{case}: {options:?}");
        assert_same(finest_a.closest_pair(&finest_b, &options), expected, &text);
        assert_same(tree_a.closest_pair(&finest_b, &options), expected, &text);
        assert_same(tree_a.closest_pair(&tree_b, &options), expected, &text);
        assert_same(kdop_a.closest_pair(&finest_b, &options), expected, &text);
        assert_same(finest_a.closest_pair(&kdop_b, &options), expected, &text);
    }
}

/// Rounding loses the nearest points inside of two long edges, so a pair that is hardly nearer replaces them.
#[test]
fn lower_bounds_hold_where_rounding_leaves_the_nearest_pair_out() {
    let p = [[0.0, 1.4732134762836382e-6, 1.0], [328.4927311896118, -944.5064969457171, 0.9995877563339473]];
    let q = [[-129892406583.04027, -45175667367.752655, 0.0], [110180953874.87888, 38320162459.466866, 0.0]];
    let far = |z: f64| p2m::Point::new([5e12, 5e12, z].into());
    let segment = |[a, b]: [[f64; 3]; 2]| p2m::Segment::new(a.into(), b.into());
    let a = [Shape::from(segment(p)), Shape::from(far(0.999_999_999_999_957_6))];
    let b = [Shape::from(segment(q)), Shape::from(far(0.0))];
    let [tree_a, tree_b] = [&a, &b].map(|shapes| AabbTree::new(shapes).expect("valid"));
    let exact = p2m_testkit::oracle::Distance::between(&p, &q);
    for hint in [[0, 0], [1, 1]] {
        let options = PairOptions::default().with_hint(hint.map(PrimitiveId::new));
        let pair = tree_a.closest_pair(&tree_b, &options).expect("both have primitives");
        assert!(exact.is_at_least(pair.lower_bound), "{pair:?}");
    }
}

/// In scenes with many intersections, only pairs with lower ids than the best are evaluated.
#[test]
fn equal_scenes_are_compared_in_few_steps() {
    let soup = scenes::soup(&mut rng("equal scenes", 0), scenes::Kinds::Segments, scenes::Layout::Strewn, 3_000);
    let tree = AabbTree::new(&soup).expect("valid");
    let pair = tree.closest_pair(&tree, &PairOptions::default()).expect("not empty");
    assert_eq!((pair.distance, pair.is_intersecting, pair.primitives), (0.0, true, [PrimitiveId::new(0); 2]));
}

/// Returns the nearest pair, and the number of steps of the search.
fn counted<T: Real>(
    a: &impl PairQuery<T>,
    b: &impl PairQuery<T>,
    options: &PairOptions<T>,
) -> (Option<ClosestPair<T>>, usize) {
    let steps = Cell::new(0);
    let counting = Interruptible::pairs(a, || {
        steps.set(steps.get() + 1);
        true
    });
    (counting.closest_pair(b, options), steps.get())
}

/// Rounding moves all vertices to few positions, so all pairs are about equally near, and exact ties are common.
#[test]
fn scenes_that_a_translation_swallows_are_compared_in_few_steps() {
    let mut rng = rng("swallowed scenes", 0);
    let [large, small] = [3_000, 300]
        .map(|len| scenes::soup(&mut rng, scenes::Kinds::Triangles, scenes::Layout::Strewn, len))
        .map(|soup| [AabbTree::new(soup.clone()).expect("valid"), AabbTree::new(soup).expect("valid")]);
    for far in [1e14, 1e15, 1e16, 1e17, 1e20, 1e100] {
        for turn in [Vector3::zeros(), Vector3::new(0.3, 0.2, 1.0)] {
            let options = PairOptions::default().with_motion(Isometry3::new(Vector3::new(far, -0.3 * far, 0.0), turn));
            let brute = BruteForce::new(small[0].set()).expect("valid");
            let (found, _) = counted(&small[0], &small[1], &options);
            assert_same(found, brute.closest_pair(&brute, &options), &format!("{far:e}, {turn:?}"));
            // Each scene has more than 200 packets.
            let (_, steps) = counted(&large[0], &large[1], &options);
            assert!(steps < 2_000, "{steps} steps, {far:e}, {turn:?}");
        }
    }
}

/// All pairs of two clouds of equal points are equally near, or all of them intersect.
#[test]
fn clouds_of_equal_points_are_compared_in_few_steps() {
    for (place, is_same) in [([0.1, 0.2, 0.3], false), ([0.0; 3], true)] {
        let [a, b] = [[0.0; 3], place].map(|at| vec![p2m::Point::new(Point3::from(at)); 10_000]);
        let [aabb_a, aabb_b] = [&a, &b].map(|points| AabbTree::new(points).expect("valid"));
        let [kdop_a, kdop_b] = [&a, &b].map(|points| KdopTree::<f64, _, 14>::new(points).expect("valid"));
        let options = PairOptions::default();
        for (found, steps) in [counted(&aabb_a, &aabb_b, &options), counted(&kdop_a, &kdop_b, &options)] {
            let pair = found.expect("not empty");
            assert_eq!((pair.primitives, pair.is_intersecting), ([PrimitiveId::new(0); 2], is_same));
            assert!(steps < 200, "{steps} steps, {place:?}");
        }
    }
}

#[test]
fn searches_for_pairs_end_when_they_are_told_to() {
    let soup = scenes::soup(&mut rng("ended searches", 0), scenes::Kinds::Triangles, scenes::Layout::Strewn, 2_000);
    let (tree, brute) = (AabbTree::new(&soup).expect("valid"), BruteForce::new(&soup).expect("valid"));
    let options = PairOptions::default().with_motion(Isometry3::translation(0.01, 0.0, 0.0)).with_max_distance(0.5);
    let shape = soup.get(PrimitiveId::new(0));
    for last in [0_i32, 5] {
        let left = Cell::new(last);
        let goes_on = || left.replace(left.get() - 1) > 0;
        let (stopping, slow) = (Interruptible::pairs(&tree, goes_on), Interruptible::pairs(&brute, goes_on));
        let mut found = 0;
        let mut count = |_: &_| (found += 1, ControlFlow::Continue(())).1;
        let check = |search: &mut dyn FnMut() -> ControlFlow<()>| {
            left.set(last);
            assert!(search().is_continue());
            assert!(left.get() == -1, "it asks until it has to end, and not again: {left:?}");
        };
        check(&mut || stopping.visit_pairs_within(&tree, &options, &mut count));
        check(&mut || slow.visit_pairs_within(&brute, &options, &mut |_| ControlFlow::Continue(())));
        check(&mut || stopping.visit_near(&shape, &options, &mut |_| ControlFlow::Continue(())));
        check(&mut || slow.visit_near(&shape, &options, &mut |_| ControlFlow::Continue(())));
        assert!(found < 2_000, "{found}");
    }
}

#[test]
fn nothing_is_near_an_empty_scene_or_beyond_the_range() {
    let soup = scenes::soup(&mut rng("pairs of nothing", 0), scenes::Kinds::Triangles, scenes::Layout::Sheet, 20);
    let empty: Soup<f64> = Soup::new(Vec::new(), []).expect("valid");
    let [full, nothing] = [&soup, &empty].map(|soup| AabbTree::new(soup).expect("valid"));
    let options = PairOptions::default();
    assert_eq!(full.closest_pair(&nothing, &options), None);
    assert_eq!(nothing.closest_pair(&full, &options), None);
    for motion in [f64::INFINITY, f64::NAN].map(|x| Isometry3::translation(x, 0.0, 0.0)) {
        assert_eq!(full.closest_pair(&full, &options.with_motion(motion)), None);
        assert_eq!(full.closest_to(&soup.get(PrimitiveId::new(0)), &options.with_motion(motion)), None);
    }
    // The distance is beyond the range of numbers, but its bound is not.
    let far = options.with_motion(Isometry3::translation(f64::MAX, 0.0, f64::MAX));
    let answer = full.closest_to(&soup.get(PrimitiveId::new(0)), &far).expect("a finite shape");
    assert!(answer.distance == f64::INFINITY && answer.lower_bound < f64::INFINITY, "{answer:?}");
    for limit in [f64::NAN, -1.0] {
        assert_eq!(full.closest_pair(&full, &options.with_max_distance(limit)), None);
        assert!(!full.is_any_near(&soup.get(PrimitiveId::new(0)), &options.with_max_distance(limit)));
    }
    // The first triangles of equal scenes intersect.
    let same = full.closest_pair(&full, &options.with_max_distance(0.0)).expect("equal scenes intersect");
    assert_eq!((same.distance, same.is_intersecting, same.primitives), (0.0, true, [PrimitiveId::new(0); 2]));
}

/// Returns the vertices of a primitive after a motion, as the contract moves them.
fn vertices(soup: &Soup<f64>, id: PrimitiveId, motion: Option<&Isometry3<f64>>) -> Vec<[f64; 3]> {
    let motion = motion.map(Motion::new);
    let shape = soup.get(id);
    let corners = shape.vertices().iter().map(|v| <[f64; 3]>::from(v.coords));
    corners.map(|x| motion.as_ref().map_or(x, |motion| motion.apply(x))).collect()
}

#[test]
fn trees_of_many_levels_are_those_of_brute_force() {
    for case in cases(60, 4) {
        let mut rng = rng("large pairs of scenes", case);
        let layout = [scenes::Layout::Sheet, scenes::Layout::Strewn][usize::from(case % 2 == 1)];
        let a = scenes::soup(&mut rng, scenes::Kinds::Triangles, layout, 2_000);
        let b = scenes::soup(&mut rng, scenes::Kinds::Triangles, layout, 1_500);
        let size = (a.aabb().max - a.aabb().min).amax();
        let turn = vector(&mut rng) * 3.0;
        let shift = vector(&mut rng) * size * [0.0, 0.5, 1.2, 4.0][rng.random_range(0..4)];
        check_scenes(case, [&a, &b], Some(Isometry3::new(shift, turn)), f64::INFINITY);
    }
}

#[test]
fn a_radius_is_taken_from_the_distance() {
    for case in cases(3_000, 300) {
        let (mut rng, (kinds, layout)) = (rng("shapes with a radius", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, 40);
        let shapes = scenes::soup(&mut rng, kinds, layout, 3);
        let size = (soup.aabb().max - soup.aabb().min).amax();
        let tree = AabbTree::new(&soup).expect("valid");
        let brute = BruteForce::new(&soup).expect("valid");
        for id in (0..shapes.len()).map(PrimitiveId::new) {
            let shape = shapes.get(id);
            let alone = brute.closest_to(&shape, &PairOptions::default()).expect("not empty");
            let radius = alone.distance * [0.5, 1.0, 1.5, 0.0][rng.random_range(0..4)];
            let options = PairOptions::default().with_radius(radius);
            let thick = tree.closest_to(&shape, &options).expect("not empty");
            let text = format!("{case}: {shape:?} {radius:e}");
            assert_same(brute.closest_to(&shape, &options), Some(thick), &text);
            assert_eq!(thick.distance, (alone.distance - radius).max(0.0), "{text}");
            assert_eq!(thick.primitives, alone.primitives, "{text}");
            let exact = p2m_testkit::oracle::Distance::between(
                &vertices(&soup, thick.primitives[0], None),
                &vertices(&shapes, id, None),
            );
            assert!(exact.is_at_least(thick.lower_bound), "{text}");
            assert_eq!(
                thick.is_intersecting,
                alone.is_intersecting || radius > 0.0 && alone.distance <= radius,
                "{text}"
            );
            if radius > 0.0 && alone.distance.is_normal() && alone.distance < 1e100 {
                let between = nalgebra::distance(&thick.points[0], &thick.points[1]);
                assert!((between - thick.distance).abs() <= 1e-10 * (size + radius), "{text} {between:e}");
            }
            // The largest distance is inclusive.
            let limited = options.with_max_distance(thick.distance);
            if alone.distance <= thick.distance + radius {
                assert!(tree.is_any_near(&shape, &limited), "{text}");
            }
        }
    }
    let tree = AabbTree::new([p2m::Point::new([0.0; 3].into())]).expect("valid");
    for radius in [-1.0, f64::NAN] {
        let options = PairOptions::default().with_radius(radius);
        assert_eq!(tree.closest_to(&p2m::Point::new([0.0; 3].into()), &options), None, "{radius}");
    }
}

#[test]
fn certified_pairs_are_nearest_in_rational_arithmetic() {
    use p2m_testkit::oracle::Distance;
    let mut ties = 0;
    let all = cases(2_000, 150);
    for case in all.clone() {
        let (mut rng, (kinds, layout)) = (rng("certified pairs", case), kinds_and_layout(case));
        let a = scenes::soup(&mut rng, kinds, layout, 12);
        let b = if case % 3 == 0 { a.clone() } else { scenes::soup(&mut rng, kinds, layout, 12) };
        let moved = motion(&mut rng, (a.aabb().max - a.aabb().min).amax());
        let mut options = PairOptions::default();
        options.motion = moved;
        let text = format!("{case}: {options:?}");
        let (mut best, mut equal): (Option<(Distance, [PrimitiveId; 2])>, usize) = (None, 0);
        for i in (0..a.len()).map(PrimitiveId::new) {
            for j in (0..b.len()).map(PrimitiveId::new) {
                let exact = Distance::between(&vertices(&a, i, None), &vertices(&b, j, moved.as_ref()));
                match best.as_ref().map(|(least, _)| exact.compare(least)) {
                    None | Some(std::cmp::Ordering::Less) => (best, equal) = (Some((exact, [i, j])), 0),
                    Some(std::cmp::Ordering::Equal) => equal += 1,
                    Some(std::cmp::Ordering::Greater) => {}
                }
            }
        }
        let (exact, ids) = best.expect("neither is empty");
        ties += usize::from(equal > 0);
        let [tree_a, tree_b] = [&a, &b].map(|soup| AabbTree::new(soup).expect("valid"));
        let found = tree_a.certified_closest_pair(&tree_b, &options).expect("neither is empty");
        assert_eq!(found.primitives, ids, "{text} {found:?}");
        // The exact length is given by the nearest f64 and the remainder.
        assert_eq!(found.distance, exact.length()[0], "{text} {found:?}");
        assert!(exact.is_at_least(found.lower_bound), "{text} {found:?}");
        assert!(found.lower_bound >= found.distance.next_down(), "{text} {found:?}");
        let [brute_a, brute_b] = [&a, &b].map(|soup| BruteForce::new(soup).expect("valid"));
        assert_eq!(brute_a.certified_closest_pair(&brute_b, &options), Some(found), "{text}");
        // The limit is compared without rounding.
        let below = options.with_max_distance(found.distance.next_down());
        assert_eq!(tree_a.certified_closest_pair(&tree_b, &below), None, "{text}");
    }
    assert!(all.have_more_than(20, ties), "{ties}");
}

#[test]
fn pairs_are_found_behind_pointers_and_in_batches() {
    let mut rng = rng("pairs behind pointers", 0);
    let soup = scenes::soup(&mut rng, scenes::Kinds::Triangles, scenes::Layout::Strewn, 60);
    let tree = AabbTree::new(&soup).expect("valid");
    let kdop: KdopTree<f64, _> = KdopTree::new(&soup).expect("valid");
    let brute = BruteForce::new(&soup).expect("valid");
    let indexes: [&dyn p2m::AnyIndex; 3] = [&tree, &kdop, &brute];
    let pairs = indexes.map(|index| index.as_pair_query().expect("it answers queries for pairs"));
    let motions: Vec<_> = (0..20).map(|_| Isometry3::new(vector(&mut rng) * 3.0, vector(&mut rng))).collect();
    let expected: Vec<_> =
        motions.iter().map(|motion| brute.closest_pair(&brute, &PairOptions::default().with_motion(*motion))).collect();
    for a in pairs {
        for b in pairs {
            let found = p2m::pair::closest_pair_at_each(&a, b, &motions, &PairOptions::default(), &Default::default());
            for (found, expected) in found.iter().zip(&expected) {
                assert_same(*found, *expected, "a batch");
            }
        }
        let shapes: Vec<Shape<f64>> = (0..soup.len()).map(|i| soup.get(PrimitiveId::new(i))).collect();
        let options = PairOptions::default().with_motion(motions[0]);
        let found = p2m::pair::closest_to_each(&a, &shapes, &options, &Default::default());
        for (found, shape) in found.iter().zip(&shapes) {
            assert_same(*found, brute.closest_to(shape, &options), "a batch of shapes");
        }
    }
    let octree = p2m::OctreeIndex::new(&soup).expect("valid");
    assert!((&octree as &dyn p2m::AnyIndex).as_pair_query().is_none());
}

/// The distances between the shape and a segment and a point differ by less than the error of the kernel, in either
/// order.
#[test]
fn certified_pairs_distinguish_what_rounding_does_not() {
    use p2m_testkit::oracle::Distance;
    let mut different = 0;
    let all = cases(5_000, 600);
    for case in all.clone() {
        let mut rng = rng("certified near ties", case);
        let [a, b, centre] = [(); 3].map(|()| vector(&mut rng));
        let segment = p2m::Segment::new(a.into(), b.into());
        let shape = p2m::Point::new(centre.into());
        let alone = BruteForce::new([segment]).expect("valid").closest_to(&shape, &PairOptions::default());
        let distance = alone.expect("not empty").distance;
        let away =
            centre + vector(&mut rng).normalize() * (distance * (1.0 + f64::from(rng.random_range(-2..3)) * 1e-16));
        let scene = [Shape::from(segment), Shape::from(p2m::Point::new(away.into()))];
        let exact =
            [vec![a.into(), b.into()], vec![away.into()]].map(|hull| Distance::between(&hull, &[centre.into()]));
        let nearest = usize::from(exact[1].compare(&exact[0]).is_lt());
        let text = format!("{case}: {scene:?} {shape:?}");
        let tree = AabbTree::new(&scene).expect("valid");
        let found = tree.certified_closest_to(&shape, &PairOptions::default()).expect("not empty");
        assert_eq!(found.primitives[0].index(), nearest, "{text}");
        assert_eq!(found.distance, exact[nearest].length()[0], "{text}");
        let other = BruteForce::new([shape]).expect("valid");
        assert_eq!(tree.certified_closest_pair(&other, &PairOptions::default()), Some(found), "{text}");
        let plain = tree.closest_to(&shape, &PairOptions::default()).expect("not empty");
        different += usize::from(plain.primitives[0].index() != nearest);
    }
    assert!(all.have_more_than(20, different), "{different}");
}

/// For two long segments the kernel has a larger error than for two points, whose distance lies between the computed
/// and the true distance of the segments.
#[test]
fn certified_pairs_are_nearest_beside_long_segments() {
    use p2m_testkit::oracle::Distance;
    let mut decided = [0, 0];
    let all = cases(30_000, 600);
    for case in all.clone() {
        let mut rng = rng("certified long segments", case);
        let long = 10f64.powf(rng.random_range(2.0..9.0));
        let mut segment = |level: f64| -> [[f64; 3]; 2] {
            let (middle, along) = (vector(&mut rng) + Vector3::z() * level, vector(&mut rng) * long);
            [(middle - along * rng.random_range(0.1..1.0)).into(), (middle + along).into()]
        };
        let hulls = [segment(0.0), segment(3.0)];
        let exact = Distance::between(&hulls[0], &hulls[1]);
        let [a, b] = hulls.map(|[a, b]| Shape::from(p2m::Segment::new(a.into(), b.into())));
        let [alone_a, alone_b] = [[a], [b]].map(|scene| BruteForce::new(scene).expect("finite"));
        let computed = alone_a.closest_pair(&alone_b, &PairOptions::default()).expect("not empty");
        assert!(exact.is_at_least(computed.lower_bound), "{case}: {hulls:?}");
        let (distance, found) = (exact.length()[0], computed.distance);
        if distance == 0.0 || (found - distance).abs() < 1e-14 * distance {
            continue;
        }
        let between = distance * 0.5 + found * 0.5;
        let are_segments_nearest = distance < between;
        decided[usize::from(are_segments_nearest)] += 1;
        let far = |z: f64| Shape::from(p2m::Point::new([20.0 * long, 20.0 * long, z].into()));
        for is_reversed in [false, true] {
            let mut scenes = [vec![a, far(0.0)], vec![b, far(between)]];
            if is_reversed {
                scenes.iter_mut().for_each(|scene| scene.reverse());
            }
            let nearest = PrimitiveId::new(usize::from(are_segments_nearest == is_reversed));
            for hint in [0, 1] {
                let options = PairOptions::default().with_hint([PrimitiveId::new(hint); 2]);
                let [tree_a, tree_b] = scenes.each_ref().map(|scene| AabbTree::new(scene).expect("finite"));
                let [brute_a, brute_b] = scenes.each_ref().map(|scene| BruteForce::new(scene).expect("finite"));
                for pair in [
                    tree_a.certified_closest_pair(&tree_b, &options).expect("not empty"),
                    brute_a.certified_closest_pair(&brute_b, &options).expect("not empty"),
                ] {
                    let text = format!("{case}: {scenes:?} {hint}");
                    assert_eq!(pair.primitives, [nearest; 2], "{text}");
                    assert_eq!(pair.distance, if are_segments_nearest { distance } else { between }, "{text}");
                }
                let plain = tree_a.closest_pair(&tree_b, &options).expect("not empty");
                assert!(exact.is_at_least(plain.lower_bound) && plain.lower_bound <= between, "{case}: {plain:?}");
            }
        }
    }
    assert!(decided.into_iter().all(|count| all.have_more_than(3_000, count)), "{decided:?}");
}
