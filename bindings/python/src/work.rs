//! Work that is detached from the interpreter, with signals, progress and cancellation.
//!
//! The calling thread waits for the threads that work. Every [`POLL_INTERVAL`] it attaches to the interpreter, lets
//! it handle signals, and calls the progress callback. If either raises an exception, the work is cancelled. Work that
//! is small, or for one thread, runs on the calling thread itself, which then polls between its steps.

use crate::memory::OutOfMemory;
use pyo3::exceptions::{PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;
use rayon::ThreadPool;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The options of a call: the number of threads, and the Python function that receives its progress.
pub(crate) type Run = (usize, Option<Py<PyAny>>);

/// The time between two polls of the interpreter.
const POLL_INTERVAL: Duration = Duration::from_millis(40);
/// The duration below which the next step becomes longer.
const SHORT_STEP: Duration = Duration::from_millis(2);
/// The duration above which the next step becomes shorter.
const LONG_STEP: Duration = Duration::from_millis(10);
/// The number of queries in the first step, unless they are expected to be slow.
pub(crate) const FIRST_STEP_QUERIES: usize = 16;
/// The largest number of queries in a step.
const MAX_STEP_QUERIES: usize = 1 << 14;

/// The state of a piece of work, shared by its threads and the calling thread.
pub(crate) struct Monitor {
    is_cancelled: AtomicBool,
    done: AtomicUsize,
    total: usize,
    /// The number of queries of the next step.
    step: AtomicUsize,
    /// Whether the work runs on the calling thread, which then has to poll between its steps.
    polls_itself: bool,
    start: Instant,
    /// The time of the last poll, in microseconds after the start.
    last_poll: AtomicU64,
    callback: Option<Py<PyAny>>,
    /// The exception that cancelled the work.
    error: Mutex<Option<PyErr>>,
}

/// The panic payload that ends cancelled work.
struct Cancelled;

impl Monitor {
    /// Makes the state of work with a total. `progress(done, total)` is called from time to time.
    fn new(total: usize, progress: Option<Py<PyAny>>, polls_itself: bool) -> Self {
        Self {
            is_cancelled: AtomicBool::new(false),
            done: AtomicUsize::new(0),
            total,
            step: AtomicUsize::new(FIRST_STEP_QUERIES),
            polls_itself,
            start: Instant::now(),
            last_poll: AtomicU64::new(0),
            callback: progress,
            error: Mutex::new(None),
        }
    }

    /// Returns whether the work was cancelled. Its result is then discarded.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }

    /// Runs a part of the work. If it unwinds, for example because memory runs out, the other threads stop as well.
    pub(crate) fn run_part<R>(&self, part: impl FnOnce() -> R) -> R {
        catch_unwind(AssertUnwindSafe(part)).unwrap_or_else(|payload| {
            self.is_cancelled.store(true, Ordering::Relaxed);
            resume_unwind(payload)
        })
    }

    /// Sets the amount of work that is done.
    pub(crate) fn set_done(&self, done: usize) {
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    /// Returns the number of queries to answer before the next call of [`end_step`](Self::end_step).
    pub(crate) fn step(&self) -> usize {
        self.step.load(Ordering::Relaxed)
    }

    /// Sets the number of queries of the next step.
    pub(crate) fn set_step(&self, queries: usize) {
        self.step.store(queries, Ordering::Relaxed);
    }

    /// Records the end of a step of this number of queries, and adapts the length of the next one.
    pub(crate) fn end_step(&self, queries: usize, start: Instant) {
        self.done.fetch_add(queries, Ordering::Relaxed);
        let now = Instant::now();
        let elapsed = now - start;
        if elapsed < SHORT_STEP {
            // A step that was shorter than planned, such as the last one of a batch, says nothing about longer ones.
            if queries >= self.step() {
                self.step.store((2 * queries).min(MAX_STEP_QUERIES), Ordering::Relaxed);
            }
        } else if elapsed > LONG_STEP {
            self.step.store((queries / 2).max(1), Ordering::Relaxed);
        }
        self.poll_if_due(now);
    }

    /// Answers the next step of a batch with `left` remaining queries, unless the work was cancelled. Returns whether
    /// to continue.
    ///
    /// The library orders all queries of a batch and hands them to the index in blocks of about a thousand. So the
    /// order of a batch does not depend on how often it is interrupted, and steps cost no measurable time.
    pub(crate) fn run_step(&self, left: usize, answer: &mut dyn FnMut(usize)) -> bool {
        if self.is_cancelled() {
            return false;
        }
        let (count, start) = (self.step().min(left), Instant::now());
        answer(count);
        self.end_step(count, start);
        true
    }

    /// Polls if this thread has to poll, and the last poll is longer ago than the interval.
    fn poll_if_due(&self, now: Instant) {
        if self.polls_itself {
            let micros = u64::try_from((now - self.start).as_micros()).unwrap_or(u64::MAX);
            let interval = u64::try_from(POLL_INTERVAL.as_micros()).unwrap_or(u64::MAX);
            if micros - self.last_poll.load(Ordering::Relaxed) >= interval {
                self.last_poll.store(micros, Ordering::Relaxed);
                self.poll();
            }
        }
    }

    /// Unwinds if the work was cancelled. For callbacks that cannot end the work in another way.
    pub(crate) fn unwind_if_cancelled(&self) {
        if self.is_cancelled() {
            // `resume_unwind` does not call the panic hook, so nothing is printed.
            resume_unwind(Box::new(Cancelled));
        }
    }

    /// Lets the interpreter handle signals, and calls the callback. An exception cancels the work.
    fn poll(&self) {
        let polled = Python::attach(|py| py.check_signals().and_then(|()| self.report(py)));
        if let Err(error) = polled {
            self.is_cancelled.store(true, Ordering::Relaxed);
            self.lock_error().get_or_insert(error);
        }
    }

    /// Calls the callback with what is done and the total.
    fn report(&self, py: Python<'_>) -> PyResult<()> {
        let Some(callback) = &self.callback else { return Ok(()) };
        let done = self.done.load(Ordering::Relaxed).min(self.total);
        callback.bind(py).call1((done, self.total)).map(drop)
    }

    /// Returns the exception of cancelled work, or calls the callback for the last time.
    fn finish<R>(&self, py: Python<'_>, result: Result<R, Box<dyn Any + Send>>) -> PyResult<R> {
        if let Some(error) = self.lock_error().take() {
            return Err(error);
        }
        match result {
            Ok(result) => {
                self.set_done(self.total);
                self.report(py)?;
                Ok(result)
            }
            Err(payload) => Err(panicked(&*payload)),
        }
    }

    fn lock_error(&self) -> std::sync::MutexGuard<'_, Option<PyErr>> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the exception for work that ran out of memory, or for a panic, which is a bug of this package and not a
/// mistake of the user.
fn panicked(payload: &(dyn Any + Send)) -> PyErr {
    if payload.is::<OutOfMemory>() {
        return PyMemoryError::new_err("the answers do not fit into memory");
    }
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    PyRuntimeError::new_err(format!("p2m failed, which is an error in p2m: {text}"))
}

/// Runs work that may run out of memory, on the calling thread.
pub(crate) fn catch<R>(work: impl FnOnce() -> R) -> PyResult<R> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| panicked(&*payload))
}

/// The threads on which a batch runs.
pub(crate) enum Threads {
    /// On the calling thread.
    Calling,
    /// On the threads of a pool.
    Pool(Arc<ThreadPool>),
}

impl Threads {
    /// Returns whether the work may be divided among threads.
    pub(crate) fn is_parallel(&self) -> bool {
        matches!(self, Self::Pool(_))
    }
}

/// Runs work that borrows data, detached from the interpreter, and waits until all of it has ended. The work is a batch
/// of this number of queries, and its first step has `first_step` of them.
pub(crate) fn run_batch<R: Send>(
    py: Python<'_>,
    threads: &Threads,
    (queries, first_step): (usize, usize),
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Threads, &Monitor) -> PyResult<R> + Send,
) -> PyResult<R> {
    let monitor = Monitor::new(queries, progress, !threads.is_parallel());
    monitor.set_step(first_step);
    let work = || work(threads, &monitor);
    let result = match threads {
        Threads::Calling => py.detach(|| catch_unwind(AssertUnwindSafe(work))),
        Threads::Pool(pool) => py.detach(|| {
            let mut result = None;
            pool.in_place_scope(|scope| {
                let (ended, end) = channel::<()>();
                let result = &mut result;
                scope.spawn(move |_| {
                    *result = Some(catch_unwind(AssertUnwindSafe(work)));
                    drop(ended);
                });
                while end.recv_timeout(POLL_INTERVAL) == Err(RecvTimeoutError::Timeout) {
                    monitor.poll();
                }
            });
            result.unwrap_or_else(|| Err(Box::new("its thread has ended")))
        }),
    };
    monitor.finish(py, result)?
}

/// Runs work that owns its data on a pool, detached from the interpreter. If the work is cancelled, this function
/// returns at once, and the work ends in the background when it next checks the monitor.
pub(crate) fn run_owned<R: Send + 'static>(
    py: Python<'_>,
    (threads, progress): Run,
    total: usize,
    work: impl FnOnce(&Monitor) -> R + Send + 'static,
) -> PyResult<R> {
    let pool = crate::threads::pool(py, threads)?;
    let monitor = Arc::new(Monitor::new(total, progress, false));
    let result = py.detach(|| {
        let (send, receive) = channel();
        let shared = Arc::clone(&monitor);
        pool.spawn(move || {
            let result = catch_unwind(AssertUnwindSafe(|| work(&shared)));
            // Nobody waits for the result of cancelled work.
            let _ = send.send(result);
        });
        loop {
            match receive.recv_timeout(POLL_INTERVAL) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Timeout) => monitor.poll(),
                Err(RecvTimeoutError::Disconnected) => return Err(Box::new("its thread has ended") as Box<_>),
            }
            if monitor.is_cancelled() {
                return Err(Box::new(Cancelled) as Box<_>);
            }
        }
    });
    if monitor.is_cancelled() {
        crate::threads::abandon(py, &pool);
    }
    monitor.finish(py, result)
}
