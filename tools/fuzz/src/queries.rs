//! Checks of closest points of scenes from bytes: every backend is compared with brute force, bit for bit, and with
//! rational arithmetic.
//!
//! The first byte selects the question, the second one the scalar, and the next ones a backend. Then come the scene and
//! up to four queries.

use super::answers::{self, QUESTIONS};
use super::backends::{index, tree};
use super::boxes;
use super::bytes::Bytes;
use super::scene::SceneDraft;
use super::subject::Subject;
use nalgebra::Point3;
use p2m::{AabbTree, BruteForce, BuildError, Real, Soup};
use p2m_testkit::near_check;
use p2m_testkit::scenes::{narrow, to_f32};

/// The part of the library that an input has reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Reached {
    /// The mode of the scene, the backend, and the question.
    Answers(&'static str, &'static str, &'static str),
    /// The scene was refused, as it has to be.
    Refused,
}

struct Input<'a> {
    question: usize,
    is_single: bool,
    backend: Bytes<'a>,
    draft: SceneDraft,
    queries: Vec<Point3<f64>>,
    seed: u64,
}

impl<'a> Input<'a> {
    fn new(input: &'a [u8]) -> Self {
        let mut bytes = Bytes::new(input);
        let (question, is_single) = (bytes.below(QUESTIONS.len()), bytes.byte() % 4 == 1);
        let backend = Bytes::new(bytes.take(3));
        let seed = u64::from(bytes.byte());
        let draft = SceneDraft::new(&mut bytes, 40);
        let queries = (0..=bytes.below(4)).map(|_| draft.query(&mut bytes)).collect();
        Self { question, is_single, backend, draft, queries, seed }
    }
}

/// Formats the question, the scene and the queries of an input.
#[must_use]
pub fn describe(input: &[u8]) -> String {
    let Input { question, draft, queries, .. } = Input::new(input);
    format!("question {}\n{}\nqueries {queries:?}", QUESTIONS[question], draft.describe())
}

/// Runs the check of an input.
///
/// # Panics
/// Panics if an answer is wrong.
pub fn check(input: &[u8]) -> Reached {
    let input = Input::new(input);
    let Ok(soup) = input.draft.soup() else {
        check_build_error(&input.draft);
        return Reached::Refused;
    };
    match narrow(&soup).filter(|_| input.is_single) {
        Some(single) => check_in(input, &single, to_f32),
        None => check_in(input, &soup, |query| query),
    }
}

fn check_in<T: Real>(mut input: Input<'_>, soup: &Soup<T>, to_scalar: impl Fn(Point3<f64>) -> Point3<T>) -> Reached {
    let brute = BruteForce::new(soup).expect("finite");
    let queries: Vec<Point3<T>> = input.queries.iter().map(|query| to_scalar(*query)).collect();
    let name = match QUESTIONS[input.question] {
        "boxes" => {
            let (name, tree) = tree(&mut input.backend, soup).expect("finite");
            boxes::check(soup, &*tree, name, &queries);
            name
        }
        question => {
            let (name, index) = index(&mut input.backend, soup).expect("finite");
            let subject = Subject { soup, brute: &brute, index: &*index, name, seed: input.seed };
            match question {
                "batches" => answers::check_batches(&subject, &queries),
                "near" => {
                    let finite: Vec<_> = queries.into_iter().filter(|q| q.iter().all(|x| x.is_finite())).collect();
                    near_check::agrees(input.seed, soup, &finite, &*index);
                }
                _ => queries.iter().for_each(|query| answers::check_answer(&subject, question, query)),
            }
            name
        }
    };
    Reached::Answers(input.draft.mode, name, QUESTIONS[input.question])
}

/// Checks that a build over primitives with a coordinate that is not finite is an error, too.
fn check_build_error(draft: &SceneDraft) {
    let shapes = draft.shapes();
    let id = draft.soup().expect_err("not finite");
    let error = Some(BuildError::NonFinite { id });
    assert_eq!(BruteForce::new::<f64>(&shapes).err(), error);
    assert_eq!(AabbTree::<f64, _>::new(&shapes).err(), error);
}
