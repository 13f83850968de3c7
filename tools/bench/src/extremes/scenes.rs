//! Checks small scenes of hard families with every backend, both scalars and external libraries.

use super::counts::{Counts, ROUNDING};
use super::threads;
use crate::backend::{Answer, Backend, BoxedIndex, ScalarKind, Unavailable};
use crate::backends::{ALL, YARDSTICK};
use crate::queries::Queries;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_backends::BackendEntry;
use p2m_core::kernel::ERROR_CONSTANT;
use p2m_core::{BruteForce, ClosestPoint, PrimitiveId, PrimitiveSet, Real, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_testkit::extremes::Extreme;
use p2m_testkit::truth::Truth;
use std::collections::BTreeMap;

/// The names of the settings and external libraries that are checked besides all registered backends.
const SETTINGS: [&str; 13] = [
    "aabb-avx2",
    "aabb-portable",
    "kdop-6",
    "kdop-18",
    "kdop-26",
    "octree-portable",
    "p2m-avx2",
    "p2m-kiddo",
    "p2m-batch",
    "rstar",
    "parry-tree",
    "parry3d-f64",
    "bvh",
];
/// The number of queries of a scene.
const QUERIES: usize = 64;
/// The largest number of broken promises that are shown.
const SHOWN: usize = 20;

/// Returns the backends that are checked, in the order of the list of all.
pub(super) fn subjects() -> Vec<&'static Backend> {
    let is_registered = |backend: &Backend| BackendEntry::find(backend.name.trim_end_matches("-f32")).is_some();
    ALL.iter().filter(|b| is_registered(b) || b.name == YARDSTICK || SETTINGS.contains(&b.name)).collect()
}

/// The results of all checks.
#[derive(Default)]
pub(super) struct Findings {
    /// The counts of all subjects, for each family.
    pub(super) rows: Vec<Vec<Counts>>,
    /// The number of answers of our indexes that were compared with those of brute force.
    pub(super) checked: u64,
    /// The number of queries for which brute force was compared with the true distances of every primitive.
    pub(super) queries: u64,
    /// The number of distances that needed rational arithmetic.
    pub(super) rational: u64,
    /// The number of promises that our backends broke.
    pub(super) broken: u64,
    pub(super) shown: Vec<String>,
    /// The reasons why subjects were left out, with the number of scenes.
    pub(super) absent: BTreeMap<String, u64>,
    /// For each family: the number of scenes in f64, and of those in which the octree and the P2M index have cells.
    pub(super) cells: Vec<[u64; 3]>,
}

impl threads::Findings for Findings {
    fn new() -> Self {
        let rows = vec![vec![Counts::default(); subjects().len()]; Extreme::ALL.len()];
        Self { rows, cells: vec![[0; 3]; Extreme::ALL.len()], ..Self::default() }
    }

    fn merge(&mut self, other: Self, rational: u64) {
        for (results, others) in self.rows.iter_mut().zip(other.rows) {
            results.iter_mut().zip(&others).for_each(|(results, other)| results.merge(other));
        }
        self.checked += other.checked;
        self.queries += other.queries;
        self.rational += rational;
        self.broken += other.broken;
        self.shown.extend(other.shown);
        self.shown.truncate(SHOWN);
        for (results, others) in self.cells.iter_mut().zip(other.cells) {
            *results = std::array::from_fn(|k| results[k] + others[k]);
        }
        other.absent.into_iter().for_each(|(why, count)| self.leave_out(why, count));
    }
}

impl Findings {
    fn leave_out(&mut self, why: String, count: u64) {
        *self.absent.entry(why).or_default() += count;
    }

    fn blame(&mut self, what: impl FnOnce() -> String) {
        self.broken += 1;
        if self.shown.len() < SHOWN {
            self.shown.push(what());
        }
    }
}

/// A scene in one scalar, with its true distances and the answers of brute force.
struct Side {
    /// The vertices of each primitive, in f64.
    vertices: Vec<Vec<[f64; 3]>>,
    queries: Vec<[f64; 3]>,
    /// The answers of brute force.
    answers: Vec<Answer>,
    /// The errors of brute force, in u M.
    errors: Vec<f64>,
    bits: u32,
    eta: f64,
}

impl Side {
    /// Compares brute force with the true distances: N1 and N7 for every primitive.
    fn new<T: Real>(soup: &Soup<T>, queries: &[Point3<T>], findings: &mut Findings, name: &str) -> Self {
        let wide = |p: &Point3<T>| -> [f64; 3] { p.map(Real::to_f64).coords.into() };
        let vertices: Vec<Vec<[f64; 3]>> =
            (0..soup.len()).map(|i| soup.get(PrimitiveId::new(i)).vertices().iter().map(wide).collect()).collect();
        let (bits, eta) = (if T::UNIT_ROUNDOFF > f64::UNIT_ROUNDOFF { 24 } else { 53 }, T::SMALLEST_SUBNORMAL);
        let limit = if bits == 24 { f64::from(f32::MAX) } else { f64::MAX };
        let brute = BruteForce::new(soup).expect("a soup is valid");
        let (mut answers, mut errors) = (Vec::new(), Vec::new());
        for query in queries {
            let q = wide(query);
            let found = brute.closest_point(query).expect("there are primitives");
            let (distance, lower) = (found.distance.to_f64(), found.lower_bound.to_f64());
            let truths: Vec<Truth<'_>> = vertices.iter().map(|v| Truth::new(q, v)).collect();
            let results = found.primitive.index();
            let mut fail = |what: &str| {
                findings.blame(|| format!("{name}, f{bits}: {what}; {found:?} at {q:?} of {vertices:?}"));
            };
            if distance.is_nan() || lower.is_nan() {
                fail("N6, NaN");
            }
            // An infinite distance is right if all primitives are out of range, which is checked below.
            let error = if distance == f64::INFINITY { 0.0 } else { truths[results].error(distance, bits, eta) };
            // A NaN error compares false, so it is not counted as small.
            let is_small = error <= ERROR_CONSTANT;
            if !is_small {
                fail("N1, from the primitive that is named");
            }
            errors.push(error);
            for truth in &truths {
                // No primitive may be nearer by more than the rounding of its distance.
                let error = truth
                    .times_max_vertex_distance(ERROR_CONSTANT * 2f64.powi(-bits.cast_signed()) * (1.0 + 1e-9))
                    + eta;
                let least = if distance < f64::INFINITY { (distance - error).next_down() } else { limit };
                if !truth.is_at_least(least) {
                    fail("N1, N2: another primitive is nearer");
                }
                if !truth.is_at_least(lower) {
                    fail("N7");
                }
            }
            answers.push(Answer { distance, id: crate::our_indexes::id_of(found.primitive) });
        }
        findings.queries += queries.len() as u64;
        Self { vertices, queries: queries.iter().map(wide).collect(), answers, errors, bits, eta }
    }

    /// Returns the error of an external library's answer in u M, and whether it names a primitive that is not the
    /// nearest beyond rounding, if ids are to be checked. The reference is our nearest primitive, which is right apart
    /// from its rounding.
    fn judge(&self, at: usize, answer: &Answer, has_ids: bool) -> (f64, bool) {
        let Self { bits, eta, ref vertices, .. } = *self;
        let (query, nearest) = (self.queries[at], self.answers[at].id as usize);
        let truth = Truth::new(query, &vertices[nearest]);
        let limit = if bits == 24 { f64::from(f32::MAX) } else { f64::MAX };
        let beyond = answer.distance == f64::INFINITY && truth.is_at_least(limit);
        let error = if beyond { 0.0 } else { truth.error(answer.distance, bits, eta) };
        let named = vertices.get(answer.id as usize).filter(|_| has_ids && answer.id as usize != nearest && !beyond);
        let wrong = named.is_some_and(|named| {
            // The distance of the nearest primitive may be above the true one by the rounding of both.
            let rounding = ROUNDING * 2f64.powi(-bits.cast_signed());
            let least = truth.exact().length()[0] + truth.times_max_vertex_distance(rounding);
            let theirs = Truth::new(query, named);
            theirs.is_at_least(least + theirs.times_max_vertex_distance(rounding) + eta)
        });
        (error, wrong)
    }
}

/// Checks every subject on `scenes` scenes of each family, on all threads.
pub(super) fn run(scenes: u64, seed: u64) -> Findings {
    let families = Extreme::ALL.len() as u64;
    threads::run("scenes", scenes * families, |job, results| {
        let row = usize::try_from(job % families).expect("few families");
        let (family, case) = (Extreme::ALL[row], (seed << 32) + job / families);
        let (soup, queries) = family.generate(&mut p2m_testkit::rng(family.name(), case), QUERIES);
        check(row, &format!("{} {case}", family.name()), soup, queries, results);
    })
}

fn check(row: usize, name: &str, soup: Soup<f64>, queries: Vec<Point3<f64>>, findings: &mut Findings) {
    let triangles_only = soup.triangles().len() == soup.len();
    let scene = Scene::new(name.to_owned(), soup).expect("it has primitives");
    // Queries that overflow f32 are left out in f32.
    let queries: Vec<_> = match scene.single {
        Some(_) => queries.into_iter().filter(|q| q.iter().all(|x| f32::round_from_f64(*x).is_finite())).collect(),
        None => queries,
    };
    let queries = Queries::new(queries);
    let double = Side::new(&*scene.double, queries.all().double, findings, name);
    // A scene whose coordinates all underflow to zero is not checked in f32.
    let is_there = |soup: &&Soup<f32>| soup.positions().iter().any(|p| p.iter().any(|x| *x != 0.0));
    let single = scene.single.as_deref().filter(is_there);
    let single = single.map(|soup| Side::new(soup, queries.all().single, findings, name));
    let has_cells = [
        OctreeIndex::new(&*scene.double).is_ok_and(|index| {
            let report = index.report();
            report.list_cells + report.single_cells > 0
        }),
        P2mIndex::new(&*scene.double).is_ok_and(|index| index.report().list_cells > 0),
    ];
    let cells = &mut findings.cells[row];
    *cells = [cells[0] + 1, cells[1] + u64::from(has_cells[0]), cells[2] + u64::from(has_cells[1])];
    let at = |axis: usize, x: f64| Point3::from(std::array::from_fn::<_, 3, _>(|k| if k == axis { x } else { 0.0 }));
    let nowhere = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let bad = Queries::new((0..3).flat_map(|axis| nowhere.map(|x| at(axis, x))).collect());
    for (column, backend) in subjects().into_iter().enumerate() {
        let side = match backend.scalar {
            ScalarKind::Double => Some(&double),
            ScalarKind::Single => single.as_ref(),
        };
        let Some(side) = side else { continue };
        let built = backend.build(&scene);
        let answers = built.and_then(|index| {
            if backend.is_ours && answers(&index, &bad)?.iter().any(|answer| !answer.is_none()) {
                findings.blame(|| format!("N6, {} of {name}: an answer to what is no place", backend.name));
            }
            answers(&index, &queries)
        });
        match answers {
            Ok(answers) if backend.is_ours => hold(row, column, backend, side, &answers, name, findings),
            Ok(answers) => {
                let has_ids = triangles_only && backend.name.starts_with("parry3d");
                for (at, answer) in answers.iter().enumerate() {
                    let (error, wrong) = side.judge(at, answer, has_ids);
                    let counts = &mut findings.rows[row][column];
                    counts.add(error);
                    counts.wrong_ids += u64::from(wrong);
                }
            }
            Err(Unavailable(why)) if backend.is_ours && !why.starts_with("this processor") => {
                findings.blame(|| format!("{} of {name}: {why}", backend.name));
            }
            Err(Unavailable(why)) if why == "it panicked" => {
                findings.rows[row][column].panicked += side.queries.len() as u64;
                findings.leave_out(format!("`{}` panics", backend.name), 1);
            }
            Err(Unavailable(why)) => findings.leave_out(format!("`{}`: {why}", backend.name), 1),
        }
    }
}

fn answers(index: &BoxedIndex, queries: &Queries) -> Result<Vec<Answer>, Unavailable> {
    let mut answers = vec![Answer::NONE; queries.len()];
    index.answer(queries.all(), &mut answers)?;
    Ok(answers)
}

/// Checks N3: the answers have to be the same bits as those of brute force.
fn hold(
    row: usize,
    column: usize,
    backend: &Backend,
    side: &Side,
    answers: &[Answer],
    name: &str,
    findings: &mut Findings,
) {
    for (at, (answer, expected)) in answers.iter().zip(&side.answers).enumerate() {
        findings.checked += 1;
        let same = answer.same_distance(expected) && answer.id == expected.id;
        if !same {
            findings.blame(|| {
                format!("N3, {} of {name}: {answer:?}, not {expected:?} at {:?}", backend.name, side.queries[at])
            });
        }
        findings.rows[row][column].add(side.errors[at]);
    }
}
