//! `p2m advise`: recommends a backend for a scene and its queries.

use crate::io::input::{PointArgs, SceneArgs, read_finite_points, read_scene};
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::io::threads::ThreadArgs;
use crate::io::usage::{not_negative, positive, whole_number};
use anyhow::Context;
use clap::ArgGroup;
use p2m_backends::{Advice, Estimate, QueryRegion, Workload, recommend};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::time::Duration;

const HELP: &str = "\
Each backend is built and queried over a sample of the scene, and its times are scaled to the whole scene. A backend \
is skipped if its build alone would take longer than building and querying the AABB tree, so the advice takes a few \
per cent of the job. Times are estimates for one thread. Where two backends are about equally fast, the advice may \
vary.

Examples:
  p2m advise bunny.obj --queries 10000000 --near
  p2m advise scene.ply --queries 100000 --points scan.xyz --memory 500 --json";

/// Recommend a backend for a scene and a number of queries
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("regions").required(true).args(["near", "within", "points"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// The number of queries
    #[arg(long, value_name = "N", value_parser = whole_number, allow_negative_numbers = true)]
    queries: u64,

    /// Queries are near the surface, about 1 % of the diagonal away
    #[arg(long)]
    near: bool,

    /// Queries are uniform in the box of the scene
    #[arg(long = "box", id = "within")]
    within: bool,

    #[command(flatten)]
    points: PointArgs,

    /// The largest memory of the index, in megabytes
    #[arg(long, value_name = "MB", value_parser = positive, allow_negative_numbers = true)]
    memory: Option<f64>,

    /// The longest time for the advice, in seconds
    #[arg(long, value_name = "S", value_parser = not_negative, allow_negative_numbers = true)]
    time: Option<f64>,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let format = args.scene.format()?;
    let pool = args.threads.pool()?;
    let scene = read_scene(streams, &pool, &args.scene, format)?;
    let points = read_finite_points(streams, &args.points)?;
    let region = match &points {
        Some(points) => QueryRegion::Like(points),
        None if args.near => QueryRegion::NearSurface,
        None => QueryRegion::SceneBox,
    };
    let mut workload = Workload::new(args.queries, region);
    if let Some(memory) = args.memory {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let bytes = (memory * 1e6) as usize;
        workload = workload.with_max_bytes(bytes);
    }
    if let Some(time) = args.time {
        workload = workload.with_max_time(Duration::try_from_secs_f64(time).unwrap_or(Duration::MAX));
    }
    let advice = pool.install(|| recommend(&scene.soup, &workload)).with_context(|| args.scene.name())?;
    if args.json {
        let estimates: Vec<Value> = advice.estimates.iter().map(estimate_json).collect();
        let report = json!({
            "p2m": "advise",
            "version": json::VERSION,
            "scene": { "file": args.scene.name(), "format": format.name() },
            "queries": args.queries,
            "backend": advice.backend().name,
            "estimates": estimates,
            "sample_primitives": advice.sample_primitives,
            "threads": pool.current_num_threads(),
            "seconds": { "advice": advice.seconds },
        });
        return json::print(streams, &report);
    }
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_table(&mut text, &advice);
    Output::print(streams, text)
}

fn estimate_json(estimate: &Estimate) -> Value {
    json!({
        "backend": estimate.backend.name,
        "build": json::number(estimate.build_seconds),
        "query": json::number(estimate.query_seconds),
        "total": json::number(estimate.total_seconds),
        "bytes": json::number(estimate.bytes.round()),
        "measured": estimate.is_measured,
        "break_even": estimate.break_even.map(|n| json::number(n.ceil())),
        "reason": estimate.reason(),
    })
}

fn write_table(text: &mut String, advice: &Advice) -> std::fmt::Result {
    writeln!(text, "backend  {}", advice.backend())?;
    writeln!(text, "         {:>12} {:>12} {:>12} {:>10}", "build", "a query", "in all", "memory")?;
    for estimate in &advice.estimates {
        let Estimate { backend, build_seconds, query_seconds, total_seconds, bytes, is_measured, .. } = estimate;
        let times = [build_seconds, query_seconds, total_seconds];
        let [build, query, total] = times.map(|s| format!("{:.2?}", duration(*s)));
        let memory = format!("{:.1} MB", bytes / 1e6);
        let remark = if *is_measured { "" } else { " (not measured)" };
        writeln!(
            text,
            "{:<8} {build:>12} {query:>12} {total:>12} {memory:>10}  {}{remark}",
            backend.name,
            estimate.reason()
        )?;
    }
    let sample = match advice.sample_primitives {
        0 => "nothing was measured".to_owned(),
        primitives => format!("measured on {primitives} primitives"),
    };
    writeln!(text, "advice   took {:.2?}, {sample}; estimates are for one thread", duration(advice.seconds))
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
}
