//! The errors of answers.

use crate::measure::tradeoff::settings::Promise;
use p2m_core::engine::stats::percentile;
use p2m_core::{Closest, PrimitiveId, Real};
use serde::Serialize;

/// The true answer to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Truth {
    /// The true distance, rounded.
    pub(crate) distance: f64,
    /// M: the largest distance from the query to a vertex of the nearest primitive.
    pub(crate) max_vertex_distance: f64,
    /// The nearest primitive, the one with the lowest id among equally near primitives.
    pub(crate) primitive: PrimitiveId,
}

impl Truth {
    /// The error of a distance.
    fn error(&self, distance: f64) -> f64 {
        (distance - self.distance).abs()
    }

    /// The unit of scaled errors, u M.
    fn unit(&self) -> f64 {
        f64::UNIT_ROUNDOFF * self.max_vertex_distance
    }
}

/// The largest error and the 99.9th percentile of errors; NaN if there are none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct ErrorQuantiles {
    /// The largest error.
    pub(crate) max: f64,
    /// The 99.9th percentile.
    pub p999: f64,
}

impl ErrorQuantiles {
    /// Computes the quantiles of errors in any order.
    pub(crate) fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let at = |per_mille| percentile(&errors, per_mille, 1000).unwrap_or(f64::NAN);
        Self { max: at(1000), p999: at(999) }
    }
}

/// The errors of the answers to some queries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Errors {
    /// The number of answers that were compared.
    pub(crate) compared: usize,
    /// The number of queries without a finite answer. They are left out of all other figures.
    pub(crate) unanswered: usize,
    /// The errors in units of u M.
    pub(crate) scaled: ErrorQuantiles,
    /// The errors relative to the true distance, for queries where it is not 0.
    pub(crate) relative: ErrorQuantiles,
    /// The largest gap between a distance and its certified lower bound, relative to the distance; NaN without bounds.
    pub(crate) gap: f64,
    /// The number of lower bounds above the true distance.
    pub(crate) bounds_above_truth: usize,
    /// The number of answers with another primitive than the nearest one.
    pub(crate) other_ids: usize,
    /// The number of answers with a larger error than promised.
    pub(crate) broken: usize,
}

impl Errors {
    /// Compares each answer with its truth.
    pub(crate) fn of(answers: &[Option<Closest<f64>>], truths: &[Truth], promise: Promise) -> Self {
        let answered = |(answer, truth): (&Option<Closest<f64>>, _)| Some((*answer.as_ref()?, truth));
        let pairs =
            || answers.iter().zip(truths).filter_map(answered).filter(|(answer, _)| answer.distance.is_finite());
        let error = |(answer, truth): &(Closest<f64>, &Truth)| truth.error(answer.distance);
        let gap = |(answer, _): (Closest<f64>, &Truth)| {
            if answer.distance > 0.0 { (answer.distance - answer.lower_bound) / answer.distance } else { 0.0 }
        };
        Self {
            compared: pairs().count(),
            unanswered: answers.len() - pairs().count(),
            scaled: ErrorQuantiles::of(pairs().map(|pair| in_units(error(&pair), pair.1.unit())).collect()),
            relative: ErrorQuantiles::of(
                pairs().filter(|(_, t)| t.distance > 0.0).map(|pair| error(&pair) / pair.1.distance).collect(),
            ),
            gap: pairs().map(gap).fold(f64::NAN, f64::max),
            bounds_above_truth: pairs().filter(|(answer, truth)| answer.lower_bound > truth.distance).count(),
            other_ids: pairs().filter(|(answer, truth)| answer.primitive != truth.primitive).count(),
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
    use nalgebra::Point3;
    use p2m_core::{BruteForce, ClosestPoint, Point};

    const U: f64 = f64::EPSILON / 2.0;

    fn truth(distance: f64) -> Truth {
        Truth { distance, max_vertex_distance: 2.0, primitive: PrimitiveId::new(7) }
    }

    fn answer(distance: f64, lower_bound: f64, id: usize) -> Option<Closest<f64>> {
        let site = [Point::new(Point3::origin())];
        let mut closest = BruteForce::new(&site).unwrap().closest_point(&[0.0; 3])?;
        (closest.distance, closest.lower_bound, closest.primitive) = (distance, lower_bound, PrimitiveId::new(id));
        Some(closest)
    }

    #[test]
    fn errors_are_in_their_units() {
        let answers = [answer(1.0, 1.0, 7), answer(1.25, 0.75, 7), answer(1.0 + 8.0 * U, 1.0 + 2.0 * U, 8), None];
        let errors = Errors::of(&answers, &[truth(1.0); 4], Promise::Within(0.1));
        assert_eq!((errors.compared, errors.unanswered), (3, 1));
        assert_eq!(errors.scaled.max, 0.25 / (2.0 * U));
        assert_eq!((errors.relative.max, errors.gap), (0.25, 0.4));
        assert_eq!((errors.bounds_above_truth, errors.other_ids, errors.broken), (1, 1, 1));
        let alone = Errors::of(&answers[2..3], &[truth(1.0)], Promise::Nothing);
        assert_eq!((alone.scaled.max, alone.relative.p999), (4.0, 8.0 * U));
    }

    #[test]
    fn a_distance_of_zero_has_no_relative_error() {
        let errors = Errors::of(&[answer(2.0 * U, 0.0, 7)], &[truth(0.0)], Promise::Nothing);
        assert!(errors.relative.max.is_nan());
        assert_eq!(errors.scaled.max, 1.0);
        // A query that lies on a point: no error, in a unit of nothing.
        let point = Truth { max_vertex_distance: 0.0, ..truth(0.0) };
        assert_eq!(Errors::of(&[answer(0.0, 0.0, 7)], &[point], Promise::Nothing).scaled.max, 0.0);
    }
}
