//! `p2m-bench advise`: compares the recommended backend with the one that would have been best.

use crate::measure::Spread;
use crate::our_indexes::{aabb_options, octree_options, p2m_options};
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::Result;
use nalgebra::Point3;
use p2m_advisor::{Choice, Place, Workload, recommend};
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, QueryOptions};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::{KdopOptions, KdopTree};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;

/// The number of queries that are timed.
pub(crate) const QUERIES: usize = 20_000;
/// The number of times that the queries are timed.
const ROUNDS: usize = 3;
/// The numbers of queries for which a backend is recommended.
const JOBS: [u64; 2] = [100_000, 10_000_000];

/// The cost of a backend: seconds to build, and seconds of a query near the surface and in the box.
struct Cost {
    choice: Choice,
    build: f64,
    query: [f64; 2],
}

/// Adds the rows of a scene. Returns the worst ratio of a recommended job to the best one, and the largest share of a
/// job that the advice took.
pub(crate) fn add_rows(scene: &Scene, table: &mut Table) -> Result<[f64; 2]> {
    let soup = &scene.double;
    let sets = [QuerySet::Near, QuerySet::Box1].map(|set| set.generate(soup, QUERIES, 1));
    let mut costs = Vec::new();
    for choice in Choice::ALL {
        costs.push(match choice {
            Choice::Brute => cost(choice, || Ok(BruteForce::build(soup, &())?), &sets, 20)?,
            Choice::Aabb => cost(choice, || Ok(AabbTree::build(soup, &aabb_options())?), &sets, QUERIES)?,
            Choice::Kdop => {
                let options = KdopOptions::default().with_splits(aabb_options());
                cost(choice, || Ok(KdopTree::<f64, _, 14>::build(soup, &options)?), &sets, QUERIES)?
            }
            Choice::Octree => cost(choice, || Ok(OctreeIndex::build(soup, &octree_options(1.0))?), &sets, QUERIES)?,
            Choice::P2m => cost(choice, || Ok(P2mIndex::build(soup, &p2m_options())?), &sets, QUERIES)?,
        });
    }
    let (mut worst_ratio, mut largest_share) = (1.0f64, 0.0f64);
    for (k, (place, name)) in [(Place::Near, "near"), (Place::Box, "box")].into_iter().enumerate() {
        for queries in JOBS {
            let (advice, seconds) = thread_seconds(|| recommend(soup, &Workload::new(queries, place)));
            let advice = advice?;
            #[allow(clippy::cast_precision_loss, reason = "a number of queries")]
            let total = |cost: &Cost| cost.build + queries as f64 * cost.query[k];
            let best = costs.iter().map(total).fold(f64::INFINITY, f64::min);
            let chosen = costs.iter().find(|cost| cost.choice == advice.choice()).map_or(f64::NAN, total);
            let share = seconds / chosen;
            (worst_ratio, largest_share) = (worst_ratio.max(chosen / best), largest_share.max(share));
            let all: Vec<String> = costs.iter().map(|c| format!("{} {:.2}", c.choice, total(c) / best)).collect();
            table.push(vec![
                scene.name.clone(),
                name.to_owned(),
                format!("{queries:.0e}", queries = queries as f64),
                advice.choice().name().to_owned(),
                format!("{:.2}", chosen / best),
                format!("{:.2}", best),
                format!("{:.1} %", 100.0 * share),
                advice.patch.to_string(),
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

fn cost<I: ClosestPoint<f64>>(
    choice: Choice,
    build: impl FnOnce() -> Result<I>,
    sets: &[Vec<Point3<f64>>; 2],
    count: usize,
) -> Result<Cost> {
    let (index, build) = thread_seconds(build);
    let index = index?;
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
        Spread::of(&times).map_or(f64::NAN, |spread| spread.median)
    });
    Ok(Cost { choice, build, query })
}
