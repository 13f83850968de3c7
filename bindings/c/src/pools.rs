//! Pools of threads.

use crate::status::{Call, Failure, Status};
use crate::threads::checked;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

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
