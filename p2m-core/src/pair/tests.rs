//! Pairs of primitives against exact rational arithmetic.

use super::*;
use crate::kernel::vector::{power_of_two, scale_by_power};
use nalgebra::{Isometry3, Vector3};
use p2m_testkit::families::{case, pair};
use p2m_testkit::oracle::Distance;
use p2m_testkit::{cases, rng, vector};
use rand::RngExt;

/// Four times the smallest subnormal number.
const FOUR_ETA: f64 = f64::from_bits(4);

#[test]
fn distances_are_within_the_bound_and_intersections_are_exact() {
    let mut worst: f64 = 0.0;
    let mut intersecting = 0;
    let all = cases(10_000_000, 40_000);
    for number in all.clone() {
        let mut rng = rng("pairs of primitives", number);
        let (family, [a, b]) = pair(&mut rng);
        let exact = Distance::between(&a, &b);
        let pair = nearest_of_hulls(&a, &b, f64::INFINITY).expect("no limit");
        assert_eq!(
            (pair.is_intersecting, pair.key == Key::ZERO),
            (exact.is_zero(), exact.is_zero()),
            "{number}: {family}: {a:?} {b:?}"
        );
        let distance = pair.key.distance();
        let error = exact.error(distance, 53, FOUR_ETA);
        assert!(error <= ERROR_CONSTANT_OF_PAIRS, "{number}: {error} u M, {family}: {distance:e} {a:?} {b:?}");
        worst = worst.max(error);
        intersecting += usize::from(pair.is_intersecting);
    }
    println!("largest error: {worst} u M; {intersecting} intersect");
    assert!(all.have_more_than(1000, intersecting), "{intersecting}");
}

#[test]
fn keys_depend_neither_on_order_nor_on_scale() {
    for number in cases(200_000, 10_000) {
        let mut rng = rng("orders of pairs", number);
        let (family, [mut a, mut b]) = pair(&mut rng);
        let within = |pair: Result<NearestPair, f64>| pair.expect("no limit");
        let pair = within(nearest_of_hulls(&a, &b, f64::INFINITY));
        let swapped = within(nearest_of_hulls(&b, &a, f64::INFINITY));
        assert_eq!(pair.key, swapped.key, "{number}: {family}: {a:?} {b:?}");
        let by = 1 % a.len();
        a.rotate_left(by);
        b.reverse();
        let permuted = within(nearest_of_hulls(&a, &b, f64::INFINITY));
        assert_eq!(pair.key, permuted.key, "{number}: {family}: {a:?} {b:?}");
        // A limit that equals the key keeps the pair.
        let limited = nearest_of_hulls(&a, &b, pair.key.square_above());
        assert_eq!(limited.map(|pair| pair.key), Ok(pair.key), "{number}: {family}: {a:?} {b:?}");
        let is_ordinary = |x: &f64| *x == 0.0 || (1e-30..1e30).contains(&x.abs());
        // A distance that rounds to zero becomes the smallest number, at any scale.
        let is_tiny = pair.key.distance() == f64::from_bits(1);
        if !is_tiny && a.iter().chain(&b).flatten().all(is_ordinary) {
            let [a, b] = [&a, &b].map(|hull| hull.iter().map(|v| v.map(|x| scale_by_power(x, 70))).collect::<Vec<_>>());
            let scaled = within(nearest_of_hulls(&a, &b, f64::INFINITY));
            assert_eq!(scale_by_power(pair.key.distance(), 70), scaled.key.distance(), "{number}: {family}");
        }
    }
}

#[test]
fn points_are_those_of_the_weights_and_as_far_apart_as_the_distance() {
    for number in cases(50_000, 5_000) {
        let mut rng = rng("points of pairs", number);
        let (family, [a, b]) = pair(&mut rng);
        let pair = nearest_of_hulls(&a, &b, f64::INFINITY).expect("no limit");
        let size = largest(&a).max(largest(&b));
        if !(1e-100..1e100).contains(&size) {
            continue;
        }
        let text = || format!("{number}: {family}: {pair:?} {a:?} {b:?}");
        let offset: V3 = std::array::from_fn(|k| pair.points[1][k] - pair.points[0][k]);
        let length = Key::from_offset(offset).distance();
        assert!((length - pair.key.distance()).abs() <= 40.0 * f64::EPSILON * size, "{length:e} {}", text());
        for (hull, k) in [(&a, 0), (&b, 1)] {
            let weights = pair.barycentric[k];
            assert!(weights.iter().all(|w| *w >= 0.0), "{}", text());
            assert!((weights.iter().sum::<f64>() - 1.0).abs() <= 8.0 * f64::EPSILON, "{}", text());
            let bounds = bounds_of(hull);
            assert_eq!(bounds.clamp(pair.points[k]), pair.points[k], "{}", text());
            let on_hull = project(pair.points[k].coords.into(), hull, f64::INFINITY).expect("no limit");
            assert!(on_hull.key.distance() <= 20.0 * f64::EPSILON * size, "{}", text());
            let used = match pair.features[k] {
                Feature::Vertex(i) => vec![usize::from(i)],
                Feature::Edge(i) => vec![usize::from(i), (usize::from(i) + 1) % hull.len()],
                Feature::Face => vec![0, 1, 2],
            };
            assert!((0..3).all(|i| weights[i] == 0.0 || used.contains(&i)), "{}", text());
        }
    }
}

#[test]
fn gaps_of_boxes_never_exceed_the_keys_inside() {
    for number in cases(200_000, 10_000) {
        let mut rng = rng("gaps of boxes", number);
        let (family, [a, b]) = pair(&mut rng);
        let pair = nearest_of_hulls(&a, &b, f64::INFINITY).expect("no limit");
        let mut boxes = [bounds_of(&a), bounds_of(&b)];
        // A box may be larger than the hull.
        boxes[0] = boxes[0].union(&bounds_of(&[case(&mut rng).query]));
        for gap in [bounds_of(&a).gap_squared(&boxes[1]), boxes[0].gap_squared(&boxes[1])] {
            assert!(gap <= pair.key.square_above(), "{number}: {family}: {gap:e} {pair:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn moved_boxes_are_the_smallest_around_moved_vertices() {
    for number in cases(100_000, 3_000) {
        let mut rng = rng("moved boxes", number);
        let size = [1e-300, 1e-9, 1.0, 1e9, 1e290][rng.random_range(0..5)];
        let quarters = std::f64::consts::FRAC_PI_2 * f64::from(rng.random_range(0..4));
        let turn = [Vector3::x() * quarters, vector(&mut rng) * 3.0][rng.random_range(0..2)];
        // A large translation leaves few digits of the box, or none.
        let far = size * [0.0, 1.0, 1e8, 1e15, 1e17][rng.random_range(0..5)];
        let motion = Motion::new(&Isometry3::new(vector(&mut rng) * far, turn));
        let [p, q] = [(); 2].map(|()| (vector(&mut rng) * size).into());
        let bounds = bounds_of(&[p, q]);
        let corner = |i: usize| -> V3 { std::array::from_fn(|k| [bounds.min, bounds.max][i >> k & 1][k]) };
        let corners = std::array::from_fn::<_, 8, _>(corner);
        let inside: V3 = std::array::from_fn(|k| rng.random_range(bounds.min[k]..=bounds.max[k]));
        let images = [
            (motion.apply_to_box(&bounds), corners.map(|v| motion.apply(v)), motion.apply(inside)),
            (
                motion.apply_inverse_to_box(&bounds),
                corners.map(|v| motion.apply_inverse(v)),
                motion.apply_inverse(inside),
            ),
        ];
        for (moved, corners, inside) in images {
            assert_eq!(moved, bounds_of(&corners), "{number}: {motion:?} {bounds:?}");
            assert_eq!(moved.clamp(inside.into()), inside.into(), "{number}: {motion:?} {bounds:?}");
        }
    }
}

/// Regression tests.
#[test]
fn cases_that_were_wrong_are_right() {
    let huge = |[y, z]: [f64; 2]| [power_of_two(1000), y, z];
    let subnormal = |v: [i32; 3]| v.map(|x| f64::from(x) * f64::from_bits(1));
    let cases: [[Vec<V3>; 2]; 3] = [
        // The offset cancels, but the point is beside the segment.
        [vec![[0.0; 3], [1.0, 3.0, 0.0]], vec![[0.265_210_608_424_337, 0.795_631_825_273_011, 0.0]]],
        // All vertices share a huge coordinate.
        [
            vec![
                huge([-8.451405573738713e-306, -1.5007027894088542e-306]),
                huge([-3.50270159638403e-306, -6.937155642425861e-306]),
            ],
            vec![
                huge([-6.620386193792874e-306, -3.512191224747391e-306]),
                huge([-9.808440491243053e-306, -6.081272014386094e-306]),
            ],
        ],
        // The point inside of an edge is rounded to a subnormal.
        [
            vec![subnormal([25, 20, 0]), subnormal([-34, -22, -10])],
            vec![subnormal([-38, 39, -50]), subnormal([16, -32, 26])],
        ],
    ];
    for [a, b] in cases {
        let exact = Distance::between(&a, &b);
        let pair = nearest_of_hulls(&a, &b, f64::INFINITY).expect("no limit");
        let error = exact.error(pair.key.distance(), 53, FOUR_ETA);
        assert!(error <= ERROR_CONSTANT_OF_PAIRS && !exact.is_zero(), "{error}: {a:?} {b:?}");
        assert!(!pair.is_intersecting && pair.key > Key::ZERO, "{pair:?}");
    }
}

#[test]
fn primitives_of_both_scalars_have_pairs() {
    let point = |x: f32, y: f32, z: f32| Point3::new(x, y, z);
    let a = crate::Triangle::new(point(0.0, 0.0, 0.0), point(4.0, 0.0, 0.0), point(0.0, 4.0, 0.0));
    let b = crate::Point::new(point(1.0, 1.0, 3.0));
    let pair = nearest_pair(&a, &b);
    assert_eq!((pair.key.distance(), pair.features), (3.0, [Feature::Face, Feature::Vertex(0)]));
    assert_eq!(nearest_pair(&b, &a), pair.swapped());
    assert_eq!(nearest_pair_within(&a, &b, 8.9), None);
}
