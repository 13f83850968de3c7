//! Threads and cancellation of batches.

use crate::status::{Call, Failure, Status, invalid};
use std::sync::atomic::{AtomicBool, Ordering};

/// A switch with which another thread, or a signal handler, cancels a call.
pub struct Cancel {
    pub(crate) is_set: AtomicBool,
}

/// Makes a switch that is not set. Free it with `p2m_cancel_free`.
#[unsafe(no_mangle)]
pub extern "C" fn p2m_cancel_new() -> *mut Cancel {
    Box::into_raw(Box::new(Cancel { is_set: AtomicBool::new(false) }))
}

/// Sets a switch. Calls with this switch end with `P2M_STATUS_CANCELLED`, within milliseconds once they search. Any
/// thread and any signal handler may call this function. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_cancel_set(cancel: *const Cancel) {
    // SAFETY: the pointer is null, or one of `p2m_cancel_new`.
    if let Some(cancel) = unsafe { cancel.as_ref() } {
        cancel.is_set.store(true, Ordering::Relaxed);
    }
}

/// Frees a switch. No other call may be using it. Null is ignored.
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

/// The largest number of threads of a call.
const MAX_THREADS: u32 = 1024;

/// Returns a number of threads, or fails if it is absurdly large.
pub(crate) fn checked(threads: u32) -> Call<u32> {
    if threads > MAX_THREADS { Err(invalid(format!("threads: more than {MAX_THREADS}"))) } else { Ok(threads) }
}

/// Runs a batch with a number of threads, and passes whether it may use several. 0 stands for all processors. With 1
/// the batch runs on the calling thread.
pub(crate) fn with_threads<R: Send>(threads: u32, work: impl FnOnce(bool) -> R + Send) -> Call<R> {
    if threads == 1 { Ok(work(false)) } else { in_pool(threads, || work(true)) }
}

/// Runs work on a pool with this number of threads; 0 stands for all processors.
#[cfg(feature = "rayon")]
pub(crate) fn in_pool<R: Send>(threads: u32, work: impl FnOnce() -> R + Send) -> Call<R> {
    let threads = if threads == 0 { p2m_core::engine::default_threads() } else { checked(threads)? as usize };
    let pool = p2m_core::engine::pools::shared_pool(threads);
    Ok(pool.map_err(|error| Failure(Status::OutOfMemory, error.to_string()))?.install(work))
}

/// Runs work on the calling thread, because the crate was compiled without other threads.
#[cfg(not(feature = "rayon"))]
pub(crate) fn in_pool<R: Send>(threads: u32, work: impl FnOnce() -> R + Send) -> Call<R> {
    checked(threads).map(|_| work())
}
