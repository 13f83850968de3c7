//! Checks distances between isolated primitives, and those of other libraries.

use super::counts::Counts;
use super::threads;
use crate::blocks::Blocks;
use crate::command::{Document, provenance};
use anyhow::Result;
use clap::Args;
use p2m_cli::harness::Table;
use p2m_core::Real;
use p2m_core::pair::{ERROR_CONSTANT_OF_PAIRS, NearestPair, nearest_pair};
use p2m_testkit::families::{Family, Span, pair_in, shape};
use p2m_testkit::oracle::Distance;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The block of docs/measurements/extremes.md.
pub(crate) const BLOCKS: Blocks<1> = Blocks { command: "extreme-pairs", names: ["pairs"] };

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

/// The counts of a subject in a row.
#[derive(Clone, Copy, Default)]
struct PairCounts {
    distances: Counts,
    /// The number of wrong answers to the question whether the primitives intersect.
    wrong_intersections: u64,
}

/// An answer to a pair.
struct Answer {
    distance: f64,
    /// Whether the primitives intersect. parry3d says so by the distance 0.
    is_intersecting: bool,
}

struct Findings {
    rows: [[PairCounts; SUBJECTS.len()]; ROWS.len()],
}

impl threads::Findings for Findings {
    fn new() -> Self {
        Self { rows: Default::default() }
    }

    fn merge(&mut self, other: Self, _: u64) {
        for (counts, others) in self.rows.as_flattened_mut().iter_mut().zip(other.rows.as_flattened()) {
            counts.distances.merge(&others.distances);
            counts.wrong_intersections += others.wrong_intersections;
        }
    }
}

impl Findings {
    fn ours_are_within_their_bound(&self) -> bool {
        self.rows.iter().flat_map(|row| &row[..2]).all(|counts| {
            let Counts { worst, failed, panicked, .. } = counts.distances;
            worst <= ERROR_CONSTANT_OF_PAIRS && (failed, panicked, counts.wrong_intersections) == (0, 0, 0)
        })
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

#[derive(Args)]
pub(crate) struct Arguments {
    /// Pairs of primitives that are checked
    #[arg(long, default_value_t = 1_000_000)]
    cases: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    document: Document,
}

/// Checks pairs of primitives, half of them in each scalar, and publishes the block. Returns whether ours are
/// all within their bound.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let document = arguments.document.write.as_deref();
    BLOCKS.check(document)?;
    let found = super::without_messages(|| check(arguments.cases, arguments.seed));
    let mut table = Table::new([""].into_iter().chain(SUBJECTS));
    for (name, row) in ROWS.iter().zip(&found.rows) {
        table.push(std::iter::once((*name).to_owned()).chain(row.iter().map(cell)).collect());
    }
    let total: u64 = found.rows.as_flattened().iter().map(|counts| counts.distances.cases).sum();
    let provenance = provenance();
    let text = format!("{provenance}\n\n{table}\n{total} distances were compared with rational arithmetic.\n");
    BLOCKS.publish(document, &[text])?;
    Ok(found.ours_are_within_their_bound())
}

fn check(cases: u64, seed: u64) -> Findings {
    threads::run("distances of pairs", cases.div_ceil(2 * CHUNK), |chunk, found: &mut Findings| {
        let mut rng = p2m_testkit::rng("extreme pairs", (seed << 32) + chunk);
        for _ in 0..CHUNK {
            for (scalar, span) in [Span::F64, Span::F32].iter().enumerate() {
                let (family, [a, b]) = pair_in(&mut rng, span);
                let truth = Distance::between(&a, &b);
                let row = &mut found.rows[row_of(&family)];
                let ours = if scalar == 0 { answer::<f64>(&a, &b) } else { answer::<f32>(&a, &b) };
                judge(&mut row[scalar], scalar, &truth, Some(ours));
                // Other libraries have no points.
                if a.len() > 1 && b.len() > 1 {
                    let theirs = catch_unwind(AssertUnwindSafe(|| {
                        if scalar == 0 { parry_double(&a, &b) } else { parry_single(&a, &b) }
                    }));
                    judge(&mut row[2 + scalar], scalar, &truth, theirs.ok());
                }
            }
        }
    })
}

/// Adds an answer, or a panic.
fn judge(counts: &mut PairCounts, scalar: usize, truth: &Distance, answer: Option<Answer>) {
    let Some(Answer { distance, is_intersecting }) = answer else {
        counts.distances.panicked += 1;
        return;
    };
    let (bits, eta, limit) =
        [(53u32, f64::from_bits(4), f64::MAX), (24, 4.0 * f64::from(f32::from_bits(1)), f64::from(f32::MAX))][scalar];
    // A distance may be infinite if it exceeds the range together with its error.
    let unit_roundoff = 2f64.powi(-bits.cast_signed());
    let error = truth.times_max_vertex_distance(ERROR_CONSTANT_OF_PAIRS * unit_roundoff);
    let beyond = distance == f64::INFINITY && truth.is_at_least(limit - error);
    counts.distances.add(if beyond { 0.0 } else { truth.error(distance, bits, eta) });
    counts.wrong_intersections += u64::from(is_intersecting != truth.is_zero());
}

/// Formats the largest error, and the fraction of answers that are wrong in other ways.
fn cell(counts: &PairCounts) -> String {
    let all = counts.distances.cases.max(1) as f64;
    let wrong = counts.wrong_intersections;
    let wrong = if wrong == 0 { String::new() } else { format!(", wrong intersection {:.1e}", wrong as f64 / all) };
    counts.distances.cell() + &wrong
}

fn answer<T: Real>(a: &[[f64; 3]], b: &[[f64; 3]]) -> Answer {
    let of = |hull: &[[f64; 3]]| shape(&hull.iter().map(|v| v.map(T::round_from_f64)).collect::<Vec<_>>());
    let pair: NearestPair = nearest_pair(&of(a), &of(b));
    Answer { distance: T::round_from_f64(pair.key.distance()).to_f64(), is_intersecting: pair.is_intersecting }
}

/// Generates the adapter for one of the two crates of parry, which have the same names for different types.
macro_rules! parry {
    ($name:ident, $parry:ident, $scalar:ty) => {
        #[allow(clippy::cast_possible_truncation, reason = "to the scalar of the crate; f32 is rounded to before")]
        #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
        fn $name(a: &[[f64; 3]], b: &[[f64; 3]]) -> Answer {
            use $parry::math::{Pose, Vector};
            use $parry::query::distance;
            use $parry::shape::{Segment, Shape, Triangle};
            let vector = |v: [f64; 3]| Vector::new(v[0] as $scalar, v[1] as $scalar, v[2] as $scalar);
            let shape = |hull: &[[f64; 3]]| -> Box<dyn Shape> {
                match *hull {
                    [a, b] => Box::new(Segment::new(vector(a), vector(b))),
                    [a, b, c] => Box::new(Triangle::new(vector(a), vector(b), vector(c))),
                    _ => unreachable!("segments and triangles"),
                }
            };
            let found = distance(&Pose::IDENTITY, &*shape(a), &Pose::IDENTITY, &*shape(b));
            let distance: f64 = found.map_or(f64::NAN, |found| found.distance.into());
            Answer { distance, is_intersecting: distance == 0.0 }
        }
    };
}
parry!(parry_double, parry3d_f64, f64);
parry!(parry_single, parry3d, f32);

#[cfg(test)]
mod tests {
    #[test]
    fn ours_are_within_their_bound() {
        assert!(super::check(4_000, 3).ours_are_within_their_bound());
    }
}
