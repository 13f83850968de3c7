//! `p2m-bench splits`: compares the split rules of the AABB tree.

use crate::backend::Backend;
use crate::measure::{Effort, MedianRange, build_all, measure_set};
use crate::our_indexes::over_soup_with;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::{AabbOptions, AabbTree, SplitRule};
use p2m_core::BuildIndex;
use p2m_core::StatsCollector;
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;

fn options(rule: SplitRule) -> AabbOptions {
    AabbOptions::default().with_parallel(false).with_rule(rule)
}

/// Prints the tables of a scene, and returns whether all trees agree.
pub(crate) fn print(scene: &Scene, sets: &[QuerySet], effort: &Effort) -> bool {
    let backends = SplitRule::ALL
        .map(|rule| Backend::new(rule.name(), move |s| over_soup_with::<AabbTree<_, _>>(s, options(rule))));
    let mut entries = build_all(scene, &backends.each_ref(), effort.builds);
    for set in sets {
        measure_set(scene, *set, &mut entries, effort);
    }
    let mut table = Table::new(["split", "build s", "nodes", "depth"].into_iter().chain(sets.iter().map(|s| s.name())));
    let mut clean = true;
    for (rule, entry) in SplitRule::ALL.iter().zip(&entries) {
        let tree = AabbTree::build(&*scene.double, &options(*rule)).expect("built before");
        let (nodes, depth) = tree.tree().parts().fold((0, 0), |(n, deepest), part| (n + 1, part.depth.max(deepest)));
        let seconds = MedianRange::of(&entry.build.seconds).map_or(f64::NAN, |s| s.median);
        let mut row =
            vec![entry.backend.name.to_owned(), format!("{seconds:.4}"), nodes.to_string(), depth.to_string()];
        for (set, figures) in sets.iter().zip(&entry.sets) {
            let figures = figures.as_ref().expect("ours are never absent");
            clean &= figures.agreement.is_clean();
            let [nodes, primitives] = work(&tree, &set.generate(&scene.double, effort.queries, effort.seed));
            let ns = MedianRange::of(&figures.nanoseconds).map_or(f64::NAN, |s| s.median);
            row.push(format!("{nodes:.1} / {primitives:.1} / {ns:.0}"));
        }
        table.push(row);
    }
    println!("\n## {}\n", scene.describe());
    println!("Per query: nodes visited / primitives offered / nanoseconds (median).\n");
    println!("{table}");
    clean
}

/// Returns the nodes visited and the primitives offered per query, which are deterministic.
fn work<S: p2m_core::PrimitiveSet<f64>>(tree: &AabbTree<f64, S>, queries: &[Point3<f64>]) -> [f64; 2] {
    let [nodes, _, primitives] = StatsCollector::count_queries(queries, |query, counting| tree.visit(query, counting));
    [nodes, primitives].map(|sum| sum as f64 / queries.len() as f64)
}
