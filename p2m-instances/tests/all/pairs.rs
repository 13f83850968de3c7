//! Queries for pairs against those of all moved vertices.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use crate::reference::{Expected, Object, fields, motion, moved_soup, scene, within};
use nalgebra::Isometry3;
use p2m_backends::{BACKENDS, BuildSettings};
use p2m_bvh::AabbTree;
use p2m_core::pair::{PairOptions, PairQuery};
use p2m_core::{AnyIndex, BruteForce, PrimitiveId, PrimitiveSet, Shape, Soup};
use p2m_instances::Instances;
use p2m_testkit::scenes::{self, kinds_and_layout};
use p2m_testkit::{cases, rng};
use rand::{Rng, RngExt};
use std::sync::Arc;

/// Builds the index of a random backend, mostly of one that answers queries for pairs.
fn object<'a>(rng: &mut impl Rng, soup: &'a Soup<f64>) -> Object<'a, f64> {
    let backend = loop {
        let backend = &BACKENDS[rng.random_range(0..BACKENDS.len())];
        if backend.answers_pairs || rng.random_range(0..20) == 0 {
            break backend;
        }
    };
    (soup, backend.build(Arc::new(soup.clone()), &BuildSettings::default()).expect("valid").index)
}

/// Compares pairs of instances, and returns how many there are.
fn check_instances(
    case: u64,
    scene: &Instances<f64, dyn AnyIndex<f64> + '_>,
    objects: &[Object<'_, f64>],
    expected: &[Expected],
    distance: f64,
) -> usize {
    let found = scene.near_instances(distance).into_iter().map(|(instances, pair)| (instances, fields(Some(pair))));
    let found: Vec<_> = found.collect();
    let mut all = Vec::new();
    let options = PairOptions::default().with_max_distance(distance);
    for (i, a) in expected.iter().enumerate() {
        for b in &expected[i + 1..] {
            let [one, other] = [a, b].map(|one| moved_soup(objects, std::slice::from_ref(one)));
            let [first, second] = [a, b].map(|one| scene.instance(one.0).expect("in the scene").primitives().start);
            let [one, other] = [&one, &other].map(|soup| BruteForce::new(soup).expect("valid"));
            if let Some(mut pair) = fields(one.closest_pair(&other, &options)) {
                let [p, q] = pair.primitives.map(PrimitiveId::index);
                pair.primitives = [PrimitiveId::new(first + p), PrimitiveId::new(second + q)];
                all.push(([a.0, b.0], Some(pair)));
            }
        }
    }
    assert_eq!(found, all, "case {case}, {distance:e}");
    all.len()
}

#[test]
fn pairs_are_those_of_the_moved_scene() {
    let (mut near, mut found) = (0, 0);
    let all = cases(4_000, 200);
    for case in all.clone() {
        let mut rng = rng("pairs of instances", case);
        let (kinds, layout) = kinds_and_layout(case);
        let soups = [0, 1].map(|_| {
            let len = [0, 1, 20, 60][rng.random_range(0..4)];
            scenes::soup(&mut rng, kinds, layout, len)
        });
        let size = soups.iter().map(|soup| soup.aabb()).filter(|b| !b.is_empty()).map(|b| (b.max - b.min).amax());
        let size = size.fold(0.0, f64::max).max(1.0);
        let objects: Vec<_> = soups.iter().map(|soup| object(&mut rng, soup)).collect();
        let (scene, expected) = scene(&mut rng, &objects, size);
        let moved = moved_soup(&objects, &expected);
        let truth = BruteForce::new(&moved).expect("valid");
        let text = format!("case {case}");

        let isometry: Option<Isometry3<f64>> = (rng.random_range(0..2) == 0).then(|| motion(&mut rng, size));
        let mut options = PairOptions::default();
        options.motion = isometry;
        let shapes = scenes::soup(&mut rng, kinds, layout, 3);
        for id in (0..shapes.len()).map(PrimitiveId::new) {
            let shape: Shape<f64> = shapes.get(id);
            let expected = truth.closest_to(&shape, &options);
            assert_eq!(fields(scene.closest_to(&shape, &options)), fields(expected), "{text}, {shape:?}");
            let distance = expected.map_or(0.0, |pair| pair.distance);
            let limited = options.with_max_distance(distance);
            assert_eq!(scene.is_any_near(&shape, &limited), expected.is_some(), "{text}, {shape:?}");
            let certified = truth.certified_closest_to(&shape, &options);
            assert_eq!(scene.certified_closest_to(&shape, &options), certified, "{text}, {shape:?}");
        }
        let other = scenes::soup(&mut rng, kinds, layout, 25);
        let (index, other_truth) = (object(&mut rng, &other).1, BruteForce::new(&other).expect("valid"));
        if let Some(index) = index.as_pair_query() {
            // The scene is first, and then second, where its motions and that of the options follow each other.
            let expected = truth.closest_pair(&other_truth, &options);
            found += usize::from(expected.is_some());
            assert_eq!(fields(scene.closest_pair(index, &options)), fields(expected), "{text}");
            let expected = other_truth.closest_pair(&truth, &options);
            assert_eq!(fields((&index).closest_pair(&scene, &options)), fields(expected), "{text}");
            if let Some(pair) = expected {
                let limited = options.with_max_distance(pair.distance * 1.1);
                let pairs = within(&other_truth, &truth, &limited);
                assert_eq!(within(&index, &scene, &limited), pairs, "{text}");
            }
            let expected = truth.closest_pair(&truth, &options);
            assert_eq!(fields(scene.closest_pair(&scene, &options)), fields(expected), "{text}");
        }
        for distance in [0.0, size * 0.1, f64::INFINITY, f64::NAN] {
            near += check_instances(case, &scene, &objects, &expected, distance);
        }
    }
    assert!(all.have_more_than(60, found), "{found}");
    assert!(all.have_more_than(100, near), "{near}");
}

/// An object without a tree is searched by primitives, before or after one with a tree that was turned.
#[test]
fn instances_with_and_without_trees_are_compared() {
    let mut near = 0;
    let all = cases(4_000, 300);
    for case in all.clone() {
        let mut rng = rng("instances without trees", case);
        let (kinds, layout) = kinds_and_layout(case);
        let soups = [0, 1].map(|_| scenes::soup(&mut rng, kinds, layout, 12));
        let size = soups.iter().map(|soup| (soup.aabb().max - soup.aabb().min).amax()).fold(0.0, f64::max);
        let brute = Arc::new(BruteForce::new(&soups[0]).expect("valid")) as Arc<dyn AnyIndex<f64> + '_>;
        let tree = AabbTree::new(&soups[1]).expect("valid");
        let tree = Arc::new(tree) as Arc<dyn AnyIndex<f64> + '_>;
        let objects: Vec<Object<'_, f64>> = vec![(&soups[0], brute), (&soups[1], tree)];
        let (scene, expected) = scene(&mut rng, &objects, size);
        near += check_instances(case, &scene, &objects, &expected, f64::INFINITY);
        // All pairs within a distance have no guess to begin with.
        let truth = moved_soup(&objects, &expected);
        let truth = BruteForce::new(&truth).expect("valid");
        let options = PairOptions::default().with_max_distance(size * 0.5);
        assert_eq!(within(&scene, &scene, &options), within(&truth, &truth, &options), "case {case}");
    }
    assert!(all.have_more_than(100, near), "{near}");
}
