//! Threads of batches, and their end before their time.

use crate::status::{Call, Failure, Status, invalid};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

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

/// Sets a switch: calls that have it end with `P2M_STATUS_CANCELLED`, those that run within milliseconds. Any thread and
/// any signal handler may call this. Null is ignored.
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
        match cancel {
            Some(cancel) if cancel.is_set.load(Ordering::Relaxed) => {
                Err(Failure(Status::Cancelled, "the call was cancelled".to_owned()))
            }
            _ => Ok(()),
        }
    }
}

/// Runs work with a number of threads, and tells it whether it may use several. 0 stands for all processors, and with 1
/// the work runs on the calling thread.
pub(crate) fn with_threads<R: Send>(threads: u32, work: impl FnOnce(bool) -> R + Send) -> Call<R> {
    static POOLS: OnceLock<Mutex<HashMap<usize, Arc<ThreadPool>>>> = OnceLock::new();
    if threads == 1 {
        return Ok(work(false));
    }
    if threads > MAX_THREADS {
        return Err(invalid(format!("threads: {threads} is more than {MAX_THREADS}")));
    }
    let threads = if threads == 0 { p2m_core::engine::default_threads() } else { threads as usize };
    let mut pools = POOLS.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
    let pool = match pools.get(&threads) {
        Some(pool) => Arc::clone(pool),
        None => {
            let builder = ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("p2m-{number}"));
            let pool = builder.build().map_err(|error| Failure(Status::OutOfMemory, error.to_string()))?;
            Arc::clone(pools.entry(threads).or_insert(Arc::new(pool)))
        }
    };
    drop(pools);
    Ok(pool.install(|| work(true)))
}
