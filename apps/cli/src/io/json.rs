//! Reports for programs.
//!
//! Each report is one object on the standard output. Its key `"p2m"` names its kind, and `"version"` its version.
//! Within a version keys are added, never removed, renamed or given another meaning. Values that do not exist or are
//! not finite are null.

use crate::answers::RunningStats;
use crate::io::streams::Streams;
use anyhow::Context;
use p2m_mixed::Skipped;
use p2m_mixed::statistics::Counts;
use serde_json::{Value, json};
use std::io::{self, Write};

/// The version of all reports.
pub(crate) const VERSION: u32 = 4;

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

/// Writes the report of a command, which is one object of several parts, to the standard output.
pub(crate) fn print_report<const N: usize>(streams: &Streams, command: &str, parts: [Value; N]) -> anyhow::Result<()> {
    print(streams, &joined([json!({ "p2m": command, "version": VERSION }), joined(parts)]))
}

/// Merges several objects into one.
pub(crate) fn joined<const N: usize>(parts: [Value; N]) -> Value {
    let mut all = serde_json::Map::new();
    for part in parts {
        if let Value::Object(part) = part {
            all.extend(part);
        }
    }
    Value::Object(all)
}

/// Converts a number to JSON; to null if it is not finite.
pub(crate) fn number(x: f64) -> Value {
    // serde_json writes null as well. The condition stands here because reports rely on it.
    if x.is_finite() { json!(x) } else { Value::Null }
}

/// Converts the numbers of primitives of each kind.
pub(crate) fn counts(counts: &Counts) -> Value {
    json!({ "triangles": counts.triangles, "segments": counts.segments, "points": counts.points })
}

/// Converts least, greatest and mean number; to null if there are no numbers.
pub(crate) fn stats(stats: &RunningStats) -> Value {
    if stats.count == 0 {
        return Value::Null;
    }
    json!({ "min": number(stats.min), "max": number(stats.max), "mean": number(stats.mean()) })
}

/// Lists the records of a file that were skipped.
pub(crate) fn skipped(skipped: &[Skipped]) -> Value {
    let one = |s: &Skipped| json!({ "kind": s.what, "count": s.count });
    skipped.iter().map(one).collect()
}
