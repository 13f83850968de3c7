//! Compares every backend of the registry with brute force, in both scalars, in all kinds of queries that it answers. A
//! new backend is tested once it has an entry in the registry.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]

use crate::agreement::agrees_with;
use nalgebra::{Isometry3, Point3, Rotation3, Vector3};
use p2m::pair::{BallContact, ClosestPair, MovingBall, PairOptions, PairQuery};
use p2m::storage::{SavedFile, Writer};
use p2m::{
    Aabb, BoxQuery, BruteForce, BuildError, CertifiedQuery, Element, PrimitiveId, PrimitiveSet, QueryOptions, Ray,
    RayQuery, Real, Soup,
};
use p2m_backends::{AnyIndex, BACKENDS, BuildSettings, BuiltIndex, Choice, QueryRegion, Workload};
use p2m_mixed::generate::{IcoSphere, SkewedGear, ico_sphere, skewed_gear};
use p2m_testkit::extremes::Extreme;
use p2m_testkit::near_check;
use p2m_testkit::scenes::{extreme_soups, narrow, queries, random_soups, to_f32};
use p2m_testkit::{amount, cases, rng};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A scene in f64 with queries, and its seed.
type Case = (u64, Soup<f64>, Vec<Point3<f64>>);

/// Checks the index of every backend, over scenes in f64.
fn in_f64(cases: impl Iterator<Item = Case>, check: impl Fn(u64, &Soup<f64>, &[Point3<f64>], &dyn AnyIndex)) {
    for (seed, soup, queries) in cases {
        let soup = Arc::new(soup);
        for backend in BACKENDS {
            let built = backend.build(Arc::clone(&soup), &BuildSettings::default()).expect("valid scene");
            check(seed, &soup, &queries, &*built.index);
        }
    }
}

/// Checks the index of every backend, over scenes that are rounded to f32.
fn in_f32(cases: impl Iterator<Item = Case>, check: impl Fn(u64, &Soup<f32>, &[Point3<f32>], &dyn AnyIndex<f32>)) {
    for (seed, soup, queries) in cases {
        let soup = Arc::new(narrow(&soup).expect("fits f32"));
        let queries: Vec<_> = queries.into_iter().map(to_f32).collect();
        for backend in BACKENDS {
            let built = backend.build_in(Arc::clone(&soup), &BuildSettings::default()).expect("valid scene");
            check(seed, &soup, &queries, &*built.index);
        }
    }
}

fn random_cases(name: &'static str) -> impl Iterator<Item = Case> {
    random_soups(name).map(|(seed, soup)| {
        let queries = queries(seed, &soup);
        (seed, soup, queries)
    })
}

/// Generates scenes of every family that breaks indexes and kernels, with queries that are finite in f32 as well.
fn hard_cases() -> impl Iterator<Item = Case> {
    cases(2800, 42).map(|seed| {
        let family = Extreme::ALL[usize::try_from(seed).expect("small") % Extreme::ALL.len()];
        let (soup, queries) = family.generate(&mut rng(family.name(), seed), amount(64, 24));
        let is_finite = |query: &Point3<f64>| to_f32(*query).iter().all(|x| x.is_finite());
        (seed, soup, queries.into_iter().filter(is_finite).collect())
    })
}

fn nearest<T: Real>(seed: u64, soup: &Soup<T>, queries: &[Point3<T>], index: &dyn AnyIndex<T>) {
    let brute = BruteForce::new(soup).expect("valid scene");
    agrees_with(&brute, seed, soup.len(), queries, &index);
}

fn near<T: Real>(seed: u64, soup: &Soup<T>, queries: &[Point3<T>], index: &dyn AnyIndex<T>) {
    near_check::agrees(seed, soup, queries, index);
}

#[test]
fn the_nearest_agrees_on_random_scenes_in_f64() {
    in_f64(random_cases("f64"), nearest);
}

#[test]
fn the_nearest_agrees_on_random_scenes_in_f32() {
    in_f32(random_cases("f32"), nearest);
}

#[test]
fn the_nearest_agrees_at_extreme_scales() {
    in_f64(extreme_soups("scales"), nearest);
}

#[test]
fn the_nearest_agrees_on_hard_scenes_in_f64() {
    in_f64(hard_cases(), nearest);
}

#[test]
fn the_nearest_agrees_on_hard_scenes_in_f32() {
    in_f32(hard_cases().filter(|(_, soup, _)| narrow(soup).is_some()), nearest);
}

#[test]
fn near_queries_agree_on_random_scenes_in_f64() {
    in_f64(random_cases("near f64"), near);
}

#[test]
fn near_queries_agree_on_random_scenes_in_f32() {
    in_f32(random_cases("near f32"), near);
}

#[test]
fn near_queries_agree_at_extreme_scales() {
    in_f64(extreme_soups("near scales"), near);
}

/// The trees and cells have separate tests of rays, boxes and certified answers. This test covers new backends.
#[test]
fn other_queries_agree_where_a_backend_answers_them() {
    in_f64(random_cases("registry"), |seed, soup, queries, index| {
        let brute = BruteForce::new(soup).expect("valid scene");
        for pair in queries.chunks_exact(2) {
            let [a, b] = [pair[0], pair[1]];
            let options = QueryOptions::default();
            let certified = index.certified_closest_point(&a, &options);
            assert_eq!(certified, brute.certified_closest_point(&a, &options), "seed {seed}, {a:?}");
            if let (Some(index), Ok(ray)) = (index.as_ray_query(), Ray::new(&a, &Vector3::from(b - a))) {
                assert_eq!(index.all_intersections(&ray), brute.all_intersections(&ray), "seed {seed}, {ray:?}");
            }
            if let Some(index) = index.as_box_query() {
                let bounds = Aabb { min: a.inf(&b), max: a.sup(&b) };
                assert_eq!(index.intersects_box(&bounds), brute.intersects_box(&bounds), "seed {seed}, {bounds:?}");
            }
        }
    });
}

/// The answers to all queries for pairs, without lower bounds, which depend on the pairs that a search evaluates.
#[derive(Debug, Default, PartialEq)]
struct PairAnswers<T: Real> {
    closest: Vec<Option<ClosestPair<T>>>,
    within: Vec<Vec<([PrimitiveId; 2], T)>>,
    is_near: Vec<bool>,
    contacts: Vec<Option<BallContact<T>>>,
}

impl<T: Real> PairAnswers<T> {
    /// Queries a scene with triangles between queries, as shapes and as another scene, and with balls that move from
    /// one query to the next.
    fn new(scene: &impl PairQuery<T>, queries: &[Point3<T>]) -> Self {
        let triangle = |i: u32| Element::Triangle([3 * i, 3 * i + 1, 3 * i + 2]);
        let triangles = (0..u32::try_from(queries.len() / 3).expect("few queries")).map(triangle);
        let other = Soup::new(queries.to_vec(), triangles).expect("finite");
        let brute = BruteForce::new(&other).expect("finite");
        let mut answers = Self::default();
        let motion = Isometry3::new(Vector3::new(0.2, -0.1, 0.3), Vector3::new(0.5, 0.4, -0.3));
        for options in [PairOptions::default(), PairOptions::default().with_motion(motion)] {
            let nearest = scene.closest_pair(&brute, &options);
            answers.closest.extend([nearest, scene.certified_closest_pair(&brute, &options)]);
            answers.closest.push(brute.closest_pair(scene, &options));
            let around = |nearest: Option<ClosestPair<T>>| {
                let factor = T::round_from_f64(1.25);
                options.with_max_distance(nearest.map_or(T::zero(), |nearest| nearest.distance * factor))
            };
            let (mut pairs, mut near) = (Vec::new(), Vec::new());
            let _ = scene.visit_pairs_within(&brute, &around(nearest), &mut |pair| {
                pairs.push((pair.primitives, pair.distance));
                ControlFlow::Continue(())
            });
            answers.is_near.push(scene.is_any_pair_near(&brute, &around(nearest)));
            answers.is_near.push(scene.is_any_pair_near(&brute, &options.with_max_distance(T::zero())));
            for shape in (0..other.len()).map(|i| other.get(PrimitiveId::new(i))) {
                let nearest = scene.closest_to(&shape, &options);
                answers.closest.extend([nearest, scene.certified_closest_to(&shape, &options)]);
                answers.is_near.push(scene.is_any_near(&shape, &around(nearest)));
                let _ = scene.visit_near(&shape, &around(nearest), &mut |pair| {
                    near.push((pair.primitives, pair.distance));
                    ControlFlow::Continue(())
                });
            }
            // Searches find these in any order.
            for mut found in [pairs, near] {
                found.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.to_f64().total_cmp(&b.1.to_f64())));
                answers.within.push(found);
            }
        }
        answers.closest.iter_mut().flatten().for_each(|pair| pair.lower_bound = T::zero());
        let balls = queries.windows(2).map(|ends| MovingBall::new(ends[0], ends[1], T::round_from_f64(0.01)));
        answers.contacts = balls.map(|ball| ball.first_contact(scene)).collect();
        answers
    }
}

fn pairs<T: Real>(seed: u64, soup: &Soup<T>, queries: &[Point3<T>], index: &dyn AnyIndex<T>) {
    if let Some(index) = index.as_pair_query() {
        let brute = BruteForce::new(soup).expect("valid scene");
        assert_eq!(PairAnswers::new(&index, queries), PairAnswers::new(&brute, queries), "seed {seed}");
    }
}

#[test]
fn pairs_agree_on_random_scenes_in_f64() {
    in_f64(random_cases("pairs f64"), pairs);
}

#[test]
fn pairs_agree_on_random_scenes_in_f32() {
    in_f32(random_cases("pairs f32"), pairs);
}

/// Refits an index to a moved scene, and compares it with brute force.
fn refit<T: Real>(seed: u64, soup: &Soup<T>, queries: &[Point3<T>], index: &dyn AnyIndex<T>) {
    let mut moved = soup.clone();
    moved.map_positions(|p| Point3::new(-p.z, p.x + p.y, p.y)).expect("in range");
    let moved = Arc::new(moved);
    let Some(refitted) = index.refitted(Arc::clone(&moved)) else { return };
    let refitted = refitted.expect("the same primitives");
    nearest(seed, &moved, queries, &*refitted);
    near(seed, &moved, queries, &*refitted);
    pairs(seed, &moved, queries, &*refitted);
    assert_eq!(refitted.primitive_count(), soup.len());
    // The original index is unchanged.
    nearest(seed, soup, queries, index);
    let error = |soup: Soup<T>| index.refitted(Arc::new(soup)).expect("as before").err();
    let shorter = Soup::new(soup.positions().to_vec(), soup.elements().skip(1)).expect("valid");
    let other_length = BuildError::OtherLength { len: shorter.len(), expected: soup.len() };
    assert_eq!(error(shorter), (!soup.is_empty()).then_some(other_length), "seed {seed}");
}

#[test]
fn refitted_indexes_agree_on_random_scenes_in_f64() {
    in_f64(random_cases("refit f64"), refit);
}

#[test]
fn refitted_indexes_agree_on_random_scenes_in_f32() {
    in_f32(random_cases("refit f32"), refit);
}

#[test]
fn loaded_indexes_answer_as_brute_force() {
    for (seed, soup, queries) in random_cases("saved") {
        let soup = Arc::new(soup);
        for backend in BACKENDS.iter().filter(|backend| backend.is_saveable()) {
            let built = backend.build(Arc::clone(&soup), &BuildSettings::default()).expect("valid scene");
            let (mut writer, mut bytes) = (Writer::default(), Vec::new());
            built.save(&mut writer);
            writer.write(&mut bytes).expect("memory");
            let file = SavedFile::read(&bytes[..]).expect("read");
            let loaded = backend.load(Arc::clone(&soup), file.checked().expect("whole")).expect("an index");
            nearest(seed, &soup, &queries, &*loaded.index);
        }
    }
}

/// The bytes of a saved index.
fn saved_bytes(built: &BuiltIndex) -> Vec<u8> {
    let (mut writer, mut bytes) = (Writer::default(), Vec::new());
    built.save(&mut writer);
    writer.write(&mut bytes).expect("memory");
    bytes
}

#[test]
fn the_choice_of_auto_follows_from_scene_and_queries() {
    let ball = Arc::new(ico_sphere(&IcoSphere { frequency: 12 }).expect("valid options"));
    let mut gear = skewed_gear(&SkewedGear::default()).expect("valid options");
    let turn = Rotation3::from_euler_angles(0.7, 0.3, 0.0);
    let turned: Vec<_> = gear.positions().iter().map(|position| turn * position).collect();
    gear = Soup::new(turned, gear.elements()).expect("valid");
    let gear = Arc::new(gear);
    let cases =
        [(&ball, 1_000, "aabb"), (&ball, 10_000_000, "octree"), (&gear, 1_000, "aabb"), (&gear, 1_000_000, "kdop")];
    for (soup, queries, expected) in cases {
        for region in [QueryRegion::SceneBox, QueryRegion::NearSurface] {
            let workload = Workload::new(queries, region);
            let choice = Choice::new(Arc::clone(soup), &workload).expect("valid scene");
            assert_eq!(choice.backend().name, expected, "{queries} {region:?}");
            let (backend, resolution) = (choice.backend(), choice.resolution());
            // The index equals the one that the backend builds without a choice.
            let built = choice.build(&BuildSettings::default()).expect("valid scene");
            let alone = BuildSettings::default().with_resolution(resolution);
            let alone = backend.build(Arc::clone(soup), &alone).expect("valid scene");
            assert!(saved_bytes(&built) == saved_bytes(&alone), "{expected}");
        }
    }
    // Slivers need finer cells.
    let choice = Choice::new(gear, &Workload::new(100_000_000, QueryRegion::SceneBox)).expect("valid scene");
    assert!(choice.backend().name == "octree" && choice.resolution().is_some());
    // Points like those of the scene are near the surface.
    let workload = Workload::new(10_000_000, QueryRegion::Like(ball.positions()));
    assert_eq!(Choice::new(Arc::clone(&ball), &workload).expect("valid scene").backend().name, "octree");
    // Points that are not finite, or are beyond the cells of an octree, do not justify an octree.
    let far = |scale: f64| -> Vec<Point3<f64>> { ball.positions().iter().map(|p| p * scale).collect() };
    for points in
        [vec![Point3::new(f64::NAN, 0.0, 0.0); 600], far(1e3), vec![Point3::new(f64::INFINITY, 0.0, 0.0); 600]]
    {
        let workload = Workload::new(10_000_000, QueryRegion::Like(&points));
        assert_eq!(Choice::new(Arc::clone(&ball), &workload).expect("valid scene").backend().name, "aabb");
    }
    // Around a closed mesh, the cells of vertices often contain the answer.
    let around = far(8.0);
    let workload = Workload::new(100_000_000, QueryRegion::Like(&around));
    assert_eq!(Choice::new(Arc::clone(&ball), &workload).expect("valid scene").backend().name, "p2m");
    // A few queries take less time than building an index.
    let few = Workload::new(3, QueryRegion::SceneBox);
    for (workload, expected) in [(few, "brute"), (few.with_needs_index(true), "aabb")] {
        for choice in [Choice::new(Arc::clone(&ball), &workload), Choice::compare(Arc::clone(&ball), &workload)] {
            let choice = choice.expect("valid scene");
            assert_eq!(choice.backend().name, expected);
            let estimates = choice.estimates();
            assert_eq!(estimates.len(), BACKENDS.len());
            assert!(BACKENDS.iter().all(|backend| estimates.iter().any(|e| e.backend == backend)));
            let built = choice.build(&BuildSettings::default()).expect("valid scene");
            assert_eq!(built.index.memory_bytes() == 0, expected == "brute");
        }
    }
    // Within a small distance, the tree has little work.
    let box_of = |radius| {
        let workload = Workload::new(60_000, QueryRegion::SceneBox).with_max_distance(radius);
        Choice::new(Arc::clone(&ball), &workload).expect("valid scene").backend().name
    };
    assert_eq!((box_of(f64::INFINITY), box_of(1e-9)), ("octree", "aabb"));
    // Even more queries justify finer cells, unless these would take too much memory.
    let octree_within = |queries, bytes| {
        let workload = Workload::new(queries, QueryRegion::SceneBox).with_max_bytes(bytes);
        let choice = Choice::new(Arc::clone(&ball), &workload).expect("valid scene");
        assert_eq!(choice.backend().name, "octree", "{queries} {bytes}");
        let resolution = choice.resolution();
        (resolution, choice.build(&BuildSettings::default()).expect("valid scene").index.memory_bytes())
    };
    let (coarse, coarse_bytes) = octree_within(60_000, usize::MAX);
    let (fine, fine_bytes) = octree_within(10_000_000, usize::MAX);
    assert!(coarse.is_none() && fine.is_some() && fine_bytes > coarse_bytes, "{coarse_bytes} {fine_bytes}");
    assert_eq!(octree_within(10_000_000, 250 * ball.len()).0, None);
    for bytes in [coarse_bytes - 20_000, coarse_bytes - 1, fine_bytes - 1] {
        let (_, taken) = octree_within(10_000_000, bytes);
        assert!(taken <= bytes, "{taken} of {bytes}");
    }
    // A limit of memory excludes the octree. A scene without primitives has no work to count.
    let workload = Workload::new(10_000_000, QueryRegion::SceneBox).with_max_bytes(1000);
    assert_eq!(Choice::new(ball, &workload).expect("valid scene").backend().name, "aabb");
    let empty = Choice::new(Arc::default(), &Workload::new(10_000_000, QueryRegion::SceneBox)).expect("valid scene");
    assert_eq!((empty.backend().name, empty.reason()), ("aabb", None));
}
