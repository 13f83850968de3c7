//! A contest of competitors that answer the same questions in turns.

use crate::measure::MedianRange;
use crate::rounds::{rotated, thread_seconds};
use nalgebra::Point3;
use p2m_core::batch::{BatchOptions, closest_points_into};
use p2m_core::{Closest, ClosestPoint, QueryOptions};
use std::hint::black_box;

/// The longest time of a round of an external competitor, in seconds. A slower one answers only the first questions.
const ROUND_SECONDS: f64 = 2.0;

/// The kind of a competitor, which determines the reference of its answers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// One of ours, whose answers have to equal those of the first competitor, bit for bit.
    Exact,
    /// One of ours that answers another question, or in another scalar.
    Other,
    /// An external library, which may answer fewer questions.
    External,
}

/// A function that answers some questions.
type Answer<'a, Q, A> = dyn FnMut(&[Q], &mut [A]) + 'a;

/// A competitor that answers questions of one kind.
pub(crate) struct Competitor<'a, Q, A> {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    answer: Box<Answer<'a, Q, A>>,
}

impl<'a, Q, A> Competitor<'a, Q, A> {
    /// Makes a competitor that answers questions one by one. The loop is compiled for this function.
    pub(crate) fn new(name: &'static str, kind: Kind, mut answer: impl FnMut(&Q) -> A + 'a) -> Self {
        Self::in_batches(name, kind, move |questions, out| {
            questions.iter().zip(out).for_each(|(question, out)| *out = answer(question));
        })
    }

    /// Makes a competitor that answers all questions of a round in one call.
    pub(crate) fn in_batches(name: &'static str, kind: Kind, answer: impl FnMut(&[Q], &mut [A]) + 'a) -> Self {
        Self { name, kind, answer: Box::new(answer) }
    }
}

/// The measurements of a competitor.
pub(crate) struct Score<A> {
    /// The seconds per question of each round.
    pub(crate) seconds: MedianRange,
    /// The answers of the last round, possibly to the first questions only.
    pub(crate) answers: Vec<A>,
}

/// Measures competitors, which answer questions in turns, and returns their results in order. Answers are `none` before
/// the first round.
///
/// # Panics
/// Panics without questions or rounds.
pub(crate) fn measure<Q, A: Clone>(
    questions: &[Q],
    competitors: &mut [Competitor<'_, Q, A>],
    rounds: usize,
    none: &A,
) -> Vec<Score<A>> {
    let kinds: Vec<Kind> = competitors.iter().map(|competitor| competitor.kind).collect();
    let mut ask = |at: usize, out: &mut [A]| {
        let questions = black_box(&questions[..out.len()]);
        let seconds = thread_seconds(|| (competitors[at].answer)(questions, out)).1 / out.len() as f64;
        black_box(out);
        seconds
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
    let affordable = |seconds: f64| ((ROUND_SECONDS / seconds.max(1e-9)) as usize).clamp(1, questions.len());
    let mut answers = Vec::new();
    for (at, kind) in kinds.iter().enumerate() {
        // The first call after a pause is slow, so the second one is measured.
        let count = match kind {
            Kind::External => affordable([(); 2].map(|()| ask(at, &mut [none.clone()]))[1]),
            Kind::Exact | Kind::Other => questions.len(),
        };
        answers.push(vec![none.clone(); count]);
    }
    let mut seconds = vec![Vec::new(); kinds.len()];
    for round in 0..rounds {
        for at in rotated(kinds.len(), round) {
            seconds[at].push(ask(at, &mut answers[at]));
        }
    }
    let spread = |seconds: &Vec<f64>| MedianRange::of(seconds).expect("there is a round");
    seconds.iter().map(spread).zip(answers).map(|(seconds, answers)| Score { seconds, answers }).collect()
}

/// Returns two competitors for an index: one answers points one by one, and one answers them as a batch on one thread.
pub(crate) fn single_and_batch<'a, I: ClosestPoint<f64> + Sync + ?Sized>(
    index: &'a I,
) -> [Competitor<'a, Point3<f64>, Option<Closest<f64>>>; 2] {
    let one_thread = BatchOptions::default().with_parallel(false);
    let batch = move |points: &[Point3<f64>], out: &mut [_]| {
        closest_points_into(index, points, &QueryOptions::default(), &one_thread, out);
    };
    [
        Competitor::new("one by one", Kind::Exact, |point| index.closest_point(point)),
        Competitor::in_batches("batch", Kind::Exact, batch),
    ]
}
