//! Tests of ranges of rays that end at hits, at zero and at infinity.

use super::backends::{backends, rays, scaled, soup_of};
use nalgebra::{Point3, Vector3};
use p2m::core::Side;
use p2m::{AabbTree, Ray, RayQuery};
use p2m_testkit::ray_check::bits;
use p2m_testkit::scenes::{self, Kinds, LAYOUTS};
use p2m_testkit::{cases, rng};
use rand::RngExt;

/// Each hit of a single point lies in exactly one of the adjacent ranges [t0, t1], [t1.next_up(), t2] and so on.
#[test]
fn ranges_in_a_row_share_the_hits_out() {
    let mut shared = 0;
    let cases = cases(30, 12);
    for seed in cases.clone() {
        let mut rng = rng("ranges in a row", seed);
        let soup = scenes::soup(&mut rng, Kinds::Triangles, LAYOUTS[seed as usize % 6], 60);
        let tree = AabbTree::new(&soup).expect("valid");
        for ray in rays(&mut rng, &soup) {
            let all = tree.all_intersections(&ray.line());
            if all.iter().any(|hit| hit.side == Side::Along) {
                continue;
            }
            let mut cuts: Vec<f64> = all.iter().map(|hit| hit.parameter).filter(|_| rng.random()).collect();
            cuts.extend(all.iter().map(|hit| hit.parameter.next_down()).filter(|_| rng.random()));
            cuts.push(f64::INFINITY);
            let (mut min, mut hits, mut crossings) = (f64::NEG_INFINITY, Vec::new(), 0);
            cuts.dedup();
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
            for max in cuts {
                let part = ray.with_range(min, max).expect("in order");
                hits.extend(tree.all_intersections(&part));
                crossings += tree.crossings(&part);
                min = max.next_up();
            }
            assert_eq!(hits, all, "seed {seed} {ray:?}");
            assert_eq!(crossings, tree.crossings(&ray.line()), "seed {seed} {ray:?}");
            shared += all.len();
        }
    }
    assert!(cases.have_more_than(500, shared), "{shared}");
}

/// Both zeros are equal: a hit at -0 is in a range that begins at 0, and the lowest id wins.
#[test]
fn ranges_may_begin_at_minus_zero() {
    let flat = |y: f64| vec![[-1.0, 0.0, y], [1.0, 0.0, y], [0.0, 1.0, y]];
    let upright = |z: f64| vec![[0.0, 0.0, z], [0.0, 4.0, z - 1.0], [0.0, 4.0, z + 1.0]];
    // One hit begins at zero, and the other one before it.
    let soup = soup_of(&[upright(0.0), flat(0.0), upright(0.0), flat(0.0)]);
    for (name, index) in backends(&soup) {
        for min in [-0.0, 0.0] {
            let ray = Ray::new(&Point3::new(0.0, 0.5, 0.0), &Vector3::x()).expect("valid");
            let ray = ray.with_range(min, 5.0).expect("in order");
            let hits = index.all_intersections(&ray);
            let ids: Vec<_> = hits.iter().map(|hit| (hit.primitive.index(), hit.parameter.to_bits())).collect();
            assert_eq!(ids, [(0, 0), (1, 0), (2, 0), (3, 0)], "{name} {min:?}");
            assert_eq!(index.first_intersection(&ray).as_ref().map(bits), hits.first().map(bits), "{name} {min:?}");
        }
    }
}

/// Products of coordinates underflow, and a long direction magnifies the error.
#[test]
fn a_tiny_triangle_is_hit_into_a_long_direction() {
    let triangle = [[0.0, 0.0, 1.0], [1.0, 2.0, 0.0], [-1.0, -3.0, -1.0]];
    let tiny = triangle.iter().map(|v| v.map(|x| scaled(x, -538))).collect();
    let long = Vector3::new(-1.0, 0.0, 1.0) * 2f64.powi(250);
    let ray = Ray::new(&Point3::origin(), &long).expect("valid").line();
    for (name, index) in backends(&soup_of(&[tiny])) {
        let hit = index.first_intersection(&ray).map(|hit| (hit.parameter, hit.side));
        assert_eq!(hit, Some((scaled(-1.0 / 6.0, -788), Side::Back)), "{name}");
    }
}

/// The end of a common segment may be beyond the range of f64. A range at infinity then contains only this end.
#[test]
fn a_stretch_may_end_at_infinity() {
    let [near, far] = [[1.0, 0.0, 0.0], [2f64.powi(900), 0.0, 0.0]];
    let ray = Ray::new(&Point3::origin(), &Vector3::new(2f64.powi(-900), 0.0, 0.0)).expect("valid");
    let beyond = ray.with_range(f64::INFINITY, f64::INFINITY).expect("in order");
    for (name, index) in backends(&soup_of(&[vec![near, far], vec![near, far, [2.0, 1.0, 0.0]]])) {
        let found =
            |ray| index.all_intersections(&ray).iter().map(|hit| (hit.parameter, hit.point())).collect::<Vec<_>>();
        assert_eq!(found(ray), [(2f64.powi(900), Point3::from(near)); 2], "{name}");
        assert_eq!(found(beyond), [(f64::INFINITY, Point3::from(far)); 2], "{name}");
        assert_eq!(found(ray.with_range(f64::MAX, f64::MAX).expect("in order")).len(), 2, "{name}");
    }
}
