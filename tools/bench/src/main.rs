//! `p2m-bench` measures the speed, memory and agreement of p2m's backends and of other libraries.
//!
//! `p2m-bench query` builds every backend over a scene and lets them answer sets of queries in turns, in one process,
//! on one thread, one call at a time. `p2m-bench verify` compares our exact backends with brute force, bit for bit.
//! Each command is a module with its arguments and a function `run`, which returns whether the command found no fault.
//! [`command`] has the parts that commands share, and the other modules are used by several commands.
//!
//! The default build is portable. Figures of libraries that need compile-time target features come from `RUSTFLAGS="-C
//! target-cpu=native" cargo run --release -p p2m-bench -- query ...`. The line above the tables describes the build.
#![forbid(unsafe_code)]

mod agree;
mod auto;
mod backend;
mod backends;
mod blocks;
mod bvh_crate;
mod command;
mod contest;
mod extremes;
mod field;
mod instances;
mod measure;
mod memory;
mod our_indexes;
mod pairs;
mod parry;
mod point_trees;
mod query;
mod rays;
mod report;
mod rounds;
mod scale;
mod scene;
mod shards;
mod tables;
mod verify;

use clap::{Parser, Subcommand};
use p2m_cli::harness::queries;
use std::process::ExitCode;

/// Measures p2m and other libraries.
#[derive(Parser)]
#[command(after_help = "\
The default release build is portable. For the native rows of other libraries:\n  \
RUSTFLAGS=\"-C target-cpu=native\" cargo run --release -p p2m-bench -- query ...\n\
Times are thread CPU times; pin the process as well: taskset -c 1 p2m-bench query ...")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build time, memory, time per query and agreement of all backends
    Query(query::Arguments),
    /// Measures all scenes, indexes and sets of queries of the documents into one file; fails if ours differ
    Tables(tables::Arguments),
    /// Compares our exact backends with brute force, bit for bit, in f64 and f32; fails on any difference
    Verify(verify::Arguments),
    /// Times the first hits of rays against parry3d; fails if ours differ
    Ray(rays::Arguments),
    /// Checks the accuracy contract where other libraries fail (docs/measurements/extremes.md); fails if ours break it
    Extremes(extremes::Arguments),
    /// Times distance fields on a grid, against parry3d; fails if ours differ
    Field(field::Arguments),
    /// Compares the choice of `auto` with the best index for each job; fails if too many choices are bad
    Auto(auto::Arguments),
    /// Compares a scene of moving instances of meshes with one index over all of them; fails if an answer differs
    Instances(instances::Arguments),
    /// Measures builds, memory and queries of scenes that grow, for docs/measurements/scale.md; fails if ours differ
    Scale(scale::Arguments),
    /// Times distances between two scenes at many poses, and between a scene and an arm of capsules, against parry3d
    Pairs(pairs::Arguments),
    /// Writes a generated terrain as shards and asks them within a limit of memory; fails if an answer differs
    Shards(shards::Arguments),
}

fn main() -> anyhow::Result<ExitCode> {
    let is_good = match Cli::parse().command {
        Command::Query(arguments) => query::run(&arguments),
        Command::Tables(arguments) => tables::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Ray(arguments) => rays::run(&arguments),
        Command::Extremes(arguments) => extremes::run(&arguments),
        Command::Field(arguments) => field::run(&arguments),
        Command::Auto(arguments) => auto::run(&arguments),
        Command::Instances(arguments) => instances::run(&arguments),
        Command::Scale(arguments) => scale::run(&arguments),
        Command::Pairs(arguments) => pairs::run(&arguments),
        Command::Shards(arguments) => shards::run(&arguments),
    }?;
    Ok(if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;
    use std::path::Path;

    #[test]
    fn the_command_line_is_consistent() {
        crate::Cli::command().debug_assert();
    }

    #[test]
    fn documents_have_the_blocks_of_their_commands() {
        let document = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
        crate::extremes::BLOCKS.check(Some(&document("measurements/extremes.md"))).unwrap();
        crate::scale::BLOCKS.check(Some(&document("measurements/scale.md"))).unwrap();
    }
}
