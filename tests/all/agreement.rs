//! Compares every backend with brute force, bit for bit (N3), and whole sets with the exact oracle (N2, N7).
//!
//! One generic suite serves all backends with sets of many types. `registry.rs` compares every backend of the registry
//! over scenes.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Point3, Vector3};
use p2m::core::{BatchAnswer, Best, Key};
use p2m::kdop::Directions;
use p2m::{
    AabbTree, BruteForce, BuildError, BuildIndex, Closest, ClosestPoint, Feature, KdopOptions, KdopTree, OctreeIndex,
    P2mIndex, P2mOptions, Point, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Real, Segment, Shape, Soup,
    Triangle,
};
use p2m_testkit::ball::Ball;
use p2m_testkit::families::shape;
use p2m_testkit::near_check::compared_fields;
use p2m_testkit::scenes::{self, extreme_soups, kinds_and_layout, queries, random_soups, to_f32};
use p2m_testkit::{amount, cases, oracle::Distance, rng};
use rand::RngExt;
use std::fmt::Debug;

/// Generates tests on scenes of all kinds, in both scalars, for an index that is not in the registry.
macro_rules! on_soups {
    ($index:ident) => {
        #[test]
        fn agrees_on_random_scenes_in_f64() {
            for (seed, soup) in random_soups("f64") {
                agrees::<f64, &Soup<f64>, $index<f64, _>>(seed, &soup, &queries(seed, &soup));
            }
        }

        #[test]
        fn agrees_on_random_scenes_in_f32() {
            for (seed, soup) in random_soups("f32") {
                let queries: Vec<_> = queries(seed, &soup).into_iter().map(to_f32).collect();
                agrees::<f32, &Soup<f32>, $index<f32, _>>(seed, &scenes::narrow(&soup).expect("fits f32"), &queries);
            }
        }

        #[test]
        fn agrees_at_extreme_scales() {
            for (seed, soup, queries) in extreme_soups("scales") {
                agrees::<f64, &Soup<f64>, $index<f64, _>>(seed, &soup, &queries);
            }
        }
    };
}

/// Generates the same tests for k-DOP trees with other directions, which the rest of the suite need not vary.
macro_rules! variants {
    ($($name:ident: $index:ident),+ $(,)?) => {
        $(mod $name {
            use super::*;
            on_soups!($index);
        })+
    };
}

/// Generates tests on sets of many types for a backend.
macro_rules! backends {
    ($($name:ident: $index:ident),+ $(,)?) => {
        $(mod $name {
            use super::*;

            #[test]
            fn agrees_on_homogeneous_slices() {
                for (seed, soup) in random_soups("slices") {
                    let queries = queries(seed, &soup);
                    let triangles: Vec<Triangle<f64>> =
                        soup.triangles().iter().map(|t| Triangle { vertices: corners(&soup, t) }).collect();
                    let segments: Vec<Segment<f64>> =
                        soup.segments().iter().map(|s| Segment { vertices: corners(&soup, s) }).collect();
                    let points: Vec<Point<f64>> =
                        soup.points().iter().map(|p| Point::new(soup.positions()[*p as usize])).collect();
                    agrees::<f64, &[Triangle<f64>], $index<f64, _>>(seed, &triangles[..], &queries);
                    agrees::<f64, &[Segment<f64>], $index<f64, _>>(seed, &segments[..], &queries);
                    agrees::<f64, &[Point<f64>], $index<f64, _>>(seed, &points[..], &queries);
                }
            }

            #[test]
            fn bad_and_tiny_sets_have_stated_answers() {
                stated_answers::<$index<f64, Vec<Shape<f64>>>>();
            }

            #[test]
            fn many_identical_triangles_are_answered_with_the_first() {
                let t = Triangle::new(
                    Point3::new(0.0, 0.0, 0.0),
                    Point3::new(1.0, 0.0, 0.0),
                    Point3::new(0.0, 1.0, 0.0),
                );
                let index = <$index<f64, _>>::build(vec![t; amount(10_000, 100)], &Default::default()).expect("finite");
                for q in [Point3::new(0.2, 0.2, 1.0), Point3::new(-1.0, -1.0, 0.0), Point3::new(1e9, 3.0, 0.0)] {
                    assert_eq!(index.closest_point(&q).map(|c| c.primitive), Some(PrimitiveId::new(0)));
                }
            }

            #[test]
            fn adversarial_depth_is_survived() {
                // Centres and sizes are in geometric progression.
                let points: Vec<Point<f64>> = (-1000..1000)
                    .step_by(amount(1, 9))
                    .map(|e| Point::new(Point3::new(2f64.powi(e), -2f64.powi(e / 2), 0.0)))
                    .collect();
                let queries: Vec<_> = points.iter().step_by(7).map(|p| p.position * 1.3).collect();
                agrees::<f64, &[Point<f64>], $index<f64, _>>(0, &points[..], &queries);
            }

            #[test]
            fn magnitudes_may_mix_in_one_scene_and_in_one_primitive() {
                for seed in cases(1500, 12) {
                    let mut r = rng("magnitudes", seed);
                    let cases: Vec<_> = (0..amount(12, 7)).map(|_| p2m_testkit::families::wild(&mut r)).collect();
                    let shapes: Vec<Shape<f64>> = cases.iter().map(|c| shape(&c.vertices)).collect();
                    // Each case is queried at its query point, and near a vertex of another case.
                    let vertex =
                        |c: &p2m_testkit::families::Case| Point3::from(c.vertices[0].map(|x| x * (1.0 + 1e-13)));
                    let queries: Vec<Point3<f64>> = cases
                        .iter()
                        .map(|c| Point3::from(c.query))
                        .chain(cases.iter().map(vertex))
                        .filter(|q| q.iter().all(|x| x.is_finite()))
                        .collect();
                    agrees::<f64, &[Shape<f64>], $index<f64, _>>(seed, &shapes[..], &queries);
                }
            }

            #[test]
            fn past_failures_stay_mended() {
                past_failures::<$index<f64, Vec<Shape<f64>>>>();
            }

            #[test]
            fn a_primitive_of_ones_own_agrees() {
                let balls: Vec<Ball> = (0..200).map(|i| {
                    let mut r = rng("balls", i);
                    Ball {
                        centre: Point3::from(std::array::from_fn(|_| r.random_range(-5.0..5.0))),
                        radius: r.random_range(0.0..1.0),
                    }
                }).collect();
                let queries: Vec<_> = (0..amount(300, 60)).map(|i| {
                    let mut r = rng("ball queries", i);
                    Point3::from(std::array::from_fn(|_| r.random_range(-9.0..9.0)))
                }).collect();
                agrees::<f64, &[Ball], $index<f64, _>>(0, &balls[..], &queries);
            }
        })+
    };
}

/// `BruteForce` with the type parameters of other backends.
type Brute<T, S> = BruteForceOf<T, S>;

type Kdop6<T, S> = KdopTree<T, S, 6>;
type Kdop14<T, S> = KdopTree<T, S, 14>;
type Kdop18<T, S> = KdopTree<T, S, 18>;
type Kdop26<T, S> = KdopTree<T, S, 26>;
type KdopTurned<T, S> = OwnDirections<T, S, 10, true>;
type KdopSkew<T, S> = OwnDirections<T, S, 8, false>;

backends! {
    aabb: AabbTree,
    brute: Brute,
    kdop_14: Kdop14,
    octree: OctreeIndex,
    p2m_index: P2mIndex,
}

#[cfg(feature = "paper")]
variants! {
    p2m_index_as_in_paper: AsInPaper,
}

// Only a few sets are tested, because these variants take long to compile.
variants! {
    kdop_6: Kdop6,
    kdop_18: Kdop18,
    kdop_26: Kdop26,
    kdop_of_turned_directions: KdopTurned,
    kdop_of_skew_directions: KdopSkew,
}

/// A P2M index with the options of the paper.
#[cfg(feature = "paper")]
struct AsInPaper<T: Real, S>(P2mIndex<T, S>);

#[cfg(feature = "paper")]
impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for AsInPaper<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        self.0.search(query, best);
    }
    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        self.0.answer_queries(queries, options, answered);
    }
}

#[cfg(feature = "paper")]
impl<T: Real, S: PrimitiveSet<T> + Sync> BuildIndex<T, S> for AsInPaper<T, S> {
    type Options = ();
    type Error = BuildError;
    fn build(set: S, (): &()) -> Result<Self, BuildError> {
        P2mIndex::build_with(set, &P2mOptions::as_in_paper()).map(Self)
    }
}

/// A k-DOP tree with user-defined directions. Either three of them are orthogonal, or none are.
struct OwnDirections<T: Real, S, const K: usize, const ORTHOGONAL: bool>(KdopTree<T, S, K>);

impl<T: Real, S: PrimitiveSet<T>, const K: usize, const O: bool> ClosestPoint<T> for OwnDirections<T, S, K, O> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        self.0.search(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync, const K: usize, const O: bool> BuildIndex<T, S> for OwnDirections<T, S, K, O> {
    type Options = ();
    type Error = BuildError;
    fn build(set: S, (): &()) -> Result<Self, BuildError> {
        let turned = [[2.0, 1.0, 2.0], [1.0, 2.0, -2.0], [-2.0, 2.0, 1.0], [1.0, 0.3, 0.2], [0.1, -3.0, 0.4]];
        let skew = [[2.0, 1.0, 2.0], [1.0, 0.1, -0.4], [0.0, 1.0, 0.3], [1.0, -1.0, 0.2]];
        let directions: Vec<Vector3<f64>> =
            if O { &turned[..] } else { &skew[..] }.iter().map(|d| (*d).into()).collect();
        let directions = Directions::new(&directions).expect("directions");
        assert_eq!(directions.starts_orthogonal(), O);
        KdopTree::build_with(set, &KdopOptions::new(directions)).map(Self)
    }
}

/// `BruteForce` with a scalar parameter, so that the suite can be tested on itself.
struct BruteForceOf<T, S>(BruteForce<S>, std::marker::PhantomData<T>);

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for BruteForceOf<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        self.0.search(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T>> BuildIndex<T, S> for BruteForceOf<T, S> {
    type Options = ();
    type Error = BuildError;
    fn build(set: S, _: &()) -> Result<Self, BuildError> {
        Ok(Self(BruteForce::new(set)?, std::marker::PhantomData))
    }
}

fn corners<const N: usize>(soup: &Soup<f64>, indices: &[u32; N]) -> [Point3<f64>; N] {
    indices.map(|i| soup.positions()[i as usize])
}

fn agrees<T: Real, S: PrimitiveSet<T> + Copy, I: BuildIndex<T, S>>(seed: u64, set: S, queries: &[Point3<T>])
where
    I::Error: Debug,
{
    let brute = BruteForce::new(set).expect("valid scene");
    let index = I::build(set, &I::Options::default()).expect("valid scene");
    agrees_with(&brute, seed, set.len(), queries, &index);
}

/// Checks an index of `len` primitives with every option. It takes trait objects, so that it is compiled once and not
/// for many types.
pub(crate) fn agrees_with<T: Real>(
    brute: &dyn ClosestPoint<T>,
    seed: u64,
    len: usize,
    queries: &[Point3<T>],
    index: &dyn ClosestPoint<T>,
) {
    let mut rng = rng("options", seed);
    let without_bound = |c: Option<Closest<T>>| c.as_ref().map(compared_fields);
    let mut batch = vec![None; queries.len()];
    index.closest_points_into(queries, &QueryOptions::default(), &mut batch);
    for (i, q) in queries.iter().enumerate() {
        let expected = brute.closest_point(q);
        let context = || format!("seed {seed}, query {i} {q:?}");
        let found = index.closest_point(q);
        assert_eq!(without_bound(found), without_bound(expected), "{}", context());
        assert_eq!(without_bound(batch[i]), without_bound(expected), "{}: batch", context());
        assert!(batch[i].is_none_or(|batch| batch.lower_bound <= batch.distance), "{}: batch", context());
        let (Some(found), Some(expected)) = (found, expected) else {
            assert_eq!(len, 0, "{}", context());
            continue;
        };
        assert!(found.lower_bound <= found.distance, "{}", context());
        // A hint changes no answer, whether it is good, bad or out of range.
        let hint = PrimitiveId::new(rng.random_range(0..len + 1));
        let hinted = index.closest_point_with(q, &QueryOptions::default().with_hint(hint));
        assert_eq!(without_bound(hinted), without_bound(Some(expected)), "{}: hint {hint}", context());
        // A radius decides whether there is an answer, but does not change it.
        let at = |r: T| index.closest_point_with(q, &QueryOptions::default().with_max_distance(r));
        assert_eq!(without_bound(at(found.distance)), without_bound(Some(expected)), "{}: at its distance", context());
        let factor = T::round_from_f64(rng.random_range(0.0..2.0));
        let limited = at(found.distance * factor);
        let within = found.distance <= found.distance * factor;
        assert_eq!(without_bound(limited), without_bound(Some(expected)).filter(|_| within), "{}: radius", context());
        // Epsilon bounds the error of the distance.
        let epsilon = [0.001, 0.1, 3.0][rng.random_range(0..3)];
        let rough = index
            .closest_point_with(q, &QueryOptions::default().with_epsilon(T::round_from_f64(epsilon)))
            .expect("found");
        let (rough_distance, distance) = (rough.distance.to_f64(), expected.distance.to_f64());
        let slack = 1.0 + 8.0 * T::UNIT_ROUNDOFF;
        assert!(rough_distance >= distance, "{}: epsilon {epsilon}", context());
        assert!(
            rough_distance <= distance * (1.0 + epsilon) * slack + T::SMALLEST_SUBNORMAL,
            "{}: epsilon {epsilon}: {rough_distance:e}, not {distance:e}",
            context()
        );
        assert!(rough.lower_bound <= expected.distance, "{}: epsilon {epsilon}", context());
        // With both a hint and a radius, there is an answer if any primitive is within the radius, and it keeps the
        // bounds.
        let stretch = rng.random_range(1.0..1.0 + epsilon);
        let radius = T::round_from_f64(expected.distance.to_f64() * stretch);
        let options = QueryOptions::default().with_epsilon(T::round_from_f64(epsilon)).with_max_distance(radius);
        for options in [options, options.with_hint(hint)] {
            let Some(rough) = index.closest_point_with(q, &options) else {
                assert!(expected.distance > radius, "{}: epsilon {epsilon} within {radius:?}", context());
                continue;
            };
            let bound = distance * (1.0 + epsilon) * slack + T::SMALLEST_SUBNORMAL;
            assert!(rough.distance.to_f64() <= bound && rough.distance <= radius, "{}: epsilon {epsilon}", context());
            assert!(rough.lower_bound <= expected.distance, "{}: epsilon {epsilon} and radius", context());
        }
    }
}

/// Tests scenes that were answered wrongly by earlier versions.
fn past_failures<I: BuildIndex<f64, Vec<Shape<f64>>, Error = BuildError>>() {
    let build = |set: Vec<Shape<f64>>| I::build(set, &I::Options::default()).expect("finite");
    // Scaling down by 1e300 lost the distance of the projection, so the key was below the bound of the box.
    let set = vec![shape(&[[0.0, 0.0, 1.1e-100]]), shape(&[[-1e300, 0.0, 0.0], [1e300, 0.0, 0.0]])];
    let q = Point3::new(0.0, 0.0, 1e-100);
    let expected = BruteForce::new(&set[..]).expect("finite").closest_point(&q).expect("not empty");
    assert_eq!(
        build(set).closest_point(&q).map(|c| (c.primitive, c.distance)),
        Some((expected.primitive, expected.distance))
    );
    // The certified bound of keys outside of the plain range was wrong.
    let point = [-7.528623501410492e140, -1.5628541052992638e141, 1.5027718543271175e141];
    let q = Point3::new(-7.528623501410494e140, -1.5628541052992638e141, 1.5027718543271175e141);
    let segment = [
        [-3.0485825683102407e141, -2.667486116741718e141, 6.458994849699129e140],
        [2.7944990166126107e141, 1.4403024883833572e140, 2.8268164461896628e141],
    ];
    let found = build(vec![shape(&[point]), shape(&segment)]).closest_point(&q).expect("not empty");
    assert!(Distance::new(q.coords.into(), &segment).is_at_least(found.lower_bound), "{found:?}");
    // Any epsilon is allowed, alone and with a radius.
    let row = |from: i32| (from..from + 100).map(|i| shape(&[[f64::from(i), 0.0, 0.0]])).collect::<Vec<_>>();
    let index = build(row(7));
    for epsilon in [1.0, 1e30, 1e154, 1e200, f64::MAX, f64::INFINITY] {
        let options = QueryOptions::default().with_epsilon(epsilon);
        let found = index.closest_point_with(&Point3::new(0.3, 1.0, 0.0), &options).expect("not empty");
        assert!(found.lower_bound <= 6.775, "{found:?}");
        let limited = options.with_max_distance(10.0);
        assert!(index.closest_point_with(&[0.0; 3], &limited).is_some(), "epsilon {epsilon}");
        let beyond = options.with_max_distance(6.9);
        assert!(index.closest_point_with(&[0.0; 3], &beyond).is_none(), "epsilon {epsilon}");
    }
    // A search with unlimited epsilon evaluates the hint first and nothing else.
    let hinted = QueryOptions::default().with_epsilon(f64::INFINITY).with_hint(PrimitiveId::new(60));
    let found = index.closest_point_with(&[0.0; 3], &hinted).expect("not empty");
    assert!(found.primitive.index() == 60 || found.primitive.index() == 0, "{found:?}");
}

/// A distance of 1.41 eta is reported as eta, and counts as within a radius of eta.
#[test]
fn the_radius_is_inclusive_for_subnormal_distances_in_f32() {
    let eta = f32::from_bits(1);
    let index = AabbTree::new([Point::new(Point3::new(eta, eta, 0.0))]).expect("finite");
    let found = index.closest_point_with(&[0.0; 3], &QueryOptions::default().with_max_distance(eta));
    assert_eq!(found.map(|c| c.distance), Some(eta));
}

fn stated_answers<I: BuildIndex<f64, Vec<Shape<f64>>, Error = BuildError>>()
where
    I::Options: Default,
{
    let build = |set: Vec<Shape<f64>>| I::build(set, &I::Options::default());
    let segment = |a: f64, b: f64| Shape::from(Segment::new(Point3::new(a, 0.0, 0.0), Point3::new(b, 0.0, 0.0)));
    // An empty scene has no answer.
    let index = build(vec![]).expect("an empty scene is a scene");
    assert_eq!(index.closest_point(&[0.0; 3]), None);
    // The scene has one primitive.
    let index = build(vec![segment(0.0, 2.0)]).expect("finite");
    let found = index.closest_point(&Point3::new(1.0, 3.0, 4.0)).expect("there is one");
    assert_eq!((found.distance, found.feature, found.barycentric), (5.0, Feature::Edge(0), [0.5, 0.5, 0.0]));
    // Queries that are not finite have no answer.
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(index.closest_point(&Point3::new(0.0, bad, 0.0)), None);
    }
    // Coordinates that are not finite are an error, wherever they are.
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for at in 0..3 {
            let mut set = vec![segment(0.0, 1.0), segment(1.0, 2.0), segment(2.0, 3.0)];
            set[at] = segment(5.0, bad);
            let error = build(set).err();
            assert_eq!(error, Some(BuildError::NonFinite { id: PrimitiveId::new(at) }), "{bad} at {at}");
        }
    }
    // Of equally near primitives the one with the lowest id wins, wherever it is in the tree.
    let set: Vec<_> = (0..100).map(|i| segment(f64::from(i % 10), f64::from(i % 10))).collect();
    let index = build(set).expect("finite");
    for i in 0..10 {
        let found = index.closest_point(&Point3::new(f64::from(i), 0.0, 1.0)).expect("not empty");
        assert_eq!(found.primitive.index(), usize::try_from(i).expect("small"));
    }
    // Slices of different lengths cause the only documented panic.
    let mut out = [None; 2];
    let short = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        index.closest_points_into(&[Point3::origin()], &QueryOptions::default(), &mut out);
    }));
    assert!(short.is_err());
}

/// Checks N2 and N7 of whole scenes against the nearest primitive of exact arithmetic.
#[test]
fn the_returned_primitive_is_nearest_within_rounding() {
    let mut wrong = 0;
    let mut query_count = 0;
    let cases = cases(200, 48);
    for seed in cases.clone() {
        let mut rng = rng("identity", seed);
        let (kinds, layout) = kinds_and_layout(seed);
        let soup = scenes::soup(&mut rng, kinds, layout, 25);
        let index = AabbTree::new(&soup).expect("valid");
        let queries: Vec<_> = (0..20).map(|_| scenes::query(&mut rng, soup.positions())).collect();
        let mut batch = vec![None; queries.len()];
        index.closest_points_into(&queries, &QueryOptions::default(), &mut batch);
        for (i, (q, batch)) in queries.into_iter().zip(batch).enumerate() {
            let found = index.closest_point(&q).expect("not empty");
            let in_batch = batch.expect("not empty");
            let exact: Vec<Distance> = (0..soup.len())
                .map(|i| {
                    let shape = soup.get(PrimitiveId::new(i));
                    let vertices: Vec<[f64; 3]> = shape.vertices().iter().map(|v| v.coords.into()).collect();
                    Distance::new(q.coords.into(), &vertices)
                })
                .collect();
            let nearest = (0..exact.len()).min_by(|a, b| exact[*a].compare(&exact[*b])).expect("not empty");
            let returned = &exact[found.primitive.index()];
            let context = || format!("seed {seed}, query {i}");
            // N1 for scenes: the error is bounded by the M of the returned primitive on one side, and by the M of the
            // nearest primitive on the other side.
            assert!(returned.error(found.distance, 53, 0.0) <= 4.0, "{}: N1", context());
            for bound in [found.lower_bound, in_batch.lower_bound] {
                assert!(exact.iter().all(|d| d.is_at_least(bound)), "{}: N7", context());
            }
            if returned.compare(&exact[nearest]).is_gt() {
                wrong += 1;
                let slack =
                    4.0 * f64::EPSILON / 2.0 * (returned.max_vertex_distance() + exact[nearest].max_vertex_distance());
                let allowed = (found.distance - 2.0 * slack).max(0.0);
                assert!(exact[nearest].is_at_least(allowed), "{}: N2", context());
            }
            query_count += 1;
        }
    }
    println!("{query_count} queries, {wrong} answered with a primitive that is farther by rounding");
    assert!(cases.is_replay() || wrong < query_count / 50, "{wrong} of {query_count}");
}

/// Permuting and duplicating primitives and adding far geometry change answers only as they have to.
#[test]
fn scenes_can_be_permuted_duplicated_and_extended() {
    for seed in cases(60, 24) {
        let mut rng = rng("metamorphic", seed);
        let (kinds, layout) = kinds_and_layout(seed);
        let soup = scenes::soup(&mut rng, kinds, layout, 80);
        let elements: Vec<_> = soup.elements().collect();
        let mut order: Vec<usize> = (0..elements.len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, rng.random_range(0..=i));
        }
        let of = |elements: Vec<_>| Soup::new(soup.positions().to_vec(), elements).expect("valid");
        let shuffled = of(order.iter().map(|i| elements[*i]).collect());
        let doubled = of(elements.iter().chain(&elements).copied().collect());
        let mut with_far = soup.positions().to_vec();
        with_far.push(Point3::new(1e9, 1e9, 1e9));
        let far = u32::try_from(with_far.len() - 1).expect("small");
        let extended = Soup::new(with_far, elements.iter().copied().chain([p2m::Element::Point(far)])).expect("valid");
        let build = |soup| AabbTree::new(soup).expect("valid");
        let [plain, shuffled, doubled, extended] = [&soup, &shuffled, &doubled, &extended].map(build);
        for _ in 0..40 {
            let q = scenes::query(&mut rng, soup.positions());
            let a = plain.closest_point(&q).expect("not empty");
            let b = shuffled.closest_point(&q).expect("not empty");
            assert_eq!(a.distance, b.distance, "seed {seed}: permuted");
            let key = |e: usize| soup.get(PrimitiveId::new(e)).project(&q).key;
            assert_eq!(key(order[b.primitive.index()]), key(a.primitive.index()), "seed {seed}: permuted, another key");
            let c = doubled.closest_point(&q).expect("not empty");
            assert_eq!((c.distance, c.point, c.primitive), (a.distance, a.point, a.primitive), "seed {seed}: doubled");
            let d = extended.closest_point(&q).expect("not empty");
            if a.distance < 1e8 {
                assert_eq!(
                    (d.distance, d.point, d.primitive),
                    (a.distance, a.point, a.primitive),
                    "seed {seed}: extended"
                );
            }
        }
    }
}

/// The bound of a box never exceeds the key of a primitive inside of it, so searches can prune without slack.
#[test]
fn box_bounds_never_exceed_the_keys_inside() {
    for seed in cases(300_000, 6_000) {
        let case = p2m_testkit::families::case(&mut rng("bounds", seed));
        let (shape, q) = (shape(&case.vertices), Point3::from(case.query));
        let key: Key = shape.project(&q).key;
        let bound = shape.aabb().lower_bound(&q);
        assert!(bound <= key.square_above(), "seed {seed}: {bound:e} > {key:?}\n{case:?}");
    }
}
