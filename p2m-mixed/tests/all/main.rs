//! Tests of readers, writers and generators in one program, whose allocator counts bytes for each thread.

mod blocks;
mod common;
mod generator;
mod generator_kinds;
mod generator_modifiers;
mod generator_support;
mod memory;
mod models;
mod npy;
mod obj;
mod off;
mod pieces;
mod ply;
mod polygons;
mod rays;
mod robustness;
mod statistics;
mod stl;
mod write;
