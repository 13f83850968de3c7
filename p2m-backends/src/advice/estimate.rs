//! The expected costs of each backend, and the advice that follows from them.

use crate::registry::{BackendEntry, EXHAUSTIVE_SECONDS_PER_PRIMITIVE, REFERENCE_PRIMITIVES, SearchStructure};

/// The costs that are expected of a backend for a scene and a workload, on one thread.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The backend that is estimated.
    pub backend: &'static BackendEntry,
    /// The time to build the index, in seconds.
    pub build_seconds: f64,
    /// The time of one query, in seconds.
    pub query_seconds: f64,
    /// The memory of the index besides the scene, in bytes.
    pub bytes: f64,
    /// The time to build the index and to answer all queries, in seconds.
    pub total_seconds: f64,
    /// Whether the backend was measured on a sample of the scene. Otherwise the estimate follows from other scenes.
    pub is_measured: bool,
    /// The number of queries at which this backend and the recommended one take the same time; `None` if one of them
    /// is faster for every number of queries.
    pub break_even: Option<f64>,
    pub(crate) verdict: Verdict,
}

/// The reason for the rank of a backend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// It takes the least time in the memory that is allowed.
    Best,
    /// It needs more memory than is allowed.
    TooLarge,
    /// It takes longer to build than the best one.
    SlowBuild,
    /// It is built sooner than the best one, but answers queries more slowly.
    SlowQueries,
}

impl Estimate {
    /// The estimate of a backend for a scene of `primitives` primitives, without any measurement.
    pub(crate) fn unmeasured(backend: &'static BackendEntry, primitives: f64, is_near: bool) -> Self {
        let cost = &backend.cost;
        let query_seconds = match backend.structure {
            SearchStructure::Exhaustive => EXHAUSTIVE_SECONDS_PER_PRIMITIVE * primitives,
            _ => {
                let reference = if is_near { cost.near_query_seconds } else { cost.box_query_seconds };
                reference * cost.near_growth.powf((primitives / REFERENCE_PRIMITIVES).log2())
            }
        };
        Self {
            backend,
            build_seconds: cost.build_seconds_per_primitive * primitives,
            query_seconds,
            bytes: cost.bytes_per_primitive * primitives,
            total_seconds: 0.0,
            is_measured: false,
            break_even: None,
            verdict: Verdict::Best,
        }
    }

    /// The time to build the index and to answer this number of queries, in seconds.
    pub(crate) fn seconds_for(&self, queries: f64) -> f64 {
        self.build_seconds + queries * self.query_seconds
    }

    /// Returns the reason why the backend is recommended or not, as a phrase for people.
    #[must_use]
    pub fn reason(&self) -> String {
        let count = |n: f64| if n < 1e6 { format!("{n:.0}") } else { format!("{:.1} million", n / 1e6) };
        match (self.verdict, self.break_even) {
            (Verdict::Best, _) => "the least time for building and all queries".to_owned(),
            (Verdict::TooLarge, _) => format!("takes about {:.0} MB, more than there may be", self.bytes / 1e6),
            (Verdict::SlowBuild, Some(n)) => format!("takes longer to build; it pays from {} queries on", count(n)),
            (Verdict::SlowBuild, None) => "takes longer to build, and is not faster then".to_owned(),
            (Verdict::SlowQueries, Some(n)) => format!("is built sooner, but pays up to {} queries alone", count(n)),
            (Verdict::SlowQueries, None) => "takes longer for queries".to_owned(),
        }
    }
}

/// The answer of [`recommend`](crate::recommend).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Advice {
    /// The estimates of all backends: the recommended one first, then by total time, and those that need more memory
    /// than is allowed last.
    pub estimates: Vec<Estimate>,
    /// The time that the advice took, in seconds.
    pub seconds: f64,
    /// The number of primitives of the last sample that was measured; 0 if nothing was measured.
    pub sample_primitives: usize,
}

impl Advice {
    /// The recommended backend.
    #[must_use]
    pub fn backend(&self) -> &'static BackendEntry {
        self.estimates[0].backend
    }

    /// Ranks the estimates by total time, within the memory that is allowed.
    pub(crate) fn rank(mut estimates: Vec<Estimate>, max_bytes: usize, seconds: f64, sample_primitives: usize) -> Self {
        let fits = |e: &Estimate| e.bytes <= max_bytes as f64;
        estimates.sort_by(|a, b| fits(b).cmp(&fits(a)).then(a.total_seconds.total_cmp(&b.total_seconds)));
        let best = estimates[0];
        for other in &mut estimates[1..] {
            let queries = (other.build_seconds - best.build_seconds) / (best.query_seconds - other.query_seconds);
            other.break_even = (queries > 0.0 && queries.is_finite()).then_some(queries);
            other.verdict = if !fits(other) {
                Verdict::TooLarge
            } else if other.build_seconds > best.build_seconds {
                Verdict::SlowBuild
            } else {
                Verdict::SlowQueries
            };
        }
        Self { estimates, seconds, sample_primitives }
    }
}
