//! Thread pools for bindings to other languages. A pool belongs to one process.
//!
//! A forked process has none of the threads of its parent, so work in a pool of the parent would never end. Pools are
//! therefore stored with the id of their process, and a child creates its own. The global pool of rayon cannot be
//! recreated, so it is never used.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The pools of a process, by number of threads.
type Pools = HashMap<usize, Arc<ThreadPool>>;

/// Pools with the id of the process to which they belong.
type OwnedPools = Option<(u32, Pools)>;

/// The pools that are shared by all threads.
static POOLS: Mutex<OwnedPools> = Mutex::new(None);

thread_local! {
    /// The pool of one thread that serves the current thread.
    static OWN_POOL: RefCell<OwnedPools> = const { RefCell::new(None) };
}

/// Returns this process's pool of `threads` threads. The first call starts it. It lives as long as the process, unless
/// it is [abandoned](abandon_pool). Pools of one thread belong to the calling thread and live as long as it does, so
/// that callers on several threads do not wait for each other.
///
/// If another thread forks while this function runs, calls in the child process never return.
///
/// # Errors
/// Returns a [`ThreadPoolBuildError`] if the system refuses to start more threads.
pub fn shared_pool(threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    if threads == 1 {
        return OWN_POOL.with_borrow_mut(|owned| pool_of(owned, threads));
    }
    pool_of(&mut POOLS.lock().unwrap_or_else(PoisonError::into_inner), threads)
}

/// Returns the pool with this number of threads, and starts it if there is none.
fn pool_of(owned: &mut OwnedPools, threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let process = std::process::id();
    if owned.as_ref().is_some_and(|(owner, _)| *owner != process) {
        // Dropping the pools of the parent would wait for threads that do not exist in this process.
        std::mem::forget(owned.take());
    }
    let (_, pools) = owned.get_or_insert_with(|| (process, Pools::new()));
    if let Some(pool) = pools.get(&threads) {
        return Ok(Arc::clone(pool));
    }
    let pool = start_pool(threads)?;
    pools.insert(threads, Arc::clone(&pool));
    Ok(pool)
}

/// Starts a pool with this number of threads that nobody else uses.
fn start_pool(threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let builder = ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("p2m-{number}"));
    builder.build().map(Arc::new)
}

/// Leaves a pool to the cancelled work that runs on it. Later calls get another pool, and the threads end with that
/// work.
pub fn abandon_pool(abandoned: &Arc<ThreadPool>) {
    let leave = |owned: &mut OwnedPools| {
        if let Some((_, pools)) = owned {
            pools.retain(|_, pool| !Arc::ptr_eq(pool, abandoned));
        }
    };
    OWN_POOL.with_borrow_mut(leave);
    leave(&mut POOLS.lock().unwrap_or_else(PoisonError::into_inner));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_threads_has_one_pool_until_it_is_abandoned() {
        let pool = shared_pool(3).expect("threads");
        assert_eq!(pool.current_num_threads(), 3);
        assert!(Arc::ptr_eq(&pool, &shared_pool(3).expect("threads")));
        assert!(!Arc::ptr_eq(&pool, &start_pool(3).expect("threads")));
        abandon_pool(&pool);
        assert!(!Arc::ptr_eq(&pool, &shared_pool(3).expect("threads")));
    }

    #[test]
    fn each_thread_has_a_pool_of_one_thread() {
        let pool = shared_pool(1).expect("threads");
        assert!(Arc::ptr_eq(&pool, &shared_pool(1).expect("threads")));
        let other = std::thread::spawn(|| shared_pool(1).expect("threads")).join().expect("no panic");
        assert!(!Arc::ptr_eq(&pool, &other) && other.current_num_threads() == 1);
        abandon_pool(&pool);
        assert!(!Arc::ptr_eq(&pool, &shared_pool(1).expect("threads")));
    }
}
