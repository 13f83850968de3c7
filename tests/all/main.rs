//! The tests that hold backends against each other and against the oracle, as one program: what they have in common is
//! compiled once. `cargo test --test all signs::` runs those of one module.
//!
//! Programs of their own beside it are `soak`, which needs an allocator of its own, and `examples`, which runs other
//! programs.

mod adversaries;
mod agreement;
mod boxes;
mod consistency;
mod contract;
mod determinism;
mod fields;
mod fuzzed;
mod kdop;
mod models;
mod near;
mod octree;
mod p2m;
mod packets;
mod paper_route;
mod pruning;
mod ray_counters;
mod ray_models;
mod rays;
mod saved;
mod signs;
mod trade;
