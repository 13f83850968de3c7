//! The triangles of polygons, through the OBJ reader. Areas and overlaps are checked in exact arithmetic.

use crate::common::obj;
use chacha20::ChaCha8Rng;
use nalgebra::Point3;
use p2m_core::Element;
use p2m_testkit::scenes::square_spiral;
use p2m_testkit::{cases, rng};
use rand::RngExt;
use std::collections::HashSet;
use std::fmt::Write;

type P = [i64; 2];

fn cross(a: P, b: P, c: P) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn outline_area(polygon: &[P]) -> i64 {
    (0..polygon.len()).map(|i| cross([0, 0], polygon[i], polygon[(i + 1) % polygon.len()])).sum()
}

/// Returns the triangles of a polygon with these corners, as indices of corners.
fn cut3(corners: &[[f64; 3]]) -> Vec<[u32; 3]> {
    cut3_with_note(corners).0
}

/// Returns the triangles of a polygon, and whether there is a note that it crosses itself.
fn cut3_with_note(corners: &[[f64; 3]]) -> (Vec<[u32; 3]>, bool) {
    let mut text = String::new();
    for [x, y, z] in corners {
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
    }
    text.push('f');
    for i in 1..=corners.len() {
        write!(text, " {i}").unwrap();
    }
    let scene = obj(text).unwrap();
    assert_eq!(scene.soup.positions().len(), corners.len());
    assert!(scene.sources.iter().all(|&s| s == 0));
    let triangle = |e| match e {
        Element::Triangle(t) => t,
        other => panic!("{other:?}"),
    };
    let note = scene.skipped.first().map(|skipped| (skipped.what.as_str(), skipped.count));
    assert!(note.is_none_or(|note| note == ("insides of polygons that cross themselves", 1)), "{note:?}");
    (scene.soup.elements().map(triangle).collect(), note.is_some())
}

/// Maps corners to a plane that is perpendicular to `axis`, or tilted.
#[allow(clippy::cast_precision_loss, reason = "small integers")]
fn lift(polygon: &[P], axis: usize, tilt: i64) -> Vec<[f64; 3]> {
    polygon
        .iter()
        .map(|&[u, v]| {
            let mut p = [0.0; 3];
            p[(axis + 1) % 3] = u as f64;
            p[(axis + 2) % 3] = v as f64;
            p[axis] = (tilt * u) as f64 / 8.0 + (tilt * v) as f64 / 16.0 + 5.0;
            p
        })
        .collect()
}

/// Returns whether the insides of two counter-clockwise triangles share a point, that is, no edge separates them.
fn overlap(s: [P; 3], t: [P; 3]) -> bool {
    let separates = |s: [P; 3], t: [P; 3]| (0..3).any(|i| t.iter().all(|&p| cross(s[i], s[(i + 1) % 3], p) <= 0));
    !separates(s, t) && !separates(t, s)
}

/// Checks that `triangles` cover a simple polygon exactly, with its winding and all of its edges.
fn check(polygon: &[P], triangles: &[[u32; 3]]) {
    let n = polygon.len();
    let area = outline_area(polygon);
    let corners = |t: &[u32; 3]| t.map(|i| polygon[i as usize]);
    let areas: Vec<i64> = triangles.iter().map(&corners).map(|[a, b, c]| cross(a, b, c)).collect();
    assert!(areas.iter().all(|&a| a == 0 || (a > 0) == (area > 0)), "winding: {polygon:?} {triangles:?}");
    assert_eq!(areas.iter().sum::<i64>(), area, "area: {polygon:?} {triangles:?}");
    // The areas add up, so a triangle outside of the polygon would have to overlap another one.
    let oriented: Vec<[P; 3]> = triangles
        .iter()
        .zip(&areas)
        .filter(|(_, a)| **a != 0)
        .map(|(t, a)| {
            let [a_, b, c] = corners(t);
            if *a > 0 { [a_, b, c] } else { [a_, c, b] }
        })
        .collect();
    for (i, s) in oriented.iter().enumerate() {
        for t in &oriented[..i] {
            assert!(!overlap(*s, *t), "overlap: {polygon:?} {triangles:?}");
        }
    }
    check_edges(n, triangles);
    assert_eq!(triangles.len(), n - 2, "{polygon:?} {triangles:?}");
}

/// Checks that every edge of the polygon is an edge of a triangle.
fn check_edges(n: usize, triangles: &[[u32; 3]]) {
    let edges: HashSet<[u32; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).flat_map(|[a, b]| [[a, b], [b, a]]).collect();
    let n = u32::try_from(n).unwrap();
    for i in 0..n {
        assert!(edges.contains(&[i, (i + 1) % n]), "edge {i} of {n} is lost: {triangles:?}");
    }
}

/// Checks a polygon with every first corner, both windings, all axes and some tilts.
fn check_all_ways(polygon: &[P]) {
    let n = polygon.len();
    for start in 0..n {
        for reverse in [false, true] {
            let mut turned: Vec<P> = (0..n).map(|i| polygon[(start + i) % n]).collect();
            if reverse {
                turned.reverse();
            }
            for axis in 0..3 {
                for tilt in [0, 3, -5] {
                    check(&turned, &cut3(&lift(&turned, axis, tilt)));
                }
            }
        }
    }
}

#[test]
fn convex_polygons() {
    check_all_ways(&[[0, 0], [4, 0], [4, 4], [0, 4]]);
    check_all_ways(&[[0, 0], [2, -1], [5, 0], [6, 3], [3, 6], [0, 5]]);
}

#[test]
fn concave_quadrilaterals_are_cut_along_the_inner_diagonal() {
    check_all_ways(&[[0, 0], [4, 0], [1, 1], [0, 4]]);
    check_all_ways(&[[0, 0], [10, 1], [9, 0], [10, -1]]);
    // A corner is on an edge, so one of the triangles has no area.
    check_all_ways(&[[0, 0], [4, 0], [2, 2], [0, 4]]);
}

#[test]
fn concave_polygons() {
    let l = [[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]];
    check_all_ways(&l);
    let arrow = [[0, 0], [4, 2], [8, 0], [4, 8], [3, 3]];
    check_all_ways(&arrow);
    let mut comb = vec![[0i64, -1]];
    comb.extend((0..9).map(|i| [2 * i, if i % 2 == 0 { 10 } else { 0 }]));
    comb.push([16, -1]);
    check_all_ways(&comb);
    // Square teeth have many collinear corners on several lines.
    let mut teeth = vec![[0, -2], [40, -2]];
    for i in (0..10).rev() {
        teeth.extend([[4 * i + 4, 0], [4 * i + 4, 7], [4 * i + 2, 7], [4 * i + 2, 0]]);
    }
    check_all_ways(&teeth);
    for arms in 2..12 {
        check_all_ways(&square_spiral(arms));
    }
}

/// Returns whether two closed segments share a point.
fn touch([a, b]: [P; 2], [c, d]: [P; 2]) -> bool {
    let inside =
        |p: P, a: P, b: P| cross(a, b, p) == 0 && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]));
    let sides = |a: P, b: P, c: P, d: P| cross(a, b, c).signum() * cross(a, b, d).signum() < 0;
    inside(a, c, d) || inside(b, c, d) || inside(c, a, b) || inside(d, a, b) || (sides(a, b, c, d) && sides(c, d, a, b))
}

/// Returns two edges that intersect each other elsewhere than at a common corner.
fn conflict(polygon: &[P]) -> Option<(usize, usize)> {
    let n = polygon.len();
    let edge = |i: usize| [polygon[i % n], polygon[(i + 1) % n]];
    for i in 0..n {
        for j in i + 1..n {
            let bad = if j == i + 1 || (i == 0 && j == n - 1) {
                let ([a, b], [c, d]) = if j == i + 1 { (edge(i), edge(j)) } else { (edge(j), edge(i)) };
                let ahead = (b[0] - a[0]) * (d[0] - c[0]) + (b[1] - a[1]) * (d[1] - c[1]);
                cross(a, b, d) == 0 && ahead < 0
            } else {
                touch(edge(i), edge(j))
            };
            if bad {
                return Some((i, j));
            }
        }
    }
    None
}

/// Returns a random simple polygon of points on a lattice, whose order is changed until no edges intersect.
fn random_simple(rng: &mut ChaCha8Rng) -> Option<Vec<P>> {
    let size = rng.random_range(2..12);
    let mut polygon: Vec<P> = Vec::new();
    for _ in 0..rng.random_range(4..40) {
        let p = [rng.random_range(0..=size), rng.random_range(0..=size)];
        if !polygon.contains(&p) {
            polygon.push(p);
        }
    }
    for _ in 0..200 {
        match conflict(&polygon) {
            None => return (polygon.len() >= 3).then_some(polygon),
            Some((i, j)) => polygon[i + 1..=j].reverse(),
        }
    }
    None
}

/// Returns the first random polygon that is simple.
fn simple(rng: &mut ChaCha8Rng) -> Vec<P> {
    std::iter::repeat_with(|| random_simple(rng)).flatten().next().expect("some are")
}

#[test]
fn random_simple_polygons() {
    let mut concave = 0;
    let cases = cases(20_000, 1_500);
    for case in cases.clone() {
        let polygon = simple(&mut rng("simple polygons", case));
        let n = polygon.len();
        let turns = (0..n).map(|i| cross(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]).signum());
        concave += usize::from(turns.collect::<HashSet<_>>().is_superset(&HashSet::from([-1, 1])));
        check(&polygon, &cut3(&lift(&polygon, case as usize % 3, [0, 1, -7][case as usize / 3 % 3])));
    }
    assert!(cases.have_more_than(10_000, concave), "{concave} of {}", cases.len());
}

#[test]
fn long_polygons() {
    // Above 80 corners the ear cutter uses another search.
    for polygon in [square_spiral(60), square_spiral(61)] {
        assert_eq!(conflict(&polygon), None);
        check(&polygon, &cut3(&lift(&polygon, 1, 2)));
    }
    for case in cases(20, 6) {
        let (round, mut rng) = (case as usize, rng("long polygons", case));
        // The polygon is a star, whose corners are in the order of their angles around the origin.
        let mut star: Vec<P> = (0..300).map(|_| [rng.random_range(-500..500), rng.random_range(-500..500)]).collect();
        #[allow(clippy::cast_precision_loss, reason = "small integers")]
        let angle = |p: &P| (p[1] as f64).atan2(p[0] as f64);
        star.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        star.dedup_by(|a, b| cross([0, 0], *a, *b) == 0);
        assert_eq!(conflict(&star), None);
        check(&star, &cut3(&lift(&star, round % 3, 1)));
    }
}

#[test]
fn scaling_by_powers_of_two_changes_nothing() {
    for case in cases(200, 60) {
        let polygon = simple(&mut rng("scaled polygons", case));
        let corners = lift(&polygon, case as usize % 3, 8);
        let expected = cut3(&corners);
        for exponent in [-1073, -1000, -540, -300, 300, 540, 1000, 1016] {
            let half = exponent / 2;
            let factors = [2f64.powi(half), 2f64.powi(exponent - half)];
            let scaled: Vec<[f64; 3]> = corners.iter().map(|c| c.map(|x| x * factors[0] * factors[1])).collect();
            assert_eq!(cut3(&scaled), expected, "2^{exponent}: {polygon:?}");
        }
    }
    // The corners are at opposite ends of the range, and their difference overflows. The second corner is reflex.
    let big = f64::MAX;
    let corners = [[big, -big, 0.0], [-big / 2.0, -big / 2.0, 0.0], [-big, big, 0.0], [-big, -big, 0.0]];
    assert_eq!(cut3(&corners), [[1, 2, 3], [1, 3, 0]]);
    // The polygon is tiny, in a plane far from the origin.
    let tiny = 2f64.powi(-700);
    let corners = [[1.0, 4.0 * tiny, 0.0], [1.0, tiny, tiny], [1.0, 0.0, 4.0 * tiny], [1.0, 0.0, 0.0]];
    assert_eq!(cut3(&corners), [[1, 2, 3], [1, 3, 0]]);
}

#[test]
fn far_from_the_origin_the_shape_is_the_same() {
    let l = [[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]];
    let near = lift(&l, 2, 0);
    let far: Vec<[f64; 3]> = near.iter().map(|&[x, y, z]| [x + 1e15, y - 3e15, z + 2e15]).collect();
    assert_eq!(cut3(&far), cut3(&near));
}

#[test]
fn polygons_without_area_keep_their_outline() {
    for polygon in [
        vec![[0, 0], [1, 0], [2, 0], [3, 0]],
        vec![[0, 0], [3, 0], [1, 0], [2, 0], [5, 0]],
        vec![[2, 2]; 6],
        vec![[0, 0], [4, 4], [0, 0], [4, 4], [2, 2]],
        vec![[0, 0], [4, 0], [4, 3], [4, 0]],
    ] {
        for axis in 0..3 {
            let triangles = cut3(&lift(&polygon, axis, 0));
            assert_eq!(triangles.len(), polygon.len() - 2);
            check_edges(polygon.len(), &triangles);
        }
    }
}

#[test]
fn spikes_and_repeated_corners_keep_outline_and_area() {
    let l = [[0, 0], [8, 0], [8, 2], [2, 2], [2, 6], [0, 6]];
    for at in 0..l.len() {
        for extra in [
            vec![l[at]], // the same corner again
            vec![l[at], l[at]],
            vec![[20, 30], l[at]],                                         // a spike
            vec![[20, 30], [40, 60], [20, 30], l[at]],                     // with corners on it
            vec![[20, 30], [20, 31], [20, 30], [21, 31], [20, 30], l[at]], // with spikes on it
        ] {
            let forked = extra.len() == 6;
            let mut polygon = l.to_vec();
            polygon.splice(at + 1..at + 1, extra);
            for axis in 0..3 {
                let triangles = cut3(&lift(&polygon, axis, 0));
                check_edges(polygon.len(), &triangles);
                let corners = triangles.iter().map(|t| t.map(|i| polygon[i as usize]));
                let area: i64 = corners.map(|[a, b, c]| cross(a, b, c).abs()).sum();
                // The ear cutter fails on a spike with spikes. The fan then covers the polygon and more.
                assert!(area == outline_area(&l) || forked, "{polygon:?} {triangles:?}");
            }
        }
    }
}

#[test]
fn polygons_that_cross_themselves_keep_their_outline() {
    check_edges(4, &cut3(&lift(&[[0, 0], [2, 2], [2, 0], [0, 2]], 0, 0)));
    check_edges(5, &cut3(&lift(&[[0, 3], [2, -3], [-3, 1], [3, 1], [-2, -3]], 0, 0)));
    let mut fans = 0;
    let cases = cases(20_000, 2_000);
    for case in cases.clone() {
        let (round, mut rng) = (case as usize, rng("crossed polygons", case));
        let n = rng.random_range(3..30);
        let size = rng.random_range(1..9);
        let polygon: Vec<P> = (0..n).map(|_| [rng.random_range(0..=size), rng.random_range(0..=size)]).collect();
        let (triangles, is_noted) = cut3_with_note(&lift(&polygon, round % 3, 1));
        check_edges(n, &triangles);
        // Either the areas add up, or the triangles are a fan.
        let areas = triangles.iter().map(|t| t.map(|i| polygon[i as usize])).map(|[a, b, c]| cross(a, b, c).abs());
        let (areas, outline) = (areas.sum::<i64>(), outline_area(&polygon).abs());
        assert_eq!(is_noted, areas != outline && n > 3, "{polygon:?}");
        if areas != outline {
            let last = u32::try_from(n).unwrap() - 1;
            assert_eq!(triangles, (1..last).map(|i| [0, i, i + 1]).collect::<Vec<_>>(), "{polygon:?}");
            fans += 1;
        }
    }
    let others = cases.len() - fans;
    assert!(cases.have_more_than(1000, fans) && cases.have_more_than(1000, others), "{fans}");
}

#[test]
fn polygons_that_are_not_planar_become_a_closed_patch() {
    for case in cases(2000, 200) {
        let mut rng = rng("bent polygons", case);
        let polygon = simple(&mut rng);
        let mut corners = lift(&polygon, 2, 0);
        for corner in &mut corners {
            corner[2] += rng.random_range(-0.01..0.01);
        }
        let triangles = cut3(&corners);
        assert_eq!(triangles.len(), polygon.len() - 2);
        // Each edge inside is shared by two triangles in opposite directions, each edge of the polygon has one.
        let edges: Vec<[u32; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let n = u32::try_from(polygon.len()).unwrap();
        let free: Vec<_> = edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])).collect();
        assert_eq!(free.len(), polygon.len(), "{polygon:?} {triangles:?}");
        assert!(free.iter().all(|&&[a, b]| b == (a + 1) % n), "{polygon:?} {triangles:?}");
    }
}

#[test]
fn points_that_are_not_of_the_lattice() {
    for case in cases(5000, 400) {
        let mut rng = rng("stars in any plane", case);
        // The polygons are stars around the origin in a random plane.
        let n = rng.random_range(5..60);
        let (u, v) = (random_vector(&mut rng), random_vector(&mut rng));
        let corners: Vec<[f64; 3]> = (0..n)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                let radius = rng.random_range(0.2..1.0);
                (u * (radius * angle.cos()) + v * (radius * angle.sin())).into()
            })
            .collect();
        let triangles = cut3(&corners);
        let p: Vec<_> = corners.iter().map(|&c| Point3::from(c)).collect();
        let at = |i: u32| p[i as usize];
        let sum: f64 = triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(&(at(c) - at(a))).norm()).sum();
        let outline =
            (0..p.len()).map(|i| p[i].coords.cross(&p[(i + 1) % p.len()].coords)).sum::<nalgebra::Vector3<f64>>();
        assert!((sum - outline.norm()).abs() <= 1e-12 * sum, "{sum} {}", outline.norm());
    }
}

fn random_vector(rng: &mut ChaCha8Rng) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0))
}

#[test]
fn large_polygons_over_few_places_are_not_cut_by_ears() {
    // The polygon runs many times around a star of nine corners, for which cutting ears takes cubic time, and makes
    // other triangles.
    const TURNS: usize = 3000;
    let star: [P; 9] = [[0, 9], [-2, 2], [-9, 2], [-3, -2], [-5, -9], [0, -4], [5, -9], [3, -2], [9, 2]];
    let polygon = star.repeat(TURNS);
    let triangles = cut3(&lift(&polygon, 0, 0));
    let last = u32::try_from(9 * TURNS).unwrap() - 1;
    assert_eq!(triangles, (1..last).map(|i| [0, i, i + 1]).collect::<Vec<_>>());
}
