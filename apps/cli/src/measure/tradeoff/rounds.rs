//! Measures competitors, and compares their answers with the truth outside of the measured time.

use crate::measure::harness::MedianRange;
use crate::measure::harness::queries::{Queries, QuerySlice};
use crate::measure::harness::rounds::{Rounds, rotated};
use crate::measure::tradeoff::curve::{Build, Curve, Latency, Point};
use crate::measure::tradeoff::errors::{Errors, Truth};
use crate::measure::tradeoff::settings::{Accuracy, Setting};
use nalgebra::Point3;
use p2m_backends::AnyIndex;
use p2m_core::{Closest, QueryOptions};
use std::convert::Infallible;
use std::time::Instant;

/// An answer to a query, if there is one.
type Answer = Option<Closest<f64>>;

/// A backend with a setting that takes part in a measurement.
pub(crate) struct Competitor<'a> {
    /// The name of the backend. Points of the same name become one curve.
    pub(crate) backend: &'a str,
    pub(crate) setting: &'a Setting,
    /// The index that answers.
    pub(crate) index: &'a dyn AnyIndex,
    /// The cost of its index.
    pub(crate) build: Build,
}

impl Competitor<'_> {
    /// Answers queries in their order. Where there is no certificate, there is no certified answer.
    fn answer(&self, queries: &[Point3<f64>], answers: &mut [Answer]) {
        let options = self.setting.options();
        let pairs = queries.iter().zip(answers);
        match self.setting.accuracy {
            Accuracy::Certified => pairs.for_each(|(query, answer)| {
                *answer = self.index.certified_closest_point(query, &QueryOptions::default()).ok().flatten();
            }),
            _ => pairs.for_each(|(query, answer)| *answer = self.index.closest_point_with(query, &options)),
        }
    }

    /// Answers queries in their order, and returns the wall time of each in nanoseconds. The time to read the
    /// clock is included.
    fn answer_timed(&self, queries: &[Point3<f64>], answers: &mut [Answer]) -> Vec<u64> {
        let timed = |(query, answer): (&Point3<f64>, &mut Answer)| {
            let start = Instant::now();
            self.answer(std::slice::from_ref(query), std::slice::from_mut(answer));
            elapsed_nanoseconds(start)
        };
        queries.iter().zip(answers).map(timed).collect()
    }
}

#[allow(clippy::cast_possible_truncation, reason = "584 years")]
fn elapsed_nanoseconds(start: Instant) -> u64 {
    start.elapsed().as_nanos() as u64
}

/// Measures the time between two readings of the clock, in nanoseconds: the median of many.
pub(crate) fn clock_nanoseconds() -> f64 {
    const READINGS: usize = 10_000;
    let mut all: Vec<u64> = (0..READINGS).map(|_| elapsed_nanoseconds(Instant::now())).collect();
    all.sort_unstable();
    all[READINGS / 2] as f64
}

/// The amount of work of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Effort {
    /// The number of rounds. A median needs five.
    pub(crate) rounds: usize,
    /// The largest number of seconds of a round of one setting. Slow ones get fewer queries.
    pub(crate) seconds: f64,
}

/// Measures all competitors with `queries`, and compares their answers with `truths`. Calls `progress` with the
/// fraction of the work that is done, from 0 to 1.
///
/// # Panics
/// If there is not one truth for each query, or if a backend panics.
pub(crate) fn measure(
    competitors: &[Competitor<'_>],
    queries: &Queries,
    truths: &[Truth],
    effort: &Effort,
    progress: &dyn Fn(f64),
) -> Vec<Curve> {
    assert_eq!(queries.len(), truths.len(), "one truth for each query");
    let affordable = |nanoseconds| affordable_queries(nanoseconds, effort.seconds);
    let answer = |competitor: &Competitor<'_>, queries: QuerySlice<'_>, answers: &mut [Answer]| {
        competitor.answer(queries.double, answers);
        Ok(())
    };
    let rounds_of = |c: &Competitor<'_>| Rounds::new(queries, None, |q, a| answer(c, q, a), affordable);
    let mut all: Vec<Rounds<Answer, Infallible>> = competitors.iter().map(rounds_of).collect();
    let mut latencies = vec![None; all.len()];
    // The first round is not counted, because it loads indexes into the caches. The last one times single queries.
    let steps = (effort.rounds + 2) * all.len();
    for round in 0..effort.rounds + 2 {
        for (step, at) in rotated(all.len(), round).enumerate() {
            let (rounds, competitor) = (&mut all[at], &competitors[at]);
            if round <= effort.rounds {
                rounds.run(|queries, answers| answer(competitor, queries, answers));
            } else {
                latencies[at] = Latency::of(competitor.answer_timed(rounds.queries.all().double, &mut rounds.answers));
            }
            progress((round * all.len() + step + 1) as f64 / steps as f64);
        }
    }
    let mut curves: Vec<Curve> = Vec::new();
    for ((competitor, rounds), latency) in competitors.iter().zip(all).zip(latencies) {
        let Some(nanoseconds) = MedianRange::of(&rounds.nanoseconds[1..]) else { continue };
        let truths: Vec<Truth> = rounds.chosen.iter().map(|&i| truths[i]).collect();
        let point = Point {
            setting: competitor.setting.name.to_owned(),
            queries: rounds.chosen.len(),
            rounds: effort.rounds,
            nanoseconds,
            errors: Errors::of(&rounds.answers, &truths, competitor.setting.promise()),
            latency,
            build: competitor.build,
        };
        match curves.iter_mut().find(|curve| curve.name == competitor.backend) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name: competitor.backend.to_owned(), points: vec![point] }),
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
    use crate::measure::tradeoff::settings::SETTINGS;
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
        let index = BruteForce::new(sites).unwrap();
        let double: Vec<_> = (0..40).map(|i| Point3::new(f64::from(i) * 1.3, 1.0, 0.5)).collect();
        let truth = |q: &Point3<f64>| {
            let c = index.closest_point(q).unwrap();
            Truth { distance: c.distance, max_vertex_distance: c.distance, primitive: c.primitive }
        };
        let truths: Vec<Truth> = double.iter().map(truth).collect();
        let competitors: Vec<Competitor<'_>> = ["a", "b"]
            .iter()
            .flat_map(|name| SETTINGS.iter().map(move |s| (name, s)))
            .map(|(name, setting)| Competitor { backend: name, setting, index: &index, build: Build::default() })
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
