//! Tests of rays at user-defined primitives, and of invalid or extreme input.

use super::backends::{Index, few_backends, soup_of};
use nalgebra::{Point3, Vector3};
use p2m::core::{Crossing, RayHit};
use p2m::core::{Projection, RayError, Side};
use p2m::{Aabb, AabbTree, BruteForce, Feature, Hit, KdopTree, Primitive, PrimitiveId, Ray, RayQuery, Real};
use p2m_testkit::ray_check::agrees;
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;

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
            expected.push(Crossing::from_hit(&ray, answer).expect("in the range").hit(PrimitiveId::new(id)));
        }
        expected.sort_by(|a, b| a.parameter.total_cmp(&b.parameter).then(a.primitive.cmp(&b.primitive)));
        for (name, index) in &backends {
            agrees(&**index, &ray, &expected, 0, &|| format!("{name}: ray {i}"));
        }
        count += expected.len();
    }
    assert!(count > amount(100, 20), "{count}");
}

/// A user-defined primitive that ignores the range, or returns nonsense.
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
    let mut boxes = AabbTree::<f64, _>::new(&triangles).expect("valid");
    boxes.refit(&others, &Default::default()).expect("as many");
    let mut kdops = KdopTree::<f64, _, 14>::new(&triangles).expect("valid");
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
