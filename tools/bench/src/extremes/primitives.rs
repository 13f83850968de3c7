//! Checks of isolated primitives, for every clause of the contract that a single primitive can break.

use super::counts::{Broken, Counts, merge_all};
use super::external::LIBRARIES;
use crate::backend::{Unavailable, catch};
use p2m_core::Real;
use p2m_testkit::contract::{self, Violation};
use p2m_testkit::families::{self, Case, Family, OFFSETS, SINES, Span};
use p2m_testkit::truth::rational_distances;
use rand::Rng;
use std::sync::LazyLock;

/// The number of cases of a scalar that a thread takes at a time.
const CHUNK: u64 = 10_000;
/// The number of cases for each case that external libraries answer.
const CASES_PER_LIBRARY_CASE: u64 = 20;
/// Our scalars, and the ranges of their cases.
const SPANS: [(&str, Span); 2] = [("f64", Span::F64), ("f32", Span::F32)];
/// The number of subjects: our kernel in both scalars, and the external libraries.
const SUBJECTS: usize = 2 + LIBRARIES.len();

/// The results of all checks.
pub(super) struct Findings {
    /// The counters of all subjects in each of the [`ROWS`].
    pub(super) rows: Vec<[Counts; SUBJECTS]>,
    /// The numbers of our answers in f64 and in f32 that were compared with the true distance.
    pub(super) checked: [u64; 2],
    /// The number of our answers that were compared with answers for another order of vertices and another scale.
    pub(super) invariant: u64,
    /// The number of distances that needed rational arithmetic.
    pub(super) rational: u64,
    /// The promises that our kernel broke.
    pub(super) broken: Broken,
}

/// Whether a case of a scalar, given by its number, belongs to a row.
type HasFn = dyn Fn(usize, &Family) -> bool + Send + Sync;

/// A row of the table: its name, and whether a case of a scalar belongs to it.
pub(super) struct Row {
    pub(super) label: String,
    has: Box<HasFn>,
}

impl Row {
    fn new(label: impl Into<String>, has: impl Fn(usize, &Family) -> bool + Send + Sync + 'static) -> Self {
        Self { label: label.into(), has: Box::new(has) }
    }
}

/// The rows of the table. The rows of sines and of query positions have only cases of ordinary scale and position, so
/// that a row shows the effect of one parameter.
#[allow(clippy::float_cmp, reason = "drawn from the lists")]
pub(super) static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    use Family::Shaped;
    let mut rows = vec![
        Row::new("lattice", |_, case| *case == Family::Lattice),
        Row::new("any magnitude", |_, case| *case == Family::Wild),
        Row::new("almost parallel to an axis", |_, case| *case == Family::AlmostFlat),
        Row::new("neighbours of an f32", |_, case| *case == Family::Neighbours),
        Row::new("needles", |_, case| matches!(case, Shaped { needle: true, scale: 0, offset: 0.0, .. })),
    ];
    rows.extend(SINES.map(|of| {
        let has = move |case: &_| matches!(case, Shaped { sine, scale: 0, offset: 0.0, .. } if *sine == of);
        Row::new(format!("sine {of:e}"), move |_, case| has(case))
    }));
    rows.extend(OFFSETS.map(|of| {
        let has = move |case: &_| matches!(case, Shaped { offset, scale: 0, .. } if *offset == of);
        Row::new(format!("offset {of:e}"), move |_, case| has(case))
    }));
    for (at, (name, span)) in SPANS.into_iter().enumerate() {
        rows.extend(span.scales.iter().map(|&of| {
            let has = move |case: &_| matches!(case, Shaped { scale, offset: 0.0, .. } if *scale == of);
            Row::new(format!("scale 2^{of} of {name}"), move |scalar, case| scalar == at && has(case))
        }));
    }
    rows.extend(PLACES.map(|of| {
        let has = move |case: &_| {
            matches!(case, Shaped { query_position, scale: 0, offset: 0.0, .. } if *query_position == of)
        };
        Row::new(format!("query {of}"), move |_, case| has(case))
    }));
    rows
});

/// Returns the indices of the rows to which a case of a scalar belongs.
fn rows_of(scalar: usize, family: &Family) -> impl Iterator<Item = usize> {
    ROWS.iter().enumerate().filter(move |(_, row)| (row.has)(scalar, family)).map(|(index, _)| index)
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

impl Default for Findings {
    fn default() -> Self {
        let rows = vec![Default::default(); ROWS.len()];
        Self { rows, checked: [0; 2], invariant: 0, rational: 0, broken: Broken::default() }
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
                rows_of(scalar, &case.family).for_each(|row| self.rows[row][scalar].add(Some(error)));
            }
            Ok(Err(broken)) => self.blame(&case, scalar, &broken.to_string()),
            Err(Unavailable(panic)) => self.blame(&case, scalar, &panic),
        }
        case
    }

    fn merge(&mut self, other: Self) {
        merge_all(self.rows.as_flattened_mut(), other.rows.as_flattened());
        self.checked = [self.checked[0] + other.checked[0], self.checked[1] + other.checked[1]];
        self.invariant += other.invariant;
        self.rational += other.rational;
        self.broken.merge(other.broken);
    }

    fn blame(&mut self, case: &Case, scalar: usize, broken: &str) {
        let scalar = SPANS[scalar].0;
        self.broken.add(|| format!("{scalar}: {broken}; {}: {:?} {:?}", case.family, case.query, case.vertices));
    }

    /// Checks the external libraries that have the scalar and the primitive of a case.
    fn check_libraries(&mut self, case: &Case, scalar: usize) {
        for (i, library) in LIBRARIES.iter().enumerate() {
            if library.scalar == scalar && library.has(case.vertices.len()) {
                let error = library.error(case.query, &case.vertices);
                rows_of(scalar, &case.family).for_each(|row| self.rows[row][2 + i].add(error));
            }
        }
    }
}

/// Returns the error of our answer, and the number of further answers that it was compared with.
fn judged<T: Real>(rng: &mut impl Rng, case: &Case) -> Result<(f64, u64), Violation> {
    let of = |v: [f64; 3]| v.map(T::round_from_f64);
    let (query, vertices) = (of(case.query), case.vertices.iter().map(|v| of(*v)).collect::<Vec<_>>());
    let found = contract::answer(query, &vertices);
    let error = contract::check(case.query, &case.vertices, &found)?;
    Ok((error, contract::check_invariance(rng, query, &vertices, &found)?))
}

/// Checks at least `cases` of our answers, half of them in each scalar, on all threads.
pub(super) fn run(cases: u64, seed: u64) -> Findings {
    let check = |chunk: u64, found: &mut Findings| {
        let mut rng = p2m_testkit::rng("extreme primitives", (seed << 32) + chunk);
        let before = rational_distances();
        for i in 0..CHUNK {
            for scalar in [0, 1] {
                let case = found.check(&mut rng, scalar);
                if i % CASES_PER_LIBRARY_CASE == 0 {
                    found.check_libraries(&case, scalar);
                }
            }
        }
        found.rational += rational_distances() - before;
    };
    super::on_all_threads("answers about primitives", cases.div_ceil(2 * CHUNK), check, Findings::merge)
}
