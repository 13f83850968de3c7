//! Work in shares, on all threads, the results in order.

use std::ops::Range;

/// Numbers of a chunk.
const CHUNK_LEN: usize = 1024;
/// Shares that are results before they are taken: what they have is in memory twice.
const CHUNKS_PER_GROUP: usize = 32;

/// Gives to `take` what `work` makes of shares of 0..count, in their order; on all threads if `parallel`.
pub(crate) fn map_chunks_in_order<R: Send>(
    count: usize,
    parallel: bool,
    work: impl Fn(Range<usize>) -> R + Sync,
    mut take: impl FnMut(R),
) {
    let all: Vec<Range<usize>> =
        (0..count).step_by(CHUNK_LEN).map(|first| first..count.min(first + CHUNK_LEN)).collect();
    #[cfg(feature = "rayon")]
    if parallel {
        use rayon::prelude::*;
        for group in all.chunks(CHUNKS_PER_GROUP) {
            let results: Vec<R> = group.par_iter().cloned().map(&work).collect();
            results.into_iter().for_each(&mut take);
        }
        return;
    }
    let _ = (parallel, CHUNKS_PER_GROUP);
    all.into_iter().for_each(|chunk| take(work(chunk)));
}
