//! Isolated primitives: every clause of the contract that one primitive can break.

use super::rival::{Kind, RIVALS, Said};
use super::tally::Tally;
use crate::contender::{Absent, catch};
use p2m_core::Real;
use p2m_testkit::contract::{self, Violation};
use p2m_testkit::families::{self, Case, Family, OFFSETS, SINES, Span};
use p2m_testkit::truth::rational_distances;
use rand::Rng;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Cases that a thread takes at a time.
const CHUNK: u64 = 10_000;
/// Rivals are asked about one case of so many.
const RIVAL_EVERY: u64 = 20;
/// The scalars of ours, and the ranges of their cases.
const SPANS: [(&str, Span); 2] = [("f64", Span::F64), ("f32", Span::F32)];
/// Subjects: ours in both scalars, and rivals.
const SUBJECTS: usize = 2 + RIVALS.len();
/// Broken promises that are kept to be shown.
const SHOWN: usize = 20;

/// The shortest case that a rival gets wrong in some way.
#[derive(Clone, Debug)]
pub(super) struct Example {
    pub(super) rival: usize,
    pub(super) kind: Kind,
    pub(super) query: [f64; 3],
    pub(super) vertices: Vec<[f64; 3]>,
}

impl Example {
    /// Ordinary magnitudes first, then what is short to write.
    fn plainness(&self) -> (bool, usize) {
        let ordinary = |x: &f64| *x == 0.0 || (1e-30..1e30).contains(&x.abs());
        (!self.vertices.as_flattened().iter().chain(&self.query).all(ordinary), self.text().len())
    }

    /// As Rust source.
    pub(super) fn text(&self) -> String {
        format!("{:?} {:?}", self.query, self.vertices)
    }
}

/// Everything that was found.
pub(super) struct Findings {
    /// The names of rows, and of each the tallies of all subjects.
    pub(super) rows: Vec<(String, [Tally; SUBJECTS])>,
    /// Answers of ours in f64 and in f32 that were held against the truth.
    pub(super) checked: [u64; 2],
    /// Answers compared besides to those for another order of vertices and another scale.
    pub(super) invariant: u64,
    /// Distances that needed rational arithmetic.
    pub(super) rational: u64,
    /// Promises of ours that were broken: how many, and some of them in words.
    pub(super) broken: u64,
    pub(super) shown: Vec<String>,
    /// What rivals get wrong.
    pub(super) examples: Vec<Example>,
}

/// Names of the rows; [`rows_of`] knows their places.
fn labels() -> Vec<String> {
    let mut labels: Vec<String> =
        ["lattice", "any magnitude", "almost parallel to an axis", "neighbours of an f32", "needles"]
            .map(str::to_owned)
            .to_vec();
    labels.extend(SINES.iter().map(|sine| format!("sine {sine:e}")));
    labels.extend(OFFSETS.iter().map(|offset| format!("offset {offset:e}")));
    for (scalar, span) in SPANS {
        labels.extend(span.scales.iter().map(|scale| format!("scale 2^{scale} of {scalar}")));
    }
    labels.extend(PLACES.iter().map(|place| format!("query {place}")));
    labels
}

/// Where queries are.
const PLACES: [&str; 13] = [
    "on a vertex",
    "on an edge",
    "in the face",
    "near the face",
    "above the face",
    "above a vertex",
    "above an edge",
    "on the extension of an edge",
    "near an edge",
    "equidistant",
    "far",
    "beside a vertex",
    "near a vertex",
];

/// The rows to which a case of a scalar belongs: those of sines and queries have ordinary scales and places only, so that they say what they
/// are about.
#[allow(clippy::float_cmp, reason = "drawn from the lists")]
fn rows_of(scalar: usize, family: &Family) -> impl Iterator<Item = usize> {
    let alone = |row: usize| [Some(row), None, None, None, None, None];
    let rows = match *family {
        Family::Lattice => alone(0),
        Family::Wild => alone(1),
        Family::AlmostFlat => alone(2),
        Family::Neighbours => alone(3),
        Family::Shaped { sine, scale, offset, needle, place } => {
            let (scaled, moved) = (scale != 0, offset != 0.0);
            let mut first = 5;
            let mut find = |at: Option<usize>, len: usize, counts: bool| {
                let row = at.filter(|_| counts).map(|at| first + at);
                first += len;
                row
            };
            let sines = find(SINES.iter().position(|s| *s == sine), SINES.len(), !scaled && !moved);
            let offsets = find(OFFSETS.iter().position(|o| *o == offset), OFFSETS.len(), !scaled);
            let [double, single] = [0, 1].map(|of| {
                let scales = SPANS[of].1.scales;
                find(scales.iter().position(|s| *s == scale), scales.len(), !moved && of == scalar)
            });
            let places = find(PLACES.iter().position(|p| *p == place), PLACES.len(), !scaled && !moved);
            [(needle && !scaled && !moved).then_some(4), sines, offsets, double, single, places]
        }
    };
    rows.into_iter().flatten()
}

impl Findings {
    fn new() -> Self {
        let rows = labels().into_iter().map(|label| (label, [Tally::default(); SUBJECTS])).collect();
        Self { rows, checked: [0; 2], invariant: 0, rational: 0, broken: 0, shown: Vec::new(), examples: Vec::new() }
    }

    fn merge(&mut self, other: Self) {
        for ((_, own), (_, others)) in self.rows.iter_mut().zip(other.rows) {
            own.iter_mut().zip(&others).for_each(|(own, other)| own.merge(other));
        }
        self.checked = [self.checked[0] + other.checked[0], self.checked[1] + other.checked[1]];
        self.invariant += other.invariant;
        self.rational += other.rational;
        self.broken += other.broken;
        self.shown.extend(other.shown);
        self.shown.truncate(SHOWN);
        other.examples.into_iter().for_each(|example| self.keep(example));
    }

    /// Keeps the example if it is the plainest of its kind.
    fn keep(&mut self, example: Example) {
        match self.examples.iter_mut().find(|e| (e.rival, e.kind) == (example.rival, example.kind)) {
            Some(known) if example.plainness() < known.plainness() => *known = example,
            Some(_) => {}
            None => self.examples.push(example),
        }
    }

    /// A case in the range of a scalar, and what ours says of it.
    fn check(&mut self, rng: &mut impl Rng, scalar: usize) -> Case {
        let case = families::case_in(rng, &SPANS[scalar].1);
        let checked = catch(|| Ok(if scalar == 0 { judged::<f64>(rng, &case) } else { judged::<f32>(rng, &case) }));
        match checked {
            Ok(Ok((error, compared))) => {
                self.checked[scalar] += 1;
                self.invariant += compared;
                rows_of(scalar, &case.family).for_each(|row| self.rows[row].1[scalar].add(error));
            }
            Ok(Err(broken)) => self.blame(&case, scalar, &broken.to_string()),
            Err(Absent(panic)) => self.blame(&case, scalar, &panic),
        }
        case
    }

    fn blame(&mut self, case: &Case, scalar: usize, broken: &str) {
        self.broken += 1;
        let scalar = SPANS[scalar].0;
        self.shown.push(format!("{scalar}: {broken}; {}: {:?} {:?}", case.family, case.query, case.vertices));
        self.shown.truncate(SHOWN);
    }

    /// Rivals of the scalar of a case.
    fn rivals(&mut self, case: &Case, scalar: usize) {
        for (i, rival) in RIVALS.iter().enumerate().filter(|(_, rival)| rival.single == (scalar == 1)) {
            let Some(said) = rival.ask(case.query, &case.vertices) else { continue };
            for row in rows_of(scalar, &case.family) {
                let tally = &mut self.rows[row].1[2 + i];
                match said {
                    Said::Error(error) => tally.add(error),
                    Said::Panic => tally.panicked += 1,
                }
            }
            if let Some(kind) = said.kind() {
                self.keep(Example { rival: i, kind, query: case.query, vertices: case.vertices.clone() });
            }
        }
    }
}

/// The error of ours, and how many other answers it was compared to.
fn judged<T: Real>(rng: &mut impl Rng, case: &Case) -> Result<(f64, u64), Violation> {
    let of = |v: [f64; 3]| v.map(T::of_f64);
    let (query, vertices) = (of(case.query), case.vertices.iter().map(|v| of(*v)).collect::<Vec<_>>());
    let found = contract::answer(query, &vertices);
    let error = contract::check(case.query, &case.vertices, &found)?;
    Ok((error, contract::check_invariance(rng, query, &vertices, &found)?))
}

/// Checks so many answers of ours at least, half of them in each scalar, on all threads.
pub(super) fn run(cases: u64, seed: u64) -> Findings {
    let all = Mutex::new(Findings::new());
    let (next, done) = (AtomicU64::new(0), AtomicU64::new(0));
    let work = || {
        let mut own = Findings::new();
        let before = rational_distances();
        while done.load(Ordering::Relaxed) < cases {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            let mut rng = p2m_testkit::rng("extreme primitives", (seed << 32) + chunk);
            for i in 0..CHUNK {
                for scalar in [0, 1] {
                    let case = own.check(&mut rng, scalar);
                    if i % RIVAL_EVERY == 0 {
                        own.rivals(&case, scalar);
                    }
                }
            }
            let so_far = done.fetch_add(2 * CHUNK, Ordering::Relaxed);
            progress(so_far, 2 * CHUNK, cases);
        }
        own.rational = rational_distances() - before;
        all.lock().expect("no thread panicked").merge(own);
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, Into::into) {
            scope.spawn(work);
        }
    });
    all.into_inner().expect("no thread panicked")
}

/// A line for every twentieth.
fn progress(before: u64, more: u64, all: u64) {
    let part = |count: u64| count.min(all) * 20 / all.max(1);
    if part(before + more) > part(before) {
        eprintln!("{} % of {all} answers about primitives", part(before + more) * 5);
    }
}
