//! The checks of the fuzz targets, as functions of the bytes of an input. `tests/all/fuzzed.rs` of the workspace runs
//! them on the seeds and on inputs that once failed.
//!
//! - [`readers`]: files of scenes and points.
//! - [`queries`], [`rays`], [`pairs`]: scenes and questions that are made from the bytes. Answers are compared with
//!   brute force and with rational arithmetic.
//! - [`saved`]: files of saved indexes, damaged or made up.

mod answers;
mod approximation;
pub mod backends;
mod boxes;
mod bytes;
mod exactness;
mod memory;
pub mod pairs;
pub mod queries;
pub mod rays;
pub mod readers;
pub mod saved;
pub mod scene;
pub mod subject;

pub use answers::QUESTIONS;
