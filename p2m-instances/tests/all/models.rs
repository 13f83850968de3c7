//! Scenes of real meshes and their stand-ins.

use crate::reference::{Expected, Object, moved_soup};
use nalgebra::{Isometry3, Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{ClosestPoint, NearQuery, PrimitiveSet, Ray, RayQuery, Soup};
use p2m_instances::Instances;
use p2m_testkit::near_check::compared_fields;
use p2m_testkit::{amount, model_files, ray_check, rng, vector};
use rand::RngExt;
use std::sync::Arc;

#[test]
fn meshes_that_move_answer_as_one_index_over_all_of_them() {
    let files = model_files();
    let soups: Vec<Soup<f64>> = files
        .iter()
        .map(|file| Arc::unwrap_or_clone(p2m_mixed::read_scene(file).expect("a scene").soup))
        .filter(|soup| soup.len() < 200_000)
        .collect();
    let mut rng = rng("moving meshes", 0);
    let objects: Vec<Object<'_, f64>> = (soups.iter())
        .map(|soup| -> Object<'_, f64> { (soup, Arc::new(AabbTree::new(soup).expect("valid"))) })
        .collect();
    let mut scene = Instances::new();
    let mut expected: Vec<Expected> = Vec::new();
    let mut edit = scene.edit();
    for i in 0..amount(60, 24) {
        let object = i % objects.len();
        let id = edit.add(&files[object].display().to_string(), &objects[object].1, Isometry3::identity());
        expected.push((id.expect("valid"), object, Isometry3::identity()));
    }
    drop(edit);
    let size = soups.iter().map(|soup| soup.aabb()).map(|b| (b.max - b.min).amax()).fold(0.0, f64::max);
    for _ in 0..amount(8, 2) {
        let mut edit = scene.edit();
        for (id, _, motion) in &mut expected {
            *motion = Isometry3::new(vector(&mut rng) * size * 2.0, vector(&mut rng) * 3.0);
            edit.set_motion(*id, *motion).expect("finite");
        }
        drop(edit);
        let moved = moved_soup(&objects, &expected);
        let index = AabbTree::new(&moved).expect("valid");
        let mut hits = 0;
        for _ in 0..amount(20_000, 2_000) {
            let query = Point3::from(vector(&mut rng) * size * 3.0);
            let found = scene.closest_point(&query).as_ref().map(compared_fields);
            assert_eq!(found, index.closest_point(&query).as_ref().map(compared_fields), "{query:?}");
            let k = rng.random_range(0..6);
            let nearest = |index: &dyn NearQuery<f64>| {
                index.k_nearest(&query, k, f64::INFINITY).iter().map(compared_fields).collect::<Vec<_>>()
            };
            assert_eq!(nearest(&scene), nearest(&index), "{query:?}");
            let ray = Ray::new(&query, &Vector3::from(vector(&mut rng))).expect("a direction");
            let bits = |hits: Vec<p2m_core::Hit>| hits.iter().map(ray_check::bits).collect::<Vec<_>>();
            let all = bits(index.all_intersections(&ray));
            assert_eq!(bits(scene.all_intersections(&ray)), all, "{ray:?}");
            assert_eq!(scene.first_intersection(&ray).as_ref().map(ray_check::bits).as_ref(), all.first(), "{ray:?}");
            hits += all.len();
        }
        assert!(hits > 0);
    }
}
