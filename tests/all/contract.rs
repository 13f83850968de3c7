//! Checks the accuracy contract (N1, N4, N5, N6 of `ClosestPoint`) on isolated primitives against exact rational
//! arithmetic.
//!
//! The primitives are isolated, because in a mesh the neighbours hide the errors of a kernel. A failure prints the seed
//! of its case.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]
#![allow(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]

use nalgebra::Point3;
use p2m::core::Key;
use p2m::core::Projection;
use p2m::{BruteForce, Shape};
use p2m::{Closest, ClosestPoint, Feature, Point, Primitive, PrimitiveSet, QueryOptions, Real};
use p2m_testkit::contract::{self, MAX_OBSERVED_ERROR};
use p2m_testkit::families::{self, Case, Span, shape};
use p2m_testkit::{cases, oracle::Distance, rng};

fn project<T: Real>(query: [T; 3], vertices: &[[T; 3]]) -> Projection {
    shape(vertices).project(&query.into())
}

fn answer<T: Real>(query: [T; 3], vertices: &[[T; 3]]) -> Closest<T> {
    BruteForce::new([shape(vertices)]).expect("finite").closest_point(&Point3::from(query)).expect("one primitive")
}

fn case(name: &str, seed: u64) -> Case {
    families::case(&mut rng(name, seed))
}

/// Generates a case in the range of f32.
fn single_case(name: &str, seed: u64) -> (Case, [f32; 3], Vec<[f32; 3]>) {
    let case = families::case_in(&mut rng(name, seed), &Span::F32);
    let single = |v: [f64; 3]| v.map(|x| x as f32);
    let (query, vertices) = (single(case.query), case.vertices.iter().map(|v| single(*v)).collect());
    (case, query, vertices)
}

/// Panics with the data that reproduce a case unless the condition holds.
macro_rules! require {
    ($condition:expr, $seed:expr, $case:expr, $($detail:tt)+) => {
        assert!($condition, "seed {}: {}\n{:?}", $seed, format_args!($($detail)+), $case);
    };
}

fn check_answer<T: Real>(seed: u64, case: &Case, query: [f64; 3], vertices: &[[f64; 3]], found: &Closest<T>) -> f64 {
    contract::check(query, vertices, found).unwrap_or_else(|broken| panic!("seed {seed}: {broken}\n{case:?}"))
}

#[test]
fn n1_n5_hold_for_every_family_in_f64() {
    let mut worst = (0.0, 0);
    let cases = cases(400_000, 5_000);
    for seed in cases.clone() {
        let case = case("contract f64", seed);
        let found = answer(case.query, &case.vertices);
        let error = check_answer(seed, &case, case.query, &case.vertices, &found);
        if error > worst.0 {
            worst = (error, seed);
        }
    }
    let family = case("contract f64", worst.1).family;
    println!("{} cases in f64, largest error {:.3} u M (seed {}: {family})", cases.len(), worst.0, worst.1);
}

#[test]
fn n1_n5_hold_for_every_family_in_f32() {
    let mut worst = (0.0, 0);
    let cases = cases(300_000, 5_000);
    for seed in cases.clone() {
        let (case, query, vertices) = single_case("contract f32", seed);
        let found = answer(query, &vertices);
        let error = check_answer(seed, &case, case.query, &case.vertices, &found);
        if error > worst.0 {
            worst = (error, seed);
        }
    }
    println!("{} cases in f32, largest error {:.3} u M (seed {})", cases.len(), worst.0, worst.1);
}

#[test]
fn n4_order_and_scale_change_no_bit_in_either_scalar() {
    let mut compared = [0; 2];
    let cases = cases(40_000, 1_500);
    for seed in cases.clone() {
        let rng = &mut rng("contract order and scale", seed);
        let case = case("contract invariance", seed);
        let found = answer(case.query, &case.vertices);
        compared[0] += contract::check_invariance(rng, case.query, &case.vertices, &found)
            .unwrap_or_else(|broken| panic!("seed {seed}: {broken}\n{case:?}"));
        let (case, query, vertices) = single_case("contract invariance in f32", seed);
        let found = answer(query, &vertices);
        compared[1] += contract::check_invariance(rng, query, &vertices, &found)
            .unwrap_or_else(|broken| panic!("seed {seed}: {broken}\n{case:?}"));
    }
    println!("{compared:?} of {} cases, at most two each", cases.len());
    assert!(compared.iter().all(|count| cases.have_more_than(45_000, *count as usize)), "{compared:?}");
}

/// Scaling by 2^e changes only the exponents, as long as all numbers stay normal.
#[test]
fn n4_scaling_by_powers_of_two_changes_no_bit() {
    let normal = |x: f64| x == 0.0 || x.is_normal();
    let mut compared = 0;
    let cases = cases(60_000, 1_500);
    for seed in cases.clone() {
        let mut case = case("contract scaling", seed);
        // Each case is brought to a scale of about one first, whatever its family.
        let size = case.vertices.as_flattened().iter().chain(&case.query).fold(0.0, |m: f64, x| m.max(x.abs()));
        if !size.is_normal() {
            continue;
        }
        let to_one = size.log2().floor() as i32;
        let scale = |v: [f64; 3], e: i32| v.map(|x| x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2));
        case.query = scale(case.query, -to_one);
        case.vertices = case.vertices.iter().map(|v| scale(*v, -to_one)).collect();
        let unscaled = answer(case.query, &case.vertices);
        for e in [-900, -510, -300, -251, -249, -40, 1, 40, 248, 252, 300, 510, 900] {
            let query = scale(case.query, e);
            let vertices: Vec<_> = case.vertices.iter().map(|v| scale(*v, e)).collect();
            let scaled = answer(query, &vertices);
            let results = scaled.point.iter().chain([&scaled.distance]).chain(&scaled.barycentric);
            let pairs =
                query.iter().zip(&case.query).chain(vertices.as_flattened().iter().zip(case.vertices.as_flattened()));
            let stays_normal = pairs.into_iter().all(|(x, y)| normal(*x) && normal(*y) && (*x == 0.0) == (*y == 0.0));
            if !stays_normal || !results.into_iter().all(|x| normal(*x)) {
                continue;
            }
            compared += 1;
            let expected = scale([unscaled.distance, 0.0, 0.0], e)[0];
            require!(
                scaled.distance == expected,
                seed,
                case,
                "2^{e}: distance {:e}, not {expected:e}",
                scaled.distance
            );
            require!(
                scaled.feature == unscaled.feature,
                seed,
                case,
                "2^{e}: {:?}, not {:?}",
                scaled.feature,
                unscaled.feature
            );
            let point: [f64; 3] = unscaled.point.coords.into();
            require!(scaled.point == scale(point, e).into(), seed, case, "2^{e}: another point");
            require!(scaled.barycentric == unscaled.barycentric, seed, case, "2^{e}: other weights");
        }
    }
    assert!(cases.have_more_than(300_000, compared), "{compared}");
}

#[test]
fn n4_the_order_of_vertices_changes_no_bit() {
    for seed in cases(100_000, 3_000) {
        let case = case("contract permutation", seed);
        let unscaled = answer(case.query, &case.vertices);
        let n = case.vertices.len();
        let permutations: &[[usize; 3]] = &[[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        for p in permutations.iter().filter(|p| p[n..].iter().all(|i| *i >= n)) {
            let vertices: Vec<_> = p[..n].iter().map(|i| case.vertices[*i]).collect();
            let scaled = answer(case.query, &vertices);
            require!(
                scaled.distance == unscaled.distance,
                seed,
                case,
                "{p:?}: {:e}, not {:e}",
                scaled.distance,
                unscaled.distance
            );
            require!(scaled.point == unscaled.point, seed, case, "{p:?}: {} is not {}", scaled.point, unscaled.point);
        }
    }
}

/// Checks K1: keys of vertices and edges have the same bits in every primitive that contains them.
#[test]
fn shared_features_have_the_same_key_in_every_primitive() {
    let mut faces = 0;
    let cases = cases(200_000, 5_000);
    for seed in cases.clone() {
        let case = case("contract features", seed);
        let [a, b, c] = case.vertices[..] else { continue };
        let triangle = project(case.query, &[a, b, c]);
        let edges = [[a, b], [b, c], [c, a]].map(|e| project(case.query, &e).key);
        let points = [a, b, c].map(|v| project(case.query, &[v]).key);
        let min_key = |keys: &[Key]| *keys.iter().min().expect("three keys");
        let expected = match triangle.feature {
            Feature::Vertex(i) => points[usize::from(i)],
            Feature::Edge(i) => edges[usize::from(i)],
            Feature::Face => triangle.key,
        };
        faces += usize::from(triangle.feature == Feature::Face);
        require!(triangle.key == expected, seed, case, "key of {:?} differs", triangle.feature);
        require!(triangle.key <= min_key(&edges), seed, case, "an edge is nearer");
        require!(min_key(&edges) <= min_key(&points), seed, case, "a vertex is nearer");
    }
    assert!(cases.have_more_than(10_000, faces), "{faces}");
}

/// Searches pass a bound for pruning to the kernel. The kernel may then stop early, but never returns another value.
#[test]
fn a_bound_ends_the_work_only_beyond_the_key() {
    let (mut ended, mut beyond) = (0, 0);
    let cases = cases(200_000, 5_000);
    for seed in cases.clone() {
        let case = case("contract within", seed);
        let (shape, query) = (shape(&case.vertices), Point3::from(case.query));
        let full = shape.project(&query);
        let square = full.key.square_above();
        for factor in [0.0, 0.5, 1.0 - 1e-9, 1.0 - f64::EPSILON, 1.0, 1.0 + f64::EPSILON, 2.0, f64::INFINITY] {
            let bound = if factor == 0.0 { 0.0 } else { square * factor };
            match shape.project_within(&query, bound) {
                Some(found) => {
                    require!(found == full, seed, case, "bound {factor}: {found:?}, not {full:?}");
                }
                None => {
                    require!(square > bound, seed, case, "ended below the bound, factor {factor}");
                    ended += 1;
                }
            }
            beyond += usize::from(square > bound);
        }
    }
    println!("{ended} of {beyond} ended early");
    // The scaled path never stops early, and neither do bounds within the margin of an estimate.
    assert!(cases.is_replay() || ended > beyond / 4, "the bound saves little: {ended} of {beyond}");
}

#[test]
fn a_point_is_a_degenerate_segment_and_a_degenerate_triangle() {
    for seed in cases(100_000, 3_000) {
        let case = case("contract degenerate", seed);
        let (q, v) = (case.query, case.vertices[0]);
        let one = project(q, &[v]);
        for same in [vec![v; 2], vec![v; 3]] {
            let other = project(q, &same);
            require!(other.key == one.key && other.point == one.point, seed, case, "{same:?}");
        }
        if let [a, b, ..] = case.vertices[..] {
            let segment = project(q, &[a, b]);
            for flat in [[a, b, a], [a, b, b], [b, a, a], [a, a, b]] {
                let other = project(q, &flat);
                require!(other.key == segment.key && other.point == segment.point, seed, case, "{flat:?}");
            }
        }
    }
}

/// Checks triangles on a 3x3x3 lattice with all queries on it, in integers. The deep suite checks all such triangles.
#[test]
fn every_triangle_of_a_small_lattice_is_answered_exactly() {
    let lattice: Vec<[f64; 3]> = (0..27).map(|i| [f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)]).collect();
    let mut corners = Vec::new();
    for i in 0..27 {
        for j in i..27 {
            corners.extend((j..27).map(|k| [i, j, k]));
        }
    }
    assert_eq!(corners.len(), 3654);
    let mut worst = 0.0f64;
    let cases = cases(3654, 240);
    for case in cases.clone() {
        // A step without a common divisor reaches all triangles, and few steps reach triangles of every kind.
        let t = corners[(case as usize).wrapping_mul(1009) % corners.len()].map(|i| lattice[i]);
        for q in &lattice {
            let found = answer(*q, &t);
            let exact = Distance::new(*q, &t);
            worst = worst.max(exact.error(found.distance, 53, 0.0));
            // The squared distances are fractions with small denominators. A wrong region would be off by at least a
            // hundredth, so the nearest feature of exact arithmetic must have been found.
            let feature: Vec<[f64; 3]> = match found.feature {
                Feature::Vertex(v) => vec![t[usize::from(v)]],
                Feature::Edge(e) => vec![t[usize::from(e)], t[(usize::from(e) + 1) % 3]],
                Feature::Face => t.to_vec(),
            };
            assert!(Distance::new(*q, &feature).compare(&exact).is_eq(), "{q:?} {t:?} {:?}", found.feature);
            let lower: Vec<Vec<[f64; 3]>> = match found.feature {
                Feature::Vertex(_) => vec![],
                Feature::Edge(_) => t.iter().map(|v| vec![*v]).collect(),
                Feature::Face => (0..3).map(|e| vec![t[e], t[(e + 1) % 3]]).collect(),
            };
            for f in lower {
                assert!(Distance::new(*q, &f).compare(&exact).is_gt(), "{q:?} {t:?}: {f:?} holds the point");
            }
            // Translating by integers, mirroring and rotating the case moves the point and changes nothing else.
            let moved = |v: [f64; 3]| [v[0] + 1048576.0, v[1] - 4096.0, v[2] + 3.0];
            let turned = |v: [f64; 3]| [2.0 - v[1], v[2], v[0]];
            assert_eq!(answer(moved(*q), &t.map(moved)).distance, found.distance);
            let other = answer(turned(*q), &t.map(turned)).distance;
            assert!(exact.error(other, 53, 0.0) <= MAX_OBSERVED_ERROR, "{q:?} {t:?}");
        }
    }
    println!("{} lattice queries, largest error {worst:.3} u M", 27 * cases.len());
    assert!(worst <= MAX_OBSERVED_ERROR);
}

/// Checks the named examples that other libraries got wrong.
#[test]
fn known_failures_of_other_projects_are_answered() {
    // A query at 1e-170 from the corner of a unit triangle makes squares underflow.
    let t = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let d = answer([-1e-170, -1e-170, 0.0], &t).distance;
    assert!((d / 1e-170 - 2f64.sqrt()).abs() < 1e-15, "{d:e}");
    // The coordinates are at both ends of the range: the difference overflows, the distance does not.
    let ends = [[-f64::MAX, 0.0, 0.0], [f64::MAX, 0.0, 0.0]];
    let found = answer([f64::MAX, 3e300, 0.0], &ends);
    assert_eq!(found.distance, 3e300);
    let found = answer([1e307, 3e300, 0.0], &ends);
    assert!((found.distance / 3e300 - 1.0).abs() < 1e-3 || found.distance <= 4.0 * f64::EPSILON * f64::MAX);
    assert!(found.point.iter().all(|x| x.is_finite()));
    // The distance is not representable and becomes infinite, but the nearer primitive is still found.
    let far = [Point::new(Point3::new(f64::MAX, f64::MAX, f64::MAX)), Point::new(Point3::new(f64::MAX, f64::MAX, 0.0))];
    let index = BruteForce::new(far).expect("finite");
    let found = index.closest_point(&Point3::new(-f64::MAX, -f64::MAX, 0.0)).expect("not empty");
    assert_eq!((found.distance, found.primitive.index()), (f64::INFINITY, 1));
    // A collinear triangle has the answers of its edges.
    let flat = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
    assert_eq!(answer([4.0, 3.0, 3.0], &flat).distance, 1.0);
}

/// Checks cases that earlier versions of the kernel got wrong, and cases that would fail without one of its steps.
#[test]
fn past_failures_stay_mended() {
    let error = |q: [f64; 3], v: &[[f64; 3]]| Distance::new(q, v).error(project(q, v).key.distance(), 53, 0.0);
    let origin = [0.0; 3];
    // Both ends of a tiny edge round to the same distance, so the wrong end seems nearer. The estimate of a projection
    // far beyond the other end must not exclude the edge that has the answer. The error was once 1e14 u M.
    assert!(error([1.0, -5.0, 0.0], &[origin, [2f64.powi(-53), 0.0, 0.0], [2.0, 0.1, 0.0]]) <= MAX_OBSERVED_ERROR);
    let (q, t) = (
        [1.351079888211149e16, -562949953421315.0, -5629499534213118.0],
        [[-1.0, 3.0, -4.0], [3.0, -1.0, 6.0], [2.0, -5.0, 4.0]],
    );
    assert_eq!(project(q, &t).key, project(q, &t[..2]).key);
    // Heights are 2^-55 to 2^-50 of the longest edge, so the first weights are far off and must not be multiplied by
    // long sides. The error was once 30 u M.
    let q = [-0.015273819676656053, -0.2878166238002008, 0.28597550426703106];
    let a = [-0.037468572102620945, -0.7088830678307931, 0.7043301088604648];
    assert!(
        error(q, &[a, origin, [-0.037468571763492366, -0.7088830614146825, 0.7043301024855632]]) <= MAX_OBSERVED_ERROR
    );
    let q = [0.22352065081639855, 0.14915974621314368, 0.18765167798631388];
    let a = [0.681975043702849, 0.4550954199125677, 0.5725366351082702];
    assert!(
        error(q, &[origin, a, [0.6819542314761735, 0.45508153150253616, 0.5725191626767789]]) <= MAX_OBSERVED_ERROR
    );
    let q = [0.032630187874821345, 0.28102950424171574, 0.37507717682698066];
    let a = [0.06945341662019783, 0.5981718314202142, 0.7983524804340297];
    assert!(
        error(q, &[origin, a, [0.033614149441385084, 0.2895039338804641, 0.3863876089920929]]) <= MAX_OBSERVED_ERROR
    );
    // Without the second projection on an edge the error is 3.2 u M.
    let q = [-216365.202532822, -104996.10677091136, 86085.36384840212];
    let a = [0.05437519627965304, 0.8861508897723058, -0.25455041204516715];
    assert!(error(q, &[a, [-444089.36260986526, -215505.30942860627, 176690.36866632823]]) < 3.0);
    // Whether a weight is zero is decided at the scale of the triangle, because products of four lengths underflow at
    // 2^-249.
    let q = [0.40714549371745673, -0.9133631636166474, 0.0005275355512286034];
    let t = [
        origin,
        [0.40714549371745673, -0.9133631636166474, 0.000527535551228604],
        [0.40820166434240773, -0.9128927466441797, -0.0010466019827892192],
    ];
    let at = |e: i32| project(q.map(|x| x * 2f64.powi(e)), &t.map(|v| v.map(|x| x * 2f64.powi(e))));
    assert_eq!((at(-249).feature, at(-249).key.distance()), (at(0).feature, at(0).key.distance() * 2f64.powi(-249)));
    // A length at the end of the plain range has one key in all primitives.
    let x = [2f64.powi(400), 0.0, 0.0];
    assert_eq!(project(origin, &[x]).key, project(origin, &[x, x]).key);
}

#[test]
fn n6_queries_that_are_not_finite_have_no_answer() {
    let index = BruteForce::new([shape(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])]).expect("finite");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut q = Point3::new(1.0, 2.0, 3.0);
            q[axis] = bad;
            assert_eq!(index.closest_point(&q), None);
        }
    }
    let none = BruteForce::new(Vec::<Shape<f64>>::new()).expect("empty sets are fine");
    assert_eq!(none.closest_point(&[0.0; 3]), None);
    let set: &dyn Fn() -> usize = &|| PrimitiveSet::<f64>::len(&Vec::<Shape<f64>>::new());
    assert_eq!(set(), 0);
}

#[test]
fn the_radius_is_inclusive_on_the_reported_distance() {
    for seed in cases(50_000, 3_000) {
        let case = case("contract radius", seed);
        let index = BruteForce::new([shape(&case.vertices)]).expect("finite");
        let q = Point3::from(case.query);
        let found = index.closest_point(&q).expect("one primitive");
        let at = |r: f64| index.closest_point_with(&q, &QueryOptions::default().with_max_distance(r));
        require!(at(found.distance) == Some(found), seed, case, "lost at its own distance {:e}", found.distance);
        if found.distance > 0.0 {
            let below = found.distance.next_down();
            require!(at(below).is_none(), seed, case, "found beyond {below:e}");
        }
        require!(at(f64::NAN).is_none() && at(-1.0).is_none(), seed, case, "no radius at all");
    }
}
