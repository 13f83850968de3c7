//! Tests of rays on a small lattice: all triangles of 27 points, and closed surfaces.

use super::backends::{Checked, backends, check, soup_of};
use nalgebra::{Point3, Vector3};
use p2m::{Element, Ray, Soup};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;

/// Checks all triangles of a lattice of 27 points (some of them in shallow tests), with their vertices in any order,
/// and all segments and points of the lattice. Most of the triangles are degenerate or in a plane of the lattice.
#[test]
fn the_whole_lattice_of_three_is_met_as_exact_arithmetic_says() {
    let at = |i: usize| -> [f64; 3] { [i / 9, i / 3 % 3, i % 3].map(|x| x as f64) };
    let mut order = rng("rays on the lattice", 0);
    let mut primitives: Vec<Vec<[f64; 3]>> = Vec::new();
    for a in 0..27 {
        primitives.push(vec![at(a)]);
        for b in a..27 {
            primitives.push(vec![at(a), at(b)]);
            for c in b..27 {
                let mut triangle = vec![at(a), at(b), at(c)];
                triangle.rotate_left(order.random_range(0..3));
                if order.random() {
                    triangle.swap(0, 1);
                }
                primitives.push(triangle);
            }
        }
    }
    assert_eq!(primitives.len(), 27 + 378 + 3654);
    let mut checked = Checked::default();
    let cases = cases(24, 10);
    for case in cases.clone() {
        let mut rng = rng("rays on the lattice", case + 1);
        // In shallow tests, each line is tested against another subset.
        let (skipped, step) = (case as usize % amount(1, 43), amount(1, 43));
        let soup = soup_of(&primitives.iter().skip(skipped).step_by(step).cloned().collect::<Vec<_>>());
        let origin = Point3::from(at(rng.random_range(0..27))) + Vector3::repeat(if case % 7 == 0 { 0.5 } else { 0.0 });
        let direction = loop {
            let reach = if case % 2 == 0 { 1 } else { 3 };
            let d = Vector3::from_fn(|_, _| f64::from(rng.random_range(-reach..=reach)));
            if d != Vector3::zeros() {
                break d;
            }
        };
        let off = |x: f64| if case % 5 == 0 { x.next_up() } else { x };
        let line = Ray::new(&origin.map(off), &direction).expect("valid").line();
        let line = line.with_radius(if case % 3 == 0 { 1.0 } else { 0.0 }).expect("valid");
        check(&soup, &[line], &mut rng, &mut checked, &|| format!("lattice, line {case}"));
    }
    println!("{checked:?}");
    let has_many = |count| cases.have_more_than(amount(4000, 67), count);
    assert!(has_many(checked.along) && has_many(checked.crossings), "{checked:?}");
}

/// Every line of the lattice crosses the surface of a cube as often from outside as from inside, and a ray that begins
/// inside leaves once more than it enters. The cubes have two triangles per side, or sides cut into four.
#[test]
fn closed_surfaces_are_crossed_an_even_number_of_times() {
    let corners: Vec<Point3<f64>> =
        (0..8).map(|i| Point3::from([i & 1, i >> 1 & 1, i >> 2].map(|x: u32| 2.0 * f64::from(x)))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]].map(Element::Triangle));
    let halves = Soup::new(corners.clone(), halves).expect("valid");
    let mut centred = corners.clone();
    let mut quarters = Vec::new();
    for quad in quads {
        let centre = u32::try_from(centred.len()).expect("few");
        centred.push(Point3::from(quad.iter().map(|i| corners[*i as usize].coords).sum::<Vector3<f64>>() / 4.0));
        quarters.extend((0..4).map(|k| Element::Triangle([quad[k], quad[(k + 1) % 4], centre])));
    }
    let quarters = Soup::new(centred, quarters).expect("valid");
    let mut crossed = [0; 3];
    let (cases, every) = (cases(343, 50), amount(1, 3));
    for soup in [&halves, &quarters] {
        let backends = backends(soup);
        for case in cases.clone() {
            // A step without a common divisor reaches all lines, and few steps reach all directions.
            let i = case as usize * 100 % 343;
            let origin = Point3::from([i / 49, i / 7 % 7, i % 7].map(|x| x as f64 - 2.0)) * 0.5 + Vector3::repeat(0.5);
            let inside = origin.iter().all(|x| 0.0 < *x && *x < 2.0);
            let outside = origin.iter().any(|x| !(0.0..=2.0).contains(x));
            for j in (0..125).skip(i % every).step_by(every) {
                let direction = Vector3::from([j / 25, j / 5 % 5, j % 5].map(|x| x as f64 - 2.0));
                let Ok(ray) = Ray::new(&origin, &direction) else { continue };
                let (name, index) = &backends[(i + j) % backends.len()];
                let all = index.crossings(&ray.line());
                assert_eq!(all % 2, 0, "{name} {ray:?}");
                assert!(all <= 2, "a cube is convex: {name} {ray:?}");
                crossed[all] += 1;
                let ahead = index.crossings(&ray);
                assert!(!inside || ahead == 1, "{name} {ray:?}");
                assert!(!outside || ahead % 2 == 0, "{name} {ray:?}");
            }
        }
    }
    println!("{crossed:?}");
    let has_many = |count| cases.have_more_than(amount(1000, 333), count);
    assert!(has_many(crossed[0]) && has_many(crossed[2]), "{crossed:?}");
}
