//! `p2m-bench refit`: compares a tree that was refitted to a moved scene with trees and cells that were built anew.

use crate::measure::{Effort, MedianRange};
use crate::our_indexes::aabb_options;
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::{Context, Result};
use nalgebra::{Point3, Rotation3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{BuildIndex, ClosestPoint, PrimitiveSet, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::hint::black_box;

/// The angles by which one end of a scene is turned against the other, in degrees.
const TWISTS: [f64; 6] = [0.0, 45.0, 90.0, 180.0, 360.0, 1080.0];

/// Prints the quality and the speed of refitted and of rebuilt trees over twisted forms of a scene. Returns whether both
/// have the same answers.
pub(crate) fn print(scene: &Scene, sets: &[QuerySet], effort: &Effort) -> Result<bool> {
    let soup = &*scene.double;
    let checked = "the scene was checked when it was read";
    let mut tree = AabbTree::build(soup.clone(), &Default::default()).context(checked)?;
    let area = tree.surface_area();
    let head = ["twist", "area", "refit ms", "build ms"].map(str::to_owned).into_iter();
    let mut table = Table::new(head.chain(sets.iter().map(|set| format!("{}, refit / built", set.name()))));
    let mut equal = true;
    for degrees in TWISTS {
        let twisted = twisted(soup, degrees.to_radians())?;
        let mut times = [Vec::new(), Vec::new()];
        let mut rebuilt = None;
        for _ in 0..effort.rounds {
            let positions = twisted.positions().to_vec();
            let (refitted, seconds) =
                thread_seconds(|| tree.refit_in_place(&aabb_options(), |soup| soup.set_positions(positions)));
            refitted.context(checked)?;
            times[0].push(seconds);
            let (built, seconds) = thread_seconds(|| AabbTree::build(&twisted, &aabb_options()));
            times[1].push(seconds);
            rebuilt = Some(built.context(checked)?);
        }
        let rebuilt = rebuilt.context("at least one round")?;
        let median = |times: &[f64]| MedianRange::of(times).map_or(f64::NAN, |range| range.median);
        let mut row = vec![
            format!("{degrees}"),
            format!("{:.2}", tree.surface_area() / area),
            format!("{:.0}", median(&times[0]) * 1e3),
            format!("{:.0}", median(&times[1]) * 1e3),
        ];
        for set in sets {
            let queries = set.generate(&twisted, effort.queries, effort.seed);
            let mut seconds = [Vec::new(), Vec::new()];
            for _ in 0..effort.rounds {
                for (index, seconds) in [&tree as &dyn ClosestPoint<f64>, &rebuilt].into_iter().zip(&mut seconds) {
                    seconds.push(
                        thread_seconds(|| {
                            queries.iter().for_each(|q| {
                                black_box(distance(index, q));
                            })
                        })
                        .1,
                    );
                }
            }
            equal &= queries.iter().all(|query| distance(&tree, query) == distance(&rebuilt, query));
            let [refit, built] = seconds.map(|seconds| median(&seconds) * 1e9 / queries.len() as f64);
            row.push(format!("{refit:.0} / {built:.0}"));
        }
        table.push(row);
    }
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let octree = one_thread.install(|| thread_seconds(|| OctreeIndex::build(soup, &Default::default())).1);
    let p2m = one_thread.install(|| thread_seconds(|| P2mIndex::build(soup, &Default::default())).1);
    println!(
        "\n## {}\n\nThe surface area is relative to that of the tree before the motion. Queries are in ns.\n\n{table}\n\
         The octree and the P2M index have no refit: a build takes {octree:.2} s and {p2m:.2} s of CPU time.\n",
        scene.describe()
    );
    Ok(equal)
}

fn distance(index: &(impl ClosestPoint<f64> + ?Sized), query: &Point3<f64>) -> Option<f64> {
    index.closest_point(query).map(|closest| closest.distance)
}

/// Turns each position about the x axis through the centre, by an angle that grows along the axis up to `angle`.
fn twisted(soup: &Soup<f64>, angle: f64) -> Result<Soup<f64>> {
    let bounds = soup.aabb();
    let centre = nalgebra::center(&bounds.min, &bounds.max);
    let length = (bounds.max.x - bounds.min.x).max(f64::MIN_POSITIVE);
    let mut twisted = soup.clone();
    twisted.map_positions(|p| {
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), angle * (p.x - bounds.min.x) / length);
        centre + turn * (p - centre)
    })?;
    Ok(twisted)
}
