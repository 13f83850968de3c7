//! Tests of every stage of the predicates against big integers.

use super::adaptive::{self, PredicateStage, RANGE};
use super::*;
use p2m_testkit::{Cases, cases, rng, vector};
use rand::{Rng, RngExt};

type Point = [f64; 3];

fn orientation_by_integers([a, b, c, d]: [Point; 4]) -> Ordering {
    let exponent = common_exponent([a, b, c, d].as_flattened());
    let [b, c, d] = [b, c, d].map(|p| difference(p, a, exponent));
    exact::sign(&exact::dot(&exact::cross(&b, &c), &d))
}

/// Asserts that all stages that are certain of a sign agree with the integers. Returns which of the filter, fixed
/// point, double-double and the adaptive predicate were certain.
fn check_sphere(points: [Point; 4], e: Point) -> [bool; 4] {
    let expected = insphere_by_integers(points, e);
    let [a, b, c, d] = points;
    assert_eq!(insphere(a, b, c, d, e), expected, "{points:?} {e:?}");
    let filter = adaptive::sphere_filter(points, e).sign();
    assert!(filter.is_none_or(|sign| sign == expected), "{points:?} {e:?}");
    let double = adaptive::sphere_double(points, e);
    assert!(double.is_none_or(|sign| sign == expected), "{points:?} {e:?}");
    let (sign, stage) = adaptive::sphere_exact(points, e);
    assert_eq!(sign, expected, "{stage:?} {points:?} {e:?}");
    assert_eq!(adaptive::sphere_adaptive(points, e), expected, "{points:?} {e:?}");
    [filter.is_some(), stage == PredicateStage::Whole, double.is_some(), true]
}

fn check_orientation(points: [Point; 4]) -> [bool; 2] {
    let expected = orientation_by_integers(points);
    let [a, b, c, d] = points;
    assert_eq!(orientation_3d(a, b, c, d), expected, "{points:?}");
    // The determinant of a, b and c relative to d has the opposite sign.
    let filter = adaptive::orientation_filter([a, b, c].map(|p| std::array::from_fn(|k| p[k] - d[k]))).sign();
    assert!(filter.is_none_or(|sign| sign == expected.reverse()), "{points:?}");
    let (sign, stage) = adaptive::orientation_exact([a, b, c], d);
    assert_eq!(sign, expected.reverse(), "{stage:?} {points:?}");
    [filter.is_some(), stage == PredicateStage::Whole]
}

/// Checks both predicates on many points, and returns how often each stage was certain.
fn check_all(name: &str, cases: Cases, mut points: impl FnMut(&mut dyn Rng) -> [Point; 5]) -> [usize; 4] {
    let mut certain = [0; 4];
    for case in cases {
        let [a, b, c, d, e] = points(&mut rng(name, case));
        for (count, is_certain) in certain.iter_mut().zip(check_sphere([a, b, c, d], e)) {
            *count += usize::from(is_certain);
        }
        check_orientation([a, b, c, d]);
        check_orientation([b, c, d, e]);
    }
    certain
}

fn random(mut rng: &mut dyn Rng) -> Point {
    vector(&mut rng).into()
}

fn rounded(p: Point, length: f64) -> Point {
    let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / norm * length)
}

#[test]
fn inside_is_greater_for_positive_tetrahedra() {
    for scale in [1.0, 2f64.powi(-150), 2f64.powi(150), 2f64.powi(-1000), 2f64.powi(1000)] {
        let at = |p: Point| p.map(|x| x * scale);
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]].map(at);
        assert_eq!(orientation_3d(a, b, c, d), Ordering::Greater);
        for (e, expected) in
            [([1.0; 3], Ordering::Greater), ([2.0; 3], Ordering::Equal), ([2.0, 2.0, 2.5], Ordering::Less)]
        {
            assert_eq!(insphere(a, b, c, d, at(e)), expected);
            assert_eq!(insphere(b, a, c, d, at(e)), expected.reverse());
        }
    }
}

#[test]
fn random_points_are_decided_by_the_filter() {
    let cases = cases(20_000, 2_000);
    let [filter, _, double, _] = check_all("predicates random", cases.clone(), |rng| [0; 5].map(|_| random(rng)));
    assert!(cases.have_more_than(19_900, filter) && double == cases.len(), "{filter} {double}");
}

#[test]
fn whole_numbers_are_decided_in_integers() {
    let cases = cases(5000, 500);
    for most in [1i64, 2, 4, 100, 1 << 22, 1 << 40, 1 << 61] {
        let [_, whole, ..] = check_all("predicates whole", cases.clone(), |rng| {
            [0; 5].map(|_| [0; 3].map(|_| rng.random_range(-most..=most) as f64 * 0.125))
        });
        assert_eq!(whole, cases.len());
    }
    // These are the largest possible determinants.
    let most = 2f64.powi(61).next_down();
    let corner = |i: u32| [0, 1, 2].map(|k| if i >> k & 1 == 1 { most } else { -most });
    for i in 0..8u32.pow(4) {
        let points = [0, 3, 6, 9].map(|shift| corner(i >> shift & 7));
        assert!(check_sphere(points, [0.0; 3])[1]);
        assert!(check_sphere(points.map(|p| p.map(|x| x * 0.5)), [most * 0.5; 3])[1]);
    }
}

#[test]
fn points_rounded_onto_a_sphere_are_decided_in_double_double() {
    let cases = cases(20_000, 2_000);
    let [filter, _, double, _] =
        check_all("predicates sphere", cases.clone(), |rng| [0; 5].map(|_| rounded(random(rng), 1.0)));
    assert!(cases.have_fewer_than(1000, filter) && cases.have_more_than(19_900, double), "{filter} {double}");
    // The points are on a small part of the sphere.
    let [.., double, _] = check_all("predicates cap", cases.clone(), |rng| {
        let centre = rounded(random(rng), 1.0);
        [0; 5].map(|_| {
            let offset = random(rng);
            rounded(std::array::from_fn(|k| centre[k] + 0.01 * offset[k]), 1.0)
        })
    });
    assert!(cases.have_more_than(15_000, double), "{double}");
}

#[test]
fn points_of_a_box_are_on_its_sphere() {
    let cases = cases(20_000, 2_000);
    let [_, whole, double, _] = check_all("predicates box", cases.clone(), |rng| {
        let [low, high] = [random(rng), random(rng)];
        [0; 5].map(|_| std::array::from_fn(|k| if rng.random_range(0..2) == 0 { low[k] } else { high[k] }))
    });
    assert!(cases.have_more_than(10_000, whole) && (cases.is_replay() || double < cases.len()), "{whole} {double}");
    // One coordinate is changed by one unit in the last place, or far.
    check_all("predicates near box", cases.clone(), |rng| {
        let [low, high] = [random(rng), random(rng)];
        let mut points: [Point; 5] =
            [0; 5].map(|_| std::array::from_fn(|k| if rng.random_range(0..2) == 0 { low[k] } else { high[k] }));
        let x = &mut points[rng.random_range(0..5)][rng.random_range(0..3)];
        *x = if rng.random_range(0..2) == 0 { x.next_up() } else { 0.5 };
        points
    });
}

/// Rounded grids, lines and planes give determinants of zero and of one bit.
#[test]
fn nearly_degenerate_points_are_decided_rightly() {
    let spacing = [0.01, 0.1, 1.0 / 3.0];
    let cases = cases(20_000, 1_500);
    check_all("predicates fine grid", cases.clone(), |rng| {
        let spacing = spacing[rng.random_range(0..3)];
        [0; 5].map(|_| [0; 3].map(|_| f64::from(rng.random_range(0..4)) * spacing))
    });
    check_all("predicates plane", cases.clone(), |rng| {
        [0; 5].map(|_| {
            let [x, y, _] = random(rng);
            [x, y, 0.3 * x + 0.7 * y]
        })
    });
    check_all("predicates line", cases.clone(), |rng| {
        [0; 5].map(|_| {
            let [x, ..] = random(rng);
            [x, 0.3 * x, 0.7 * x]
        })
    });
    // The coordinates are neighbouring floats.
    check_all("predicates last bits", cases.clone(), |rng| {
        let p = random(rng);
        [0; 5].map(|_| p.map(|x| f64::from_bits(x.to_bits() + rng.random_range(0..4u64))))
    });
}

/// The points are on the border of the range of the stages, or have any exponents.
#[test]
fn exponents_at_the_border_and_beyond_are_decided_rightly() {
    let least = *RANGE.start();
    let least_cases = cases(5000, 500);
    let [_, _, double, _] = check_all("predicates least", least_cases.clone(), |rng| {
        [0; 5].map(|_| rounded(random(rng), 1.0).map(|x| if x.abs() < 1e-3 { 0.0 } else { x * 1024.0 * least }))
    });
    assert!(least_cases.have_more_than(4900, double), "{double}");
    check_all("predicates mixed", cases(20_000, 2_000), |rng| {
        [0; 5]
            .map(|_| random(rng).map(|x| if x.abs() < 0.1 { 0.0 } else { x * 2f64.powi(rng.random_range(-150..190)) }))
    });
    for (low, high) in [(-1070, 1023), (-1070, -900), (900, 1023), (-200, 0)] {
        for case in cases(3000, 200) {
            let rng: &mut dyn Rng = &mut rng("predicates any", case);
            let [a, b, c, d, e] = [0; 5].map(|_| random(rng).map(|x| x * 2f64.powi(rng.random_range(low..high))));
            let expected = insphere_by_integers([a, b, c, d], e);
            assert_eq!(insphere(a, b, c, d, e), expected);
            assert_eq!(insphere(b, c, a, d, e), expected);
            assert_eq!(insphere(a, b, d, c, e), expected.reverse());
        }
    }
}
