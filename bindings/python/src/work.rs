//! Running work detached from the interpreter, with signals, progress and an end before its time.
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

/// How a call runs: the number of its threads, and the function of Python that is called with its progress.
pub(crate) type Run = (usize, Option<Py<PyAny>>);

/// The time between two polls of the interpreter.
const POLL_INTERVAL: Duration = Duration::from_millis(40);
/// Steps that are shorter are followed by longer ones.
const SHORT_STEP: Duration = Duration::from_millis(2);
/// Steps that are longer are followed by shorter ones.
const LONG_STEP: Duration = Duration::from_millis(10);
/// The number of queries of the first step, unless they are expected to be slow.
pub(crate) const FIRST_STEP_QUERIES: usize = 16;
/// The largest number of queries of a step.
const MAX_STEP_QUERIES: usize = 1 << 14;

/// The state of a piece of work that its threads and the calling thread share.
pub(crate) struct Monitor {
    is_cancelled: AtomicBool,
    done: AtomicUsize,
    total: usize,
    /// The number of queries of the next step.
    step: AtomicUsize,
    /// Whether the work runs on the calling thread, which then has to poll.
    polls_itself: bool,
    start: Instant,
    /// The time of the last poll, in microseconds after the start.
    last_poll: AtomicU64,
    callback: Option<Py<PyAny>>,
    /// The exception that cancelled the work.
    error: Mutex<Option<PyErr>>,
}

/// The payload of an unwinding that ends cancelled work.
struct Cancelled;

impl Monitor {
    /// Makes the state of work with this total, of which `progress(done, total)` is called from time to time.
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

    /// Returns whether the work was cancelled. What it returns is not used.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }

    /// Returns the result of a part of the work. If the part unwinds, such as for lack of memory, the other threads stop
    /// as well.
    pub(crate) fn run_part<R>(&self, part: impl FnOnce() -> R) -> R {
        catch_unwind(AssertUnwindSafe(part)).unwrap_or_else(|payload| {
            self.is_cancelled.store(true, Ordering::Relaxed);
            resume_unwind(payload)
        })
    }

    /// Sets how much of the work is done.
    pub(crate) fn set_done(&self, done: usize) {
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    /// Returns the number of queries that should be answered before the next call of [`end_step`](Self::end_step).
    pub(crate) fn step(&self) -> usize {
        self.step.load(Ordering::Relaxed)
    }

    /// Sets the number of queries of the next step.
    pub(crate) fn set_step(&self, queries: usize) {
        self.step.store(queries, Ordering::Relaxed);
    }

    /// Records that so many queries were answered in a step that began at this time.
    pub(crate) fn end_step(&self, queries: usize, start: Instant) {
        self.done.fetch_add(queries, Ordering::Relaxed);
        let now = Instant::now();
        let elapsed = now - start;
        if elapsed < SHORT_STEP {
            // After a shorter step than planned, such as the last one, a longer one might not be short enough.
            if queries >= self.step() {
                self.step.store((2 * queries).min(MAX_STEP_QUERIES), Ordering::Relaxed);
            }
        } else if elapsed > LONG_STEP {
            self.step.store((queries / 2).max(1), Ordering::Relaxed);
        }
        self.poll_if_due(now);
    }

    /// Answers the next step of a batch with so many queries left, unless the work was cancelled. Returns whether to go on.
    ///
    /// Batches of the library order all their queries and hand them to the index by the thousand. So the order of a
    /// batch does not depend on how often it is watched, and steps cost nothing that can be measured.
    pub(crate) fn run_step(&self, left: usize, answer: &mut dyn FnMut(usize)) -> bool {
        if self.is_cancelled() {
            return false;
        }
        let (count, start) = (self.step().min(left), Instant::now());
        answer(count);
        self.end_step(count, start);
        true
    }

    /// Polls if this thread has to, and has not done so for the interval.
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

    /// Ends the work by unwinding if it was cancelled. It is for callbacks that have no other way to end it.
    pub(crate) fn unwind_if_cancelled(&self) {
        if self.is_cancelled() {
            // No hook prints anything for it.
            resume_unwind(Box::new(Cancelled));
        }
    }

    /// Lets the interpreter handle signals and calls the callback. An exception cancels the work.
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

    /// Returns the exception of cancelled work, or makes the last call of the callback.
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

/// Returns the exception for work that ran out of memory, or for a panic, which is an error of this package and not
/// of its user.
fn panicked(payload: &(dyn Any + Send)) -> PyErr {
    if payload.is::<OutOfMemory>() {
        return PyMemoryError::new_err("the answers do not fit into memory");
    }
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    PyRuntimeError::new_err(format!("p2m failed, which is an error in p2m: {text}"))
}

/// Runs work that may run out of memory on the calling thread.
pub(crate) fn catch<R>(work: impl FnOnce() -> R) -> PyResult<R> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| panicked(&*payload))
}

/// Where a batch runs.
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

/// Runs work that borrows, detached from the interpreter, and waits until all of it has ended. It is a batch of so many
/// queries, and begins with a step of `first_step` of them.
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

/// Runs work that owns what it needs on a pool, detached from the interpreter. If it is cancelled, this returns at
/// once, and the work ends in the background when it next looks at the monitor.
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
