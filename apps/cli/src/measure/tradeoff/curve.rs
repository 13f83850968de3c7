//! The results of a measurement: for each scene and each set of queries a curve for each backend, which has a point
//! for each setting.

use crate::measure::harness::MedianRange;
use crate::measure::tradeoff::errors::Errors;
use crate::measure::tradeoff::settings::DEFAULT;
use p2m_core::engine::stats::percentile;
use serde::Serialize;

/// The cost of an index before its first query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Build {
    /// The time to build it on one thread, in seconds.
    pub(crate) seconds: f64,
    /// The heap memory besides the scene, in bytes per primitive.
    pub(crate) bytes_per_primitive: f64,
}

/// Percentiles of the wall time of single queries, in nanoseconds. The time to read the clock is included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Latency {
    /// The median time.
    pub p50: u64,
    /// The 90th percentile.
    pub p90: u64,
    /// The 99th percentile.
    pub p99: u64,
    /// The 99.9th percentile.
    pub p999: u64,
    /// The longest time.
    pub(crate) max: u64,
}

impl Latency {
    /// Computes the percentiles of times in any order. Returns `None` if there are none.
    pub(crate) fn of(mut nanoseconds: Vec<u64>) -> Option<Self> {
        nanoseconds.sort_unstable();
        let at = |per_mille| percentile(&nanoseconds, per_mille, 1000);
        Some(Self { p50: at(500)?, p90: at(900)?, p99: at(990)?, p999: at(999)?, max: at(1000)? })
    }
}

/// The results of one setting of one backend.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Point {
    /// The name of the setting.
    pub(crate) setting: String,
    /// The number of queries of a round.
    pub(crate) queries: usize,
    /// The number of rounds.
    pub(crate) rounds: usize,
    /// The thread CPU time per query in nanoseconds, over the rounds.
    pub(crate) nanoseconds: MedianRange,
    /// The errors of the answers.
    pub(crate) errors: Errors,
    /// The times of single queries.
    pub(crate) latency: Option<Latency>,
    /// The cost of the index.
    pub(crate) build: Build,
}

/// The results of one backend.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Curve {
    /// The name of the backend.
    pub(crate) name: String,
    /// The results of its settings, at least one.
    pub(crate) points: Vec<Point>,
}

impl Curve {
    /// Returns the point of the default setting, or else the first one.
    pub(crate) fn default_point(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.setting == DEFAULT.name).or(self.points.first())
    }
}

/// The results for one set of queries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SetFigures {
    /// The name of the set.
    pub(crate) name: String,
    /// A sentence that describes the queries.
    pub(crate) about: String,
    /// The results of the backends.
    pub(crate) curves: Vec<Curve>,
    /// The backends of the curves that take the least time for some number of queries, with their builds.
    pub(crate) turns: Vec<Turn>,
}

/// A backend that takes the least time for its build and all queries, by the counts of a choice.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Turn {
    /// The name of the backend.
    pub(crate) name: &'static str,
    /// The number of queries from which on it does.
    pub(crate) from: f64,
}

/// The results for one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SceneFigures {
    /// The name of the scene.
    pub(crate) name: String,
    /// A sentence that describes the scene.
    pub(crate) about: String,
    /// The number of primitives.
    pub(crate) primitives: usize,
    /// The results for the sets of queries.
    pub(crate) sets: Vec<SetFigures>,
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
