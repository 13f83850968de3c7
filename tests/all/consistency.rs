//! Compares every backend with brute force in every kind of query, on scenes that proptest shrinks. A failure prints
//! the smallest scene that it finds, as Rust source.
//!
//! A scene has some primitives of a large one. The large scenes are one from each generator, and a random one of each
//! kind and layout.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::Point3;
use p2m::scene::generate::Kind;
use p2m::{
    Aabb, AabbTree, BoxQuery, BruteForce, Closest, ClosestPoint, Element, KdopTree, NearQuery, OctreeIndex, P2mIndex,
    PrimitiveId, PrimitiveSet, QueryOptions, RayQuery, Real, Soup,
};
use p2m_testkit::near_check::compared_fields;
use p2m_testkit::rays::{self, AIMS};
use p2m_testkit::scenes::{self, KINDS, LAYOUTS, narrow};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use std::fmt::{self, Debug, Formatter};
use std::sync::LazyLock;

/// The large scenes from which cases take primitives.
static SOURCES: LazyLock<Vec<Soup<f64>>> = LazyLock::new(|| {
    let generated = Kind::all().into_iter().map(|kind| kind.generate().expect("default options"));
    let random = KINDS
        .into_iter()
        .flat_map(|kinds| LAYOUTS.map(|layout| (kinds, layout)))
        .map(|(kinds, layout)| scenes::soup(&mut p2m_testkit::rng("sources", 0), kinds, layout, 400));
    generated.chain(random).collect()
});

/// A scene with queries, which prints as Rust source.
#[derive(Clone)]
struct Case {
    soup: Soup<f64>,
    queries: Vec<Point3<f64>>,
    /// The seed of radii, hints, boxes and rays.
    seed: u64,
}

impl Debug for Case {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let write_point =
            |f: &mut Formatter<'_>, p: &Point3<f64>| write!(f, "Point3::new({:?}, {:?}, {:?})", p.x, p.y, p.z);
        writeln!(f, "\nlet soup = Soup::new(\n    vec![")?;
        for p in self.soup.positions() {
            write!(f, "        ")?;
            write_point(f, p)?;
            writeln!(f, ",")?;
        }
        writeln!(f, "    ],\n    [")?;
        for element in self.soup.elements() {
            writeln!(f, "        Element::{element:?},")?;
        }
        writeln!(f, "    ],\n)\n.unwrap();")?;
        for query in &self.queries {
            write!(f, "let query = ")?;
            write_point(f, query)?;
            writeln!(f, ";")?;
        }
        write!(f, "let seed = {};", self.seed)
    }
}

/// Returns some primitives of a scene, with their vertices.
fn part(source: &Soup<f64>, chosen: &[usize]) -> Soup<f64> {
    let mut soup = Soup::default();
    let mut numbers = std::collections::HashMap::new();
    for id in chosen {
        let element = source.element(PrimitiveId::new(id % source.len()));
        let mut number = |i: u32| {
            let copy = *numbers.entry(i).or_insert_with(|| soup.push_position(source.positions()[i as usize]));
            u32::try_from(copy).expect("few vertices")
        };
        let element = match element {
            Element::Triangle(t) => Element::Triangle(t.map(&mut number)),
            Element::Segment(s) => Element::Segment(s.map(&mut number)),
            Element::Point(p) => Element::Point(number(p)),
        };
        soup.push(element).expect("of a valid scene");
    }
    soup
}

fn case() -> impl Strategy<Value = Case> {
    let source = 0..SOURCES.len();
    let chosen = prop::collection::vec(0..100_000usize, 0..60);
    let exponent = prop_oneof![8 => Just(0), 1 => -900..900i32];
    let queries = prop::collection::vec(any::<u64>(), 1..4);
    (source, chosen, exponent, queries, any::<u64>()).prop_map(|(source, chosen, exponent, queries, seed)| {
        let scale = |p: Point3<f64>| p.map(|x| x * 2f64.powi(exponent));
        let soup = part(&SOURCES[source], &chosen);
        let queries = queries
            .into_iter()
            .map(|seed| scale(scenes::query(&mut p2m_testkit::rng("consistency", seed), soup.positions())))
            .filter(|query| query.iter().all(|x| x.is_finite()))
            .collect();
        let positions = soup.positions().iter().map(|p| scale(*p)).collect();
        Case { soup: Soup::new(positions, soup.elements()).expect("far from the ends"), queries, seed }
    })
}

/// An index with the queries that all backends answer.
trait Index<T: Real>: ClosestPoint<T> + NearQuery<T> {}
impl<T: Real, I: ClosestPoint<T> + NearQuery<T>> Index<T> for I {}

/// An index with all kinds of queries.
trait Tree<T: Real>: Index<T> + RayQuery<T> + BoxQuery<T> {}
impl<T: Real, I: Index<T> + RayQuery<T> + BoxQuery<T>> Tree<T> for I {}

fn all<T: Real>(closest: &[Closest<T>]) -> impl PartialEq + Debug + use<T> {
    closest.iter().map(compared_fields).collect::<Vec<_>>()
}

fn check<T: Real>(case: &Case, soup: &Soup<T>, point: impl Fn(&Point3<f64>) -> Point3<T>) -> Result<(), TestCaseError> {
    let brute = BruteForce::new(soup).expect("valid");
    let tree = AabbTree::new(soup).expect("valid");
    let kdop = KdopTree::<T, _, 14>::new(soup).expect("valid");
    let octree = OctreeIndex::new(soup).expect("valid");
    let p2m = P2mIndex::new(soup).expect("valid");
    let indexes: [(&str, &dyn Index<T>); 4] = [("aabb", &tree), ("kdop", &kdop), ("octree", &octree), ("p2m", &p2m)];
    for query in case.queries.iter().map(&point) {
        let expected = brute.closest_point(&query);
        let radius = expected.map_or(T::one(), |c| c.distance) * T::round_from_f64(1.0 + (case.seed % 3) as f64 * 0.3);
        let hint = PrimitiveId::new(case.seed as usize % (soup.len() + 1));
        let options = QueryOptions::default().with_max_distance(radius).with_hint(hint);
        let odd = |id: PrimitiveId| (id.index() as u64 ^ case.seed).is_multiple_of(3);
        for (name, index) in indexes {
            let found = index.closest_point(&query);
            prop_assert_eq!(
                found.as_ref().map(compared_fields),
                expected.as_ref().map(compared_fields),
                "{}, {:?}",
                name,
                query
            );
            let (found, near) =
                (index.closest_point_with(&query, &options), brute.closest_point_with(&query, &options));
            prop_assert_eq!(
                found.as_ref().map(compared_fields),
                near.as_ref().map(compared_fields),
                "{}, {:?} within",
                name,
                query
            );
            let (found, nearest) = (index.k_nearest(&query, 3, radius), brute.k_nearest(&query, 3, radius));
            prop_assert_eq!(all(&found), all(&nearest), "{}, three nearest of {:?}", name, query);
            let (found, within) = (index.all_within(&query, radius), brute.all_within(&query, radius));
            prop_assert_eq!(all(&found), all(&within), "{}, all within {:?} of {:?}", name, radius, query);
            prop_assert_eq!(index.is_any_within(&query, radius), !within.is_empty(), "{}, any near {:?}", name, query);
            let among = |index: &dyn Index<T>| index.closest_point_among(&query, &options, &mut |id| odd(id));
            let (found, some) = (among(index), brute.closest_point_among(&query, &options, &mut |id| odd(id)));
            prop_assert_eq!(
                found.as_ref().map(compared_fields),
                some.as_ref().map(compared_fields),
                "{}, some near {:?}",
                name,
                query
            );
        }
    }
    let trees: [(&str, &dyn Tree<T>); 2] = [("aabb", &tree), ("kdop", &kdop)];
    let mut rng = p2m_testkit::rng("consistency boxes", case.seed);
    for query in &case.queries {
        let (a, b) = (point(query), point(&scenes::query(&mut rng, case.soup.positions())));
        let bounds = Aabb { min: a.inf(&b), max: a.sup(&b) };
        let sorted = |index: &dyn BoxQuery<T>| {
            let mut out = Vec::new();
            index.primitives_in_box_into(&bounds, &mut out);
            out.sort_unstable();
            out
        };
        for (name, tree) in trees {
            prop_assert_eq!(sorted(tree), sorted(&brute), "{}, in {:?}", name, bounds);
        }
    }
    if soup.is_empty() {
        return Ok(());
    }
    for aim in AIMS {
        let ray = rays::ray(&mut rng, &case.soup, &case.soup.aabb(), aim);
        for (name, tree) in trees {
            prop_assert_eq!(tree.first_intersection(&ray), brute.first_intersection(&ray), "{}, {:?}", name, ray);
            prop_assert_eq!(tree.all_intersections(&ray), brute.all_intersections(&ray), "{}, all of {:?}", name, ray);
            prop_assert_eq!(tree.count(&ray), brute.count(&ray), "{}, number of {:?}", name, ray);
            prop_assert_eq!(tree.crossings(&ray), brute.crossings(&ray), "{}, crossings of {:?}", name, ray);
        }
    }
    Ok(())
}

/// Runs a check on the same cases each time. Each case has its own runner, whose seed is the number of the case. So
/// `P2M_SEED` generates the same scene again, and a failure shrinks in the same steps.
fn on_all(check: impl Fn(&Case) -> Result<(), TestCaseError>) {
    for number in p2m_testkit::cases(1000, 24) {
        let config = ProptestConfig {
            cases: 1,
            // The default would shrink a failure in at most four steps for each case.
            max_shrink_iters: 4000,
            rng_seed: RngSeed::Fixed(number),
            failure_persistence: None,
            ..Default::default()
        };
        TestRunner::new(config).run(&case(), |case| check(&case)).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_backend_answers_every_query_as_brute_force_in_f64() {
    on_all(|case| check(case, &case.soup, |p| *p));
}

#[test]
fn every_backend_answers_every_query_as_brute_force_in_f32() {
    on_all(|case| narrow(&case.soup).map_or(Ok(()), |soup| check(case, &soup, |p| scenes::to_f32(*p))));
}

#[test]
fn a_case_is_printed_as_a_program() {
    let soup = Soup::new(
        [[0.0, 0.5, 1.0], [1.0, 0.0, -0.0], [2.0, 1e-300, 0.0]].map(Point3::from).to_vec(),
        [Element::Segment([0, 1]), Element::Triangle([0, 1, 2]), Element::Point(2)],
    );
    let case = Case { soup: soup.expect("valid"), queries: vec![Point3::new(1.0, 2.0, 3.5)], seed: 7 };
    let text = format!("{case:?}");
    for line in
        ["Point3::new(0.0, 0.5, 1.0),", "Element::Triangle([0, 1, 2]),", "let query = Point3::new(1.0, 2.0, 3.5);"]
    {
        assert!(text.contains(line), "{text}");
    }
}
