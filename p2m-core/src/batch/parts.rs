//! The division of a batch into parts, each of which is ordered and answered by one thread.

use crate::parallel::{join, thread_count};

/// The most queries in a part.
const MAX_QUERIES_PER_PART: usize = 1 << 20;
/// The fewest queries in a part, if there are several.
const MIN_QUERIES_PER_PART: usize = 1 << 10;
/// The number of parts per thread, so that no thread waits long for the others.
const PARTS_PER_THREAD: usize = 4;

/// A destination for answers that can be split.
pub(super) trait Split: Send + Sized {
    /// Splits the destination in two; the first part takes `len` answers.
    fn split(self, len: usize) -> (Self, Self);
}

impl<A: Send> Split for &mut [A] {
    fn split(self, len: usize) -> (Self, Self) {
        self.split_at_mut(len)
    }
}

/// Calls `answer_part` with each part of the queries and the destination of its answers, on all threads if `parallel`.
pub(super) fn answer_parts<Q: Sync, O: Split>(
    mut queries: &[Q],
    mut out: O,
    parallel: bool,
    answer_part: &(impl Fn(&[Q], &mut O) + Sync),
) {
    if parallel && cfg!(feature = "rayon") {
        let part = queries.len().div_ceil(thread_count(true) * PARTS_PER_THREAD);
        return halve(queries, out, part.clamp(MIN_QUERIES_PER_PART, MAX_QUERIES_PER_PART), answer_part);
    }
    while queries.len() > MAX_QUERIES_PER_PART {
        let (part, rest) = queries.split_at(MAX_QUERIES_PER_PART);
        let (mut part_out, rest_out) = out.split(MAX_QUERIES_PER_PART);
        answer_part(part, &mut part_out);
        (queries, out) = (rest, rest_out);
    }
    answer_part(queries, &mut out);
}

/// Halves the queries until each part is small enough for one thread.
fn halve<Q: Sync, O: Split>(queries: &[Q], mut out: O, part: usize, answer_part: &(impl Fn(&[Q], &mut O) + Sync)) {
    if queries.len() <= part {
        return answer_part(queries, &mut out);
    }
    let middle = queries.len() / 2;
    let (first_out, second_out) = out.split(middle);
    let (first, second) = queries.split_at(middle);
    join(true, || halve(first, first_out, part, answer_part), || halve(second, second_out, part, answer_part));
}
