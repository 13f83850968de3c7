//! Signs of whole families of surfaces, compared with rational crossings.
//!
//! The oracle counts the crossings of a ray along x by the rational arithmetic of p2m-testkit, one triangle after the
//! other. It has neither the direction nor the code of the library.

use nalgebra::{Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{Closest, PrimitiveSet, Ray, Side, Soup};
use p2m_field::sign::{Sign, SignRule, SignedDistance};
use p2m_mixed::generate::{IcoSphere, TorusKnot, Transform, ico_sphere, torus_knot};
use p2m_testkit::ray_oracle::crossing;
use p2m_testkit::{amount, cases, rng, vector};
use rand::{Rng, RngExt};
use std::collections::BTreeMap;

/// A surface of a family.
type Family = fn(&mut dyn Rng) -> Soup<f64>;

/// The families, each with the rule that is expected by default.
const FAMILIES: [(&str, SignRule, Family); 14] = [
    ("one ball", SignRule::Winding, |rng| ball(rng, 1.0)),
    ("overlapping balls", SignRule::Winding, |rng| {
        let (one, other) = (ball(rng, 1.0), ball(rng, 0.8));
        joined(&[one, moved(&other, offset(rng) * 0.9)])
    }),
    ("nested balls", SignRule::Winding, |rng| {
        let (one, other) = (ball(rng, 1.0), ball(rng, 0.5));
        joined(&[one, moved(&other, offset(rng) * 0.2)])
    }),
    ("cavity", SignRule::Winding, |rng| {
        let (one, other) = (ball(rng, 1.0), ball(rng, 0.5));
        joined(&[one, flipped(&moved(&other, offset(rng) * 0.2))])
    }),
    ("inside out", SignRule::Winding, |rng| flipped(&ball(rng, 1.0))),
    ("overlapping boxes", SignRule::Winding, |rng| {
        let boxes: Vec<_> = (0..4).map(|_| any_box(rng)).collect();
        joined(&boxes)
    }),
    ("touching bricks", SignRule::Winding, |_| {
        let brick = |i: usize| {
            let low = [i % 3, i / 3 % 3, i / 9].map(|k| k as f64);
            // Every second layer is shifted, so faces touch in parts.
            let shift = 0.5 * f64::from(low[2] as u32 % 2);
            cuboid([low[0] + shift, low[1], low[2]], [low[0] + shift + 1.0, low[1] + 1.0, low[2] + 1.0])
        };
        joined(&(0..18).map(brick).collect::<Vec<_>>())
    }),
    ("duplicated shells", SignRule::Winding, |rng| {
        let one = ball(rng, 1.0);
        joined(&[one.clone(), one])
    }),
    ("tetrahedra", SignRule::Winding, |rng| {
        let all: Vec<_> = (0..12).map(|_| tetrahedron(rng)).collect();
        joined(&all)
    }),
    ("slivers", SignRule::Winding, |rng| {
        let all: Vec<_> = (0..6).map(|_| needle(rng)).collect();
        joined(&all)
    }),
    ("self-intersecting knot", SignRule::Winding, |rng| {
        let thick = TorusKnot { rings: 24, sides: 6, tube_radius: rng.random_range(0.4..0.9), ..Default::default() };
        torus_knot(&thick).expect("valid")
    }),
    ("far away", SignRule::Winding, |rng| {
        let (one, other) = (ball(rng, 1.0), ball(rng, 0.8));
        let pair = joined(&[one, moved(&other, offset(rng) * 0.9)]);
        let far = 10f64.powi(rng.random_range(3..12));
        moved(&pair, offset(rng) * far)
    }),
    ("tiny or huge", SignRule::Winding, |rng| {
        let (one, other) = (ball(rng, 1.0), ball(rng, 0.8));
        let pair = joined(&[one, moved(&other, offset(rng) * 0.9)]);
        let scale = 10f64.powi(rng.random_range(-120..120));
        Transform::default().scaled(scale).apply(&pair).expect("valid")
    }),
    ("not oriented", SignRule::Parity, |rng| {
        let pair = joined(&[ball(rng, 1.0), moved(&ball(rng, 0.8), offset(rng) * 0.9)]);
        let turned = pair.triangles().iter().map(|[a, b, c]| if rng.random() { [*a, *b, *c] } else { [*a, *c, *b] });
        Soup::from_triangles(pair.positions().to_vec(), turned.collect()).expect("valid")
    }),
];

/// Returns a random vector with components from -1 to 1.
fn offset(mut rng: &mut dyn Rng) -> Vector3<f64> {
    vector(&mut rng)
}

fn ball(rng: &mut dyn Rng, radius: f64) -> Soup<f64> {
    let ball = ico_sphere(&IcoSphere { frequency: rng.random_range(1..5) }).expect("valid");
    Transform::default().scaled(radius).apply(&ball).expect("valid")
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Soup<f64> {
    let at = |i: usize| Point3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] }));
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Soup::from_triangles((0..8).map(at).collect(), triangles).expect("valid")
}

fn any_box(rng: &mut dyn Rng) -> Soup<f64> {
    let low = [0; 3].map(|_| f64::from(rng.random_range(0..8u8)) / 4.0);
    cuboid(low, low.map(|x| x + f64::from(rng.random_range(1..6u8)) / 4.0))
}

fn of_corners(corners: [Point3<f64>; 4]) -> Soup<f64> {
    let [a, b, c, d] = corners;
    let is_positive = (b - a).cross(&(c - a)).dot(&(d - a)) > 0.0;
    let faces = [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]];
    let faces = faces.map(|[a, b, c]| if is_positive { [a, b, c] } else { [a, c, b] });
    Soup::from_triangles(corners.to_vec(), faces.to_vec()).expect("valid")
}

fn tetrahedron(rng: &mut dyn Rng) -> Soup<f64> {
    of_corners([0; 4].map(|_| Point3::from(offset(rng))))
}

/// Returns a tetrahedron with faces of very small angles.
fn needle(rng: &mut dyn Rng) -> Soup<f64> {
    let (start, along) = (offset(rng), offset(rng));
    let mut thin = || 10f64.powi(-rng.random_range(1..13));
    let widths = [thin(), thin(), thin()];
    let near = |w: f64, rng: &mut dyn Rng| Point3::from(start + offset(rng) * w);
    of_corners([near(widths[0], rng), near(widths[1], rng), near(widths[2], rng), Point3::from(start + along)])
}

fn joined(parts: &[Soup<f64>]) -> Soup<f64> {
    let mut scene = p2m_mixed::Scene::default();
    for part in parts {
        scene.add("", part).expect("room");
    }
    std::sync::Arc::unwrap_or_clone(scene.soup)
}

fn flipped(soup: &Soup<f64>) -> Soup<f64> {
    let triangles = soup.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Soup::from_triangles(soup.positions().to_vec(), triangles).expect("valid")
}

fn moved(soup: &Soup<f64>, by: Vector3<f64>) -> Soup<f64> {
    Transform::default().translated(by.into()).apply(soup).expect("valid")
}

/// Returns points in the box of a scene, and points at all distances from its triangles, edges and vertices.
fn queries(rng: &mut dyn Rng, soup: &Soup<f64>, count: usize) -> Vec<Point3<f64>> {
    let bounds = soup.aabb();
    let size = (bounds.max - bounds.min).norm();
    let mut one = |i: usize| {
        if i.is_multiple_of(3) {
            return Point3::from([0, 1, 2].map(|k| rng.random_range(bounds.min[k]..=bounds.max[k])));
        }
        let triangle = soup.triangles()[rng.random_range(0..soup.triangles().len())];
        let [a, b, c] = triangle.map(|i| soup.positions()[i as usize]);
        // Some weights are zero, for edges and vertices.
        let mut weight = || if rng.random_range(0..3) == 0 { 0.0 } else { rng.random::<f64>() };
        let (s, t) = (weight(), weight());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let distance = 10f64.powi(-rng.random_range(0..17)) * size;
        a + (b - a) * s + (c - a) * t + offset(rng) * distance
    };
    (0..count).map(&mut one).collect()
}

/// Counts the crossings of a ray along x: those from back to front less those from front to back, and all of them.
fn crossings(soup: &Soup<f64>, query: &Point3<f64>) -> [i64; 2] {
    let ray = Ray::new(query, &Vector3::x()).expect("finite");
    let mut counts = [0, 0];
    for triangle in soup.triangles() {
        let corners = triangle.map(|i| soup.positions()[i as usize]);
        // The comparisons are exact, so a ray that passes the box misses the triangle.
        let passes = |k: usize| corners.iter().all(|c| c[k] < query[k]) || corners.iter().all(|c| c[k] > query[k]);
        if passes(1) || passes(2) || corners.iter().all(|c| c.x < query.x) {
            continue;
        }
        if let Some((side, _)) = crossing(&ray, &corners.map(Into::into)).filter(|(_, parameter)| *parameter >= 0.0) {
            counts[0] += if side == Side::Back { 1 } else { -1 };
            counts[1] += 1;
        }
    }
    counts
}

fn is_inside(soup: &Soup<f64>, rule: SignRule, query: &Point3<f64>) -> bool {
    let [signed, all] = crossings(soup, query);
    match rule {
        SignRule::Winding => signed != 0,
        SignRule::Parity => all % 2 != 0,
    }
}

/// Returns whether a query is exactly on a triangle.
fn is_on(soup: &Soup<f64>, closest: &Closest<f64>, query: &Point3<f64>) -> bool {
    closest.distance == 0.0
        || closest.lower_bound <= 0.0 && {
            let here = Ray::new(query, &Vector3::x()).expect("finite").with_range(0.0, 0.0).expect("one place");
            p2m_core::RayQuery::do_intersect(&p2m_core::BruteForce::new(soup).expect("valid"), &here)
        }
}

#[test]
fn signs_of_all_families_are_those_of_rational_crossings() {
    let (surfaces, points) = amount((24, 3000), (3, 80));
    let cases = cases(surfaces, 3);
    println!("{:<24} {:>9} {:>9} {:>9} {:>7}", "family", "signs", "inside", "by rays", "wrong");
    let mut total = BTreeMap::new();
    for (name, rule, family) in FAMILIES {
        let (mut signs, mut inside, mut by_rays, mut wrong) = (0, 0, 0, 0);
        for case in cases.clone() {
            let mut rng = rng(name, case);
            let soup = family(&mut rng);
            let queries = queries(&mut rng, &soup, points);
            let signed = SignedDistance::new(AabbTree::new(&soup).expect("valid"), &soup).expect("triangles");
            assert_eq!(signed.rule(), rule, "{name}");
            for query in &queries {
                let answer = signed.closest_point(query).expect("not empty");
                let expected = if is_on(&soup, &answer.closest, query) {
                    Sign::Boundary
                } else if is_inside(&soup, rule, query) {
                    Sign::Inside
                } else {
                    Sign::Outside
                };
                signs += 1;
                inside += usize::from(expected == Sign::Inside);
                if answer.sign != expected {
                    wrong += 1;
                    println!("{name}, case {case}: {} for {expected} at {query:?}, {:?}", answer.sign, answer.closest);
                }
            }
            // A batch prepares certificates, which single queries do only after some rays.
            let fresh = SignedDistance::new(AabbTree::new(&soup).expect("valid"), &soup).expect("triangles");
            let batch = fresh.closest_points(&queries, &Default::default(), &Default::default());
            for (query, answer) in queries.iter().zip(batch) {
                let sign = signed.closest_point(query).map(|answer| answer.sign);
                assert_eq!(answer.map(|answer| answer.sign), sign, "{name}, case {case}: {query:?}");
            }
            let found = signed.contains_each(&queries, &Default::default());
            for (query, found) in queries.iter().zip(found) {
                assert_eq!(found, signed.contains(query), "{name}, case {case}: {query:?}");
            }
            by_rays += fresh.ambiguous_count();
        }
        println!("{name:<24} {signs:>9} {inside:>9} {by_rays:>9} {wrong:>7}");
        total.insert(name, (signs, inside, wrong));
    }
    let wrong: usize = total.values().map(|(_, _, wrong)| wrong).sum();
    assert_eq!(wrong, 0, "{total:?}");
    // Every family has points on both sides, and the normal decides most signs of a ball.
    assert!(cases.is_replay() || total.values().all(|(signs, inside, _)| *inside > signs / 50 && *inside < *signs));
}

/// Returns the sum of the solid angles of all triangles over 4 pi, by the excess of the angles of spherical triangles. The
/// library has another formula.
fn winding_number(soup: &Soup<f64>, query: &Point3<f64>) -> f64 {
    let excess = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| (soup.positions()[i as usize] - query).normalize());
        let angle = |at: &Vector3<f64>, one: &Vector3<f64>, other: &Vector3<f64>| {
            let (n, m) = (at.cross(one), at.cross(other));
            n.cross(&m).norm().atan2(n.dot(&m))
        };
        let sum = angle(&a, &b, &c) + angle(&b, &c, &a) + angle(&c, &a, &b) - std::f64::consts::PI;
        sum.copysign(a.dot(&b.cross(&c)))
    };
    soup.triangles().iter().map(excess).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Returns a box whose top has other triangles than its sides, so that vertices lie inside of edges.
fn box_with_t_junctions(rng: &mut dyn Rng) -> Soup<f64> {
    let whole = any_box(rng);
    let (mut positions, mut triangles) = (whole.positions().to_vec(), whole.triangles().to_vec());
    // The longest edge of one triangle gets a vertex in its middle, which its neighbour does not have.
    let [a, b, c] = triangles.swap_remove(rng.random_range(0..12));
    let middle = u32::try_from(positions.len()).expect("few");
    positions.push(nalgebra::center(&positions[b as usize], &positions[c as usize]));
    triangles.extend([[a, b, middle], [a, middle, c]]);
    Soup::from_triangles(positions, triangles).expect("valid")
}

#[test]
fn signs_of_open_families_are_those_of_another_sum() {
    let families: [(&str, Family); 4] = [
        ("ball with holes", |rng| {
            let ball = ball(rng, 1.0);
            let kept = ball.triangles().iter().filter(|_| rng.random_range(0..6) > 0).copied().collect();
            Soup::from_triangles(ball.positions().to_vec(), kept).expect("valid")
        }),
        ("half a ball", |rng| {
            let ball = ball(rng, 1.0);
            let low = |t: &&[u32; 3]| t.iter().any(|i| ball.positions()[*i as usize].x < 0.1);
            Soup::from_triangles(ball.positions().to_vec(), ball.triangles().iter().filter(low).copied().collect())
                .expect("valid")
        }),
        ("T-junctions", box_with_t_junctions),
        ("loose triangles", |rng| {
            let positions = (0..90).map(|_| Point3::from(offset(rng))).collect();
            Soup::from_triangles(positions, (0..30).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()).expect("valid")
        }),
    ];
    let (count, points) = amount((60, 3000), (6, 100));
    for (name, family) in families {
        let (mut decided, mut inside) = (0, 0);
        for case in cases(count, 6) {
            let mut rng = rng(name, case);
            let soup = family(&mut rng);
            let signed = SignedDistance::new(AabbTree::new(&soup).expect("valid"), &soup).expect("triangles");
            assert_eq!((signed.rule(), signed.is_closed()), (SignRule::Winding, false), "{name}, case {case}");
            let queries = queries(&mut rng, &soup, points);
            let contained = signed.contains_each(&queries, &Default::default());
            for (query, contained) in queries.iter().zip(contained) {
                let number = winding_number(&soup, query);
                let answer = signed.closest_point(query).expect("not empty");
                // Near an edge neither formula has many digits.
                if answer.closest.distance < 1e-6 || (number.abs() - 0.5).abs() < 1e-7 {
                    continue;
                }
                decided += 1;
                inside += usize::from(number.abs() > 0.5);
                let expected = if number.abs() > 0.5 { Sign::Inside } else { Sign::Outside };
                assert_eq!(answer.sign, expected, "{name}, case {case}: {number} at {query:?}");
                assert_eq!(contained, expected == Sign::Inside, "{name}, case {case}: {query:?}");
                let found = signed.winding_number(query, 1e-4);
                assert!((found - number).abs() < 1e-4 + 1e-8, "{name}, case {case}: {found} for {number} at {query:?}");
            }
        }
        println!("{name:<24} {decided:>9} {inside:>9}");
        assert!(cases(count, 6).is_replay() || decided > 100 && inside > 5, "{name}: {inside} of {decided}");
    }
}
