//! Tests of every decision against exact rational arithmetic, for correct and for wrong claims.

#![allow(clippy::float_cmp, reason = "what is proved is proved to the last bit")]

use super::candidate::Candidate;
use super::decide::{DecidedBy, Decision, decide, is_within};
use super::rounded::RoundedDistance;
use super::{feature_certificate, rational};
use crate::kernel::vector::V3;
use crate::{Feature, Point, Primitive, PrimitiveId, Segment, Triangle};
use nalgebra::Point3;
use p2m_testkit::families::{case, wild};
use p2m_testkit::oracle::Distance;
use p2m_testkit::{Cases, cases, rng, vector};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use std::cmp::Ordering;

type Shape = Vec<V3>;

const FEATURES: [Feature; 7] = [
    Feature::Vertex(0),
    Feature::Vertex(1),
    Feature::Vertex(2),
    Feature::Edge(0),
    Feature::Edge(1),
    Feature::Edge(2),
    Feature::Face,
];

/// Returns the feature that the kernel finds.
fn claim(query: V3, vertices: &[V3]) -> Feature {
    let query = Point3::from(query);
    let projection = match *vertices {
        [a] => Point::new(a.into()).project(&query),
        [a, b] => Segment::new(a.into(), b.into()).project(&query),
        [a, b, c] => Triangle::new(a.into(), b.into(), c.into()).project(&query),
        _ => unreachable!("one to three vertices"),
    };
    projection.feature
}

fn length(x: f64, more: f64) -> Distance {
    Distance::new([-more, 0.0, 0.0], &[[x, 0.0, 0.0]])
}

/// Returns whether a distance is the true one, rounded to nearest.
fn is_rounded(query: V3, vertices: &[V3], x: f64) -> bool {
    let largest = vertices.iter().chain([&query]).flatten().fold(x, |m, x| m.max(x.abs()));
    // The scale makes half a unit in the last place an f64.
    let scale = if largest < 2f64.powi(900) { 2f64.powi(120) } else { 1.0 };
    let up = |p: V3| p.map(|x| x * scale);
    let truth = Distance::new(up(query), &vertices.iter().map(|v| up(*v)).collect::<Vec<_>>());
    if x == f64::INFINITY {
        return truth.compare(&length(f64::MAX, 2f64.powi(970))).is_ge();
    }
    let above = if x < f64::MAX { (x.next_up() - x) * (0.5 * scale) } else { 2f64.powi(970) };
    let below = (x - x.next_down()) * (0.5 * scale);
    if above == 0.0 {
        // The distance is subnormal, and the largest coordinates cannot be scaled up.
        return truth.relative_error(x, 53, f64::from_bits(1)) <= 1.0;
    }
    let even = x.to_bits() & 1 == 0;
    let fits = |order: Ordering, right: Ordering| order == right || even && order.is_eq();
    fits(truth.compare(&length(x * scale, above)), Ordering::Less)
        && (x == 0.0 || fits(truth.compare(&length(x * scale, -below)), Ordering::Greater))
}

fn candidates<'a>(shapes: &'a [Shape], ids: &[usize], claims: &[Feature]) -> Vec<Candidate<'a>> {
    let candidate = |((vertices, id), feature): ((&'a Shape, &usize), &Feature)| Candidate {
        id: PrimitiveId::new(*id),
        vertices,
        feature: *feature,
    };
    shapes.iter().zip(ids).zip(claims).map(candidate).collect()
}

/// Checks the decision between some primitives with the claims of the kernel and with wrong claims, and returns the
/// decision for the claims of the kernel.
fn check(query: V3, shapes: &[Shape], rng: &mut impl Rng) -> Decision {
    let mut ids: Vec<usize> = (0..shapes.len()).map(|i| 3 * i + 1).collect();
    ids.shuffle(rng);
    let truths: Vec<Distance> = shapes.iter().map(|s| Distance::new(query, s)).collect();
    let order = |a: &usize, b: &usize| truths[*a].compare(&truths[*b]).then(ids[*a].cmp(&ids[*b]));
    let winner = (0..shapes.len()).min_by(order).unwrap();
    let decide_by = |claim: &mut dyn FnMut(&[V3]) -> Feature| {
        let claims: Vec<Feature> = shapes.iter().map(|shape| claim(shape)).collect();
        let decision = decide(query, &candidates(shapes, &ids, &claims));
        let Decision { winner: found, distance: RoundedDistance { nearest: distance, lower }, .. } = decision;
        let context = || format!("{query:?} {shapes:?} {ids:?} {claims:?} {decision:?}");
        assert_eq!(found, winner, "{}", context());
        assert!(is_rounded(query, &shapes[winner], distance), "{}", context());
        assert!(lower <= distance && lower >= distance.next_down().max(0.0), "{}", context());
        assert!(lower == 0.0 || truths[winner].is_at_least(lower), "{}", context());
        decision
    };
    let decision = decide_by(&mut |shape| claim(query, shape));
    for _ in 0..2 {
        let other = decide_by(&mut |_| FEATURES[rng.random_range(0..7)]);
        assert_eq!(other.distance.nearest, decision.distance.nearest);
    }
    for feature in FEATURES {
        decide_by(&mut |_| feature);
    }
    check_radii(query, &shapes[winner], decision.distance.nearest);
    decision
}

fn check_radii(query: V3, vertices: &[V3], distance: f64) {
    let truth = Distance::new(query, vertices);
    for radius in [distance.next_down(), distance, distance.next_up(), distance * 0.75, distance * 1.5, 0.0] {
        let expected = radius == f64::INFINITY || radius >= 0.0 && truth.compare(&length(radius, 0.0)).is_le();
        assert_eq!(is_within(query, vertices, radius), expected, "{query:?} {vertices:?} {radius:e}");
    }
    assert!(!is_within(query, vertices, f64::NAN) && !is_within(query, vertices, -1.0));
}

/// Returns a point with each coordinate changed by a few units in the last place.
fn nudged(p: V3, rng: &mut impl Rng) -> V3 {
    p.map(|x| match rng.random_range(0..4) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    })
    .map(|x| x.clamp(-f64::MAX, f64::MAX))
}

/// Returns a shape that is related to another one: a part of it, a permutation, a neighbour, or a mirror image.
fn relative(query: V3, shape: &Shape, rng: &mut impl Rng) -> Shape {
    let mut all = shape.clone();
    all.shuffle(rng);
    match rng.random_range(0..6) {
        0 => all,
        1 => all[..rng.random_range(1..=all.len())].to_vec(),
        2 => all.into_iter().map(|v| nudged(v, rng)).collect(),
        3 => {
            let last = all.len() - 1;
            all[last] = nudged(all[last], rng);
            all
        }
        4 => {
            let mirror = |v: V3| std::array::from_fn(|k| (query[k] - (v[k] - query[k])).clamp(-f64::MAX, f64::MAX));
            all.into_iter().map(mirror).collect()
        }
        _ => vec![all[0]; rng.random_range(1..=3)],
    }
}

fn check_relatives(name: &str, cases: Cases, mut draw: impl FnMut(&mut dyn Rng) -> (V3, Shape)) -> [u64; 2] {
    let mut stages = [0; 2];
    for number in cases {
        let mut rng = rng(name, number);
        let (query, shape) = draw(&mut rng);
        let mut shapes = vec![shape.clone()];
        for _ in 0..rng.random_range(0..6) {
            shapes.push(relative(query, &shape, &mut rng));
        }
        stages[check(query, &shapes, &mut rng).decided_by as usize] += 1;
    }
    stages
}

#[test]
fn all_families_are_decided_rightly_whatever_is_claimed() {
    let cases = cases(6000, 600);
    let stages = check_relatives("certified families", cases.clone(), |mut rng| {
        let c = case(&mut rng);
        (c.query, c.vertices)
    });
    assert!(stages.iter().all(|count| cases.have_more_than(1000, *count as usize)), "{stages:?}");
}

#[test]
fn any_exponents_may_meet() {
    check_relatives("certified wild", cases(600, 100), |mut rng| {
        let c = wild(&mut rng);
        (c.query, c.vertices)
    });
    let tiny = f64::from_bits(1);
    let mut rng = rng("certified scales", 0);
    for scale in [tiny, 3.0 * tiny, f64::MIN_POSITIVE, 1e-300, 1e-30, 1.0, 1e30, 1e300, 4e307] {
        let at = |p: V3| p.map(|x| x * scale);
        let shapes = [
            vec![at([1.0, 2.0, 2.0])],
            vec![at([0.0, 3.0, -1.0]), at([0.0, 3.0, 2.0])],
            vec![at([3.0, -1.0, -1.0]), at([3.0, 4.0, -1.0]), at([3.0, -1.0, 4.0])],
            vec![at([2.0, 2.0, 2.0])],
        ];
        assert_eq!(check([0.0; 3], &shapes, &mut rng).distance.nearest, 3.0 * scale);
    }
    // The distance exceeds the range of f64.
    let far = [vec![[f64::MAX; 3]], vec![[f64::MAX, f64::MAX, -f64::MAX], [f64::MAX; 3]]];
    let decision = check([-f64::MAX; 3], &far, &mut rng);
    assert_eq!((decision.distance.nearest, decision.distance.lower, decision.winner), (f64::INFINITY, f64::MAX, 1));
}

/// The coordinates of the shapes are small integers, some changed by one unit in the last place. So the vertices are
/// often collinear or repeated, or the shapes are very small.
#[test]
fn degenerate_primitives_are_what_their_vertices_span() {
    check_relatives("certified degenerate", cases(3000, 500), |rng| {
        let direction: V3 = std::array::from_fn(|_| f64::from(rng.random_range(-3..=3)) / 3.0);
        let start: V3 = std::array::from_fn(|_| f64::from(rng.random_range(-3..=3)));
        let mut vertices: Shape = (0..rng.random_range(2..=3))
            .map(|_| {
                let t = f64::from(rng.random_range(-2..=2));
                std::array::from_fn(|k| start[k] + t * direction[k])
            })
            .collect();
        if rng.random_range(0..3) == 0 {
            vertices[0][rng.random_range(0..3)] += [1e-16, 1e-100, 1e-300][rng.random_range(0..3)];
        }
        (std::array::from_fn(|_| f64::from(rng.random_range(-4..=4)) / 2.0), vertices)
    });
}

/// Returns six triangles around a vertex at the origin, which form a bumpy disc.
fn triangles_around_a_vertex(rng: &mut impl Rng) -> [Shape; 6] {
    let ring: [V3; 6] = std::array::from_fn(|i| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_3 * i as f64).sin_cos();
        let bump = vector(rng);
        [cos + 0.2 * bump[0], sin + 0.2 * bump[1], 0.3 * bump[2]]
    });
    let centre: V3 = vector(rng).map(|x| 0.1 * x).into();
    std::array::from_fn(|i| vec![centre, ring[i], ring[(i + 1) % 6]])
}

#[test]
fn meshes_hardly_ever_need_integers() {
    let cases = cases(20_000, 4_000);
    let mut exact = 0;
    for number in cases.clone() {
        let mut rng = rng("certified fans", number);
        let shapes = triangles_around_a_vertex(&mut rng);
        let scale = [0.1, 1.0, 5.0, 1000.0][rng.random_range(0..4)];
        let query: V3 = vector(&mut rng).map(|x| scale * x).into();
        let decision = if number % 20 == 0 {
            check(query, &shapes, &mut rng)
        } else {
            let claims: Vec<Feature> = shapes.iter().map(|shape| claim(query, shape)).collect();
            decide(query, &candidates(&shapes, &[0, 1, 2, 3, 4, 5], &claims))
        };
        exact += usize::from(decision.decided_by == DecidedBy::Integers);
    }
    assert!(cases.have_fewer_than(20, exact), "{exact} of {}", cases.len());
}

/// A nearest feature that several primitives share is evaluated once, without integers, and the lowest id wins.
#[test]
fn what_is_shared_is_no_tie() {
    for number in cases(300, 60) {
        let mut rng = rng("certified shared", number);
        let [a, b, c, d]: [V3; 4] = std::array::from_fn(|_| vector(&mut rng).into());
        let above = |weights: [f64; 3], by: f64| -> V3 {
            let [e, f]: [V3; 2] = [b, c].map(|v| std::array::from_fn(|k| v[k] - a[k]));
            let normal = crate::kernel::arithmetic::cross(e, f);
            std::array::from_fn(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + by * normal[k])
        };
        let faces = [vec![a, b, c], vec![b, c, a], vec![c, b, a]];
        assert_eq!(check(above([0.3, 0.3, 0.4], 0.7), &faces, &mut rng).decided_by, DecidedBy::Floats);
        let edges = [vec![a, b], vec![b, a], vec![a, b, a]];
        assert_eq!(check(above([0.4, 0.6, 0.0], -0.7), &edges, &mut rng).decided_by, DecidedBy::Floats);
        let away: V3 = std::array::from_fn(|k| 9.0 * a[k] - 3.0 * (b[k] + c[k] + d[k]));
        let vertices = [vec![a, b, c], vec![d, a], vec![b, a, d], vec![a]];
        let holds = vertices.iter().all(|v| Distance::new(away, v).compare(&Distance::new(away, &[a])).is_eq());
        assert!(check(away, &vertices, &mut rng).decided_by == DecidedBy::Floats || !holds);
        assert_eq!(check(a, &vertices, &mut rng).distance.nearest, 0.0);
    }
    let square = |i: i32, j: i32| vec![[0.0; 3], [f64::from(i), 0.0, 0.0], [0.0, f64::from(j), 0.0]];
    let grid = [square(1, 1), square(1, -1), square(-1, -1), square(-1, 1)];
    assert_eq!(check([0.0, 0.0, 0.1], &grid, &mut rng("certified shared", 0)).decided_by, DecidedBy::Floats);
    let minus = [vec![[-0.0, 1.0, -0.0]], vec![[0.0, 1.0, 0.0], [0.0, 2.0, -0.0]]];
    assert_eq!(check([0.0, -0.5, 0.0], &minus, &mut rng("certified shared", 0)).decided_by, DecidedBy::Floats);
}

#[test]
fn ties_on_a_lattice_go_to_the_lowest_id() {
    for number in cases(4000, 500) {
        let mut rng = rng("certified lattice", number);
        let size = [1, 2, 4, 1 << 20][rng.random_range(0..4)];
        let mut point = || -> V3 { std::array::from_fn(|_| f64::from(rng.random_range(-size..=size))) };
        let query = point();
        let shapes: Vec<Shape> = (0..6).map(|i| (0..=i % 3).map(|_| point()).collect()).collect();
        check(query, &shapes, &mut rng);
    }
}

/// Returns a shape whose coordinates are permuted and mirrored, which is exact.
fn placed(shape: &[V3], [query, signs]: [V3; 2], axes: [usize; 3]) -> Shape {
    shape.iter().map(|v| std::array::from_fn(|k| query[k] + signs[k] * v[axes[k]])).collect()
}

fn check_placed(shapes: &[Shape], most: i64, rng: &mut impl Rng) -> Decision {
    let query: V3 = std::array::from_fn(|_| rng.random_range(-most..=most) as f64);
    let signs: V3 = std::array::from_fn(|_| if rng.random_bool(0.5) { 1.0 } else { -1.0 });
    let mut axes = [0, 1, 2];
    axes.shuffle(rng);
    let shapes: Vec<Shape> = shapes.iter().map(|s| placed(s, [query, signs], axes)).collect();
    check(query, &shapes, rng)
}

/// The squares have 2 to 104 bits and differ by one, since (2 b - 1)^2 + (b - 2)^2 = (2 b - 2)^2 + b^2 + 1.
#[test]
fn points_whose_squares_differ_by_one_are_told_apart() {
    let (mut exact, mut one) = (0, 0);
    let cases = cases(20, 8);
    for bits in 1..51 {
        for number in cases.clone() {
            let mut rng = rng("certified points", 1000 * bits + number);
            let b = ((1i64 << bits) + rng.random_range(0..1i64 << bits)) as f64;
            let c = rng.random_range(0..1i64 << bits) as f64;
            let shapes = [vec![[2.0 * b - 1.0, b - 2.0, c]], vec![[2.0 * b - 2.0, b, c]]];
            let decision = check_placed(&shapes, 1 << (bits - 1), &mut rng);
            assert_eq!(decision.winner, 1);
            let root = |s: &Shape| decide([0.0; 3], &[candidate(s)]).distance.nearest;
            one += usize::from(bits >= 30 && root(&shapes[0]) == root(&shapes[1]));
            exact += usize::from(decision.decided_by == DecidedBy::Integers);
            assert!(bits > 40 || decision.decided_by == DecidedBy::Floats, "{bits}");
        }
    }
    assert!(cases.have_more_than(20, exact), "{exact}");
    // Both distances round to the same f64, unless a boundary of rounding lies between them.
    assert!(cases.have_more_than(410, one), "{one}");
}

fn candidate(vertices: &[V3]) -> Candidate<'_> {
    Candidate { id: PrimitiveId::new(0), vertices, feature: Feature::Vertex(0) }
}

/// The face with the centroid h (1, 2, 2), and an edge through it, have the distance 3 h. They are compared with one
/// vertex of the square 9 h^2 + 1, and with one of the square 9 h^2.
#[test]
fn faces_edges_and_vertices_that_are_almost_equally_near_are_told_apart() {
    let mut stages = [0; 2];
    let cases = cases(20, 8);
    for bits in 1..49 {
        for number in cases.clone() {
            let mut rng = rng("certified mixed kinds", 1000 * bits + number);
            let h = ((1i64 << bits) + rng.random_range(0..1i64 << bits)) as f64;
            let far = (1 + rng.random_range(0..1i64 << bits)) as f64;
            let at = |d: V3| -> V3 { std::array::from_fn(|k| h * [1.0, 2.0, 2.0][k] + far * d[k]) };
            let face = vec![at([2.0, -1.0, 0.0]), at([0.0, 1.0, -1.0]), at([-2.0, 0.0, 1.0])];
            let edge = vec![at([2.0, -1.0, 0.0]), at([-2.0, 1.0, 0.0])];
            let beside = vec![[3.0 * h, 1.0, 0.0]];
            let level = vec![[0.0, 3.0 * h, 0.0], [-1.0, 4.0 * h, 0.0]];
            let near = |shape: &Shape, rng: &mut _| check_placed(&[beside.clone(), shape.clone()], 1 << bits, rng);
            for shape in [&face, &edge] {
                let decision = near(shape, &mut rng);
                assert_eq!((decision.winner, decision.distance.nearest), (1, 3.0 * h));
                stages[decision.decided_by as usize] += 1;
                assert!(bits > 40 || decision.decided_by == DecidedBy::Floats, "{bits} {number}");
            }
            let tie = check_placed(&[face, edge, level, beside], 1 << bits, &mut rng);
            assert_eq!((tie.decided_by, tie.distance.nearest), (DecidedBy::Integers, 3.0 * h));
        }
    }
    assert!(cases.have_more_than(20, stages[1]), "{stages:?}");
}

/// Edges and faces are slanted and have integer coordinates, so their squares are fractions. Their distances, such as
/// c k / sqrt(1 + k^2), differ by one step.
#[test]
fn fractions_that_almost_agree_are_told_apart() {
    for number in cases(4000, 500) {
        let mut rng = rng("certified fractions", number);
        let bits = rng.random_range(1..16);
        let mut integer = || rng.random_range(1..2i64 << bits) as f64;
        let [c, k, z, far] = [0; 4].map(|_| integer());
        let edge = |c: f64, k: f64| vec![[c + far, -k * far, z], [c - far, k * far, z]];
        let face = |c: f64, k: f64| vec![[c, 0.0, z], [c + far, -k * far, z - far], [c - far, k * far, z + far]];
        let shapes = [edge(c, k), edge(c, k + 1.0), edge(c + 1.0, k), face(c, k), face(c, k + 1.0), face(c + 1.0, k)];
        check_placed(&shapes, 1 << bits, &mut rng);
    }
}

/// The distances are about one rounding error of the coordinates. The kernel has no correct digit there, but the
/// certified distance is rounded to nearest.
#[test]
fn distances_within_rounding_are_as_accurate_as_others() {
    let mut small = 0;
    let cases = cases(3000, 600);
    for number in cases.clone() {
        let mut rng = rng("certified surface", number);
        let count = rng.random_range(2..=3);
        let shape: Shape = (0..count).map(|_| vector(&mut rng).into()).collect();
        let weights: V3 = std::array::from_fn(|_| rng.random_range(0.0..1.0));
        let sum: f64 = weights[..count].iter().sum();
        let lift = [0.0, 1e-17, 1e-14, 1e-12, 1e-9][rng.random_range(0..5)];
        let query: V3 = std::array::from_fn(|k| {
            let on: f64 = shape.iter().zip(weights).map(|(v, w)| v[k] * (w / sum)).sum();
            on + lift * rng.random_range(-1.0..1.0)
        });
        let other = relative(query, &shape, &mut rng);
        let decision = check(query, &[shape, other], &mut rng);
        small += usize::from(decision.distance.nearest < 1e-15);
    }
    assert!(cases.have_more_than(1000, small), "{small}");
}

/// Returns whether a claim is proved, and asserts that a proved feature is as near as the primitive.
fn proves(query: V3, vertices: &[V3], claim: Feature) -> bool {
    let proved = feature_certificate::is_proved(query, vertices, claim);
    if proved {
        let [by_claim, truth] = [true, false].map(|proved| rational::Square::new(query, vertices, claim, proved));
        assert!(by_claim.cmp(&truth).is_eq(), "{query:?} {vertices:?} {claim:?}");
    }
    proved
}

/// Offsets and edges have 106 bits, and dot products and sides cancel except for the last one. For perpendicular (or
/// opposite) q and w, and a small a, (a - q) . (w - a) = a . (w + q - a) and (a - q) x (w - a) = a x (w - q).
#[test]
fn what_cancels_to_the_last_bit_of_double_double_is_proved_only_if_it_is_true() {
    let mut counts = [0; 2];
    let cases = cases(20_000, 10_000);
    for number in cases.clone() {
        let mut rng = rng("certified last bits", number);
        let [x, y] = [0; 2].map(|_| rng.random_range(1.0..2.0));
        let up = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-1.0..1.0) };
        let small = rng.random_range(-1.0..1.0) * 2f64.powi(-rng.random_range(45..56));
        let turned = rng.random_bool(0.5);
        let w = if turned { [-y, x] } else { [-x, -y] };
        let a =
            if turned { [small, -small * (w[0] + x) / (w[1] + y)] } else { [small, small * (w[1] - y) / (w[0] - x)] };
        let other: V3 = [rng.random_range(-2.0..2.0), rng.random_range(-2.0..2.0), 0.0];
        let mut vertices = vec![[a[0], a[1], 0.0], [w[0], w[1], 0.0], other];
        vertices.truncate(rng.random_range(2..=3));
        vertices.shuffle(&mut rng);
        let count = FEATURES.iter().filter(|f| proves([x, y, up], &vertices, **f)).count();
        counts[usize::from(count > 0)] += 1;
    }
    assert!(counts.iter().all(|count| cases.have_more_than(1000, *count)), "{counts:?}");
}

/// The distances have 106 bits and lie midway between two f64, exactly or except for the last bit.
#[test]
fn distances_almost_half_way_between_floats_are_rounded_rightly() {
    let mut stages = [0; 2];
    let cases = cases(2000, 200);
    for number in cases.clone() {
        let mut rng = rng("certified half way", number);
        let x: f64 = rng.random_range(1.0..2.0);
        let off = [0.0, 2f64.powi(-rng.random_range(30..53))][rng.random_range(0..2)];
        let q = -(f64::EPSILON / 2.0) * if rng.random_bool(0.5) { 1.0 + off } else { 1.0 - off };
        let [y, z] = [0; 2].map(|_| rng.random_range(1.0..4.0));
        let shapes = [
            vec![[x, 0.0, 0.0]],
            vec![[x, -y, 0.0], [x, y, 0.0]],
            vec![[x, -y, -z], [x, y, -z], [x, 0.0, z]],
            vec![[x, -y, -z], [x, y, z]],
        ];
        for shape in shapes {
            stages[check([q, 0.0, 0.0], &[shape], &mut rng).decided_by as usize] += 1;
        }
    }
    assert!(stages.iter().all(|count| cases.have_more_than(1000, *count)), "{stages:?}");
}

/// The claims have zero weights, or are on the border of the range of the first stage.
#[test]
fn the_border_of_the_fast_stage_is_no_border_of_the_truth() {
    check_relatives("certified border", cases(3000, 300), |mut rng| {
        let mut point = |most: i32| -> V3 {
            let v = vector(&mut rng);
            std::array::from_fn(|k| {
                let e = if rng.random_bool(0.5) { rng.random_range(90..110) } else { rng.random_range(0..most) };
                (v[k] * 8.0).round() * 2f64.powi(if most < 120 { e } else { -e })
            })
        };
        let most = if point(2)[0] > 0.0 { 119 } else { 300 };
        (point(most), vec![point(most), point(most), point(most)])
    });
}

#[test]
fn roots_of_small_integers_round_as_the_processor_does() {
    for n in 0..3000 {
        let shape = [[f64::from(n), f64::from(n % 7), f64::from(n % 3)]];
        let square = f64::from(n * n + (n % 7) * (n % 7) + (n % 3) * (n % 3));
        let exact = rational::Square::new([0.0; 3], &shape, Feature::Face, false).distance();
        assert_eq!(exact.nearest, square.sqrt());
        assert_eq!(decide([0.0; 3], &[candidate(&shape)]).distance.nearest, square.sqrt());
    }
}
