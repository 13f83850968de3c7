//! Pools of threads.
//!
//! Only threads that are attached to the interpreter take the lock of p2m-core's pools, and only such threads fork. So
//! no child process starts with a lock that is never released.

use p2m_core::engine::pools;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPool;
use std::sync::{Arc, OnceLock};

/// Returns the default number of threads: the environment variable `RAYON_NUM_THREADS`, or else the number of
/// processors that this process may use, and at most 1024.
///
/// It is determined once, because asking the system takes longer than ten queries.
#[pyfunction]
pub(crate) fn default_threads() -> usize {
    static THREADS: OnceLock<usize> = OnceLock::new();
    *THREADS.get_or_init(p2m_core::engine::default_threads)
}

/// Returns the pool of this process with this number of threads. The first call starts the threads.
pub(crate) fn pool(_: Python<'_>, threads: usize) -> PyResult<Arc<ThreadPool>> {
    pools::shared_pool(threads).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// Leaves a pool to the cancelled work that runs on it. Later calls get another pool, and the threads end with the
/// work.
pub(crate) fn abandon(_: Python<'_>, abandoned: &Arc<ThreadPool>) {
    pools::abandon_pool(abandoned);
}
