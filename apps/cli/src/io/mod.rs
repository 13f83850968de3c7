//! Files, terminals, and the words of the command line.

pub(crate) mod input;
pub(crate) mod interrupt;
pub(crate) mod json;
pub(crate) mod limits;
pub(crate) mod output;
pub(crate) mod progress;
pub(crate) mod read_pipeline;
pub(crate) mod streams;
pub(crate) mod threads;
pub(crate) mod usage;
pub(crate) mod zstd;
