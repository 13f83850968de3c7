//! Checks the promises of approximate answers for every backend, option and scalar: the error is as requested, the
//! lower bound does not exceed the distance, and the answer is exact wherever the option allows no error.
//!
//! `P2M_DEEP=200 cargo test --profile deep --test all approximate` checks more than ten million answers.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::Point3;
use p2m::core::{Best, IndexStats};
use p2m::scene::generate::Kind;
use p2m::{
    AabbTree, BruteForce, CertifiedQuery, Closest, ClosestPoint, KdopTree, OctreeIndex, P2mIndex, Primitive,
    PrimitiveSet, QueryOptions, Real, Soup,
};
use p2m_testkit::near_check::compared_fields;
use p2m_testkit::oracle::Distance;
use p2m_testkit::scenes::{self, KINDS, LAYOUTS, narrow};
use p2m_testkit::{amount, cases};
use rand::{Rng, RngExt};
use std::sync::Mutex;

/// The exponents of the scales of scenes; the last two exceed the range of f32.
const EXPONENTS: [i32; 3] = [0, -350, 450];

/// An index with counters.
trait Index<T: Real>: ClosestPoint<T> + IndexStats<T> + Sync {}
impl<T: Real, I: ClosestPoint<T> + IndexStats<T> + Sync> Index<T> for I {}

struct Case<'a, T: Real> {
    soup: &'a Soup<T>,
    name: &'a str,
    index: &'a dyn Index<T>,
    query: Point3<T>,
    exact: Closest<T>,
    /// The exact answer to the same query.
    truth: Closest<T>,
    /// The number of lower bounds that only rational arithmetic could decide, because they are so close.
    compared: &'a mut usize,
    checked: &'a mut usize,
}

impl<T: Real> Case<'_, T> {
    /// Queries the index and checks the promises of the answer.
    fn checked_answer(&mut self, options: &QueryOptions<T>) -> Closest<T> {
        let found = self.index.closest_point_with(&self.query, options).expect("there is something");
        let context = || format!("{}, {options:?} at {:?}: {found:?}, not {:?}", self.name, self.query, self.exact);
        assert!(found.lower_bound <= self.exact.distance && found.distance >= self.exact.distance, "{}", context());
        let projection = self.soup.get(found.primitive).project(&self.query);
        assert_eq!(
            T::round_from_f64(projection.key.distance()),
            found.distance,
            "{}: the distance of another primitive",
            context()
        );
        *self.checked += 1;
        if found.lower_bound > self.truth.lower_bound {
            *self.compared += 1;
            let vertices: Vec<[f64; 3]> = (self.soup.get(self.truth.primitive).vertices().iter())
                .map(|v| v.map(|x| x.to_f64()).coords.into())
                .collect();
            let distance = Distance::new(self.query.map(|x| x.to_f64()).coords.into(), &vertices);
            assert!(distance.is_at_least(found.lower_bound.to_f64()), "{}: the bound is too large", context());
        }
        found
    }

    fn check(&mut self) {
        let defaults = QueryOptions::default();
        let exact = self.exact;
        let u = T::UNIT_ROUNDOFF;
        let (distance, rounding) = (exact.distance.to_f64(), (exact.distance - exact.lower_bound).to_f64());
        for epsilon in [1e-9, 0.001, 0.03, 0.3, 3.0] {
            let found = self.checked_answer(&defaults.with_epsilon(T::round_from_f64(epsilon)));
            let max_distance = (1.0 + epsilon) * (1.0 + 8.0 * u);
            let reached = found.distance.to_f64();
            assert!(
                reached <= distance * max_distance + T::SMALLEST_SUBNORMAL,
                "{}: {epsilon}: {found:?}, {exact:?}",
                self.name
            );
            // The lower bound proves the requested error, up to the rounding of candidates.
            let proved = (found.lower_bound.to_f64() + 4.0 * rounding) * max_distance * (1.0 + 8.0 * u);
            assert!(
                reached <= proved + T::SMALLEST_SUBNORMAL,
                "{}: {epsilon}: bound of {found:?}, {exact:?}",
                self.name
            );
        }
        for budget in [0, 1, 3, 10, 100] {
            self.checked_answer(&defaults.with_max_visits(budget));
        }
        let found = self.checked_answer(&defaults.with_max_visits(u32::MAX - 1));
        assert_eq!(compared_fields(&found), compared_fields(&exact), "{}: a budget for everything", self.name);
        // Within a radius that allows no error, the answer is the nearest primitive.
        let options = defaults.with_epsilon(T::round_from_f64(0.5));
        let found = self.checked_answer(&options.with_max_distance(exact.distance));
        assert!(found.distance == exact.distance, "{}: {found:?}, {exact:?}", self.name);
        let short = exact.distance.to_f64() * 0.99;
        if short < distance {
            let options = options.with_max_distance(T::round_from_f64(short)).with_max_visits(5);
            assert_eq!(self.index.closest_point_with(&self.query, &options), None, "{}: beyond the radius", self.name);
        }
    }
}

fn check_scene<T: Real>(soup: &Soup<T>, queries: &[Point3<T>], counts: &mut [usize; 2]) {
    let brute = BruteForce::new(soup).expect("valid");
    let tree = AabbTree::new(soup).expect("valid");
    let kdop = KdopTree::<T, _, 14>::new(soup).expect("valid");
    let octree = OctreeIndex::new(soup).expect("valid");
    let p2m = P2mIndex::new(soup).expect("valid");
    let indexes: [(&str, &dyn Index<T>); 4] = [("aabb", &tree), ("kdop", &kdop), ("octree", &octree), ("p2m", &p2m)];
    for query in queries {
        let Some(exact) = tree.closest_point(query) else { continue };
        let truth = tree.certified_closest_point(query, &Default::default()).expect("vertices").expect("found");
        // Brute force may ignore options that allow an error.
        if soup.len() < 1000 {
            let rough = QueryOptions::default().with_max_visits(0).with_epsilon(T::round_from_f64(1.0));
            let found = brute.closest_point_with(query, &rough).map(|c| compared_fields(&c));
            assert_eq!(found, Some(compared_fields(&exact)), "brute force at {query:?}");
        }
        for (name, index) in indexes {
            let [checked, compared] = counts;
            Case { soup, name, index, query: *query, exact, truth, compared, checked }.check();
        }
    }
}

/// Returns the first primitives of scenes of all kinds.
fn sources() -> Vec<Soup<f64>> {
    let generated = Kind::all().into_iter().map(|kind| kind.generate().expect("default options"));
    let random = KINDS
        .into_iter()
        .flat_map(|kinds| LAYOUTS.map(|layout| (kinds, layout)))
        .map(|(kinds, layout)| scenes::soup(&mut p2m_testkit::rng("approximation", 0), kinds, layout, 400));
    let largest = amount(1200, 25);
    let first = |soup: Soup<f64>| {
        Soup::new(soup.positions().to_vec(), soup.elements().take(largest)).expect("of a valid scene")
    };
    // This scene has more slivers as candidates than the search can keep pending.
    let gear = std::iter::once(scenes::skewed_gear(amount(1500, 100)));
    generated.chain(random).map(first).chain(gear).collect()
}

/// Returns the numbers of checked answers and of bounds that rational arithmetic had to decide, in f64 and in f32.
fn check_scale(soup: &Soup<f64>, exponent: i32, rng: &mut impl Rng) -> [[usize; 2]; 2] {
    let [mut double, mut single] = [[0; 2]; 2];
    let scale = |p: &Point3<f64>| p.map(|x| x * 2f64.powi(exponent));
    let positions = soup.positions().iter().map(scale).collect();
    let scaled = Soup::new(positions, soup.elements()).expect("far from the ends");
    let queries: Vec<_> = (0..amount(9, 1)).map(|_| scale(&scenes::query(rng, soup.positions()))).collect();
    check_scene(&scaled, &queries, &mut double);
    if let Some(narrowed) = narrow(&scaled) {
        let queries: Vec<_> = queries.iter().map(|q| scenes::to_f32(*q)).collect();
        check_scene(&narrowed, &queries, &mut single);
    }
    [double, single]
}

/// Returns the choice out of `choices` for a case. The cases go through `count` sources in turns. After `choices`
/// rounds each source has had each choice, and each source begins with another choice than the previous one.
fn choice_of_source(case: u64, count: u64, choices: u64) -> usize {
    ((case % count + case / count) % choices) as usize
}

#[test]
fn approximate_answers_keep_what_they_promise() {
    let sources = sources();
    let count = sources.len() as u64;
    // The deep suite has every source at every scale, and the shallow suite has each source at one scale.
    let cases = cases(EXPONENTS.len() as u64 * count, count);
    let counts = Mutex::new([[0; 2]; 2]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = |first| {
        for case in cases.clone().skip(first).step_by(threads) {
            let (soup, exponent) = (&sources[(case % count) as usize], EXPONENTS[choice_of_source(case, count, 3)]);
            let [double, single] = check_scale(soup, exponent, &mut p2m_testkit::rng("approximation", case + 1));
            let mut counts = counts.lock().expect("no check failed");
            for (sum, count) in counts.as_flattened_mut().iter_mut().zip([double, single].as_flattened()) {
                *sum += count;
            }
        }
    };
    std::thread::scope(|scope| {
        for first in 0..threads {
            scope.spawn(move || work(first));
        }
    });
    let [double, single] = counts.into_inner().expect("no check failed");
    println!("answers, and lower bounds that rational arithmetic had to tell: {double:?} in f64, {single:?} in f32");
    // Each query has twelve answers from each of four backends.
    assert!(cases.have_more_than(amount(39_999, 140 * sources.len()), double[0] + single[0]), "{double:?}, {single:?}");
}

/// If there are more candidates than can be pending, some are evaluated before the search ends. The incumbent of that
/// evaluation is then only a bound for the others.
#[test]
fn slivers_side_by_side_keep_epsilon() {
    let soup = scenes::skewed_gear(amount(3000, 800));
    let tree = AabbTree::new(&soup).expect("valid");
    for case in cases(40_000, 1_500) {
        let mut rng = p2m_testkit::rng("slivers side by side", case);
        let query = Point3::from([0; 3].map(|_| rng.random_range(-1.2..1.2)));
        let exact = tree.closest_point(&query).expect("found");
        for epsilon in [0.001, 0.01] {
            let found = tree.closest_point_with(&query, &QueryOptions::default().with_epsilon(epsilon)).expect("found");
            let max_distance = exact.distance * (1.0 + epsilon) * (1.0 + f64::EPSILON);
            assert!(found.distance <= max_distance, "case {case}: {epsilon} at {query:?}: {found:?}, {exact:?}");
            assert!(found.lower_bound <= exact.distance, "case {case}: {epsilon} at {query:?}: {found:?}, {exact:?}");
        }
    }
}

/// A search exceeds its budget only on the path to a first answer, and a larger budget never gives a worse answer.
#[test]
fn budgets_are_kept_and_pay() {
    let options = p2m::scene::generate::TorusKnot::default();
    let options = amount(options, p2m::scene::generate::TorusKnot { rings: 60, sides: 8, ..options });
    let soup = p2m::scene::generate::torus_knot(&options).expect("valid options");
    let tree = AabbTree::new(&soup).expect("valid");
    let octree = OctreeIndex::new(&soup).expect("valid");
    let p2m = P2mIndex::new(&soup).expect("valid");
    let indexes: [(&str, &dyn Index<f64>); 3] = [("aabb", &tree), ("octree", &octree), ("p2m", &p2m)];
    let mut rng = p2m_testkit::rng("budgets", 0);
    let queries: Vec<_> =
        (0..amount(300, 100)).map(|_| Point3::from([0; 3].map(|_| rng.random_range(-1.5..1.5)))).collect();
    for (name, index) in indexes {
        let (mut least, mut errors) = ([usize::MAX; 2], Vec::new());
        for budget in [0, 4, 16, 64, 256] {
            let mut error = 0.0;
            for query in &queries {
                let options = QueryOptions::default().with_max_visits(budget);
                let mut best = Best::new(&options);
                index.search(query, &mut best);
                let [nodes, packets, primitives] = best.counts();
                let visits = nodes + packets;
                // The path leads from the root to a packet, or over the sites to a cell.
                assert!(visits <= budget as usize + 20, "{name}: {visits} visits for {budget}");
                least = [least[0].min(visits), least[1].min(primitives)];
                let found = best.finish().expect("found");
                error += found.distance / index.closest_point(query).expect("found").distance - 1.0;
            }
            errors.push(error / queries.len() as f64);
        }
        println!("{name}: mean relative errors {errors:?}, at least {least:?} visits and primitives");
        assert!(errors.is_sorted_by(|more, less| more >= less), "{name}: {errors:?}");
        assert!(errors[4] < 1e-3, "{name}: {errors:?}");
    }
}

/// The answer of a cell with a single primitive is exact and certified as such, for any options.
#[test]
fn what_is_certain_leaves_nothing_open() {
    let mut rng = p2m_testkit::rng("certain cells", 0);
    let soup = scenes::soup(&mut rng, scenes::Kinds::Triangles, scenes::Layout::Uniform, 300);
    let index = P2mIndex::new(&soup).expect("valid");
    let mut exact = 0;
    for _ in 0..200 {
        let query = Point3::from([0; 3].map(|_| rng.random_range(-4.0..4.0)));
        let expected = index.closest_point(&query).expect("found");
        let options = QueryOptions::default().with_max_visits(0);
        let found = index.closest_point_with(&query, &options).expect("found");
        exact += usize::from(found == expected);
    }
    println!("{exact} of 200 first guesses have the bound of an exact answer");
    assert!(exact > 20, "{exact}");
}
