//! Checks the promises of answers that are less accurate than exact ones, and of those that are certified.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

mod approximation;
mod certified;
