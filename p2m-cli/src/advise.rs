//! `p2m advise`: which backend a scene and its queries call for.

use crate::input::{SceneArgs, point_format, read_points, read_scene};
use crate::json;
use crate::output::Output;
use crate::streams::Streams;
use crate::usage::{not_negative, one_of, positive, whole};
use anyhow::Context;
use clap::ArgGroup;
use p2m_advisor::{Advice, Estimate, Place, Workload, recommend};
use p2m_mixed::PointFormat;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

fn help() -> String {
    format!(
        "\
Each backend is built and asked over a part of the scene, and what that takes is scaled to all of it; what takes longer to build than \
the tree of boxes takes for everything is not asked. So advice takes some per cent of the job. Times are estimates, for one thread; where two \
backends are about as good, advice may differ from run to run.

{}

Examples:
  p2m advise bunny.obj --queries 10000000 --near
  p2m advise scene.ply --queries 100000 --points scan.xyz --memory 500 --json",
        json::STABILITY
    )
}

/// Say which backend is fastest for a scene and so many queries, and from how many on others are
#[derive(clap::Args)]
#[command(after_help = help())]
#[command(group = ArgGroup::new("places").required(true).args(["near", "within", "points"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// How many queries
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    queries: u64,

    /// Queries are near the surface, about a hundredth of the diagonal away
    #[arg(long)]
    near: bool,

    /// Queries are anywhere in the box of the scene
    #[arg(long = "box", id = "within")]
    within: bool,

    /// Queries are like the points of this file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,

    /// The format of the points, if the extension of their file does not tell
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, requires = "points")]
    points_format: Option<PointFormat>,

    /// The most megabytes that the index may take
    #[arg(long, value_name = "MB", value_parser = positive, allow_negative_numbers = true)]
    memory: Option<f64>,

    /// The most seconds for advice
    #[arg(long, value_name = "S", value_parser = not_negative, allow_negative_numbers = true)]
    time: Option<f64>,

    /// Report as one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let format = args.scene.format()?;
    let scene = read_scene(streams, &args.scene.path, format)?;
    let points = args
        .points
        .as_ref()
        .map(|path| read_points(streams, path, point_format(path, args.points_format, "--points-format")?));
    let points = points.transpose()?;
    let place = match &points {
        Some(points) => Place::Points(points),
        None if args.near => Place::Near,
        None => Place::Box,
    };
    let mut workload = Workload::new(args.queries, place);
    if let Some(memory) = args.memory {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let bytes = (memory * 1e6) as usize;
        workload = workload.with_memory(bytes);
    }
    if let Some(time) = args.time {
        workload = workload.with_patience(Duration::try_from_secs_f64(time).unwrap_or(Duration::MAX));
    }
    let advice = recommend(&scene.soup, &workload).with_context(|| args.scene.name())?;
    if args.json {
        let estimates: Vec<Value> = advice.estimates.iter().map(estimate).collect();
        let report = json!({
            "p2m": "advise",
            "version": json::VERSION,
            "scene": { "file": args.scene.name(), "format": format.name() },
            "queries": args.queries,
            "backend": advice.choice().name(),
            "estimates": estimates,
            "patch": advice.patch,
            "seconds": { "advice": advice.seconds },
        });
        return json::print(streams, &report);
    }
    let mut text = String::new();
    // Nothing fails in writing to memory.
    let _ = table(&mut text, &advice);
    let mut output = Output::open(streams, None)?;
    output.write_all(text.as_bytes()).with_context(|| output.cannot_write())?;
    output.finish()
}

fn estimate(estimate: &Estimate) -> Value {
    json!({
        "backend": estimate.choice.name(),
        "build": json::number(estimate.build),
        "query": json::number(estimate.query),
        "total": json::number(estimate.total),
        "bytes": json::number(estimate.memory.round()),
        "measured": estimate.is_measured,
        "break_even": estimate.break_even.map(|n| json::number(n.ceil())),
        "reason": estimate.reason(),
    })
}

fn table(text: &mut String, advice: &Advice) -> std::fmt::Result {
    writeln!(text, "backend  {}", advice.choice())?;
    writeln!(text, "         {:>12} {:>12} {:>12} {:>10}", "build", "a query", "in all", "memory")?;
    for estimate in &advice.estimates {
        let Estimate { choice, build, query, total, memory, is_measured, .. } = estimate;
        let [build, query, total] = [build, query, total].map(|s| format!("{:.2?}", duration(*s)));
        let memory = format!("{:.1} MB", memory / 1e6);
        let how = if *is_measured { "" } else { " (not measured)" };
        writeln!(
            text,
            "{:<8} {build:>12} {query:>12} {total:>12} {memory:>10}  {}{how}",
            choice.name(),
            estimate.reason()
        )?;
    }
    let patch = if advice.patch > 0 { format!("asked {} primitives", advice.patch) } else { "asked none".to_owned() };
    writeln!(text, "advice   took {:.2?}, {patch}; estimates are for one thread", duration(advice.seconds))
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
}
