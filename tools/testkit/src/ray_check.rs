//! Comparison of an index's answers to rays with the exact ones.

use crate::ray_oracle::{LineIntersection, crossing};
use p2m_core::{Hit, Ray, RayQuery, Real, Side};
use rand::{Rng, RngExt};

/// The exact hits and crossings of the whole line of a ray with a scene.
pub struct Truth {
    intersections: Vec<(usize, LineIntersection)>,
    /// The parameters of crossings.
    crossings: Vec<f64>,
}

/// All numbers of a hit, comparable to the last bit.
pub type Bits = (usize, u64, Side, [u64; 3], [u64; 3]);

/// Returns the bits of a hit.
#[must_use]
pub fn bits(hit: &Hit) -> Bits {
    let point: [f64; 3] = hit.point().coords.into();
    let [weights, point] = [hit.barycentric(), point].map(|x| x.map(f64::to_bits));
    (hit.primitive.index(), hit.parameter.to_bits(), hit.side, weights, point)
}

impl Truth {
    /// Computes the hits with the primitives of these ids, in this order. The other primitives must be known to be
    /// missed.
    pub fn new(primitives: &[Vec<[f64; 3]>], ids: impl IntoIterator<Item = usize>, ray: &Ray) -> Self {
        let (mut intersections, mut crossings) = (Vec::new(), Vec::new());
        for i in ids {
            intersections.extend(LineIntersection::new(ray, &primitives[i]).map(|intersection| (i, intersection)));
            crossings.extend(crossing(ray, &primitives[i]).map(|(_, parameter)| parameter));
        }
        Self { intersections, crossings }
    }

    /// Returns all hits of an index after checking each of them.
    pub fn checked_hits<T: Real>(
        &self,
        index: &(impl RayQuery<T> + ?Sized),
        ray: &Ray,
        context: &dyn Fn() -> String,
    ) -> Vec<Hit> {
        let mut expected: Vec<_> = self
            .intersections
            .iter()
            .filter_map(|(i, intersection)| Some((*i, intersection.in_range(ray.range())?)))
            .collect();
        expected.sort_by(|(i, a), (j, b)| a.parameter.partial_cmp(&b.parameter).expect("no NaN").then(i.cmp(j)));
        let found = index.all_intersections(ray);
        let ids: Vec<_> = found.iter().map(|h| (h.primitive.index(), h.parameter)).collect();
        let all: Vec<_> = expected.iter().map(|(i, e)| (*i, e.parameter)).collect();
        assert_eq!(ids, all, "{} {ray:?}", context());
        for (hit, (_, expected)) in found.iter().zip(&expected) {
            if let Err(error) = expected.check(hit) {
                panic!("{error}: {} {ray:?} {hit:?} {expected:?}", context());
            }
        }
        found
    }

    /// Returns the number of times that the ray crosses the surface in its range.
    #[must_use]
    pub fn crossings(&self, ray: &Ray) -> usize {
        let [min, max] = ray.range();
        self.crossings.iter().filter(|t| min <= **t && **t <= max).count()
    }

    /// Returns a range that often begins or ends at a hit or next to one.
    pub fn range(&self, rng: &mut impl Rng) -> [f64; 2] {
        let hits = self.intersections.iter().flat_map(|(_, intersection)| intersection.parameters());
        let parameters: Vec<f64> = hits.chain(self.crossings.iter().copied()).chain([0.0, -0.0, 1.0]).collect();
        let mut end = || {
            let t = parameters[rng.random_range(0..parameters.len())];
            match rng.random_range(0..8) {
                0 => f64::NEG_INFINITY,
                1 => f64::INFINITY,
                2 => t.next_up(),
                3 => t.next_down(),
                4 => 0.5 * t,
                _ => t,
            }
        };
        let (a, b) = (end(), end());
        if a <= b { [a, b] } else { [b, a] }
    }
}

/// Compares every function of an index with the exact hits and crossings.
pub fn agrees<T: Real>(
    index: &(impl RayQuery<T> + ?Sized),
    ray: &Ray,
    hits: &[Hit],
    crossings: usize,
    context: &dyn Fn() -> String,
) {
    let context = || format!("{} {ray:?}", context());
    let expected: Vec<_> = hits.iter().map(bits).collect();
    let found: Vec<_> = index.all_intersections(ray).iter().map(bits).collect();
    assert_eq!(found, expected, "{}", context());
    assert_eq!(index.first_intersection(ray).as_ref().map(bits), expected.first().copied(), "{}: first", context());
    assert_eq!(index.do_intersect(ray), !hits.is_empty(), "{}: whether", context());
    assert_eq!(index.count(ray), hits.len(), "{}: count", context());
    assert_eq!(index.crossings(ray), crossings, "{}: crossings", context());
    match index.any_intersection(ray) {
        Some(hit) => assert!(expected.contains(&bits(&hit)), "{}: any is {hit:?}", context()),
        None => assert!(hits.is_empty(), "{}: any", context()),
    }
}
