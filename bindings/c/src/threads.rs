//! Threads of batches, and their end before their time.

use crate::status::{Call, Failure, Status, invalid};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The largest number of threads of a call.
const MAX_THREADS: u32 = 1024;

/// A switch by which another thread, or a signal handler, ends a call before its time.
pub struct Cancel {
    pub(crate) is_set: AtomicBool,
}

/// Makes a switch that is not set. Returns a pointer for `p2m_cancel_free`.
#[unsafe(no_mangle)]
pub extern "C" fn p2m_cancel_new() -> *mut Cancel {
    Box::into_raw(Box::new(Cancel { is_set: AtomicBool::new(false) }))
}

/// Sets a switch: calls that have it end with `P2M_STATUS_CANCELLED`, within milliseconds once they search. Any thread
/// and any signal handler may call this. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_cancel_set(cancel: *const Cancel) {
    // SAFETY: the pointer is null, or one of `p2m_cancel_new`.
    if let Some(cancel) = unsafe { cancel.as_ref() } {
        cancel.is_set.store(true, Ordering::Relaxed);
    }
}

/// Frees a switch that no call has. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_cancel_free(cancel: *mut Cancel) {
    // SAFETY: the pointer is null, or one of `p2m_cancel_new`.
    unsafe { crate::arrays::take_back(cancel) };
}

impl Cancel {
    /// Fails if the switch is set.
    pub(crate) fn check(cancel: Option<&Self>) -> Call {
        let is_set = cancel.is_some_and(|cancel| cancel.is_set.load(Ordering::Relaxed));
        if is_set { Err(Failure(Status::Cancelled, "the call was cancelled".to_owned())) } else { Ok(()) }
    }
}

/// Returns a number of threads that is not absurd.
pub(crate) fn checked(threads: u32) -> Call<u32> {
    if threads > MAX_THREADS { Err(invalid(format!("threads: more than {MAX_THREADS}"))) } else { Ok(threads) }
}

/// Runs a batch with a number of threads, and tells it whether it may use several. 0 stands for all processors, and
/// with 1 the batch runs on the calling thread.
pub(crate) fn with_threads<R: Send>(threads: u32, work: impl FnOnce(bool) -> R + Send) -> Call<R> {
    if threads == 1 { Ok(work(false)) } else { in_pool(threads, || work(true)) }
}

/// Runs work on a pool of so many threads; 0 stands for all processors. The global pool is never used, because a
/// process that was forked has none of the threads of its parent: pools belong to one process, and a child makes its
/// own.
pub(crate) fn in_pool<R: Send>(threads: u32, work: impl FnOnce() -> R + Send) -> Call<R> {
    static POOLS: Mutex<Option<(u32, Pools)>> = Mutex::new(None);
    let threads = checked(threads)?;
    let threads = if threads == 0 { p2m_core::engine::default_threads() } else { threads as usize };
    let mut guard = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if guard.as_ref().is_some_and(|(owner, _)| *owner != process) {
        // To end the pools of the parent would wait for threads that do not exist here.
        std::mem::forget(guard.take());
    }
    let (_, pools) = guard.get_or_insert_with(|| (process, Pools::new()));
    let pool = match pools.get(&threads) {
        Some(pool) => Arc::clone(pool),
        None => {
            let builder = ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("p2m-{number}"));
            let pool = builder.build().map_err(|error| Failure(Status::OutOfMemory, error.to_string()))?;
            Arc::clone(pools.entry(threads).or_insert(Arc::new(pool)))
        }
    };
    drop(guard);
    Ok(pool.install(work))
}

/// The pools of a process by their number of threads. They live as long as the process.
type Pools = HashMap<usize, Arc<ThreadPool>>;
