//! Files, terminals, and the words of the command line. What most commands need is named here as well.

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

pub(crate) use input::{PointArgs, SceneArgs, SceneFile, is_standard, shown};
pub(crate) use output::Output;
pub(crate) use progress::{Progress, Unit};
pub(crate) use streams::Streams;
pub(crate) use threads::{Session, ThreadArgs};
pub(crate) use usage::usage;
