//! What was measured: a curve for each backend with a point for each setting, in each set of queries of each scene.

use crate::errors::Errors;
use crate::settings::DEFAULT;
use crate::spread::{Spread, percentile};

/// What a backend costs before its first query.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Build {
    /// Seconds to build it on one thread.
    pub seconds: f64,
    /// Heap bytes that it owns for each primitive, besides the scene; `None` where they were not counted.
    pub bytes_each: Option<f64>,
}

/// How long single queries took by the wall clock, in nanoseconds, reading the clock included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Half of them.
    pub p50: u64,
    /// All but one in ten.
    pub p90: u64,
    /// All but one in a hundred.
    pub p99: u64,
    /// All but one in a thousand.
    pub p999: u64,
    /// All.
    pub max: u64,
}

impl Latency {
    /// Of queries in any order; `None` without any.
    #[must_use]
    pub fn of(mut nanoseconds: Vec<u64>) -> Option<Self> {
        nanoseconds.sort_unstable();
        let at = |parts| percentile(&nanoseconds, parts, 1000);
        Some(Self { p50: at(500)?, p90: at(900)?, p99: at(990)?, p999: at(999)?, max: at(1000)? })
    }
}

/// One setting of one backend.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The name of the setting.
    pub setting: String,
    /// Queries a round.
    pub queries: usize,
    /// Rounds.
    pub rounds: usize,
    /// Nanoseconds of thread CPU time per query, of the rounds.
    pub nanoseconds: Spread,
    /// Of its answers.
    pub errors: Errors,
    /// Of single queries.
    pub latency: Option<Latency>,
    /// Of its index.
    pub build: Build,
}

/// The settings of one backend.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The name of the backend.
    pub name: String,
    /// At least one.
    pub points: Vec<Point>,
}

impl Curve {
    /// Its usual setting: that of this name, or the first.
    #[must_use]
    pub fn usual(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.setting == DEFAULT.name).or(self.points.first())
    }
}

/// A set of queries.
#[derive(Clone, Debug, PartialEq)]
pub struct SetFigures {
    /// Its name.
    pub name: String,
    /// What its queries are.
    pub about: String,
    /// What was measured.
    pub curves: Vec<Curve>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFigures {
    /// Its name.
    pub name: String,
    /// What it has, in words.
    pub about: String,
    /// How many primitives.
    pub primitives: usize,
    /// The sets of queries.
    pub sets: Vec<SetFigures>,
    /// What is missing and why, in sentences.
    pub notes: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latencies_are_percentiles() {
        assert_eq!(Latency::of(Vec::new()), None);
        let reversed = (1..=1000).rev().collect();
        let expected = Latency { p50: 500, p90: 900, p99: 990, p999: 999, max: 1000 };
        assert_eq!(Latency::of(reversed), Some(expected));
    }
}
