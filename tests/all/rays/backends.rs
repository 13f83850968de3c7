//! The backends that cast rays, and the comparison of all of them with the exact hits.

use nalgebra::{Point3, Vector3};
use p2m::core::{Crossing, Hits, RayCollector};
use p2m::core::{Isa, Side};
use p2m::kdop::Directions;
use p2m::{AabbTree, BruteForce, Element, KdopTree, PrimitiveId, PrimitiveSet, Ray, RayQuery, Real, Soup};
use p2m_testkit::ray_check::{Truth, agrees};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::scenes::{self, kinds_and_layout};
use p2m_testkit::{Cases, amount, rng};
use rand::{Rng, RngExt};
use std::ops::ControlFlow;

pub(super) type Index<'a, T> = (String, Box<dyn RayQuery<T> + 'a>);

/// Adds a k-DOP tree with every instruction set.
pub(super) fn kdops<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a, const K: usize>(
    all: &mut Vec<Index<'a, T>>,
    set: S,
) where
    Directions<K>: Default,
{
    let tree = KdopTree::<T, S, K>::new(set).expect("valid");
    all.extend(
        Isa::available()
            .into_iter()
            .map(|isa| -> Index<'a, T> { (format!("{K}-DOPs, {isa}"), Box::new(tree.clone().with_isa(isa))) }),
    );
}

/// An index that finds hits in descending order of ids.
pub(super) struct Reversed<T: Real, S>(AabbTree<T, S>);

/// A collector that records all offers.
pub(super) struct Offered<'r> {
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

    fn visit_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) {
        self.0.visit_ray_candidates(ray, visit);
    }
}

/// Returns brute force first, then every tree with every instruction set.
pub(super) fn backends<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a>(set: S) -> Vec<Index<'a, T>> {
    let mut all = few_backends(set);
    kdops::<T, S, 6>(&mut all, set);
    kdops::<T, S, 18>(&mut all, set);
    kdops::<T, S, 26>(&mut all, set);
    all
}

/// Returns brute force, boxes and 14-DOPs. They are few, because each tree is compiled for each type of set.
pub(super) fn few_backends<'a, T: Real, S: PrimitiveSet<T> + Sync + Copy + 'a>(set: S) -> Vec<Index<'a, T>> {
    let mut all: Vec<Index<'a, T>> = vec![("brute force".to_owned(), Box::new(BruteForce::new(set).expect("valid")))];
    let boxes = AabbTree::<T, S>::new(set).expect("valid");
    for isa in Isa::available() {
        all.push((format!("boxes, {isa}"), Box::new(boxes.clone().with_isa(isa))));
    }
    all.push(("boxes, backwards".to_owned(), Box::new(Reversed(boxes))));
    kdops::<T, S, 14>(&mut all, set);
    all
}

/// The numbers of checked rays, of hits, and of hits along a segment.
#[derive(Debug, Default)]
pub(super) struct Checked {
    pub(super) rays: usize,
    pub(super) hits: usize,
    pub(super) along: usize,
    pub(super) crossings: usize,
}

/// Compares all backends with the exact hits, for each ray in its own range and in other ranges.
pub(super) fn check<T: Real, R: Rng>(
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
            // Each case tests one of the ranges.
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
pub(super) fn rays<R: Rng>(rng: &mut R, soup: &Soup<f64>) -> Vec<Ray> {
    let radius = |rng: &mut R| match rng.random_range(0..3) {
        0 => 0.0,
        1 => 1.0,
        _ => 2f64.powi(rng.random_range(-60..4)),
    };
    AIMS.iter().map(|aim| ray(rng, soup, &soup.aabb(), *aim).with_radius(radius(rng)).expect("valid")).collect()
}

/// Returns x 2^e, which is infinite or rounded outside of the range of f64.
pub(super) fn scaled(x: f64, e: i32) -> f64 {
    x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2)
}

/// Returns the ray at 2^e times the scale of the scene, with 2^f times the direction, if it is valid.
pub(super) fn scaled_ray(ray: &Ray, e: i32, f: i32) -> Option<Ray> {
    let (origin, direction) = (ray.origin().map(|x| scaled(x, e)), ray.direction().map(|x| scaled(x, f)));
    let [min, max] = ray.range();
    let scaled_ray = Ray::new(&origin, &direction).ok()?.with_radius(scaled(ray.radius(), e)).ok()?;
    scaled_ray.with_range(scaled(min, e - f), scaled(max, e - f)).ok()
}

pub(super) fn soup_of(primitives: &[Vec<[f64; 3]>]) -> Soup<f64> {
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

/// Runs a check on random scenes of all kinds and layouts with rays of all aims: three rays of each aim, or one in
/// fourteen of them in shallow tests.
pub(super) fn on_random_scenes(
    name: &str,
    cases: Cases,
    sizes: &[usize],
    mut each: impl FnMut(u64, Soup<f64>, Vec<Ray>),
) {
    for seed in cases {
        let mut rng = rng(name, seed);
        let (kinds, layout) = kinds_and_layout(seed);
        let size = sizes[rng.random_range(0..sizes.len())];
        let soup = scenes::soup(&mut rng, kinds, layout, size);
        let rays = if soup.len() == 0 {
            vec![Ray::new(&Point3::<f64>::origin(), &Vector3::x()).expect("valid")]
        } else {
            let all: Vec<_> = (0..3).flat_map(|_| rays(&mut rng, &soup)).collect();
            // Each case tests some of the aims.
            all.into_iter().skip(seed as usize % amount(1, 14)).step_by(amount(1, 14)).collect()
        };
        each(seed, soup, rays);
    }
}
