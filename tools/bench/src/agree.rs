//! Compares the answers of backends.
//!
//! All our backends of one scalar have to return the same bits, in distance and id, and are compared with the first of
//! them. For external libraries, and for our backends in f32, distances are compared with our first index in f64; the
//! rounding of the input to f32 is part of that difference.

use crate::backend::{Answer, Backend, ScalarKind};

/// The answers of a backend in a round.
#[derive(Clone, Copy)]
pub(crate) struct Answers<'a> {
    /// The backend that gave the answers.
    pub(crate) backend: &'a Backend,
    /// The positions of its queries in the set, in increasing order.
    pub(crate) chosen: &'a [usize],
    /// The answers, one for each of these queries.
    pub(crate) answers: &'a [Answer],
}

/// The result of comparing the answers of a backend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Agreement {
    /// The number of answers that were compared bitwise with another backend of ours.
    pub(crate) compared: usize,
    /// The number of compared answers that have another distance.
    pub(crate) other_distance: usize,
    /// The number of compared answers that have the same distance and another id.
    pub(crate) other_id: usize,
    /// A query with a different answer: its position in the set, the answer, and the expected answer.
    pub(crate) example: Option<(usize, Answer, Answer)>,
    /// The number of queries without a finite answer.
    pub(crate) failed: usize,
    /// The largest difference of a distance from the reference, in units of the scene; NaN without a reference.
    pub(crate) difference: f64,
}

impl Agreement {
    /// Returns whether compared answers are bitwise equal and all queries were answered.
    pub(crate) fn is_clean(&self) -> bool {
        self.other_distance == 0 && self.other_id == 0 && self.failed == 0
    }

    /// Adds the comparison of another round.
    pub(crate) fn add(&mut self, other: &Self) {
        self.compared += other.compared;
        self.other_distance += other.other_distance;
        self.other_id += other.other_id;
        self.example = self.example.or(other.example);
        self.failed += other.failed;
        self.difference = if self.difference > other.difference { self.difference } else { other.difference };
    }
}

/// Compares all backends of a round and returns a result for each, in their order. The reference of a scalar is our
/// first backend that answered all queries, or that visits few primitives.
pub(crate) fn compare_round(round: &[Option<Answers<'_>>], total: usize) -> Vec<Agreement> {
    let reference = |scalar: ScalarKind| -> Option<Vec<Option<Answer>>> {
        let of_scalar = || round.iter().flatten().filter(|a| a.backend.is_ours && a.backend.scalar == scalar);
        let best = of_scalar().find(|a| !a.backend.is_exhaustive || a.chosen.len() == total);
        best.or_else(|| of_scalar().next()).map(|answers| by_query(answers, total))
    };
    let [double, single] = [ScalarKind::Double, ScalarKind::Single].map(reference);
    let compare = |a: &Answers<'_>| {
        let failed = a.answers.iter().filter(|answer| !answer.distance.is_finite()).count();
        let mut agreement = Agreement { failed, difference: f64::NAN, ..Agreement::default() };
        let peer = if a.backend.scalar == ScalarKind::Double { &double } else { &single };
        for (&at, answer) in a.chosen.iter().zip(a.answers) {
            let expected_at = |all: &Option<Vec<Option<Answer>>>| all.as_ref().and_then(|all| all[at]);
            // Failed queries have no difference. They are counted above.
            let difference = expected_at(&double).map(|expected| (answer.distance - expected.distance).abs());
            agreement.difference = difference
                .filter(|difference| difference.is_finite())
                .map_or(agreement.difference, |difference| agreement.difference.max(difference));
            if let Some(expected) = expected_at(peer).filter(|_| a.backend.is_ours) {
                agreement.compared += 1;
                let (is_distance, is_id) = (answer.same_distance(&expected), answer.id == expected.id);
                agreement.other_distance += usize::from(!is_distance);
                agreement.other_id += usize::from(is_distance && !is_id);
                if !(is_distance && is_id) {
                    agreement.example.get_or_insert((at, *answer, expected));
                }
            }
        }
        agreement
    };
    round.iter().map(|answers| answers.as_ref().map(compare).unwrap_or_default()).collect()
}

/// Returns the answers by the positions of their queries in the set, `None` for queries that were not asked.
fn by_query(answers: &Answers<'_>, total: usize) -> Vec<Option<Answer>> {
    let mut all = vec![None; total];
    answers.chosen.iter().zip(answers.answers).for_each(|(&position, answer)| all[position] = Some(*answer));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backends;

    fn answers<'a>(name: &str, chosen: &'a [usize], answers: &'a [Answer]) -> Option<Answers<'a>> {
        let backend = backends::ALL.iter().find(|b| b.name == name).unwrap();
        Some(Answers { backend, chosen, answers })
    }

    #[test]
    fn each_kind_of_disagreement_is_counted_as_such() {
        let expected = [1.0, 2.0, 3.0].map(|distance| Answer { distance, id: 7 });
        let ours = [Answer { distance: 2.0, id: 6 }, Answer { distance: 3.5, id: 7 }];
        let external = [Answer { distance: 1.25, id: 0 }, Answer::NONE, Answer { distance: 3.0, id: 1 }];
        let round = [
            answers("brute", &[1, 2], &ours),
            answers("aabb", &[0, 1, 2], &expected),
            answers("parry3d", &[0, 1, 2], &external),
            None,
        ];
        let [brute, aabb, parry, none] = compare_round(&round, 3).try_into().unwrap();
        let clean = Agreement::default();
        assert_eq!(aabb, Agreement { compared: 3, ..clean });
        let example = Some((1, ours[0], expected[1]));
        assert_eq!(brute, Agreement { compared: 2, other_distance: 1, other_id: 1, example, difference: 0.5, ..clean });
        assert_eq!(parry, Agreement { failed: 1, difference: 0.25, ..clean });
        assert_eq!(none, clean);
        assert!(aabb.is_clean() && !brute.is_clean() && !parry.is_clean());
    }

    #[test]
    fn rounds_add_up() {
        let mut sum = Agreement { difference: f64::NAN, ..Agreement::default() };
        sum.add(&Agreement { compared: 2, other_id: 1, difference: 0.5, ..Agreement::default() });
        sum.add(&Agreement { compared: 3, failed: 1, difference: 0.25, ..Agreement::default() });
        assert_eq!(sum, Agreement { compared: 5, other_id: 1, failed: 1, difference: 0.5, ..Agreement::default() });
    }
}
