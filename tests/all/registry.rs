//! Compares every backend of the registry with brute force, in both scalars, for all kinds of queries that it answers.
//! A new backend joins with its entry in the registry.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]

use crate::agreement::agrees_with;
use nalgebra::{Point3, Vector3};
use p2m::storage::{SavedFile, Writer};
use p2m::{Aabb, BoxQuery, BruteForce, CertifiedQuery, PrimitiveSet, QueryOptions, Ray, RayQuery, Real, Soup};
use p2m_backends::{AnyIndex, BACKENDS, BuildSettings};
use p2m_testkit::near_check;
use p2m_testkit::scenes::{extreme_soups, narrow, queries, random_soups, to_f32};

/// A scene in f64 with queries, and its seed.
type Case = (u64, Soup<f64>, Vec<Point3<f64>>);

/// Checks the index of every backend over scenes in f64.
fn in_f64(cases: impl Iterator<Item = Case>, check: impl Fn(u64, &Soup<f64>, &[Point3<f64>], &dyn AnyIndex)) {
    for (seed, soup, queries) in cases {
        for backend in BACKENDS {
            let built = backend.build(&soup, &BuildSettings::default()).expect("valid scene");
            check(seed, &soup, &queries, &*built.index);
        }
    }
}

/// Checks the index of every backend over scenes that are rounded to f32.
fn in_f32(cases: impl Iterator<Item = Case>, check: impl Fn(u64, &Soup<f32>, &[Point3<f32>], &dyn AnyIndex<f32>)) {
    for (seed, soup, queries) in cases {
        let soup = narrow(&soup).expect("fits f32");
        let queries: Vec<_> = queries.into_iter().map(to_f32).collect();
        for backend in BACKENDS {
            let built = backend.build_f32(&soup, &BuildSettings::default()).expect("valid scene");
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

/// Rays, boxes and certified answers of trees and cells have tests of their own; this is for what a new backend adds.
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

#[test]
fn loaded_indexes_answer_as_brute_force() {
    for (seed, soup, queries) in random_cases("saved") {
        for backend in BACKENDS.iter().filter(|backend| backend.is_saveable()) {
            let built = backend.build(&soup, &BuildSettings::default()).expect("valid scene");
            let (mut writer, mut bytes) = (Writer::default(), Vec::new());
            built.save(&mut writer);
            writer.write(&mut bytes).expect("memory");
            let file = SavedFile::read(&bytes[..]).expect("read");
            let loaded = backend.load(&soup, file.checked().expect("whole")).expect("an index");
            nearest(seed, &soup, &queries, &*loaded.index);
        }
    }
}
