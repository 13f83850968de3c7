//! Builds and rounds of queries, contenders taking turns, in thread CPU time.

use crate::agree::{Agreement, compare_round};
use crate::contender::{Absent, Answer, Backend, Ready, catch};
use crate::memory;
use crate::queries::{Queries, spread};
use crate::scene::Scene;
use cpu_time::ThreadTime;
use nalgebra::Point3;
use p2m_testkit::queries::QuerySet;
use std::hint::black_box;

pub(crate) use p2m_tradeoff::{Spread, rotated};

/// A contender slower than this gets [`SLOW_QUERIES`].
const SLOW_NANOSECONDS: f64 = 20_000.0;
const SLOW_QUERIES: usize = 20_000;

/// A round of an exhaustive contender is not to take longer, in nanoseconds.
const EXHAUSTIVE_ROUND: f64 = 1e9;

/// Enough probing to tell how slow a contender is, in nanoseconds.
const PROBE: f64 = 1e7;

/// Building again stops after so many seconds.
const BUILD_SECONDS: f64 = 10.0;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Rounds of queries.
    pub(crate) rounds: usize,
    /// Queries a round.
    pub(crate) queries: usize,
    /// Builds.
    pub(crate) builds: usize,
    /// Seed of the query sets.
    pub(crate) seed: u64,
}

/// What an index costs before its first query.
#[derive(Clone, Debug, Default)]
pub(crate) struct BuildFigures {
    /// Thread CPU seconds of each build.
    pub(crate) seconds: Vec<f64>,
    /// Heap bytes that the index owns, its copies of positions and ids included.
    pub(crate) owned: usize,
    /// Heap bytes of the scene that it borrows besides.
    pub(crate) borrowed: usize,
    /// The most heap bytes while building, those that it owns included.
    pub(crate) peak: usize,
}

/// What a contender did on a query set.
#[derive(Clone, Debug, Default)]
pub(crate) struct SetFigures {
    /// Queries a round.
    pub(crate) queries: usize,
    /// Thread CPU nanoseconds per query of each round.
    pub(crate) nanoseconds: Vec<f64>,
    /// Checksum of the answers of each round.
    pub(crate) checksums: Vec<u64>,
    /// How its answers compare with the others', over all rounds.
    pub(crate) agreement: Agreement,
}

/// A contender in a scene.
pub(crate) struct Entry<'a> {
    /// Which one.
    pub(crate) backend: &'static Backend,
    /// The index, or why there is none.
    pub(crate) index: Result<Ready<'a>, Absent>,
    /// Of its builds.
    pub(crate) build: BuildFigures,
    /// Of the query sets, in their order.
    pub(crate) sets: Vec<Result<SetFigures, Absent>>,
}

/// Builds all contenders `builds` times, in turns, and keeps the last index of each.
pub(crate) fn build_all<'a>(scene: &'a Scene, backends: &[&'static Backend], builds: usize) -> Vec<Entry<'a>> {
    let mut entries: Vec<Entry<'a>> = backends
        .iter()
        .map(|&backend| Entry {
            backend,
            index: Err(Absent("not built".to_owned())),
            build: BuildFigures::default(),
            sets: Vec::new(),
        })
        .collect();
    for round in 0..builds.max(1) {
        for at in rotated(entries.len(), round) {
            let entry = &mut entries[at];
            let failed = round > 0 && entry.index.is_err();
            if !failed && entry.build.seconds.iter().sum::<f64>() < BUILD_SECONDS {
                build_once(scene, entry);
            }
        }
    }
    entries
}

fn build_once<'a>(scene: &'a Scene, entry: &mut Entry<'a>) {
    // The previous one goes first, untimed.
    entry.index = Err(Absent("not built".to_owned()));
    let before = memory::current();
    entry.index = (entry.backend.prepare)(scene).and_then(|prepared| {
        entry.build.borrowed = prepared.borrowed;
        weigh(&mut entry.build, before, || catch(prepared.build))
    });
}

/// Builds, and adds what that costs; `before` is the memory before its input was prepared.
pub(crate) fn weigh<V>(
    figures: &mut BuildFigures,
    before: usize,
    build: impl FnOnce() -> Result<V, Absent>,
) -> Result<V, Absent> {
    memory::reset_peak();
    let start = ThreadTime::now();
    let index = build()?;
    let seconds = start.elapsed().as_secs_f64();
    figures.peak = memory::peak().saturating_sub(before);
    figures.owned = memory::current().saturating_sub(before);
    figures.seconds.push(seconds);
    Ok(index)
}

/// Measures one query set and appends its figures to every entry.
pub(crate) fn measure_set(scene: &Scene, set: QuerySet, entries: &mut [Entry<'_>], effort: &Effort) {
    measure(set.generate(&scene.double, effort.queries, effort.seed), entries, effort.rounds);
}

/// Measures queries of any kind.
pub(crate) fn measure(queries: Vec<Point3<f64>>, entries: &mut [Entry<'_>], rounds: usize) {
    let queries = Queries::new(queries);
    let mut runs: Vec<Run> = entries.iter().map(|entry| Run::new(entry, &queries)).collect();
    for round in 0..rounds {
        for at in rotated(entries.len(), round) {
            runs[at].round(&entries[at]);
        }
        let answers: Vec<_> = entries.iter().zip(&runs).map(|(e, run)| run.for_comparison(e)).collect();
        let agreements = compare_round(&answers, queries.len());
        for (run, agreement) in runs.iter_mut().zip(agreements) {
            run.figures.agreement.add(&agreement);
        }
    }
    for (entry, run) in entries.iter_mut().zip(runs) {
        entry.sets.push(run.failure.map_or(Ok(run.figures), Err));
    }
}

/// The state of a contender on a query set.
struct Run {
    /// The places of its queries in the set.
    chosen: Vec<usize>,
    queries: Queries,
    answers: Vec<Answer>,
    figures: SetFigures,
    failure: Option<Absent>,
}

impl Run {
    /// Decides how many queries the contender gets.
    fn new(entry: &Entry<'_>, queries: &Queries) -> Self {
        let (count, failure) = match &entry.index {
            Err(absent) => (1, Some(absent.clone())),
            Ok(index) => match probe(index, queries) {
                Err(absent) => (1, Some(absent)),
                Ok(nanoseconds) => (affordable(entry.backend, nanoseconds), None),
            },
        };
        let chosen = spread(queries.len(), count);
        let answers = vec![Answer::NONE; chosen.len()];
        let figures = SetFigures { queries: chosen.len(), ..SetFigures::default() };
        Self { queries: queries.gather(&chosen), chosen, answers, figures, failure }
    }

    fn round(&mut self, entry: &Entry<'_>) {
        let Ok(index) = &entry.index else { return };
        if self.failure.is_some() {
            return;
        }
        self.answers.fill(Answer::NONE);
        let start = ThreadTime::now();
        let outcome = index.answer(black_box(self.queries.all()), &mut self.answers);
        let elapsed = start.elapsed();
        black_box(&self.answers);
        self.failure = outcome.err();
        self.figures.nanoseconds.push(elapsed.as_secs_f64() * 1e9 / self.answers.len() as f64);
        self.figures.checksums.push(checksum(&self.answers));
    }

    fn for_comparison<'a>(&'a self, entry: &Entry<'_>) -> Option<crate::agree::Answers<'a>> {
        let backend = entry.backend;
        self.failure.is_none().then_some(crate::agree::Answers {
            backend,
            chosen: &self.chosen,
            answers: &self.answers,
        })
    }
}

/// Rough nanoseconds per query, from ever more queries.
fn probe(index: &Ready<'_>, queries: &Queries) -> Result<f64, Absent> {
    let sample = queries.gather(&spread(queries.len(), 1000));
    // A set that was read in order would favour its beginning: stride through it.
    let mut answers = vec![Answer::NONE; sample.len()];
    let mut count = 1;
    loop {
        let picked = sample.gather(&(0..count).map(|i| i * sample.len() / count).collect::<Vec<_>>());
        let start = ThreadTime::now();
        index.answer(picked.all(), &mut answers[..count])?;
        let elapsed = start.elapsed().as_secs_f64() * 1e9;
        if elapsed > PROBE || count == sample.len() {
            return Ok(elapsed / count as f64);
        }
        count = (count * 4).min(sample.len());
    }
}

/// How many queries a round a contender of that speed gets.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
fn affordable(backend: &Backend, nanoseconds: f64) -> usize {
    if nanoseconds <= SLOW_NANOSECONDS {
        usize::MAX
    } else if backend.exhaustive {
        SLOW_QUERIES.min((EXHAUSTIVE_ROUND / nanoseconds) as usize)
    } else {
        SLOW_QUERIES
    }
}

/// Depends on every bit of every answer and on their order.
fn checksum(answers: &[Answer]) -> u64 {
    answers.iter().fold(0, |sum: u64, answer| {
        (sum ^ answer.distance.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23) ^ u64::from(answer.id)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backends;
    use p2m_core::{Element, Soup};

    #[test]
    fn slow_contenders_get_fewer_queries() {
        let [brute, aabb] = ["brute", "aabb"].map(|name| backends::ALL.iter().find(|b| b.name == name).unwrap());
        assert_eq!([affordable(aabb, 1e3), affordable(aabb, 1e6), affordable(brute, 1e6)], [usize::MAX, 20_000, 1000]);
    }

    #[test]
    fn checksums_see_order_and_ids() {
        let answers = [Answer { distance: 1.0, id: 3 }, Answer { distance: 2.0, id: 3 }];
        let mut other = answers;
        other.reverse();
        assert_ne!(checksum(&answers), checksum(&other));
        other = answers;
        other[0].id = 4;
        assert_ne!(checksum(&answers), checksum(&other));
    }

    /// All contenders over a scene of these elements, measured a little.
    fn measured(elements: &[Element], check: impl FnOnce(&[Entry<'_>])) {
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        let scene = Scene::new("test".into(), Soup::new(p, elements.iter().copied()).unwrap()).unwrap();
        let effort = Effort { rounds: 2, queries: p2m_testkit::amount(300, 60), builds: 2, seed: 1 };
        let mut entries = build_all(&scene, &backends::ALL.iter().collect::<Vec<_>>(), effort.builds);
        QuerySet::ALL.iter().for_each(|set| measure_set(&scene, *set, &mut entries, &effort));
        check(&entries);
    }

    #[test]
    fn a_mixed_scene_is_measured_and_all_agree() {
        measured(&[Element::Triangle([0, 1, 2]), Element::Segment([2, 3])], |entries| {
            for entry in entries {
                let name = entry.backend.name;
                if ["aabb-tri", "aabb-set"].contains(&name) {
                    assert!(entry.index.is_err());
                    continue;
                }
                assert_eq!((entry.build.seconds.len(), entry.sets.len()), (2, 8), "{name}");
                for set in &entry.sets {
                    let set = set.as_ref().unwrap();
                    assert_eq!((set.nanoseconds.len(), set.checksums.len()), (2, 2));
                    assert_eq!(set.checksums[0], set.checksums[1]);
                    assert!(set.agreement.is_clean(), "{name} {:?}", set.agreement);
                    assert_eq!(set.agreement.compared > 0, entry.backend.ours);
                    assert!(set.agreement.difference < 1e-4, "{name} {:?}", set.agreement);
                }
            }
        });
    }

    #[test]
    fn a_rival_without_a_shape_is_absent_and_nothing_else_is() {
        measured(&[Element::Triangle([0, 1, 2]), Element::Point(3)], |entries| {
            for entry in entries {
                let absent = entry.index.as_ref().err();
                // The tree of the crate bvh asks our primitives.
                let has_shapes = entry.backend.ours || entry.backend.name == "bvh";
                let is_of_triangles = ["aabb-tri", "aabb-set"].contains(&entry.backend.name);
                assert_eq!(absent.is_some(), !has_shapes || is_of_triangles);
                assert!(entry.sets.iter().all(|set| set.is_err() == absent.is_some()));
            }
        });
    }
}
