//! Answers of an index to rays, held against the exact ones.

use crate::ray_oracle::{Meeting, crossing};
use p2m_core::{Hit, Ray, RayQuery, Real, Side};
use rand::{Rng, RngExt};

/// What the whole line of a ray does with a scene.
pub struct Truth {
    meetings: Vec<(usize, Meeting)>,
    /// Parameters.
    crossings: Vec<f64>,
}

/// All of a hit, comparable to the last bit.
pub type Bits = (usize, u64, Side, [u64; 3], [u64; 3]);

/// The bits of a hit.
#[must_use]
pub fn bits(hit: &Hit) -> Bits {
    let point: [f64; 3] = hit.point().coords.into();
    let [weights, point] = [hit.barycentric(), point].map(|x| x.map(f64::to_bits));
    (hit.primitive.index(), hit.parameter.to_bits(), hit.side, weights, point)
}

impl Truth {
    /// Of the primitives with these ids, in their order; the others are known to be missed.
    pub fn new(primitives: &[Vec<[f64; 3]>], ids: impl IntoIterator<Item = usize>, ray: &Ray) -> Self {
        let (mut meetings, mut crossings) = (Vec::new(), Vec::new());
        for i in ids {
            meetings.extend(Meeting::new(ray, &primitives[i]).map(|meeting| (i, meeting)));
            crossings.extend(crossing(ray, &primitives[i]).map(|(_, parameter)| parameter));
        }
        Self { meetings, crossings }
    }

    /// All hits of an index, each checked.
    pub fn checked_hits<T: Real>(
        &self,
        index: &(impl RayQuery<T> + ?Sized),
        ray: &Ray,
        say: &dyn Fn() -> String,
    ) -> Vec<Hit> {
        let mut expected: Vec<_> =
            self.meetings.iter().filter_map(|(i, meeting)| Some((*i, meeting.in_range(ray.range())?))).collect();
        expected.sort_by(|(i, a), (j, b)| a.parameter.partial_cmp(&b.parameter).expect("no NaN").then(i.cmp(j)));
        let found = index.all_intersections(ray);
        let ids: Vec<_> = found.iter().map(|h| (h.primitive.index(), h.parameter)).collect();
        let all: Vec<_> = expected.iter().map(|(i, e)| (*i, e.parameter)).collect();
        assert_eq!(ids, all, "{} {ray:?}", say());
        for (hit, (_, expected)) in found.iter().zip(&expected) {
            if let Err(what) = expected.check(hit) {
                panic!("{what}: {} {ray:?} {hit:?} {expected:?}", say());
            }
        }
        found
    }

    /// How often the surface is crossed in the range of the ray.
    #[must_use]
    pub fn crossings(&self, ray: &Ray) -> usize {
        let [min, max] = ray.range();
        self.crossings.iter().filter(|t| min <= **t && **t <= max).count()
    }

    /// A range that often begins or ends at a hit or next to one.
    pub fn range(&self, rng: &mut impl Rng) -> [f64; 2] {
        let hits = self.meetings.iter().flat_map(|(_, meeting)| meeting.parameters());
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

/// Every function of an index against the hits and crossings that it has to find.
pub fn agrees<T: Real>(
    index: &(impl RayQuery<T> + ?Sized),
    ray: &Ray,
    hits: &[Hit],
    crossings: usize,
    say: &dyn Fn() -> String,
) {
    let say = || format!("{} {ray:?}", say());
    let expected: Vec<_> = hits.iter().map(bits).collect();
    let found: Vec<_> = index.all_intersections(ray).iter().map(bits).collect();
    assert_eq!(found, expected, "{}", say());
    assert_eq!(index.first_intersection(ray).as_ref().map(bits), expected.first().copied(), "{}: first", say());
    assert_eq!(index.do_intersect(ray), !hits.is_empty(), "{}: whether", say());
    assert_eq!(index.count(ray), hits.len(), "{}: count", say());
    assert_eq!(index.crossings(ray), crossings, "{}: crossings", say());
    match index.any_intersection(ray) {
        Some(hit) => assert!(expected.contains(&bits(&hit)), "{}: any is {hit:?}", say()),
        None => assert!(hits.is_empty(), "{}: any", say()),
    }
}
