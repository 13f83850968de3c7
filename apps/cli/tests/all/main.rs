//! Tests of the output, the files and the exit codes of `p2m`. `cargo test -p p2m-cli --test all query::` runs the
//! tests of one command.

mod advise;
mod align;
mod boxes;
mod build;
mod common;
mod convert;
mod deviation;
mod distance;
mod field;
mod files;
mod generate;
mod hausdorff;
mod info;
mod interrupt;
mod json;
mod limits;
mod program;
mod query;
mod query_options;
mod ray;
mod sample;
mod shard;
mod shell;
mod stats;
mod terminal;
mod tradeoff;
mod transcript;
mod usage;
mod view;
