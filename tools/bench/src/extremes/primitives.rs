//! Checks isolated primitives on every clause of the contract that one primitive can break.

use super::counts::Counts;
use super::external::{CallResult, LIBRARIES};
use super::threads;
use crate::backend::{Unavailable, catch};
use p2m_core::Real;
use p2m_testkit::contract::{self, Violation};
use p2m_testkit::families::{self, Case, Family, OFFSETS, SINES, Span};
use rand::Rng;

/// The number of cases of a scalar that a thread takes at a time.
const CHUNK: u64 = 10_000;
/// External libraries answer one case out of this many.
const CASES_PER_LIBRARY_CASE: u64 = 20;
/// Our scalars, and the ranges of their cases.
const SPANS: [(&str, Span); 2] = [("f64", Span::F64), ("f32", Span::F32)];
/// The number of subjects: our kernel in both scalars, and the external libraries.
const SUBJECTS: usize = 2 + LIBRARIES.len();
/// The largest number of broken promises that are shown.
const SHOWN: usize = 20;

/// The results of all checks.
pub(super) struct Findings {
    /// The names of the rows, each with the counts of all subjects.
    pub(super) rows: Vec<(String, [Counts; SUBJECTS])>,
    /// The numbers of our answers in f64 and in f32 that were compared with the true distance.
    pub(super) checked: [u64; 2],
    /// The number of our answers that were compared with those for another order of vertices and another scale.
    pub(super) invariant: u64,
    /// The number of distances that needed rational arithmetic.
    pub(super) rational: u64,
    /// The number of promises that our kernel broke.
    pub(super) broken: u64,
    pub(super) shown: Vec<String>,
}

/// Returns the names of the rows; [`rows_of`] knows their order.
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
    labels.extend(PLACES.iter().map(|position| format!("query {position}")));
    labels
}

/// The names of the positions of query points.
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

/// Returns the rows to which a case of a scalar belongs. The rows of sines and of query positions have cases of
/// ordinary scale and position only, so that a row shows the effect of one parameter.
#[allow(clippy::float_cmp, reason = "drawn from the lists")]
fn rows_of(scalar: usize, family: &Family) -> impl Iterator<Item = usize> {
    let alone = |row: usize| [Some(row), None, None, None, None, None];
    let rows = match *family {
        Family::Lattice => alone(0),
        Family::Wild => alone(1),
        Family::AlmostFlat => alone(2),
        Family::Neighbours => alone(3),
        Family::Shaped { sine, scale, offset, needle, query_position } => {
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
            let places = find(PLACES.iter().position(|p| *p == query_position), PLACES.len(), !scaled && !moved);
            [(needle && !scaled && !moved).then_some(4), sines, offsets, double, single, places]
        }
    };
    rows.into_iter().flatten()
}

impl threads::Findings for Findings {
    fn new() -> Self {
        let rows = labels().into_iter().map(|label| (label, [Counts::default(); SUBJECTS])).collect();
        Self { rows, checked: [0; 2], invariant: 0, rational: 0, broken: 0, shown: Vec::new() }
    }

    fn merge(&mut self, other: Self, rational: u64) {
        for ((_, results), (_, others)) in self.rows.iter_mut().zip(other.rows) {
            results.iter_mut().zip(&others).for_each(|(results, other)| results.merge(other));
        }
        self.checked = [self.checked[0] + other.checked[0], self.checked[1] + other.checked[1]];
        self.invariant += other.invariant;
        self.rational += rational;
        self.broken += other.broken;
        self.shown.extend(other.shown);
        self.shown.truncate(SHOWN);
    }
}

impl Findings {
    /// Generates a case in the range of a scalar and checks our answer.
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
            Err(Unavailable(panic)) => self.blame(&case, scalar, &panic),
        }
        case
    }

    fn blame(&mut self, case: &Case, scalar: usize, broken: &str) {
        self.broken += 1;
        let scalar = SPANS[scalar].0;
        self.shown.push(format!("{scalar}: {broken}; {}: {:?} {:?}", case.family, case.query, case.vertices));
        self.shown.truncate(SHOWN);
    }

    /// Checks the external libraries that have the scalar of a case.
    fn check_libraries(&mut self, case: &Case, scalar: usize) {
        for (i, library) in LIBRARIES.iter().enumerate().filter(|(_, library)| library.single == (scalar == 1)) {
            let Some(result) = library.check(case.query, &case.vertices) else { continue };
            for row in rows_of(scalar, &case.family) {
                let counts = &mut self.rows[row].1[2 + i];
                match result {
                    CallResult::Error(error) => counts.add(error),
                    CallResult::Panic => counts.panicked += 1,
                }
            }
        }
    }
}

/// Returns the error of our answer, and the number of other answers that it was compared with.
fn judged<T: Real>(rng: &mut impl Rng, case: &Case) -> Result<(f64, u64), Violation> {
    let of = |v: [f64; 3]| v.map(T::round_from_f64);
    let (query, vertices) = (of(case.query), case.vertices.iter().map(|v| of(*v)).collect::<Vec<_>>());
    let found = contract::answer(query, &vertices);
    let error = contract::check(case.query, &case.vertices, &found)?;
    Ok((error, contract::check_invariance(rng, query, &vertices, &found)?))
}

/// Checks at least `cases` answers of ours, half of them in each scalar, on all threads.
pub(super) fn run(cases: u64, seed: u64) -> Findings {
    threads::run("answers about primitives", cases.div_ceil(2 * CHUNK), |chunk, results: &mut Findings| {
        let mut rng = p2m_testkit::rng("extreme primitives", (seed << 32) + chunk);
        for i in 0..CHUNK {
            for scalar in [0, 1] {
                let case = results.check(&mut rng, scalar);
                if i % CASES_PER_LIBRARY_CASE == 0 {
                    results.check_libraries(&case, scalar);
                }
            }
        }
    })
}
