//! Pools of threads for other languages, which belong to one process.
//!
//! A process that was forked has none of the threads of its parent, so a pool of the parent would never answer. Pools
//! are therefore kept with the id of their process, and a child makes its own. The global pool of rayon cannot be made
//! anew, so it is never used.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The pools of a process by their number of threads.
type Pools = HashMap<usize, Arc<ThreadPool>>;

/// Pools, with the id of the process that they belong to.
type OwnedPools = Option<(u32, Pools)>;

/// The pools that all threads share.
static POOLS: Mutex<OwnedPools> = Mutex::new(None);

thread_local! {
    /// The pool of one thread that works for this thread.
    static OWN_POOL: RefCell<OwnedPools> = const { RefCell::new(None) };
}

/// Returns the pool of this process with so many threads, which are started by the first call. It lives as long as the
/// process, unless it is [abandoned](abandon_pool). Pools of one thread belong to the calling thread and live as long as
/// it, so that callers on several threads do not wait for each other.
///
/// A fork in another thread while this function runs leaves a child whose calls never return.
///
/// # Errors
/// [`ThreadPoolBuildError`] if the system starts no more threads.
pub fn shared_pool(threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    if threads == 1 {
        return OWN_POOL.with_borrow_mut(|owned| pool_of(owned, threads));
    }
    pool_of(&mut POOLS.lock().unwrap_or_else(PoisonError::into_inner), threads)
}

/// Returns the pool with so many threads among these, which is started if there is none.
fn pool_of(owned: &mut OwnedPools, threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let process = std::process::id();
    if owned.as_ref().is_some_and(|(owner, _)| *owner != process) {
        // To end the pools of the parent would wait for threads that do not exist here.
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

/// Returns a pool with so many threads that nobody else uses.
fn start_pool(threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let builder = ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("p2m-{number}"));
    builder.build().map(Arc::new)
}

/// Leaves a pool to the cancelled work that runs on it: later calls get another one. Its threads end with that work.
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
