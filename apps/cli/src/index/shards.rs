//! Indexes in shards, as commands open and summarize them.

use crate::answers::IndexSummary;
use crate::io::{SceneArgs, usage};
use p2m_core::PrimitiveId;
use p2m_shards::{ShardedIndex, folder_of};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Returns the folder of shards at a path, if it is one.
pub(crate) fn shard_folder(path: &Path) -> anyhow::Result<Option<PathBuf>> {
    let folder = folder_of(path);
    if folder.is_none() && path.is_dir() {
        anyhow::bail!(
            "{}: cannot be read: is a directory without the file manifest.json, so it is no finished index in shards",
            path.display()
        );
    }
    Ok(folder)
}

/// Opens an index in shards, whose primitives have to have numbers in a table.
pub(crate) fn open(folder: &Path, max_memory: Option<u64>, is_mapped: bool) -> anyhow::Result<ShardedIndex> {
    let max_bytes = max_memory.unwrap_or(u64::MAX);
    let index = if is_mapped {
        // SAFETY: `--map` says that the user has to keep the files unchanged.
        #[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
        unsafe {
            ShardedIndex::open_mapped(folder, max_bytes)
        }
    } else {
        ShardedIndex::open_with_max_bytes(folder, max_bytes)
    }?;
    if index.manifest().primitive_count() > PrimitiveId::MAX_COUNT as u64 {
        anyhow::bail!("{}: has more than 2^30 primitives, whose numbers fit into no table", folder.display());
    }
    Ok(index)
}

/// Returns the summary of an index in shards.
pub(crate) fn summarize(
    name: String,
    index: &ShardedIndex,
    read_time: Duration,
    build_time: Duration,
) -> IndexSummary<'_> {
    let manifest = index.manifest();
    IndexSummary {
        name,
        format: "p2m-shards",
        counts: manifest.counts(),
        skipped: &[],
        backend: &manifest.backend,
        prepared: None,
        is_loaded: true,
        read_time,
        build_time,
    }
}

/// Returns the line of a summary about the shards and how often they were loaded.
pub(crate) fn loads_line(index: &ShardedIndex) -> String {
    let (count, loads) = (index.manifest().shards.len(), index.loads());
    format!("shards   {count}, loaded {loads} {}\n", if loads == 1 { "time" } else { "times" })
}

/// Returns the part of a report about the shards.
pub(crate) fn shards_json(index: &ShardedIndex, max_memory: Option<u64>) -> Value {
    json!({ "count": index.manifest().shards.len(), "loads": index.loads(), "max_memory": max_memory })
}

/// Refuses options that say how to read a scene or to build an index.
pub(crate) fn refuse_options_of_builds(scene: &SceneArgs, has_options_of_builds: bool) -> anyhow::Result<()> {
    if scene.has_format() {
        return Err(usage("--format is for files, but this is the folder of an index in shards"));
    }
    if has_options_of_builds {
        return Err(usage(
            "--backend, --k, --locator and --filter have no effect on an index in shards: each is built",
        ));
    }
    Ok(())
}
