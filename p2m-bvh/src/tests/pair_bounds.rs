//! Tests that the bounds of a search for pairs never exceed distances. Wrong answers would reveal an error too rarely:
//! nodes are rounded outwards, and the bound of the nearest pair itself would have to exceed its distance.

use crate::traverse::pairs::TreeSide;
use crate::tree::PacketTree;
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::WideNode;
use crate::{AabbTree, SplitOptions};
use nalgebra::{Isometry3, Point3, Vector3};
use p2m_core::engine::pairs::{Directions, PairSide, Place, ShapeSide};
use p2m_core::engine::vector::{V3, dot};
use p2m_core::pair::{Motion, PairOptions, PairQuery, nearest_of_hulls};
use p2m_core::{Aabb, BruteForce, Point, PrimitiveId, Triangle};
use p2m_testkit::{cases, rng, vector};
use rand::RngExt;

/// Returns the tree of at most eight points, each in a packet of its own. So the boxes have no extent except for
/// rounding, and bounds are tight.
fn tree(points: &[Point<f64>]) -> PacketTree<Aabb<f64>> {
    PacketTree::build(points, &SplitOptions { max_leaf: 1, ..SplitOptions::default() })
}

/// Returns the children of the root of a tree with their points.
fn children(tree: &PacketTree<Aabb<f64>>, points: &[Point<f64>]) -> Vec<(Place, V3)> {
    let node = &tree.nodes[tree.root.number()];
    let child = |slot: usize| {
        let reference = node.children()[slot];
        assert!(reference.is_packet(), "eight points are in one node");
        let id: PrimitiveId = tree.leaves.packets[reference.number()].ids()[0];
        let place =
            Place { node: reference.0, parent: tree.root.0, slot: u8::try_from(slot).expect("eight"), size: 0.0 };
        (place, points[id.index()].position.coords.into())
    };
    node.used_slots().map(child).collect()
}

#[test]
fn bounds_between_nodes_never_exceed_distances() {
    let all = cases(300_000, 8_000);
    let mut compared = 0;
    for case in all.clone() {
        let mut rng = rng("bounds between nodes", case);
        // Frames keep a margin in proportion to the distance, so the distances are small relative to the frame.
        let gap = 2f64.powi(-rng.random_range(5..16));
        let far = vector(&mut rng) * [0.0, 1.0, 1e9, 2f64.powi(34), 2f64.powi(35)][rng.random_range(0..5)];
        let turn = [Vector3::zeros(), vector(&mut rng) * 3.0][rng.random_range(0..2)];
        let moved = Isometry3::new(far, turn);
        let motions = [Motion::new(&moved)];
        let at: Vec<Vector3<f64>> = (0..8).map(|_| vector(&mut rng)).collect();
        let first: Vec<_> = at.iter().map(|place| Point::new(Point3::from(*place))).collect();
        let second: Vec<_> = (at.iter())
            .map(|place| place + vector(&mut rng).normalize() * gap)
            .map(|place| Point::new(moved.inverse_transform_point(&place.into())))
            .collect();
        let trees = [tree(&first), tree(&second)];
        let sides = [TreeSide::new(&trees[0], &[]), TreeSide::new(&trees[1], &motions)];
        let Some(directions) = Directions::new([&sides[0], &sides[1]]) else { continue };
        let mut slabs = Vec::new();
        for fixed in [0, 1] {
            let points = [&first, &second];
            let image = |side: usize, point: V3| if side == 1 { motions[0].apply(point) } else { point };
            let others = children(&trees[1 - fixed], points[1 - fixed]);
            for (place, point) in children(&trees[fixed], points[fixed]) {
                directions.slabs(fixed, &sides[fixed], &place, &mut slabs);
                let bounds = sides[1 - fixed].cut(trees[1 - fixed].root.0, &slabs, directions.triples);
                for (other, other_point) in &others {
                    let (p, q) = (image(fixed, point), image(1 - fixed, *other_point));
                    let pair = nearest_of_hulls(&[p], &[q], f64::INFINITY).expect("no limit");
                    let bound = bounds.squares[usize::from(other.slot)];
                    assert!(bound <= pair.key.square_above(), "{case}: {} > {:?}", bound.sqrt(), pair.key);
                    compared += 1;
                }
            }
        }
    }
    assert!(all.have_more_than(500_000, compared), "{compared}");
}

/// The vertices of a node have about the same height, so a search that trusts bounds in f32 would stop at one that is
/// not the highest.
#[test]
fn extents_along_a_direction_are_those_of_vertices() {
    for case in cases(100_000, 4_000) {
        let mut rng = rng("extents", case);
        let along = vector(&mut rng).normalize();
        let noise = [1e-9, 1e-8, 1e-7][rng.random_range(0..3)];
        let points: Vec<Point<f64>> = (0..8)
            .map(|_| {
                let at = vector(&mut rng);
                let at = at - along * along.dot(&at) + along * (noise * rng.random_range(-1.0..1.0));
                Point::new(at.into())
            })
            .collect();
        let tree = tree(&points);
        let side = TreeSide::new(&tree, &[]);
        let along: V3 = along.into();
        let highest = points.iter().map(|point| dot(point.position.coords.into(), along)).fold(f64::MIN, f64::max);
        let found = side.support(NodeRef::node(0).0, &along);
        assert!((found - highest).abs() <= 1e-15, "{case}: {found} {highest}");
    }
}

/// The boxes of nodes are exact here, because the coordinates of the points have few digits. A shape has no slack of
/// its own, so only the slack of the children covers the rounding of their heights to f32.
#[test]
fn bounds_between_exact_nodes_and_shapes_never_exceed_distances() {
    for case in cases(200_000, 3_000) {
        let mut rng = rng("bounds between shapes and nodes", case);
        let gap = 2f64.powi(-rng.random_range(10..18));
        let moved = Isometry3::new(vector(&mut rng), vector(&mut rng) * 3.0);
        let motions = [Motion::new(&moved)];
        // The first two points make 0 the centre of the frame, and 2 its unit.
        let few_digits = |x: f64| (x * 2f64.powi(23)).round() * 2f64.powi(-23);
        let corners = [-1.0, 1.0].map(Vector3::repeat);
        let others = [(); 6].map(|()| vector(&mut rng).map(few_digits));
        let points: Vec<_> = corners.into_iter().chain(others).map(|at| Point::new(Point3::from(at))).collect();
        let mut tree = tree(&points);
        assert_eq!((tree.frame.centre, tree.frame.unit), ([0.0; 3], 2.0));
        let places = children(&tree, &points);
        for (place, point) in &places {
            #[allow(clippy::cast_possible_truncation, reason = "the coordinates have few digits")]
            let exact = point.map(|x| (x * 0.5) as f32);
            let root = tree.root.number();
            tree.nodes[root].set_bounds(usize::from(place.slot), &[exact, exact]);
        }
        let side = TreeSide::new(&tree, &motions);
        let mut slabs = Vec::new();
        for (place, point) in &places {
            let image = motions[0].apply(*point);
            let beside: V3 = (Vector3::from(image) + vector(&mut rng).normalize() * gap).into();
            let hull = [beside];
            let shape = ShapeSide(&hull);
            let directions = Directions::new([&side, &shape]).expect("ordinary sizes");
            directions.slabs(1, &shape, &shape.root().expect("one point"), &mut slabs);
            let bound = side.cut(tree.root.0, &slabs, directions.triples).squares[usize::from(place.slot)];
            let pair = nearest_of_hulls(&[image], &hull, f64::INFINITY).expect("no limit");
            assert!(bound <= pair.key.square_above(), "{case}: {} > {:?}", bound.sqrt(), pair.key);
        }
    }
}

/// At these scales squares of lengths, or lengths themselves, are subnormal or overflow, so that heights have large
/// relative errors.
#[test]
fn scenes_of_extreme_sizes_have_the_pairs_of_brute_force() {
    for case in cases(200_000, 3_000) {
        let mut rng = rng("extreme scenes", case);
        let exponent = [-1070, -545, -540, -537, -534, -531, -525, -310, 310, 505, 1015, 1021][rng.random_range(0..12)];
        let unit = 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
        let flat = [1.0, 1e-3, 0.0][rng.random_range(0..3)];
        let mut scene = || -> Vec<Triangle<f64>> {
            let mut at = || {
                let at = vector(&mut rng) * unit;
                Point3::new(at.x, at.y, at.z * flat)
            };
            (0..4).map(|_| Triangle::new(at(), at(), at())).collect()
        };
        let [a, b] = [scene(), scene()];
        let options = PairOptions::default();
        let brutes = [&a, &b].map(|scene| BruteForce::new(scene).expect("valid"));
        let expected = brutes[0].closest_pair(&brutes[1], &options).map(|pair| (pair.distance, pair.primitives));
        let finest = SplitOptions { max_leaf: 1, ..SplitOptions::default() };
        for splits in [SplitOptions::default(), finest] {
            let [a, b] = [&a, &b].map(|scene| AabbTree::build_with(scene, &splits).expect("valid"));
            let found = a.closest_pair(&b, &options).map(|pair| (pair.distance, pair.primitives));
            assert_eq!(found, expected, "{case}: 2^{exponent}");
        }
    }
}

/// The squares of these lengths are one or two times the smallest number. Rounded like that, the second offset seems to
/// be longer than the first.
#[test]
fn offsets_whose_squares_are_hardly_numbers_are_compared() {
    for unit in [2f64.powi(-537), 2f64.powi(-536), 2f64.powi(-530)] {
        for diagonal in [0.7, 0.74, 0.75, 0.753] {
            let at = |v: [f64; 3]| Point::new(Point3::from(v.map(|x| x * unit)));
            let a = [at([10.0, 0.0, 0.0]), at([0.0; 3])];
            let b = [at([11.305, 0.0, 0.0]), at([diagonal; 3])];
            let brutes = [&a, &b].map(|scene| BruteForce::new(scene).expect("valid"));
            let trees = [&a, &b].map(|scene| AabbTree::new(scene).expect("valid"));
            for hint in [[0, 0], [1, 1]] {
                let options = PairOptions::default().with_hint(hint.map(PrimitiveId::new));
                let expected = brutes[0].closest_pair(&brutes[1], &options).map(|pair| pair.primitives);
                assert_eq!(expected, Some([PrimitiveId::new(usize::from(diagonal < 0.753_4)); 2]));
                assert_eq!(
                    trees[0].closest_pair(&trees[1], &options).map(|pair| pair.primitives),
                    expected,
                    "{unit:e}"
                );
            }
        }
    }
}
