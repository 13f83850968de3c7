//! What a run was about: for people on the standard error, or for programs as JSON.

use crate::faces::Used;
use crate::json;
use p2m_core::Closest;
use p2m_interception::OctreeReport;
use p2m_mixed::statistics::Counts;
use p2m_mixed::{Format, Scene};
use serde_json::{Value, json};
use std::fmt;
use std::time::Duration;

/// Numbers of a run.
pub(crate) struct Summary<'a> {
    pub(crate) scene_name: String,
    pub(crate) scene: &'a Scene,
    pub(crate) format: Format,
    pub(crate) backend: &'static str,
    pub(crate) about: About,
    pub(crate) threads: usize,
    pub(crate) read: Duration,
    pub(crate) build: Duration,
    pub(crate) query: Duration,
    pub(crate) answers: Answers,
}

/// What there is to say about an index.
pub(crate) enum About {
    Nothing,
    /// Of a k-DOP tree.
    Faces(Used),
    /// Of an octree.
    Cells(OctreeReport),
}

/// 2^-64
const SCALE: f64 = 1.0 / (1u128 << 64) as f64;

/// Statistics of the answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Answers {
    queries: u64,
    answered: u64,
    min: f64,
    max: f64,
    sum: f64,
    /// The sum of the distances times [`SCALE`], for those whose sum leaves the range.
    scaled_sum: f64,
}

impl Answers {
    pub(crate) fn none() -> Self {
        Self { queries: 0, answered: 0, min: f64::INFINITY, max: 0.0, sum: 0.0, scaled_sum: 0.0 }
    }

    pub(crate) fn add(&mut self, answer: Option<&Closest<f64>>) {
        self.queries += 1;
        if let Some(closest) = answer {
            self.answered += 1;
            self.min = self.min.min(closest.distance);
            self.max = self.max.max(closest.distance);
            self.sum += closest.distance;
            self.scaled_sum += closest.distance * SCALE;
        }
    }

    #[allow(clippy::cast_precision_loss, reason = "more answers than 2^53 are out of reach")]
    fn mean(&self) -> Option<f64> {
        let count = self.answered as f64;
        let mean = if self.sum.is_finite() { self.sum / count } else { self.scaled_sum / count / SCALE };
        (self.answered > 0).then_some(mean)
    }
}

impl Summary<'_> {
    /// The report: of queries that came from `asked_about`, within `max_distance`, with answers that went to `out`.
    pub(crate) fn json(&self, asked_about: &Value, max_distance: Option<f64>, out: &Value) -> Value {
        let answers = &self.answers;
        let distance = answers.mean().map(|mean| {
            json!({ "min": json::number(answers.min), "max": json::number(answers.max), "mean": json::number(mean) })
        });
        let (faces, choice) = match &self.about {
            About::Faces(used) => (Some(used.k), used.choice.as_ref()),
            _ => (None, None),
        };
        let cells = match &self.about {
            About::Cells(report) => json!({
                "lists": report.lists,
                "singles": report.singles,
                "trees": report.trees,
                "bytes": report.bytes,
                "tree_bytes": report.tree_bytes,
                "tests": report.work,
                "resolution": json::number(report.resolution),
            }),
            _ => Value::Null,
        };
        json!({
            "p2m": "query",
            "version": json::VERSION,
            "scene": {
                "file": self.scene_name,
                "format": self.format.name(),
                "primitives": json::counts(&Counts::of(&self.scene.soup)),
                "skipped": json::skipped(self.scene),
            },
            "backend": self.backend,
            "faces": faces,
            "choice": choice,
            "cells": cells,
            "threads": self.threads,
            "max_distance": max_distance.map_or(Value::Null, json::number),
            "asked_about": asked_about,
            "queries": answers.queries,
            "answered": answers.answered,
            "unanswered": answers.queries - answers.answered,
            "distance": distance,
            "seconds": {
                "read": self.read.as_secs_f64(),
                "build": self.build.as_secs_f64(),
                "query": self.query.as_secs_f64(),
            },
            "out": out,
        })
    }
}

#[allow(clippy::cast_precision_loss, reason = "counts for people to read")]
impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let soup = &self.scene.soup;
        let (triangles, segments, points) = (soup.triangles().len(), soup.segments().len(), soup.points().len());
        writeln!(f, "scene    {}", self.scene_name)?;
        writeln!(f, "         {triangles} triangles, {segments} segments, {points} points")?;
        if triangles + segments + points == 0 {
            writeln!(f, "note     the scene is empty: no query has an answer")?;
        }
        if !self.scene.skipped.is_empty() {
            let list: Vec<String> = self.scene.skipped.iter().map(ToString::to_string).collect();
            writeln!(f, "skipped  {}", list.join(", "))?;
        }
        let threads = if self.threads == 1 { "thread" } else { "threads" };
        let faces = if let About::Faces(used) = &self.about { format!(", {} faces", used.k) } else { String::new() };
        writeln!(f, "backend  {}{faces}, built in {:.3?}", self.backend, self.build)?;
        match &self.about {
            About::Faces(Used { choice: Some(choice), .. }) => writeln!(f, "k-DOPs   {choice}")?,
            About::Cells(report) => writeln!(f, "cells    {report}")?,
            _ => {}
        }
        let answers = &self.answers;
        let seconds = self.query.as_secs_f64();
        write!(f, "queries  {} in {:.3?} on {} {threads}", answers.queries, self.query, self.threads)?;
        if answers.queries > 0 && seconds > 0.0 {
            let count = answers.queries as f64;
            write!(f, ": {:.0} ns per query, {:.0} queries/s", seconds * 1e9 / count, count / seconds)?;
        }
        writeln!(f)?;
        writeln!(f, "answers  {}, without answer {}", answers.answered, answers.queries - answers.answered)?;
        if let Some(mean) = answers.mean() {
            writeln!(f, "distance min {:?}, max {:?}, mean {mean:?}", answers.min, answers.max)?;
        }
        Ok(())
    }
}
