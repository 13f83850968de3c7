//! Errors of writing shards, and of queries that have to load one.

use p2m_core::BuildError;
use p2m_core::storage::LoadError;
use p2m_mixed::ReadError;
use std::io;
use std::path::PathBuf;

/// An error of writing, opening or querying a sharded index. The message begins with the name of the file, if the
/// error concerns one.
///
/// # Loading a shard
///
/// A query loads the shards that it needs. Loading fails with [`Load`](Self::Load) if the file cannot be read, is
/// damaged or has another length, with [`OtherShard`](Self::OtherShard) if a file of the right length is not the one
/// that the manifest describes, and with [`Threads`](Self::Threads) if the system has no thread for it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShardError {
    /// A file cannot be read or written.
    #[error("{}: {error}", file.display())]
    Io {
        /// The file or the folder.
        file: PathBuf,
        /// The error of the operating system, which the message repeats.
        error: io::Error,
    },
    /// The folder has the manifest of a sharded index already.
    #[error("{}: there is a sharded index already", folder.display())]
    Exists {
        /// The folder.
        folder: PathBuf,
    },
    /// The manifest does not belong to a sharded index, or contradicts itself.
    #[error("{}: {reason}", file.display())]
    Manifest {
        /// The manifest.
        file: PathBuf,
        /// What is wrong, as a clause for the message.
        reason: String,
    },
    /// The file of a shard cannot be read, is damaged, or has another length than the manifest states or another
    /// version of the format.
    #[error("{} {error}", file.display())]
    Load {
        /// The file of the shard.
        file: PathBuf,
        /// The error of loading it, which the message repeats.
        error: LoadError,
    },
    /// The file of a shard has the right length, but the manifest states another checksum, another number of
    /// primitives or another box.
    #[error("{} is not the shard that the manifest describes: {reason}", file.display())]
    OtherShard {
        /// The file of the shard.
        file: PathBuf,
        /// What differs, as a clause for the message.
        reason: &'static str,
    },
    /// The threads that load a shard cannot be started.
    #[error("the threads that load a shard cannot be started: {reason}")]
    Threads {
        /// The message of the operating system.
        reason: String,
    },
    /// The answers do not fit into memory.
    #[error("the answers do not fit into memory: {0}")]
    Memory(#[from] std::collections::TryReserveError),
    /// The file of a scene cannot be read.
    #[error(transparent)]
    Scene(#[from] ReadError),
    /// The index of a shard cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The backend of the shards has no saved form.
    #[error("the backend {backend} has no saved form")]
    NotSaveable {
        /// The name of the backend.
        backend: String,
    },
    /// The backend of the shards casts no rays.
    #[error("the backend {backend} of the shards casts no rays")]
    NoRays {
        /// The name of the backend.
        backend: String,
    },
    /// A scene with segments or points has no inside.
    #[error("the scene has segments or points, which have no inside")]
    NoInside,
    /// An open surface has no inside in shards.
    #[error("the surface is open, and shards decide signs only for closed surfaces")]
    Open,
    /// Writing or a batch of queries was cancelled.
    #[error("the work was cancelled")]
    Cancelled,
}

impl ShardError {
    /// Returns a function that makes the error of a file from an error of the operating system.
    pub(crate) fn io(file: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::Io { file: file.into(), error }
    }
}
