//! `p2m-bench ray`: times the first hits of rays by our trees and by parry3d, and compares them.
//!
//! Rays begin at the points of a query set and have directions that are evenly distributed on the sphere. parry3d
//! promises nothing about rays through edges, and a parameter of f32 is as accurate as its rounding.

use crate::backend::Scalar;
use crate::command::{Rounds, all_good, at_least_one};
use crate::measure::MedianRange;
use crate::our_indexes::{aabb_options, kdop_options};
use crate::report::significant;
use crate::rounds::{rotated, thread_seconds};
use crate::scene::{Scene, single_point};
use anyhow::Result;
use clap::Args;
use nalgebra::{Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::{BuildIndex, Ray, RayQuery};
use p2m_kdop::KdopTree;
use p2m_testkit::queries::QuerySet;
use std::hint::black_box;
use std::path::PathBuf;

/// The largest difference of parameters that rounding of the input to f32 explains, relative to the parameter and the
/// diagonal of the box: a thousand units of the last place.
const ROUNDING: f64 = 1000.0 / (1u32 << 24) as f64;
/// The method of parry3d that returns the triangle, the parameter and the normal, in f32.
const YARDSTICK: &str = "parry3d";
/// The method of parry3d that returns the parameter alone, in f32.
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

/// Rays in the representation of each competitor.
struct Rays {
    ours: Vec<Ray>,
    double: Vec<(Point3<f64>, Vector3<f64>)>,
    single: Vec<(Point3<f32>, Vector3<f32>)>,
}

impl Rays {
    fn new(ours: Vec<Ray>) -> Self {
        let double: Vec<_> = ours.iter().map(|ray| (ray.origin(), ray.direction())).collect();
        let single = double.iter().map(|(o, d)| (single_point(o), single_point(&Point3::from(*d)).coords)).collect();
        Self { ours, double, single }
    }
}

/// The parameter of the first hit, and the id of the primitive, if the competitor returns it.
type Outcome = Option<(f64, usize)>;
/// A function that answers all rays, one by one. Its loop is compiled for each competitor.
type Cast<'a> = dyn Fn(&Rays, &mut [Outcome]) + 'a;

/// A competitor that casts rays.
struct Caster<'a> {
    name: &'static str,
    is_ours: bool,
    cast: Box<Cast<'a>>,
}

impl<'a> Caster<'a> {
    fn ours(name: &'static str, index: impl RayQuery<f64> + 'a) -> Self {
        let cast = move |rays: &Rays, outcomes: &mut [Outcome]| {
            for (ray, outcome) in rays.ours.iter().zip(outcomes) {
                // `black_box` keeps the compiler from leaving out a part of the hit.
                let hit = black_box(index.first_intersection(ray));
                *outcome = hit.map(|hit| (hit.parameter, hit.primitive.index()));
            }
        };
        Self { name, is_ours: true, cast: Box::new(cast) }
    }
}

/// Generates a function that makes casters of one of the two crates of parry, which have the same names for different
/// types. Scenes with other primitives than triangles have none.
macro_rules! parry {
    ($name:ident, $parry:ident, $scalar:ty, $rays:ident) => {
        fn $name(scene: &Scene, name: &'static str, with_normal: bool) -> Option<Caster<'static>> {
            use $parry::math::Vector;
            use $parry::query::RayCast;
            let (soup, _) = <$scalar as Scalar>::soup(scene).ok()?;
            if soup.triangles().is_empty() || !soup.points().is_empty() || !soup.segments().is_empty() {
                return None;
            }
            let positions = soup.positions().iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
            let mesh = $parry::shape::TriMesh::new(positions, soup.triangles().to_vec()).ok()?;
            let cast = move |rays: &Rays, outcomes: &mut [Outcome]| {
                for ((o, d), outcome) in rays.$rays.iter().zip(outcomes) {
                    let ray = $parry::query::Ray::new(Vector::new(o.x, o.y, o.z), Vector::new(d.x, d.y, d.z));
                    *outcome = if with_normal {
                        let hit = black_box(mesh.cast_local_ray_and_get_normal(&ray, <$scalar>::MAX, false));
                        hit.map(|hit| (hit.time_of_impact.into(), hit.subshape as usize))
                    } else {
                        let parameter = mesh.cast_local_ray(&ray, <$scalar>::MAX, false);
                        parameter.map(|parameter| (parameter.into(), usize::MAX))
                    };
                }
            };
            Some(Caster { name, is_ours: false, cast: Box::new(cast) })
        }
    };
}

parry!(parry_single, parry3d, f32, single);
parry!(parry_double, parry3d_f64, f64, double);

fn casters(scene: &Scene) -> Result<Vec<Caster<'_>>> {
    let soup = &*scene.double;
    let mut all = vec![
        Caster::ours("aabb", AabbTree::build(soup, &aabb_options())?),
        Caster::ours("kdop-6", KdopTree::<f64, _, 6>::build(soup, &kdop_options())?),
        Caster::ours("kdop-14", KdopTree::<f64, _, 14>::build(soup, &kdop_options())?),
        Caster::ours("kdop-18", KdopTree::<f64, _, 18>::build(soup, &kdop_options())?),
        Caster::ours("kdop-26", KdopTree::<f64, _, 26>::build(soup, &kdop_options())?),
    ];
    all.extend(parry_single(scene, YARDSTICK, true));
    all.extend(parry_single(scene, YARDSTICK_PARAMETER, false));
    all.extend(parry_double(scene, "parry3d-f64", true));
    Ok(all)
}

/// Times rays, and returns whether all our trees agree bit for bit.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let about = arguments.rounds.describe("One thread, thread CPU time", arguments.rays, "rays");
    all_good(&arguments.scenes, &about, |scene| measure(&scene, arguments))
}

fn measure(scene: &Scene, arguments: &Arguments) -> Result<bool> {
    let Rounds { rounds, seed } = arguments.rounds;
    let casters = casters(scene)?;
    let mut rows: Vec<Vec<String>> = casters.iter().map(|caster| vec![caster.name.to_owned()]).collect();
    let (mut notes, mut is_good) = (Vec::new(), true);
    for set in &arguments.sets {
        let rays = Rays::new(set.rays(&scene.double, arguments.rays, seed));
        let count = rays.ours.len();
        let mut outcomes = vec![vec![None; count]; casters.len()];
        let mut seconds = vec![Vec::new(); casters.len()];
        for round in 0..rounds {
            for at in rotated(casters.len(), round) {
                let spent = thread_seconds(|| (casters[at].cast)(black_box(&rays), &mut outcomes[at])).1;
                seconds[at].push(spent);
            }
        }
        let spreads: Vec<MedianRange> = seconds.iter().filter_map(|seconds| MedianRange::of(seconds)).collect();
        let references = [YARDSTICK, YARDSTICK_PARAMETER]
            .map(|name| Some(spreads[casters.iter().position(|caster| caster.name == name)?].median));
        for (row, spread) in rows.iter_mut().zip(&spreads) {
            let [median, minimum] = [spread.median, spread.min].map(|s| s * 1e9 / count as f64);
            let [mesh, parameter] = references
                .map(|reference| reference.map_or("-".to_owned(), |reference| significant(reference / spread.median)));
            row.push(format!("{median:.0} ({minimum:.0}), {mesh} / {parameter}"));
        }
        notes.push(format!("{set}: {} of {count} rays hit.", outcomes[0].iter().flatten().count()));
        for (caster, found) in casters.iter().zip(&outcomes) {
            let differences = Differences::new(found, &outcomes[0], caster.is_ours, scene.diagonal());
            is_good &= !caster.is_ours || differences.is_clean();
            if !caster.is_ours || !differences.is_clean() {
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
    /// The number of rays that hit for the reference only.
    missed: usize,
    /// The number of rays that hit for this competitor only.
    added: usize,
    /// The number of rays with other hits: in any bit for our trees, by more than rounding for other libraries.
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
            let casters = casters(&scene).unwrap();
            assert_eq!(casters.len(), competitors);
            let rays = Rays::new(QuerySet::Box1.rays(&scene.double, 1000, 1));
            let mut outcomes = vec![vec![None; 1000]; competitors];
            for (caster, outcomes) in casters.iter().zip(&mut outcomes) {
                (caster.cast)(&rays, outcomes);
            }
            assert!(outcomes[0].iter().flatten().count() > hits);
            for (caster, found) in casters.iter().zip(&outcomes) {
                let differences = Differences::new(found, &outcomes[0], caster.is_ours, scene.diagonal());
                assert!(differences.is_clean(), "{} {differences}", caster.name);
                assert_eq!(differences.largest > 0.0, !caster.is_ours, "{}", caster.name);
            }
            let sets = vec![QuerySet::Box1, QuerySet::Grid];
            let rounds = Rounds { rounds: 2, seed: 1 };
            assert!(measure(&scene, &Arguments { scenes: Vec::new(), sets, rays: 300, rounds }).unwrap());
        }
    }
}
