//! The errors of answers.

use crate::backend::Answer;
use crate::settings::Promise;
use p2m_core::Real;
use p2m_core::engine::stats::percentile;
use serde::Serialize;

/// The true answer to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The true distance, rounded.
    pub distance: f64,
    /// The true distance minus the rounded one, as far as it is known; 0 if rounding errors are not compared.
    pub residual: f64,
    /// M: the largest distance from the query to a vertex of the nearest primitive.
    pub max_vertex_distance: f64,
    /// The id of the nearest primitive, the lowest one among equally near primitives.
    pub id: u32,
}

impl Truth {
    /// The error of a distance.
    fn error(&self, distance: f64) -> f64 {
        ((distance - self.distance) - self.residual).abs()
    }

    /// The unit of scaled errors, u M.
    fn unit(&self) -> f64 {
        f64::UNIT_ROUNDOFF * self.max_vertex_distance
    }
}

/// The largest error and the 99.9th percentile of errors; NaN if there are none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorQuantiles {
    /// The largest error.
    pub max: f64,
    /// The 99.9th percentile.
    pub p999: f64,
}

impl ErrorQuantiles {
    /// Computes the quantiles of errors in any order.
    #[must_use]
    pub fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let at = |per_mille| percentile(&errors, per_mille, 1000).unwrap_or(f64::NAN);
        Self { max: at(1000), p999: at(999) }
    }
}

/// The errors of the answers to some queries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The number of answers that were compared.
    pub compared: usize,
    /// The number of queries without a finite answer. They are left out of all other figures.
    pub unanswered: usize,
    /// The errors in units of u M.
    pub scaled: ErrorQuantiles,
    /// The errors relative to the true distance, for queries where it is not 0.
    pub relative: ErrorQuantiles,
    /// The largest gap between a distance and its certified lower bound, relative to the distance; NaN without bounds.
    pub gap: f64,
    /// The number of lower bounds above the true distance.
    pub bounds_above_truth: usize,
    /// The number of answers with another primitive than the nearest one; `None` if answers have no primitives.
    pub other_ids: Option<usize>,
    /// The number of answers with a larger error than promised.
    pub broken: usize,
}

impl Errors {
    /// Compares each answer with its truth.
    #[must_use]
    pub fn of(answers: &[Answer], truths: &[Truth], promise: Promise) -> Self {
        let pairs = || answers.iter().zip(truths).filter(|(answer, _)| answer.distance.is_finite());
        let error = |(answer, truth): &(&Answer, &Truth)| truth.error(answer.distance);
        let named = pairs().any(|(answer, _)| answer.id != u32::MAX);
        let bounded = || pairs().filter(|(answer, _)| !answer.lower_bound.is_nan());
        // The sum of the rounded distance and its residual is exact.
        let above = |(answer, truth): &(&Answer, &Truth)| (answer.lower_bound - truth.distance) - truth.residual > 0.0;
        let gap = |(answer, _): (&Answer, &Truth)| {
            if answer.distance > 0.0 { (answer.distance - answer.lower_bound) / answer.distance } else { 0.0 }
        };
        Self {
            compared: pairs().count(),
            unanswered: answers.len() - pairs().count(),
            scaled: ErrorQuantiles::of(pairs().map(|pair| in_units(error(&pair), pair.1.unit())).collect()),
            relative: ErrorQuantiles::of(
                pairs().filter(|(_, t)| t.distance > 0.0).map(|pair| error(&pair) / pair.1.distance).collect(),
            ),
            gap: bounded().map(gap).fold(f64::NAN, f64::max),
            bounds_above_truth: bounded().filter(above).count(),
            other_ids: named.then(|| pairs().filter(|(answer, truth)| answer.id != truth.id).count()),
            broken: pairs().filter(|p| !promise.is_kept(error(p), p.1.distance, p.1.unit())).count(),
        }
    }
}

/// Divides an error by its unit. The quotient of 0 and 0 is 0: a query on a point primitive has no error and no unit.
fn in_units(error: f64, unit: f64) -> f64 {
    if error > 0.0 { error / unit } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: Truth = Truth { distance: 1.0, residual: 0.0, max_vertex_distance: 2.0, id: 7 };
    const U: f64 = f64::EPSILON / 2.0;

    fn answer(distance: f64, lower_bound: f64, id: u32) -> Answer {
        Answer { distance, lower_bound, id }
    }

    #[test]
    fn errors_are_in_their_units() {
        let answers =
            [answer(1.0, 1.0, 7), answer(1.25, 0.75, 7), answer(1.0 + 8.0 * U, 1.0 + 2.0 * U, 8), Answer::NONE];
        let errors = Errors::of(&answers, &[TRUTH; 4], Promise::Within(0.1));
        assert_eq!((errors.compared, errors.unanswered), (3, 1));
        assert_eq!(errors.scaled.max, 0.25 / (2.0 * U));
        assert_eq!((errors.relative.max, errors.gap), (0.25, 0.4));
        assert_eq!((errors.bounds_above_truth, errors.other_ids, errors.broken), (1, Some(1), 1));
        let alone = Errors::of(&answers[2..3], &[TRUTH], Promise::Nothing);
        assert_eq!((alone.scaled.max, alone.relative.p999), (4.0, 8.0 * U));
    }

    #[test]
    fn what_the_true_distance_has_beyond_rounding_counts() {
        let truth = Truth { residual: 0.25 * U, ..TRUTH };
        let errors = Errors::of(&[answer(1.0, 1.0, 7)], &[truth], Promise::Within(0.0));
        assert_eq!((errors.scaled.max, errors.bounds_above_truth), (0.125, 0));
        let below = Truth { residual: -0.25 * U, ..TRUTH };
        assert_eq!(Errors::of(&[answer(1.0, 1.0, 7)], &[below], Promise::Nothing).bounds_above_truth, 1);
    }

    #[test]
    fn a_distance_of_zero_has_no_relative_error() {
        let truth = Truth { distance: 0.0, ..TRUTH };
        let errors = Errors::of(&[Answer::of_distance(2.0 * U)], &[truth], Promise::Nothing);
        assert!(errors.relative.max.is_nan() && errors.gap.is_nan() && errors.other_ids.is_none());
        assert_eq!(errors.scaled.max, 1.0);
        // A query that lies on a point: no error, in a unit of nothing.
        let point = Truth { max_vertex_distance: 0.0, ..truth };
        assert_eq!(Errors::of(&[Answer::of_distance(0.0)], &[point], Promise::Nothing).scaled.max, 0.0);
    }
}
