//! `p2m advise`: recommends a backend for a scene and its queries.

use crate::answers::queries::{BOX_SCALE, Queries, Region};
use crate::io::input::{PointArgs, SceneArgs, read_finite_points};
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::io::threads::ThreadArgs;
use crate::io::usage::{count, positive};
use crate::scene::smallest_build::SmallestBuild;
use anyhow::Context;
use clap::ArgGroup;
use p2m_backends::{Choice, Estimate, QueryRegion, Workload};
use p2m_core::PrimitiveSet;
use p2m_mixed::statistics::figure::Count;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::sync::Arc;

const HELP: &str = "\
It is the choice of --backend auto: a tree of boxes is built, the work of some queries in it is counted, and the times \
of all backends follow from these counts and from constants. No time is measured, so the advice is the same in every \
run. Times are for batches on one thread, on the processor of the constants. Backends whose times differ by less than \
15 % are about equal.

Examples:
  p2m advise bunny.obj
  p2m advise bunny.obj --queries 1e7 --near
  p2m advise scene.ply --queries 100_000 --points scan.xyz --memory 500 --json";

/// Recommend a backend for a scene and a number of queries
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("regions").args(["near", "within", "points"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// The number of queries
    #[arg(long, value_name = "N", default_value = "1e6", value_parser = count, allow_negative_numbers = true)]
    queries: u64,

    /// Queries are near the surface, about 1 % of the diagonal away
    #[arg(long)]
    near: bool,

    /// Queries are uniform in the box of the scene, as without this option
    #[arg(long = "box", id = "within")]
    within: bool,

    #[command(flatten)]
    points: PointArgs,

    /// The largest memory of the index, in megabytes. The tree of boxes may exceed it
    #[arg(long, value_name = "MB", value_parser = positive, allow_negative_numbers = true)]
    memory: Option<f64>,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let scene = args.scene.read(&session, format)?.scene;
    let points = read_finite_points(streams, &args.points)?;
    // These are the points by which `query` chooses.
    let sample = match &points {
        Some(points) => Queries::sample_of(points),
        None => Queries::sample(Region::around(&scene.soup.aabb(), BOX_SCALE)),
    };
    let (region, place) = match &points {
        Some(_) => (QueryRegion::Like(&sample), "like the points"),
        None if args.near => (QueryRegion::NearSurface, "near the surface"),
        None => (QueryRegion::Like(&sample), "in the box of the scene"),
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let max_bytes = args.memory.map_or(usize::MAX, |memory| (memory * 1e6) as usize);
    let workload = Workload::new(args.queries, region).with_max_bytes(max_bytes);
    let choice = session.pool.install(|| Choice::compare(Arc::clone(&scene.soup), &workload));
    let choice = choice.with_context(|| args.scene.name())?;
    let estimates = choice.estimates();
    let build = SmallestBuild::new(choice.backend(), format);
    if args.json {
        let report = json!({
            "p2m": "advise",
            "version": json::VERSION,
            "scene": { "file": args.scene.name(), "format": format.name() },
            "queries": args.queries,
            "backend": choice.backend().name,
            "resolution": choice.resolution(),
            "estimates": estimates.into_iter().map(estimate_json).collect::<Value>(),
            "features": build.features,
        });
        return json::print(streams, &report);
    }
    let mut text = format!("backend  {}, for {} queries {place}\n", choice.backend(), Count(args.queries));
    let _ = writeln!(text, "build    {build}\n");
    let _ = writeln!(text, "         {:>8} {:>8} {:>8} {:>8}", "build", "a query", "in all", "memory");
    for Estimate { backend, build_seconds, query_seconds, total_seconds, bytes, reason, .. } in estimates {
        let [build, query, total] = [build_seconds, query_seconds, total_seconds].map(|time| two_digits(*time, &TIMES));
        let memory = two_digits(*bytes, &MEMORY);
        let _ = writeln!(text, "{:<8} {build:>8} {query:>8} {total:>8} {memory:>8}  {reason}", backend.name);
    }
    Output::print(streams, text)
}

fn estimate_json(estimate: &Estimate) -> Value {
    json!({
        "backend": estimate.backend.name,
        "build": json::number(estimate.build_seconds),
        "query": json::number(estimate.query_seconds),
        "total": json::number(estimate.total_seconds),
        "bytes": json::number(estimate.bytes.round()),
        "about_equal": estimate.is_about_best,
        "break_even": estimate.break_even.map(|n| json::number(n.ceil())),
        "reason": estimate.reason,
    })
}

/// Units, each with its size, the smallest one first.
type Units = [(f64, &'static str); 6];
const TIMES: Units = [(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s"), (60.0, "min"), (3600.0, "h")];
const MEMORY: Units = [(1.0, "B"), (1e3, "kB"), (1e6, "MB"), (1e9, "GB"), (1e12, "TB"), (1e15, "PB")];

/// Formats an amount with two digits in the largest unit that it has at least one of.
fn two_digits(amount: f64, units: &Units) -> String {
    let digit = 10f64.powf(amount.max(units[0].0).log10().floor() - 1.0);
    let amount = (amount / digit).round() * digit;
    let (size, unit) = units.iter().rfind(|(size, _)| amount >= size * (1.0 - 1e-9)).unwrap_or(&units[0]);
    let amount = amount / size;
    let text = if amount < 9.95 { format!("{amount:.1}") } else { format!("{amount:.0}") };
    format!("{} {unit}", text.trim_end_matches(".0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_have_two_digits() {
        let times = [0.0, 1.04e-9, 34.6e-9, 994e-9, 996e-9, 1.25e-3, 0.37, 59.7, 61.0, 3.5e5];
        let found = times.map(|time| two_digits(time, &TIMES));
        assert_eq!(found, ["0 ns", "1 ns", "35 ns", "990 ns", "1 µs", "1.3 ms", "370 ms", "1 min", "1 min", "97 h"]);
        assert_eq!(
            [0.0, 65.0, 6499.0, 2.65e8].map(|bytes| two_digits(bytes, &MEMORY)),
            ["0 B", "65 B", "6.5 kB", "270 MB"]
        );
    }
}
