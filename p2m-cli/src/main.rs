//! The command line of p2m: reads a scene, asks for closest points, writes a table.

#![forbid(unsafe_code)]

mod boxes;
mod generate;
mod output;
mod query;
mod sampling;
mod summary;

use clap::{Parser, Subcommand};
use std::io::{self, Write};
use std::process::ExitCode;

/// Closest points of scenes of triangles, segments and points
#[derive(Parser)]
#[command(name = "p2m", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Example:
  p2m query scene.obj --random 1000 --out answers.csv

The exit code is 0 for success, 1 for what could not be read, written or done, and 2 for wrong usage.";

#[derive(Subcommand)]
enum Command {
    Query(query::Args),
    Generate(generate::Args),
    Boxes(boxes::Args),
}

fn main() -> ExitCode {
    // Wrong usage ends here, with code 2.
    let result = match Cli::parse().command {
        Command::Query(args) => query::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Boxes(args) => boxes::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever reads our output has seen enough, like `head`.
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // If even this cannot be written there is nobody to tell.
            let _ = writeln!(io::stderr(), "error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|e| e.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe))
}
