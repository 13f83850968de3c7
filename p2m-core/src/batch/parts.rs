//! The division of a batch into parts, each of which one thread orders and answers.

use crate::parallel::{join, thread_count};

/// The largest number of queries that are ordered and answered at a time by one thread.
const MAX_QUERIES_PER_PART: usize = 1 << 20;
/// The number of queries below which a batch is not divided among threads any further.
const MIN_QUERIES_PER_PART: usize = 1 << 10;
/// The number of parts for each thread, so that none waits long for the others.
const PARTS_PER_THREAD: usize = 4;

/// A place for answers that can be divided.
pub(super) trait Split: Send + Sized {
    /// Divides the place in two, the first for `len` answers.
    fn split(self, len: usize) -> (Self, Self);
}

impl<A: Send> Split for &mut [A] {
    fn split(self, len: usize) -> (Self, Self) {
        self.split_at_mut(len)
    }
}

/// Calls `answer_part` for parts of the queries with the places for their answers, on all threads if `parallel`.
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

/// Halves the queries until a part is small enough for one thread.
fn halve<Q: Sync, O: Split>(queries: &[Q], mut out: O, part: usize, answer_part: &(impl Fn(&[Q], &mut O) + Sync)) {
    if queries.len() <= part {
        return answer_part(queries, &mut out);
    }
    let middle = queries.len() / 2;
    let (first_out, second_out) = out.split(middle);
    let (first, second) = queries.split_at(middle);
    join(true, || halve(first, first_out, part, answer_part), || halve(second, second_out, part, answer_part));
}
