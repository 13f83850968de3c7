//! `p2m-bench octree`: compares the settings of the octree: resolution, domain and number of threads.

use crate::backend::Backend;
use crate::measure::{Effort, MedianRange, build_all, measure_set};
use crate::our_indexes::{octree_options, over_soup_with};
use crate::scene::Scene;
use anyhow::{Context, Result};
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, BuildIndex, PrimitiveSet};
use p2m_interception::{Domain, OctreeIndex, OctreeOptions};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::time::Instant;

/// The options of a setting for a scene.
type Options = fn(&Scene) -> OctreeOptions;

/// The settings under their names in the table.
const SETTINGS: [(&str, Options); 7] = [
    ("usual", |_| octree_options(1.0)),
    ("a hundredth", |_| octree_options(0.01)),
    ("a tenth", |_| octree_options(0.1)),
    ("threefold", |_| octree_options(3.0)),
    ("tenfold", |_| octree_options(10.0)),
    ("box", |scene| octree_options(1.0).with_domain(Domain::Box(queried(scene)))),
    ("band", |scene| octree_options(1.0).with_domain(Domain::Band(0.03 * scene.diagonal()))),
];

/// Returns the box of the query set 1x.
fn queried(scene: &Scene) -> Aabb<f64> {
    let bounds = scene.double.aabb();
    let (centre, half_extent) = (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min) * (1.05 / 2.0));
    let corner = |offset: Vector3<f64>| Point3::from(centre.coords + offset);
    Aabb { min: corner(-half_extent), max: corner(half_extent) }
}

/// Prints the table of a scene, and returns whether all indexes agree.
pub(crate) fn print(scene: &Scene, sets: &[QuerySet], threads: &[usize], effort: &Effort) -> Result<bool> {
    let backends =
        SETTINGS.map(|(name, options)| Backend::new(name, move |s| over_soup_with::<OctreeIndex<_, _>>(s, options(s))));
    let mut entries = build_all(scene, &backends.each_ref(), 1);
    for set in sets {
        measure_set(scene, *set, &mut entries, effort);
    }
    let build_columns = threads.iter().map(|n| format!("build s, {n} thr"));
    let fixed = ["resolution", "lists", "B/primitive"].map(str::to_owned);
    let head = std::iter::once("setting".to_owned()).chain(build_columns).chain(fixed);
    let mut table = Table::new(head.chain(sets.iter().map(ToString::to_string)));
    let mut clean = true;
    for ((name, options), entry) in SETTINGS.iter().zip(&entries) {
        let mut options = options(scene);
        options.splits.parallel = true;
        let mut row = vec![(*name).to_owned()];
        let mut report = None;
        for &count in threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
            let mut seconds = Vec::new();
            for _ in 0..effort.builds {
                let start = Instant::now();
                let index = pool.install(|| OctreeIndex::build(&*scene.double, &options));
                seconds.push(start.elapsed().as_secs_f64());
                report = Some(index.context("the scene was checked when it was read")?.report());
            }
            row.push(format!("{:.3}", MedianRange::of(&seconds).map_or(f64::NAN, |s| s.median)));
        }
        let report = report.context("no threads to build with")?;
        row.push(format!("{:.4}", report.resolution));
        row.push(report.lists.to_string());
        row.push(format!("{:.0}", (report.bytes + report.tree_bytes) as f64 / scene.double.len() as f64));
        for figures in &entry.sets {
            let figures = figures.as_ref().ok().context("ours are never absent")?;
            clean &= figures.agreement.is_clean();
            row.push(format!("{:.0}", MedianRange::of(&figures.nanoseconds).map_or(f64::NAN, |s| s.median)));
        }
        table.push(row);
    }
    println!("\n## {}\n", scene.describe());
    println!("Builds in wall time, queries in nanoseconds of thread CPU time; medians.\n\n{table}");
    Ok(clean)
}
