//! A sharded index: the manifest and the shards that are in memory.

use crate::cache::Cache;
use crate::{Manifest, Shard, ShardError};
use p2m_core::Aabb;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An index in shards, which are loaded when a query needs them. The crate documentation has the contract.
///
/// Queries from several threads run at the same time. A query that needs a shard which another thread is loading waits
/// for it.
pub struct ShardedIndex {
    folder: PathBuf,
    manifest: Manifest,
    pub(crate) boxes: Vec<Aabb<f64>>,
    /// The box of the whole scene.
    pub(crate) bounds: Aabb<f64>,
    cache: Cache,
}

impl ShardedIndex {
    /// Opens the sharded index of a folder. No shard is loaded.
    ///
    /// # Errors
    /// It returns the errors of [`Manifest::read`].
    pub fn open(folder: &Path) -> Result<Self, ShardError> {
        Self::open_with(folder, u64::MAX, false)
    }

    /// Opens the sharded index of a folder, with a limit on the memory of the shards in bytes.
    ///
    /// The memory of a shard is estimated as the length of its file and 40 bytes per primitive. If a shard does
    /// not fit, those unused for longest are dropped. Memory may exceed the limit, because one shard is loaded whatever
    /// the limit is, and a dropped shard stays until the threads that use it have finished.
    ///
    /// # Errors
    /// It returns the errors of [`Manifest::read`].
    pub fn open_with_max_bytes(folder: &Path, max_bytes: u64) -> Result<Self, ShardError> {
        Self::open_with(folder, max_bytes, false)
    }

    /// Opens the sharded index of a folder as [`open_with_max_bytes`](Self::open_with_max_bytes) does, and maps the
    /// files of shards into memory, so that processes share it. The limit counts mapped files as well.
    ///
    /// # Safety
    /// Nobody may change or truncate the file of a shard while the index, or a shard of it, is in use. A change is a
    /// data race, and truncation ends the program. [`ShardWriter`](crate::ShardWriter) never writes to a file that a
    /// manifest names: it writes new files and removes the files of an index that it replaces.
    ///
    /// # Errors
    /// It returns the errors of [`Manifest::read`].
    #[allow(unsafe_code, reason = "a file may change while it is mapped; the caller has to prevent that")]
    pub unsafe fn open_mapped(folder: &Path, max_bytes: u64) -> Result<Self, ShardError> {
        Self::open_with(folder, max_bytes, true)
    }

    fn open_with(folder: &Path, max_bytes: u64, is_mapped: bool) -> Result<Self, ShardError> {
        let manifest = Manifest::read(folder)?;
        let boxes = manifest.shards.iter().map(crate::ShardEntry::bounds).collect();
        let cache = Cache::new(folder, &manifest, max_bytes, is_mapped);
        Ok(Self { folder: folder.to_owned(), bounds: manifest.bounds(), manifest, boxes, cache })
    }

    /// Returns the folder of the index.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the manifest.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Returns the box of the whole scene, which is empty if the scene is.
    #[must_use]
    pub fn bounds(&self) -> Aabb<f64> {
        self.bounds
    }

    /// Returns the number of times that a shard was loaded so far.
    #[must_use]
    pub fn loads(&self) -> u64 {
        self.cache.loads()
    }

    /// Returns a shard by its number in the manifest, which is loaded if it is not in memory.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    ///
    /// # Panics
    /// It panics if the manifest has no such shard.
    pub fn shard(&self, number: usize) -> Result<Arc<Shard>, ShardError> {
        self.cache.get(number, &self.manifest.shards)
    }
}
