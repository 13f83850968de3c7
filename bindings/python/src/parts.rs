//! Division of queries of any kind among threads, in parts that are short enough to check for interrupts between them.

use crate::errors::not_finite;
use crate::work::{Monitor, Threads};
use p2m_core::Position;
use p2m_core::batch::BatchOptions;
use pyo3::PyResult;
use std::ops::Range;
use std::time::Instant;

/// Room for the answers of queries, which can be divided.
pub(crate) trait Split: Send + Sized {
    /// Divides the room into two parts, the first of which is for `len` queries.
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

impl<A: Split, B: Split> Split for (A, B) {
    fn split(self, len: usize) -> (Self, Self) {
        let ((first, first_other), (second, second_other)) = (self.0.split(len), self.1.split(len));
        ((first, second), (first_other, second_other))
    }
}

impl<A: Split> Split for Option<A> {
    fn split(self, len: usize) -> (Self, Self) {
        self.map(|places| places.split(len)).unzip()
    }
}

/// Calls `answer` for all queries in parts, each with the room for its answers, and returns the results in the order of
/// the parts. After a cancellation, results are missing.
///
/// The basic idea: the queries are halved recursively, and rayon may run the halves on two threads. A range becomes a
/// part when it is no longer than the step that the monitor currently wants. The monitor doubles the step after fast
/// parts and halves it after slow ones. The second half is divided after the first one was answered, so parts adapt to
/// the speed of the queries.
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
        results.push(monitor.run_part(|| answer(queries, out)));
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

/// The number of rows that are checked at a time.
const ROWS_PER_CHECK: usize = 1 << 10;

/// Checks that all coordinates are finite, and otherwise reports the argument, of which each has `width` rows. A block
/// of rows is checked without branches.
pub(crate) fn check_finite<P: Position<f64>>(name: &str, points: &[P], width: usize) -> PyResult<()> {
    let is_finite = |point: &P| point.point().iter().fold(true, |all, x| all & x.is_finite());
    for (block, rows) in points.chunks(ROWS_PER_CHECK).enumerate() {
        if !rows.iter().fold(true, |all, row| all & is_finite(row)) {
            let row = rows.iter().position(|row| !is_finite(row)).unwrap_or(0);
            return Err(not_finite(name, (block * ROWS_PER_CHECK + row) / width));
        }
    }
    Ok(())
}

/// The number of queries from which sorting them along a curve saves more time than it takes.
const MIN_ORDERED_QUERIES: usize = 256;

/// Returns the options of a batch of this number of queries. A part of a batch is not divided again.
pub(crate) fn batch_options(queries: usize, parallel: bool) -> BatchOptions {
    BatchOptions::default().with_parallel(parallel).with_reorder(queries >= MIN_ORDERED_QUERIES)
}
