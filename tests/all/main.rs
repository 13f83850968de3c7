//! The tests that compare backends with each other and with the oracle, in one program so that shared code is compiled
//! once. `cargo test --test all signs::` runs those of one module.
//!
//! Two test programs are separate: `soak` needs its own allocator, and `examples` runs other programs.

mod adversaries;
mod agreement;
mod batches;
mod boxes;
mod consistency;
mod contract;
mod crafted_files;
mod determinism;
mod fields;
mod fuzzed;
mod hausdorff;
mod kdop;
mod models;
mod moving_balls;
mod near;
mod octree;
mod ownership;
mod p2m;
mod packets;
mod pairs;
mod pruning;
mod ray_collectors;
mod ray_counters;
mod ray_models;
mod rays;
mod registry;
mod saved;
mod signs;
mod trade;
