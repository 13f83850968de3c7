//! Tests that indexes own, borrow and share their scenes, work behind pointers, move between threads, and follow moving
//! scenes.

#![cfg(all(feature = "bvh", feature = "field", feature = "interception", feature = "kdop", feature = "scene"))]

use nalgebra::{Point3, Rotation3, Vector3};
use p2m::batch::BatchOptions;
use p2m::core::IndexStats;
use p2m::field::sign::{Sign, SignError, SignRule, SignedDistance};
use p2m::scene::generate::{IcoSphere, ico_sphere};
use p2m::{
    AabbTree, AnyIndex, BruteForce, BuildError, CertifiedQuery, ClosestPoint, KdopTree, NearQuery, OctreeIndex,
    P2mIndex, PrimitiveSet, Soup,
};
use p2m_testkit::rng;
use p2m_testkit::scenes::narrow;
use rand::RngExt;
use std::rc::Rc;
use std::sync::Arc;

fn ball() -> Soup<f64> {
    ico_sphere(&IcoSphere::default()).expect("valid")
}

fn queries(count: usize) -> Vec<Point3<f64>> {
    let mut rng = rng("ownership", 0);
    (0..count).map(|_| Point3::from([(); 3].map(|()| rng.random_range(-1.5..1.5)))).collect()
}

/// A struct that is generic over its index, as programs have them.
struct Collider<I> {
    index: I,
}

impl<I: ClosestPoint<f64>> Collider<I> {
    fn distance(&self, query: &Point3<f64>) -> f64 {
        self.index.closest_point(query).expect("not empty").distance
    }
}

#[test]
fn pointers_answer_as_what_they_point_to() {
    let soup = Arc::new(ball());
    let expected = BruteForce::new(&*soup).expect("valid");
    let tree: AabbTree<f64, Arc<Soup<f64>>> = AabbTree::new(Arc::clone(&soup)).expect("valid");
    let boxed: AabbTree<f64, Box<Soup<f64>>> = AabbTree::new(Box::new(ball())).expect("valid");
    let counted = BruteForce::new(Rc::new(ball())).expect("valid");
    let shared: Arc<dyn ClosestPoint<f64> + Send + Sync> =
        Arc::new(OctreeIndex::new(Arc::clone(&soup)).expect("valid"));
    let dynamic: Box<dyn ClosestPoint<f64>> = Box::new(KdopTree::<f64, _, 14>::new(Arc::clone(&soup)).expect("valid"));
    for query in queries(200) {
        let distance = expected.closest_point(&query).expect("not empty").distance;
        assert_eq!(Collider { index: &tree }.distance(&query), distance);
        assert_eq!(Collider { index: &boxed }.distance(&query), distance);
        assert_eq!(Collider { index: Rc::new(&counted) }.distance(&query), distance);
        assert_eq!(Collider { index: Arc::clone(&shared) }.distance(&query), distance);
        assert_eq!(Collider { index: &dynamic }.distance(&query), distance);
    }
    assert!(Arc::ptr_eq(&soup, &tree.into_set()), "the scene comes back");
}

#[test]
fn one_trait_object_does_everything_in_any_thread() {
    let soup = Arc::new(ball());
    let all: Vec<Box<dyn AnyIndex>> = vec![
        Box::new(BruteForce::new(Arc::clone(&soup)).expect("valid")),
        Box::new(AabbTree::new(Arc::clone(&soup)).expect("valid")),
        Box::new(KdopTree::<f64, _>::new(Arc::clone(&soup)).expect("valid")),
        Box::new(OctreeIndex::new(Arc::clone(&soup)).expect("valid")),
        Box::new(P2mIndex::new(Arc::clone(&soup)).expect("valid")),
    ];
    let ray = p2m::Ray::new(&Point3::new(0.1, 0.2, 9.0), &Vector3::new(0.0, 0.0, -1.0)).expect("a direction");
    let answers = all.into_iter().map(|index| {
        let work = move || {
            let query = Point3::new(0.3, 0.2, 1.7);
            let closest = index.closest_point(&query).expect("not empty");
            let certified = index.certified_closest_point(&query, &Default::default()).expect("triangles");
            let near = index.k_nearest(&query, 2, f64::INFINITY);
            let hit = index.as_ray_query().and_then(|index| index.first_intersection(&ray)).map(|hit| hit.primitive);
            let boxes = index.as_box_query().map(|index| index.intersects_box(&p2m::Aabb::from_points(&[query])));
            assert!(!index.parts().is_empty() || index.memory_bytes() == 0);
            (closest.distance, closest.primitive, certified.map(|c| c.primitive), near.len(), hit, boxes)
        };
        std::thread::spawn(move || std::panic::catch_unwind(std::panic::AssertUnwindSafe(work))).join()
    });
    let answers: Vec<_> = answers.map(|answer| answer.expect("joined").expect("no panic")).collect();
    let (distance, primitive, certified, ..) = answers[0];
    assert_eq!(certified, Some(primitive));
    for (i, answer) in answers.iter().enumerate() {
        assert_eq!((answer.0, answer.1, answer.2, answer.3), (distance, primitive, certified, 2));
        let has_rays = i < 3;
        assert_eq!((answer.4.is_some(), answer.5), (has_rays, has_rays.then_some(false)));
    }
}

#[test]
fn indexes_are_unwind_safe() {
    fn is_unwind_safe<X: std::panic::UnwindSafe + std::panic::RefUnwindSafe>(_: &X) {}
    is_unwind_safe(&AabbTree::new(Arc::new(ball())).expect("valid"));
    is_unwind_safe(&OctreeIndex::new(ball()).expect("valid"));
}

#[test]
fn signs_are_owned_cloned_sent_and_batched() {
    let soup = Arc::new(ball());
    let signed = SignedDistance::build(Arc::clone(&soup)).expect("closed");
    let borrowed = SignedDistance::new(AabbTree::new(&*soup).expect("valid"), &*soup).unwrap();
    let queries = queries(3000);
    let expected: Vec<_> = queries.iter().map(|query| borrowed.closest_point(query)).collect();
    assert!(expected.iter().flatten().any(|signed| signed.sign == Sign::Inside));
    let copy = signed.clone();
    assert_eq!(format!("{copy:?}"), "SignedDistance { rule: Winding, .. }");
    let of_thread = std::thread::spawn({
        let queries = queries.clone();
        move || queries.iter().map(|query| copy.closest_point(query)).collect::<Vec<_>>()
    });
    assert_eq!(of_thread.join().expect("no panic"), expected);
    let batch = signed.closest_points(&queries, &Default::default(), &BatchOptions::default());
    let fields = |all: &[Option<p2m::field::sign::Signed>]| -> Vec<_> {
        all.iter().map(|one| one.map(|one| (one.sign, one.closest.primitive, one.distance()))).collect()
    };
    assert_eq!(fields(&batch), fields(&expected));
}

#[test]
fn a_scene_in_f32_has_the_signs_of_the_same_scene_in_f64() {
    let single: Soup<f32> = narrow(&ball()).expect("fits f32");
    let positions: Vec<Point3<f64>> = single.positions().iter().map(|p| p.map(f64::from)).collect();
    let double = Arc::new(Soup::from_triangles(positions, single.triangles().to_vec()).expect("valid"));
    let tree = AabbTree::new(Arc::new(single)).expect("valid");
    let signed = SignedDistance::new(tree, Arc::clone(&double)).expect("closed");
    let expected = SignedDistance::build(double).expect("closed");
    let mut inside = 0;
    for query in queries(3000) {
        let query = query.map(|x| x as f32);
        let answer = signed.closest_point(&query).expect("not empty");
        assert_eq!(answer.sign, expected.closest_point(&query.map(f64::from)).expect("not empty").sign);
        let distance = answer.distance().expect("defined");
        assert_eq!(distance < 0.0, answer.sign == Sign::Inside);
        inside += usize::from(distance < 0.0);
    }
    assert!(inside > 300, "{inside}");
}

#[test]
fn a_tree_follows_a_scene_in_place_and_tells_what_it_lost() {
    let mut tree = AabbTree::new(ball()).expect("valid");
    let area = tree.surface_area();
    assert!(area > 10.0 && area < 1000.0, "{area}");
    // A rigid motion by a right angle does not change the quality.
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
    tree.refit_in_place(&Default::default(), |soup| soup.map_positions(|p| turn * p)).expect("finite");
    assert!((tree.surface_area() / area - 1.0).abs() < 1e-3);
    // Scattering the vertices ruins the quality, and a new build restores it.
    let mut rng = rng("scattered", 0);
    let scatter = |_| Point3::from([(); 3].map(|()| rng.random_range(-1.0..1.0)));
    tree.refit_in_place(&Default::default(), |soup| soup.map_positions(scatter)).expect("finite");
    let scattered = tree.surface_area();
    assert!(scattered > 2.0 * area, "{scattered} {area}");
    let brute = BruteForce::new(tree.set().clone()).expect("valid");
    for query in queries(100) {
        let fields = |index: &dyn ClosestPoint<f64>| index.closest_point(&query).map(|c| (c.distance, c.primitive));
        assert_eq!(fields(&tree), fields(&brute));
    }
    let rebuilt = AabbTree::new(tree.into_set()).expect("valid");
    assert!(rebuilt.surface_area() < scattered);
    // After a failed motion, scene and tree are unchanged.
    let mut tree = rebuilt;
    let before = tree.set().clone();
    let failed = tree.refit_in_place(&Default::default(), |soup| soup.map_positions(|p| p * f64::NAN));
    assert!(matches!(failed, Err(BuildError::NonFinite { .. })));
    assert_eq!(tree.set(), &before);
    let short = tree.refit_in_place(&Default::default(), |soup| soup.set_positions(Vec::new()));
    assert_eq!(short, Err(BuildError::OtherPositionCount { len: 0, expected: before.positions().len() }));
    let empty: AabbTree<f64, Soup<f64>> = AabbTree::new(Soup::default()).expect("valid");
    assert_eq!(empty.surface_area(), 0.0);
}

#[test]
fn one_primitive_that_flies_away_does_not_hide_what_a_tree_lost() {
    let mut rng = rng("outlier", 0);
    let mut point = move || Point3::from([(); 3].map(|()| rng.random_range(-1.0..1.0)));
    let mut tree = AabbTree::new(scattered(&mut point, 5000)).expect("valid");
    let area = tree.surface_area();
    let mut soup = scattered(&mut point, 5000);
    let positions = soup.positions().iter().enumerate().map(|(i, p)| if i < 3 { p * 100.0 } else { *p }).collect();
    soup.set_positions(positions).expect("finite");
    tree.refit(soup, &Default::default()).expect("as many primitives");
    assert!(tree.surface_area() > 2.0 * area);
}

/// Returns small triangles at random places.
fn scattered(point: &mut impl FnMut() -> Point3<f64>, count: usize) -> Soup<f64> {
    let positions = (0..count).flat_map(|_| {
        let corner = point();
        [corner, corner + Vector3::new(0.01, 0.0, 0.0), corner + Vector3::new(0.0, 0.01, 0.0)]
    });
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Soup::from_triangles(positions.collect(), triangles).expect("valid")
}

#[test]
fn a_tree_answers_for_whatever_a_change_left() {
    let same = |tree: &AabbTree<f64, Soup<f64>>| {
        let brute = BruteForce::new(tree.set().clone()).expect("valid");
        queries(30).iter().all(|q| {
            let distance = |index: &dyn ClosestPoint<f64>| index.closest_point(q).map(|c| c.distance);
            distance(tree) == distance(&brute)
        })
    };
    let mut tree = AabbTree::new(ball()).expect("valid");
    let up = |p: Point3<f64>| p + Vector3::new(0.0, 0.0, 2.0);
    // The first motion is valid, the second one is not.
    let failed = tree.refit_in_place(&Default::default(), |soup| {
        soup.map_positions(up)?;
        soup.map_positions(|p| p * f64::NAN)
    });
    assert!(failed.is_err() && same(&tree));
    let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        tree.refit_in_place(&Default::default(), |soup| {
            soup.map_positions(up)?;
            panic!("after a motion")
        })
    }));
    assert!(panicked.is_err() && same(&tree));
    // No tree fits a scene of another size, so the search finds nothing.
    let other = Soup::from_triangles(ball().positions().to_vec(), vec![[0, 1, 2]]).expect("valid");
    let error = tree.refit_in_place(&Default::default(), |soup| {
        *soup = other;
        Ok(())
    });
    assert_eq!(error, Err(BuildError::OtherLength { len: 1, expected: ball().len() }));
    assert!(tree.closest_point(&[0.0; 3]).is_none());
    assert!(tree.refit(ball(), &Default::default()).is_err());
}

#[test]
fn an_index_of_another_scene_has_no_signs() {
    let shifted = Arc::new({
        let mut soup = ball();
        soup.map_positions(|p| p + Vector3::new(5.0, 0.0, 0.0)).expect("finite");
        soup
    });
    let index = || AabbTree::new(ball()).expect("valid");
    let other = SignError::OtherScene { triangle: 0, vertex: 0 };
    assert_eq!(SignedDistance::new(index(), Arc::clone(&shifted)).unwrap_err(), other);
    assert_eq!(SignedDistance::with_rule(index(), Arc::clone(&shifted), SignRule::Parity).unwrap_err(), other);
    // A scene with other kinds of primitives returns that error, whatever the ids of its triangles are.
    let elements = [p2m::Element::Segment([2, 3]), p2m::Element::Point(3), p2m::Element::Triangle([0, 1, 2])];
    let mixed = Soup::new(ball().positions()[..4].to_vec(), elements).expect("valid");
    let over_mixed = AabbTree::new(&mixed).expect("valid");
    assert_eq!(SignedDistance::new(over_mixed, &mixed).unwrap_err(), SignError::OtherKinds { others: 2 });
    let empty = AabbTree::<f64, Soup<f64>>::new(Soup::default()).expect("valid");
    assert_eq!(SignedDistance::new(empty, shifted).unwrap_err(), other);
}

#[test]
fn messages_tell_the_reason() {
    let message = |positions: usize| {
        let positions = vec![Point3::origin(); positions];
        Soup::<f64>::from_triangles(positions, vec![[0, 1, 2]]).unwrap_err().to_string()
    };
    assert_eq!(message(0), "primitive 0 uses position 0, but there are no positions");
    assert_eq!(message(1), "primitive 0 uses position 1, but there is only position 0");
    assert_eq!(message(2), "primitive 0 uses position 2, but positions are numbered 0 to 1");
    let error = p2m::scene::read_scene(std::path::Path::new("missing.obj")).unwrap_err().to_string();
    assert!(error.starts_with("missing.obj: cannot be read: ") && error.len() > 40, "{error}");
    assert_eq!(ball().len(), ball().triangles().len());
}
