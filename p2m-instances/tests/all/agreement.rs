//! Random scenes of all kinds, over all backends.

use crate::reference::{Object, moved_soup, scene};
use nalgebra::Point3;
use p2m_backends::{BACKENDS, BuildSettings};
use p2m_core::{
    Aabb, AnyIndex, BoxQuery, BruteForce, CertifiedQuery, Closest, ClosestPoint, IndexStats, NearQuery, PrimitiveId,
    PrimitiveSet, QueryCost, QueryOptions, Ray, RayQuery, Real, Soup,
};
use p2m_instances::Instances;
use p2m_testkit::near_check::{self, compared_fields};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::scenes::{self, extreme_soups, kinds_and_layout, narrow};
use p2m_testkit::{cases, ray_check, rng};
use rand::{Rng, RngExt};
use std::sync::Arc;

/// Builds the index of a random backend.
fn object<'a>(rng: &mut impl Rng, soup: &'a Soup<f64>) -> Object<'a, f64> {
    let backend = &BACKENDS[rng.random_range(0..BACKENDS.len())];
    (soup, backend.build(Arc::new(soup.clone()), &BuildSettings::default()).expect("valid").index)
}

/// Returns the length of the longest side of a box, or 1 for an empty one.
fn size_of(bounds: &Aabb<f64>) -> f64 {
    if bounds.is_empty() { 1.0 } else { (bounds.max - bounds.min).amax() }
}

/// Compares all queries in f64.
fn check(
    rng: &mut impl Rng,
    case: u64,
    scene: &Instances<f64, dyn AnyIndex<f64> + '_>,
    moved: &Soup<f64>,
    queries: &[Point3<f64>],
) {
    let truth = BruteForce::new(moved).expect("valid");
    near_check::agrees(case, moved, queries, scene);
    let exact = QueryOptions::default();
    for query in queries {
        let text = format!("case {case}, {query:?}");
        let expected = truth.closest_point(query);
        let fields = |found: Option<Closest<f64>>| found.as_ref().map(compared_fields);
        let found = scene.closest_point(query);
        assert_eq!(fields(found), fields(expected), "{text}");
        let hint = PrimitiveId::new(rng.random_range(0..moved.len() + 2));
        assert_eq!(fields(scene.closest_point_with(query, &exact.with_hint(hint))), fields(expected), "{text}");
        let certified = scene.certified_closest_point(query, &exact).expect("all have vertices");
        assert_eq!(certified, truth.certified_closest_point(query, &exact).expect("all have vertices"), "{text}");
        if let (Some(found), Some(certified)) = (found, certified) {
            assert!(found.lower_bound <= certified.distance && certified.distance.is_finite(), "{text}: {found:?}");
            let about = exact.with_epsilon(0.3).with_max_visits(rng.random_range(0..9));
            let about = scene.closest_point_with(query, &about).expect("the radius is infinite");
            assert!(about.lower_bound <= certified.distance && about.distance <= found.distance * 1.3 * 1.000_001);
        }
    }
    // A batch begins each search with the last answer, and skips queries that are not finite.
    let mut batch = [queries, &[Point3::new(0.0, f64::INFINITY, 0.0)], queries].concat();
    batch.reverse();
    for options in [exact, exact.with_hint(PrimitiveId::new(moved.len() / 2))] {
        let mut answers = vec![None; batch.len()];
        scene.closest_points_into(&batch, &options, &mut answers);
        let expected: Vec<_> = batch.iter().map(|q| truth.closest_point(q).as_ref().map(compared_fields)).collect();
        assert_eq!(
            answers.iter().map(|a| a.as_ref().map(compared_fields)).collect::<Vec<_>>(),
            expected,
            "case {case}"
        );
    }
    let about = exact.with_epsilon(0.2);
    let mut answers = vec![None; batch.len()];
    scene.closest_points_into(&batch, &about, &mut answers);
    let single: Vec<_> = batch.iter().map(|q| scene.closest_point_with(q, &about)).collect();
    assert_eq!(answers, single, "case {case}");
    assert_eq!(scene.closest_point(&Point3::new(f64::NAN, 0.0, 0.0)), None);
    let visited = QueryCost::measure(scene, queries).primitives.mean;
    assert!(visited <= moved.len() as f64 && (moved.is_empty() || queries.is_empty() || visited >= 1.0), "{visited}");
}

fn check_rays(case: u64, scene: &impl RayQuery<f64>, moved: &Soup<f64>, rays: &[Ray]) -> usize {
    let truth = BruteForce::new(moved).expect("valid");
    let mut hits = 0;
    for ray in rays {
        let text = format!("case {case}, {ray:?}");
        let bits = |hits: Vec<p2m_core::Hit>| hits.iter().map(ray_check::bits).collect::<Vec<_>>();
        let expected = bits(truth.all_intersections(ray));
        assert_eq!(bits(scene.all_intersections(ray)), expected, "{text}");
        assert_eq!(scene.first_intersection(ray).as_ref().map(ray_check::bits).as_ref(), expected.first(), "{text}");
        assert_eq!((scene.count(ray), scene.do_intersect(ray)), (expected.len(), !expected.is_empty()), "{text}");
        assert_eq!(scene.any_intersection(ray).is_some(), !expected.is_empty(), "{text}");
        assert_eq!(scene.crossings(ray), truth.crossings(ray), "{text}");
        hits += expected.len();
    }
    hits
}

fn check_boxes(rng: &mut impl Rng, case: u64, scene: &impl BoxQuery<f64>, moved: &Soup<f64>, queries: &[Point3<f64>]) {
    let truth = BruteForce::new(moved).expect("valid");
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    let infinite = Aabb { min: Point3::from([f64::NEG_INFINITY; 3]), max: Point3::from([f64::INFINITY; 3]) };
    let mut boxes = vec![infinite, Aabb::empty()];
    for query in queries {
        let vertex = moved.positions()[rng.random_range(0..moved.positions().len())];
        let span = Aabb::from_points(&[*query, vertex]);
        boxes.push(span);
        boxes.push(Aabb { max: Point3::new(f64::INFINITY, span.max.y, span.max.z), ..span });
        boxes.push(Aabb { min: vertex, max: vertex });
    }
    for bounds in &boxes {
        scene.primitives_in_box_into(bounds, &mut found);
        truth.primitives_in_box_into(bounds, &mut expected);
        assert_eq!(found, expected, "case {case}, {bounds:?}");
        assert_eq!(scene.intersects_box(bounds), !expected.is_empty(), "case {case}, {bounds:?}");
    }
}

/// Returns two random soups and their size.
fn soups(rng: &mut impl Rng, case: u64) -> ([Soup<f64>; 2], f64) {
    let (kinds, layout) = kinds_and_layout(case);
    let (other_kinds, other_layout) = kinds_and_layout(rng.random());
    let len = [0, 1, 5, 40, 150][rng.random_range(0..5)];
    let soups = [scenes::soup(rng, kinds, layout, len), scenes::soup(rng, other_kinds, other_layout, 30)];
    let size = size_of(&soups[rng.random_range(0..2)].aabb());
    (soups, size)
}

/// Returns queries near a scene.
fn queries(rng: &mut impl Rng, moved: &Soup<f64>) -> Vec<Point3<f64>> {
    (0..8).map(|_| scenes::query(rng, moved.positions())).collect()
}

#[test]
fn answers_are_those_of_the_moved_scene() {
    let (mut hits, mut primitives) = (0, 0);
    let all = cases(6_000, 240);
    for case in all.clone() {
        let mut rng = rng("instances", case);
        let (soups, size) = soups(&mut rng, case);
        let objects: Vec<_> = soups.iter().map(|soup| object(&mut rng, soup)).collect();
        let (scene, expected) = scene(&mut rng, &objects, size);
        let moved = moved_soup(&objects, &expected);
        let shapes: Vec<_> = (0..moved.len()).map(|i| moved.get(PrimitiveId::new(i))).collect();
        assert_eq!(shapes, (0..moved.len()).map(|i| scene.get(PrimitiveId::new(i))).collect::<Vec<_>>());
        let queries = queries(&mut rng, &moved);
        check(&mut rng, case, &scene, &moved, &queries);
        if !moved.is_empty() {
            let bounds = moved.aabb();
            assert!(scene.bounds().contains(&bounds));
            let rays: Vec<_> = (0..8)
                .map(|_| {
                    let aim = AIMS[rng.random_range(0..AIMS.len())];
                    let thick = [0.0, 0.0, 0.02][rng.random_range(0..3)] * size;
                    ray(&mut rng, &moved, &bounds, aim).with_radius(thick).expect("a radius")
                })
                .collect();
            hits += check_rays(case, &scene, &moved, &rays);
            check_boxes(&mut rng, case, &scene, &moved, &queries);
        }
        primitives += moved.len();
    }
    assert!(all.have_more_than(10_000, hits) && all.have_more_than(100_000, primitives), "{hits} {primitives}");
}

/// Instances of a scene of instances: the vertices are moved and rounded twice.
#[test]
fn a_scene_of_instances_can_have_instances() {
    let mut hits = 0;
    let all = cases(1_000, 60);
    for case in all.clone() {
        let mut rng = rng("nested instances", case);
        let (soups, size) = soups(&mut rng, case);
        let objects: Vec<_> = soups.iter().map(|soup| object(&mut rng, soup)).collect();
        let (inner, expected) = scene(&mut rng, &objects, size);
        let inner_moved = moved_soup(&objects, &expected);
        let outer: [Object<'_, f64>; 1] = [(&inner_moved, Arc::new(inner))];
        let (scene, expected) = scene(&mut rng, &outer, size);
        let moved = moved_soup(&outer, &expected);
        let queries = queries(&mut rng, &moved);
        check(&mut rng, case, &scene, &moved, &queries);
        if !moved.is_empty() {
            let bounds = moved.aabb();
            let rays: Vec<_> =
                (0..4).map(|i| ray(&mut rng, &moved, &bounds, AIMS[(case as usize + i) % AIMS.len()])).collect();
            hits += check_rays(case, &scene, &moved, &rays);
            check_boxes(&mut rng, case, &scene, &moved, &queries);
        }
    }
    assert!(all.have_more_than(100, hits), "{hits}");
}

#[test]
fn answers_in_f32_are_those_of_the_moved_scene_in_f64() {
    for case in cases(2_000, 120) {
        let mut rng = rng("instances in f32", case);
        let (soups, size) = soups(&mut rng, case);
        let soups = soups.map(|soup| narrow(&soup).expect("fits f32"));
        let objects: Vec<Object<'_, f32>> = soups
            .iter()
            .map(|soup| {
                let backend = &BACKENDS[rng.random_range(0..BACKENDS.len())];
                let built = backend.build_in(Arc::new(soup.clone()), &BuildSettings::default()).expect("valid");
                (soup, built.index)
            })
            .collect();
        let (scene, expected) = scene(&mut rng, &objects, size);
        let moved = moved_soup(&objects, &expected);
        let truth = BruteForce::new(&moved).expect("valid");
        for query in queries(&mut rng, &moved) {
            let query = query.map(f32::round_from_f64);
            let text = format!("case {case}, {query:?}");
            let rounded =
                |c: &Closest<f64>| (c.primitive, f32::round_from_f64(c.distance), c.point.map(f32::round_from_f64));
            let bits = |c: &Closest<f32>| (c.primitive, c.distance, c.point);
            let (k, wide) = (rng.random_range(0..9), query.map(f64::from));
            assert_eq!(
                scene.closest_point(&query).as_ref().map(bits),
                truth.closest_point(&wide).as_ref().map(rounded),
                "{text}"
            );
            let expected: Vec<_> = truth.k_nearest(&wide, k, f64::INFINITY).iter().map(rounded).collect();
            assert_eq!(
                scene.k_nearest(&query, k, f32::INFINITY).iter().map(bits).collect::<Vec<_>>(),
                expected,
                "{text}"
            );
            if let Some((_, radius, _)) = expected.last() {
                assert!(scene.is_any_within(&query, *radius), "{text}");
                let within: Vec<_> = truth.all_within(&wide, radius.to_f64_above()).iter().map(rounded).collect();
                assert_eq!(scene.all_within(&query, *radius).iter().map(bits).collect::<Vec<_>>(), within, "{text}");
            }
            if !moved.is_empty() {
                let ray = [ray(&mut rng, &moved, &moved.aabb(), AIMS[case as usize % AIMS.len()])];
                let bits = |hits: Vec<p2m_core::Hit>| hits.iter().map(ray_check::bits).collect::<Vec<_>>();
                assert_eq!(bits(scene.all_intersections(&ray[0])), bits(truth.all_intersections(&ray[0])), "{text}");
                let bounds = Aabb::from_points(&[query, moved.positions()[0].map(f32::round_from_f64)]);
                let (mut found, mut expected) = (Vec::new(), Vec::new());
                scene.primitives_in_box_into(&bounds, &mut found);
                truth.primitives_in_box_into(&bounds.to_f64(), &mut expected);
                assert_eq!(found, expected, "{text}");
            }
        }
        assert_eq!(scene.parts().len(), 2);
    }
}

#[test]
fn answers_at_the_ends_of_the_range_are_those_of_the_moved_scene() {
    let mut added = 0;
    for (case, soup, queries) in extreme_soups("instances at extreme scales") {
        let mut rng = rng("extreme instances", case);
        let objects = [object(&mut rng, &soup)];
        let (scene, expected) = scene(&mut rng, &objects, size_of(&soup.aabb()).min(1e300));
        let moved = moved_soup(&objects, &expected);
        added += expected.len();
        near_check::agrees(case, &moved, &queries, &scene);
        if moved.is_empty() || !size_of(&moved.aabb()).is_finite() {
            continue;
        }
        let rays: Vec<_> =
            (0..4).map(|i| ray(&mut rng, &moved, &moved.aabb(), AIMS[(case as usize + i) % AIMS.len()])).collect();
        check_rays(case, &scene, &moved, &rays);
        check_boxes(&mut rng, case, &scene, &moved, &queries);
    }
    assert!(added > 20, "{added}");
}
