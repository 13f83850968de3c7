//! The questions about closest points, and checks of the answers.

use super::subject::{Subject, compared_fields};
use super::{approximation, exactness};
use nalgebra::Point3;
use p2m::batch::{self, BatchOptions};
use p2m::{Closest, ClosestPoint, PrimitiveId, PrimitiveSet, QueryOptions, Real};

/// The groups of questions.
pub const QUESTIONS: [&str; 7] = ["agreement", "exactness", "certified", "approximate", "near", "batches", "boxes"];

/// Checks one of the questions about a query point.
pub fn check_answer<T: Real>(subject: &Subject<'_, T>, question: &str, query: &Point3<T>) {
    let Some(expected) = subject.brute.closest_point(query) else {
        return check_absence(subject, query);
    };
    match question {
        "agreement" => check_agreement(subject, query, &expected),
        "exactness" => exactness::check(subject, query, &subject.index.closest_point(query).expect("something")),
        "certified" => exactness::check_certified(subject, query),
        _ => approximation::check(subject, query, &expected),
    }
}

/// Checks that a finite query has an answer if the scene has primitives, and that other queries have none.
fn check_absence<T: Real>(subject: &Subject<'_, T>, query: &Point3<T>) {
    assert!(subject.soup.is_empty() || !query.iter().all(|x| x.is_finite()), "{}", subject.describe(query));
    assert_eq!(subject.index.closest_point(query), None, "{}", subject.describe(query));
    assert_eq!(subject.index.certified_closest_point(query, &QueryOptions::default()), Ok(None));
    assert!(subject.index.all_within(query, T::INFINITY).is_empty(), "{}", subject.describe(query));
    let rough = QueryOptions::default().with_max_visits(1);
    assert_eq!(subject.index.closest_point_with(query, &rough), None, "{}", subject.describe(query));
}

/// Checks that the answer has the bits of brute force, with every option that only changes the work.
fn check_agreement<T: Real>(subject: &Subject<'_, T>, query: &Point3<T>, expected: &Closest<T>) {
    let context = || subject.describe(query);
    let default = QueryOptions::default();
    let expected = (compared_fields(expected), expected.distance);
    let query_with = |options: &QueryOptions<T>| subject.index.closest_point_with(query, options);
    let found = query_with(&default).expect("something");
    assert_eq!(compared_fields(&found), expected.0, "{}", context());
    assert!(found.lower_bound <= found.distance && found.lower_bound >= T::zero(), "{}: {found:?}", context());
    // A hint may be any primitive, even one that does not exist.
    for id in [subject.seed as usize % (subject.soup.len() + 1), found.primitive.index()] {
        let hinted = query_with(&default.with_hint(PrimitiveId::new(id)));
        assert_eq!(hinted.as_ref().map(compared_fields), Some(expected.0), "{}: hint {id}", context());
    }
    // A radius decides whether there is an answer, but does not change it. It is inclusive.
    let beside =
        [expected.1, expected.1 * T::round_from_f64(1.5), T::round_down_from_f64(expected.1.to_f64() * (1.0 - 1e-7))];
    for radius in beside {
        let limited = query_with(&default.with_max_distance(radius).with_hint(PrimitiveId::new(0)));
        let within = Some(expected.0).filter(|_| expected.1 <= radius);
        assert_eq!(limited.as_ref().map(compared_fields), within, "{}: radius {radius:?}", context());
    }
    for radius in [T::round_from_f64(-1.0), T::round_from_f64(f64::NAN)] {
        assert_eq!(query_with(&default.with_max_distance(radius)), None, "{}: radius {radius:?}", context());
    }
}

/// Checks that a batch returns the answers of single queries. It is long enough for searches to be interleaved.
pub fn check_batches<T: Real>(subject: &Subject<'_, T>, queries: &[Point3<T>]) {
    let queries: Vec<_> = queries.iter().copied().cycle().take(37).collect();
    let radius = queries.iter().find_map(|query| subject.brute.closest_point(query)).map_or(T::one(), |c| c.distance);
    let (default, near) = (QueryOptions::default(), QueryOptions::default().with_max_distance(radius));
    for options in [default, near, default.with_hint(PrimitiveId::new(subject.seed as usize))] {
        let expected: Vec<_> = queries.iter().map(|query| subject.brute.closest_point_with(query, &options)).collect();
        let same = |found: &[Option<Closest<T>>], how: &str| {
            for ((found, expected), query) in found.iter().zip(&expected).zip(&queries) {
                let (found, expected) = (found.as_ref().map(compared_fields), expected.as_ref().map(compared_fields));
                assert_eq!(found, expected, "{}: {how}, {options:?}", subject.describe(query));
            }
        };
        let mut out = vec![None; queries.len()];
        subject.index.closest_points_into(&queries, &options, &mut out);
        same(&out, "in a row");
        let batch = BatchOptions::default().with_parallel(false);
        batch::closest_points_into(subject.index, &queries, &options, &batch, &mut out);
        same(&out, "along a curve");
    }
}
