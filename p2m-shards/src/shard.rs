//! A shard in memory: a part of the scene with its index and the ids of its primitives in the whole scene.

use crate::{ShardEntry, ShardError};
use p2m_backends::BackendEntry;
use p2m_core::storage::{Array, LoadError, SavedFile, require};
use p2m_core::{Aabb, AnyIndex, PrimitiveId, PrimitiveSet, Soup};
use p2m_mixed::load_scene;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// `(n,)` u64: the ids of the primitives in the whole scene, in ascending order.
pub(crate) const IDS: &str = "shard/ids";
/// An estimate of the memory that a primitive takes besides the file, in bytes: its vertices and its indices.
const MEMORY_BYTES_PER_PRIMITIVE: u64 = 40;

/// A part of the scene in memory.
pub struct Shard {
    soup: Arc<Soup<f64>>,
    bounds: Aabb<f64>,
    backend: &'static BackendEntry,
    index: Arc<dyn AnyIndex>,
    ids: Array<u64>,
}

impl Shard {
    /// Loads the shard of an entry of the manifest from the folder, and checks that the file matches the entry.
    pub(crate) fn load(folder: &Path, backend: &str, entry: &ShardEntry, is_mapped: bool) -> Result<Self, ShardError> {
        let file = folder.join(&entry.file);
        let other = |reason| ShardError::OtherShard { file: file.clone(), reason };
        let load_error = |error| ShardError::Load { file: file.clone(), error };
        let length = fs::metadata(&file).map_err(|error| load_error(error.into()))?.len();
        if length != entry.bytes {
            return Err(load_error(LoadError::Length { found: length, expected: entry.bytes }));
        }
        let saved = if is_mapped { map(&file) } else { SavedFile::open(&file) }.map_err(load_error)?;
        if format!("{:016x}", saved.checksum()) != entry.checksum {
            return Err(other("its checksum differs"));
        }
        let load = || {
            let reader = saved.checked()?;
            let soup = load_scene(reader)?.soup;
            let ids = reader.array::<u64>(IDS)?;
            require(ids.len() == soup.len(), IDS, "there is not one for each primitive")?;
            require(ids.is_sorted_by(|a, b| a < b), IDS, "they are not in ascending order")?;
            let missing = LoadError::Missing { section: "index/kind".to_owned() };
            let backend = BackendEntry::from_saved(reader).ok_or(missing)?;
            let index = backend.load(Arc::clone(&soup), reader)?.index;
            Ok(Self { bounds: soup.aabb(), soup, backend, index, ids })
        };
        let shard = load().map_err(load_error)?;
        if shard.backend() != backend {
            return Err(other("its backend differs"));
        }
        if shard.soup.len() as u64 != entry.primitives {
            return Err(other("the number of its primitives differs"));
        }
        if shard.bounds != entry.bounds() {
            return Err(other("its box differs"));
        }
        Ok(shard)
    }

    /// Returns an estimate of the memory of the shard of an entry, in bytes.
    pub(crate) fn estimated_bytes(entry: &ShardEntry) -> u64 {
        entry.bytes + MEMORY_BYTES_PER_PRIMITIVE * entry.primitives
    }

    /// Returns the primitives, whose ids in the shard are in the order of their ids in the whole scene.
    #[must_use]
    pub fn soup(&self) -> &Soup<f64> {
        &self.soup
    }

    /// Returns the box of the primitives.
    pub(crate) fn bounds(&self) -> &Aabb<f64> {
        &self.bounds
    }

    /// Returns the name of the backend of the index.
    pub(crate) fn backend(&self) -> &'static str {
        self.backend.name
    }

    /// Returns the index over the primitives.
    #[must_use]
    pub fn index(&self) -> &dyn AnyIndex {
        &*self.index
    }

    /// Returns the id in the whole scene of a primitive of the shard.
    ///
    /// # Panics
    /// It panics if the shard has no such primitive.
    #[must_use]
    pub fn global_id(&self, id: PrimitiveId) -> u64 {
        self.ids[id.index()]
    }
}

/// Maps the file of a shard into memory.
#[allow(unsafe_code, reason = "a file may change while it is mapped; the caller of `open_mapped` has to prevent that")]
fn map(file: &Path) -> Result<SavedFile, LoadError> {
    // SAFETY: the caller of the unsafe function `ShardedIndex::open_mapped` ensures that nobody changes the file.
    unsafe { SavedFile::map(file) }
}
