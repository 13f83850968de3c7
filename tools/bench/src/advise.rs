//! `p2m-bench advise`: compares the recommended backend with the one that would have been best.

use crate::measure::MedianRange;
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::Result;
use nalgebra::Point3;
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, QueryRegion, SearchStructure, Workload, recommend};
use p2m_core::{QueryOptions, Soup};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::sync::Arc;

/// The number of queries that are timed.
pub(crate) const QUERIES: usize = 20_000;
/// The number of queries that are timed with exhaustive searches.
const EXHAUSTIVE_QUERIES: usize = 20;
/// The number of times that the queries are timed.
const ROUNDS: usize = 3;
/// The numbers of queries for which a backend is recommended.
const JOBS: [u64; 2] = [100_000, 10_000_000];

/// The cost of a backend: seconds to build, and seconds of a query near the surface and in the box.
struct Cost {
    backend: &'static BackendEntry,
    build: f64,
    query: [f64; 2],
}

/// Adds the rows of a scene. Returns the worst ratio of a recommended job to the best one, and the largest share of a
/// job that the advice took.
pub(crate) fn add_rows(scene: &Scene, table: &mut Table) -> Result<[f64; 2]> {
    let soup = &scene.double;
    let sets = [QuerySet::Near, QuerySet::Box1].map(|set| set.generate(soup, QUERIES, 1));
    let mut costs = Vec::new();
    for backend in BACKENDS {
        let count = if backend.structure == SearchStructure::Exhaustive { EXHAUSTIVE_QUERIES } else { QUERIES };
        costs.push(cost(backend, soup, &sets, count)?);
    }
    let (mut worst_ratio, mut largest_share) = (1.0f64, 0.0f64);
    for (k, (region, name)) in
        [(QueryRegion::NearSurface, "near"), (QueryRegion::SceneBox, "box")].into_iter().enumerate()
    {
        for queries in JOBS {
            let (advice, seconds) = thread_seconds(|| recommend(soup, &Workload::new(queries, region)));
            let advice = advice?;
            #[allow(clippy::cast_precision_loss, reason = "a number of queries")]
            let total = |cost: &Cost| cost.build + queries as f64 * cost.query[k];
            let best = costs.iter().map(total).fold(f64::INFINITY, f64::min);
            let chosen = costs.iter().find(|cost| cost.backend == advice.backend()).map_or(f64::NAN, total);
            let share = seconds / chosen;
            (worst_ratio, largest_share) = (worst_ratio.max(chosen / best), largest_share.max(share));
            let all: Vec<String> = costs.iter().map(|c| format!("{} {:.2}", c.backend, total(c) / best)).collect();
            table.push(vec![
                scene.name.clone(),
                name.to_owned(),
                format!("{queries:.0e}", queries = queries as f64),
                advice.backend().name.to_owned(),
                format!("{:.2}", chosen / best),
                format!("{:.2}", best),
                format!("{:.1} %", 100.0 * share),
                advice.sample_primitives.to_string(),
                all.join(", "),
            ]);
        }
    }
    Ok([worst_ratio, largest_share])
}

/// The headings of the table.
pub(crate) const HEADINGS: [&str; 9] = [
    "scene",
    "where",
    "queries",
    "advice",
    "times the best",
    "best s",
    "time of advice",
    "patch",
    "each, times the best",
];

fn cost(
    backend: &'static BackendEntry,
    soup: &Arc<Soup<f64>>,
    sets: &[Vec<Point3<f64>>; 2],
    count: usize,
) -> Result<Cost> {
    let (built, build) =
        thread_seconds(|| backend.build(Arc::clone(soup), &BuildSettings::default().with_parallel(false)));
    let index = built?.index;
    let query = sets.each_ref().map(|queries| {
        let queries = &queries[..count];
        let mut answers = vec![None; count];
        let times: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                let options = QueryOptions::default();
                let ((), seconds) = thread_seconds(|| index.closest_points_into(queries, &options, &mut answers));
                seconds / count as f64
            })
            .collect();
        MedianRange::of(&times).map_or(f64::NAN, |spread| spread.median)
    });
    Ok(Cost { backend, build, query })
}
