//! `p2m-bench threads`: compares the wall time of builds on several numbers of threads.

use crate::command::{all_good, at_least_one, index_names};
use crate::measure::MedianRange;
use crate::rounds::rotated;
use crate::scene::Scene;
use anyhow::{Context, Result};
use clap::Args;
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_cli::harness::Table;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Indexes
    #[arg(long, value_delimiter = ',', default_value = "aabb,kdop,octree,p2m", value_parser = index_names())]
    backends: Vec<String>,
    /// Numbers of threads; times are compared with those of the first
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Rounds; another number of threads begins in each
    #[arg(long, default_value_t = 5, value_parser = at_least_one())]
    rounds: usize,
}

/// Times builds on several numbers of threads. No result counts as bad.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let about = format!("Wall time of builds, median of {} rounds in turns.", arguments.rounds);
    all_good(&arguments.scenes, &about, |scene| print(&scene, arguments).map(|()| true))
}

/// Prints the table of a scene. All numbers of threads build once in each round.
fn print(scene: &Scene, arguments: &Arguments) -> Result<()> {
    let Arguments { backends, threads, rounds, .. } = arguments;
    let columns = threads.iter().map(|count| format!("s, {count} thr"));
    let ratios = threads[1..].iter().map(|count| format!("{} / {count} thr", threads[0]));
    let mut table = Table::new(std::iter::once("index".to_owned()).chain(columns).chain(ratios));
    let pools = threads
        .iter()
        .map(|count| rayon::ThreadPoolBuilder::new().num_threads(*count).build())
        .collect::<Result<Vec<_>, _>>()?;
    for name in backends {
        let backend = BackendEntry::find(name).context("a backend of the registry")?;
        let mut seconds = vec![Vec::new(); pools.len()];
        for round in 0..*rounds {
            for at in rotated(pools.len(), round) {
                let (built, elapsed) = pools[at].install(|| {
                    let start = Instant::now();
                    (backend.build(Arc::clone(&scene.double), &BuildSettings::default()), start.elapsed())
                });
                built?;
                seconds[at].push(elapsed.as_secs_f64());
            }
        }
        let medians: Vec<f64> =
            seconds.iter().map(|seconds| MedianRange::of(seconds).map_or(f64::NAN, |seconds| seconds.median)).collect();
        let ratios = medians[1..].iter().map(|median| format!("{:.2}", medians[0] / median));
        let times = medians.iter().map(|median| format!("{median:.3}"));
        table.push(std::iter::once(name.clone()).chain(times).chain(ratios).collect());
    }
    println!("\n## {}\n\n{table}", scene.describe());
    Ok(())
}
