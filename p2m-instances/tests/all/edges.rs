//! Scenes and motions at the edge of what is allowed.

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{AnyIndex, BruteForce, ClosestPoint, Element, IndexStats, NearQuery, PrimitiveId, Ray, RayQuery, Soup};
use p2m_instances::{InstanceError, Instances};
use std::sync::Arc;

type Tree = AabbTree<f64, Soup<f64>>;

/// Returns an index over a unit square of two triangles in the plane z = 0.
fn square() -> Arc<Tree> {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let soup = Soup::from_arrays(&positions, &[[0u32, 1, 2], [0, 2, 3]]).expect("valid");
    Arc::new(Tree::new(soup).expect("valid"))
}

#[test]
fn a_scene_without_primitives_has_no_answers() {
    let mut scene: Instances<f64> = Instances::default();
    let origin = Point3::<f64>::origin();
    let ray = Ray::new(&origin, &Vector3::x()).expect("a direction");
    assert_eq!((scene.closest_point(&origin), scene.first_intersection(&ray)), (None, None));
    let nothing: Arc<dyn AnyIndex> = Arc::new(BruteForce::new(Soup::<f64>::default()).expect("valid"));
    let id = scene.edit().add("nothing", &nothing, Isometry3::translation(1.0, 2.0, 3.0)).expect("valid");
    assert!(scene.bounds().is_empty() && scene.instance(id).is_some_and(|instance| instance.primitives().is_empty()));
    assert_eq!((scene.closest_point(&origin), scene.count(&ray)), (None, 0));
    // Empty instances before and behind take no ids.
    let square: Arc<dyn AnyIndex> = square();
    let mut edit = scene.edit();
    let square = edit.add("square", &square, Isometry3::identity()).expect("valid");
    edit.add("nothing again", &nothing, Isometry3::identity()).expect("valid");
    drop(edit);
    let found = scene.closest_point(&Point3::new(0.9, 0.1, 2.0)).expect("a square");
    assert_eq!((found.distance, scene.instance_of(found.primitive)), (2.0, Some((square, PrimitiveId::new(0)))));
    assert_eq!(scene.instance_count(), 3);
}

#[test]
fn motions_that_cannot_be_applied_are_errors_and_change_nothing() {
    let (mut scene, square) = (Instances::new(), square());
    let id = scene.edit().add("square", &square, Isometry3::identity()).expect("valid");
    let zero = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 0.0, 0.0));
    let not_finite = [
        Isometry3::translation(f64::NAN, 0.0, 0.0),
        Isometry3::translation(0.0, f64::INFINITY, 0.0),
        Isometry3::from_parts(Translation3::identity(), zero),
        Isometry3::rotation(Vector3::new(f64::NAN, 0.0, 0.0)),
    ];
    for motion in not_finite {
        let mut edit = scene.edit();
        assert_eq!(edit.set_motion(id, motion), Err(InstanceError::NonFiniteMotion));
        assert_eq!(edit.add("lost", &square, motion), Err(InstanceError::NonFiniteMotion));
    }
    let beyond = Isometry3::translation(f64::MAX, 0.0, 0.0);
    assert_eq!(scene.edit().set_motion(id, beyond), Err(InstanceError::OutOfRange));
    assert_eq!(scene.instance_count(), 1);
    assert_eq!(scene.closest_point(&Point3::new(0.5, 0.25, 3.0)).expect("a square").distance, 3.0);
    scene.edit().remove(id).expect("in the scene");
    assert_eq!(scene.edit().set_motion(id, Isometry3::identity()), Err(InstanceError::Unknown { id }));
    assert_eq!(scene.edit().remove(id), Err(InstanceError::Unknown { id }));
    // The id is not used again.
    assert_ne!(scene.edit().add("square", &square, Isometry3::identity()), Ok(id));
}

#[test]
fn a_primitive_without_vertices_cannot_be_moved() {
    struct Ball;
    impl p2m_core::Primitive<f64> for Ball {
        fn aabb(&self) -> p2m_core::Aabb<f64> {
            p2m_core::Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) }
        }
        fn project(&self, query: &Point3<f64>) -> p2m_core::Projection {
            p2m_core::Projection::new(query, Point3::origin(), p2m_core::Feature::Face, [1.0, 0.0, 0.0], 0.0)
        }
        fn intersect_ray(&self, _: &Ray) -> Option<p2m_core::RayHit> {
            None
        }
    }
    let ball = Arc::new(BruteForce::new([Ball]).expect("valid"));
    let mut scene = Instances::new();
    let error = InstanceError::NoVertices { id: PrimitiveId::new(0) };
    assert_eq!(scene.edit().add("ball", &ball, Isometry3::identity()), Err(error));
    assert_eq!(scene.instance_count(), 0);
}

#[test]
fn more_primitives_than_ids_are_an_error() {
    /// Claims to have as many primitives as there are ids, all of them the origin.
    struct Many;
    impl p2m_core::PrimitiveSet<f64> for Many {
        type Primitive<'a> = p2m_core::Point<f64>;
        fn len(&self) -> usize {
            1 << 22
        }
        fn get(&self, _: PrimitiveId) -> p2m_core::Point<f64> {
            p2m_core::Point::new(Point3::origin())
        }
    }
    let many = Arc::new(BruteForce::new(Many).expect("valid"));
    let mut scene = Instances::new();
    let mut edit = scene.edit();
    for i in 0..256 {
        edit.add("many", &many, Isometry3::translation(f64::from(i), 0.0, 0.0)).expect("ids are left");
    }
    let len = 257 << 22;
    assert_eq!(edit.add("one too many", &many, Isometry3::identity()), Err(InstanceError::TooMany { len }));
    drop(edit);
    let last = PrimitiveId::new((1 << 30) - 1);
    assert_eq!(scene.instance_of(last).map(|(_, local)| local.index()), Some((1 << 22) - 1));
}

#[test]
fn equally_near_instances_are_told_apart_by_their_ids() {
    let (mut scene, square) = (Instances::new(), square());
    let mut edit = scene.edit();
    let [above, below] =
        [1.0, -1.0].map(|z| edit.add("square", &square, Isometry3::translation(0.0, 0.0, z)).expect("valid"));
    drop(edit);
    let between = Point3::new(0.75, 0.25, 0.0);
    let nearest = |scene: &Instances<f64, Tree>| {
        let primitive = scene.closest_point(&between).expect("two squares").primitive;
        scene.instance_of(primitive).map(|(instance, _)| instance)
    };
    assert_eq!(nearest(&scene), Some(above));
    let ids: Vec<_> = scene.k_nearest(&between, 9, 1.0).iter().map(|found| found.primitive.index()).collect();
    assert_eq!(ids.len(), 2);
    scene.edit().remove(above).expect("in the scene");
    assert_eq!(nearest(&scene), Some(below));
}

#[test]
fn an_edit_that_is_leaked_costs_time_and_no_answer() {
    let (mut scene, square) = (Instances::new(), square());
    for x in [0.0, 3.0, 6.0] {
        let mut edit = scene.edit();
        edit.add("square", &square, Isometry3::translation(x, 0.0, 0.0)).expect("valid");
        std::mem::forget(edit);
    }
    let above = Point3::new(6.75, 0.25, 2.0);
    let ray = Ray::new(&above, &-Vector3::z()).expect("a direction");
    for _ in 0..2 {
        assert_eq!(scene.closest_point(&above).map(|found| (found.distance, found.primitive.index())), Some((2.0, 4)));
        assert_eq!(scene.first_intersection(&ray).map(|hit| hit.primitive.index()), Some(4));
        assert_eq!(scene.all_within(&above, 2.5).len(), 2);
        // The next edit builds the tree.
        drop(scene.edit());
    }
}

#[test]
fn a_scene_keeps_its_answers_while_all_instances_move_far_apart() {
    let (mut scene, square) = (Instances::new(), square());
    let mut edit = scene.edit();
    for i in 0..300 {
        edit.add("square", &square, Isometry3::translation(f64::from(i), 0.0, 0.0)).expect("valid");
    }
    drop(edit);
    assert!(scene.memory_bytes() < 400 * 300, "{:?}", IndexStats::parts(&scene));
    for step in 1..30 {
        let at =
            |i: f64| Vector3::new(i, (i * 0.7).sin() * f64::from(step * step), (i * i).cos() * f64::from(step * 9));
        scene
            .edit()
            .move_all(|instance| Isometry3::new(at((instance.primitives().start / 2) as f64), Vector3::zeros()))
            .expect("finite");
        let query = Point3::from(at(137.0)) + Vector3::new(0.9, 0.2, 0.125);
        let found = scene.closest_point(&query).expect("squares");
        assert_eq!(scene.instances().nth(found.primitive.index() / 2).map(|one| one.primitives().start), Some(274));
    }
}

#[test]
fn an_index_is_measured_once_for_all_of_its_instances() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    struct Counted(AtomicUsize);
    impl p2m_core::PrimitiveSet<f64> for Counted {
        type Primitive<'a> = p2m_core::Point<f64>;
        fn len(&self) -> usize {
            10
        }
        fn get(&self, id: PrimitiveId) -> p2m_core::Point<f64> {
            self.0.fetch_add(1, Ordering::Relaxed);
            p2m_core::Point::new(Point3::new(id.index() as f64, 0.0, 0.0))
        }
    }
    let index = Arc::new(BruteForce::new(Counted(AtomicUsize::new(0))).expect("valid"));
    let before = index.set().0.load(Ordering::Relaxed);
    let mut scene = Instances::new();
    let mut edit = scene.edit();
    for i in 0..100 {
        edit.add("points", &index, Isometry3::translation(0.0, f64::from(i), 0.0)).expect("valid");
    }
    drop(edit);
    assert_eq!(index.set().0.load(Ordering::Relaxed) - before, 10);
    assert_eq!(Arc::strong_count(&index), 2);
    let ids: Vec<_> = scene.instances().map(|instance| instance.id()).collect();
    let mut edit = scene.edit();
    ids.into_iter().for_each(|id| edit.remove(id).expect("in the scene"));
    drop(edit);
    assert_eq!(Arc::strong_count(&index), 1);
}

/// The points of a small grid are moved so far that rounding puts many of them into the same place. The nearest one is
/// found by the margin alone, at the first level of instances and through a scene that is an instance itself.
#[test]
fn points_that_a_far_motion_rounds_together_are_told_apart_by_their_ids() {
    let grid = |i: u32| f64::from(i % 12) * 3e-5;
    let points: Vec<_> = (0..1728).map(|i| [grid(i), grid(i / 12), grid(i / 144)]).collect();
    let ids: Vec<u32> = (0..1728).rev().collect();
    let soup = Soup::new(points.iter().map(|p| Point3::from(*p)).collect(), ids.iter().map(|i| Element::Point(*i)));
    let soup = soup.expect("valid");
    let tree: Arc<dyn AnyIndex + '_> = Arc::new(AabbTree::new(&soup).expect("valid"));
    let turned = Isometry3::new(Vector3::new(-7e11, 1e12, 3e11), Vector3::new(0.3, 0.2, 0.1));
    let mut inner = Instances::new();
    inner.edit().add("grid", &tree, Isometry3::identity()).expect("valid");
    let inner: Arc<dyn AnyIndex + '_> = Arc::new(inner);
    for index in [&tree, &inner] {
        let mut scene = Instances::new();
        scene.edit().add("far", index, turned).expect("valid");
        let truth = BruteForce::new(&scene).expect("finite");
        for i in 0..60 {
            let near = turned * Point3::new(grid(i), grid(2 * i), 4e-4 * f64::from(i % 3));
            let ids = |found: Vec<p2m_core::Closest<f64>>| found.iter().map(|c| c.primitive).collect::<Vec<_>>();
            let nearest = scene.closest_point(&near).map(|found| found.primitive);
            assert_eq!(nearest, truth.closest_point(&near).map(|found| found.primitive), "{i}");
            assert_eq!(ids(scene.k_nearest(&near, 5, 1.0)), ids(truth.k_nearest(&near, 5, 1.0)), "{i}");
        }
    }
}
