//! Tests of rays at random scenes of every kind, at every scale, and far from the origin.

use super::backends::{Checked, check, on_random_scenes, scaled, scaled_ray, soup_of};
use nalgebra::{Point3, Vector3};
use p2m::{PrimitiveSet, Ray, Soup};
use p2m_testkit::families::{SCALES, wild};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::scenes::{self, Kinds, LAYOUTS};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;

#[test]
fn random_scenes_are_met_as_exact_arithmetic_says() {
    let mut checked = Checked::default();
    let cases = cases(48, 24);
    on_random_scenes("rays", cases.clone(), &[0, 1, 5, amount(40, 15), amount(120, 30)], |seed, soup, rays| {
        check(&soup, &rays, &mut rng("ranges", seed), &mut checked, &|| format!("seed {seed}"));
    });
    println!("{checked:?}");
    let has_many = |count| cases.have_more_than(amount(1000, 102), count);
    let is_hit = cases.is_replay() || checked.hits > checked.rays;
    assert!(is_hit && has_many(checked.along) && has_many(checked.crossings), "{checked:?}");
}

#[test]
fn scenes_of_f32_are_met_as_exact_arithmetic_says() {
    let mut checked = Checked::default();
    let cases = cases(48, 24);
    on_random_scenes("rays in f32", cases.clone(), &[1, 5, amount(40, 20)], |seed, soup, rays| {
        let narrow = scenes::narrow(&soup).expect("fits f32");
        check(&narrow, &rays, &mut rng("ranges", seed), &mut checked, &|| format!("seed {seed}"));
    });
    println!("{checked:?}");
    assert!(cases.have_more_than(amount(1000, 102), checked.hits), "{checked:?}");
}

/// Scaling by powers of two changes no side, and scales a parameter by a power of two, unless a number overflows or
/// underflows.
#[test]
fn no_scale_of_scene_or_direction_is_too_small_or_too_large() {
    let mut checked = Checked::default();
    let cases = cases(48, 24);
    on_random_scenes("scaled rays", cases.clone(), &[1, 5, amount(20, 10)], |seed, soup, rays| {
        let mut rng = rng("scales", seed);
        let scales = SCALES.into_iter().chain([-540, -340, 340, 1022]);
        // Shallow tests use some of the scales for each case.
        for e in scales.skip(seed as usize % amount(1, 4)).step_by(amount(1, 4)) {
            let positions = soup.positions().iter().map(|p| p.map(|x| scaled(x, e))).collect();
            let Ok(soup) = Soup::new(positions, soup.elements()) else { continue };
            let mut some = Vec::new();
            for ray in &rays {
                // The direction has any length, or is so long that parameters come near a limit of f64 or of plain
                // arithmetic, or exceed it.
                let f = match rng.random_range(0..4) {
                    0 => [-1074, -1000, -600, -250, 0, 0, 250, 600, 1000, 1023][rng.random_range(0..10)],
                    1 => e + rng.random_range(-30..30),
                    2 => e - [-1074, -1030, -1022, 1022][rng.random_range(0..4)] + rng.random_range(-10..10),
                    _ => e - [-250, 250, -500, 500][rng.random_range(0..4)] + rng.random_range(-5..5),
                };
                some.extend(scaled_ray(ray, e, f).filter(|_| rng.random_range(0..amount(8, 4)) == 0));
            }
            if !some.is_empty() {
                check(&soup, &some, &mut rng, &mut checked, &|| format!("seed {seed} at 2^{e}"));
            }
        }
    });
    println!("{checked:?}");
    let has_more = |least, count| cases.have_more_than(least, count);
    let is_crossed = has_more(amount(500, 12), checked.crossings);
    assert!(is_crossed && has_more(amount(5_000, 128), checked.hits), "{checked:?}");
}

#[test]
fn magnitudes_may_mix_in_scene_and_ray() {
    let mut checked = Checked::default();
    let cases = cases(40, 6);
    for seed in cases.clone() {
        let mut rng = rng("magnitudes of rays", seed);
        let cases: Vec<_> = (0..6).map(|_| wild(&mut rng)).collect();
        let primitives: Vec<_> = cases.iter().map(|case| case.vertices.clone()).collect();
        let soup = soup_of(&primitives);
        let mut rays: Vec<Ray> = AIMS
            .iter()
            .filter(|_| rng.random())
            .copied()
            .collect::<Vec<_>>()
            .into_iter()
            .map(|aim| ray(&mut rng, &soup, &soup.aabb(), aim))
            .collect();
        for (case, other) in cases.iter().zip(&cases[1..]) {
            // Rays lead from a vertex or a query in a direction given by coordinates, and to another vertex.
            let vertex = Point3::from(case.vertices[0]);
            let queries = [Point3::from(case.query), vertex];
            let directions = [other.query.into(), Point3::from(other.vertices[0]) - vertex];
            let wire = other.query[0].abs();
            for (query, direction) in queries.into_iter().zip(directions) {
                rays.extend(Ray::new(&query, &direction).and_then(|ray| ray.line().with_radius(wire)));
            }
        }
        let rays: Vec<Ray> = rays.into_iter().skip(seed as usize % amount(1, 9)).step_by(amount(1, 9)).collect();
        check(&soup, &rays, &mut rng, &mut checked, &|| format!("seed {seed}"));
    }
    println!("{checked:?}");
    let has_more = |least, count| cases.have_more_than(least, count);
    let is_crossed = has_more(amount(1000, 110), checked.along) && has_more(amount(100, 11), checked.crossings);
    assert!(is_crossed && has_more(amount(2000, 220), checked.hits), "{checked:?}");
}

/// The scene is thin along one axis. Along another axis it is so far away that the rounding of its centre is 2^178
/// times its size, so its tree cannot locate a line.
#[test]
fn thin_scenes_far_from_the_origin_are_met() {
    let place = -8.799083088101401e24;
    let [a, b] = [1.754425677334671e-41, 1.7561072354918608e-41].map(|z| [place, place, z]);
    let soup = soup_of(&[vec![a, b], vec![a], vec![b]]);
    let from = Point3::from(a);
    let rays = [from.coords, Vector3::z()].map(|direction| Ray::new(&from, &direction).expect("valid"));
    let mut checked = Checked::default();
    check(&soup, &rays, &mut rng("thin scenes", 0), &mut checked, &String::new);
    assert!(checked.hits > 0, "{checked:?}");
}

/// The parameter of a hit has as many digits far from the origin as near it.
#[test]
fn far_origins_lose_nothing() {
    let mut checked = Checked::default();
    let cases = cases(20, 6);
    for seed in cases.clone() {
        let mut rng = rng("far rays", seed);
        let soup = scenes::soup(&mut rng, Kinds::Mixed, LAYOUTS[seed as usize % 6], 30);
        let rays: Vec<Ray> = (0..amount(30, 3))
            .map(|_| {
                let target = scenes::query(&mut rng, soup.positions());
                let away = Vector3::from_fn(|k, _| f64::from((k as i32 + rng.random_range(-3..=3)) * 2 + 1));
                let distance = 2f64.powi([20, 40, 50, 53, 54, 60, 990][rng.random_range(0..7)]);
                let origin = target + away * distance;
                let aim = if rng.random() { target - origin } else { -away };
                Ray::new(&origin, &aim).expect("finite").line().with_radius(rng.random_range(0.0..0.1)).expect("valid")
            })
            .collect();
        check(&soup, &rays, &mut rng, &mut checked, &|| format!("seed {seed}"));
    }
    println!("{checked:?}");
    assert!(cases.have_more_than(amount(100, 10), checked.hits), "{checked:?}");
}
