//! Compares the contacts of moving balls with exact distances.
#![cfg(all(feature = "bvh", feature = "kdop"))]

use nalgebra::Point3;
use p2m::pair::{MovingBall, PairQuery};
use p2m::{AabbTree, BruteForce, KdopTree, PrimitiveId, PrimitiveSet, Real, Shape, Soup};
use p2m_testkit::oracle::Distance;
use p2m_testkit::scenes::{self, extreme_soups, kinds_and_layout, narrow};
use p2m_testkit::{cases, rng};
use rand::{Rng, RngExt};
use std::cmp::Ordering;

type V3 = [f64; 3];

fn to_f64_array<T: Real>(point: &Point3<T>) -> V3 {
    point.map(T::to_f64).coords.into()
}

/// Returns the centre of the ball at a parameter, in the arithmetic of the ball.
fn centre_at(start: V3, end: V3, t: f64) -> V3 {
    std::array::from_fn(|k| start[k] * (1.0 - t) + end[k] * t)
}

/// Returns the vertices of all primitives in f64.
fn hulls<T: Real>(soup: &Soup<T>) -> Vec<Vec<V3>> {
    let vertices = |shape: Shape<T>| shape.vertices().iter().map(to_f64_array).collect();
    (0..soup.len()).map(|i| vertices(soup.get(PrimitiveId::new(i)))).collect()
}

fn largest(hull: &[V3]) -> f64 {
    hull.as_flattened().iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Checks the contacts by brute force and by the trees, and returns whether there is one.
fn check_all<T: Real>(case: u64, soup: &Soup<T>, ball: &MovingBall<T>) -> bool {
    let aabb = AabbTree::new(soup).expect("valid");
    let kdop: KdopTree<T, _> = KdopTree::new(soup).expect("valid");
    check(case, soup, ball, &aabb);
    check(case, soup, ball, &kdop);
    check(case, soup, ball, &BruteForce::new(soup).expect("valid"))
}

/// Compares a contact with exact distances, and returns whether there is one.
fn check<T: Real>(case: u64, soup: &Soup<T>, ball: &MovingBall<T>, index: &impl PairQuery<T>) -> bool {
    let found = ball.first_contact(index);
    let text = || format!("{case}: {ball:?} {found:?}");
    let (start, end) = (to_f64_array(&ball.start), to_f64_array(&ball.end));
    let length = |x: T| Distance::new([0.0; 3], &[[x.to_f64(), 0.0, 0.0]]);
    let is_farther = |path: &[V3], distance: T| {
        hulls(soup).iter().all(|hull| Distance::between(path, hull).compare(&length(distance)) == Ordering::Greater)
    };
    let Some(found) = found else {
        assert!(is_farther(&[start, end], ball.radius), "{}", text());
        return false;
    };
    assert!(T::zero() <= found.parameter && found.parameter <= found.upper_parameter, "{}", text());
    assert!(found.upper_parameter <= T::one(), "{}", text());
    if found.parameter > T::zero() {
        let until = centre_at(start, end, found.parameter.to_f64());
        assert!(is_farther(&[start, until], ball.radius), "{}", text());
    }
    let centre = centre_at(start, end, found.upper_parameter.to_f64());
    assert!(!is_farther(&[centre], found.distance_bound), "{}", text());
    // The bound is the radius plus the tolerance, up to rounding, unless the ball starts in contact.
    let size = hulls(soup).iter().map(|hull| largest(hull)).fold(largest(&[start, end]), f64::max);
    let step = T::UNIT_ROUNDOFF * (size + ball.radius.to_f64()) + T::SMALLEST_SUBNORMAL;
    let excess = found.distance_bound.to_f64() - ball.radius.to_f64() - ball.tolerance.to_f64();
    assert!(found.upper_parameter == T::zero() || excess <= 4000.0 * step, "{}: {excess} {step}", text());
    true
}

fn random_ball(rng: &mut impl Rng, soup: &Soup<f64>) -> MovingBall<f64> {
    let [start, end] = [0, 1].map(|_| scenes::query(rng, soup.positions()));
    let bounds = soup.aabb();
    let size = (bounds.max - bounds.min).amax();
    let radius = size * [0.0, 0.01, 0.1, 0.5][rng.random_range(0..4)];
    MovingBall::new(start, end, radius).with_tolerance(size * [0.0, 0.0, 1e-3][rng.random_range(0..3)])
}

#[test]
fn nothing_is_touched_before_the_contact() {
    let (mut with_contact, mut without) = (0, 0);
    let all = cases(20_000, 1_000);
    for case in all.clone() {
        let (mut rng, (kinds, layout)) = (rng("moving balls", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, 40);
        let ball = random_ball(&mut rng, &soup);
        let touches = check_all(case, &soup, &ball);
        *(if touches { &mut with_contact } else { &mut without }) += 1;
        if let Some(soup) = narrow(&soup) {
            let single = MovingBall::new(
                ball.start.map(f32::round_from_f64),
                ball.end.map(f32::round_from_f64),
                f32::round_from_f64(ball.radius),
            );
            check_all(case, &soup, &single);
        }
    }
    assert!(all.have_more_than(50, with_contact) && all.have_more_than(50, without), "{with_contact} {without}");
}

#[test]
fn scales_do_not_matter() {
    for (case, soup, queries) in extreme_soups("scales of moving balls") {
        let bounds = soup.aabb();
        let radius = (bounds.max.coords * 0.1 - bounds.min.coords * 0.1).amax();
        for ends in queries.chunks_exact(2).take(2).filter(|_| radius.is_finite()) {
            check_all(case, &soup, &MovingBall::new(ends[0], ends[1], radius));
        }
    }
}
