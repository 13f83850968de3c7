//! `p2m-bench pairs`: distances of two scenes at many poses, and of a robot's arm from a scene, by p2m and by parry3d.
//!
//! parry3d answers by `query::distance` of two `TriMesh`es, and of a `TriMesh` and a `Capsule`. All distances are
//! compared with those of our AABB tree.

mod arm;
mod poses;

use crate::command::{Rounds, at_least_one, provenance};
use crate::contest::{self, Competitor, Kind};
use crate::parry::{double, single};
use crate::report::significant;
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use nalgebra::Isometry3;
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::pair::{ClosestPair, PairOptions, PairQuery};
use p2m_core::{Real, Soup};
use p2m_kdop::KdopTree;
use std::path::PathBuf;

/// The competitor to whose times ratios refer.
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

/// The indexes of two scenes, ours and those of parry3d.
struct Indexes<'a> {
    trees: poses::Trees<'a>,
    kdops: [KdopTree<f64, &'a Soup<f64>>; 2],
    trees_in_f32: Option<[AabbTree<f32, &'a Soup<f32>>; 2]>,
    single: [single::Mesh; 2],
    double: [double::Mesh; 2],
}

impl<'a> Indexes<'a> {
    fn build(scene: &'a Scene, other: &'a Scene) -> Result<Self> {
        let soups = [&*scene.double, &*other.double];
        let trees_in_f32 = match [scene.single.as_deref(), other.single.as_deref()] {
            [Some(a), Some(b)] => Some([AabbTree::new(a)?, AabbTree::new(b)?]),
            _ => None,
        };
        let [a, b] = soups.map(AabbTree::new);
        let [c, d] = soups.map(KdopTree::new);
        let single = [single::Mesh::build(scene)?, single::Mesh::build(other)?];
        let double = [double::Mesh::build(scene)?, double::Mesh::build(other)?];
        Ok(Self { trees: [a?, b?], kdops: [c?, d?], trees_in_f32, single, double })
    }

    /// Returns the competitors for a set of poses of the second scene.
    fn competitors(&self, set: poses::Set, diagonal: f64) -> Vec<Competitor<'_, Isometry3<f64>, f64>> {
        let Self { trees: [a, b], kdops: [c, d], trees_in_f32, single: [e, f], double: [g, h] } = self;
        let mut all = vec![
            Competitor::new("AABB tree", Kind::Exact, |motion| distance(a.closest_pair(b, &moved(motion)))),
            Competitor::new("14-DOP tree", Kind::Exact, |motion| distance(c.closest_pair(d, &moved(motion)))),
        ];
        if set != poses::Set::Deep {
            let mut last = None;
            all.push(Competitor::new("AABB tree, begun with the last pair", Kind::Exact, move |motion| {
                let mut options = moved(motion);
                options.hint = last;
                let pair = a.closest_pair(b, &options);
                last = pair.map(|pair| pair.primitives);
                distance(pair)
            }));
        }
        let within = move |motion: &_, limit| moved(motion).with_max_distance(limit);
        all.push(Competitor::new("AABB tree, within 0.1 diagonals", Kind::Other, move |motion| {
            a.closest_pair(b, &within(motion, 0.1 * diagonal)).map_or(f64::NAN, |pair| pair.distance)
        }));
        all.push(Competitor::new("AABB tree, whether they intersect", Kind::Other, move |motion| {
            if a.is_any_pair_near(b, &within(motion, 0.0)) { 0.0 } else { f64::NAN }
        }));
        if let Some([a, b]) = trees_in_f32 {
            let answer = |motion: &_| distance(a.closest_pair(b, &moved(motion)));
            all.push(Competitor::new("AABB tree in f32", Kind::Other, answer));
        }
        all.push(Competitor::new("parry3d-f64", Kind::External, |motion| g.distance(h, motion)));
        all.push(Competitor::new("parry3d", Kind::External, |motion| e.distance(f, motion)));
        if set == poses::Set::Deep {
            let answer = |motion: &_| g.intersection(h, motion);
            all.push(Competitor::new("parry3d-f64, whether they intersect", Kind::External, answer));
            let answer = |motion: &_| e.intersection(f, motion);
            all.push(Competitor::new("parry3d, whether they intersect", Kind::External, answer));
        }
        all
    }
}

fn moved<T: Real>(motion: &Isometry3<f64>) -> PairOptions<T> {
    PairOptions::default().with_motion(*motion)
}

fn distance<T: Real>(pair: Option<ClosestPair<T>>) -> f64 {
    pair.map_or(f64::INFINITY, |pair| pair.distance.to_f64())
}

/// Prints the times of distances between two scenes, the second of which is scaled to the size of the first and moved,
/// and of distances of an arm from the first. Returns whether our exact answers agree.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Rounds { rounds, seed } = arguments.rounds;
    let about = arguments.rounds.describe("One thread, thread CPU time", arguments.poses, "poses");
    println!("{}\n{about}", provenance());
    let (scene, other) = (&Scene::read(&arguments.scene)?, Scene::read(&arguments.other)?);
    let other = Scene::new(other.name, poses::scaled_to(&other.double, scene.diagonal())?)?;
    let indexes = Indexes::build(scene, &other)?;
    println!("\n## {} and {}, scaled to the same diagonal\n", scene.describe(), other.describe());
    println!("Microseconds per pose as median (minimum), and the speed relative to {YARDSTICK}.\n");
    let head = ["set", "poses", "median distance", "competitor", "time", "speed", "answers"];
    let mut table = Table::new(head);
    let mut is_good = true;
    for set in poses::Set::ALL {
        let questions = set.poses(&indexes.trees, scene.diagonal(), arguments.poses, seed);
        let competitors = indexes.competitors(set, scene.diagonal());
        is_good &= measure(&mut table, set.name(), &questions, competitors, scene, rounds);
    }
    println!("{table}");
    println!("\n## An arm of six capsules beside {}\n", scene.describe());
    println!("Microseconds per pose of the arm, which is six capsules.\n");
    let mut table = Table::new(head);
    let questions = arm::walk(&scene.double, arguments.arms, seed);
    is_good &= measure(&mut table, "arm", &questions, arm::competitors(&indexes), scene, rounds);
    println!("{table}");
    Ok(is_good)
}

/// Measures competitors on a set of questions, adds their rows, and returns whether exact answers are equal.
fn measure<Q>(
    table: &mut Table,
    set: &str,
    questions: &[Q],
    mut competitors: Vec<Competitor<'_, Q, f64>>,
    scene: &Scene,
    rounds: usize,
) -> bool {
    let scores = contest::measure(questions, &mut competitors, rounds, &f64::NAN);
    let yardstick = competitors.iter().zip(&scores).find(|(c, _)| c.name == YARDSTICK).map(|(_, s)| s.seconds.median);
    let expected = &scores[0].answers;
    let mut sorted = expected.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).map_or(f64::NAN, |distance| distance / scene.diagonal());
    let mut is_good = true;
    for (competitor, score) in competitors.iter().zip(&scores) {
        let (spread, found, count) = (score.seconds, &score.answers, score.answers.len());
        let microseconds = |seconds: f64| significant(seconds * 1e6);
        let agreement = if competitor.kind == Kind::Exact {
            let equal = found.iter().zip(expected).filter(|(x, y)| x.to_bits() == y.to_bits()).count();
            is_good &= equal == count;
            format!("{equal} of {count} equal bits")
        } else {
            // A competitor without a distance answers NaN, which is left out.
            let differences = found.iter().zip(expected).map(|(x, y)| (x - y).abs());
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
