//! Parallel work in chunks, whose results are consumed in order.

use std::ops::Range;

/// The number of chunks whose results exist before they are consumed. Their memory is needed twice.
const CHUNKS_PER_GROUP: usize = 32;

/// Splits 0..count into chunks of `chunk_len`, and passes the result of `work` on each chunk to `take`, in the order of
/// the chunks. If `parallel`, the chunks of a group are worked on by all threads.
pub(crate) fn map_chunks_in_order<R: Send>(
    count: usize,
    chunk_len: usize,
    parallel: bool,
    work: impl Fn(Range<usize>) -> R + Sync,
    mut take: impl FnMut(R),
) {
    let chunks: Vec<Range<usize>> =
        (0..count).step_by(chunk_len).map(|first| first..count.min(first + chunk_len)).collect();
    #[cfg(feature = "rayon")]
    if parallel {
        use rayon::prelude::*;
        for group in chunks.chunks(CHUNKS_PER_GROUP) {
            let results: Vec<R> = group.par_iter().cloned().map(&work).collect();
            results.into_iter().for_each(&mut take);
        }
        return;
    }
    let _ = (parallel, CHUNKS_PER_GROUP);
    chunks.into_iter().for_each(|chunk| take(work(chunk)));
}

/// Returns the results of two functions. If `parallel`, another thread may run the first one at the same time.
pub(crate) fn run_both<A: Send, B>(
    parallel: bool,
    aside: impl FnOnce() -> A + Send,
    here: impl FnOnce() -> B,
) -> (A, B) {
    #[cfg(feature = "rayon")]
    if parallel {
        let mut result = None;
        let other = rayon::in_place_scope(|scope| {
            scope.spawn(|_| result = Some(aside()));
            here()
        });
        return (result.expect("the scope waits for it"), other);
    }
    let _ = parallel;
    (aside(), here())
}
