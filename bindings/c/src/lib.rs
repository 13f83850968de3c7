//! The C interface of p2m. cbindgen makes its header `include/p2m.h` from the comments in this crate (`cargo xtask c
//! --build`).
//!
//! Every function checks its arguments, catches panics, and returns a status; each thread keeps the message of its last
//! failure. Pointers are checked for null and alignment, but not for the memory that counts and strides claim.
#![allow(unsafe_code, reason = "pointers of C")]
#![allow(unreachable_pub, reason = "functions of C are exported by their names")]
#![allow(clippy::missing_safety_doc, reason = "the header says what pointers have to point to")]

mod arrays;
#[cfg(not(target_family = "wasm"))]
mod files;
mod index;
mod pairs;
mod queries;
mod rays;
mod scene;
mod signs;
mod status;
mod threads;
#[cfg(target_family = "wasm")]
#[path = "../../js/src/exports.rs"]
mod web;
