//! Readers, writers, generators and adapters, as one program; beside it those that count allocations (`memory`, `robustness`).

mod adapters;
mod answers;
#[path = "../common/mod.rs"]
mod common;
mod generator;
mod generator_kinds;
mod generator_modifiers;
mod generator_support;
mod models;
mod npy;
mod obj;
mod off;
mod picture;
mod ply;
mod polygons;
mod rays;
mod statistics;
mod stl;
mod write;
