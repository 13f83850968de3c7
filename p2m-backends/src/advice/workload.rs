//! The work that an index is needed for.

use nalgebra::Point3;
use std::time::Duration;

/// The region that queries come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryRegion<'a> {
    /// About a hundredth of the diagonal of the scene away from its surface.
    NearSurface,
    /// Anywhere in the box of the scene.
    SceneBox,
    /// Where these points are, which are an example of the queries.
    Like(&'a [Point3<f64>]),
}

/// The work that an index is needed for, and the limits for the index and for the advice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Workload<'a> {
    /// The number of queries.
    pub queries: u64,
    /// The region that queries come from.
    pub region: QueryRegion<'a>,
    /// The largest number of bytes that the index may occupy besides the scene; unlimited by default.
    pub max_bytes: usize,
    /// The largest distance of an answer; unlimited by default. Only [`Choice`](crate::Choice) uses it.
    pub max_distance: f64,
    /// The longest time that the advice may take; unlimited by default. Advice never takes
    /// more than a small part of the expected time of the job.
    pub max_time: Duration,
}

impl<'a> Workload<'a> {
    /// Describes a number of queries from a region, without limits.
    #[must_use]
    pub fn new(queries: u64, region: QueryRegion<'a>) -> Self {
        Self { queries, region, max_bytes: usize::MAX, max_distance: f64::INFINITY, max_time: Duration::MAX }
    }

    /// Sets the largest number of bytes that the index may occupy.
    #[must_use]
    pub fn with_max_bytes(self, max_bytes: usize) -> Self {
        Self { max_bytes, ..self }
    }

    /// Sets the largest distance of an answer.
    #[must_use]
    pub fn with_max_distance(self, max_distance: f64) -> Self {
        Self { max_distance, ..self }
    }

    /// Sets the longest time that the advice may take.
    #[must_use]
    pub fn with_max_time(self, max_time: Duration) -> Self {
        Self { max_time, ..self }
    }
}
