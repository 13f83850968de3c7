//! `p2m-bench pairs`: distances of two scenes at many poses, and of a robot's arm from a scene, by p2m and by parry3d.
//!
//! Each competitor answers all poses of a set in a round, and competitors take turns. The distances of a set are
//! compared with those of our AABB tree.

mod arm;
mod external;
mod ours;
mod poses;

use crate::command::{Rounds, at_least_one, provenance};
use crate::measure::MedianRange;
use crate::report::significant;
use crate::rounds::{rotated, thread_seconds};
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use p2m_cli::harness::Table;
use std::hint::black_box;
use std::path::PathBuf;

/// The kind of a competitor tells with what its answers are compared.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// It is ours, and its answers have to be those of the first competitor, bit for bit.
    Exact,
    /// It is ours and answers another question, or in another scalar.
    Other,
    /// It is of another library, and may answer fewer questions.
    External,
}

/// A function that writes the distances of some questions.
type Answer<'a, Q> = dyn Fn(&[Q], &mut [f64]) + 'a;

/// A competitor that computes distances for questions of one kind.
struct Competitor<'a, Q> {
    name: &'static str,
    kind: Kind,
    answer: Box<Answer<'a, Q>>,
}

impl<'a, Q> Competitor<'a, Q> {
    fn new(name: &'static str, kind: Kind, answer: impl Fn(&[Q], &mut [f64]) + 'a) -> Self {
        Self { name, kind, answer: Box::new(answer) }
    }
}

/// Answers questions one after the other.
fn each<Q>(questions: &[Q], out: &mut [f64], mut answer: impl FnMut(&Q) -> f64) {
    questions.iter().zip(out).for_each(|(question, out)| *out = answer(question));
}

/// A competitor of another library that would need longer than this for a round answers the first questions of
/// a set only.
const ROUND_SECONDS: f64 = 2.0;

/// The competitor whose times the others are compared with.
const YARDSTICK: &str = "parry3d-f64";

#[derive(Args)]
pub(crate) struct Arguments {
    /// File of the scene that stays
    scene: PathBuf,
    /// File of the scene that is moved
    other: PathBuf,
    /// Number of poses in each set
    #[arg(long, default_value_t = 1000, value_parser = at_least_one())]
    poses: usize,
    /// Number of poses of the arm
    #[arg(long, default_value_t = 100_000, value_parser = at_least_one())]
    arms: usize,
    #[command(flatten)]
    rounds: Rounds,
}

/// Prints times of the distances of two scenes, of which the second is scaled to the size of the first and moved, and
/// of the distances of an arm from the first. Returns whether our exact answers agree.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Rounds { rounds, seed } = arguments.rounds;
    let about = arguments.rounds.describe("One thread, thread CPU time", arguments.poses, "poses");
    println!("{}\n{about}", provenance());
    let (scene, other) = (&Scene::read(&arguments.scene)?, Scene::read(&arguments.other)?);
    let other = Scene::new(other.name, poses::scaled_to(&other.double, scene.diagonal())?)?;
    let (ours, theirs) = (ours::Scenes::build(scene, &other)?, external::Scenes::build(scene, &other)?);
    println!("\n## {} and {}, scaled to the same diagonal\n", scene.describe(), other.describe());
    println!("Microseconds per pose as median (minimum), and the speed relative to {YARDSTICK}.\n");
    let mut table = Table::new(["set", "poses", "median distance", "competitor", "time", "speed", "answers"]);
    let mut is_good = true;
    for set in poses::Set::ALL {
        let questions = set.poses(&ours.trees, scene.diagonal(), arguments.poses, seed);
        let mut competitors = ours.competitors(set, scene.diagonal());
        competitors.extend(theirs.competitors(set));
        is_good &= measure(&mut table, set.name(), &questions, &competitors, scene, rounds);
    }
    println!("{table}");
    println!("\n## An arm of six capsules beside {}\n", scene.describe());
    println!("Microseconds per pose of the arm, which is six capsules.\n");
    let mut table = Table::new(["set", "poses", "median distance", "competitor", "time", "speed", "answers"]);
    let questions = arm::walk(&scene.double, arguments.arms, seed);
    let mut competitors = arm::competitors(&ours);
    competitors.extend(theirs.arm_competitors());
    is_good &= measure(&mut table, "arm", &questions, &competitors, scene, rounds);
    println!("{table}");
    Ok(is_good)
}

/// Measures competitors on a set of questions, adds their rows, and returns whether exact answers are equal.
fn measure<Q>(
    table: &mut Table,
    set: &str,
    questions: &[Q],
    competitors: &[Competitor<'_, Q>],
    scene: &Scene,
    rounds: usize,
) -> bool {
    let time = |at: usize, count: usize, out: &mut [f64]| {
        thread_seconds(|| (competitors[at].answer)(black_box(&questions[..count]), out)).1
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
    let counts: Vec<usize> = (0..competitors.len())
        .map(|at| {
            if competitors[at].kind != Kind::External {
                return questions.len();
            }
            let seconds = time(at, 1, &mut [f64::NAN]);
            ((ROUND_SECONDS / seconds.max(1e-9)) as usize).clamp(1, questions.len())
        })
        .collect();
    let mut answers: Vec<_> = counts.iter().map(|count| vec![f64::NAN; *count]).collect();
    let mut seconds = vec![Vec::new(); competitors.len()];
    for round in 0..rounds {
        for at in rotated(competitors.len(), round) {
            let spent = time(at, counts[at], &mut answers[at]);
            seconds[at].push(spent / counts[at] as f64);
        }
    }
    black_box(&answers);
    let spreads: Vec<_> = seconds.iter().filter_map(|seconds| MedianRange::of(seconds)).collect();
    let yardstick = competitors.iter().zip(&spreads).find(|(c, _)| c.name == YARDSTICK).map(|(_, s)| s.median);
    let mut sorted = answers[0].clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).map_or(f64::NAN, |distance| distance / scene.diagonal());
    let mut is_good = true;
    for ((competitor, spread), found) in competitors.iter().zip(&spreads).zip(&answers) {
        let count = found.len();
        let microseconds = |seconds: f64| significant(seconds * 1e6);
        let agreement = if competitor.kind == Kind::Exact {
            let equal = found.iter().zip(&answers[0]).filter(|(x, y)| x.to_bits() == y.to_bits()).count();
            is_good &= equal == count;
            format!("{equal} of {count} equal bits")
        } else {
            // A competitor that has no distance answers NaN, which is left out.
            let differences = found.iter().zip(&answers[0]).map(|(x, y)| (x - y).abs());
            let largest = differences.fold(0.0, f64::max) / scene.diagonal();
            format!("differ by at most {largest:.1e} diagonals")
        };
        table.push(vec![
            set.to_owned(),
            count.to_string(),
            significant(median),
            competitor.name.to_owned(),
            format!("{} ({})", microseconds(spread.median), microseconds(spread.min)),
            yardstick.map_or("-".to_owned(), |yardstick| significant(yardstick / spread.median)),
            agreement,
        ]);
    }
    is_good
}
