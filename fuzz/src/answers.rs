//! The questions about closest points, and the checks of the answers.

use super::backends::Index;
use super::{approximation, exactness};
use nalgebra::Point3;
use p2m::batch::{self, BatchOptions};
use p2m::{BruteForce, Closest, ClosestPoint, Feature, PrimitiveId, PrimitiveSet, QueryOptions, Real, Soup};

/// The groups of questions.
pub const QUESTIONS: [&str; 7] = ["agreement", "exactness", "certified", "approximate", "near", "batches", "boxes"];

/// An index, with the scene that it was built over.
pub struct Asked<'a, T: Real> {
    pub soup: &'a Soup<T>,
    pub brute: &'a BruteForce<&'a Soup<T>>,
    pub index: &'a dyn Index<T>,
    pub name: &'static str,
    pub seed: u64,
}

/// All fields of an answer but its lower bound, to the last bit.
pub type Known = (PrimitiveId, u64, [u64; 3], Feature, [u64; 3]);

/// Returns the fields of an answer that every index has to return.
pub fn known<T: Real>(c: &Closest<T>) -> Known {
    let bits = |x: T| x.to_f64().to_bits();
    let point: [T; 3] = c.point.coords.into();
    (c.primitive, bits(c.distance), point.map(bits), c.feature, c.barycentric.map(bits))
}

impl<T: Real> Asked<'_, T> {
    pub fn say(&self, query: &Point3<T>) -> String {
        format!("{} of {} primitives, {query:?}", self.name, self.soup.len())
    }

    /// Checks one of the questions about a query point.
    pub fn one(&self, question: &str, query: &Point3<T>) {
        let Some(expected) = self.brute.closest_point(query) else {
            return self.nothing(query);
        };
        match question {
            "agreement" => self.agreement(query, &expected),
            "exactness" => exactness::ordinary(self, query, &self.index.closest_point(query).expect("something")),
            "certified" => exactness::certified(self, query),
            _ => approximation::check(self, query, &expected),
        }
    }

    /// Checks that each finite query has an answer, if the scene has primitives.
    fn nothing(&self, query: &Point3<T>) {
        assert!(self.soup.is_empty() || !query.iter().all(|x| x.is_finite()), "{}", self.say(query));
        assert_eq!(self.index.closest_point(query), None, "{}", self.say(query));
        assert_eq!(self.index.certified_closest_point(query, &QueryOptions::default()), Ok(None));
        assert!(self.index.all_within(query, T::INFINITY).is_empty(), "{}", self.say(query));
        let rough = QueryOptions::default().with_max_visits(1);
        assert_eq!(self.index.closest_point_with(query, &rough), None, "{}", self.say(query));
    }

    /// Checks that the answer has the bits of brute force, with every option that changes the work alone.
    fn agreement(&self, query: &Point3<T>, expected: &Closest<T>) {
        let say = || self.say(query);
        let usual = QueryOptions::default();
        let expected = (known(expected), expected.distance);
        let ask = |options: &QueryOptions<T>| self.index.closest_point_with(query, options);
        let found = ask(&usual).expect("something");
        assert_eq!(known(&found), expected.0, "{}", say());
        assert!(found.lower_bound <= found.distance && found.lower_bound >= T::zero(), "{}: {found:?}", say());
        // A hint may be any primitive, and also one that does not exist.
        for id in [self.seed as usize % (self.soup.len() + 1), found.primitive.index()] {
            let hinted = ask(&usual.with_hint(PrimitiveId::new(id)));
            assert_eq!(hinted.as_ref().map(known), Some(expected.0), "{}: hint {id}", say());
        }
        // A radius decides whether there is an answer and does not change it; it is inclusive.
        let beside = [expected.1, expected.1 * T::of_f64(1.5), T::of_f64_below(expected.1.to_f64() * (1.0 - 1e-7))];
        for radius in beside {
            let limited = ask(&usual.with_max_distance(radius).with_hint(PrimitiveId::new(0)));
            let within = Some(expected.0).filter(|_| expected.1 <= radius);
            assert_eq!(limited.as_ref().map(known), within, "{}: radius {radius:?}", say());
        }
        for radius in [T::of_f64(-1.0), T::of_f64(f64::NAN)] {
            assert_eq!(ask(&usual.with_max_distance(radius)), None, "{}: radius {radius:?}", say());
        }
    }

    /// Checks that a batch has the answers of single queries; there are enough of them to be interleaved.
    pub fn in_batches(&self, queries: &[Point3<T>]) {
        let queries: Vec<_> = queries.iter().copied().cycle().take(37).collect();
        let radius = queries.iter().find_map(|query| self.brute.closest_point(query)).map_or(T::one(), |c| c.distance);
        let (usual, near) = (QueryOptions::default(), QueryOptions::default().with_max_distance(radius));
        for options in [usual, near, usual.with_hint(PrimitiveId::new(self.seed as usize))] {
            let expected: Vec<_> = queries.iter().map(|query| self.brute.closest_point_with(query, &options)).collect();
            let same = |found: &[Option<Closest<T>>], how: &str| {
                for ((found, expected), query) in found.iter().zip(&expected).zip(&queries) {
                    let (found, expected) = (found.as_ref().map(known), expected.as_ref().map(known));
                    assert_eq!(found, expected, "{}: {how}, {options:?}", self.say(query));
                }
            };
            let mut out = vec![None; queries.len()];
            self.index.closest_points_into(&queries, &options, &mut out);
            same(&out, "in a row");
            let batch = BatchOptions::default().with_parallel(false).with_hints(self.seed.is_multiple_of(2));
            batch::closest_points_into(self.index, &queries, &options, &batch, &mut out);
            same(&out, "along a curve");
        }
    }
}
