//! Parallel work in chunks, whose results are consumed in order.

use p2m_core::engine::parallel::{thread_count, with_helpers};
use std::ops::Range;

/// The largest number of chunks that are begun and not consumed yet, for up to sixteen threads.
const MAX_OPEN_CHUNKS: usize = 32;

/// Splits 0..count into chunks of `chunk_len`, and passes the result of `work` on each chunk to `take`, in the order of
/// the chunks. If `parallel`, all threads work on the chunks, and this one consumes results between its own chunks.
pub(crate) fn map_chunks_in_order<R: Send>(
    count: usize,
    chunk_len: usize,
    parallel: bool,
    work: impl Fn(Range<usize>) -> R + Sync,
    mut take: impl FnMut(R),
) {
    let work = |chunk: usize| work(chunk * chunk_len..count.min((chunk + 1) * chunk_len));
    let chunks = count.div_ceil(chunk_len);
    let threads = thread_count(parallel);
    if chunks > 1 && threads > 1 {
        OpenChunks::new(chunks, threads).run(work, take);
        return;
    }
    (0..chunks).for_each(|chunk| take(work(chunk)));
}

/// The chunks that are begun and not consumed yet.
///
/// No thread waits for one particular other thread, so work may use threads itself. A thread that finds nothing to
/// begin leaves the scope, in which all threads work, and a new scope begins if chunks are left.
struct OpenChunks<R>(std::sync::Mutex<OpenChunksState<R>>);

struct OpenChunksState<R> {
    /// The number of chunks that are not begun.
    left: usize,
    /// The number of the next chunk.
    next: usize,
    /// The results of the chunks before the next one that are not consumed, where they are known.
    results: std::collections::VecDeque<Option<R>>,
    /// The number of other threads that are asked to work.
    helpers: usize,
    /// The number of other threads.
    max_helpers: usize,
    /// The number of chunks that may be open.
    max_open: usize,
}

impl<R: Send> OpenChunks<R> {
    fn new(chunks: usize, threads: usize) -> Self {
        Self(std::sync::Mutex::new(OpenChunksState {
            left: chunks,
            next: 0,
            results: std::collections::VecDeque::new(),
            helpers: 0,
            max_helpers: threads - 1,
            max_open: MAX_OPEN_CHUNKS.max(2 * threads),
        }))
    }

    fn run(&self, work: impl Fn(usize) -> R + Sync, mut take: impl FnMut(R)) {
        while self.lock().has_more() {
            with_helpers(&|| self.help(&work), &mut |call_helper| {
                loop {
                    while self.lock().add_helper() {
                        call_helper();
                    }
                    if let Some(result) = self.take_first() {
                        take(result);
                    } else if let Some(chunk) = self.begin() {
                        self.finish(chunk, work(chunk));
                    } else {
                        break;
                    }
                }
            });
            while let Some(result) = self.take_first() {
                take(result);
            }
        }
    }

    /// Works on chunks until none may be begun.
    fn help(&self, work: &impl Fn(usize) -> R) {
        while let Some(chunk) = self.begin_or_leave() {
            self.finish(chunk, work(chunk));
        }
    }

    // Each of these functions gives the lock back before it returns, so nobody has it while a chunk is worked on or
    // consumed.

    fn begin(&self) -> Option<usize> {
        self.lock().begin()
    }

    /// Begins the next chunk, or counts one helper less if none may be begun.
    fn begin_or_leave(&self) -> Option<usize> {
        let mut state = self.lock();
        let chunk = state.begin();
        state.helpers -= usize::from(chunk.is_none());
        chunk
    }

    fn finish(&self, chunk: usize, result: R) {
        self.lock().finish(chunk, result);
    }

    fn take_first(&self) -> Option<R> {
        self.lock().take_first()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, OpenChunksState<R>> {
        self.0.lock().expect("no thread panics while it has the lock")
    }
}

impl<R> OpenChunksState<R> {
    /// Returns whether chunks are left to be worked on or to be consumed.
    fn has_more(&self) -> bool {
        self.left > 0 || !self.results.is_empty()
    }

    /// Counts one more helper, if another one may have something to do.
    fn add_helper(&mut self) -> bool {
        let has_work = self.left > self.helpers && self.results.len() + self.helpers < self.max_open;
        let is_added = has_work && self.helpers < self.max_helpers;
        self.helpers += usize::from(is_added);
        is_added
    }

    /// Begins the next chunk and returns its number; `None` if all are begun, or as many as may be open.
    fn begin(&mut self) -> Option<usize> {
        if self.left == 0 || self.results.len() >= self.max_open {
            return None;
        }
        self.left -= 1;
        self.next += 1;
        self.results.push_back(None);
        Some(self.next - 1)
    }

    fn finish(&mut self, chunk: usize, result: R) {
        let first = self.next - self.results.len();
        self.results[chunk - first] = Some(result);
    }

    /// Removes the result of the first open chunk, if it is known.
    fn take_first(&mut self) -> Option<R> {
        let result = self.results.front_mut()?.take()?;
        self.results.pop_front();
        Some(result)
    }
}

#[cfg(all(test, feature = "rayon"))]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Chunks of very different lengths are consumed in order, each once, and few are open at a time.
    #[test]
    fn results_come_in_order_from_any_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            for (count, chunk_len) in [(0, 4), (1, 4), (9, 2), (1000, 7), (200, 1)] {
                let (open, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
                let mut taken = Vec::new();
                let work = |range: Range<usize>| {
                    most.fetch_max(open.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                    // Meanwhile other threads begin as many chunks as they may.
                    if range.start == 0 {
                        std::thread::sleep(std::time::Duration::from_millis(30));
                    }
                    // The work uses threads itself.
                    let steps = if range.start.is_multiple_of(5) { 20_000 } else { 10 };
                    let step = |i: usize| std::hint::black_box(i) + range.start;
                    let [a, b] = [0..steps / 2, steps / 2..steps];
                    let (a, b) = rayon::join(|| a.map(step).sum::<usize>(), || b.map(step).sum::<usize>());
                    (range.clone(), a + b - steps * (steps - 1) / 2)
                };
                pool.install(|| {
                    map_chunks_in_order(count, chunk_len, true, work, |(range, sum)| {
                        open.fetch_sub(1, Ordering::SeqCst);
                        // Results are consumed without the lock: another thread may run a helper meanwhile.
                        rayon::join(std::thread::yield_now, std::thread::yield_now);
                        let steps = if range.start.is_multiple_of(5) { 20_000 } else { 10 };
                        assert_eq!(sum, steps * range.start);
                        taken.extend(range);
                    });
                });
                assert!(taken.into_iter().eq(0..count), "{threads} threads");
                assert!(most.into_inner() <= MAX_OPEN_CHUNKS);
            }
        }
    }
}
