//! Checks of approximate answers: the error is as requested, and the lower bound is valid.

use super::exactness;
use super::subject::{Subject, compared_fields};
use nalgebra::Point3;
use p2m::{Closest, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Real};

/// Queries an index and checks the promises of the answer; `exact` is the answer of brute force.
fn checked_answer<T: Real>(
    subject: &Subject<'_, T>,
    query: &Point3<T>,
    exact: &Closest<T>,
    options: &QueryOptions<T>,
) -> Closest<T> {
    let found = subject.index.closest_point_with(query, options);
    let context = || format!("{}, {options:?}: {found:?}, not {exact:?}", subject.describe(query));
    let found = found.unwrap_or_else(|| panic!("{}", context()));
    assert!(found.distance >= exact.distance && found.lower_bound <= exact.distance, "{}", context());
    let projection = subject.soup.get(found.primitive).project(query);
    assert_eq!(
        T::round_from_f64(projection.key.distance()),
        found.distance,
        "{}: the distance of another primitive",
        context()
    );
    if found.lower_bound > exact.lower_bound {
        let (nearest, all) = exactness::nearest(subject.soup, query);
        assert!(all[nearest].is_at_least(found.lower_bound.to_f64()), "{}: bound", context());
    }
    found
}

/// Checks every option, with values chosen by the seed.
pub fn check<T: Real>(subject: &Subject<'_, T>, query: &Point3<T>, exact: &Closest<T>) {
    let context = || format!("{}, {exact:?}", subject.describe(query));
    let default = QueryOptions::default();
    let distance = exact.distance.to_f64();
    let seed = subject.seed as usize;
    let epsilon = [1e-9, 0.001, 0.03, 0.3, 3.0, 1e30][seed % 6];
    let found = checked_answer(subject, query, exact, &default.with_epsilon(T::round_from_f64(epsilon)));
    let max_distance = distance * ((1.0 + epsilon) * (1.0 + 8.0 * T::UNIT_ROUNDOFF)) + T::SMALLEST_SUBNORMAL;
    assert!(found.distance.to_f64() <= max_distance, "{}: epsilon {epsilon}: {found:?}", context());
    let hint = PrimitiveId::new(seed % (subject.soup.len() + 1));
    checked_answer(subject, query, exact, &default.with_max_visits([0, 1, 2, 3, 5, 9][seed % 6]).with_hint(hint));
    let found = checked_answer(subject, query, exact, &default.with_max_visits(u32::MAX - 1));
    assert_eq!(compared_fields(&found), compared_fields(exact), "{}: a budget for everything: {found:?}", context());
    // One of the radii contains a primitive, and the other one does not.
    let rough = default.with_epsilon(T::round_from_f64(epsilon));
    let found = checked_answer(subject, query, exact, &rough.with_max_distance(exact.distance).with_hint(hint));
    assert_eq!(found.distance, exact.distance, "{}: {found:?}", context());
    let short = T::round_down_from_f64(distance * (1.0 - 1e-6));
    if short < exact.distance {
        let options = rough.with_max_distance(short).with_max_visits(5);
        assert_eq!(subject.index.closest_point_with(query, &options), None, "{}: beyond {short:?}", context());
    }
}
