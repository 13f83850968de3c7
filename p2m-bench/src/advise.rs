//! `p2m-bench advise`: what is recommended, against what would have been best.

use crate::measure::Spread;
use crate::scene::Scene;
use anyhow::Result;
use cpu_time::ThreadTime;
use nalgebra::Point3;
use p2m_advisor::{BACKENDS, BackendEntry, BuildSettings, QueryRegion, SearchStructure, Workload, recommend};
use p2m_core::{QueryOptions, Soup};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;

/// Queries that are timed.
pub(crate) const QUERIES: usize = 20_000;
/// Queries that are timed with exhaustive searches.
const EXHAUSTIVE_QUERIES: usize = 20;
/// How often.
const ROUNDS: usize = 3;
/// Jobs.
const JOBS: [u64; 2] = [100_000, 10_000_000];

/// Seconds to build, and a query near the surface and in the box.
struct Cost {
    backend: &'static BackendEntry,
    build: f64,
    query: [f64; 2],
}

/// Adds the rows of a scene; the worst ratio of a recommended job to the best one, and the largest share of advice.
pub(crate) fn add_rows(scene: &Scene, table: &mut Table) -> Result<[f64; 2]> {
    let soup = &scene.double;
    let sets = [QuerySet::Near, QuerySet::Box1].map(|set| set.generate(soup, QUERIES, 1));
    let mut costs = Vec::new();
    for backend in BACKENDS {
        let count = if backend.structure == SearchStructure::Exhaustive { EXHAUSTIVE_QUERIES } else { QUERIES };
        costs.push(cost(backend, soup, &sets, count)?);
    }
    let (mut worst, mut most) = (1.0f64, 0.0f64);
    for (k, (region, name)) in
        [(QueryRegion::NearSurface, "near"), (QueryRegion::SceneBox, "box")].into_iter().enumerate()
    {
        for queries in JOBS {
            let start = ThreadTime::now();
            let advice = recommend(soup, &Workload::new(queries, region))?;
            let seconds = start.elapsed().as_secs_f64();
            #[allow(clippy::cast_precision_loss, reason = "a number of queries")]
            let total = |cost: &Cost| cost.build + queries as f64 * cost.query[k];
            let best = costs.iter().map(total).fold(f64::INFINITY, f64::min);
            let chosen = costs.iter().find(|cost| cost.backend == advice.backend()).map_or(f64::NAN, total);
            let share = seconds / chosen;
            (worst, most) = (worst.max(chosen / best), most.max(share));
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
    Ok([worst, most])
}

/// The columns.
pub(crate) const HEAD: [&str; 9] = [
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

fn cost(backend: &'static BackendEntry, soup: &Soup<f64>, sets: &[Vec<Point3<f64>>; 2], count: usize) -> Result<Cost> {
    let start = ThreadTime::now();
    let index = backend.build(soup, &BuildSettings::default().with_parallel(false))?.index;
    let build = start.elapsed().as_secs_f64();
    let query = sets.each_ref().map(|places| {
        let places = &places[..count];
        let mut answers = vec![None; count];
        let times: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                let start = ThreadTime::now();
                index.closest_points_into(places, &QueryOptions::default(), &mut answers);
                start.elapsed().as_secs_f64() / count as f64
            })
            .collect();
        Spread::of(&times).map_or(f64::NAN, |spread| spread.median)
    });
    Ok(Cost { backend, build, query })
}
