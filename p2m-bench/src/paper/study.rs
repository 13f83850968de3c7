//! What is measured in a scene: the P2M index from inside, and contenders in turns.

use crate::backends::{self, p2m_options};
use crate::contender::{Absent, Answer, Backend};
use crate::measure::{self, Effort, Entry, SetFigures, Spread, rotated};
use crate::queries::Queries;
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

/// What to measure besides builds and queries in the box of ten times the size.
#[derive(Clone, Copy, Default)]
pub(super) struct Wanted<'a> {
    /// Names of contenders.
    pub(super) contenders: &'a [&'a str],
    /// Of those that are built once, and asked in the box of ten times the size alone.
    pub(super) more: &'a [&'a str],
    /// Factors by which boxes of queries are larger than that of the scene.
    pub(super) boxes: &'a [f64],
    /// Numbers of threads.
    pub(super) threads: &'a [usize],
}

/// What was measured.
pub(super) struct Study {
    pub(super) name: String,
    pub(super) primitives: usize,
    pub(super) inside: Inside,
    pub(super) contenders: Vec<Measured>,
    /// Whether answers of ours were bitwise the same.
    pub(super) agrees: bool,
}

/// The P2M index from inside.
pub(super) struct Inside {
    pub(super) report: P2mReport,
    pub(super) lists: Option<ListStats>,
    /// In the box of ten times the size.
    pub(super) visits: QueryCost,
    /// Seconds of stages.
    pub(super) stages: Vec<(BuildStage, f64)>,
    pub(super) parts: Vec<(&'static str, usize)>,
    pub(super) breakdown: Breakdown,
}

/// Nanoseconds of a query.
#[derive(Clone, Copy)]
pub(super) struct Breakdown {
    /// To find the cell.
    pub(super) locate: f64,
    /// In all.
    pub(super) whole: f64,
}

/// A contender.
pub(super) struct Measured {
    pub(super) name: &'static str,
    /// Seconds, in the median.
    pub(super) build: Option<f64>,
    /// With the scene that it borrows.
    pub(super) bytes: usize,
    /// Nanoseconds of a query in the box of ten times the size.
    pub(super) query: Option<Spread>,
    /// The same, in the median, for the boxes
    pub(super) boxes: Vec<Option<f64>>,
    /// and for numbers of threads, of wall time.
    pub(super) threads: Vec<Option<f64>>,
    /// Why there is nothing of all that.
    pub(super) absent: Option<Absent>,
}

impl Study {
    /// Measures a scene, and says so on the standard error.
    pub(super) fn of(scene: &Scene, wanted: Wanted<'_>, effort: &Effort) -> Result<Self> {
        let start = Instant::now();
        let soup = &scene.double;
        let far = QuerySet::Box10.generate(soup, effort.queries, effort.seed);
        let inside = Inside::of(soup, &far, effort.rounds)?;
        let named = |names: &[&str]| -> Vec<&'static Backend> {
            backends::ALL.iter().filter(|backend| names.contains(&backend.name)).collect()
        };
        let mut entries = measure::build_all(scene, &named(wanted.contenders), effort.builds);
        let count = entries.len();
        entries.extend(measure::build_all(scene, &named(wanted.more), 1));
        measure::measure(far, &mut entries, effort.rounds);
        let usual = &mut entries[..count];
        for scale in wanted.boxes {
            measure::measure(scaled_box(soup, *scale, effort.queries, effort.seed), usual, effort.rounds);
        }
        let mut threads = threads(soup, usual, wanted.threads, effort)?;
        threads.resize(entries.len(), Vec::new());
        let contenders: Vec<Measured> =
            entries.iter().zip(threads).map(|(entry, threads)| Measured::of(entry, threads)).collect();
        // One of ours that is absent does not agree.
        let is_clean = |set: &Result<SetFigures, Absent>| set.as_ref().is_ok_and(|set| set.agreement.is_clean());
        let agrees = entries.iter().filter(|entry| entry.backend.ours).all(|entry| entry.sets.iter().all(is_clean));
        eprintln!("{} primitives of {} in {:.1?}", soup.len(), scene.name, start.elapsed());
        Ok(Self { name: scene.name.clone(), primitives: soup.len(), inside, contenders, agrees })
    }

    /// A contender that was measured, if it could be.
    pub(super) fn contender(&self, name: &str) -> Option<&Measured> {
        self.contenders.iter().find(|measured| measured.name == name && measured.absent.is_none())
    }

    /// Its median nanoseconds for a query in the box of ten times the size.
    pub(super) fn query(&self, name: &str) -> Option<f64> {
        self.contender(name)?.query.map(|spread| spread.median)
    }
}

impl Inside {
    fn of(soup: &Soup<f64>, queries: &[Point3<f64>], rounds: usize) -> Result<Self> {
        let times = StageTimes::new(|| ThreadTime::now().as_duration());
        let index = P2mIndex::<f64, _>::build_with_progress(soup, &p2m_options(), &|told| {
            times.tell(told);
        })?;
        let stages = times.finish().into_iter().map(|(stage, time)| (stage, time.as_secs_f64())).collect();
        Ok(Self {
            report: index.report(),
            lists: ListStats::of(&index),
            visits: QueryCost::of(&index, queries),
            stages,
            parts: p2m_core::Inspect::parts(&index),
            breakdown: Breakdown::of(&index, queries, rounds),
        })
    }
}

impl Breakdown {
    /// Locating alone and whole queries in turns.
    fn of(index: &P2mIndex<f64, &Soup<f64>>, queries: &[Point3<f64>], rounds: usize) -> Self {
        let (mut locate, mut whole) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            locate.push(nanoseconds(queries, |query| index.partition().site_of(query)));
            whole.push(nanoseconds(queries, |query| index.closest_point(query)));
        }
        let [locate, whole] = [locate, whole].map(|times| Spread::of(&times).map_or(f64::NAN, |spread| spread.median));
        Self { locate, whole }
    }
}

/// Thread CPU time per query.
fn nanoseconds<R>(queries: &[Point3<f64>], answer: impl Fn(&Point3<f64>) -> R) -> f64 {
    let start = ThreadTime::now();
    for query in queries {
        black_box(answer(black_box(query)));
    }
    start.elapsed().as_secs_f64() * 1e9 / queries.len().max(1) as f64
}

impl Measured {
    fn of(entry: &Entry<'_>, threads: Vec<Option<f64>>) -> Self {
        let medians: Vec<Option<Spread>> =
            entry.sets.iter().map(|set| Spread::of(&set.as_ref().ok()?.nanoseconds)).collect();
        Self {
            name: entry.backend.name,
            build: Spread::of(&entry.build.seconds).map(|spread| spread.median),
            bytes: entry.build.owned + entry.build.borrowed,
            query: medians.first().copied().flatten(),
            boxes: medians.iter().skip(1).map(|spread| spread.map(|spread| spread.median)).collect(),
            threads,
            absent: entry.index.as_ref().err().cloned(),
        }
    }
}

/// Of each contender the nanoseconds of wall time per query with each number of threads, contenders in turns.
fn threads(
    soup: &Soup<f64>,
    entries: &[Entry<'_>],
    counts: &[usize],
    effort: &Effort,
) -> Result<Vec<Vec<Option<f64>>>> {
    /// Queries that a thread takes at a time.
    const SHARE: usize = 1024;
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
                let share = |(i, answers): (usize, &mut [Answer])| {
                    index.answer(queries.slice(i * SHARE..i * SHARE + answers.len()), answers)
                };
                let done: Result<(), Absent> =
                    pool.install(|| answers.par_chunks_mut(SHARE).enumerate().try_for_each(share));
                if done.is_ok() {
                    times[at].push(start.elapsed().as_secs_f64() * 1e9 / queries.len().max(1) as f64);
                }
                black_box(&answers);
            }
        }
        for (medians, times) in medians.iter_mut().zip(times) {
            medians.push(Spread::of(&times).map(|spread| spread.median));
        }
    }
    Ok(medians)
}
