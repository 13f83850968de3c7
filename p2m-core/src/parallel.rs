//! Loops and pairs of functions that run on all threads of the current pool.
//!
//! An iterator of rayon compiles its scheduler anew for each closure. Here closures are passed to rayon behind
//! pointers, so the scheduler is compiled once for all crates. Each call through such a pointer handles a whole chunk
//! of items. Without the feature `rayon` everything runs on the calling thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The number of chunks per thread, so that no thread waits long for the others.
const CHUNKS_PER_THREAD: usize = 16;
/// The most items in a chunk of [`map`].
const MAX_CHUNK_LEN: usize = 1 << 12;

/// Returns the number of threads that loops use: all threads of the pool if `parallel` is set, otherwise one.
#[must_use]
pub fn thread_count(parallel: bool) -> usize {
    #[cfg(feature = "rayon")]
    if parallel {
        return rayon::current_num_threads();
    }
    let _ = parallel;
    1
}

/// Calls `work` with each number below `count`, on all threads if `parallel` is set.
#[inline(never)]
pub fn for_each(count: usize, parallel: bool, work: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "rayon")]
    if parallel && count > 1 {
        use rayon::prelude::*;
        return (0..count).into_par_iter().for_each(work);
    }
    let _ = parallel;
    (0..count).for_each(work);
}

/// Calls `work` with the numbers below `count`, on all threads if `parallel` is set, until it fails.
///
/// # Errors
/// One of the errors of `work`.
pub fn try_for_each<E: Send>(
    count: usize,
    parallel: bool,
    work: impl Fn(usize) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let (has_failed, failure) = (AtomicBool::new(false), Mutex::new(None));
    for_each(count, parallel, &|number| {
        if has_failed.load(Ordering::Relaxed) {
            return;
        }
        if let Err(error) = work(number) {
            has_failed.store(true, Ordering::Relaxed);
            *lock(&failure) = Some(error);
        }
    });
    failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Maps the numbers below `count` in order, on all threads if `parallel` is set.
pub fn map<B: Send>(count: usize, parallel: bool, f: impl Fn(usize) -> B + Sync) -> Vec<B> {
    let chunks = CHUNKS_PER_THREAD * thread_count(parallel);
    if chunks == CHUNKS_PER_THREAD {
        return (0..count).map(f).collect();
    }
    let len = count.div_ceil(chunks).clamp(1, MAX_CHUNK_LEN);
    // Each round moves its results to the list, so that only few results are in memory twice.
    let mapped: Vec<Mutex<Vec<B>>> = (0..count.div_ceil(len).min(chunks)).map(|_| Mutex::default()).collect();
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        let first = all.len();
        let range = |chunk: usize| (first + chunk * len).min(count)..(first + (chunk + 1) * len).min(count);
        for_each(mapped.len(), parallel, &|chunk| lock(&mapped[chunk]).extend(range(chunk).map(&f)));
        mapped.iter().for_each(|chunk| all.append(&mut lock(chunk)));
    }
    all
}

/// Maps a slice in order, on all threads if `parallel` is set.
pub fn map_slice<A: Sync, B: Send>(all: &[A], parallel: bool, f: impl Fn(&A) -> B + Sync) -> Vec<B> {
    map(all.len(), parallel, |i| f(&all[i]))
}

/// Maps a list in order, on all threads if `parallel` is set.
///
/// # Panics
/// Panics if `f` does.
pub fn map_owned<A: Send, B: Send>(all: Vec<A>, parallel: bool, f: impl Fn(A) -> B + Sync) -> Vec<B> {
    let all: Vec<Mutex<Option<A>>> = all.into_iter().map(|item| Mutex::new(Some(item))).collect();
    map(all.len(), parallel, |i| f(lock(&all[i]).take().expect("each item is taken once")))
}

/// Maps a list in order, on all threads if `parallel` is set, until `f` fails.
///
/// # Errors
/// One of the errors of `f`.
///
/// # Panics
/// Panics if `f` does.
pub fn try_map_owned<A: Send, B: Send, E: Send>(
    all: Vec<A>,
    parallel: bool,
    f: impl Fn(A) -> Result<B, E> + Sync,
) -> Result<Vec<B>, E> {
    let all: Vec<Mutex<Option<A>>> = all.into_iter().map(|item| Mutex::new(Some(item))).collect();
    try_map(all.len(), parallel, |i| f(lock(&all[i]).take().expect("each item is taken once")))
}

/// Maps the numbers below `count` in order, on all threads if `parallel` is set, until `f` fails.
///
/// # Errors
/// One of the errors of `f`.
pub fn try_map<B: Send, E: Send>(
    count: usize,
    parallel: bool,
    f: impl Fn(usize) -> Result<B, E> + Sync,
) -> Result<Vec<B>, E> {
    let has_failed = AtomicBool::new(false);
    let mapped = map(count, parallel, |number| {
        if has_failed.load(Ordering::Relaxed) {
            return None;
        }
        let result = f(number);
        has_failed.fetch_or(result.is_err(), Ordering::Relaxed);
        Some(result)
    });
    // If a result is missing, there is an error as well, so `flatten` drops nothing.
    mapped.into_iter().flatten().collect()
}

/// Calls `work` with each chunk of a slice and its number, on all threads if `parallel` is set. Each chunk has `len`
/// items, except that the last one may be shorter.
///
/// # Panics
/// Panics if `len` is 0.
pub fn for_each_chunk<A: Send>(all: &mut [A], len: usize, parallel: bool, work: impl Fn(usize, &mut [A]) + Sync) {
    let chunks: Vec<Mutex<&mut [A]>> = all.chunks_mut(len).map(Mutex::new).collect();
    for_each(chunks.len(), parallel, &|number| work(number, &mut lock(&chunks[number])));
}

/// Calls `work` as [`for_each_chunk`] does, until it fails.
///
/// # Errors
/// One of the errors of `work`.
///
/// # Panics
/// Panics if `len` is 0.
pub fn try_for_each_chunk<A: Send, E: Send>(
    all: &mut [A],
    len: usize,
    parallel: bool,
    work: impl Fn(usize, &mut [A]) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let chunks: Vec<Mutex<&mut [A]>> = all.chunks_mut(len).map(Mutex::new).collect();
    try_for_each(chunks.len(), parallel, |number| work(number, &mut lock(&chunks[number])))
}

/// Runs two functions, on two threads if `parallel` is set.
///
/// # Panics
/// Panics if one of them does.
pub fn join<A: Send, B: Send>(parallel: bool, a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    if !parallel {
        return (a(), b());
    }
    let (mut a, mut b) = (Some(a), Some(b));
    let (mut of_a, mut of_b) = (None, None);
    join_pointers(&mut || of_a = a.take().map(|a| a()), &mut || of_b = b.take().map(|b| b()));
    (of_a.expect("it has run"), of_b.expect("it has run"))
}

#[inline(never)]
fn join_pointers(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    #[cfg(feature = "rayon")]
    rayon::join(a, b);
    #[cfg(not(feature = "rayon"))]
    {
        a();
        b();
    }
}

/// Runs `body` on this thread. `body` receives a function that starts `help` on another thread; all these calls have
/// ended when this function returns.
#[inline(never)]
pub fn with_helpers(help: &(dyn Fn() + Sync), body: &mut dyn FnMut(&dyn Fn())) {
    #[cfg(feature = "rayon")]
    rayon::in_place_scope(|scope| body(&|| scope.spawn(|_| help())));
    #[cfg(not(feature = "rayon"))]
    body(&|| help());
}

/// Runs `here` on this thread. If `parallel` is set, another thread may run `aside` at the same time.
///
/// # Panics
/// Panics if one of them does.
pub fn run_beside<A: Send, B>(parallel: bool, aside: impl FnOnce() -> A + Send, here: impl FnOnce() -> B) -> (A, B) {
    if !parallel {
        return (aside(), here());
    }
    let (aside, of_aside) = (Mutex::new(Some(aside)), Mutex::new(None));
    let (mut here, mut of_here) = (Some(here), None);
    let help = || {
        let work = lock(&aside).take();
        *lock(&of_aside) = work.map(|work| work());
    };
    with_helpers(&help, &mut |call_helper| {
        call_helper();
        of_here = here.take().map(|here| here());
    });
    let of_aside = of_aside.into_inner().unwrap_or_else(PoisonError::into_inner);
    (of_aside.expect("it has run"), of_here.expect("it has run"))
}

fn lock<A>(mutex: &Mutex<A>) -> MutexGuard<'_, A> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_order_and_complete() {
        for parallel in [false, true] {
            for count in [0, 1, 2, 31, 1000, 300_000] {
                let expected: Vec<usize> = (0..count).map(|i| i * 3).collect();
                assert_eq!(map(count, parallel, |i| i * 3), expected);
                assert_eq!(map_owned(expected.clone(), parallel, |x| x / 3), (0..count).collect::<Vec<_>>());
                assert_eq!(try_map(count, parallel, |i| Ok::<_, ()>(i * 3)), Ok(expected));
                let mut chunks = vec![usize::MAX; count];
                for_each_chunk(&mut chunks, 7, parallel, |number, chunk| chunk.fill(number));
                assert!(chunks.iter().enumerate().all(|(i, number)| *number == i / 7), "{count}");
            }
            assert_eq!(join(parallel, || 1, || "two"), (1, "two"));
            let this = std::thread::current().id();
            assert_eq!(run_beside(parallel, || 1, || std::thread::current().id()), (1, this));
        }
    }

    #[test]
    fn a_failure_is_returned_and_ends_the_work() {
        for parallel in [false, true] {
            let work = |i: usize| if i == 5 { Err(i) } else { Ok(()) };
            assert_eq!(try_for_each(100_000, parallel, work), Err(5));
            assert_eq!(try_map(100_000, parallel, work), Err(5));
            assert_eq!(try_for_each(5, parallel, work), Ok(()));
            let calls = Mutex::new(0);
            let fail = |_: usize| -> Result<(), ()> {
                *lock(&calls) += 1;
                Err(())
            };
            assert_eq!(try_for_each(100_000, parallel, fail), Err(()));
            assert!(*lock(&calls) <= 2 * thread_count(parallel), "every thread sees it");
        }
    }
}
