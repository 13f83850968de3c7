//! Reports for programs.
//!
//! Each is one object on the standard output, with `"p2m"` naming its kind and `"version"` its version. Within a
//! version keys are added, never removed, renamed or given another meaning. Numbers are numbers; what is not finite, or
//! does not exist, is null.

use crate::streams::Streams;
use anyhow::Context;
use p2m_mixed::statistics::Counts;
use p2m_mixed::{Scene, Skipped};
use serde_json::{Value, json};
use std::io::{self, Write};

/// The version of all reports.
pub(crate) const VERSION: u32 = 1;

/// What `--json` says about itself, for the help of each command.
pub(crate) const STABILITY: &str = "\
Reports of --json are one object. Its key \"p2m\" names the kind of the report and \"version\" its version, now 1: within a \
version keys are added, but not removed, renamed or given another meaning. Lengths are in the unit of the scene, times in \
seconds; what does not exist is null, and so is what is infinite, like the end of a range without one.";

/// Writes a report to the standard output.
pub(crate) fn print(streams: &Streams, report: &Value) -> anyhow::Result<()> {
    let write = || -> io::Result<()> {
        let mut output = streams.stdout();
        serde_json::to_writer_pretty(&mut output, report)?;
        writeln!(output)?;
        output.flush()
    };
    write().context("the standard output: cannot be written")
}

/// One object of several.
pub(crate) fn joined<const N: usize>(parts: [Value; N]) -> Value {
    let mut all = serde_json::Map::new();
    for part in parts {
        if let Value::Object(part) = part {
            all.extend(part);
        }
    }
    Value::Object(all)
}

/// A number, or null if it is not finite.
pub(crate) fn number(x: f64) -> Value {
    // That is what serde_json does; stated here because reports rely on it.
    if x.is_finite() { json!(x) } else { Value::Null }
}

pub(crate) fn counts(counts: &Counts) -> Value {
    json!({ "triangles": counts.triangles, "segments": counts.segments, "points": counts.points })
}

pub(crate) fn skipped(scene: &Scene) -> Value {
    let one = |s: &Skipped| json!({ "what": s.what, "count": s.count });
    scene.skipped.iter().map(one).collect()
}
