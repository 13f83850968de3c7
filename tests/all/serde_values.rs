//! Tests of soups and indexes as serde values, which contain saved files.
#![cfg(all(feature = "bvh", feature = "interception", feature = "serde"))]

use p2m::nalgebra::Point3;
use p2m::{AabbTree, BuildIndex, ClosestPoint, Element, OctreeIndex, PrimitiveSet, Soup};
use std::sync::Arc;

fn scene() -> Arc<Soup<f64>> {
    let positions = [[0.1, 0.2, 0.3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1e-300, -0.0, 9.0]].map(Point3::from);
    let elements = [Element::Segment([0, 3]), Element::Triangle([0, 1, 2]), Element::Point(3)];
    Arc::new(Soup::new(positions.to_vec(), elements).expect("valid"))
}

#[test]
fn indexes_come_back_with_their_scenes() {
    type Tree = AabbTree<f64, Arc<Soup<f64>>>;
    type Octree = OctreeIndex<f64, Arc<Soup<f64>>>;
    let tree = Tree::new(scene()).expect("valid");
    let octree = Octree::build(scene(), &Default::default()).expect("valid");
    let tree_text = serde_json::to_string(&tree).expect("serialises");
    let octree_text = serde_json::to_string(&octree).expect("serialises");
    let tree_back: Tree = serde_json::from_str(&tree_text).expect("deserialises");
    let octree_back: Octree = serde_json::from_str(&octree_text).expect("deserialises");
    assert_eq!(tree_back.set(), &scene());
    for query in [[0.5, 0.5, 1.0], [0.0, 0.0, 8.0], [9.0, 9.0, 9.0]].map(Point3::from) {
        assert_eq!(tree_back.closest_point(&query), tree.closest_point(&query));
        assert_eq!(octree_back.closest_point(&query), octree.closest_point(&query));
    }
    // An index of another kind, another scene, and damaged bytes are errors.
    assert!(serde_json::from_str::<Octree>(&tree_text).is_err_and(|e| e.to_string().contains("kind")));
    let bits = |x: f64| x.to_bits().to_string();
    let other_scene = tree_text.replacen(&bits(9.0), &bits(9.5), 1);
    assert!(serde_json::from_str::<Tree>(&other_scene).is_err_and(|e| e.to_string().contains("other primitives")));
    let damaged = tree_text.replacen("[137,", "[136,", 1);
    assert_ne!(damaged, tree_text);
    assert!(serde_json::from_str::<Tree>(&damaged).is_err());
}

#[test]
fn a_soup_is_checked_when_it_comes_back() {
    let mut unused = Soup::clone(&scene());
    unused.push_position(Point3::new(f64::NAN, f64::INFINITY, 0.1));
    let text = serde_json::to_string(&unused).expect("serialises");
    let back: Soup<f64> = serde_json::from_str(&text).expect("deserialises");
    assert!(back.positions()[4].x.is_nan() && back.positions()[4].y == f64::INFINITY);
    let text = serde_json::to_string(&*scene()).expect("serialises");
    let back: Soup<f64> = serde_json::from_str(&text).expect("deserialises");
    assert_eq!(back, *scene());
    assert_eq!(back.len(), 3);
    let bad = text.replace("\"Point\":3", "\"Point\":4");
    assert_ne!(bad, text);
    let error = serde_json::from_str::<Soup<f64>>(&bad).expect_err("there is no position 4").to_string();
    assert!(error.contains("primitive 2 uses position 4, but positions are numbered 0 to 3"), "{error}");
}
