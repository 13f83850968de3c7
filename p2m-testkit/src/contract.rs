//! What an answer about one primitive promises (N1, N5, N6 and N7 of docs/proofs/accuracy.md), against the truth.
//!
//! Of isolated primitives, because in a mesh the neighbours hide the errors of a kernel.

use crate::families::shape;
use crate::truth::Truth;
use p2m_core::{Best, Closest, Collector, Feature, Primitive, PrimitiveId, QueryOptions, Real};
use rand::{Rng, RngExt};

/// The largest error that was ever observed must stay below this many u M;
/// [`ERROR_CONSTANT`](p2m_core::kernel::ERROR_CONSTANT) is what is proved.
pub const OBSERVED: f64 = 4.0;

/// The sum of the vertices by their weights is as near to the point as that is to the primitive, but for this many u of the
/// largest coordinate (observed).
const WEIGHED: f64 = 8.0;

/// A broken promise.
#[derive(Clone, Debug)]
pub struct Violation {
    /// The clause, as in docs/proofs/accuracy.md.
    pub clause: &'static str,
    /// What is wrong.
    pub what: String,
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.clause, self.what)
    }
}

/// Fails with what is wrong, of a clause.
macro_rules! keep {
    ($condition:expr, $clause:literal, $($what:tt)+) => {
        // Of NaN no comparison holds.
        let holds: bool = $condition;
        if !holds {
            return Err(Violation { clause: $clause, what: format!($($what)+) });
        }
    };
}

/// The answer about a primitive in `T`, whose coordinates are given in f64; returns its error in u M.
///
/// # Errors
/// The first promise that it does not keep.
pub fn check<T: Real>(query: [f64; 3], vertices: &[[f64; 3]], found: &Closest<T>) -> Result<f64, Violation> {
    let single = T::UNIT_ROUNDOFF > f64::UNIT_ROUNDOFF;
    let bits = if single { 24 } else { 53 };
    let truth = Truth::new(query, vertices);
    let distance = found.distance.to_f64();
    let eta = T::SMALLEST_SUBNORMAL;
    keep!(!distance.is_nan(), "N6", "the distance is NaN");
    let error = if distance == f64::INFINITY {
        let limit = largest::<T>();
        // The distance and its error exceed the range, M being 2 sqrt(3) of it at most.
        let error = 3.5 * OBSERVED * T::UNIT_ROUNDOFF * limit;
        keep!(truth.is_at_least(limit - error), "N1", "infinite below the range of the scalar");
        0.0
    } else {
        truth.error(distance, bits, eta)
    };
    keep!(error <= OBSERVED, "N1", "error of {error} u M");
    if vertices.len() == 1 && distance < f64::INFINITY {
        let relative = truth.relative_error(distance, bits, eta);
        keep!(relative <= 4.0, "N1", "relative error of {relative} u for a point");
    }
    let lower = found.lower_bound.to_f64();
    keep!(lower <= distance && truth.is_at_least(lower), "N7", "lower bound {lower:e} of {distance:e}");

    let point: [f64; 3] = found.point.map(Real::to_f64).coords.into();
    for k in 0..3 {
        let low = vertices.iter().map(|v| v[k]).fold(f64::INFINITY, f64::min);
        let high = vertices.iter().map(|v| v[k]).fold(f64::NEG_INFINITY, f64::max);
        keep!((low..=high).contains(&point[k]), "N5", "the point is outside the box on axis {k}");
    }
    let weights = found.barycentric.map(Real::to_f64);
    let sum: f64 = weights.iter().sum();
    keep!(weights.iter().all(|w| *w >= 0.0), "N5", "negative weights {weights:?}");
    keep!((sum - 1.0).abs() <= 4.0 * T::UNIT_ROUNDOFF, "N5", "weights {weights:?} add up to {sum}");
    if let Feature::Vertex(i) = found.feature {
        #[allow(clippy::float_cmp, reason = "verbatim")]
        let verbatim = point == vertices[usize::from(i)];
        keep!(verbatim, "N5", "vertex {i} is not answered verbatim");
    }
    let has_weight = |k: usize| match found.feature {
        Feature::Vertex(i) => k == usize::from(i),
        Feature::Edge(i) => k == usize::from(i) || k == (usize::from(i) + 1) % vertices.len(),
        Feature::Face => vertices.len() == 3,
    };
    for (k, weight) in weights.into_iter().enumerate() {
        let may = k < vertices.len() && has_weight(k);
        keep!(may || weight == 0.0, "N5", "{:?}: {weights:?}", found.feature);
    }

    // How far the point is from the primitive that it should lie on, and from where its weights say.
    let u = T::UNIT_ROUNDOFF;
    let size = |all: &[f64]| all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let slack = 4.0 * u * size(&query) + truth.of_reach(8.0 * u) + 2.0 * eta;
    // "At most the slack" is "not at least the next larger number".
    let off = Truth::new(point, vertices);
    keep!(!off.is_at_least(slack.next_up()), "N5", "the point is off the primitive by more than {slack:e}");
    let slack = slack + WEIGHED * u * size(vertices.as_flattened());
    for k in 0..3 {
        // Halves, that do not overflow.
        let there: f64 = weights.iter().zip(vertices).map(|(w, v)| w * (0.5 * v[k])).sum();
        let off = (there - 0.5 * point[k]).abs();
        keep!(off <= 0.5 * slack + 2.0 * eta, "N5", "the weights {weights:?} are of a point {:e} aside", 2.0 * off);
    }
    Ok(error)
}

/// The largest number of a scalar.
fn largest<T: Real>() -> f64 {
    if T::UNIT_ROUNDOFF > f64::UNIT_ROUNDOFF { f32::MAX.into() } else { f64::MAX }
}

/// What every exact backend answers about one primitive alone; all finite.
#[must_use]
pub fn answer<T: Real>(query: [T; 3], vertices: &[[T; 3]]) -> Closest<T> {
    let mut best = Best::new(&QueryOptions::default());
    best.offer(PrimitiveId::new(0), shape(vertices).project(&query.into()));
    best.finish().expect("the distance is within infinity")
}

/// N4 is promised for coordinates that are zero or at least 2^TINY of the largest.
const TINY: i32 = -200;

/// N4: whether `found` is the answer about the vertices in another order, and, all scaled by a power of two, scaled by as much;
/// numbers are compared, so that zeros may differ in their signs. Returns how many of the two comparisons could be made.
///
/// # Errors
/// If one is not.
#[allow(clippy::float_cmp, reason = "the same bits")]
pub fn check_invariance<T: Real>(
    rng: &mut impl Rng,
    query: [T; 3],
    vertices: &[[T; 3]],
    found: &Closest<T>,
) -> Result<u64, Violation> {
    let mut other = [query; 3];
    let other = &mut other[..vertices.len()];
    other.copy_from_slice(vertices);
    // Any order but that which it is in: a part turned by one or two, or the other way round.
    let turns = rng.random_range(0..vertices.len());
    other.rotate_left(turns);
    if turns == 0 || rng.random_bool(0.5) {
        other.reverse();
    }
    let mut compared = 0;
    if other != vertices {
        let there = answer(query, other);
        let same = there.distance == found.distance && there.point == found.point;
        keep!(same, "N4", "{other:?}: {there:?}, not {found:?}");
        compared += 1;
    }

    let (smallest, largest) = (T::SMALLEST_SUBNORMAL / (2.0 * T::UNIT_ROUNDOFF), largest::<T>());
    let is_normal = |x: f64| (smallest..=largest).contains(&x.abs());
    let most = if largest == f64::MAX { 600 } else { 80 };
    let e = rng.random_range(-most..most);
    let scale = |x: f64| x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2);
    // Zero stays zero, everything else has to stay normal and not be tiny beside the largest coordinate.
    let all = || vertices.as_flattened().iter().chain(&query).map(|x| x.to_f64());
    let size = all().fold(0.0, |m: f64, x| m.max(x.abs()));
    let of_size = |x: f64| x == 0.0 || x.abs() / size >= 2f64.powi(TINY);
    let kept = |x: f64| x == 0.0 || is_normal(x) && is_normal(scale(x)) && of_size(x);
    if e == 0 || !all().all(kept) {
        return Ok(compared);
    }
    let results = |c: &Closest<T>| [c.distance, c.point.x, c.point.y, c.point.z].map(Real::to_f64);
    let scaled = |v: [T; 3]| v.map(|x| T::of_f64(scale(x.to_f64())));
    let there = answer(scaled(query), &vertices.iter().map(|v| scaled(*v)).collect::<Vec<_>>());
    // What became zero only by underflow, or infinite, is no result that has to be kept; nor is the smallest normal number, to
    // which a subnormal one may have been rounded.
    let fits = |x: f64| x == 0.0 || is_normal(x) && x.abs() > smallest;
    let alike = |x: f64, y: f64| fits(x) && fits(y) && (x == 0.0) == (y == 0.0);
    let pairs = || results(found).into_iter().zip(results(&there));
    let weights = || found.barycentric.into_iter().zip(there.barycentric);
    if !pairs().all(|(x, y)| alike(x, y) && of_size(x)) || !weights().all(|(x, y)| alike(x.to_f64(), y.to_f64())) {
        return Ok(compared);
    }
    let same = results(&there) == results(found).map(scale) && there.feature == found.feature;
    keep!(same && there.barycentric == found.barycentric, "N4", "scaled by 2^{e}: {there:?}, not {found:?}");
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
        check(query, &VERTICES, found).map_or_else(|broken| broken.clause, |_| "kept")
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
            ("N5", "weights of another place", |c| {
                // As many as there were, with the same sum.
                let [first, second] = [c.barycentric[0], c.barycentric[1]];
                c.barycentric[0] = first * 0.999_999_999_9;
                c.barycentric[1] = second + (first - c.barycentric[0]);
            }),
        ];
        for (query, feature) in CASES {
            let found = answer(query, &VERTICES);
            assert_eq!(clause(query, &found), "kept", "{feature}");
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
