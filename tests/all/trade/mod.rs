//! Checks the promises of approximate answers and of certified answers.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

mod approximation;
mod certified;
