//! Checks the promises of an answer about one primitive (N1, N4 to N7 of docs/proofs/accuracy.md) against the true
//! distance.
//!
//! The primitives are isolated, because in a mesh the neighbours hide the errors of a kernel.

use crate::families::shape;
use crate::truth::Truth;
use p2m_core::{Best, Closest, Collector, Feature, Primitive, PrimitiveId, QueryOptions, Real};
use rand::{Rng, RngExt};

/// The limit on the observed error, in units of u M. The proved bound is
/// [`ERROR_CONSTANT`](p2m_core::kernel::ERROR_CONSTANT).
pub const MAX_OBSERVED_ERROR: f64 = 4.0;

/// The distance by which the weighted sum of the vertices may be farther from the point than the point is from the
/// primitive, in units of u of the largest coordinate (observed).
const WEIGHTED_SUM_SLACK: f64 = 8.0;

/// A broken promise.
#[derive(Clone, Debug)]
pub struct Violation {
    /// The clause of docs/proofs/accuracy.md that was broken.
    pub clause: &'static str,
    /// A description of the error.
    pub what: String,
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.clause, self.what)
    }
}

/// Returns a [`Violation`] of a clause from the surrounding function unless the condition holds.
macro_rules! ensure {
    ($condition:expr, $clause:literal, $($what:tt)+) => {
        // A condition on NaN evaluates to false, so NaN violates the clause.
        let holds: bool = $condition;
        if !holds {
            return Err(Violation { clause: $clause, what: format!($($what)+) });
        }
    };
}

/// Checks the answer in `T` about a primitive whose coordinates are given in f64, and returns the error in units of u
/// M.
///
/// # Errors
/// Returns the first promise that the answer breaks.
pub fn check<T: Real>(query: [f64; 3], vertices: &[[f64; 3]], found: &Closest<T>) -> Result<f64, Violation> {
    let single = T::UNIT_ROUNDOFF > f64::UNIT_ROUNDOFF;
    let bits = if single { 24 } else { 53 };
    let truth = Truth::new(query, vertices);
    let distance = found.distance.to_f64();
    let eta = T::SMALLEST_SUBNORMAL;
    ensure!(!distance.is_nan(), "N6", "the distance is NaN");
    let error = if distance == f64::INFINITY {
        let limit = largest::<T>();
        // The distance may overflow by its error. M is at most 2 sqrt(3) times the limit.
        let error = 3.5 * MAX_OBSERVED_ERROR * T::UNIT_ROUNDOFF * limit;
        ensure!(truth.is_at_least(limit - error), "N1", "infinite below the range of the scalar");
        0.0
    } else {
        truth.error(distance, bits, eta)
    };
    ensure!(error <= MAX_OBSERVED_ERROR, "N1", "error of {error} u M");
    if vertices.len() == 1 && distance < f64::INFINITY {
        let relative = truth.relative_error(distance, bits, eta);
        ensure!(relative <= 4.0, "N1", "relative error of {relative} u for a point");
    }
    let lower = found.lower_bound.to_f64();
    ensure!(lower <= distance && truth.is_at_least(lower), "N7", "lower bound {lower:e} of {distance:e}");

    let point: [f64; 3] = found.point.map(Real::to_f64).coords.into();
    for k in 0..3 {
        let low = vertices.iter().map(|v| v[k]).fold(f64::INFINITY, f64::min);
        let high = vertices.iter().map(|v| v[k]).fold(f64::NEG_INFINITY, f64::max);
        ensure!((low..=high).contains(&point[k]), "N5", "the point is outside the box on axis {k}");
    }
    let weights = found.barycentric.map(Real::to_f64);
    let sum: f64 = weights.iter().sum();
    ensure!(weights.iter().all(|w| *w >= 0.0), "N5", "negative weights {weights:?}");
    ensure!((sum - 1.0).abs() <= 4.0 * T::UNIT_ROUNDOFF, "N5", "weights {weights:?} add up to {sum}");
    if let Feature::Vertex(i) = found.feature {
        #[allow(clippy::float_cmp, reason = "verbatim")]
        let verbatim = point == vertices[usize::from(i)];
        ensure!(verbatim, "N5", "vertex {i} is not answered verbatim");
    }
    let has_weight = |k: usize| match found.feature {
        Feature::Vertex(i) => k == usize::from(i),
        Feature::Edge(i) => k == usize::from(i) || k == (usize::from(i) + 1) % vertices.len(),
        Feature::Face => vertices.len() == 3,
    };
    for (k, weight) in weights.into_iter().enumerate() {
        let may = k < vertices.len() && has_weight(k);
        ensure!(may || weight == 0.0, "N5", "{:?}: {weights:?}", found.feature);
    }

    // The limit on the distance of the point from the primitive and from the weighted sum of the vertices.
    let u = T::UNIT_ROUNDOFF;
    let size = |all: &[f64]| all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let slack = 4.0 * u * size(&query) + truth.times_max_vertex_distance(8.0 * u) + 2.0 * eta;
    // `Truth` has only `is_at_least`, so "at most the slack" is tested as "not at least the next larger number".
    let off = Truth::new(point, vertices);
    ensure!(!off.is_at_least(slack.next_up()), "N5", "the point is off the primitive by more than {slack:e}");
    let slack = slack + WEIGHTED_SUM_SLACK * u * size(vertices.as_flattened());
    for k in 0..3 {
        // Coordinates are halved so that sums do not overflow.
        let other: f64 = weights.iter().zip(vertices).map(|(w, v)| w * (0.5 * v[k])).sum();
        let off = (other - 0.5 * point[k]).abs();
        ensure!(off <= 0.5 * slack + 2.0 * eta, "N5", "the weights {weights:?} are of a point {:e} aside", 2.0 * off);
    }
    Ok(error)
}

/// Returns the largest finite number of a scalar.
fn largest<T: Real>() -> f64 {
    if T::UNIT_ROUNDOFF > f64::UNIT_ROUNDOFF { f32::MAX.into() } else { f64::MAX }
}

/// Returns the answers of the exact backends about one primitive alone; all coordinates are finite.
#[must_use]
pub fn answer<T: Real>(query: [T; 3], vertices: &[[T; 3]]) -> Closest<T> {
    let mut best = Best::new(&QueryOptions::default());
    best.offer(PrimitiveId::new(0), shape(vertices).project(&query.into()));
    best.finish().expect("the distance is within infinity")
}

/// The exponent of two below which N4 promises nothing: coordinates are zero or at least 2^N4_MIN_EXPONENT times the
/// largest one.
const N4_MIN_EXPONENT: i32 = -200;

/// Checks N4: the answer stays the same if the vertices are reordered, and scales with the coordinates if these are
/// multiplied by a power of two. Numbers are compared by value, so zeros may differ in sign. Returns how many of the
/// two comparisons were possible.
/// many of the two comparisons were possible.
///
/// # Errors
/// Returns the violation if an answer differs.
#[allow(clippy::float_cmp, reason = "the same bits")]
pub fn check_invariance<T: Real>(
    rng: &mut impl Rng,
    query: [T; 3],
    vertices: &[[T; 3]],
    found: &Closest<T>,
) -> Result<u64, Violation> {
    let mut reordered = [query; 3];
    let reordered = &mut reordered[..vertices.len()];
    reordered.copy_from_slice(vertices);
    // The new order is a rotation by one or two vertices, a reversal, or both.
    let turns = rng.random_range(0..vertices.len());
    reordered.rotate_left(turns);
    if turns == 0 || rng.random_bool(0.5) {
        reordered.reverse();
    }
    let mut compared = 0;
    if reordered != vertices {
        let other = answer(query, reordered);
        let same = other.distance == found.distance && other.point == found.point;
        ensure!(same, "N4", "{reordered:?}: {other:?}, not {found:?}");
        compared += 1;
    }

    let (smallest, largest) = (T::SMALLEST_SUBNORMAL / (2.0 * T::UNIT_ROUNDOFF), largest::<T>());
    let is_normal = |x: f64| (smallest..=largest).contains(&x.abs());
    let max_exponent = if largest == f64::MAX { 600 } else { 80 };
    let e = rng.random_range(-max_exponent..max_exponent);
    let scale = |x: f64| x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2);
    // Zeros stay zeros. Other coordinates have to remain normal numbers that are not tiny beside the largest one.
    let all = || vertices.as_flattened().iter().chain(&query).map(|x| x.to_f64());
    let size = all().fold(0.0, |m: f64, x| m.max(x.abs()));
    let is_large_enough = |x: f64| x == 0.0 || x.abs() / size >= 2f64.powi(N4_MIN_EXPONENT);
    let stays_normal = |x: f64| x == 0.0 || is_normal(x) && is_normal(scale(x)) && is_large_enough(x);
    if e == 0 || !all().all(stays_normal) {
        return Ok(compared);
    }
    let results = |c: &Closest<T>| [c.distance, c.point.x, c.point.y, c.point.z].map(Real::to_f64);
    let scaled = |v: [T; 3]| v.map(|x| T::round_from_f64(scale(x.to_f64())));
    let other = answer(scaled(query), &vertices.iter().map(|v| scaled(*v)).collect::<Vec<_>>());
    // Results that become zero by underflow, or infinite, need not be preserved. The smallest normal number is excluded
    // as well, because a subnormal number may have been rounded to it.
    let fits = |x: f64| x == 0.0 || is_normal(x) && x.abs() > smallest;
    let alike = |x: f64, y: f64| fits(x) && fits(y) && (x == 0.0) == (y == 0.0);
    let pairs = || results(found).into_iter().zip(results(&other));
    let weights = || found.barycentric.into_iter().zip(other.barycentric);
    if !pairs().all(|(x, y)| alike(x, y) && is_large_enough(x))
        || !weights().all(|(x, y)| alike(x.to_f64(), y.to_f64()))
    {
        return Ok(compared);
    }
    let same = results(&other) == results(found).map(scale) && other.feature == found.feature;
    ensure!(same && other.barycentric == found.barycentric, "N4", "scaled by 2^{e}: {other:?}, not {found:?}");
    Ok(compared + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle seen from above its face, from beside an edge and from beyond a vertex.
    const CASES: [([f64; 3], &str); 3] =
        [([0.3, 0.4, 0.7], "face"), ([0.7, -0.4, 0.3], "edge"), ([-0.5, -0.75, 0.3], "vertex")];
    const VERTICES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]];

    fn clause(query: [f64; 3], found: &Closest<f64>) -> &'static str {
        check(query, &VERTICES, found).map_or_else(|broken| broken.clause, |_| "stays_normal")
    }

    #[test]
    fn whatever_is_wrong_with_an_answer_is_told() {
        type Change = fn(&mut Closest<f64>);
        let changes: [(&str, &str, Change); 13] = [
            ("N6", "distance", |c| c.distance = f64::NAN),
            ("N1", "distance", |c| c.distance = f64::INFINITY),
            ("N1", "distance", |c| c.distance *= 1.0 + 64.0 * f64::EPSILON),
            ("N1", "distance", |c| c.distance *= 1.0 - 64.0 * f64::EPSILON),
            ("N7", "bound", |c| c.lower_bound = c.distance.next_up()),
            ("N7", "bound", |c| c.lower_bound = f64::NAN),
            ("N5", "point below the face", |c| c.point.z = -1e-12),
            ("N5", "point that is none", |c| c.point.x = f64::NAN),
            ("N5", "point elsewhere on the face", |c| c.point += nalgebra::Vector3::new(1e-12, 1e-12, 0.0)),
            ("N5", "weights of other vertices", |c| c.barycentric.rotate_left(1)),
            ("N5", "weights that are none", |c| c.barycentric = [f64::NAN; 3]),
            ("N5", "weights that are too large", |c| c.barycentric = c.barycentric.map(|w| w * (1.0 + 1e-14))),
            ("N5", "weights of another point", |c| {
                // The changed weights keep their sum, so only their distribution is wrong.
                let [first, second] = [c.barycentric[0], c.barycentric[1]];
                c.barycentric[0] = first * 0.999_999_999_9;
                c.barycentric[1] = second + (first - c.barycentric[0]);
            }),
        ];
        for (query, feature) in CASES {
            let found = answer(query, &VERTICES);
            assert_eq!(clause(query, &found), "stays_normal", "{feature}");
            for (expected, what, change) in changes {
                let mut wrong = found;
                change(&mut wrong);
                assert_eq!(clause(query, &wrong), expected, "{feature}, {what}: {wrong:?}");
            }
            let mut features = [Feature::Vertex(1), Feature::Vertex(2), Feature::Edge(1)].to_vec();
            features.extend((feature != "vertex").then_some(Feature::Vertex(0)));
            for other in features {
                let mut wrong = found;
                wrong.feature = other;
                assert_eq!(clause(query, &wrong), "N5", "{feature}, {other:?}");
            }
        }
    }

    #[test]
    fn infinite_answers_are_looked_at_too() {
        let query = [-1e308, -1e308, 1e308];
        let vertices = [[1e308, 1e308, 0.0], [1.2e308, 1e308, 0.0], [1e308, 1.2e308, 0.0]];
        let found = answer(query, &vertices);
        assert_eq!(found.distance, f64::INFINITY);
        assert!(check(query, &vertices, &found).is_ok());
        let mut wrong = found;
        wrong.barycentric = [0.0, 0.0, 1.0];
        assert_eq!(check(query, &vertices, &wrong).unwrap_err().clause, "N5");
        wrong = found;
        wrong.point.x *= 1.1;
        assert_eq!(check(query, &vertices, &wrong).unwrap_err().clause, "N5");
    }
}
