//! Compares answers with rational arithmetic.

use super::answers::{Asked, known};
use super::scene::vertices;
use nalgebra::Point3;
use p2m::backend::kernel::ERROR_CONSTANT;
use p2m::{Closest, PrimitiveSet, QueryOptions, Real, Soup};
use p2m_testkit::contract;
use p2m_testkit::oracle::Distance;
use std::cmp::Ordering;

/// Returns the precision of a scalar in bits, and its largest number.
fn digits<T: Real>() -> (u32, f64) {
    if T::UNIT_ROUNDOFF == f64::UNIT_ROUNDOFF { (53, f64::MAX) } else { (24, f64::from(f32::MAX)) }
}

fn wide<T: Real>(p: &Point3<T>) -> [f64; 3] {
    p.map(T::to_f64).coords.into()
}

/// Returns the nearest primitive (the lowest id of several) and the distances of all.
fn nearest<T: Real>(soup: &Soup<T>, query: [f64; 3]) -> (usize, Vec<Distance>) {
    let all: Vec<_> = (0..soup.len()).map(|id| Distance::new(query, &vertices(soup, id))).collect();
    let less = |a: usize, b: usize| if all[b].compare(&all[a]) == Ordering::Less { b } else { a };
    ((0..all.len()).reduce(less).expect("not empty"), all)
}

/// Checks N1, N2, N5 and N7 of an answer.
pub fn ordinary<T: Real>(asked: &Asked<'_, T>, query: &Point3<T>, found: &Closest<T>) {
    let say = || format!("{}: {found:?}", asked.say(query));
    let (bits, largest) = digits::<T>();
    let (place, id) = (wide(query), found.primitive.index());
    let (best, all) = nearest(asked.soup, place);
    let own = vertices(asked.soup, id);
    let distance = found.distance.to_f64();
    if distance.is_finite() {
        // The distance exceeds that of the nearest primitive by at most its rounding, which implies N2.
        if !all[best].is_at_least(distance) {
            let wrong = all[best].error(distance, bits, T::SMALLEST_SUBNORMAL);
            assert!(wrong <= ERROR_CONSTANT, "{}: N2, {wrong} from primitive {best}", say());
        }
    } else {
        // A distance above the range has the rounding error of the largest possible vertices.
        assert!(all[best].is_at_least(largest * (1.0 - 32.0 * T::UNIT_ROUNDOFF)), "{}: infinite", say());
    }
    assert!(all[best].is_at_least(found.lower_bound.to_f64()), "{}: N7", say());
    // The other fields are checked against the primitive that the answer names.
    if let Err(broken) = contract::check(place, &own, found) {
        panic!("{}: {broken}", say());
    }
}

/// Checks N8: the answer is the nearest primitive, the lowest id of several that are exactly as near, with the rounded
/// distance.
pub fn certified<T: Real>(asked: &Asked<'_, T>, query: &Point3<T>) {
    let (bits, largest) = digits::<T>();
    let (id, all) = nearest(asked.soup, wide(query));
    let truth = &all[id];
    let ask = |options: &QueryOptions<T>| asked.index.certified_closest_point(query, options).expect("vertices");
    let found = ask(&QueryOptions::default()).expect("something");
    let say = || format!("{}: {found:?}, primitive {id}", asked.say(query));
    assert_eq!(found.primitive.index(), id, "{}", say());
    let distance = found.distance.to_f64();
    let lower = found.lower_bound.to_f64();
    assert!(lower <= distance && truth.is_at_least(lower), "{}: N7", say());
    if distance.is_finite() {
        let wrong = truth.relative_error(distance, bits, T::SMALLEST_SUBNORMAL);
        assert!(wrong <= 1.0 + 1e-4, "{}: {wrong} u d", say());
    } else {
        assert!(truth.is_at_least(largest), "{}: infinite", say());
    }
    // A radius is compared without rounding.
    let all_of_it = (known(&found), found.lower_bound);
    let unit = distance * 2.0 * T::UNIT_ROUNDOFF + T::SMALLEST_SUBNORMAL;
    for radius in [distance, distance - unit, distance + 2.0 * unit, distance * 0.5] {
        let radius = T::of_f64(radius);
        let found = ask(&QueryOptions::default().with_max_distance(radius)).map(|c| (known(&c), c.lower_bound));
        let r = radius.to_f64();
        let is_within = || truth.compare(&Distance::new([0.0; 3], &[[r, 0.0, 0.0]])) != Ordering::Greater;
        let expected = if r == f64::INFINITY || r >= 0.0 && is_within() { Some(all_of_it) } else { None };
        assert_eq!(found, expected, "{}: within {r:e}", say());
    }
}
