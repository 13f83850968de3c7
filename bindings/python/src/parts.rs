//! The division of queries of any kind among threads, in parts that are short enough to be watched.

use crate::work::{Monitor, Threads};
use std::ops::Range;
use std::time::Instant;

/// Places for the answers of queries, which can be divided.
pub(crate) trait Split: Send + Sized {
    /// Divides the places in two, the first for `len` queries.
    fn split(self, len: usize) -> (Self, Self);
}

impl Split for () {
    fn split(self, _: usize) -> (Self, Self) {
        ((), ())
    }
}

impl<T: Send> Split for &mut [T] {
    fn split(self, len: usize) -> (Self, Self) {
        self.split_at_mut(len)
    }
}

/// Calls `answer` for all queries, in parts with the places for their answers, and returns its results in the order of
/// the parts. After a cancellation parts are missing.
///
/// The queries are halved until a part is as long as the monitor wants its next step. Parts begin short and are longer
/// where queries are fast, because the second half is divided after the first was answered.
pub(crate) fn answer_in_parts<O: Split, R: Send>(
    queries: usize,
    out: O,
    threads: &Threads,
    monitor: &Monitor,
    answer: &(impl Fn(Range<usize>, O) -> R + Sync),
) -> Vec<R> {
    let mut results = Vec::new();
    halve(0..queries, out, threads.is_parallel(), monitor, answer, &mut results);
    results
}

fn halve<O: Split, R: Send>(
    queries: Range<usize>,
    out: O,
    parallel: bool,
    monitor: &Monitor,
    answer: &(impl Fn(Range<usize>, O) -> R + Sync),
    results: &mut Vec<R>,
) {
    if queries.is_empty() || monitor.is_cancelled() {
        return;
    }
    if queries.len() <= monitor.step() {
        let (count, start) = (queries.len(), Instant::now());
        results.push(answer(queries, out));
        monitor.end_step(count, start);
        return;
    }
    let first_len = queries.len() / 2;
    let (first_out, second_out) = out.split(first_len);
    let middle = queries.start + first_len;
    let (first, second) = (queries.start..middle, middle..queries.end);
    if !parallel {
        halve(first, first_out, parallel, monitor, answer, results);
        return halve(second, second_out, parallel, monitor, answer, results);
    }
    let mut others = Vec::new();
    rayon::join(
        || halve(first, first_out, parallel, monitor, answer, results),
        || halve(second, second_out, parallel, monitor, answer, &mut others),
    );
    results.append(&mut others);
}
