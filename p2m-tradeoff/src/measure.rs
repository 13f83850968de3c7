//! Measures rounds of queries in thread CPU time. Backends take turns, so that drift of the machine affects all of them
//! alike. Answers are compared outside of the measured time.

use crate::backend::{Answer, Subject};
use crate::curve::{Build, Curve, Latency, Point};
use crate::errors::{Errors, Truth};
use crate::quantiles::Spread;
use crate::queries::{Queries, spread};
use crate::settings::Promise;
use cpu_time::ThreadTime;
use std::hint::black_box;

/// The duration of a calibration run, in nanoseconds.
const CALIBRATION_NANOSECONDS: f64 = 2e6;

/// A backend with a setting that takes part in a measurement.
pub struct Competitor<'a> {
    /// The name of the backend. Points of the same name become one curve.
    pub backend: String,
    /// The name of the setting.
    pub setting: String,
    /// The accuracy that its answers promise.
    pub promise: Promise,
    /// The backend itself.
    pub subject: Box<dyn Subject + 'a>,
    /// The cost of its index.
    pub build: Build,
}

/// The amount of work of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The number of rounds. A median needs five.
    pub rounds: usize,
    /// The largest number of seconds of a round of one setting. Slow ones get fewer queries.
    pub seconds: f64,
}

/// Measures all entrants with `queries`, and compares their answers with `truths`. Calls `progress` with the fraction
/// of the work that is done, from 0 to 1.
///
/// # Panics
/// If there is not one truth for each query, or if a backend panics.
#[must_use]
pub fn measure(
    entrants: &[Competitor<'_>],
    queries: &Queries,
    truths: &[Truth],
    effort: &Effort,
    progress: &dyn Fn(f64),
) -> Vec<Curve> {
    assert_eq!(queries.len(), truths.len(), "one truth for each query");
    let mut runs: Vec<Run> = entrants.iter().map(|entrant| Run::new(entrant, queries, effort)).collect();
    // The first round is not counted, because it loads indexes into the caches. The last one times single queries.
    let steps = (effort.rounds + 2) * runs.len();
    for round in 0..effort.rounds + 2 {
        for (step, at) in rotated(runs.len(), round).enumerate() {
            let (run, entrant) = (&mut runs[at], &entrants[at]);
            if round <= effort.rounds {
                let nanoseconds = run.run_round(entrant);
                run.nanoseconds.extend((round > 0).then_some(nanoseconds));
            } else {
                run.time_single_queries(entrant);
            }
            progress((round * runs.len() + step + 1) as f64 / steps as f64);
        }
    }
    let mut curves: Vec<Curve> = Vec::new();
    for (entrant, run) in entrants.iter().zip(runs) {
        let Some(point) = run.into_point(entrant, truths) else { continue };
        match curves.iter_mut().find(|curve| curve.name == entrant.backend) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name: entrant.backend.clone(), points: vec![point] }),
        }
    }
    curves
}

/// Returns the result of `work` and the CPU time that this thread spent on it, in seconds.
pub fn thread_seconds<V>(work: impl FnOnce() -> V) -> (V, f64) {
    let start = ThreadTime::now();
    let value = work();
    (value, start.elapsed().as_secs_f64())
}

/// Returns the numbers below `n` in their cyclic order, beginning with another one in every round.
pub fn rotated(n: usize, round: usize) -> impl Iterator<Item = usize> {
    (0..n).map(move |i| (i + round) % n)
}

/// The state of the measurement of an entrant.
struct Run {
    /// The indices of its queries among all queries.
    chosen: Vec<usize>,
    queries: Queries,
    answers: Vec<Answer>,
    /// The mean time of a query in each round, in nanoseconds.
    nanoseconds: Vec<f64>,
    /// The time of each single query, in nanoseconds.
    single_nanoseconds: Vec<u64>,
}

impl Run {
    fn new(entrant: &Competitor<'_>, queries: &Queries, effort: &Effort) -> Self {
        let chosen = spread(queries.len(), affordable_queries(calibrate(&*entrant.subject, queries), effort.seconds));
        let answers = vec![Answer::NONE; chosen.len()];
        let single_nanoseconds = vec![0; chosen.len()];
        Self { queries: queries.gather(&chosen), chosen, answers, nanoseconds: Vec::new(), single_nanoseconds }
    }

    /// Runs a round and returns the nanoseconds per query.
    fn run_round(&mut self, entrant: &Competitor<'_>) -> f64 {
        self.answers.fill(Answer::NONE);
        let start = ThreadTime::now();
        entrant.subject.answer(black_box(self.queries.all()), &mut self.answers);
        let elapsed = start.elapsed();
        black_box(&self.answers);
        elapsed.as_secs_f64() * 1e9 / self.answers.len() as f64
    }

    /// Times single queries.
    fn time_single_queries(&mut self, entrant: &Competitor<'_>) {
        entrant.subject.answer_timed(black_box(self.queries.all()), &mut self.answers, &mut self.single_nanoseconds);
        black_box(&self.answers);
    }

    /// Returns the results, if there were queries and rounds.
    fn into_point(self, entrant: &Competitor<'_>, truths: &[Truth]) -> Option<Point> {
        let truths: Vec<Truth> = self.chosen.iter().map(|&i| truths[i]).collect();
        Some(Point {
            setting: entrant.setting.clone(),
            queries: self.chosen.len(),
            rounds: self.nanoseconds.len(),
            nanoseconds: Spread::of(&self.nanoseconds)?,
            errors: Errors::of(&self.answers, &truths, entrant.promise),
            latency: Latency::of(self.single_nanoseconds),
            build: entrant.build,
        })
    }
}

/// Estimates the nanoseconds per query, with more and more queries until the run is long enough.
fn calibrate(subject: &dyn Subject, queries: &Queries) -> f64 {
    let mut count = 1;
    loop {
        let picked = queries.gather(&spread(queries.len(), count));
        let mut answers = vec![Answer::NONE; picked.len()];
        let start = ThreadTime::now();
        subject.answer(picked.all(), &mut answers);
        let elapsed = start.elapsed().as_secs_f64() * 1e9;
        if elapsed > CALIBRATION_NANOSECONDS || count >= queries.len() {
            return elapsed / picked.len().max(1) as f64;
        }
        count *= 8;
    }
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
    use crate::backend::WithOptions;
    use crate::settings::SETTINGS;
    use nalgebra::Point3;
    use p2m_core::{BruteForce, ClosestPoint, Point as Site};

    #[test]
    fn every_entrant_begins_once() {
        let first: Vec<_> = (0..3).map(|round| rotated(3, round).next()).collect();
        assert_eq!(first, [Some(0), Some(1), Some(2)]);
        assert_eq!(rotated(3, 4).collect::<Vec<_>>(), [1, 2, 0]);
        assert_eq!(rotated(0, 1).count(), 0);
    }

    #[test]
    fn slow_entrants_get_fewer_queries() {
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
            Truth { distance: c.distance, rest: 0.0, reach: c.distance, id }
        };
        let truths: Vec<Truth> = double.iter().map(truth).collect();
        let entrants: Vec<Competitor<'_>> = ["a", "b"]
            .iter()
            .flat_map(|name| SETTINGS.iter().map(move |s| (name, s)))
            .map(|(name, setting)| Competitor {
                backend: (*name).to_owned(),
                setting: setting.name.to_owned(),
                promise: setting.promise(),
                subject: Box::new(WithOptions::new(&index, setting.options::<f64>())),
                build: Build::default(),
            })
            .collect();
        let seen = std::cell::Cell::new(0.0);
        let effort = Effort { rounds: 3, seconds: 1.0 };
        let curves = measure(&entrants, &Queries::new(double), &truths, &effort, &|part| {
            assert!(part > seen.replace(part));
        });
        assert!((seen.get() - 1.0).abs() < 1e-12);
        assert_eq!(curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        for point in curves.iter().flat_map(|curve| &curve.points) {
            assert_eq!((point.queries, point.rounds, point.errors.compared), (40, 3, 40));
            assert_eq!((point.errors.bounds_above_truth, point.errors.broken, point.errors.unanswered), (0, 0, 0));
            assert!(point.nanoseconds.min > 0.0 && point.latency.is_some());
        }
        assert_eq!(curves[0].usual().unwrap().errors.relative.max, 0.0);
    }
}
