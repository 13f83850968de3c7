//! `p2m-bench query`: measures backends beside other libraries. A table shows how the answers of other libraries
//! differ.

use crate::command::{Common, Rounds, all_good, at_least_one, backend_names};
use crate::{backends, measure, report};
use anyhow::Result;
use clap::Args;

#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Backends
    #[arg(long, value_delimiter = ',', default_value = backends::DEFAULT, value_parser = backend_names())]
    backends: Vec<String>,
    #[command(flatten)]
    rounds: Rounds,
    /// Queries in a round; backends slower than 20 us per query get at most 20,000, brute force as many as take a
    /// second
    #[arg(long, default_value_t = 200_000)]
    queries: usize,
    /// Number of times that each index is built
    #[arg(long, default_value_t = 5, value_parser = at_least_one())]
    builds: usize,
}

/// Measures backends, and returns whether ours agree.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Arguments { common, backends, rounds, queries, builds } = arguments;
    let selected = common.select(|b| backends.iter().any(|name| name == b.name));
    all_good(&common.scenes, &rounds.describe("One thread, thread CPU time", *queries, "queries"), |scene| {
        let mut entries = measure::build_all(&scene, &selected, *builds);
        for set in &common.sets {
            measure::measure(
                set.generate(&scene.double, *queries, rounds.seed),
                &mut entries,
                rounds.rounds,
                measure::affordable,
            );
        }
        report::print_scene(&scene, &common.sets, &entries);
        Ok(report::is_clean(&entries))
    })
}
