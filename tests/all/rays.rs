//! Compares rays with exact rational arithmetic: every backend on every instruction set, every function, and ranges
//! that begin and end at hits.
#![cfg(all(feature = "bvh", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Point3, Vector3};
use p2m::backend::{Crossing, Hits, RayCollector, RayHit};
use p2m::kdop::Directions;
use p2m::{
    Aabb, AabbTree, BruteForce, BuildIndex, Element, Feature, Hit, Isa, KdopTree, Primitive, PrimitiveId, PrimitiveSet,
    Projection, Ray, RayError, RayQuery, Real, Side, Soup,
};
use p2m_testkit::families::{SCALES, wild};
use p2m_testkit::ray_check::{Truth, agrees, bits};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::scenes::{self, Kinds, LAYOUTS, of_case};
use p2m_testkit::{Cases, amount, cases, rng};
use rand::{Rng, RngExt};
use std::ops::ControlFlow;

type Index<'a, T> = (String, Box<dyn RayQuery<T> + 'a>);

/// Adds a tree with every instruction set.
fn kdops<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a, const K: usize>(all: &mut Vec<Index<'a, T>>, set: S)
where
    Directions<K>: Default,
{
    let tree = KdopTree::<T, S, K>::build(set, &Default::default()).expect("valid");
    all.extend(
        Isa::available()
            .into_iter()
            .map(|isa| -> Index<'a, T> { (format!("{K}-DOPs, {isa}"), Box::new(tree.clone().with_isa(isa))) }),
    );
}

/// An index that finds hits in another order than that of ids.
struct Reversed<T: Real, S>(AabbTree<T, S>);

/// A collector that keeps all offers.
struct Offered<'r> {
    only_crossings: bool,
    all: Vec<(PrimitiveId, Crossing<'r>)>,
}

impl<'r> RayCollector<'r> for Offered<'r> {
    fn only_crossings(&self) -> bool {
        self.only_crossings
    }

    fn offer(&mut self, id: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()> {
        self.all.push((id, *crossing));
        ControlFlow::Continue(())
    }
}

impl<T: Real, S: PrimitiveSet<T>> RayQuery<T> for Reversed<T, S> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        let mut offered = Offered { only_crossings: hits.only_crossings(), all: Vec::new() };
        self.0.visit_ray(ray, &mut offered);
        offered.all.sort_by_key(|(id, _)| std::cmp::Reverse(*id));
        let _ = offered.all.iter().try_for_each(|(id, crossing)| hits.offer(*id, crossing));
    }
}

/// Returns brute force first, then every tree with every instruction set.
fn backends<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a>(set: S) -> Vec<Index<'a, T>> {
    let mut all = few_backends(set);
    kdops::<T, S, 6>(&mut all, set);
    kdops::<T, S, 18>(&mut all, set);
    kdops::<T, S, 26>(&mut all, set);
    all
}

/// Returns brute force, boxes and 14-DOPs. They are few because each tree is compiled for each type of set.
fn few_backends<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a>(set: S) -> Vec<Index<'a, T>> {
    let mut all: Vec<Index<'a, T>> = vec![("brute force".to_owned(), Box::new(BruteForce::new(set).expect("valid")))];
    let boxes = AabbTree::<T, S>::build(set, &Default::default()).expect("valid");
    for isa in Isa::available() {
        all.push((format!("boxes, {isa}"), Box::new(boxes.clone().with_isa(isa))));
    }
    all.push(("boxes, backwards".to_owned(), Box::new(Reversed(boxes))));
    kdops::<T, S, 14>(&mut all, set);
    all
}

/// The numbers of rays, hits, and hits along a segment that were checked.
#[derive(Debug, Default)]
struct Checked {
    rays: usize,
    hits: usize,
    along: usize,
    crossings: usize,
}

/// Compares all backends with the exact hits, for each ray with its own range and with other ranges.
fn check<T: Real, R: Rng>(
    soup: &Soup<T>,
    rays: &[Ray],
    rng: &mut R,
    checked: &mut Checked,
    context: &dyn Fn() -> String,
) {
    let wide = |v: &Point3<T>| -> [f64; 3] { v.map(T::to_f64).coords.into() };
    let primitives: Vec<Vec<[f64; 3]>> =
        (0..soup.len()).map(|i| soup.get(PrimitiveId::new(i)).vertices().iter().map(wide).collect()).collect();
    let backends = backends(soup);
    for ray in rays {
        let truth = Truth::new(&primitives, 0..primitives.len(), ray);
        for round in 0..6 {
            let ray = match round {
                0 => *ray,
                _ => {
                    let [min, max] = truth.range(rng);
                    ray.with_range(min, max).expect("in order")
                }
            };
            let hits = truth.checked_hits(&*backends[0].1, &ray, context);
            let crossings = truth.crossings(&ray);
            checked.rays += 1;
            checked.hits += hits.len();
            checked.along += hits.iter().filter(|h| h.side == Side::Along).count();
            checked.crossings += crossings;
            // The ranges take turns.
            let turn = rng.random_range(0..3);
            for (i, (name, index)) in backends.iter().enumerate() {
                if round == 0 || i == 0 || i % 3 == turn {
                    agrees(&**index, &ray, &hits, crossings, &|| format!("{name}: {}", context()));
                }
            }
        }
    }
    for (name, index) in &backends {
        assert!(soup.len() > 0 || index.first_intersection(&rays[0]).is_none(), "{name}: nothing there");
    }
}

/// Returns one ray of each aim.
fn rays<R: Rng>(rng: &mut R, soup: &Soup<f64>) -> Vec<Ray> {
    let radius = |rng: &mut R| match rng.random_range(0..3) {
        0 => 0.0,
        1 => 1.0,
        _ => 2f64.powi(rng.random_range(-60..4)),
    };
    AIMS.iter().map(|aim| ray(rng, soup, &soup.aabb(), *aim).with_radius(radius(rng)).expect("valid")).collect()
}

/// Returns x 2^e, which is infinite or rounded beyond the range of f64.
fn scaled(x: f64, e: i32) -> f64 {
    x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2)
}

/// Returns the ray at 2^e times the scene, with 2^f times the direction, if there is one.
fn scaled_ray(ray: &Ray, e: i32, f: i32) -> Option<Ray> {
    let (origin, direction) = (ray.origin().map(|x| scaled(x, e)), ray.direction().map(|x| scaled(x, f)));
    let [min, max] = ray.range();
    let scaled_ray = Ray::new(&origin, &direction).ok()?.with_radius(scaled(ray.radius(), e)).ok()?;
    scaled_ray.with_range(scaled(min, e - f), scaled(max, e - f)).ok()
}

fn soup_of(primitives: &[Vec<[f64; 3]>]) -> Soup<f64> {
    let positions = primitives.iter().flatten().map(|v| Point3::from(*v)).collect();
    let mut next = 0;
    let mut take = || {
        next += 1;
        next - 1
    };
    let elements: Vec<Element> = primitives
        .iter()
        .map(|v| match v.len() {
            1 => Element::Point(take()),
            2 => Element::Segment([take(), take()]),
            _ => Element::Triangle([take(), take(), take()]),
        })
        .collect();
    Soup::new(positions, elements).expect("finite")
}

/// Runs a check on random scenes of all kinds and layouts with rays of all aims: three of each, or one in fourteen of
/// them in shallow tests.
fn on_random_scenes(name: &str, cases: Cases, sizes: &[usize], mut each: impl FnMut(u64, Soup<f64>, Vec<Ray>)) {
    for seed in cases {
        let mut rng = rng(name, seed);
        let (kinds, layout) = of_case(seed);
        let size = sizes[rng.random_range(0..sizes.len())];
        let soup = scenes::soup(&mut rng, kinds, layout, size);
        let rays = if soup.len() == 0 {
            vec![Ray::new(&Point3::<f64>::origin(), &Vector3::x()).expect("valid")]
        } else {
            let all: Vec<_> = (0..3).flat_map(|_| rays(&mut rng, &soup)).collect();
            // The aims take turns.
            all.into_iter().skip(seed as usize % amount(1, 14)).step_by(amount(1, 14)).collect()
        };
        each(seed, soup, rays);
    }
}

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

/// Powers of two change no side, and change a parameter by a power of two, unless a number under- or overflows.
#[test]
fn no_scale_of_scene_or_direction_is_too_small_or_too_large() {
    let mut checked = Checked::default();
    let cases = cases(48, 24);
    on_random_scenes("scaled rays", cases.clone(), &[1, 5, amount(20, 10)], |seed, soup, rays| {
        let mut rng = rng("scales", seed);
        let scales = SCALES.into_iter().chain([-540, -340, 340, 1022]);
        // The scales take turns in shallow tests.
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
            // Rays lead from a vertex or a query into the direction of coordinates, and to another vertex.
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

/// The scene is thin along one axis, and so far away along another one that the rounding of its centre there is 2^178
/// times its size, so that its tree cannot locate a line.
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

/// The parameter of a hit has as many digits far away as near.
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

/// Checks all triangles of a lattice of 27 points (some of them in shallow tests), most of which are degenerate or in a
/// plane of the lattice, with their vertices in any order, and all segments and points of the lattice.
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
        // In shallow tests each line is tested against another subset.
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
/// inside leaves once more than it enters. The cubes have two triangles a side, or sides cut into four.
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
            // A step without a common divisor reaches all lines, and a few steps reach all directions.
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

/// Each hit of a single point is in exactly one of the adjacent ranges [t0, t1], [t1.next_up(), t2] and so on.
#[test]
fn ranges_in_a_row_share_the_hits_out() {
    let mut shared = 0;
    let cases = cases(30, 12);
    for seed in cases.clone() {
        let mut rng = rng("ranges in a row", seed);
        let soup = scenes::soup(&mut rng, Kinds::Triangles, LAYOUTS[seed as usize % 6], 60);
        let tree = AabbTree::build(&soup, &Default::default()).expect("valid");
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

/// Both zeros are equal: a hit at -0 begins at 0, and the lowest id wins.
#[test]
fn ranges_may_begin_at_minus_zero() {
    let flat = |y: f64| vec![[-1.0, 0.0, y], [1.0, 0.0, y], [0.0, 1.0, y]];
    let upright = |z: f64| vec![[0.0, 0.0, z], [0.0, 4.0, z - 1.0], [0.0, 4.0, z + 1.0]];
    // The first hit begins at zero, the second before it.
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

/// The end of a common segment may be beyond the range of f64, and it is then all that a range at infinity contains.
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

/// A user-defined primitive.
#[derive(Clone, Copy)]
struct Ball {
    centre: Point3<f64>,
    radius: f64,
}

impl Primitive<f64> for Ball {
    fn aabb(&self) -> Aabb<f64> {
        let r = Vector3::repeat(self.radius);
        Aabb { min: self.centre - r, max: self.centre + r }
    }

    fn project(&self, query: &Point3<f64>) -> Projection {
        let point = self.aabb().clamp(*query);
        Projection::new(query, point, Feature::Face, [1.0, 0.0, 0.0], 1.0)
    }

    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit> {
        let (offset, d) = (self.centre - ray.origin(), ray.direction());
        let middle = offset.dot(&d) / d.norm_squared();
        let aside = (offset - d * middle).norm_squared();
        if aside > self.radius * self.radius {
            return None;
        }
        let half = ((self.radius * self.radius - aside) / d.norm_squared()).sqrt();
        let parameter = (middle - half).max(ray.range()[0]);
        let end = (middle + half).min(ray.range()[1]);
        (parameter <= end).then(|| RayHit {
            parameter,
            side: Side::Front,
            barycentric: [1.0, 0.0, 0.0],
            point: self.aabb().clamp(ray.at(parameter)),
        })
    }
}

#[test]
fn primitives_of_ones_own_are_hit_where_they_say() {
    let mut rng = rng("balls and rays", 0);
    let mut place = || Point3::from(std::array::from_fn(|_| rng.random_range(-5.0..5.0)));
    let balls: Vec<Ball> = (0..200).map(|i| Ball { centre: place(), radius: f64::from(i % 10) * 0.1 }).collect();
    let backends = few_backends(&balls[..]);
    let mut count = 0;
    for i in 0..amount(200, 40) {
        let (from, to) = (place(), place());
        let ray = Ray::through(&from, &to).expect("apart");
        let ray = [ray, ray.line(), ray.with_range(0.0, 1.0).expect("in order")][i % 3];
        let mut expected: Vec<Hit> = Vec::new();
        for (id, ball) in balls.iter().enumerate() {
            let Some(answer) = ball.intersect_ray(&ray) else { continue };
            expected.push(Crossing::of_hit(&ray, answer).expect("in the range").hit(PrimitiveId::new(id)));
        }
        expected.sort_by(|a, b| a.parameter.total_cmp(&b.parameter).then(a.primitive.cmp(&b.primitive)));
        for (name, index) in &backends {
            agrees(&**index, &ray, &expected, 0, &|| format!("{name}: ray {i}"));
        }
        count += expected.len();
    }
    assert!(count > amount(100, 20), "{count}");
}

/// A user-defined primitive that ignores the range or returns nonsense.
#[derive(Clone, Copy)]
struct Stubborn(f64);

impl Primitive<f64> for Stubborn {
    fn aabb(&self) -> Aabb<f64> {
        Aabb { min: Point3::new(-9.0, 0.0, 0.0), max: Point3::new(9.0, 1.0, 1.0) }
    }

    fn project(&self, query: &Point3<f64>) -> Projection {
        Projection::new(query, self.aabb().clamp(*query), Feature::Face, [1.0, 0.0, 0.0], 1.0)
    }

    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit> {
        let point = if self.0.is_finite() { ray.at(self.0) } else { ray.origin() };
        Some(RayHit { parameter: self.0, side: Side::Along, barycentric: [0.0; 3], point })
    }
}

#[test]
fn answers_of_others_count_in_the_range_only() {
    let set = [0.5, f64::NAN, 3.0, 2.0, -1.0, f64::INFINITY, 0.0, -0.0].map(Stubborn);
    let ray = Ray::new(&Point3::new(0.0, 0.5, 0.5), &Vector3::x()).expect("valid");
    let ray = ray.with_range(0.0, 2.0).expect("in order");
    for (name, index) in few_backends(&set[..]) {
        let hits = index.all_intersections(&ray);
        let ids: Vec<usize> = hits.iter().map(|hit| hit.primitive.index()).collect();
        assert_eq!(ids, [6, 7, 0, 3], "{name}");
        assert_eq!(index.first_intersection(&ray).map(|hit| hit.primitive), Some(PrimitiveId::new(6)), "{name}");
        assert_eq!((index.count(&ray), index.crossings(&ray)), (4, 0), "{name}");
    }
}

#[test]
fn rays_that_make_no_sense_are_refused() {
    let (o, x) = (Point3::<f64>::origin(), Vector3::x());
    let inf = f64::INFINITY;
    for bad in [f64::NAN, inf, -inf] {
        for k in 0..3 {
            let (mut origin, mut direction) = (o, x);
            origin[k] = bad;
            direction[k] = bad;
            assert_eq!(Ray::new(&origin, &x), Err(RayError::NonFinite), "{bad} {k}");
            assert_eq!(Ray::new(&o, &direction), Err(RayError::NonFinite), "{bad} {k}");
        }
    }
    assert_eq!(Ray::new(&o, &Vector3::new(0.0, -0.0, 0.0)), Err(RayError::ZeroDirection));
    assert_eq!(Ray::through(&o, &o), Err(RayError::ZeroDirection));
    let far = Point3::new(f64::MAX, 0.0, 0.0);
    assert_eq!(Ray::through(&far, &-far), Err(RayError::NonFinite));
    let ray = Ray::new(&o, &Vector3::new(f64::from_bits(1), 0.0, 0.0)).expect("shortest");
    assert_eq!((ray.range(), ray.radius()), ([0.0, inf], 0.0));
    assert_eq!(ray.line().range(), [-inf, inf]);
    assert_eq!(ray.with_range(2.0, 1.0), Err(RayError::EmptyRange { min: 2.0, max: 1.0 }));
    assert!(matches!(ray.with_range(f64::NAN, 1.0), Err(RayError::EmptyRange { .. })));
    assert!(matches!(ray.with_range(0.0, f64::NAN), Err(RayError::EmptyRange { .. })));
    assert_eq!(ray.with_range(2.0, 2.0).map(|r| r.range()), Ok([2.0, 2.0]));
    assert_eq!(ray.with_range(-inf, inf), Ok(ray.line()));
    for bad in [-1.0, -f64::from_bits(1), inf] {
        assert_eq!(ray.with_radius(bad), Err(RayError::Radius(bad)));
    }
    assert!(matches!(ray.with_radius(f64::NAN), Err(RayError::Radius(r)) if r.is_nan()));
    assert_eq!(ray.with_radius(f64::MAX).map(|r| r.radius()), Ok(f64::MAX));
    let narrow = Ray::new(&Point3::new(0.1f32, 0.2, 0.3), &Vector3::new(0.4f32, 0.5, 0.6)).expect("valid");
    assert_eq!(narrow.origin(), Point3::new(0.1f32, 0.2, 0.3).map(f64::from));
    assert_eq!(narrow.direction(), Vector3::new(0.4f32, 0.5, 0.6).map(f64::from));
}

#[test]
fn scenes_small_beside_their_coordinates_are_hit_from_afar() {
    let mut hits = 0;
    let cases = cases(600, 66);
    for case in cases.clone() {
        let mut rng = rng("small and far", case);
        let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0f64));
        // All vertices of a cluster are within 2^-20 to 2^-52 of their coordinates, and each primitive is as small as
        // possible.
        let extent = 2f64.powi(-20 - i32::try_from(case % 33).expect("small"));
        let centre = Vector3::new(1.3, 1.6, 1.9);
        let mut primitives = Vec::new();
        for i in 0..18u8 {
            let place = centre + vector() * extent * f64::from(i % 3);
            let near: Vec<[f64; 3]> = (0..3).map(|_| (place + vector() * (3.0 * f64::EPSILON)).into()).collect();
            primitives.push(near[..1 + usize::from(i % 3)].to_vec());
        }
        let soup = soup_of(&primitives);
        let backends = few_backends(&soup);
        for primitive in primitives.iter().skip(case as usize % amount(1, 3)).step_by(amount(1, 3)) {
            let target = Point3::from(primitive[0]);
            let far = 2f64.powi(10 + i32::try_from(case % 26).expect("small"));
            for origin in [target - vector() * far, target - vector() * (extent * far)] {
                let Ok(ray) = Ray::through(&origin, &target) else { continue };
                let radius = extent * [0.0, 0.1][usize::from(case % 2 == 0)];
                let ray = ray.line().with_radius(radius).expect("valid");
                let expected = bits_of(&backends[0], &ray);
                hits += expected.len();
                for backend in &backends[1..] {
                    assert_eq!(bits_of(backend, &ray), expected, "{} case {case}: {ray:?}", backend.0);
                }
            }
        }
    }
    assert!(cases.have_more_than(amount(20_000, 6_600), hits), "{hits}");
}

/// Returns all hits, comparable to the last bit.
fn bits_of<T: Real>((_, index): &Index<'_, T>, ray: &Ray) -> Vec<(usize, u64)> {
    let bits = |hit: &Hit| (hit.primitive.index(), hit.parameter.to_bits());
    index.all_intersections(ray).iter().map(bits).collect()
}

#[test]
fn packets_that_became_mixed_keep_the_radius() {
    let mut rng = rng("refitted rays", 0);
    let mut place = || -> [f64; 3] { std::array::from_fn(|_| rng.random_range(-2.0..2.0)) };
    let triangles = soup_of(&(0..64).map(|_| vec![place(), place(), place()]).collect::<Vec<_>>());
    let others = soup_of(&(0..64).map(|i| (0..1 + i % 2).map(|_| place()).collect()).collect::<Vec<_>>());
    let mut boxes = AabbTree::<f64, _>::build(&triangles, &Default::default()).expect("valid");
    boxes.refit(&others, &Default::default()).expect("as many");
    let mut kdops = KdopTree::<f64, _, 14>::build(&triangles, &Default::default()).expect("valid");
    kdops.refit(&others, &Default::default()).expect("as many");
    let trees: [&dyn RayQuery<f64>; 2] = [&boxes, &kdops];
    let brute = BruteForce::new(&others).expect("valid");
    let mut count = 0;
    for _ in 0..300 {
        let ray = Ray::through(&Point3::from(place()), &Point3::from(place())).expect("apart");
        let ray = ray.with_radius(0.3).expect("valid");
        count += brute.count(&ray);
        for tree in trees {
            assert_eq!(tree.all_intersections(&ray), brute.all_intersections(&ray), "{ray:?}");
        }
    }
    assert!(count > 300, "{count}");
}
