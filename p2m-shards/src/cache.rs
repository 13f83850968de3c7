//! A cache of the shards in memory. A shard is loaded when a query needs it, and shards unused for longest make room
//! for it.

use crate::manifest::Manifest;
use crate::shard::Shard;
use crate::{ShardEntry, ShardError};
use p2m_core::engine::MAX_THREADS;
use rayon::ThreadPoolBuilder;
use std::error::Error;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::thread;

/// The place of a shard in the cache.
#[derive(Default)]
struct Slot {
    shard: RwLock<Option<Arc<Shard>>>,
    /// The time of the last use, by the clock of the cache.
    last_use: AtomicU64,
}

/// The shards of an index that are in memory.
pub(crate) struct Cache {
    folder: PathBuf,
    /// The name of the backend in the manifest.
    backend: String,
    is_mapped: bool,
    /// The largest sum of the estimated bytes of all shards in memory.
    max_bytes: u64,
    slots: Vec<Slot>,
    /// The number of uses so far, which orders them.
    clock: AtomicU64,
    /// The number of times that a shard was loaded.
    loads: AtomicU64,
    /// The sum of the estimated bytes of the shards in memory. The holder of the lock may remove shards.
    used_bytes: Mutex<u64>,
}

impl Cache {
    pub(crate) fn new(folder: &Path, manifest: &Manifest, max_bytes: u64, is_mapped: bool) -> Self {
        Self {
            folder: folder.to_owned(),
            backend: manifest.backend.clone(),
            is_mapped,
            max_bytes,
            slots: std::iter::repeat_with(Slot::default).take(manifest.shards.len()).collect(),
            clock: AtomicU64::new(0),
            loads: AtomicU64::new(0),
            used_bytes: Mutex::new(0),
        }
    }

    /// Returns the number of times that a shard was loaded.
    pub(crate) fn loads(&self) -> u64 {
        self.loads.load(Ordering::Relaxed)
    }

    /// Returns a shard, which is loaded if it is not in memory. `entries` are the shards of the manifest.
    pub(crate) fn get(&self, number: usize, entries: &[ShardEntry]) -> Result<Arc<Shard>, ShardError> {
        let slot = &self.slots[number];
        slot.last_use.store(self.clock.fetch_add(1, Ordering::Relaxed), Ordering::Relaxed);
        if let Some(shard) = &*slot.shard.read().unwrap_or_else(PoisonError::into_inner) {
            return Ok(Arc::clone(shard));
        }
        // Other threads that need the same shard wait here until it is loaded.
        let mut place = slot.shard.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(shard) = &*place {
            return Ok(Arc::clone(shard));
        }
        self.reserve(number, entries);
        let loaded = self.load(&entries[number]);
        if !matches!(loaded, Ok(Ok(_))) {
            self.release(&entries[number]);
        }
        let shard = loaded.unwrap_or_else(|panic| resume_unwind(panic))?;
        self.loads.fetch_add(1, Ordering::Relaxed);
        Ok(Arc::clone(place.insert(Arc::new(shard))))
    }

    /// Loads a shard on threads of its own, and returns the panic if there is one.
    ///
    /// Files are checked in parallel. A thread of a pool that waits for these checks begins other queries meanwhile,
    /// which may need the very shard that it is loading, so it would wait for itself.
    fn load(&self, entry: &ShardEntry) -> thread::Result<Result<Shard, ShardError>> {
        let threads = rayon::current_num_threads().min(MAX_THREADS);
        let no_thread = |error: &dyn Error| ShardError::Threads { reason: error.to_string() };
        let load = || {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| no_thread(&error))?;
            pool.install(|| Shard::load(&self.folder, &self.backend, entry, self.is_mapped))
        };
        thread::scope(|scope| match thread::Builder::new().spawn_scoped(scope, load) {
            Ok(loader) => loader.join(),
            Err(error) => Ok(Err(no_thread(&error))),
        })
    }

    /// Counts the bytes of a shard that is about to be loaded, and removes others until all fit, if that is possible.
    fn reserve(&self, number: usize, entries: &[ShardEntry]) {
        let mut used = self.used_bytes.lock().unwrap_or_else(PoisonError::into_inner);
        *used += Shard::estimated_bytes(&entries[number]);
        // Other threads go on using shards, so each time is read once: sorting panics if keys change.
        let use_of = |other: usize| (self.slots[other].last_use.load(Ordering::Relaxed), other);
        let mut by_use: Vec<(u64, usize)> =
            (0..self.slots.len()).filter(|other| *other != number).map(use_of).collect();
        by_use.sort_unstable();
        for (_, other) in by_use {
            if *used <= self.max_bytes {
                return;
            }
            // A shard that another thread is loading or looking at stays: waiting for it here might never end.
            if let Ok(mut place) = self.slots[other].shard.try_write()
                && place.take().is_some()
            {
                *used -= Shard::estimated_bytes(&entries[other]);
            }
        }
    }

    /// Takes back the bytes of a shard that could not be loaded.
    fn release(&self, entry: &ShardEntry) {
        let mut used = self.used_bytes.lock().unwrap_or_else(PoisonError::into_inner);
        *used -= Shard::estimated_bytes(entry);
    }
}
