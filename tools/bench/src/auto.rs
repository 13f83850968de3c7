//! `p2m-bench auto`: compares the backend that `auto` chooses with the best one for each job.
//!
//! A job is a number of queries near the surface or in the box of a scene. Its time is that of a build and of all
//! queries in batches, on one thread.

use crate::command::{Rounds, all_good};
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, Choice, QueryRegion, SearchStructure, Workload};
use p2m_cli::harness::{MedianRange, Table};
use p2m_core::QueryOptions;
use p2m_core::batch::{BatchOptions, ClosestColumns, closest_columns_into};
use p2m_testkit::queries::QuerySet;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Queries of a batch
    #[arg(long, default_value_t = 200_000)]
    queries: usize,
    #[command(flatten)]
    rounds: Rounds,
}

/// The numbers of queries of the jobs.
const JOBS: [u64; 6] = [1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
/// The query sets of the jobs.
const SETS: [QuerySet; 2] = [QuerySet::Near, QuerySet::Box1];
/// The factor over the time of the best backend above which a choice is bad.
const BAD: f64 = 1.15;
/// The resolution of an octree with finer cells.
const FINER: f64 = 3.0;
/// The number of times that each choice is repeated, to check that it is always the same.
const REPEATS: usize = 20;

/// Measures all jobs. It fails if more than one choice in a hundred is bad, or if a repeated choice differs.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let about = arguments.rounds.describe("Thread CPU time", arguments.queries, "queries");
    let (mut bad, mut jobs) = (0, 0);
    all_good(&arguments.scenes, &about, |scene| {
        bad += print(&scene, arguments)?;
        jobs += SETS.len() * JOBS.len();
        Ok(true)
    })?;
    println!("\n{bad} of {jobs} choices cost more than {BAD} times the best.");
    Ok(100 * bad <= jobs)
}

/// Prints the table of a scene, and returns the number of bad choices.
fn print(scene: &Scene, arguments: &Arguments) -> Result<usize> {
    let soup = &scene.double;
    // The octree is measured twice, because a choice may also ask for finer cells.
    let finer = |backend: &BackendEntry| if backend.has_resolution { vec![None, Some(FINER)] } else { vec![None] };
    let backends: Vec<(&BackendEntry, Option<f64>)> = BACKENDS
        .iter()
        .filter(|backend| backend.structure != SearchStructure::Exhaustive)
        .flat_map(|backend| finer(backend).into_iter().map(move |resolution| (backend, resolution)))
        .collect();
    let name = |(backend, resolution): (&BackendEntry, Option<f64>)| {
        format!("{}{}", backend.name, if resolution.is_some() { ", finer" } else { "" })
    };
    let (mut builds, mut times) = (vec![vec![]; backends.len()], vec![vec![vec![]; SETS.len()]; backends.len()]);
    let settings = BuildSettings::default().with_parallel(false);
    let count = arguments.queries;
    let queries = SETS.map(|set| set.generate(soup, count, arguments.rounds.seed));
    for _ in 0..arguments.rounds.rounds {
        for (i, (backend, resolution)) in backends.iter().enumerate() {
            let settings = settings.with_resolution(*resolution);
            let (built, seconds) = thread_seconds(|| backend.build(Arc::clone(soup), &settings));
            let index = built?.index;
            builds[i].push(seconds);
            for (queries, times) in queries.iter().zip(&mut times[i]) {
                let (mut distance, mut primitive) = (vec![0.0; count], vec![0; count]);
                let columns = ClosestColumns::default().with_distance(&mut distance).with_primitive(&mut primitive);
                let batch = BatchOptions::default().with_parallel(false);
                let options = QueryOptions::default();
                let answer = || closest_columns_into(&*index, queries, &options, &batch, columns);
                times.push(thread_seconds(answer).1 / count as f64);
            }
        }
    }
    let median = |seconds: &[f64]| MedianRange::of(seconds).map_or(f64::NAN, |range| range.median);
    let total = |i: usize, set: usize, queries: u64| median(&builds[i]) + queries as f64 * median(&times[i][set]);
    let mut table = Table::new(["set", "queries", "auto", "best", "cost"]);
    let mut bad = 0;
    for (set, (kind, queries)) in SETS.iter().zip(&queries).enumerate() {
        for job in JOBS {
            let workload = Workload::new(job, QueryRegion::Like(&queries[..count.min(1024)]));
            let choose = || -> Result<(&BackendEntry, Option<f64>)> {
                let choice = Choice::new(Arc::clone(soup), &workload)?;
                Ok((choice.backend(), choice.resolution()))
            };
            let choice = choose()?;
            for _ in 1..REPEATS {
                anyhow::ensure!(choose()? == choice, "{job} queries: another choice than {}", name(choice));
            }
            let totals: Vec<f64> = (0..backends.len()).map(|i| total(i, set, job)).collect();
            let best = (0..totals.len()).min_by(|&a, &b| totals[a].total_cmp(&totals[b])).unwrap_or_default();
            let chosen = backends.iter().position(|backend| *backend == choice).unwrap_or_default();
            let cost = totals[chosen] / totals[best];
            bad += usize::from(cost > BAD);
            let row =
                [kind.name().to_owned(), job.to_string(), name(choice), name(backends[best]), format!("{cost:.2}")];
            table.push(row.to_vec());
        }
    }
    println!("\n## {}\n\n{table}", scene.describe());
    Ok(bad)
}
