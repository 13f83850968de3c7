//! Measures a scene: the P2M index from inside, and all backends in turns.

use crate::backend::{Answer, Backend, Unavailable};
use crate::backends;
use crate::measure::{self, Effort, Entry, MedianRange, SetFigures};
use crate::our_indexes::p2m_options;
use crate::queries::Queries;
use crate::rounds::{rotated, thread_seconds};
use crate::scene::Scene;
use anyhow::Result;
use cpu_time::ThreadTime;
use nalgebra::Point3;
use p2m_core::{ClosestPoint, ListStats, PrimitiveSet, QueryCost, Soup};
use p2m_interception::StageTimes;
use p2m_interception::{BuildStage, P2mIndex, P2mReport};
use p2m_testkit::queries::{QuerySet, scaled_box};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// The measurements of a study besides builds and queries in the box of ten times the size.
#[derive(Clone, Copy, Default)]
pub(super) struct StudyOptions<'a> {
    /// The names of the backends.
    pub(super) backends: &'a [&'a str],
    /// The names of backends that are built once and queried in the box of ten times the size alone.
    pub(super) more: &'a [&'a str],
    /// The factors by which boxes of queries are larger than that of the scene.
    pub(super) boxes: &'a [f64],
    /// The numbers of threads.
    pub(super) threads: &'a [usize],
}

/// The measurements of a scene.
pub(super) struct Study {
    pub(super) name: String,
    pub(super) primitives: usize,
    pub(super) inside: IndexInternals,
    pub(super) backends: Vec<Measured>,
    /// Whether the answers of our backends were bitwise equal.
    pub(super) agrees: bool,
}

/// The measurements of the P2M index from inside.
pub(super) struct IndexInternals {
    pub(super) report: P2mReport,
    pub(super) lists: Option<ListStats>,
    /// The work of queries in the box of ten times the size.
    pub(super) visits: QueryCost,
    /// The seconds of each stage of the build.
    pub(super) stages: Vec<(BuildStage, f64)>,
    pub(super) parts: Vec<(&'static str, usize)>,
    pub(super) breakdown: Breakdown,
}

/// The nanoseconds of the parts of a query.
#[derive(Clone, Copy)]
pub(super) struct Breakdown {
    /// Nanoseconds to find the cell.
    pub(super) locate: f64,
    /// Nanoseconds of the query in all.
    pub(super) total: f64,
}

/// The measurements of a backend.
pub(super) struct Measured {
    pub(super) name: &'static str,
    /// The median of the build times, in seconds.
    pub(super) build: Option<f64>,
    /// The bytes of the index and of the scene that it borrows.
    pub(super) bytes: usize,
    /// Nanoseconds of a query in the box of ten times the size.
    pub(super) query: Option<MedianRange>,
    /// The median nanoseconds of a query, for each box.
    pub(super) boxes: Vec<Option<f64>>,
    /// The median nanoseconds of a query by the wall clock, for each number of threads.
    pub(super) threads: Vec<Option<f64>>,
    /// The reason why the backend was not measured.
    pub(super) absent: Option<Unavailable>,
}

impl Study {
    /// Measures a scene, with a note on the standard error.
    pub(super) fn of(scene: &Scene, options: StudyOptions<'_>, effort: &Effort) -> Result<Self> {
        let start = Instant::now();
        let soup = &*scene.double;
        let far = QuerySet::Box10.generate(soup, effort.queries, effort.seed);
        let inside = IndexInternals::of(soup, &far, effort.rounds)?;
        let named = |names: &[&str]| -> Vec<&'static Backend> {
            backends::ALL.iter().filter(|backend| names.contains(&backend.name)).collect()
        };
        let mut entries = measure::build_all(scene, &named(options.backends), effort.builds);
        let count = entries.len();
        entries.extend(measure::build_all(scene, &named(options.more), 1));
        measure::measure(far, &mut entries, effort.rounds);
        let usual = &mut entries[..count];
        for scale in options.boxes {
            measure::measure(scaled_box(soup, *scale, effort.queries, effort.seed), usual, effort.rounds);
        }
        let mut threads = threads(soup, usual, options.threads, effort)?;
        threads.resize(entries.len(), Vec::new());
        let backends: Vec<Measured> =
            entries.iter().zip(threads).map(|(entry, threads)| Measured::of(entry, threads)).collect();
        // A backend of ours without an answer does not agree.
        let is_clean = |set: &Result<SetFigures, Unavailable>| set.as_ref().is_ok_and(|set| set.agreement.is_clean());
        let agrees = entries.iter().filter(|entry| entry.backend.is_ours).all(|entry| entry.sets.iter().all(is_clean));
        eprintln!("{} primitives of {} in {:.1?}", soup.len(), scene.name, start.elapsed());
        Ok(Self { name: scene.name.clone(), primitives: soup.len(), inside, backends, agrees })
    }

    /// Returns the measurements of a backend, unless it is absent.
    pub(super) fn backend(&self, name: &str) -> Option<&Measured> {
        self.backends.iter().find(|measured| measured.name == name && measured.absent.is_none())
    }

    /// Returns the median nanoseconds of a backend for a query in the box of ten times the size.
    pub(super) fn query(&self, name: &str) -> Option<f64> {
        self.backend(name)?.query.map(|spread| spread.median)
    }
}

impl IndexInternals {
    fn of(soup: &Soup<f64>, queries: &[Point3<f64>], rounds: usize) -> Result<Self> {
        let times = StageTimes::new(|| ThreadTime::now().as_duration());
        let index = P2mIndex::<f64, _>::build_with_progress(soup, &p2m_options(), &|told| {
            times.tell(told);
        })?;
        let stages = times.finish().into_iter().map(|(stage, time)| (stage, time.as_secs_f64())).collect();
        Ok(Self {
            report: index.report(),
            lists: ListStats::from_index(&index),
            visits: QueryCost::measure(&index, queries),
            stages,
            parts: p2m_core::IndexStats::parts(&index),
            breakdown: Breakdown::of(&index, queries, rounds),
        })
    }
}

impl Breakdown {
    /// Times the location alone and whole queries in turns.
    fn of(index: &P2mIndex<f64, &Soup<f64>>, queries: &[Point3<f64>], rounds: usize) -> Self {
        let (mut locate, mut total) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            locate.push(nanoseconds(queries, |query| index.partition().locate_site(query)));
            total.push(nanoseconds(queries, |query| index.closest_point(query)));
        }
        let [locate, total] =
            [locate, total].map(|times| MedianRange::of(&times).map_or(f64::NAN, |spread| spread.median));
        Self { locate, total }
    }
}

/// Returns thread CPU nanoseconds per query.
fn nanoseconds<R>(queries: &[Point3<f64>], answer: impl Fn(&Point3<f64>) -> R) -> f64 {
    let ((), seconds) = thread_seconds(|| {
        for query in queries {
            black_box(answer(black_box(query)));
        }
    });
    seconds * 1e9 / queries.len().max(1) as f64
}

impl Measured {
    fn of(entry: &Entry<'_>, threads: Vec<Option<f64>>) -> Self {
        let medians: Vec<Option<MedianRange>> =
            entry.sets.iter().map(|set| MedianRange::of(&set.as_ref().ok()?.nanoseconds)).collect();
        Self {
            name: entry.backend.name,
            build: MedianRange::of(&entry.build.seconds).map(|spread| spread.median),
            bytes: entry.build.owned + entry.build.borrowed,
            query: medians.first().copied().flatten(),
            boxes: medians.iter().skip(1).map(|spread| spread.map(|spread| spread.median)).collect(),
            threads,
            absent: entry.index.as_ref().err().cloned(),
        }
    }
}

/// Returns the nanoseconds of wall time per query of each backend with each number of threads, measured in turns.
fn threads(
    soup: &Soup<f64>,
    entries: &[Entry<'_>],
    counts: &[usize],
    effort: &Effort,
) -> Result<Vec<Vec<Option<f64>>>> {
    /// The number of queries that a thread takes at a time.
    const QUERIES_PER_TASK: usize = 1024;
    let queries = Queries::new(QuerySet::Box10.generate(soup, effort.queries, effort.seed));
    let mut medians = vec![Vec::new(); entries.len()];
    for count in counts {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(*count).build()?;
        let mut times = vec![Vec::new(); entries.len()];
        for round in 0..effort.rounds {
            for at in rotated(entries.len(), round) {
                let Ok(index) = &entries[at].index else { continue };
                let mut answers = vec![Answer::NONE; queries.len()];
                let start = Instant::now();
                let task = |(i, answers): (usize, &mut [Answer])| {
                    index.answer(queries.slice(i * QUERIES_PER_TASK..i * QUERIES_PER_TASK + answers.len()), answers)
                };
                let outcome: Result<(), Unavailable> =
                    pool.install(|| answers.par_chunks_mut(QUERIES_PER_TASK).enumerate().try_for_each(task));
                if outcome.is_ok() {
                    times[at].push(start.elapsed().as_secs_f64() * 1e9 / queries.len().max(1) as f64);
                }
                black_box(&answers);
            }
        }
        for (medians, times) in medians.iter_mut().zip(times) {
            medians.push(MedianRange::of(&times).map(|spread| spread.median));
        }
    }
    Ok(medians)
}
