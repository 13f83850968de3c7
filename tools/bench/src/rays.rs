//! `p2m-bench ray`: times the first hits of rays by our trees and by parry3d, and compares them.
//!
//! Rays begin at the points of a query set and have directions that are uniformly distributed on the sphere. parry3d
//! promises nothing about rays through edges, and a parameter in f32 is only as accurate as its rounding.

use crate::command::{Rounds, all_good, at_least_one};
use crate::contest::{self, Competitor, Kind};
use crate::our_indexes::{aabb_options, kdop_options};
use crate::parry::{double, single};
use crate::report::significant;
use crate::scene::Scene;
use anyhow::Result;
use clap::Args;
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::{BuildIndex, Ray, RayQuery};
use p2m_kdop::KdopTree;
use p2m_testkit::queries::QuerySet;
use std::hint::black_box;
use std::path::PathBuf;

/// The largest difference of parameters that rounding of the input to f32 explains, relative to the parameter and the
/// diagonal of the box: a thousand units in the last place.
const ROUNDING: f64 = 1000.0 / (1u32 << 24) as f64;
/// The method of parry3d that returns the triangle, the parameter and the normal, in f32.
const YARDSTICK: &str = "parry3d";
/// The method of parry3d that returns only the parameter, in f32.
const YARDSTICK_PARAMETER: &str = "parry3d-parameter";

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Query sets at which rays begin
    #[arg(long, value_delimiter = ',', default_values_t = [QuerySet::Box10, QuerySet::Box1])]
    sets: Vec<QuerySet>,
    /// Rays in a round
    #[arg(long, default_value_t = 200_000, value_parser = at_least_one())]
    rays: usize,
    #[command(flatten)]
    rounds: Rounds,
}

/// A ray in the representations of all competitors.
struct Question {
    ours: Ray,
    single: single::Ray,
    double: double::Ray,
}

impl Question {
    fn new(ours: Ray) -> Self {
        Self { single: single::ray(&ours), double: double::ray(&ours), ours }
    }
}

/// The parameter of the first hit, and the id of the primitive, if the competitor returns it.
type Outcome = Option<(f64, usize)>;
type Caster<'a> = Competitor<'a, Question, Outcome>;

/// Returns a competitor for one of our indexes.
fn ours<'a>(name: &'static str, index: impl RayQuery<f64> + 'a) -> Caster<'a> {
    Competitor::new(name, Kind::Exact, move |question: &Question| {
        // `black_box` prevents the compiler from omitting a part of the hit.
        black_box(index.first_intersection(&question.ours)).map(|hit| (hit.parameter, hit.primitive.index()))
    })
}

/// Returns all competitors. parry is left out for scenes with other primitives than triangles.
fn casters(scene: &Scene) -> Result<Vec<Caster<'_>>> {
    let soup = &*scene.double;
    let mut all = vec![
        ours("aabb", AabbTree::build(soup, &aabb_options())?),
        ours("kdop-6", KdopTree::<f64, _, 6>::build(soup, &kdop_options())?),
        ours("kdop-14", KdopTree::<f64, _, 14>::build(soup, &kdop_options())?),
        ours("kdop-18", KdopTree::<f64, _, 18>::build(soup, &kdop_options())?),
        ours("kdop-26", KdopTree::<f64, _, 26>::build(soup, &kdop_options())?),
    ];
    if soup.triangles().len() < scene.len() {
        return Ok(all);
    }
    for (name, with_normal) in [(YARDSTICK, true), (YARDSTICK_PARAMETER, false)] {
        if let Ok(mesh) = single::Mesh::build(scene) {
            let hit = move |question: &Question| mesh.first_hit(&question.single, with_normal);
            all.push(Competitor::new(name, Kind::External, hit));
        }
    }
    if let Ok(mesh) = double::Mesh::build(scene) {
        let hit = move |question: &Question| mesh.first_hit(&question.double, true);
        all.push(Competitor::new("parry3d-f64", Kind::External, hit));
    }
    Ok(all)
}

/// Times rays, and returns whether all our trees agree bit for bit.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let about = arguments.rounds.describe("One thread, thread CPU time", arguments.rays, "rays");
    all_good(&arguments.scenes, &about, |scene| measure(&scene, arguments))
}

fn measure(scene: &Scene, arguments: &Arguments) -> Result<bool> {
    let Rounds { rounds, seed } = arguments.rounds;
    let mut casters = casters(scene)?;
    let mut rows: Vec<Vec<String>> = casters.iter().map(|caster| vec![caster.name.to_owned()]).collect();
    let (mut notes, mut is_good) = (Vec::new(), true);
    for set in &arguments.sets {
        let rays: Vec<_> = set.rays(&scene.double, arguments.rays, seed).into_iter().map(Question::new).collect();
        let scores = contest::measure(&rays, &mut casters, rounds, &None);
        let median = |name: &str| Some(scores[casters.iter().position(|caster| caster.name == name)?].seconds.median);
        let expected = &scores[0].answers;
        notes.push(format!("{set}: {} of {} rays hit.", expected.iter().flatten().count(), rays.len()));
        for ((caster, score), row) in casters.iter().zip(&scores).zip(&mut rows) {
            let [time, minimum] = [score.seconds.median, score.seconds.min];
            let [mesh, parameter] = [YARDSTICK, YARDSTICK_PARAMETER]
                .map(|name| median(name).map_or("-".to_owned(), |reference| significant(reference / time)));
            row.push(format!("{:.0} ({:.0}), {mesh} / {parameter}", time * 1e9, minimum * 1e9));
            let is_ours = caster.kind == Kind::Exact;
            let differences = Differences::new(&score.answers, expected, is_ours, scene.diagonal());
            is_good &= !is_ours || differences.is_clean();
            if !is_ours || !differences.is_clean() {
                notes.push(format!("{} on {set}: {differences}", caster.name));
            }
        }
    }
    println!("\n## {}\n", scene.describe());
    println!(
        "ns per ray as median (minimum); then the speed relative to {YARDSTICK} / {YARDSTICK_PARAMETER}, which returns \
         neither triangle nor normal: its median over the competitor's, above 1 is faster.\n"
    );
    let mut table = Table::new(["first hit"].into_iter().chain(arguments.sets.iter().map(|set| set.name())));
    rows.into_iter().for_each(|row| table.push(row));
    println!("{table}");
    notes.iter().for_each(|note| println!("- {note}"));
    Ok(is_good)
}

/// The differences between the answers of a competitor and those of our first one.
#[derive(Debug, Default, PartialEq)]
struct Differences {
    /// The number of rays that hit only for the reference.
    missed: usize,
    /// The number of rays that hit only for this competitor.
    added: usize,
    /// The number of rays with different hits: in any bit for our trees, by more than rounding for other libraries.
    other: usize,
    /// The largest difference of a parameter, relative to the parameter and the diagonal of the box.
    largest: f64,
}

impl Differences {
    fn new(found: &[Outcome], expected: &[Outcome], is_exact: bool, diagonal: f64) -> Self {
        let mut differences = Self::default();
        for outcomes in found.iter().zip(expected) {
            match outcomes {
                (None, Some(_)) => differences.missed += 1,
                (Some(_), None) => differences.added += 1,
                (None, None) => {}
                (Some((found, id)), Some((parameter, expected_id))) if is_exact => {
                    let is_same = (found.to_bits(), id) == (parameter.to_bits(), expected_id);
                    differences.other += usize::from(!is_same);
                }
                (Some((found, _)), Some((parameter, _))) => {
                    let relative = (found - parameter).abs() / (parameter.abs() + diagonal);
                    differences.other += usize::from(relative.is_nan() || relative > ROUNDING);
                    differences.largest = differences.largest.max(relative);
                }
            }
        }
        differences
    }

    fn is_clean(&self) -> bool {
        self.missed + self.added + self.other == 0
    }
}

impl std::fmt::Display for Differences {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { missed, added, other, largest } = self;
        write!(
            f,
            "it misses {missed} rays that hit and hits with {added} that miss; {other} hits differ, in other libraries \
             by more than {ROUNDING:.1e} of parameter and diagonal, {largest:.1e} at most"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::{Element, Soup};

    #[test]
    fn each_kind_of_difference_is_counted_as_such() {
        let hit = |parameter| Some((parameter, 3));
        let found = [None, hit(1.0), None, hit(3.0), hit(3.0_f64.next_up()), hit(4.0), Some((3.0, 4))];
        let expected = [hit(1.0), None, None, hit(3.0), hit(3.0), hit(3.0), hit(3.0)];
        let differences = |is_exact| Differences::new(&found, &expected, is_exact, 1.0);
        let exact = Differences { missed: 1, added: 1, other: 3, largest: 0.0 };
        assert_eq!(differences(true), exact);
        assert_eq!(differences(false), Differences { other: 1, largest: 0.25, ..exact });
        let clean =
            |range: std::ops::Range<usize>| Differences::new(&found[range.clone()], &expected[range], true, 1.0);
        assert!(clean(2..4).is_clean() && !clean(0..1).is_clean());
    }

    #[test]
    fn scenes_of_any_kind_are_measured_and_ours_agree() {
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        let triangles = [Element::Triangle([0, 1, 2]), Element::Triangle([1, 2, 3])];
        for (elements, competitors, hits) in [(triangles, 8, 50), ([triangles[0], Element::Point(3)], 5, 10)] {
            let scene = Scene::new("test".into(), Soup::new(p.clone(), elements).unwrap()).unwrap();
            let mut casters = casters(&scene).unwrap();
            assert_eq!(casters.len(), competitors);
            let rays = QuerySet::Box1.rays(&scene.double, 1000, 1).into_iter().map(Question::new).collect::<Vec<_>>();
            let scores = contest::measure(&rays, &mut casters, 1, &None);
            assert!(scores[0].answers.iter().flatten().count() > hits);
            for (caster, score) in casters.iter().zip(&scores) {
                let is_ours = caster.kind == Kind::Exact;
                let differences = Differences::new(&score.answers, &scores[0].answers, is_ours, scene.diagonal());
                assert!(differences.is_clean(), "{} {differences}", caster.name);
                assert_eq!((score.answers.len(), differences.largest > 0.0), (1000, !is_ours), "{}", caster.name);
            }
            let sets = vec![QuerySet::Box1, QuerySet::Grid];
            let rounds = Rounds { rounds: 2, seed: 1 };
            assert!(measure(&scene, &Arguments { scenes: Vec::new(), sets, rays: 300, rounds }).unwrap());
        }
    }
}
