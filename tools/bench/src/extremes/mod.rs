//! `p2m-bench extremes`: checks the accuracy contract on inputs where other libraries fail, for the tables of
//! docs/measurements/extremes.md.

mod counts;
mod examples;
mod external;
pub(crate) mod pairs;
mod primitives;
mod scenes;
mod threads;

use crate::blocks::Blocks;
use crate::command::{Document, provenance};
use anyhow::Result;
use clap::Args;
use external::LIBRARIES;
use p2m_cli::harness::Table;
use p2m_testkit::extremes::Extreme;
use std::time::Instant;

/// The blocks of docs/measurements/extremes.md.
pub(crate) const BLOCKS: Blocks<5> =
    Blocks { command: "extremes", names: ["provenance", "checks", "primitives", "scenes", "examples"] };

#[derive(Args)]
pub(crate) struct Arguments {
    /// Answers about isolated primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    cases: u64,
    /// Scenes of each family, which every backend queries
    #[arg(long, default_value_t = 4)]
    scenes: u64,
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
    let (alone, together, examples) = without_messages(|| {
        (primitives::run(arguments.cases, seed), scenes::run(arguments.scenes, seed), examples::list())
    });
    let [checks, primitives] = [checks(&alone, &together), of_primitives(&alone)];
    BLOCKS.publish(document, &[provenance().to_string(), checks, primitives, of_scenes(&together), examples])?;
    alone.shown.iter().chain(&together.shown).for_each(|what| eprintln!("BROKEN {what}"));
    let broken = alone.broken + together.broken;
    println!(
        "{} answers of ours compared with the true distance, {} more with each other in {:.0?}, {broken} promises broken.",
        alone.checked.iter().sum::<u64>() + together.queries,
        alone.invariant + together.checked,
        start.elapsed()
    );
    Ok(broken == 0)
}

/// Runs checks without messages of panics. Those of external libraries are caught and counted, and a message for each
/// would bury the report.
fn without_messages<V>(check: impl FnOnce() -> V) -> V {
    let default_hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let found = check();
    std::panic::set_hook(default_hook);
    found
}

/// Formats the numbers of checks.
fn checks(alone: &primitives::Findings, together: &scenes::Findings) -> String {
    let mut table = Table::new(["", "answers", "promises broken"]);
    let [double, single] = alone.checked;
    for (what, count, broken) in [
        ("isolated primitives in f64 against the truth: N1, N5, N6, N7", double, Some(alone.broken)),
        ("isolated primitives in f32 against the truth: N1, N5, N6, N7", single, Some(alone.broken)),
        ("the same against those of another order or scale: N4", alone.invariant, None),
        ("of these, by rational arithmetic", alone.rational, None),
        (
            "scenes, brute force against the truth of every primitive: N1, N2, N6, N7",
            together.queries,
            Some(together.broken),
        ),
        ("scenes, every backend against brute force: N3, N6", together.checked, None),
        ("primitives of scenes, by rational arithmetic", together.rational, None),
    ] {
        let broken = broken.map_or_else(|| "counted above".to_owned(), |broken| broken.to_string());
        table.push(vec![what.to_owned(), count.to_string(), broken]);
    }
    table.to_string()
}

/// Formats the errors of isolated primitives.
fn of_primitives(alone: &primitives::Findings) -> String {
    let mut table = Table::new(["", "p2m f64", "p2m f32"].into_iter().chain(LIBRARIES.iter().map(|r| r.name)));
    for (label, counts) in &alone.rows {
        table.push(std::iter::once(label.clone()).chain(counts.iter().map(counts::Counts::cell)).collect());
    }
    table.to_string()
}

/// Formats the errors in scenes, the names of our backends, and the reasons why others were left out.
fn of_scenes(together: &scenes::Findings) -> String {
    let subjects = scenes::subjects();
    let shown = ["aabb", "aabb-f32", "parry3d-f64", "parry3d", "bvh"];
    let columns: Vec<usize> =
        shown.iter().filter_map(|name| subjects.iter().position(|subject| subject.name == *name)).collect();
    let mut table = Table::new(["", "ours f64", "ours f32", "parry3d-f64", "parry3d", "bvh", "cells: octree, p2m"]);
    for ((family, counts), [scenes, octree, p2m]) in Extreme::ALL.iter().zip(&together.rows).zip(&together.cells) {
        let part = |count: &u64| format!("{} %", count * 100 / scenes.max(&1));
        let cells = columns.iter().map(|column| counts[*column].cell()).chain([part(octree) + ", " + &part(p2m)]);
        table.push(std::iter::once(family.name().to_owned()).chain(cells).collect());
    }
    let ours: Vec<&str> = subjects.iter().filter(|subject| subject.is_ours).map(|subject| subject.name).collect();
    let absent = together.absent.iter().map(|(why, count)| format!("- Left out of {count} scenes: {why}.\n"));
    let ours: Vec<String> = ours.chunks(10).map(|names| names.join(", ")).collect();
    format!("{table}\nOurs: {}.\n\n{}", ours.join(",\n"), absent.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_break_nothing_over_single_primitives() {
        let cases = p2m_testkit::amount(30_000, 3_000);
        let alone = primitives::run(cases, 7);
        assert!(alone.checked.iter().all(|count| *count >= cases / 2), "{:?}", alone.checked);
        assert!(alone.invariant > cases * 2 / 3, "{}", alone.invariant);
        assert_eq!(alone.broken, 0, "{:?}", alone.shown);
    }

    #[test]
    #[ignore = "deep: every index is built over scenes of every extreme"]
    fn ours_break_nothing_over_scenes() {
        let together = scenes::run(1, 7);
        assert!(together.checked > 1000, "{}", together.checked);
        assert_eq!(together.broken, 0, "{:?}", together.shown);
    }
}
