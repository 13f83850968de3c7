//! `p2m-bench kdop`: redraws the distance figures in the manual of CGAL's k-DOP tree.
//!
//! For each scene and number of faces it prints the build time, the nodes and leaves visited, and the time per query.
//! Counters of the manual's traversal (left child first, the largest slack as the bound) stand beside ours.

use crate::backend::Backend;
use crate::backends::by_name;
use crate::measure::{Effort, MedianRange, build_all, measure_set};
use crate::our_indexes::scene_directions;
use crate::scene::Scene;
use anyhow::Result;
use nalgebra::{Point3, Rotation3, Vector3};
use p2m_bvh::{AabbOptions, AabbTree};
use p2m_core::{BuildIndex, Soup, StatsCollector};
use p2m_kdop::{DirectionChoice, Directions, KdopOptions, KdopTree};
use p2m_testkit::left_first::LeftFirst;
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::f64::consts::PI;

/// Rotation angles about the x axis and then the y axis, in multiples of pi.
const ORIENTATIONS: [[f64; 2]; 7] =
    [[0.0, 0.0], [0.125, 0.0], [0.25, 0.0], [0.0, 0.125], [0.0, 0.25], [0.125, 0.125], [0.25, 0.25]];

const COLUMNS: [&str; 6] = ["aabb", "kdop-6", "kdop-14", "kdop-18", "kdop-26", "kdop-scene"];

/// Nodes and leaves visited per query.
type Work = [f64; 2];

/// Returns the scene in each orientation.
pub(crate) fn orientations(scene: &Scene) -> Result<Vec<Scene>> {
    let turned = |[x, y]: [f64; 2]| {
        let rotation = Rotation3::from_axis_angle(&Vector3::y_axis(), y * PI)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), x * PI);
        let positions = scene.double.positions().iter().map(|p| rotation * p).collect();
        Scene::new(
            format!("{} turned by {x} pi about x, {y} pi about y", scene.name),
            Soup::new(positions, scene.double.elements())?,
        )
    };
    ORIENTATIONS.into_iter().map(turned).collect()
}

/// Prints the table of a scene, and returns whether all trees agree.
pub(crate) fn print(scene: &Scene, set: QuerySet, effort: &Effort) -> bool {
    let backends: Vec<&'static Backend> = COLUMNS.iter().map(|name| by_name(name)).collect();
    let mut entries = build_all(scene, &backends, effort.builds);
    measure_set(scene, set, &mut entries, effort);
    let queries = set.generate(&scene.double, effort.queries, effort.seed);
    let choice = scene_directions(scene);
    let work = [
        (boxes(scene, &queries), None),
        work_of_default::<6>(scene, &queries),
        work_of_default::<14>(scene, &queries),
        work_of_default::<18>(scene, &queries),
        work_of_default::<26>(scene, &queries),
        (work_of_scene(scene, &choice, &queries), None),
    ];
    let mut table = Table::new(["per query", "AABB", "6-DOP", "14-DOP", "18-DOP", "26-DOP", "scene"]);
    let row = |name: &str, cells: Vec<String>| std::iter::once(name.to_owned()).chain(cells).collect::<Vec<_>>();
    let median = |values: &[f64]| MedianRange::of(values).map_or(f64::NAN, |s| s.median);
    let minimum = |values: &[f64]| MedianRange::of(values).map_or(f64::NAN, |s| s.min);
    table.push(row("build s", entries.iter().map(|e| format!("{:.4}", median(&e.build.seconds))).collect()));
    table.push(row("nodes of eight", work.iter().map(|(w, _)| format!("{:.2}", w[0])).collect()));
    table.push(row("packets", work.iter().map(|(w, _)| format!("{:.2}", w[1])).collect()));
    let left = |at: usize| {
        work.iter().map(|(_, left)| left.map_or(String::new(), |left| format!("{:.1}", left[at]))).collect()
    };
    table.push(row("binary nodes, left first", left(0)));
    table.push(row("leaves, left first", left(1)));
    let mut clean = true;
    let mut times = [Vec::new(), Vec::new()];
    for entry in &entries {
        let figures = entry.sets[0].as_ref().expect("ours are never absent");
        clean &= figures.agreement.is_clean();
        times[0].push(format!("{:.0}", median(&figures.nanoseconds)));
        times[1].push(format!("{:.0}", minimum(&figures.nanoseconds)));
    }
    let [medians, minima] = times;
    table.push(row("ns, median", medians));
    table.push(row("ns, minimum", minima));
    println!("\n## {}\n\nThe scene: 14 {choice}.\n\n{table}", scene.describe());
    clean
}

fn count(queries: &[Point3<f64>], visit: impl Fn(&Point3<f64>, &mut StatsCollector<f64>)) -> Work {
    let [nodes, packets, _] = StatsCollector::count_queries(queries, visit);
    [nodes, packets].map(|sum| sum as f64 / queries.len() as f64)
}

fn boxes(scene: &Scene, queries: &[Point3<f64>]) -> Work {
    let tree = AabbTree::build(&*scene.double, &AabbOptions::default()).expect("built before");
    count(queries, |query, counting| tree.visit(query, counting))
}

/// Returns the work of our tree over all queries, and of the manual's traversal over every twentieth query.
fn work_of_default<const K: usize>(scene: &Scene, queries: &[Point3<f64>]) -> (Work, Option<Work>)
where
    Directions<K>: Default,
{
    let tree = KdopTree::<f64, _, K>::build(&*scene.double, &KdopOptions::default()).expect("built before");
    let work = count(queries, |query, counting| tree.visit(query, counting));
    let left_first = LeftFirst::from_packets(tree.tree());
    let some: Vec<_> = queries.iter().step_by(20).collect();
    let mut sums = [0usize; 2];
    for query in &some {
        let (_, work) = left_first.distance(&&*scene.double, query);
        sums = [sums[0] + work.nodes, sums[1] + work.leaves];
    }
    (work, Some(sums.map(|sum| sum as f64 / some.len() as f64)))
}

fn work_of_scene(scene: &Scene, choice: &DirectionChoice, queries: &[Point3<f64>]) -> Work {
    let directions = choice.directions::<14>().expect("seven directions");
    let tree = KdopTree::build_with(&*scene.double, &KdopOptions::new(directions)).expect("built before");
    count(queries, |query, counting| tree.visit(query, counting))
}
