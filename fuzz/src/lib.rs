//! What fuzz targets check, each as a function of the bytes of an input; `tests/all/fuzzed.rs` of the workspace gives them the
//! seeds and what once failed.
//!
//! - [`readers`]: files of scenes and points.
//! - [`queries`], [`rays`]: scenes and questions are made from the bytes, answers held against brute force and against
//!   rational arithmetic.
//! - [`saved`]: files of saved indexes, damaged or made up.

mod answers;
mod approximation;
pub mod backends;
mod boxes;
mod bytes;
mod exactness;
mod memory;
pub mod queries;
pub mod rays;
pub mod readers;
pub mod saved;
pub mod scene;

pub use answers::QUESTIONS;
