//! Compares pairs of scenes of thin triangles with rational arithmetic.
#![cfg(all(feature = "bvh", feature = "instances", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::Isometry3;
use p2m::instances::Instances;
use p2m::pair::{ClosestPair, ERROR_CONSTANT_OF_PAIRS, PairOptions, PairQuery};
use p2m::{AabbTree, AnyIndex, BruteForce, KdopTree, PrimitiveId, Shape};
use p2m_testkit::oracle::Distance;
use p2m_testkit::{cases, rng, thin_scenes};
use rand::RngExt;
use std::ops::ControlFlow;
use std::sync::Arc;

type Ids = [PrimitiveId; 2];

/// The exact distances of all pairs of two scenes.
struct Exact {
    distances: Vec<(Ids, Distance)>,
    /// The position of the least distance, and of equal ones the lowest ids.
    nearest: usize,
}

impl Exact {
    fn new(scenes: &[Vec<Vec<[f64; 3]>>; 2]) -> Self {
        let [a, b] = scenes;
        let ids = (0..a.len()).flat_map(|i| (0..b.len()).map(move |j| [i, j]));
        let distances: Vec<_> =
            ids.map(|[i, j]| ([i, j].map(PrimitiveId::new), Distance::between(&a[i], &b[j]))).collect();
        let nearest = (0..distances.len()).min_by(|i, j| distances[*i].1.compare(&distances[*j].1));
        Self { distances, nearest: nearest.expect("scenes are not empty") }
    }

    fn nearest(&self) -> &Distance {
        &self.distances[self.nearest].1
    }

    /// Returns the ids of all intersecting pairs, in ascending order.
    fn intersecting(&self) -> Vec<Ids> {
        self.distances.iter().filter(|(_, distance)| distance.is_zero()).map(|(ids, _)| *ids).collect()
    }
}

/// Returns all fields of an answer except the lower bound, which depends on the pairs that a search evaluates.
fn fields(pair: Option<ClosestPair<f64>>) -> impl PartialEq + std::fmt::Debug {
    pair.map(|pair| {
        (pair.distance.to_bits(), pair.primitives, pair.points, pair.features, pair.barycentric, pair.is_intersecting)
    })
}

/// Returns the ids of the pairs within the largest distance, in ascending order.
fn ids_within(a: &dyn PairQuery<f64>, b: &dyn PairQuery<f64>, options: &PairOptions<f64>) -> Vec<Ids> {
    let mut ids = Vec::new();
    let _ = (&a).visit_pairs_within(b, options, &mut |pair| {
        ids.push(pair.primitives);
        ControlFlow::Continue(())
    });
    ids.sort_unstable();
    ids
}

/// Returns a scene of one instance.
fn instance<'a>(index: impl AnyIndex<f64> + 'a) -> Instances<f64, dyn AnyIndex<f64> + 'a> {
    let index: Arc<dyn AnyIndex<f64> + 'a> = Arc::new(index);
    let mut instances = Instances::new();
    instances.edit().add("", &index, Isometry3::identity()).expect("finite");
    instances
}

/// Compares the answers of every backend with the exact ones, and returns whether the scenes intersect. At ordinary
/// scales, exact distances are also available as f64.
fn check(scenes: &[Vec<Vec<[f64; 3]>>; 2], is_ordinary: bool, text: &str) -> bool {
    let exact = Exact::new(scenes);
    let text = format!("{text}: {scenes:?}");
    let shapes = scenes.each_ref().map(|scene| -> Vec<Shape<f64>> {
        scene.iter().map(|hull| Shape::from_vertices(hull).expect("one to three vertices")).collect()
    });
    let brutes = shapes.each_ref().map(|scene| BruteForce::new(scene).expect("finite"));
    let trees = shapes.each_ref().map(|scene| AabbTree::new(scene).expect("finite"));
    let kdops = shapes.each_ref().map(|scene| KdopTree::<f64, _, 14>::new(scene).expect("finite"));
    let finer = shapes.each_ref().map(|scene| KdopTree::<f64, _, 26>::new(scene).expect("finite"));
    let of_trees = shapes.each_ref().map(|scene| instance(AabbTree::new(scene).expect("finite")));
    // In an instance without a tree, each primitive is a side of its own.
    let of_brutes = shapes.each_ref().map(|scene| instance(BruteForce::new(scene).expect("finite")));
    let sides: [(&dyn PairQuery<f64>, &dyn PairQuery<f64>, &str); 7] = [
        (&brutes[0], &brutes[1], "brute force"),
        (&trees[0], &trees[1], "boxes"),
        (&kdops[0], &kdops[1], "14-DOPs"),
        (&finer[0], &finer[1], "26-DOPs"),
        (&kdops[0], &trees[1], "14-DOPs and boxes"),
        (&of_trees[0], &of_trees[1], "instances of trees"),
        (&of_brutes[0], &of_brutes[1], "instances of brute force"),
    ];
    let options = PairOptions::default();
    let plain = brutes[0].closest_pair(&brutes[1], &options).expect("scenes are not empty");
    let intersecting = exact.intersecting();
    let touch = options.with_max_distance(0.0);
    // The largest distance is that of the nearest pair, which is inclusive, or 0.25 if they are nearer.
    let within = options.with_max_distance(plain.distance.max(0.25));
    let near = ids_within(&brutes[0], &brutes[1], &within);
    let certified = brutes[0].certified_closest_pair(&brutes[1], &options);
    for (a, b, how) in sides {
        let found = (&a).closest_pair(b, &options).expect("scenes are not empty");
        assert_eq!(fields(Some(found)), fields(Some(plain)), "{how}, {text}");
        let error = exact.nearest().error(found.distance, 53, 4.0 * f64::from_bits(1));
        assert!(error <= ERROR_CONSTANT_OF_PAIRS, "{how}: {error} u M, {text}");
        assert!(exact.nearest().is_at_least(found.lower_bound), "{how}: {found:?}, {text}");
        assert_eq!(found.is_intersecting, !intersecting.is_empty(), "{how}, {text}");
        assert_eq!((&a).is_any_pair_near(b, &touch), !intersecting.is_empty(), "{how}, {text}");
        assert_eq!(ids_within(a, b, &touch), intersecting, "{how}, {text}");
        assert_eq!(ids_within(a, b, &within), near, "{how}, {text}");
        let proved = (&a).certified_closest_pair(b, &options).expect("scenes are not empty");
        assert_eq!(Some(proved), certified, "{how}, {text}");
        assert_eq!(proved.primitives, exact.distances[exact.nearest].0, "{how}, {text}");
        assert!(!is_ordinary || proved.distance == exact.nearest().length()[0], "{how}: {proved:?}, {text}");
        // The first primitive of the second scene is used as a shape.
        let shape = &shapes[1][0];
        let closest = (&a).closest_to(shape, &options);
        assert_eq!(fields(closest), fields(brutes[0].closest_to(shape, &options)), "{how}, {text}");
        let is_touched = intersecting.iter().any(|[_, j]| j.index() == 0);
        assert_eq!((&a).is_any_near(shape, &touch), is_touched, "{how}, {text}");
        let closest = closest.expect("scenes are not empty");
        let is_within = closest.distance > 0.0 || closest.is_intersecting;
        assert_eq!((&a).is_any_near(shape, &options.with_max_distance(closest.distance)), is_within, "{how}, {text}");
    }
    !intersecting.is_empty()
}

/// Returns the scenes of a case, and the exponent of the power of two by which they are scaled.
fn scenes_of(case: u64) -> ([Vec<Vec<[f64; 3]>>; 2], i32) {
    let mut rng = rng("pairs of thin triangles", case);
    let mut scenes = thin_scenes(&mut rng);
    // At these scales squares lose digits or overflow, and distances of the smallest scenes round to zero.
    let exponent =
        [0, 0, 0, [-1070, -1000, -530, -420, 420, 530, 1000][rng.random_range(0..7)]][rng.random_range(0..4)];
    let scale = |x: f64| x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
    scenes.iter_mut().flatten().flatten().flatten().for_each(|x| *x = scale(*x));
    (scenes, exponent)
}

#[test]
fn pairs_of_thin_triangles_are_exact() {
    let mut intersecting = 0;
    let all = cases(1_000_000, 1_200);
    for case in all.clone() {
        let (scenes, exponent) = scenes_of(case);
        intersecting += usize::from(check(&scenes, exponent == 0, &format!("scaled by 2^{exponent}")));
    }
    assert!(all.have_more_than(300_000, intersecting), "{intersecting}");
}

/// At these scales squares overflow, as did heights along lines in an earlier version.
#[test]
fn pairs_of_thin_triangles_are_exact_at_large_scales() {
    let mut intersecting = 0;
    let all = cases(100_000, 600);
    for case in all.clone() {
        let mut rng = rng("pairs at large scales", case);
        let mut scenes = thin_scenes(&mut rng);
        let scale = 2f64.powi(rng.random_range(400..1000));
        scenes.iter_mut().flatten().flatten().flatten().for_each(|x| *x *= scale);
        intersecting += usize::from(check(&scenes, false, &format!("scaled by {scale:e}")));
    }
    assert!(all.have_more_than(30_000, intersecting), "{intersecting}");
}

/// Inputs that an earlier version answered wrongly.
#[test]
fn thin_triangles_that_were_left_out_are_found() {
    let hull = |vertices: &[[f64; 3]]| vertices.to_vec();
    let scenes = [
        // The triangle is collinear up to rounding, and crosses another one.
        [
            vec![hull(&[[0.7, -0.3, 0.7], [-0.21000000000000002, 0.33, -0.14], [-0.6, 0.6, -0.5]])],
            vec![
                hull(&[[-0.4, 0.9, 0.3], [0.9, 0.5, 0.4], [-0.5, -0.6, 0.3]]),
                hull(&[[0.0, 0.6, -0.2], [-0.9, 0.0, 0.9], [0.3, -0.8, -0.7]]),
            ],
        ],
        // The common corner belongs to a triangle whose sides have the ratio 1 to 14,000.
        [
            vec![hull(&[[-7.1, 1.4, -4.5], [-2.6, -8.1, 4.0], [-4.849, -3.35, -0.25]])],
            vec![hull(&[[-2.6, -8.1, 4.0], [1.4, -0.3, 6.2], [6.7, 0.4, 1.9]])],
        ],
    ];
    for scenes in scenes {
        assert!(check(&scenes, true, "it was wrong"));
        let [a, b] = scenes;
        assert!(check(&[b, a], true, "it was wrong"));
    }
    // Products of coordinates of 2^530 overflow, and their sum is NaN.
    let (scenes, exponent) = scenes_of(131_090);
    assert_eq!(exponent, 530);
    assert!(check(&scenes, false, "it was wrong"));
}
