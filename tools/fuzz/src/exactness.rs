//! Comparison of answers with rational arithmetic.

use super::scene::vertices;
use super::subject::{Subject, compared_fields};
use nalgebra::Point3;
use p2m::core::kernel::ERROR_CONSTANT;
use p2m::{Closest, PrimitiveSet, QueryOptions, Real, Soup};
use p2m_testkit::contract;
use p2m_testkit::oracle::Distance;
use std::cmp::Ordering;

/// Returns the precision of a scalar in bits, and its largest number.
fn precision<T: Real>() -> (u32, f64) {
    if T::UNIT_ROUNDOFF == f64::UNIT_ROUNDOFF { (53, f64::MAX) } else { (24, f64::from(f32::MAX)) }
}

fn to_f64<T: Real>(p: &Point3<T>) -> [f64; 3] {
    p.map(T::to_f64).coords.into()
}

/// Returns the nearest primitive, the lowest id of equally near ones, and the distances of all.
pub fn nearest<T: Real>(soup: &Soup<T>, query: &Point3<T>) -> (usize, Vec<Distance>) {
    let query = to_f64(query);
    let all: Vec<_> = (0..soup.len()).map(|id| Distance::new(query, &vertices(soup, id))).collect();
    let less = |a: usize, b: usize| if all[b].compare(&all[a]) == Ordering::Less { b } else { a };
    ((0..all.len()).reduce(less).expect("not empty"), all)
}

/// Checks N1, N2, N5 and N7 of an answer.
pub fn check<T: Real>(subject: &Subject<'_, T>, query: &Point3<T>, found: &Closest<T>) {
    let context = || format!("{}: {found:?}", subject.describe(query));
    let (bits, largest) = precision::<T>();
    let (point, id) = (to_f64(query), found.primitive.index());
    let (best, all) = nearest(subject.soup, query);
    let vertices_of_answer = vertices(subject.soup, id);
    let distance = found.distance.to_f64();
    if distance.is_finite() {
        // The distance exceeds the least distance by at most its rounding, which implies N2.
        if !all[best].is_at_least(distance) {
            let wrong = all[best].error(distance, bits, T::SMALLEST_SUBNORMAL);
            assert!(wrong <= ERROR_CONSTANT, "{}: N2, {wrong} from primitive {best}", context());
        }
    } else {
        // A distance above the range is reported as infinite. Its rounding error is bounded by that of the largest
        // vertices.
        assert!(all[best].is_at_least(largest * (1.0 - 32.0 * T::UNIT_ROUNDOFF)), "{}: infinite", context());
    }
    assert!(all[best].is_at_least(found.lower_bound.to_f64()), "{}: N7", context());
    // The other fields are checked against the primitive of the answer.
    if let Err(broken) = contract::check(point, &vertices_of_answer, found) {
        panic!("{}: {broken}", context());
    }
}

/// Checks N8: the answer is the nearest primitive, the lowest id of exactly equally near ones, with the rounded
/// distance.
pub fn check_certified<T: Real>(subject: &Subject<'_, T>, query: &Point3<T>) {
    let (bits, largest) = precision::<T>();
    let (id, all) = nearest(subject.soup, query);
    let truth = &all[id];
    let certify = |options: &QueryOptions<T>| subject.index.certified_closest_point(query, options).expect("vertices");
    let found = certify(&QueryOptions::default()).expect("something");
    let context = || format!("{}: {found:?}, primitive {id}", subject.describe(query));
    assert_eq!(found.primitive.index(), id, "{}", context());
    let distance = found.distance.to_f64();
    let lower = found.lower_bound.to_f64();
    assert!(lower <= distance && truth.is_at_least(lower), "{}: N7", context());
    if distance.is_finite() {
        let wrong = truth.relative_error(distance, bits, T::SMALLEST_SUBNORMAL);
        assert!(wrong <= 1.0 + 1e-4, "{}: {wrong} u d", context());
    } else {
        assert!(truth.is_at_least(largest), "{}: infinite", context());
    }
    // The radius is compared without rounding.
    let answer = (compared_fields(&found), found.lower_bound);
    let unit = distance * 2.0 * T::UNIT_ROUNDOFF + T::SMALLEST_SUBNORMAL;
    for radius in [distance, distance - unit, distance + 2.0 * unit, distance * 0.5] {
        let radius = T::round_from_f64(radius);
        let found =
            certify(&QueryOptions::default().with_max_distance(radius)).map(|c| (compared_fields(&c), c.lower_bound));
        let r = radius.to_f64();
        let is_within = || truth.compare(&Distance::new([0.0; 3], &[[r, 0.0, 0.0]])) != Ordering::Greater;
        let expected = if r == f64::INFINITY || r >= 0.0 && is_within() { Some(answer) } else { None };
        assert_eq!(found, expected, "{}: within {r:e}", context());
    }
}
