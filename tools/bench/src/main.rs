//! `p2m-bench` measures the speed, memory and agreement of p2m's backends and of other libraries.
//!
//! `p2m-bench query` builds every backend over a scene and lets them answer sets of queries in turns, in one process,
//! on one thread, one call at a time. `p2m-bench verify` compares our exact backends with brute force, bit for bit.
//! [`arguments`] declares the command line and [`commands`] runs it; each other module is one command or a part that
//! several of them use.
//!
//! The default build is portable. Figures of libraries that need compile-time target features come from `RUSTFLAGS="-C
//! target-cpu=native" cargo run --release -p p2m-bench -- query ...`. The line above the tables, and the column `label`
//! of a record, say which build it was.
#![forbid(unsafe_code)]

mod agree;
mod arguments;
mod backend;
mod backends;
mod blocks;
mod bvh_crate;
mod commands;
mod external;
mod extremes;
mod field;
mod instances;
mod kinds;
mod measure;
mod memory;
mod our_indexes;
mod pairs;
mod point_trees;
mod rays;
mod report;
mod rounds;
mod scale;
mod scene;
mod shards;
mod threads;
mod verify;

use clap::Parser as _;
use p2m_cli::harness::queries;
use std::process::ExitCode;

fn main() -> anyhow::Result<ExitCode> {
    let is_good = commands::run(arguments::Cli::parse().command)?;
    Ok(if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    #[test]
    fn documents_have_the_blocks_of_their_commands() {
        let document = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
        crate::extremes::BLOCKS.check(Some(&document("extremes.md"))).unwrap();
        crate::extremes::pairs::BLOCKS.check(Some(&document("extremes.md"))).unwrap();
        crate::scale::BLOCKS.check(Some(&document("scale.md"))).unwrap();
    }
}
