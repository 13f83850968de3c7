//! `p2m-bench verify`: compares every exact backend of ours with brute force, bit for bit.

use crate::agree::{Agreement, Answers, compare_round};
use crate::backend::{Answer, Backend, BoxedIndex, ScalarKind, Unavailable};
use crate::command::{Common, all_good, backend_names};
use crate::queries::Queries;
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use p2m_cli::harness::Table;
use p2m_testkit::queries::QuerySet;
use std::thread;

#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Backends [default: all exact ones of ours]
    #[arg(long, value_delimiter = ',', value_parser = backend_names())]
    backends: Vec<String>,
    /// Queries of each set
    #[arg(long, default_value_t = 5000)]
    queries: usize,
    /// Seed of the query sets
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Compares our exact backends with brute force, and returns whether all answers are equal.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Arguments { common, backends, queries, seed } = arguments;
    let oracles = common.select(|b| b.is_ours && b.is_exhaustive);
    let is_named = |b: &Backend| backends.is_empty() || backends.iter().any(|name| name == b.name);
    let backends = common.select(|b| b.is_ours && !b.is_exhaustive && is_named(b));
    let about = format!("{queries} queries of each set, seed {seed}: how many answers equal those of brute force.");
    let is_equal = all_good(&common.scenes, &about, |scene| {
        Ok(verify(&scene, &oracles, &backends, &common.sets, *queries, *seed))
    })?;
    println!("\n{}", if is_equal { "All equal." } else { "DIFFERENCES, see above." });
    Ok(is_equal)
}

/// Compares `backends` with the oracle of their scalar on every set, prints counts, and returns whether all
/// answers are equal.
fn verify(
    scene: &Scene,
    oracles: &[&Backend],
    backends: &[&Backend],
    sets: &[QuerySet],
    count: usize,
    seed: u64,
) -> bool {
    println!("\n## {}\n", scene.describe());
    let mut table = Table::new(["", "scalar"].into_iter().chain(sets.iter().map(|set| set.name())));
    let (mut equal, mut notes) = (true, Vec::new());
    for scalar in [ScalarKind::Double, ScalarKind::Single] {
        let [oracles, backends] = [oracles, backends]
            .map(|list| list.iter().copied().filter(|b| b.scalar == scalar).collect::<Vec<&Backend>>());
        let mut rows: Vec<Vec<String>> =
            backends.iter().map(|b| vec![b.name.to_owned(), scalar.name().to_owned()]).collect();
        let built: Vec<_> = oracles.iter().chain(&backends).map(|b| b.build(scene)).collect();
        for (backend, index) in oracles.iter().chain(&backends).zip(&built) {
            if let Err(Unavailable(why)) = index {
                notes.push(format!("{} is left out: {why}", backend.name));
            }
        }
        for set in sets {
            let queries = Queries::new(set.generate(&scene.double, count, seed));
            let expected = oracles.iter().zip(&built).find_map(|(b, i)| Some((*b, answer(i.as_ref().ok()?, &queries))));
            for ((backend, index), row) in backends.iter().zip(&built[oracles.len()..]).zip(&mut rows) {
                let cell = match (&expected, index) {
                    (Some((oracle, Ok(expected))), Ok(index)) => match answer(index, &queries) {
                        Ok(answers) => {
                            let agreement = compare((oracle, expected), (backend, &answers));
                            if !agreement.is_clean() {
                                notes.extend(example(backend, *set, &queries, expected, &answers));
                            }
                            equal &= agreement.is_clean();
                            counts(&agreement)
                        }
                        Err(Unavailable(why)) => {
                            equal = false;
                            why
                        }
                    },
                    (Some((_, Err(Unavailable(why)))), _) => {
                        equal = false;
                        format!("oracle: {why}")
                    }
                    _ => "-".to_owned(),
                };
                row.push(cell);
            }
        }
        rows.into_iter().for_each(|row| table.push(row));
    }
    println!("{table}");
    notes.iter().for_each(|note| println!("- {note}"));
    equal
}

/// Returns the answers to all queries, computed on all cores.
fn answer(index: &BoxedIndex, queries: &Queries) -> Result<Vec<Answer>, Unavailable> {
    let mut answers = vec![Answer::NONE; queries.len()];
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let length = queries.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> = answers
            .chunks_mut(length)
            .enumerate()
            .map(|(i, part)| {
                let range = i * length..i * length + part.len();
                scope.spawn(move || index.answer(queries.slice(range), part))
            })
            .collect();
        parts
            .into_iter()
            .try_for_each(|part| part.join().unwrap_or_else(|_| Err(Unavailable("a thread panicked".to_owned()))))
    })?;
    Ok(answers)
}

/// Compares answers bitwise. `compare_round` takes the backend that is not exhaustive as its reference, which does not
/// change the counts.
fn compare(oracle: (&Backend, &[Answer]), backend: (&Backend, &[Answer])) -> Agreement {
    let all: Vec<usize> = (0..oracle.1.len()).collect();
    let round = [oracle, backend].map(|(backend, answers)| Some(Answers { backend, chosen: &all, answers }));
    compare_round(&round, all.len())[0]
}

fn counts(a: &Agreement) -> String {
    if a.is_clean() {
        format!("{} =", a.compared)
    } else {
        format!("{} distances, {} ids, {} failures of {}", a.other_distance, a.other_id, a.failed, a.compared)
    }
}

/// Describes the first query whose answers differ in any bit.
fn example(
    backend: &Backend,
    set: QuerySet,
    queries: &Queries,
    expected: &[Answer],
    answers: &[Answer],
) -> Option<String> {
    let wrong = |(e, a): (&Answer, &Answer)| !e.same_distance(a) || e.id != a.id;
    let at = expected.iter().zip(answers).position(wrong)?;
    let [x, y, z]: [f64; 3] = queries.all().double[at].coords.into();
    let (e, a) = (expected[at], answers[at]);
    Some(format!(
        "{} on {}: query {at} ({x:e}, {y:e}, {z:e}) should be {:e} at {}, is {:e} at {}",
        backend.name,
        set.name(),
        e.distance,
        e.id,
        a.distance,
        a.id
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::{BenchIndex, Prepared};
    use crate::backends;
    use nalgebra::Point3;
    use p2m_core::{Element, Soup};

    /// An index whose answers are right apart from the id.
    struct Wrong;

    impl BenchIndex for Wrong {
        type Scalar = f64;
        fn query(&self, query: &Point3<f64>) -> Answer {
            Answer { distance: query.coords.norm(), id: 1 }
        }
    }

    #[test]
    fn our_backends_pass_and_a_wrong_one_does_not() {
        let soup = Soup::new(vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0)], [Element::Point(0)]).unwrap();
        let scene = Scene::new("test".into(), soup).unwrap();
        let (oracles, backends): (Vec<_>, Vec<_>) =
            backends::ALL.iter().filter(|b| b.is_ours).partition(|b| b.is_exhaustive);
        let run = |backends: &[_]| verify(&scene, &oracles, backends, &QuerySet::ALL, 100, 1);
        assert!(run(&backends));
        let wrong = Backend::new("wrong", |_| Ok(Prepared { build: Box::new(|| Ok(Box::new(Wrong))), borrowed: 0 }));
        assert!(!run(&[&wrong]));
    }
}
