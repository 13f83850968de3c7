//! Work in shares, on all threads, the results in order.

use std::ops::Range;

/// Numbers of a share.
const SHARE: usize = 1024;
/// Shares that are made before they are taken: what they have is in memory twice.
const GROUP: usize = 32;

/// Gives to `take` what `work` makes of shares of 0..count, in their order; on all threads if `parallel`.
pub(crate) fn in_shares<R: Send>(
    count: usize,
    parallel: bool,
    work: impl Fn(Range<usize>) -> R + Sync,
    mut take: impl FnMut(R),
) {
    let all: Vec<Range<usize>> = (0..count).step_by(SHARE).map(|first| first..count.min(first + SHARE)).collect();
    #[cfg(feature = "rayon")]
    if parallel {
        use rayon::prelude::*;
        for group in all.chunks(GROUP) {
            let made: Vec<R> = group.par_iter().cloned().map(&work).collect();
            made.into_iter().for_each(&mut take);
        }
        return;
    }
    let _ = (parallel, GROUP);
    all.into_iter().for_each(|share| take(work(share)));
}
