//! What a run was about: for people on the standard error, or for programs as JSON.

use crate::backend::About;
use crate::faces::Used;
use crate::info::counted;
use crate::json;
use p2m_core::Closest;
use p2m_mixed::statistics::Counts;
use p2m_mixed::{Format, Scene};
use serde_json::{Value, json};
use std::fmt::{self, Write};
use std::time::Duration;

/// A scene and the index over it.
pub(crate) struct Indexed<'a> {
    pub(crate) scene_name: String,
    pub(crate) scene: &'a Scene,
    pub(crate) format: Format,
    pub(crate) backend: &'static str,
    pub(crate) about: About,
    /// Whether a file had the index.
    pub(crate) loaded: bool,
    pub(crate) read: Duration,
    /// Building or loading.
    pub(crate) build: Duration,
}

impl Indexed<'_> {
    /// The report of a command up to the index, as an object.
    pub(crate) fn json(&self, command: &str) -> Value {
        let (faces, choice) = match &self.about {
            About::Faces(used) => (Some(used.k), used.choice.as_ref()),
            _ => (None, None),
        };
        json!({
            "p2m": command,
            "version": json::VERSION,
            "scene": {
                "file": self.scene_name,
                "format": self.format.name(),
                "primitives": json::counts(&Counts::of(&self.scene.soup)),
                "skipped": json::skipped(self.scene),
            },
            "backend": self.backend,
            "loaded": self.loaded,
            "faces": faces,
            "choice": choice,
        })
    }

    /// What an interception index is made of, for the report.
    pub(crate) fn cells(&self) -> Value {
        match &self.about {
            About::Cubes(report) => json!({
                "lists": report.lists,
                "singles": report.singles,
                "trees": report.trees,
                "bytes": report.bytes,
                "tree_bytes": report.tree_bytes,
                "tests": report.work,
                "resolution": json::number(report.resolution),
            }),
            About::Cells(report) => json!({
                "lists": report.lists,
                "trees": report.trees,
                "packets": report.entries,
                "primitives": report.primitives,
                "bytes": report.bytes,
                "tree_bytes": report.tree_bytes,
            }),
            _ => Value::Null,
        }
    }

    /// Lines about both, with one about what is asked if that is to be noted.
    pub(crate) fn write(&self, text: &mut String, note: Option<String>) -> fmt::Result {
        writeln!(text, "scene    {}", self.scene_name)?;
        writeln!(text, "         {}", counted(&Counts::of(&self.scene.soup)))?;
        if p2m_core::PrimitiveSet::is_empty(&self.scene.soup) {
            writeln!(text, "note     the scene is empty: there is nothing to find")?;
        }
        if let Some(note) = note {
            writeln!(text, "note     {note}")?;
        }
        if !self.scene.skipped.is_empty() {
            let list: Vec<String> = self.scene.skipped.iter().map(ToString::to_string).collect();
            writeln!(text, "skipped  {}", list.join(", "))?;
        }
        let faces = if let About::Faces(used) = &self.about { format!(", {} faces", used.k) } else { String::new() };
        let done = if self.loaded { "loaded" } else { "built" };
        writeln!(text, "backend  {}{faces}, {done} in {:.3?}", self.backend, self.build)?;
        match &self.about {
            About::Faces(Used { choice: Some(choice), .. }) => writeln!(text, "k-DOPs   {choice}")?,
            About::Cubes(report) => writeln!(text, "cells    {report}")?,
            About::Cells(report) => writeln!(text, "cells    {report}")?,
            _ => {}
        }
        Ok(())
    }
}

/// What there is to say of every run that asks.
pub(crate) struct Run<'a> {
    pub(crate) indexed: Indexed<'a>,
    pub(crate) threads: usize,
    pub(crate) asked: Duration,
}

impl Run<'_> {
    /// The report of a command: that of the run, with `answers` in it, which went to `out`.
    pub(crate) fn json(&self, command: &str, answers: Value, out: &Value) -> Value {
        let end = json!({
            "seconds": {
                "read": self.indexed.read.as_secs_f64(),
                "build": self.indexed.build.as_secs_f64(),
                "query": self.asked.as_secs_f64(),
            },
            "out": out,
        });
        json::joined([self.indexed.json(command), json!({ "threads": self.threads }), answers, end])
    }

    /// Lines about the scene, the index, and the speed of `count` questions, which are called like `rays`, one of them
    /// `ray`.
    pub(crate) fn text(&self, many: &str, one: &str, count: u64) -> String {
        let mut text = String::new();
        // Nothing fails in writing to memory.
        let _ = self.write(&mut text, many, one, count);
        text
    }

    #[allow(clippy::cast_precision_loss, reason = "counts for people to read")]
    fn write(&self, text: &mut String, many: &str, one: &str, count: u64) -> fmt::Result {
        let note = (count == 0).then(|| format!("there are no {many}: nothing is asked"));
        self.indexed.write(text, note)?;
        let threads = if self.threads == 1 { "thread" } else { "threads" };
        write!(text, "{many:9}{count} in {:.3?} on {} {threads}", self.asked, self.threads)?;
        let seconds = self.asked.as_secs_f64();
        if count > 0 && seconds > 0.0 {
            let count = count as f64;
            write!(text, ": {:.0} ns per {one}, {:.0} {many}/s", seconds * 1e9 / count, count / seconds)?;
        }
        writeln!(text)
    }
}

/// 2^-64
const SCALE: f64 = 1.0 / (1u128 << 64) as f64;

/// Statistics of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spread {
    count: u64,
    min: f64,
    max: f64,
    sum: f64,
    /// The sum of the numbers times [`SCALE`], for those whose sum leaves the range.
    scaled_sum: f64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { count: 0, min: f64::INFINITY, max: f64::NEG_INFINITY, sum: 0.0, scaled_sum: 0.0 }
    }
}

impl Spread {
    pub(crate) fn add(&mut self, x: f64) {
        self.count += 1;
        self.min = self.min.min(x);
        self.max = self.max.max(x);
        self.sum += x;
        self.scaled_sum += x * SCALE;
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    #[allow(clippy::cast_precision_loss, reason = "more numbers than 2^53 are out of reach")]
    fn mean(&self) -> f64 {
        let count = self.count as f64;
        if self.sum.is_finite() { self.sum / count } else { self.scaled_sum / count / SCALE }
    }

    /// Null if there are no numbers.
    pub(crate) fn json(&self) -> Value {
        if self.count == 0 {
            return Value::Null;
        }
        json!({ "min": json::number(self.min), "max": json::number(self.max), "mean": json::number(self.mean()) })
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "min {:?}, max {:?}, mean {:?}", self.min, self.max, self.mean())
    }
}

/// Statistics of closest points.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    queries: u64,
    distances: Spread,
    /// How much larger than the true ones they are at most.
    errors: Spread,
}

impl Answers {
    pub(crate) fn add(&mut self, answer: Option<&Closest<f64>>) {
        self.queries += 1;
        if let Some(closest) = answer {
            self.distances.add(closest.distance);
            self.errors.add(closest.distance - closest.lower_bound);
        }
    }

    pub(crate) fn queries(&self) -> u64 {
        self.queries
    }

    /// The report: of queries that came from `asked_about`, within `max_distance`.
    pub(crate) fn json(&self, cells: &Value, max_distance: &Value, accuracy: &Value, asked_about: &Value) -> Value {
        let answered = self.distances.count();
        json!({
            "cells": cells,
            "max_distance": max_distance,
            "accuracy": accuracy,
            "asked_about": asked_about,
            "queries": self.queries,
            "answered": answered,
            "unanswered": self.queries - answered,
            "distance": self.distances.json(),
            "error": self.errors.json(),
        })
    }
}

impl fmt::Display for Answers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let answered = self.distances.count();
        writeln!(f, "answers  {answered}, without answer {}", self.queries - answered)?;
        if answered > 0 {
            writeln!(f, "distance {}", self.distances)?;
            writeln!(f, "error    max {:?}, mean {:?}, at most", self.errors.max, self.errors.mean())?;
        }
        Ok(())
    }
}
