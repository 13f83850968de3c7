//! The summary of the answers of rays, as text for people or as JSON for programs.

use crate::answers::RunningStats;
use crate::io::json::stats;
use p2m_core::Hit;
use p2m_mixed::statistics::figure::{Count, Figure};
use serde_json::{Value, json};
use std::fmt;

/// The summary of the answers of rays.
#[derive(Debug, Default)]
pub(crate) struct RaySummary {
    /// The number of rays so far.
    pub(crate) rays: u64,
    /// The number of rays with at least one hit or crossing.
    with_hit: u64,
    /// The parameters of the hits, in modes that return hits.
    parameters: RunningStats,
    counts: Option<CountStats>,
}

/// Statistics of a count for each ray.
#[derive(Debug)]
struct CountStats {
    /// The word that begins the line about the counts.
    label: &'static str,
    min: u64,
    max: u64,
    total: u64,
}

impl RaySummary {
    /// A summary for modes in which every ray has a count. `label` begins the line about the counts.
    pub(crate) fn with_counts(label: &'static str) -> Self {
        Self { counts: Some(CountStats { label, min: u64::MAX, max: 0, total: 0 }), ..Self::default() }
    }

    /// Adds a ray with this number of hits or crossings.
    pub(crate) fn add(&mut self, count: u64) {
        self.rays += 1;
        self.with_hit += u64::from(count > 0);
        if let Some(counts) = &mut self.counts {
            counts.min = counts.min.min(count);
            counts.max = counts.max.max(count);
            counts.total += count;
        }
    }

    /// Adds a ray with these hits.
    pub(crate) fn add_hits(&mut self, hits: &[Hit]) {
        self.add(hits.len() as u64);
        hits.iter().for_each(|hit| self.parameters.add(hit.parameter));
    }

    #[allow(clippy::cast_precision_loss, reason = "more rays and hits than 2^53 are out of reach")]
    fn mean(&self, counts: &CountStats) -> f64 {
        counts.total as f64 / self.rays as f64
    }

    /// Returns the part of a report about the answers.
    pub(crate) fn json(&self) -> Value {
        let counts = self.counts.as_ref().filter(|_| self.rays > 0).map(
            |counts| json!({ "total": counts.total, "min": counts.min, "max": counts.max, "mean": self.mean(counts) }),
        );
        json!({
            "rays": self.rays,
            "with_hit": self.with_hit,
            "without_hit": self.rays - self.with_hit,
            "counts": counts,
            "parameter": stats(&self.parameters),
        })
    }
}

impl fmt::Display for RaySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "hitting  {}, missing {}", Count(self.with_hit), Count(self.rays - self.with_hit))?;
        if let Some(counts) = self.counts.as_ref().filter(|_| self.rays > 0) {
            let CountStats { label, min, max, total } = counts;
            let mean = Figure(self.mean(counts));
            writeln!(f, "{label:9}{}, per ray min {min}, max {max}, mean {mean}", Count(*total))?;
        }
        if self.parameters.count > 0 {
            writeln!(f, "at t     {}", self.parameters)?;
        }
        Ok(())
    }
}
