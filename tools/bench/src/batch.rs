//! `p2m-bench batch`: times batches of queries by order and number of threads.

use crate::measure::{Effort, MedianRange};
use crate::scene::Scene;
use anyhow::{Context, Result};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{BatchOptions, closest_points_into};
use p2m_core::{BuildIndex, Closest, ClosestPoint};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::time::Instant;

/// Prints wall times of batches over a scene, and returns whether all answers equal those of single queries.
pub(crate) fn print(scene: &Scene, sets: &[QuerySet], threads: &[usize], effort: &Effort) -> Result<bool> {
    let tree =
        AabbTree::build(&*scene.double, &Default::default()).context("the scene was checked when it was read")?;
    let mut head = vec!["set".to_owned(), "one by one".to_owned()];
    for n in threads {
        head.extend(["in order", "curve"].map(|strategy| format!("{strategy}, {n} thr")));
    }
    head.push("speed-up".to_owned());
    let mut table = Table::new(head);
    let strategies = [false, true];
    let mut equal = true;
    for set in sets {
        let queries = set.generate(&scene.double, effort.queries, effort.seed);
        let mut out: Vec<Option<Closest<f64>>> = vec![None; queries.len()];
        let single = |out: &mut [Option<Closest<f64>>]| tree.closest_points_into(&queries, &Default::default(), out);
        single(&mut out);
        let expected: Vec<_> = out.iter().map(answer).collect();
        // Each strategy has a row of times, so that strategies take turns.
        let mut times = vec![Vec::new(); 1 + strategies.len() * threads.len()];
        for _ in 0..effort.rounds {
            let start = Instant::now();
            single(&mut out);
            times[0].push(start.elapsed().as_secs_f64());
            for (t, &count) in threads.iter().enumerate() {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
                for (w, reorder) in strategies.iter().enumerate() {
                    let options = BatchOptions::default().with_reorder(*reorder);
                    out.fill(None);
                    let start = Instant::now();
                    pool.install(|| closest_points_into(&tree, &queries, &Default::default(), &options, &mut out));
                    times[1 + t * strategies.len() + w].push(start.elapsed().as_secs_f64());
                    equal &= out.iter().map(answer).eq(expected.iter().copied());
                }
            }
        }
        let medians: Vec<f64> =
            times.iter().map(|times| MedianRange::of(times).map_or(f64::NAN, |spread| spread.median)).collect();
        let mut row = vec![set.name().to_owned()];
        row.extend(medians.iter().map(|s| format!("{:.0}", s * 1e9 / queries.len() as f64)));
        // The speed-up is that of the last strategy, from the first to the last number of threads.
        row.push(format!("{:.2}", medians[strategies.len()] / medians[medians.len() - 1]));
        table.push(row);
    }
    println!("\n## {}\n\nNanoseconds of wall time per query, medians.\n\n{table}", scene.describe());
    Ok(equal)
}

type Answer = Option<(u64, usize, Point3<u64>)>;

/// Converts an answer into the form that is compared bitwise.
fn answer(closest: &Option<Closest<f64>>) -> Answer {
    closest.map(|c| (c.distance.to_bits(), c.primitive.index(), c.point.map(f64::to_bits)))
}
