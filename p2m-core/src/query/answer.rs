//! Conversions between limits on distances, squared distances and answers.

use crate::query::Closest;
use crate::real::from_f64_array;
use crate::{Key, PrimitiveId, Projection, Real};

/// The factor 1 + 16 u of f64, by which a value with a few roundings is enlarged to an upper bound.
pub(crate) const ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
/// The factor 1 - 16 u of f64, by which a value with a few roundings is reduced to a lower bound.
pub(crate) const ROUND_DOWN: f64 = 1.0 - 8.0 * f64::EPSILON;

/// Returns the square above which a lower bound is certainly beyond a radius.
#[must_use]
pub fn square_within(radius: f64) -> f64 {
    // Rounding near zero may reduce a distance by up to a smallest subnormal, which is added here.
    Key::from_offset([radius + f64::from_bits(1), 0.0, 0.0]).square_above() * ROUND_UP
}

/// Converts a bound that is certain apart from rounding to the lower bound of an answer.
pub(crate) fn lower_bound<T: Real>(bound: f64) -> T {
    // Each rounding near zero costs one smallest subnormal. An infinite error leaves a bound of zero.
    let bound = bound * ROUND_DOWN - 2.0 * f64::from_bits(1);
    if bound > 0.0 { T::round_down_from_f64(bound) } else { T::zero() }
}

/// Returns the answer for a primitive whose distance is at least `bound`, apart from rounding.
pub(crate) fn answer<T: Real>(primitive: PrimitiveId, p: &Projection, bound: f64) -> Closest<T> {
    Closest {
        point: from_f64_array(p.point.coords.into()),
        distance: T::round_from_f64(p.key.distance()),
        lower_bound: lower_bound(bound),
        primitive,
        feature: p.feature,
        barycentric: p.barycentric.map(T::round_from_f64),
    }
}
