//! Compares certified answers of every backend with exact rational arithmetic, on scenes in which many primitives have
//! equal distances up to rounding.
//!
//! `P2M_DEEP=100 cargo test --profile deep --test all near_ties` runs 150,000 queries on each backend.

use nalgebra::{Point3, Vector3};
use p2m::core::CertifyError;
use p2m::{
    AabbTree, BruteForce, CertifiedQuery, ClosestPoint, Element, KdopTree, OctreeIndex, P2mIndex, PrimitiveSet,
    QueryOptions, Real, Soup,
};
use p2m_testkit::oracle::Distance;
use p2m_testkit::scenes::{self, kinds_and_layout, narrow};
use p2m_testkit::{amount, cases};
use rand::{Rng, RngExt};
use std::cmp::Ordering;

/// An index that answers with and without certification.
trait Index<T: Real>: ClosestPoint<T> + CertifiedQuery<T> {}
impl<T: Real, I: ClosestPoint<T> + CertifiedQuery<T>> Index<T> for I {}

fn vertices<T: Real>(soup: &Soup<T>, id: usize) -> Vec<[f64; 3]> {
    let shape = soup.get(p2m::PrimitiveId::new(id));
    shape.vertices().iter().map(|v| v.map(|x| x.to_f64()).coords.into()).collect()
}

/// Returns the nearest primitive in exact arithmetic, the lowest id of equally near ones.
fn nearest<T: Real>(soup: &Soup<T>, query: [f64; 3]) -> (usize, Distance) {
    let all = (0..soup.len()).map(|id| (id, Distance::new(query, &vertices(soup, id))));
    all.reduce(|a, b| if b.1.compare(&a.1) == Ordering::Less { b } else { a }).expect("not empty")
}

/// Returns whether a distance is within a unit in the last place of the true one.
fn is_within_a_unit<T: Real>(true_one: &Distance, distance: T) -> bool {
    let unit = distance.to_f64() * 2.0 * T::UNIT_ROUNDOFF + T::SMALLEST_SUBNORMAL;
    let (low, high) = (distance.to_f64() - unit, distance.to_f64() + unit);
    true_one.is_at_least(low.max(0.0)) && !true_one.is_at_least(high.next_up())
}

/// Checks certified answers. Returns the number of queries, and the number of answers without certification that named
/// another primitive.
fn check<T: Real>(soup: &Soup<T>, queries: &[Point3<T>]) -> [usize; 2] {
    let brute = BruteForce::new(soup).expect("valid");
    let tree = AabbTree::new(soup).expect("valid");
    let kdop = KdopTree::<T, _, 14>::new(soup).expect("valid");
    let octree = OctreeIndex::new(soup).expect("valid");
    let p2m = P2mIndex::new(soup).expect("valid");
    let indexes: [(&str, &dyn Index<T>); 5] =
        [("brute", &brute), ("aabb", &tree), ("kdop", &kdop), ("octree", &octree), ("p2m", &p2m)];
    let mut counts = [0; 2];
    for query in queries {
        let query_point: [f64; 3] = query.map(|x| x.to_f64()).coords.into();
        let (id, distance) = nearest(soup, query_point);
        for (name, index) in indexes {
            let found = index.certified_closest_point(query, &Default::default()).expect("vertices").expect("found");
            let context = || format!("{name}, {query:?}: {found:?}, not {id}");
            assert_eq!(found.primitive.index(), id, "{}", context());
            assert!(is_within_a_unit(&distance, found.distance), "{}: off by more than a unit", context());
            assert!(distance.is_at_least(found.lower_bound.to_f64()), "{}: the bound is too large", context());
            let usual = index.closest_point(query).expect("found");
            counts[0] += 1;
            counts[1] += usize::from(usual.primitive.index() != id);
            // The radius is compared without rounding.
            let reported = found.distance.to_f64();
            let within = |r: f64| {
                let options = QueryOptions::default().with_max_distance(T::round_from_f64(r));
                index.certified_closest_point(query, &options).expect("vertices").is_some()
            };
            let beyond = |r: f64| T::round_from_f64(r).to_f64().max(r);
            if !distance.is_at_least(reported) {
                assert!(within(reported), "{}: radius", context());
            }
            if distance.is_at_least(reported.next_up()) {
                assert!(!within(reported), "{}: radius", context());
            }
            assert!(within(beyond(reported * (1.0 + 8.0 * T::UNIT_ROUNDOFF) + T::SMALLEST_SUBNORMAL)), "{}", context());
        }
    }
    counts
}

fn unit(rng: &mut impl Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from([0; 3].map(|_| rng.random_range(-1.0..1.0)));
        if (0.1..1.0).contains(&v.norm()) {
            return v.normalize();
        }
    }
}

/// Returns a scene in which `close` primitives of all kinds are at distance `radius` from the query up to rounding,
/// some of them twice, and `far` others are farther away.
fn almost_tied(rng: &mut impl Rng, query: Point3<f64>, radius: f64, close: usize, far: usize) -> Soup<f64> {
    let mut soup = Soup::default();
    let mut add = |rng: &mut dyn Rng, at: f64, size: f64| {
        let normal = unit(&mut &mut *rng);
        let side = normal.cross(&unit(&mut &mut *rng)).normalize();
        let (other, foot) = (normal.cross(&side), query + normal * at);
        let mut corner = |a: f64, b: f64| {
            let number = soup.push_position(foot + side * (a * size) + other * (b * size));
            u32::try_from(number).expect("few")
        };
        let element = match rng.random_range(0..3) {
            0 => Element::Point(corner(0.0, 0.0)),
            1 => Element::Segment([corner(-rng.random_range(0.2..2.0), 0.0), corner(rng.random_range(0.2..2.0), 0.0)]),
            _ => Element::Triangle([corner(-1.0, -0.7), corner(1.5, -0.4), corner(rng.random_range(-0.5..0.5), 1.2)]),
        };
        for _ in 0..rng.random_range(1..3) {
            soup.push(element).expect("valid");
        }
    };
    for i in 0..close + far {
        let size = radius * 2f64.powi(rng.random_range(-6..6));
        let at = if i % (1 + far / close.max(1)) == 0 { radius } else { radius * rng.random_range(1.0001..20.0) };
        add(rng, at, size);
    }
    soup
}

#[test]
fn near_ties_are_decided_rightly_by_every_backend() {
    let mut counts = [0; 2];
    let cases = cases(1500, 60);
    for case in cases.clone() {
        let (round, mut rng) = (case as usize, p2m_testkit::rng("certified near ties", case));
        let scale = 2f64.powi([0, 0, 0, -30, 200, -480][round % 6]);
        let query_point = Point3::from([0; 3].map(|_| rng.random_range(-1.0..1.0) * scale));
        let offset = [0.0, 0.0, 1e3][round % 3] * scale;
        let query_point = query_point.map(|x| x + offset);
        let radius = scale * 2f64.powi(rng.random_range(-8..3));
        let soup = almost_tied(&mut rng, query_point, radius, 4, round % 60);
        let [all, other] = check(&soup, &[query_point]);
        counts = [counts[0] + all, counts[1] + other];
    }
    println!("of {} answers without proof {} named a primitive that is not nearest", counts[0], counts[1]);
    // Certification matters in enough of the cases.
    assert!(cases.is_replay() || counts[1] * 10 > counts[0], "{counts:?}");
}

#[test]
fn ordinary_scenes_of_both_scalars_are_certified() {
    for case in cases(24, 24) {
        let (mut rng, (kinds, layout)) = (p2m_testkit::rng("certified", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(60, 20));
        let places: Vec<_> = (0..amount(6, 2)).map(|_| scenes::query(&mut rng, soup.positions())).collect();
        check(&soup, &places);
        if let Some(narrowed) = narrow(&soup) {
            check(&narrowed, &places.iter().map(|q| scenes::to_f32(*q)).collect::<Vec<_>>());
        }
    }
}

#[test]
fn what_cannot_be_certified_is_told() {
    use p2m::core::Projection;
    use p2m::{Aabb, Feature, Primitive, PrimitiveId};
    struct Ball;
    impl Primitive<f64> for Ball {
        fn aabb(&self) -> Aabb<f64> {
            Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) }
        }
        fn project(&self, query: &Point3<f64>) -> Projection {
            let point = Point3::from(query.coords.normalize());
            Projection::new(query, self.aabb().clamp(point), Feature::Face, [1.0, 0.0, 0.0], 1e-15)
        }
        fn intersect_ray(&self, _: &p2m::Ray) -> Option<p2m::core::RayHit> {
            unreachable!("no rays are cast")
        }
    }
    let tree = AabbTree::new([Ball]).expect("valid");
    let query = Point3::new(3.0, 0.0, 0.0);
    let error = CertifyError::NoVertices { id: PrimitiveId::new(0) };
    assert_eq!(tree.certified_closest_point(&query, &Default::default()), Err(error));
    // There is no answer far beyond the radius, for a query that is not finite, or in an empty scene.
    let near = QueryOptions::default().with_max_distance(1.0);
    assert_eq!(tree.certified_closest_point(&query, &near), Ok(None));
    let nowhere = Point3::new(f64::NAN, 0.0, 0.0);
    assert_eq!(tree.certified_closest_point(&nowhere, &Default::default()), Ok(None));
    let empty = BruteForce::new::<f64>(Vec::<Ball>::new()).expect("valid");
    assert_eq!(empty.certified_closest_point(&query, &Default::default()), Ok(None));
}
