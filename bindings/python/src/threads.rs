//! Pools of threads.
//!
//! The lock of p2m-core's pools is only taken by threads that are attached to the interpreter, and so is a fork. So no
//! child begins with a lock that nobody releases.

use p2m_core::engine::pools;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPool;
use std::sync::{Arc, OnceLock};

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
    pools::shared_pool(threads).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// Leaves a pool to the cancelled work that runs on it: later calls get another one. Its threads end with that work.
pub(crate) fn abandon(_: Python<'_>, abandoned: &Arc<ThreadPool>) {
    pools::abandon_pool(abandoned);
}
