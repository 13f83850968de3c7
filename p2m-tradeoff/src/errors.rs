//! How wrong answers are.

use crate::settings::Promise;
use crate::spread::percentile;
use crate::subject::Answer;
use p2m_core::Real;

/// What is true of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The true distance, rounded.
    pub distance: f64,
    /// What the true distance has beyond that, as far as it is known; 0 where rounding is not looked at.
    pub rest: f64,
    /// M: the largest distance from the query to a vertex of the nearest primitive.
    pub reach: f64,
    /// The nearest primitive, the one of the lowest number among equally near ones.
    pub id: u32,
}

impl Truth {
    /// By how much a distance differs from it.
    fn error(&self, distance: f64) -> f64 {
        ((distance - self.distance) - self.rest).abs()
    }

    /// u M
    fn unit(&self) -> f64 {
        f64::UNIT_ROUNDOFF * self.reach
    }
}

/// The worst of some errors, and what is exceeded by one in a thousand; NaN if there are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The largest.
    pub max: f64,
    /// The 99.9th percentile.
    pub p999: f64,
}

impl Worst {
    /// Of errors in any order.
    #[must_use]
    pub fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let at = |parts| percentile(&errors, parts, 1000).unwrap_or(f64::NAN);
        Self { max: at(1000), p999: at(999) }
    }
}

/// How wrong the answers to some queries are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Answers that were compared.
    pub compared: usize,
    /// Queries without a finite answer, which count in nothing below.
    pub unanswered: usize,
    /// In units of u M.
    pub scaled: Worst,
    /// Relative to the true distance, of queries where it is not 0.
    pub relative: Worst,
    /// The largest part of an answer that its certified lower bound leaves open; NaN where there are no bounds.
    pub gap: f64,
    /// How many lower bounds are above the true distance.
    pub bounds_above: usize,
    /// How many answers name another primitive than the nearest one; `None` where primitives are not named.
    pub other_ids: Option<usize>,
    /// How many answers are farther from the truth than promised.
    pub broken: usize,
}

impl Errors {
    /// Compares answers with what is true, one for one.
    #[must_use]
    pub fn of(answers: &[Answer], truths: &[Truth], promise: Promise) -> Self {
        let pairs = || answers.iter().zip(truths).filter(|(answer, _)| answer.distance.is_finite());
        let error = |(answer, truth): &(&Answer, &Truth)| truth.error(answer.distance);
        let named = pairs().any(|(answer, _)| answer.id != u32::MAX);
        let bounded = || pairs().filter(|(answer, _)| !answer.lower_bound.is_nan());
        // The true distance is within half a unit in the last place of the rounded one, and exact with its rest.
        let above = |(answer, truth): &(&Answer, &Truth)| (answer.lower_bound - truth.distance) - truth.rest > 0.0;
        let gap = |(answer, _): (&Answer, &Truth)| {
            if answer.distance > 0.0 { (answer.distance - answer.lower_bound) / answer.distance } else { 0.0 }
        };
        Self {
            compared: pairs().count(),
            unanswered: answers.len() - pairs().count(),
            scaled: Worst::of(pairs().map(|pair| over(error(&pair), pair.1.unit())).collect()),
            relative: Worst::of(
                pairs().filter(|(_, t)| t.distance > 0.0).map(|pair| error(&pair) / pair.1.distance).collect(),
            ),
            gap: bounded().map(gap).fold(f64::NAN, f64::max),
            bounds_above: bounded().filter(above).count(),
            other_ids: named.then(|| pairs().filter(|(answer, truth)| answer.id != truth.id).count()),
            broken: pairs().filter(|p| !promise.is_kept(error(p), p.1.distance, p.1.unit())).count(),
        }
    }
}

/// A quotient, of which 0 over 0 is 0: no error, of something that has no size.
fn over(error: f64, unit: f64) -> f64 {
    if error > 0.0 { error / unit } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: Truth = Truth { distance: 1.0, rest: 0.0, reach: 2.0, id: 7 };
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
        assert_eq!((errors.bounds_above, errors.other_ids, errors.broken), (1, Some(1), 1));
        let alone = Errors::of(&answers[2..3], &[TRUTH], Promise::Nothing);
        assert_eq!((alone.scaled.max, alone.relative.p999), (4.0, 8.0 * U));
    }

    #[test]
    fn what_the_true_distance_has_beyond_rounding_counts() {
        let truth = Truth { rest: 0.25 * U, ..TRUTH };
        let errors = Errors::of(&[answer(1.0, 1.0, 7)], &[truth], Promise::Within(0.0));
        assert_eq!((errors.scaled.max, errors.bounds_above), (0.125, 0));
        let below = Truth { rest: -0.25 * U, ..TRUTH };
        assert_eq!(Errors::of(&[answer(1.0, 1.0, 7)], &[below], Promise::Nothing).bounds_above, 1);
    }

    #[test]
    fn a_distance_of_zero_has_no_relative_error() {
        let truth = Truth { distance: 0.0, ..TRUTH };
        let errors = Errors::of(&[Answer::of_distance(2.0 * U)], &[truth], Promise::Nothing);
        assert!(errors.relative.max.is_nan() && errors.gap.is_nan() && errors.other_ids.is_none());
        assert_eq!(errors.scaled.max, 1.0);
        // A query that lies on a point: no error, in a unit of nothing.
        let point = Truth { reach: 0.0, ..truth };
        assert_eq!(Errors::of(&[Answer::of_distance(0.0)], &[point], Promise::Nothing).scaled.max, 0.0);
    }
}
