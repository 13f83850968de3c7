//! Small scenes of hard families: every backend, both scalars and rivals.

use super::example::{Example, judged};
use super::rival::Kind;
use super::tally::Tally;
use crate::backends::ALL;
use crate::contender::{Absent, Answer, Backend, Ready, ScalarKind};
use crate::queries::Queries;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_core::kernel::ERROR_CONSTANT;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, PrimitiveId, PrimitiveSet, Real, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_testkit::extremes::Extreme;
use p2m_testkit::truth::{Truth, rational_distances};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Who is asked.
const NAMES: &str = "brute,aabb,aabb-avx2,aabb-portable,kdop-6,kdop-14,kdop-18,kdop-26,octree,octree-portable,p2m,p2m-avx2,p2m-kiddo,p2m-batch,\
                     rstar,parry-tree,brute-f32,aabb-f32,kdop-14-f32,octree-f32,p2m-f32,parry3d,parry3d-f64,bvh";
/// Queries of a scene.
const QUERIES: usize = 64;
/// Broken promises that are kept to be shown.
const SHOWN: usize = 20;

/// Those of the list that this processor can run.
pub(super) fn subjects() -> Vec<&'static Backend> {
    NAMES.split(',').map(|name| ALL.iter().find(|b| b.name == name).expect("a name of the list")).collect()
}

/// Everything that was found.
#[derive(Default)]
pub(super) struct Findings {
    /// Of each family, the tallies of all subjects.
    pub(super) rows: Vec<Vec<Tally>>,
    /// Answers of our indexes that were held against those of brute force.
    pub(super) checked: u64,
    /// Queries whose answer in brute force was held against the truth, for every primitive.
    pub(super) queries: u64,
    /// Distances that needed rational arithmetic.
    pub(super) rational: u64,
    /// Promises of ours that were broken: how many, and some of them in words.
    pub(super) broken: u64,
    pub(super) shown: Vec<String>,
    /// Why subjects were left out, and of how many scenes.
    pub(super) absent: Vec<(String, u64)>,
    /// Of each family, how many scenes there were in f64, and of how many the octree and the P2M index have cells.
    pub(super) cells: Vec<[u64; 3]>,
    /// What rivals get wrong, each kind in the smallest of the scenes.
    pub(super) examples: Vec<Example>,
}

impl Findings {
    fn new() -> Self {
        let rows = vec![vec![Tally::default(); subjects().len()]; Extreme::ALL.len()];
        Self { rows, cells: vec![[0; 3]; Extreme::ALL.len()], ..Self::default() }
    }

    fn merge(&mut self, other: Self) {
        for (own, others) in self.rows.iter_mut().zip(other.rows) {
            own.iter_mut().zip(&others).for_each(|(own, other)| own.merge(other));
        }
        self.checked += other.checked;
        self.queries += other.queries;
        self.rational += other.rational;
        self.broken += other.broken;
        self.shown.extend(other.shown);
        self.shown.truncate(SHOWN);
        for (own, others) in self.cells.iter_mut().zip(other.cells) {
            *own = std::array::from_fn(|k| own[k] + others[k]);
        }
        other.examples.into_iter().for_each(|example| self.keep(example));
        other.absent.into_iter().for_each(|(why, count)| self.leave_out(why, count));
    }

    /// Keeps the example if it is the plainest of its kind.
    fn keep(&mut self, example: Example) {
        match self.examples.iter_mut().find(|e| (e.rival, e.kind) == (example.rival, example.kind)) {
            Some(known) if example.plainness() < known.plainness() => *known = example,
            Some(_) => {}
            None => self.examples.push(example),
        }
    }

    fn leave_out(&mut self, why: String, count: u64) {
        match self.absent.iter_mut().find(|(known, _)| *known == why) {
            Some((_, so_far)) => *so_far += count,
            None => self.absent.push((why, count)),
        }
    }

    fn blame(&mut self, what: impl FnOnce() -> String) {
        self.broken += 1;
        if self.shown.len() < SHOWN {
            self.shown.push(what());
        }
    }
}

/// The scene in one scalar, and its answers.
struct Side {
    /// Of each primitive, in f64.
    vertices: Vec<Vec<[f64; 3]>>,
    queries: Vec<[f64; 3]>,
    /// Of brute force.
    answers: Vec<Answer>,
    /// How far they are off, in u M.
    errors: Vec<f64>,
    bits: u32,
    eta: f64,
}

impl Side {
    /// Asks brute force and holds it against the truth: N1 and N7 for every primitive.
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
            let own = found.primitive.index();
            let mut fail = |what: &str| {
                findings.blame(|| format!("{name}, f{bits}: {what}; {found:?} at {q:?} of {vertices:?}"));
            };
            if distance.is_nan() || lower.is_nan() {
                fail("N6, NaN");
            }
            // What is beyond the range is right if every primitive is, which is looked at below.
            let error = if distance == f64::INFINITY { 0.0 } else { truths[own].error(distance, bits, eta) };
            // NaN is not at most anything.
            let is_small = error <= ERROR_CONSTANT;
            if !is_small {
                fail("N1, from the primitive that is named");
            }
            errors.push(error);
            for truth in &truths {
                // No primitive is nearer by more than its own rounding.
                let error = truth.of_reach(ERROR_CONSTANT * 2f64.powi(-bits.cast_signed()) * (1.0 + 1e-9)) + eta;
                let least = if distance < f64::INFINITY { (distance - error).next_down() } else { limit };
                if !truth.is_at_least(least) {
                    fail("N1, N2: another primitive is nearer");
                }
                if !truth.is_at_least(lower) {
                    fail("N7");
                }
            }
            answers.push(Answer { distance, id: crate::backends::id_of(found.primitive) });
        }
        findings.queries += queries.len() as u64;
        Self { vertices, queries: queries.iter().map(wide).collect(), answers, errors, bits, eta }
    }

    /// The error of a rival's answer, in u M, and whether it names another primitive beyond rounding. Nearest is the primitive of
    /// ours, which is so but for its own rounding.
    fn judge(&self, at: usize, answer: &Answer, names: bool) -> (f64, bool) {
        let nearest = self.answers[at].id as usize;
        judged(self.queries[at], &self.vertices, nearest, answer, names, (self.bits, self.eta))
    }

    fn example(&self, backend: &'static Backend, kind: Kind, at: usize) -> Example {
        Example { rival: backend.name, kind, query: self.queries[at], vertices: self.vertices.clone() }
    }
}

/// Every subject about so many scenes of each family, on all threads.
pub(super) fn run(scenes: u64, seed: u64) -> Findings {
    let all = Mutex::new(Findings::new());
    let next = AtomicU64::new(0);
    let jobs = scenes * Extreme::ALL.len() as u64;
    let work = || {
        let mut own = Findings::new();
        let before = rational_distances();
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            if job >= jobs {
                break;
            }
            let row = usize::try_from(job % Extreme::ALL.len() as u64).expect("few families");
            let family = Extreme::ALL[row];
            let case = (seed << 32) + job / Extreme::ALL.len() as u64;
            let (soup, queries) = family.generate(&mut p2m_testkit::rng(family.name(), case), QUERIES);
            check(row, &format!("{} {case}", family.name()), soup, queries, &mut own);
            if (job + 1) * 20 / jobs > job * 20 / jobs {
                eprintln!("{} % of {jobs} scenes", (job + 1) * 20 / jobs * 5);
            }
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

fn check(row: usize, name: &str, soup: Soup<f64>, queries: Vec<Point3<f64>>, findings: &mut Findings) {
    let triangles_only = soup.triangles().len() == soup.len();
    let scene = Scene::new(name.to_owned(), soup).expect("it has primitives");
    // Those that f32 has not are not asked about in f32.
    let queries: Vec<_> = match scene.single {
        Some(_) => queries.into_iter().filter(|q| q.iter().all(|x| f32::of_f64(*x).is_finite())).collect(),
        None => queries,
    };
    let queries = Queries::new(queries);
    let double = Side::new(&scene.double, queries.all().double, findings, name);
    // What is too small for f32 is no scene in it.
    let is_there = |soup: &&Soup<f32>| soup.positions().iter().any(|p| p.iter().any(|x| *x != 0.0));
    let single = scene.single.as_ref().filter(is_there);
    let single = single.map(|soup| Side::new(soup, queries.all().single, findings, name));
    let has_cells = [
        OctreeIndex::build(&scene.double, &Default::default()).is_ok_and(|index| {
            let report = index.report();
            report.lists + report.singles > 0
        }),
        P2mIndex::build(&scene.double, &Default::default()).is_ok_and(|index| index.report().lists > 0),
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
        let built = crate::contender::catch(|| ((backend.prepare)(&scene)?.build)());
        let answers = built.and_then(|index| {
            if backend.ours && answers(&index, &bad)?.iter().any(|answer| !answer.is_none()) {
                findings.blame(|| format!("N6, {} of {name}: an answer to what is no place", backend.name));
            }
            answers(&index, &queries)
        });
        match answers {
            Ok(answers) if backend.ours => hold(row, column, backend, side, &answers, name, findings),
            Ok(answers) => {
                let names = triangles_only && backend.name.starts_with("parry3d");
                for (at, answer) in answers.iter().enumerate() {
                    let (error, wrong) = side.judge(at, answer, names);
                    let tally = &mut findings.rows[row][column];
                    tally.add(error);
                    tally.wrong_ids += u64::from(wrong);
                    let wrong = wrong.then_some(Kind::WrongPrimitive);
                    for kind in Kind::of_error(error).into_iter().chain(wrong) {
                        findings.keep(side.example(backend, kind, at));
                    }
                }
            }
            Err(Absent(why)) if backend.ours && !why.starts_with("this processor") => {
                findings.blame(|| format!("{} of {name}: {why}", backend.name));
            }
            Err(Absent(why)) if why == "it panicked" => {
                findings.rows[row][column].panicked += side.queries.len() as u64;
                // One by one, to know which.
                let one = (0..side.queries.len()).map(|at| side.example(backend, Kind::Panic, at));
                if let Some(example) = one.into_iter().find(Example::is_confirmed) {
                    findings.keep(example);
                }
                findings.leave_out(format!("`{}` panics", backend.name), 1);
            }
            Err(Absent(why)) => findings.leave_out(format!("`{}`: {why}", backend.name), 1),
        }
    }
}

fn answers(index: &Ready<'_>, queries: &Queries) -> Result<Vec<Answer>, Absent> {
    let mut answers = vec![Answer::NONE; queries.len()];
    index.answer(queries.all(), &mut answers)?;
    Ok(answers)
}

/// N3: the same bits as brute force.
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
