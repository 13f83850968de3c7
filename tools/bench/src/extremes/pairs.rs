//! Checks of distances between isolated primitives, for p2m and other libraries.

use super::counts::{Counts, Precision, merge_all};
use crate::parry::{double, single};
use p2m_cli::harness::Table;
use p2m_core::Real;
use p2m_core::pair::{ERROR_CONSTANT_OF_PAIRS, nearest_pair};
use p2m_testkit::families::{Family, Span, pair_in, shape};
use p2m_testkit::oracle::Distance;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The number of cases that a thread takes at a time.
const CHUNK: u64 = 1_000;
/// The names of the rows.
const ROWS: [&str; 6] = [
    "lattice",
    "any magnitude",
    "almost parallel to an axis",
    "neighbours of an f32",
    "shapes at the origin, of scale 1",
    "shapes elsewhere, of any scale",
];
/// The names of the subjects, which compute in f64, f32, f64 and f32.
const SUBJECTS: [&str; 4] = ["p2m f64", "p2m f32", "parry3d-f64", "parry3d"];

/// An answer about a pair of primitives.
struct Answer {
    distance: f64,
    /// Whether the primitives intersect. For parry3d this means that the distance is 0.
    is_intersecting: bool,
}

/// The counters of all subjects in each row.
#[derive(Default)]
pub(super) struct Findings {
    rows: [[Counts; SUBJECTS.len()]; ROWS.len()],
}

impl Findings {
    pub(super) fn ours_are_within_their_bound(&self) -> bool {
        self.rows.iter().flat_map(|row| &row[..2]).all(|counts| {
            let Counts { worst, failed, panicked, wrong, .. } = *counts;
            worst <= ERROR_CONSTANT_OF_PAIRS && (failed, panicked, wrong) == (0, 0, 0)
        })
    }

    /// Formats the errors, and the number of distances.
    pub(super) fn text(&self) -> String {
        let mut table = Table::new([""].into_iter().chain(SUBJECTS));
        for (name, row) in ROWS.iter().zip(&self.rows) {
            table.push(std::iter::once((*name).to_owned()).chain(row.iter().map(Counts::cell)).collect());
        }
        let total: u64 = self.rows.as_flattened().iter().map(|counts| counts.cases).sum();
        format!("{table}\n{total} distances were compared with rational arithmetic.\n")
    }
}

fn row_of(family: &Family) -> usize {
    match family {
        Family::Lattice => 0,
        Family::Wild => 1,
        Family::AlmostFlat => 2,
        Family::Neighbours => 3,
        Family::Shaped { scale: 0, offset, .. } if *offset == 0.0 => 4,
        Family::Shaped { .. } => 5,
    }
}

/// Checks pairs of primitives, half of them in each scalar.
pub(super) fn run(cases: u64, seed: u64) -> Findings {
    let check = |chunk: u64, found: &mut Findings| {
        let mut rng = p2m_testkit::rng("extreme pairs", (seed << 32) + chunk);
        for _ in 0..CHUNK {
            for (scalar, span) in [Span::F64, Span::F32].iter().enumerate() {
                let (family, [a, b]) = pair_in(&mut rng, span);
                let truth = Distance::between(&a, &b);
                let row = &mut found.rows[row_of(&family)];
                let ours = if scalar == 0 { answer::<f64>(&a, &b) } else { answer::<f32>(&a, &b) };
                judge(&mut row[scalar], scalar, &truth, Some(ours));
                // The other libraries have no points.
                if a.len() > 1 && b.len() > 1 {
                    let distance = [double::distance_between, single::distance_between][scalar];
                    let distance = catch_unwind(AssertUnwindSafe(|| distance(&a, &b))).ok();
                    let theirs = distance.map(|distance| Answer { distance, is_intersecting: distance == 0.0 });
                    judge(&mut row[2 + scalar], scalar, &truth, theirs);
                }
            }
        }
    };
    let merge = |all: &mut Findings, other: Findings| {
        merge_all(all.rows.as_flattened_mut(), other.rows.as_flattened());
    };
    super::on_all_threads("distances of pairs", cases.div_ceil(2 * CHUNK), check, merge)
}

/// Counts an answer, or a panic.
fn judge(counts: &mut Counts, scalar: usize, truth: &Distance, answer: Option<Answer>) {
    let Precision { bits, smallest, largest } = Precision::ALL[scalar];
    // A distance may be infinite if the distance plus its error exceeds the range.
    let rounding = truth.times_max_vertex_distance(ERROR_CONSTANT_OF_PAIRS * Precision::ALL[scalar].unit());
    counts.add(answer.as_ref().map(|answer| {
        let beyond = answer.distance == f64::INFINITY && truth.is_at_least(largest - rounding);
        if beyond { 0.0 } else { truth.error(answer.distance, bits, 4.0 * smallest) }
    }));
    counts.wrong += u64::from(answer.is_some_and(|answer| answer.is_intersecting != truth.is_zero()));
}

fn answer<T: Real>(a: &[[f64; 3]], b: &[[f64; 3]]) -> Answer {
    let of = |hull: &[[f64; 3]]| shape(&hull.iter().map(|v| v.map(T::round_from_f64)).collect::<Vec<_>>());
    let pair = nearest_pair(&of(a), &of(b));
    Answer { distance: T::round_from_f64(pair.key.distance()).to_f64(), is_intersecting: pair.is_intersecting }
}

#[cfg(test)]
mod tests {
    #[test]
    fn ours_are_within_their_bound() {
        assert!(super::run(4_000, 3).ours_are_within_their_bound());
    }
}
