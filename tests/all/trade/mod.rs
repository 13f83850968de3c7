//! Speed against accuracy: what answers promise that are less than exact, and those that are more.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "mixed"))]

mod approximation;
mod certified;
