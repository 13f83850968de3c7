//! Measures how times grow with size, and the speed-up of several threads.

use super::indexes::{Index, build_all, competitors};
use super::profile::{Profile, knot_of};
use super::truth::truths;
use crate::queries::Queries;
use crate::scene::Scene;
use anyhow::Result;
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::page::Sweep;
use p2m_tradeoff::rounds::rotated;
use p2m_tradeoff::{MedianRange, measure};

/// The query set of the sweeps, in the box of the scene.
const SET: QuerySet = QuerySet::Box1;

/// Measures the time per query, the build time and the memory over the number of triangles.
pub(super) fn sizes(profile: &Profile, seed: u64) -> Result<Vec<Sweep>> {
    let abouts = [
        ("Time per query over size", "ns per query", "Default settings, one thread."),
        ("Time to build over size", "seconds to build", "On one thread."),
        ("Memory over size", "bytes a primitive", "Heap bytes besides the scene."),
    ];
    let mut sweeps = abouts.map(|(title, measured, about)| Sweep {
        title: title.to_owned(),
        about: format!("A generated torus knot in several resolutions, queried in its box. {about}"),
        axes: ["triangles", measured],
        lines: Vec::new(),
    });
    for size in profile.sizes {
        let scene = knot_of(*size)?;
        let queries = SET.generate(&scene.double, profile.queries, seed);
        let truths = truths(&scene, &queries);
        let (indexes, _) = build_all(&scene, profile.builds);
        let curves = measure(&competitors(&indexes, true), &Queries::new(queries), &truths, &profile.effort, &|_| ());
        for curve in &curves {
            let point = &curve.points[0];
            // Memory below one byte per primitive does not grow with the scene and is left out.
            let bytes = point.build.bytes_per_primitive.filter(|bytes| *bytes >= 1.0);
            let figures = [Some(point.nanoseconds.median), Some(point.build.seconds), bytes];
            for (sweep, figure) in sweeps.iter_mut().zip(figures) {
                if let Some(figure) = figure {
                    add(sweep, &curve.name, (scene.len() as f64, figure));
                }
            }
        }
    }
    Ok(sweeps.into())
}

/// Measures the wall time of batches on several threads.
pub(super) fn threads(scene: &Scene, indexes: &[Index<'_>], profile: &Profile, seed: u64) -> Result<Sweep> {
    let queries = Queries::new(SET.generate(&scene.double, profile.batch, seed));
    let count = queries.len();
    let mut sweep = Sweep {
        title: "Threads".to_owned(),
        about: format!(
            "{}: batches of {count} queries in its box (p2m_core::batch, default options: reordered), wall time, medians of {} \
             rounds in turns. Brute force and other libraries have no batches here.",
            scene.name, profile.effort.rounds
        ),
        axes: ["threads", "ns per query, wall time"],
        lines: Vec::new(),
    };
    let ours: Vec<_> = indexes.iter().filter(|index| index.candidate.has_settings).collect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for threads in (0..usize::BITS).map(|i| 1 << i).take_while(|threads: &usize| *threads <= cores) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let mut times = vec![Vec::new(); ours.len()];
        for round in 0..profile.effort.rounds {
            for at in rotated(ours.len(), round) {
                times[at].extend(pool.install(|| ours[at].built.batch(queries.all())));
            }
        }
        for (index, times) in ours.iter().zip(times) {
            if let Some(seconds) = MedianRange::of(&times) {
                add(&mut sweep, index.candidate.name, (threads as f64, seconds.median * 1e9 / count as f64));
            }
        }
    }
    Ok(sweep)
}

fn add(sweep: &mut Sweep, name: &str, point: (f64, f64)) {
    match sweep.lines.iter_mut().find(|line| line.0 == name) {
        Some(line) => line.1.push(point),
        None => sweep.lines.push((name.to_owned(), vec![point])),
    }
}
