//! Pools of threads, which belong to one process.
//!
//! A process that was forked has none of the threads of its parent, so a pool of the parent would never answer. Pools
//! are therefore kept with the id of their process, and a child makes its own. The global pool of rayon cannot be made
//! anew, so it is never used.

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The pools of a process by their number of threads.
type Pools = HashMap<usize, Arc<ThreadPool>>;

/// The pools, with the id of the process that they belong to. The lock is only taken by threads that are attached to
/// the interpreter, and so is a fork. So no child begins with a lock that nobody releases.
static POOLS: Mutex<Option<(u32, Pools)>> = Mutex::new(None);

/// Returns the number of threads that is used where none is given: that of the environment variable
/// `RAYON_NUM_THREADS`, or else the number of processors that this process may use, and at most 1024.
///
/// It is determined once, because the system takes longer to tell it than ten queries take.
#[pyfunction]
pub(crate) fn default_threads() -> usize {
    static THREADS: OnceLock<usize> = OnceLock::new();
    *THREADS.get_or_init(p2m_core::engine::default_threads)
}

/// Returns the pool of this process with so many threads, which are started by the first call.
pub(crate) fn pool(_: Python<'_>, threads: usize) -> PyResult<Arc<ThreadPool>> {
    let mut guard = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if guard.as_ref().is_some_and(|(owner, _)| *owner != process) {
        // To end the pools of the parent would wait for threads that do not exist here.
        std::mem::forget(guard.take());
    }
    let (_, pools) = guard.get_or_insert_with(|| (process, Pools::new()));
    if let Some(pool) = pools.get(&threads) {
        return Ok(Arc::clone(pool));
    }
    let pool = start(threads)?;
    pools.insert(threads, Arc::clone(&pool));
    Ok(pool)
}

/// Returns a pool with so many threads that nobody else uses.
pub(crate) fn start(threads: usize) -> PyResult<Arc<ThreadPool>> {
    let builder = ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("p2m-{number}"));
    let pool = builder.build().map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?;
    Ok(Arc::new(pool))
}

/// Leaves a pool to the cancelled work that runs on it: later calls get another one. Its threads end with that work.
pub(crate) fn abandon(_: Python<'_>, abandoned: &Arc<ThreadPool>) {
    let mut guard = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, pools)) = guard.as_mut() {
        pools.retain(|_, pool| !Arc::ptr_eq(pool, abandoned));
    }
}
