//! Compares rays with exact rational arithmetic: every backend with every instruction set, every function, and ranges
//! that begin and end at hits.
#![cfg(all(feature = "bvh", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

mod backends;
mod lattice;
mod primitives;
mod ranges;
mod scenes;
