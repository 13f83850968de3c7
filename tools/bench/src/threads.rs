//! `p2m-bench threads`: compares the wall time of builds on several numbers of threads.

use crate::measure::MedianRange;
use crate::scene::Scene;
use anyhow::{Context, Result};
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_cli::harness::Table;
use std::sync::Arc;
use std::time::Instant;

/// Prints the table of a scene. All numbers of threads build once in each round.
pub(crate) fn print(scene: &Scene, backends: &[String], threads: &[usize], rounds: usize) -> Result<()> {
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
        for round in 0..rounds {
            for turn in 0..pools.len() {
                let at = (round + turn) % pools.len();
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
