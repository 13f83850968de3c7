//! Times builds and rounds of queries in thread CPU time. Each round begins with another backend.

use crate::agree::{Agreement, Answers, compare_round};
use crate::backend::{Answer, Backend, BoxedIndex, Unavailable, catch};
use crate::memory;
use crate::queries::{Queries, QuerySlice};
use crate::rounds::{Rounds, checksum, rotated, thread_seconds};
use crate::scene::Scene;
use nalgebra::Point3;

pub(crate) use p2m_cli::harness::MedianRange;

/// The nanoseconds per query above which a backend is slow, and gets [`SLOW_QUERIES`] queries.
const SLOW_NANOSECONDS: f64 = 20_000.0;
/// The largest number of queries in a round of a slow backend.
const SLOW_QUERIES: usize = 20_000;

/// The longest time that a round of a slow backend may take, in nanoseconds.
const SLOW_ROUND_NANOSECONDS: f64 = 1e9;

/// The total seconds of builds after which an index is not built again.
const MAX_BUILD_SECONDS: f64 = 10.0;

/// The cost of an index before its first query.
#[derive(Clone, Debug, Default)]
pub(crate) struct BuildFigures {
    /// Thread CPU seconds of each build.
    pub(crate) seconds: Vec<f64>,
    /// Heap bytes that the index owns, its copies of positions and ids included.
    pub(crate) owned: usize,
    /// Heap bytes of the scene that the index borrows, which are not in `owned`.
    pub(crate) borrowed: usize,
    /// The largest number of heap bytes at any time of the build, `owned` included.
    pub(crate) peak: usize,
}

/// The measurements of a backend on one query set.
#[derive(Clone, Debug, Default)]
pub(crate) struct SetFigures {
    /// The number of queries in a round.
    pub(crate) queries: usize,
    /// Thread CPU nanoseconds per query, one value for each round.
    pub(crate) nanoseconds: Vec<f64>,
    /// A checksum of the answers, one value for each round.
    pub(crate) checksums: Vec<u64>,
    /// The comparison of the answers with those of other backends, over all rounds.
    pub(crate) agreement: Agreement,
}

/// A backend in a scene, with its index and its measurements.
pub(crate) struct Entry {
    /// The backend that was built.
    pub(crate) backend: &'static Backend,
    /// The index, or the reason why there is none.
    pub(crate) index: Result<BoxedIndex, Unavailable>,
    /// The cost of the builds.
    pub(crate) build: BuildFigures,
    /// The measurements on the query sets, in the order in which they were measured.
    pub(crate) sets: Vec<Result<SetFigures, Unavailable>>,
}

/// Builds all backends `builds` times, in turns, and keeps the last index of each.
pub(crate) fn build_all(scene: &Scene, backends: &[&'static Backend], builds: usize) -> Vec<Entry> {
    let mut entries: Vec<Entry> = backends
        .iter()
        .map(|&backend| Entry {
            backend,
            index: Err(Unavailable("not built".to_owned())),
            build: BuildFigures::default(),
            sets: Vec::new(),
        })
        .collect();
    for round in 0..builds {
        for at in rotated(entries.len(), round) {
            let entry = &mut entries[at];
            let failed = round > 0 && entry.index.is_err();
            if !failed && entry.build.seconds.iter().sum::<f64>() < MAX_BUILD_SECONDS {
                build_once(scene, entry);
            }
        }
    }
    entries
}

fn build_once(scene: &Scene, entry: &mut Entry) {
    // The previous index is dropped before the clock starts.
    entry.index = Err(Unavailable("not built".to_owned()));
    let before = memory::current();
    entry.index = (entry.backend.prepare)(scene).and_then(|prepared| {
        entry.build.borrowed = prepared.borrowed;
        measure_build(&mut entry.build, before, || catch(prepared.build))
    });
}

/// Builds an index and adds the cost to `figures`; `before` is the memory in use before the input was prepared.
pub(crate) fn measure_build<V>(
    figures: &mut BuildFigures,
    before: usize,
    build: impl FnOnce() -> Result<V, Unavailable>,
) -> Result<V, Unavailable> {
    memory::reset_peak();
    let (index, seconds) = thread_seconds(build);
    let index = index?;
    figures.peak = memory::peak().saturating_sub(before);
    figures.owned = memory::current().saturating_sub(before);
    figures.seconds.push(seconds);
    Ok(index)
}

/// Measures queries and appends the figures to every entry. `affordable` returns the number of queries in a round for a
/// backend of the given speed in nanoseconds.
///
/// The basic idea: in each round all backends answer once, and each round begins with another one. So a change of the
/// machine's speed affects all of them. After each round the answers are compared, so that wrong answers are never
/// timed unnoticed.
pub(crate) fn measure(
    queries: Vec<Point3<f64>>,
    entries: &mut [Entry],
    rounds: usize,
    affordable: impl Fn(f64) -> usize,
) {
    let queries = Queries::new(queries);
    let rounds_of = |entry: &Entry| Rounds::new(&queries, Answer::NONE, |q, a| entry.answer(q, a), &affordable);
    let mut all: Vec<Rounds<Answer, Unavailable>> = entries.iter().map(rounds_of).collect();
    let mut figures = vec![SetFigures::default(); all.len()];
    for round in 0..rounds {
        for at in rotated(entries.len(), round) {
            all[at].run(|queries, answers| entries[at].answer(queries, answers));
        }
        let answers = entries.iter().zip(&all).map(|(entry, Rounds { chosen, answers, failure, .. })| {
            failure.is_none().then_some(Answers { backend: entry.backend, chosen, answers })
        });
        let agreements = compare_round(&answers.collect::<Vec<_>>(), queries.len());
        for ((figures, rounds), agreement) in figures.iter_mut().zip(&all).zip(agreements) {
            let answers = rounds.answers.iter().map(|answer| (answer.distance.to_bits(), u64::from(answer.id)));
            figures.checksums.push(checksum(0, answers));
            figures.agreement.add(&agreement);
        }
    }
    for ((entry, rounds), figures) in entries.iter_mut().zip(all).zip(figures) {
        let Rounds { chosen, nanoseconds, failure, .. } = rounds;
        let figures = SetFigures { queries: chosen.len(), nanoseconds, ..figures };
        entry.sets.push(failure.map_or(Ok(figures), Err));
    }
}

impl Entry {
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Unavailable> {
        self.index.as_ref().map_err(Clone::clone)?.answer(queries, answers)
    }
}

/// Returns the number of queries in a round that takes at most about a second, or all queries for a fast backend.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
pub(crate) fn affordable(nanoseconds: f64) -> usize {
    if nanoseconds <= SLOW_NANOSECONDS {
        usize::MAX
    } else {
        SLOW_QUERIES.min((SLOW_ROUND_NANOSECONDS / nanoseconds) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::{BenchIndex, Prepared};
    use crate::backends;
    use p2m_core::{Element, Soup};
    use p2m_testkit::queries::QuerySet;

    #[test]
    fn slow_backends_get_fewer_queries() {
        assert_eq!([1e3, 3e4, 1e6].map(affordable), [usize::MAX, 20_000, 1000]);
    }

    /// Measures all backends over a scene of these elements, quickly.
    fn measured(elements: &[Element], check: impl FnOnce(&[Entry])) {
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        let scene = Scene::new("test".into(), Soup::new(p, elements.iter().copied()).unwrap()).unwrap();
        let mut entries = build_all(&scene, &backends::ALL.iter().collect::<Vec<_>>(), 2);
        for set in QuerySet::ALL {
            measure(set.generate(&scene.double, p2m_testkit::amount(300, 60), 1), &mut entries, 2, affordable);
        }
        check(&entries);
    }

    #[test]
    fn a_mixed_scene_is_measured_and_all_agree() {
        measured(&[Element::Triangle([0, 1, 2]), Element::Segment([2, 3])], |entries| {
            for entry in entries {
                let name = entry.backend.name;
                if name.starts_with("kiddo") {
                    assert!(entry.index.is_err());
                    continue;
                }
                assert_eq!((entry.build.seconds.len(), entry.sets.len()), (2, 8), "{name}");
                for set in &entry.sets {
                    let set = set.as_ref().unwrap();
                    assert_eq!((set.nanoseconds.len(), set.checksums.len()), (2, 2));
                    assert_eq!(set.checksums[0], set.checksums[1]);
                    assert!(set.agreement.is_clean(), "{name} {:?}", set.agreement);
                    assert_eq!(set.agreement.compared > 0, entry.backend.is_ours);
                    assert!(set.agreement.difference < 1e-4, "{name} {:?}", set.agreement);
                }
            }
        });
    }

    /// An index whose answers are right except for the id.
    struct Wrong;

    impl BenchIndex for Wrong {
        type Scalar = f64;
        fn query(&self, query: &Point3<f64>) -> Answer {
            Answer { distance: query.coords.norm(), id: 1 }
        }
    }

    #[test]
    fn a_backend_with_wrong_answers_is_found() {
        let soup = Soup::new(vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0)], [Element::Point(0)]).unwrap();
        let scene = Scene::new("test".into(), soup).unwrap();
        let wrong = Backend::new("wrong", |_| Ok(Prepared { build: Box::new(|| Ok(Box::new(Wrong))), borrowed: 0 }));
        let wrong: &'static Backend = Box::leak(Box::new(wrong));
        for (backends, is_clean) in [(vec![], true), (vec![wrong], false)] {
            let all: Vec<_> = backends::ALL.iter().filter(|b| b.is_ours).chain(backends).collect();
            let mut entries = build_all(&scene, &all, 1);
            measure(QuerySet::Box1.generate(&scene.double, 100, 1), &mut entries, 1, |_| usize::MAX);
            assert_eq!(crate::report::is_clean(&entries), is_clean);
            crate::report::print_agreement(&scene, &[QuerySet::Box1], &entries);
        }
    }

    #[test]
    fn a_library_without_a_shape_is_absent_and_nothing_else_is() {
        measured(&[Element::Triangle([0, 1, 2]), Element::Point(3)], |entries| {
            for entry in entries {
                let absent = entry.index.as_ref().err();
                // The tree of the crate bvh computes distances with our primitives, so it has all shapes.
                let has_shapes = entry.backend.is_ours || entry.backend.name == "bvh";
                assert_eq!(absent.is_some(), !has_shapes);
                assert!(entry.sets.iter().all(|set| set.is_err() == absent.is_some()));
            }
        });
    }
}
