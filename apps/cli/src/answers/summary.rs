//! Summaries of a run: its scene, its index and its answers, as text for people or as JSON for programs.

use crate::answers::running_stats::RunningStats;
use crate::index::PreparedIndex;
use crate::io::json::stats;
use crate::io::{SceneFile, Streams, json};
use crate::scene::info::counted;
use p2m_backends::ChosenDirections;
use p2m_core::{CellSummary, Closest};
use p2m_mixed::Skipped;
use p2m_mixed::statistics::Counts;
use p2m_mixed::statistics::figure::{Count, Figure, Rate, Time};
use serde_json::{Value, json};
use std::fmt;
use std::time::Duration;

/// The summary of a scene and of the index over it.
pub(crate) struct IndexSummary<'a> {
    /// The name of the scene.
    pub(crate) name: String,
    /// The name of the format of its file.
    pub(crate) format: &'static str,
    pub(crate) counts: Counts,
    pub(crate) skipped: &'a [Skipped],
    pub(crate) backend: &'a str,
    /// The index, unless it is in shards, on a card, or lists alone are used.
    pub(crate) prepared: Option<&'a PreparedIndex>,
    /// Whether the index was loaded from a file.
    pub(crate) is_loaded: bool,
    /// The time to read the scene.
    pub(crate) read_time: Duration,
    /// The time to build or load the index.
    pub(crate) build_time: Duration,
}

impl<'a> IndexSummary<'a> {
    /// Returns the summary of a scene in memory and of the index over it, if there is one.
    pub(crate) fn new(
        file: &'a SceneFile,
        backend: &'a str,
        prepared: Option<&'a PreparedIndex>,
        build_time: Duration,
    ) -> Self {
        Self {
            name: file.name.clone(),
            format: file.format.name(),
            counts: Counts::of(&file.scene.soup),
            skipped: &file.scene.skipped,
            backend,
            prepared,
            is_loaded: prepared.is_some_and(|prepared| prepared.is_loaded),
            read_time: file.read_time,
            build_time,
        }
    }

    /// Returns the part of a report that describes the scene and the index, as an object.
    pub(crate) fn json(&self) -> Value {
        let directions = self.directions();
        json!({
            "scene": {
                "file": self.name,
                "format": self.format,
                "primitives": json::counts(&self.counts),
                "skipped": json::skipped(self.skipped),
            },
            "backend": self.backend,
            "backend_reason": self.reason(),
            "loaded": self.is_loaded,
            "faces": directions.map(|directions| directions.faces),
            "directions_reason": directions.and_then(|directions| directions.reason.as_ref()),
        })
    }

    /// Returns the directions of a k-DOP tree.
    fn directions(&self) -> Option<&ChosenDirections> {
        self.prepared?.built.directions.as_ref()
    }

    /// Returns the reason of the choice of the backend, if the program chose it.
    fn reason(&self) -> Option<&str> {
        self.prepared?.reason.as_deref()
    }

    fn cells_of_index(&self) -> Option<CellSummary> {
        self.prepared?.built.index.cells()
    }

    /// Returns the part of a report about the times of reading, of building, and of something else.
    pub(crate) fn seconds(&self, what: &str, time: Duration) -> Value {
        let [read, build, time] = [self.read_time, self.build_time, time].map(|time| time.as_secs_f64());
        json!({ "read": read, "build": build, what: time })
    }

    /// Returns the numbers of cells of an index; null for an index without cells.
    pub(crate) fn cells(&self) -> Value {
        let Some(cells) = self.cells_of_index() else { return Value::Null };
        let counts = cells.counts.into_iter().map(|(name, count)| (name, count.into()));
        counts.chain(cells.resolution.map(|resolution| ("resolution", json::number(resolution)))).collect()
    }

    /// Returns lines about the scene and the index, with a line for the note if there is one.
    pub(crate) fn text(&self, note: Option<String>) -> String {
        let is_empty = self.counts.total() == 0;
        let empty = is_empty.then(|| "the scene is empty: there is nothing to find".to_owned());
        let skipped = Some(listed(self.skipped)).filter(|list| !list.is_empty());
        let faces = self.directions().map_or(String::new(), |directions| format!(", {} faces", directions.faces));
        let verb = if self.is_loaded { "loaded" } else { "built" };
        let backend = format!("{}{faces}, {verb} in {}", self.backend, Time(self.build_time));
        let lines = [
            ("scene", Some(self.name.clone())),
            ("", Some(counted(&self.counts))),
            ("note", empty),
            ("note", note),
            ("skipped", skipped),
            ("backend", Some(backend)),
            ("choice", self.reason().map(str::to_owned)),
            ("k-DOPs", self.directions().and_then(|directions| directions.reason.clone())),
            ("cells", self.cells_of_index().map(|cells| cells.text)),
        ];
        lines.into_iter().filter_map(|(label, text)| Some(format!("{label:9}{}\n", text?))).collect()
    }
}

/// Returns a list of skipped records in words.
pub(crate) fn listed(skipped: &[Skipped]) -> String {
    skipped.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// The summary of a run that answers queries or rays.
pub(crate) struct RunSummary<'a> {
    pub(crate) index: IndexSummary<'a>,
    pub(crate) threads: usize,
    /// The time that the queries took.
    pub(crate) query_time: Duration,
}

impl RunSummary<'_> {
    /// Prints the report of a command. `answers` is its part about the answers, and `out` describes their file.
    pub(crate) fn print_json(
        &self,
        streams: &Streams,
        command: &str,
        answers: Value,
        out: &Value,
    ) -> anyhow::Result<()> {
        let end = json!({ "seconds": self.index.seconds("query", self.query_time), "out": out });
        json::print_report(streams, command, [self.index.json(), json!({ "threads": self.threads }), answers, end])
    }

    /// Returns lines about the scene, the index and the speed of `count` queries. The queries are called `many` in the
    /// plural and `one` in the singular.
    #[allow(clippy::cast_precision_loss, reason = "counts for people to read")]
    pub(crate) fn text(&self, many: &str, one: &str, count: u64) -> String {
        let mut text = self.index.text((count == 0).then(|| format!("there are no {many}: nothing is computed")));
        let threads = if self.threads == 1 { "thread" } else { "threads" };
        let time = Time(self.query_time);
        text += &format!("{many:9}{} in {time} on {} {threads}", Count(count), self.threads);
        let seconds = self.query_time.as_secs_f64();
        if count > 0 && seconds > 0.0 {
            let count = count as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a time is not negative")]
            let each = Count((seconds * 1e9 / count).round() as u64);
            text += &format!(": {each} ns per {one}, {} {many}/s", Rate(count / seconds));
        }
        text + "\n"
    }
}

/// The summary of the answers of closest-point queries.
#[derive(Debug, Default)]
pub(crate) struct AnswerSummary {
    pub(crate) queries: u64,
    /// The number of queries without an answer.
    unanswered: u64,
    distances: RunningStats,
    /// The upper bounds of the errors of the distances.
    errors: RunningStats,
    /// The number of queries that are inside, if there are signs.
    pub(crate) inside: Option<u64>,
}

impl AnswerSummary {
    /// Adds a query with one answer or none, and whether it is inside if there are signs.
    pub(crate) fn add(&mut self, answer: Option<&Closest<f64>>, is_inside: Option<bool>) {
        self.add_all(answer.map_or(&[], std::slice::from_ref));
        self.count_side(is_inside);
    }

    /// Adds a query that was asked for its side alone.
    pub(crate) fn add_side(&mut self, is_inside: Option<bool>) {
        self.queries += 1;
        self.count_side(is_inside);
    }

    fn count_side(&mut self, is_inside: Option<bool>) {
        if let Some(is_inside) = is_inside {
            self.inside = Some(self.inside.unwrap_or(0) + u64::from(is_inside));
        }
    }

    /// Adds a query with any number of answers.
    pub(crate) fn add_all(&mut self, answers: &[Closest<f64>]) {
        self.queries += 1;
        self.unanswered += u64::from(answers.is_empty());
        for closest in answers {
            self.distances.add(closest.distance);
            self.errors.add(closest.distance - closest.lower_bound);
        }
    }

    /// Returns the part of a report about the answers.
    pub(crate) fn json(&self) -> Value {
        json!({
            "queries": self.queries,
            "answered": self.queries - self.unanswered,
            "unanswered": self.unanswered,
            "answers": self.distances.count,
            "distance": stats(&self.distances),
            "error": stats(&self.errors),
        })
    }
}

impl fmt::Display for AnswerSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let answers = self.distances.count;
        if let Some(inside) = self.inside {
            writeln!(f, "inside   {} of {}", Count(inside), Count(self.queries))?;
        }
        if answers > 0 || self.inside.is_none() || self.unanswered > 0 {
            writeln!(f, "answers  {}, without answer {}", Count(answers), Count(self.unanswered))?;
        }
        if answers > 0 {
            writeln!(f, "distance {}", self.distances)?;
            writeln!(
                f,
                "accuracy distances are too large by at most {}, on average by at most {}",
                Figure(self.errors.max),
                Figure(self.errors.mean())
            )?;
        }
        Ok(())
    }
}
