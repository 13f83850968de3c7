//! The loop of all measurements: competitors answer the same questions in turns, and the CPU time of the thread is
//! taken.
//!
//! Competitors that take turns see the same temperature and load of the machine, so their ratios are more stable than
//! their times. Another one begins in every round ([`rotated`]), because the first one after a pause is slower.

use crate::measure::harness::queries::{Queries, QuerySlice, sample_indices};
use cpu_time::ThreadTime;
use std::hint::black_box;

/// A run of this many nanoseconds is long enough to estimate the speed of a competitor.
const CALIBRATION_NANOSECONDS: f64 = 1e7;

/// Returns the numbers below `n` in their cyclic order, beginning with another one in every round.
pub fn rotated(n: usize, round: usize) -> impl Iterator<Item = usize> {
    (0..n).map(move |i| (i + round) % n)
}

/// Returns the result of `work` and the CPU time that this thread spent on it, in seconds.
pub fn thread_seconds<V>(work: impl FnOnce() -> V) -> (V, f64) {
    let start = ThreadTime::now();
    let value = work();
    (value, start.elapsed().as_secs_f64())
}

/// Lets a competitor answer questions of any kind, and returns the seconds of thread CPU time.
///
/// # Errors
/// The reason why the competitor has no answers.
fn time_answers<Q, A, E>(
    questions: Q,
    answers: &mut [A],
    answer: impl FnOnce(Q, &mut [A]) -> Result<(), E>,
) -> Result<f64, E> {
    let (outcome, seconds) = thread_seconds(|| answer(black_box(questions), answers));
    black_box(answers);
    outcome.map(|()| seconds)
}

/// The rounds of a competitor that answers closest-point queries.
#[derive(Clone, Debug)]
pub struct Rounds<A, E> {
    /// The indices of its queries among all queries. A slow competitor gets fewer queries.
    pub chosen: Vec<usize>,
    /// Its queries.
    pub queries: Queries,
    /// The answers of the last round.
    pub answers: Vec<A>,
    /// Thread CPU nanoseconds per query, one value for each round.
    pub nanoseconds: Vec<f64>,
    /// The reason why it has no answers. It is not asked again.
    pub failure: Option<E>,
    no_answer: A,
}

impl<A: Copy, E> Rounds<A, E> {
    /// Chooses the queries of a competitor. `affordable` returns the number of queries of a round for a number of
    /// nanoseconds per query, which is measured with more and more queries until the run is long enough.
    pub fn new(
        all: &Queries,
        no_answer: A,
        mut answer: impl FnMut(QuerySlice<'_>, &mut [A]) -> Result<(), E>,
        affordable: impl FnOnce(f64) -> usize,
    ) -> Self {
        let mut count = 1;
        let calibrated = loop {
            let sample = all.gather(&sample_indices(all.len(), count));
            let mut answers = vec![no_answer; sample.len()];
            match time_answers(sample.all(), &mut answers, &mut answer) {
                Ok(seconds) if seconds * 1e9 <= CALIBRATION_NANOSECONDS && count < all.len() => count *= 8,
                outcome => break outcome.map(|seconds| seconds * 1e9 / sample.len().max(1) as f64),
            }
        };
        let (count, failure) = match calibrated {
            Ok(nanoseconds) => (affordable(nanoseconds), None),
            Err(failure) => (1, Some(failure)),
        };
        let chosen = sample_indices(all.len(), count);
        let (queries, answers) = (all.gather(&chosen), vec![no_answer; chosen.len()]);
        Self { chosen, queries, answers, nanoseconds: Vec::new(), failure, no_answer }
    }

    /// Runs a round, unless the competitor failed before.
    pub fn run(&mut self, answer: impl FnOnce(QuerySlice<'_>, &mut [A]) -> Result<(), E>) {
        if self.failure.is_none() {
            self.answers.fill(self.no_answer);
            match time_answers(self.queries.all(), &mut self.answers, answer) {
                Ok(seconds) => self.nanoseconds.push(seconds * 1e9 / self.answers.len() as f64),
                Err(failure) => self.failure = Some(failure),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn every_competitor_begins_once() {
        let first: Vec<_> = (0..3).map(|round| rotated(3, round).next()).collect();
        assert_eq!(first, [Some(0), Some(1), Some(2)]);
        assert_eq!(rotated(3, 4).collect::<Vec<_>>(), [1, 2, 0]);
        assert_eq!(rotated(0, 1).count(), 0);
    }

    #[test]
    fn rounds_have_the_chosen_queries_and_end_with_a_failure() {
        let all = Queries::new((0..100).map(|i| Point3::new(f64::from(i), 0.0, 0.0)).collect());
        let x = |queries: QuerySlice<'_>, answers: &mut [f64]| {
            queries.double.iter().zip(answers).for_each(|(query, answer)| *answer = query.x);
            Ok(())
        };
        let mut rounds = Rounds::<f64, &str>::new(&all, -1.0, x, |nanoseconds| if nanoseconds > 0.0 { 10 } else { 11 });
        rounds.run(x);
        assert!((10..=11).contains(&rounds.chosen.len()) && rounds.nanoseconds[0] > 0.0);
        assert!(rounds.answers.iter().zip(&rounds.chosen).all(|(x, i)| *x as usize == *i));
        rounds.run(|_, _| Err("tired"));
        rounds.run(x);
        assert_eq!((rounds.failure, rounds.nanoseconds.len(), rounds.answers[0]), (Some("tired"), 1, -1.0));
        let failed = Rounds::<f64, &str>::new(&all, -1.0, |_, _| Err("absent"), |_| 100);
        assert_eq!((failed.failure, failed.chosen.len()), (Some("absent"), 1));
    }
}
