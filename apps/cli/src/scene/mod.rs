//! Commands that read, make and write scenes and index files.

pub(crate) mod build;
pub(crate) mod convert;
pub(crate) mod generate;
pub(crate) mod info;
pub(crate) mod modify;
pub(crate) mod shard;
pub(crate) mod smallest_build;
