//! Checks on all threads.

use p2m_testkit::truth::rational_distances;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// The results of checks, which each thread collects for itself.
pub(super) trait Findings: Send {
    /// Makes results without any check.
    fn new() -> Self;
    /// Adds the results of another thread, which needed rational arithmetic for so many distances.
    fn merge(&mut self, other: Self, rational: u64);
}

/// Runs jobs of which each checks something, and prints a line after every twentieth of them.
pub(super) fn run<F: Findings>(what: &str, jobs: u64, check: impl Fn(u64, &mut F) + Sync) -> F {
    let all = Mutex::new(F::new());
    let (next, done) = (AtomicU64::new(0), AtomicU64::new(0));
    let work = || {
        let mut results = F::new();
        let before = rational_distances();
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            if job >= jobs {
                break;
            }
            check(job, &mut results);
            let before = done.fetch_add(1, Ordering::Relaxed);
            let part = |count: u64| count * 20 / jobs;
            if part(before + 1) > part(before) {
                eprintln!("{} % of all {what}", part(before + 1) * 5);
            }
        }
        all.lock().expect("no thread panicked").merge(results, rational_distances() - before);
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, Into::into) {
            scope.spawn(work);
        }
    });
    all.into_inner().expect("no thread panicked")
}
