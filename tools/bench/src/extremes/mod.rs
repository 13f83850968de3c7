//! `p2m-bench extremes`: checks the accuracy contract on inputs where other libraries fail, for the tables of
//! docs/measurements/extremes.md.

mod counts;
mod examples;
mod external;
mod pairs;
mod primitives;

use crate::blocks::Blocks;
use crate::command::{Document, provenance};
use anyhow::Result;
use clap::Args;
use external::LIBRARIES;
use p2m_cli::harness::Table;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// The blocks of docs/measurements/extremes.md.
pub(crate) const BLOCKS: Blocks<5> =
    Blocks { command: "extremes", names: ["provenance", "checks", "primitives", "pairs", "examples"] };

#[derive(Args)]
pub(crate) struct Arguments {
    /// Answers about isolated primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    cases: u64,
    /// Pairs of primitives that are checked
    #[arg(long, default_value_t = 100_000)]
    pairs: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    document: Document,
}

/// Checks everything and publishes the blocks. Returns whether our backends broke no promise.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let (document, seed) = (arguments.document.write.as_deref(), arguments.seed);
    BLOCKS.check(document)?;
    let start = Instant::now();
    let (found, pairs, examples) = without_messages(|| {
        (primitives::run(arguments.cases, seed), pairs::run(arguments.pairs, seed), examples::list())
    });
    BLOCKS.publish(document, &[provenance().to_string(), checks(&found), table(&found), pairs.text(), examples])?;
    found.broken.shown.iter().for_each(|what| eprintln!("BROKEN {what}"));
    println!(
        "{} answers of ours compared with the true distance, {} more with each other in {:.0?}, {} promises broken.",
        found.checked.iter().sum::<u64>(),
        found.invariant,
        start.elapsed(),
        found.broken.count
    );
    Ok(found.broken.count == 0 && pairs.ours_are_within_their_bound())
}

/// Runs checks without printing panics. Panics of external libraries are caught and counted, and a message for each
/// would bury the report.
fn without_messages<V>(check: impl FnOnce() -> V) -> V {
    let default_hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let found = check();
    std::panic::set_hook(default_hook);
    found
}

/// Runs jobs on all threads, adds up their results, and prints a line after every twentieth job.
fn on_all_threads<F: Default + Send>(
    what: &str,
    jobs: u64,
    check: impl Fn(u64, &mut F) + Sync,
    merge: impl Fn(&mut F, F) + Sync,
) -> F {
    let done = AtomicU64::new(0);
    let checked = |mut found: F, job: u64| {
        check(job, &mut found);
        let count = done.fetch_add(1, Ordering::Relaxed);
        let part = |count: u64| count * 20 / jobs;
        if part(count + 1) > part(count) {
            eprintln!("{} % of all {what}", part(count + 1) * 5);
        }
        found
    };
    let merged = |mut all: F, other: F| {
        merge(&mut all, other);
        all
    };
    (0..jobs).into_par_iter().fold(F::default, checked).reduce(F::default, merged)
}

/// Formats the numbers of checks.
fn checks(found: &primitives::Findings) -> String {
    let mut table = Table::new(["", "answers", "promises broken"]);
    let [double, single] = found.checked;
    for (what, count, is_first) in [
        ("isolated primitives in f64 against the truth: N1, N5, N6, N7", double, true),
        ("isolated primitives in f32 against the truth: N1, N5, N6, N7", single, true),
        ("the same against those of another order or scale: N4", found.invariant, false),
        ("of these, by rational arithmetic", found.rational, false),
    ] {
        let broken = if is_first { found.broken.count.to_string() } else { "counted above".to_owned() };
        table.push(vec![what.to_owned(), count.to_string(), broken]);
    }
    table.to_string()
}

/// Formats the errors of isolated primitives.
fn table(found: &primitives::Findings) -> String {
    let mut table = Table::new(["", "p2m f64", "p2m f32"].into_iter().chain(LIBRARIES.iter().map(|r| r.name)));
    for (row, counts) in primitives::ROWS.iter().zip(&found.rows) {
        table.push(std::iter::once(row.label.clone()).chain(counts.iter().map(counts::Counts::cell)).collect());
    }
    table.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_break_nothing_over_single_primitives() {
        let cases = p2m_testkit::amount(30_000, 3_000);
        let found = primitives::run(cases, 7);
        assert!(found.checked.iter().all(|count| *count >= cases / 2), "{:?}", found.checked);
        assert!(found.invariant > cases * 2 / 3, "{}", found.invariant);
        assert_eq!(found.broken.count, 0, "{:?}", found.broken.shown);
    }
}
