//! Measures competitors, and compares their answers with the truth outside of the measured time.

use crate::backend::{Answer, AnswerQueries, with_setting};
use crate::curve::{Build, Curve, Latency, Point};
use crate::errors::{Errors, Truth};
use crate::quantiles::MedianRange;
use crate::queries::{Queries, QuerySlice};
use crate::rounds::{Rounds, rotated};
use crate::settings::{Promise, Setting};
use p2m_core::{CertifiedQuery, ClosestPoint};
use std::convert::Infallible;

/// A backend with a setting that takes part in a measurement.
pub struct Competitor<'a> {
    /// The name of the backend. Points of the same name become one curve.
    pub backend: String,
    /// The name of the setting.
    pub setting: String,
    /// The accuracy that its answers promise.
    pub promise: Promise,
    /// The index that answers.
    pub index: Box<dyn AnswerQueries + 'a>,
    /// The cost of its index.
    pub build: Build,
}

impl<'a> Competitor<'a> {
    /// Makes a competitor of an index and a setting.
    pub fn new<I>(backend: &str, index: &'a I, setting: &Setting, build: Build) -> Self
    where
        I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync + ?Sized,
    {
        Self {
            backend: backend.to_owned(),
            setting: setting.name.to_owned(),
            promise: setting.promise(),
            index: with_setting(index, setting),
            build,
        }
    }

    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Infallible> {
        self.index.answer(queries, answers);
        Ok(())
    }
}

/// The amount of work of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The number of rounds. A median needs five.
    pub rounds: usize,
    /// The largest number of seconds of a round of one setting. Slow ones get fewer queries.
    pub seconds: f64,
}

/// Measures all competitors with `queries`, and compares their answers with `truths`. Calls `progress` with the
/// fraction of the work that is done, from 0 to 1.
///
/// # Panics
/// If there is not one truth for each query, or if a backend panics.
#[must_use]
pub fn measure(
    competitors: &[Competitor<'_>],
    queries: &Queries,
    truths: &[Truth],
    effort: &Effort,
    progress: &dyn Fn(f64),
) -> Vec<Curve> {
    assert_eq!(queries.len(), truths.len(), "one truth for each query");
    let affordable = |nanoseconds| affordable_queries(nanoseconds, effort.seconds);
    let rounds_of = |c: &Competitor<'_>| Rounds::new(queries, Answer::NONE, |q, a| c.answer(q, a), affordable);
    let mut all: Vec<Rounds<Answer, Infallible>> = competitors.iter().map(rounds_of).collect();
    let mut latencies = vec![None; all.len()];
    // The first round is not counted, because it loads indexes into the caches. The last one times single queries.
    let steps = (effort.rounds + 2) * all.len();
    for round in 0..effort.rounds + 2 {
        for (step, at) in rotated(all.len(), round).enumerate() {
            let (rounds, competitor) = (&mut all[at], &competitors[at]);
            if round <= effort.rounds {
                rounds.run(|queries, answers| competitor.answer(queries, answers));
            } else {
                let mut nanoseconds = vec![0; rounds.answers.len()];
                competitor.index.answer_timed(rounds.queries.all(), &mut rounds.answers, &mut nanoseconds);
                latencies[at] = Latency::of(nanoseconds);
            }
            progress((round * all.len() + step + 1) as f64 / steps as f64);
        }
    }
    let mut curves: Vec<Curve> = Vec::new();
    for ((competitor, rounds), latency) in competitors.iter().zip(all).zip(latencies) {
        let Some(nanoseconds) = MedianRange::of(&rounds.nanoseconds[1..]) else { continue };
        let truths: Vec<Truth> = rounds.chosen.iter().map(|&i| truths[i]).collect();
        let point = Point {
            setting: competitor.setting.clone(),
            queries: rounds.chosen.len(),
            rounds: effort.rounds,
            nanoseconds,
            errors: Errors::of(&rounds.answers, &truths, competitor.promise),
            latency,
            build: competitor.build,
        };
        match curves.iter_mut().find(|curve| curve.name == competitor.backend) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name: competitor.backend.clone(), points: vec![point] }),
        }
    }
    curves
}

/// Returns the number of queries of this duration that fit into the time. It is rounded down to a power of two, which
/// is mostly the same from run to run.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
fn affordable_queries(nanoseconds: f64, seconds: f64) -> usize {
    let count = (seconds * 1e9 / nanoseconds.max(1.0)) as usize;
    count.checked_ilog2().map_or(0, |bits| 1 << bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SETTINGS;
    use nalgebra::Point3;
    use p2m_core::{BruteForce, ClosestPoint, Point as Site};

    #[test]
    fn slow_competitors_get_fewer_queries() {
        assert_eq!(
            [affordable_queries(1e3, 0.1), affordable_queries(1e9, 0.1), affordable_queries(0.0, 1e-9)],
            [65_536, 0, 1]
        );
    }

    #[test]
    fn points_of_a_backend_are_one_curve() {
        let sites: Vec<_> = (0..50).map(|i| Site::new(Point3::new(f64::from(i), 0.0, 0.0))).collect();
        let index = BruteForce::new(&sites).unwrap();
        let double: Vec<_> = (0..40).map(|i| Point3::new(f64::from(i) * 1.3, 1.0, 0.5)).collect();
        let truth = |q: &Point3<f64>| {
            let c = index.closest_point(q).unwrap();
            let id = u32::try_from(c.primitive.index()).unwrap();
            Truth { distance: c.distance, residual: 0.0, max_vertex_distance: c.distance, id }
        };
        let truths: Vec<Truth> = double.iter().map(truth).collect();
        let competitors: Vec<Competitor<'_>> = ["a", "b"]
            .iter()
            .flat_map(|name| SETTINGS.iter().map(move |s| (name, s)))
            .map(|(name, setting)| Competitor::new(name, &index, setting, Build::default()))
            .collect();
        let seen = std::cell::Cell::new(0.0);
        let effort = Effort { rounds: 3, seconds: 1.0 };
        let curves = measure(&competitors, &Queries::new(double), &truths, &effort, &|part| {
            assert!(part > seen.replace(part));
        });
        assert!((seen.get() - 1.0).abs() < 1e-12);
        assert_eq!(curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        for point in curves.iter().flat_map(|curve| &curve.points) {
            assert_eq!((point.queries, point.rounds, point.errors.compared), (40, 3, 40));
            assert_eq!((point.errors.bounds_above_truth, point.errors.broken, point.errors.unanswered), (0, 0, 0));
            assert!(point.nanoseconds.min > 0.0 && point.latency.is_some());
        }
        assert_eq!(curves[0].default_point().unwrap().errors.relative.max, 0.0);
    }
}
