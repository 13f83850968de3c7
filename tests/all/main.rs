//! The tests that compare backends with each other and with the oracle. They are one program, so that shared code is
//! compiled once. `cargo test --test all pairs::` runs the tests of one module.
//!
//! Three test programs are separate: `soak` needs its own allocator, `instructions` runs itself under valgrind, and
//! `examples` runs other programs.

mod adversaries;
mod agreement;
mod batches;
mod consistency;
mod contract;
mod crafted_files;
mod determinism;
mod equal_primitives;
mod fuzzed;
mod models;
mod moving_balls;
mod near;
mod ownership;
mod pairs;
mod ray_collectors;
mod ray_counters;
mod ray_models;
mod rays;
mod registry;
mod saved;
mod serde_values;
mod thin_pairs;
mod trade;
