//! The module that answers queries within a page: `cargo xtask wasm --build` makes `apps/page/assets/live.wasm` of it.
//!
//! A [`Live`] has a scene, an index of each backend, and the answer to the last query. The script of the page calls the
//! functions of [`abi`], which need no glue code: arguments and results are numbers, and arrays are read and written in
//! the memory of the module.
#![deny(unsafe_code)]

pub mod abi;
mod far;
mod ordinary;
mod scene;

pub use far::{FarAnswer, FarScene, OFFSET};
pub use scene::{Answer, Live, MAX_VERTEX_CELL_PRIMITIVES, backend};
