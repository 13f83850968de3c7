//! Tests of triangulations of all kinds of points, and of the check on broken ones.

use super::*;
use dashu_int::IBig;
use p2m_core::engine::exact::{self, common_exponent, difference};
use p2m_core::predicates::{insphere, orientation_3d};
use p2m_testkit::{amount, cases, rng};
use rand::{Rng, RngExt};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

const REACH: f64 = 22.78;

/// Triangulates, checks the result, and asserts what the documentation says about sites.
fn valid(points: &[[f64; 3]]) -> Delaunay {
    let delaunay = Delaunay::new(points, REACH).unwrap();
    assert_eq!(delaunay.check(), Ok(()), "{points:?}");
    let distinct: BTreeSet<[u64; 3]> = points.iter().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    assert!(delaunay.sites().len() <= BOUNDING + distinct.len());
    for (i, p) in points.iter().enumerate() {
        let site = delaunay.sites()[delaunay.site_of(i)];
        for k in 0..3 {
            let snapped = site[k] == 0.0 && p[k].abs() / delaunay.unit() < 2f64.powi(-161);
            assert!(site[k] * delaunay.unit() == p[k] || snapped, "{p:?} {site:?}");
        }
    }
    delaunay
}

/// Triangulates, and compares the result with the definition: no site is in any sphere, and the volumes add up to the
/// volume of the octahedron. The order of the tetrahedra is free.
fn valid_by_definition(points: &[[f64; 3]]) {
    let delaunay = valid(points);
    let sites = delaunay.sites();
    let exponent = common_exponent(sites.as_flattened());
    let volume = |[a, b, c, d]: [[f64; 3]; 4]| {
        let [b, c, d] = [b, c, d].map(|p| difference(p, a, exponent));
        exact::dot(&exact::cross(&b, &c), &d)
    };
    let mut sum = IBig::ZERO;
    let mut faces = BTreeMap::new();
    let (mut edges, mut vertices) = (BTreeSet::new(), BTreeSet::new());
    for t in delaunay.tetrahedra() {
        let corners = t.map(|v| sites[v as usize]);
        sum += volume(corners);
        for site in sites {
            let [a, b, c, d] = corners;
            assert_ne!(insphere(a, b, c, d, *site), Ordering::Greater, "{points:?}");
        }
        let mut t = *t;
        t.sort_unstable();
        let [a, b, c, d] = t;
        for face in [[a, b, c], [a, b, d], [a, c, d], [b, c, d]] {
            *faces.entry(face).or_insert(0) += 1;
        }
        edges.extend([[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
        vertices.extend(t);
    }
    // The octahedron consists of four tetrahedra around an axis.
    let octahedron = [[0, 1, 2, 4], [0, 1, 4, 3], [0, 1, 3, 5], [0, 1, 5, 2]].map(|t| volume(t.map(|v| sites[v])));
    assert_eq!(sum, octahedron.iter().sum::<IBig>(), "{points:?}");
    assert_eq!(faces.values().filter(|&&n| n == 1).count(), 8);
    assert!(faces.values().all(|&n| n <= 2));
    let count = |n: usize| n as i64;
    let tetrahedra = count(delaunay.tetrahedra().len());
    assert_eq!(count(vertices.len()) - count(edges.len()) + count(faces.len()) - tetrahedra, 1, "{points:?}");
}

/// Returns points with small integer coordinates.
fn small_integers(random: &mut impl Rng) -> Vec<[f64; 3]> {
    let count = random.random_range(1..40);
    let most = [1, 2, 3, 5, 9][random.random_range(0..5)];
    // Some of the sets are flat or straight.
    let range = [0; 3].map(|_| if random.random_range(0..5) == 0 { 0 } else { most });
    (0..count).map(|_| range.map(|most| f64::from(random.random_range(-most..=most)))).collect()
}

fn uniform(random: &mut impl Rng, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [0; 3].map(|_| random.random_range(-1.0..1.0))).collect()
}

fn on_a_sphere(random: &mut impl Rng, count: usize) -> Vec<[f64; 3]> {
    let onto = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    uniform(random, count).into_iter().map(onto).collect()
}

fn grid(side: u32, spacing: f64) -> Vec<[f64; 3]> {
    let at = |i: u32| f64::from(i) * spacing;
    (0..side.pow(3)).map(|i| [at(i % side), at(i / side % side), at(i / side / side)]).collect()
}

#[test]
fn sets_of_small_integers_obey_the_definition() {
    for case in cases(2000, 400) {
        let random = &mut rng("delaunay small integers", case);
        valid_by_definition(&small_integers(random));
    }
}

#[test]
fn few_points_do() {
    assert_eq!(valid(&[]).tetrahedra().len(), 4);
    for x in [0.0, -0.0, 1.0, -3.5, 1e300, 5e-324] {
        assert_eq!(valid(&[[x; 3]]).tetrahedra().len(), 8);
        assert_eq!(valid(&[[x; 3]; 5]).sites().len(), 7);
    }
    valid_by_definition(&[[1.0, 2.0, 3.0], [1.0, 2.0, 3.0f64.next_up()]]);
    valid_by_definition(&[[0.0, -0.0, 1.0], [-0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(valid(&[[0.0; 3], [-0.0; 3]]).sites().len(), 7);
}

#[test]
fn random_points_do() {
    let random = &mut rng("delaunay uniform", 0);
    valid(&uniform(random, amount(20_000, 4_000)));
    valid_by_definition(&uniform(random, 100));
    let twice = uniform(random, 500).repeat(3);
    assert_eq!(valid(&twice).sites().len(), BOUNDING + 500);
}

#[test]
fn planes_and_lines_do() {
    let random = &mut rng("delaunay flat", 0);
    let flat: Vec<_> = uniform(random, 3000).into_iter().map(|[x, y, _]| [x, 0.25, y]).collect();
    valid(&flat);
    let oblique: Vec<_> = uniform(random, 3000).into_iter().map(|[x, y, _]| [x, y, 0.3 * x + 0.7 * y]).collect();
    valid(&oblique);
    let straight: Vec<_> = (0..3000).map(|i| [f64::from(i * i % 3001); 3]).collect();
    valid(&straight);
    let oblique: Vec<_> = (0..3000).map(|i| [0.1, 0.7, -0.3].map(|x| x * f64::from(i % 1000))).collect();
    assert_eq!(valid(&oblique).sites().len(), BOUNDING + 1000);
    valid_by_definition(&oblique[..50]);
}

#[test]
fn spheres_and_circles_do() {
    let random = &mut rng("delaunay sphere", 0);
    valid(&on_a_sphere(random, 5000));
    valid_by_definition(&on_a_sphere(random, 80));
    let circle: Vec<_> = (0..500).map(f64::from).map(|i| [(i * 0.01).cos(), (i * 0.01).sin(), 0.5]).collect();
    valid(&circle);
    // The points have integer coordinates and lie on a sphere around the origin.
    let all = grid(41, 1.0).into_iter().map(|p| p.map(|x| x - 20.0));
    let whole: Vec<_> = all.filter(|p| p.iter().map(|x| x * x).sum::<f64>() == 194.0).collect();
    assert!(whole.len() > 100);
    valid_by_definition(&whole);
}

/// The points lie on a circle and on its axis, and each is joined to all points of the other kind.
#[test]
fn points_with_many_tetrahedra_do() {
    let circle = (0..400).map(f64::from).map(|i| [(i * 0.37).cos(), (i * 0.37).sin(), 0.0]);
    let points: Vec<_> = circle.chain((1..40).map(|i| [0.0, 0.0, f64::from(i) * 0.01])).collect();
    let delaunay = valid(&points);
    assert!(delaunay.work().large_cavities > 10, "{:?}", delaunay.work());
    assert!(delaunay.tetrahedra().len() > 10_000);
}

#[test]
fn grids_are_delaunay() {
    for spacing in [1.0, 0.01, 1.0 / 3.0, 1e-200, 3e250] {
        valid(&grid(14, spacing));
    }
    valid_by_definition(&grid(5, 0.1));
}

#[test]
fn all_scales_are_delaunay() {
    let random = &mut rng("delaunay scales", 0);
    for scale in [1e-323, 1e-300, 1e-160, 1e160, 1e300, 1.7e308] {
        let points: Vec<_> = uniform(random, 300).into_iter().map(|p| p.map(|x| x * scale)).collect();
        valid(&points);
    }
    let mixed = |random: &mut dyn Rng, least: i32, most: i32| -> Vec<[f64; 3]> {
        let number = |random: &mut dyn Rng| {
            let x: f64 = random.random_range(-1.0..1.0);
            x * 2f64.powi(random.random_range(least..most))
        };
        (0..200).map(|_| [0; 3].map(|_| number(random))).collect()
    };
    for case in cases(20, 4) {
        let random = &mut rng("delaunay exponents", case);
        valid(&mixed(random, -1000, 1000));
        valid(&mixed(random, -160, 1));
        valid_by_definition(&mixed(random, -200, 0)[..30]);
    }
}

#[test]
fn clusters_far_from_the_origin_are_delaunay() {
    let random = &mut rng("delaunay clusters", 0);
    for size in [1e-6, 1e-12, 1e-15, 4e-16] {
        let points: Vec<_> = uniform(random, 1000)
            .into_iter()
            .map(|p| [1.0 + size * p[0], 3.0 + size * p[1], -1.5 + size * p[2]])
            .collect();
        valid(&points);
        let beside: Vec<_> = points.iter().copied().chain(uniform(random, 1000)).chain(grid(5, size)).collect();
        valid(&beside);
    }
}

#[test]
fn the_reach_is_that_asked_for() {
    for case in cases(200, 60) {
        let random = &mut rng("delaunay reach", case);
        let points = match case % 4 {
            0 => uniform(random, 20),
            1 => small_integers(random),
            2 => uniform(random, 8).into_iter().map(|p| p.map(|x| 1.0 + 1e-15 * x)).collect(),
            _ => grid(2, 1.0),
        };
        for reach in [Delaunay::MIN_REACH, 4.28, REACH, 1000.0, Delaunay::MAX_REACH] {
            let delaunay = Delaunay::new(&points, reach).unwrap();
            assert_eq!(delaunay.check(), Ok(()));
            let [low, high] = p2m_core::engine::curve::bounds(delaunay.sites()[BOUNDING..].iter().copied());
            let half = (0..3).map(|k| (high[k] - low[k]) / 2.0).fold(0.0, f64::max);
            let half = if half == 0.0 { 1.0 } else { half };
            for (i, site) in delaunay.sites()[..BOUNDING].iter().enumerate() {
                let centre = (low[i / 2] + high[i / 2]) / 2.0;
                let distance = (site[i / 2] - centre) * if i % 2 == 0 { -1.0 } else { 1.0 };
                assert!(distance >= reach * half, "{distance} {half}");
                assert!(distance <= 1.01 * reach * half + 2f64.powi(-45), "{distance} {half}");
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_and_wrong_reaches_are_refused() {
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let points = [[0.0; 3], [0.0, x, 0.0], [x; 3]];
        assert_eq!(Delaunay::new(&points, REACH).unwrap_err(), DelaunayError::NonFinite { index: 1 });
    }
    for reach in [2.9, 0.0, -5.0, 1e7, f64::INFINITY] {
        assert_eq!(Delaunay::new(&[], reach).unwrap_err(), DelaunayError::Reach { reach });
    }
    assert!(matches!(Delaunay::new(&[], f64::NAN), Err(DelaunayError::Reach { .. })));
}

#[test]
fn the_check_finds_what_is_broken() {
    let random = &mut rng("delaunay broken", 0);
    let good = valid(&uniform(random, 200));
    let broken = |change: &dyn Fn(&mut Delaunay)| {
        let mut delaunay = good.clone();
        change(&mut delaunay);
        delaunay.check().unwrap_err()
    };
    let inner = good.neighbours().iter().position(|n| !n.contains(&Delaunay::NONE)).unwrap();
    let outer = good.neighbours().iter().position(|n| n.contains(&Delaunay::NONE)).unwrap();
    let vertex = good.neighbours()[outer].iter().position(|n| *n == Delaunay::NONE).unwrap();
    let neighbour = |e| matches!(e, Invalid::Neighbour { .. });
    assert!(neighbour(broken(&|d| d.neighbours[inner].swap(0, 1))));
    assert!(neighbour(broken(&|d| d.neighbours[inner][2] = u32::MAX - 1)));
    assert!(neighbour(broken(&|d| d.neighbours[inner][2] = inner as u32)));
    assert_eq!(broken(&|d| d.neighbours[inner][2] = Delaunay::NONE), Invalid::CellPolytope);
    assert!(neighbour(broken(&|d| d.neighbours[outer][vertex] = inner as u32)));
    assert_eq!(broken(&|d| d.tetrahedra[inner].swap(0, 1)), Invalid::Orientation { tetrahedron: inner });
    assert_eq!(broken(&|d| d.tetrahedra[inner][0] = u32::MAX), Invalid::Orientation { tetrahedron: inner });
    assert!(matches!(broken(&|d| d.neighbours.truncate(3)), Invalid::Length { .. }));
    let unused = good.sites().len();
    assert_eq!(broken(&|d| d.scaled.positions.push([0.0; 3])), Invalid::Unused { site: unused });
    // The octahedron has no faces without the tetrahedra.
    assert_eq!(
        broken(&|d| [&mut d.tetrahedra, &mut d.neighbours].into_iter().for_each(Vec::clear)),
        Invalid::CellPolytope
    );
    // A site is moved a little, which puts it into a sphere if one is near.
    let moved = |site: usize| {
        let mut delaunay = good.clone();
        delaunay.scaled.positions[site][0] += 1e-3;
        delaunay.check()
    };
    let found: Vec<_> = (BOUNDING..good.sites().len()).map(moved).filter(Result::is_err).collect();
    assert!(found.len() > 4 && found.iter().all(|e| matches!(e, Err(Invalid::Sphere { .. }))), "{found:?}");
}

/// Two tetrahedra on a common face become three around an edge, where that is possible.
#[test]
fn the_check_finds_a_flip() {
    let random = &mut rng("delaunay flip", 0);
    let good = valid(&uniform(random, amount(300, 110)));
    let (sites, mut flips) = (good.sites(), 0);
    let orientation = |t: [u32; 4]| {
        let [a, b, c, d] = t.map(|v| sites[v as usize]);
        orientation_3d(a, b, c, d)
    };
    for i in 0..good.tetrahedra().len() {
        let [a, b, c, d] = good.tetrahedra()[i];
        let next = good.neighbours()[i][3];
        let Some(other) = good.tetrahedra().get(next as usize) else { continue };
        let e = *other.iter().find(|v| ![a, b, c].contains(v)).unwrap();
        let three = [[a, b, e, d], [b, c, e, d], [c, a, e, d]];
        if three.iter().any(|t| orientation(*t) != Ordering::Greater) {
            continue;
        }
        let mut bad = good.clone();
        bad.tetrahedra[i] = three[0];
        bad.tetrahedra[next as usize] = three[1];
        bad.tetrahedra.push(three[2]);
        bad.neighbours = adjacent(&bad.tetrahedra);
        // `adjacent` is right, since it finds the adjacency of the good triangulation. So the flip is the only fault
        // of the bad one.
        assert!(matches!(bad.check(), Err(Invalid::Sphere { .. })));
        flips += 1;
    }
    assert!(flips > amount(100, 30), "{flips}");
    let mut same = good.clone();
    same.neighbours = adjacent(&same.tetrahedra);
    assert_eq!(same.neighbours, good.neighbours);
}

/// Returns the neighbours of tetrahedra, found by their faces.
fn adjacent(tetrahedra: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let mut neighbours = vec![[Delaunay::NONE; 4]; tetrahedra.len()];
    let mut seen: BTreeMap<[u32; 3], (usize, usize)> = BTreeMap::new();
    for (i, t) in tetrahedra.iter().enumerate() {
        for k in 0..4 {
            let mut face = [1, 2, 3].map(|j| t[(k + j) % 4]);
            face.sort_unstable();
            if let Some((j, l)) = seen.insert(face, (i, k)) {
                neighbours[i][k] = j as u32;
                neighbours[j][l] = i as u32;
            }
        }
    }
    neighbours
}

#[test]
fn the_same_points_give_the_same_triangulation() {
    let points = uniform(&mut rng("delaunay same", 0), 2000);
    let [a, b] = [0; 2].map(|_| valid(&points));
    assert_eq!((a.tetrahedra(), a.neighbours()), (b.tetrahedra(), b.neighbours()));
    assert!(a.memory() >= 32 * a.tetrahedra().len() + 24 * a.sites().len() + 4 * points.len());
    assert!(a.work().spheres > 0 && a.work().created as usize > a.tetrahedra().len());
}

/// Adds points to a triangulation of the first ones, and checks the result. It returns the part of the tetrahedra
/// that was kept.
fn valid_extension(points: &[[f64; 3]], first: usize) -> f64 {
    let old = Delaunay::new(&points[..first], REACH).unwrap();
    let all = Delaunay::new(points, REACH).unwrap();
    let (extended, old_numbers) = old.extend(points, REACH, usize::MAX).unwrap();
    assert_eq!(extended.check(), Ok(()), "{first} of {points:?}");
    assert_eq!((extended.sites(), extended.unit()), (all.sites(), all.unit()));
    assert!((0..points.len()).all(|i| extended.site_of(i) == all.site_of(i)));
    assert_eq!(old_numbers.len(), extended.tetrahedra().len());
    // For each site of the old triangulation, the number of the same site in the extended one.
    let mut new_sites: Vec<usize> = (0..old.sites().len()).collect();
    (0..first).for_each(|i| new_sites[old.site_of(i)] = extended.site_of(i));
    let mut found = vec![false; old.tetrahedra().len()];
    for (vertices, number) in extended.tetrahedra().iter().zip(&old_numbers) {
        if *number != Delaunay::NONE {
            let old_vertices = old.tetrahedra()[*number as usize].map(|v| new_sites[v as usize]);
            assert_eq!(vertices.map(|v| v as usize), old_vertices);
            assert!(!std::mem::replace(&mut found[*number as usize], true), "each number occurs once");
        }
    }
    // A tetrahedron is kept if and only if no new site is inside of its sphere.
    if old_numbers.iter().any(|number| *number != Delaunay::NONE) {
        let added: BTreeSet<usize> = (first..points.len()).map(|i| extended.site_of(i)).collect();
        for (vertices, is_found) in old.tetrahedra().iter().zip(&found) {
            let [a, b, c, d] = vertices.map(|v| extended.sites()[new_sites[v as usize]]);
            let is_inside = |site: &usize| insphere(a, b, c, d, extended.sites()[*site]) == Ordering::Greater;
            assert_eq!(*is_found, !added.iter().any(is_inside));
        }
    }
    found.iter().filter(|is_found| **is_found).count() as f64 / found.len() as f64
}

#[test]
fn points_can_be_added() {
    let mut random = rng("extended triangulations", 0);
    let mut kept = [0.0, 0.0];
    let count = amount(400, 40);
    for case in 0..count {
        let points = match case % 4 {
            0 => small_integers(&mut random),
            1 => on_a_sphere(&mut random, 60),
            _ => {
                // The corners of the box are among the first points, so that the others are inside.
                let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|x| f64::from(2 * x - 1)));
                corners.chain(uniform(&mut random, 60)).collect()
            }
        };
        let first = if case % 4 < 2 { random.random_range(0..=points.len()) } else { 60 };
        kept[usize::from(case % 4 > 1)] += valid_extension(&points, first) / count as f64;
    }
    // Half of the cases are points in a box whose corners are known, and keep most tetrahedra.
    assert!(kept[0] > 0.05 && kept[1] > 0.25, "{kept:?}");
}

#[test]
fn everything_is_built_again_if_points_are_outside() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [3.0, 0.0, 0.0]];
    assert_eq!(valid_extension(&points, 4), 0.0);
    assert!(valid_extension(&points, 5) == 1.0, "nothing is added");
    let few = Delaunay::new(&points[..4], REACH).unwrap().extend(&points, REACH, 6);
    assert_eq!(few.unwrap_err(), DelaunayError::TooMany { len: 5 });
}
