//! `p2m-bench verify`: compares all our exact backends with brute force, bit for bit.

use crate::command::{Common, all_good, backend_names};
use crate::{measure, report};
use anyhow::Result;
use clap::Args;

#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Backends [default: all exact ones of ours]
    #[arg(long, value_delimiter = ',', value_parser = backend_names())]
    backends: Vec<String>,
    /// Queries of each set
    #[arg(long, default_value_t = 5000)]
    queries: usize,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Compares our exact backends with brute force, and returns whether all answers are equal.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Arguments { common, backends, queries, seed } = arguments;
    let is_named = |name: &str| backends.is_empty() || backends.iter().any(|backend| backend == name);
    let selected = common.select(|b| b.is_ours && (b.is_exhaustive || is_named(b.name)));
    let about = format!("{queries} queries of each set, seed {seed}.");
    let is_equal = all_good(&common.scenes, &about, |scene| {
        let mut entries = measure::build_all(&scene, &selected, 1);
        for set in &common.sets {
            // Brute force answers all queries, however long it takes.
            measure::measure(set.generate(&scene.double, *queries, *seed), &mut entries, 1, |_| usize::MAX);
        }
        println!("\n## {}\n", scene.describe());
        report::print_agreement(&scene, &common.sets, &entries);
        Ok(report::is_clean(&entries))
    })?;
    println!("\n{}", if is_equal { "All equal." } else { "DIFFERENCES, see above." });
    Ok(is_equal)
}
