//! Pairs where rounding decides, and distances that round to zero.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use crate::reference::{Object, fields, moved_soup, within};
use nalgebra::{Isometry3, Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::pair::{Motion, PairOptions, PairQuery, nearest_of_hulls};
use p2m_core::{AnyIndex, BruteForce, Point, PrimitiveId, PrimitiveSet, Segment, Triangle};
use p2m_instances::Instances;
use p2m_testkit::scenes::{self, kinds_and_layout};
use p2m_testkit::{cases, rng, vector};
use rand::RngExt;
use std::sync::Arc;

/// A moved primitive is rounded by as much as it is long, so it may be nearer than its box was before the motion.
#[test]
fn long_primitives_are_found_where_rounding_brings_them_near() {
    let mut nearer = 0;
    let all = cases(2_000, 100);
    for case in all.clone() {
        let mut rng = rng("long primitives", case);
        let long = 1e10;
        let level = rng.random_range(1.0..2.0);
        let ends = [-long, long].map(|x| [x, level, 0.0].into());
        let line = BruteForce::new([Segment::<f64>::new(ends[0], ends[1])]).expect("finite");
        let motion = Isometry3::new(Vector3::zeros(), vector(&mut rng) * 3.0);
        // The nearest point of the second instance is at nearly the same distance, and is not rounded as much.
        let away = level + rng.random_range(-1e-6..1e-6);
        let point = BruteForce::new([Point::<f64>::new(Point3::new(0.0, -away, 0.0))]).expect("finite");
        let indexes: [Arc<dyn AnyIndex<f64>>; 2] = [Arc::new(line), Arc::new(point)];
        let mut scene = Instances::new();
        for index in &indexes {
            scene.edit().add("", index, Isometry3::identity()).expect("finite");
        }
        // The search of the tree of instances waits for some of them before it compares anything.
        for _ in 0..100 {
            scene.edit().add("", &indexes[1], Isometry3::identity()).expect("finite");
        }
        let origin = AabbTree::new([Point::<f64>::new(Point3::origin())]).expect("finite");
        let options = PairOptions::default().with_motion(motion);
        let hulls = |id: usize| scene.hull(PrimitiveId::new(id)).map(|v| Motion::new(&motion).apply(v));
        let [line, point] = [0, 1].map(|id| nearest_of_hulls(&[[0.0; 3]], hulls(id).vertices(), f64::INFINITY));
        let (line, point) = (line.expect("no limit").key, point.expect("no limit").key);
        nearer += usize::from(line < point && level > away);
        let found = origin.closest_pair(&scene, &options).expect("not empty");
        assert_eq!(found.distance, line.min(point).distance(), "case {case}");
    }
    assert!(all.have_more_than(20, nearer), "{nearer}");
}

/// Only a scene of many instances leaves some of them out.
#[test]
fn pairs_of_many_instances_are_those_of_the_moved_scene() {
    for case in cases(1_000, 40) {
        let mut rng = rng("pairs of many instances", case);
        let (kinds, layout) = kinds_and_layout(case);
        let soups = [3, 5, 40].map(|len| scenes::soup(&mut rng, kinds, layout, len));
        let (size, objects) = (soups[0].aabb().max - soups[0].aabb().min, [&soups[0], &soups[1]]);
        let objects = objects.map(|soup| -> Object<'_, f64> { (soup, Arc::new(AabbTree::new(soup).expect("finite"))) });
        let (mut scene, mut expected) = (Instances::new(), Vec::new());
        for i in 0..200 {
            let place = Isometry3::new(vector(&mut rng) * size.amax() * 8.0, vector(&mut rng) * 3.0);
            let id = scene.edit().add("", &objects[i % 2].1, place).expect("finite");
            expected.push((id, i % 2, place));
        }
        let truth = moved_soup(&objects, &expected);
        let other = AabbTree::new(&soups[2]).expect("finite");
        let [all, alone] = [&truth, &soups[2]].map(|soup| BruteForce::new(soup).expect("finite"));
        let turn = vector(&mut rng) * 3.0;
        for motion in [None, Some(Isometry3::new(vector(&mut rng) * size.amax() * 9.0, turn))] {
            let mut options = PairOptions::default();
            options.motion = motion;
            let text = format!("case {case}: {motion:?}");
            assert_eq!(
                fields(scene.closest_pair(&other, &options)),
                fields(all.closest_pair(&alone, &options)),
                "{text}"
            );
            assert_eq!(
                fields(other.closest_pair(&scene, &options)),
                fields(alone.closest_pair(&all, &options)),
                "{text}"
            );
        }
    }
}

/// The distance of the point from the triangle is positive, and rounds to zero.
#[test]
fn what_does_not_intersect_is_not_within_zero() {
    let v = [[8.487983164e-314, 2.54639494916e-313, 0.0], [0.0; 3], [0.0, 8.487983164e-314, 2.54639494916e-313]];
    let triangle = Triangle::new(v[0].into(), v[1].into(), v[2].into());
    let point = Point::new(Point3::new(1.414663861e-314, 5.6586554427e-314, 4.243991582e-314));
    let (tree, other) = (AabbTree::new([triangle]).expect("finite"), AabbTree::new([point]).expect("finite"));
    let options = PairOptions::default();
    let pair = tree.closest_pair(&other, &options).expect("not empty");
    assert_eq!((pair.distance, pair.is_intersecting), (0.0, false));
    let zero = options.with_max_distance(0.0);
    assert!(!tree.is_any_pair_near(&other, &zero) && !tree.is_any_near(&point, &zero));
    assert_eq!((tree.closest_pair(&other, &zero), within(&tree, &other, &zero)), (None, vec![]));
    // In f32 every distance below the smallest number rounds to zero.
    let single = |x: f32| AabbTree::new([Point::new(Point3::new(x, 0.0, 0.0))]).expect("finite");
    let [a, b] = [single(0.0), single(f32::from_bits(1))];
    let moved =
        PairOptions::<f32>::default().with_motion(Isometry3::translation(1e-46, 0.0, 0.0)).with_max_distance(0.0);
    assert!(!a.is_any_pair_near(&a, &moved) && !a.is_any_pair_near(&b, &moved));
    assert_eq!(a.closest_pair(&a, &moved), None);
}
