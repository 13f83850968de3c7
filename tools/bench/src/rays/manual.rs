//! Redraws the ray tables of the manual: nodes and leaves visited, and seconds of four functions.

use super::backend::{Function, RayIndex};
use super::backends::by_name;
use super::measure::{Competitor, Figures, first_chunk, measure, verify};
use crate::backend::catch;
use crate::measure::{Effort, MedianRange};
use crate::scene::Scene;
use anyhow::{Result, anyhow};
use p2m_core::Ray;
use p2m_kdop::Directions;
use p2m_testkit::left_first::LeftFirst;
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;

const COLUMNS: [&str; 5] = ["aabb", "kdop-6", "kdop-14", "kdop-18", "kdop-26"];
const HEAD: [&str; 5] = ["AABB", "6-DOP", "14-DOP", "18-DOP", "26-DOP"];

/// The number of rays for each primitive, which is that of the manual.
pub(crate) const RAYS_EACH: usize = 20;

/// The manual's numbers of rays, on the gear of 56,700 and on the bunny of 265,088 triangles.
const CITED_RAYS: [f64; 2] = [1_134_000.0, 5_301_760.0];
/// The manual's nodes visited by all intersections with the gear turned by pi / 4 about both axes.
const CITED_NODES: [f64; 5] = [675_121_081.0, 675_121_081.0, 380_445_767.0, 328_388_685.0, 292_286_940.0];
const CITED_LEAVES: [f64; 5] = [168_794_139.0, 168_794_139.0, 73_849_181.0, 53_532_425.0, 42_911_934.0];
/// The manual's seconds for all rays, in the order of [`Function::ALL`].
const CITED_SECONDS: [(&str, [[f64; 5]; 4]); 2] = [
    (
        "gear",
        [
            [5.5, 4.596, 4.14, 4.44, 5.128],
            [5.156, 4.428, 4.128, 4.276, 5.052],
            [11.576, 11.708, 9.152, 8.836, 9.916],
            [25.472, 22.656, 19.664, 19.348, 21.908],
        ],
    ),
    (
        "bunny",
        [
            [7.996, 7.264, 10.6, 12.496, 15.748],
            [7.692, 7.160, 10.268, 12.08, 15.436],
            [17.856, 18.264, 20.94, 23.912, 28.804],
            [36.188, 31.984, 36.272, 40.624, 49.496],
        ],
    ),
];

fn row(name: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Vec<String> {
    std::iter::once(name.into()).chain(cells).collect()
}

/// Prints the table of the manual's own figures.
pub(crate) fn print_cited() {
    let mut table = Table::new(std::iter::once("cited from the manual").chain(HEAD));
    for (name, counts) in [("nodes", CITED_NODES), ("leaves", CITED_LEAVES)] {
        table.push(row(format!("gear, {name} of all rays"), counts.map(|count| format!("{count:.0}"))));
        table.push(row(format!("gear, {name} per ray"), counts.map(|count| format!("{:.1}", count / CITED_RAYS[0]))));
    }
    for ((name, rows), rays) in CITED_SECONDS.iter().zip(CITED_RAYS) {
        for (function, seconds) in Function::ALL.iter().zip(rows) {
            table.push(row(format!("{name}, {} of {rays} rays, s", function.name()), seconds.map(|s| s.to_string())));
        }
    }
    println!("\n{table}");
}

/// Prints the table of a scene, and returns whether all trees agree.
pub(crate) fn print(scene: &Scene, set: QuerySet, effort: &Effort) -> Result<bool> {
    let build = |name: &&str| -> Result<RayIndex<'_>> {
        let index = (by_name(name)?.prepare)(scene).and_then(|prepared| catch(prepared.build));
        index.map_err(|absent| anyhow!("{name}: {}", absent.0))
    };
    let indexes = COLUMNS.iter().map(build).collect::<Result<Vec<_>>>()?;
    let rays = first_chunk(scene, set, effort);
    println!("\n## {}, {} rays from {set}\n", scene.describe(), effort.queries);
    let agreement = verify(scene, &rays)?;
    let mut table = Table::new(std::iter::once("per ray, all intersections").chain(HEAD));
    let works = indexes.iter().filter_map(|index| match index {
        RayIndex::Ours(index) => Some(index.work(&rays.ours).map(|sum| sum as f64 / rays.len() as f64)),
        RayIndex::External(_) => None,
    });
    let works: Vec<_> = works.collect();
    for (at, name) in ["nodes of eight", "packets", "primitives tested exactly"].into_iter().enumerate() {
        table.push(row(name, works.iter().map(|work| format!("{:.2}", work[at]))));
    }
    let some: Vec<&Ray> = rays.ours.iter().step_by(20).collect();
    let left_first = [
        left_first::<6>(scene, &some),
        left_first::<14>(scene, &some),
        left_first::<18>(scene, &some),
        left_first::<26>(scene, &some),
    ];
    for (at, name) in ["binary nodes, the manual's traversal", "leaves, the manual's traversal"].into_iter().enumerate()
    {
        let cells = left_first.iter().map(|work| format!("{:.1}", work[at]));
        // A box is the polytope of six faces, so the first value stands in both columns.
        table.push(row(name, cells.clone().take(1).chain(cells)));
    }
    println!("{table}");
    let with_all_trees = |function| indexes.iter().map(move |index| Competitor { index, function });
    let competitors: Vec<_> = Function::ALL.into_iter().flat_map(with_all_trees).collect();
    let figures = measure(scene, set, &competitors, effort);
    let mut table = Table::new(std::iter::once("s, all rays").chain(HEAD));
    for (function, figures) in Function::ALL.iter().zip(figures.chunks(COLUMNS.len())) {
        table.push(row(
            function.name(),
            figures.iter().map(|f| MedianRange::of(&f.seconds).map_or("-".to_owned(), |s| format!("{:.3}", s.median))),
        ));
    }
    println!("{table}");
    let hits = figures.last().map_or(0, |all| all.hits);
    println!("{hits} hits in all. {}", agreement.as_ref().unwrap_or_else(|difference| difference));
    let clean = figures.iter().all(|f| f.failure.is_none() && f.differences.is_clean());
    if !clean {
        println!(
            "DIFFERENCES: {:?}",
            figures.iter().map(|Figures { differences, .. }| differences).collect::<Vec<_>>()
        );
    }
    Ok(clean && agreement.is_ok())
}

/// Returns the nodes and leaves that the manual's traversal visits per ray.
fn left_first<const K: usize>(scene: &Scene, rays: &[&Ray]) -> [f64; 2]
where
    Directions<K>: Default,
{
    let tree = LeftFirst::<K>::from_primitives(&*scene.double, &Directions::default());
    let work = tree.along_all(rays.iter().copied());
    [work.nodes, work.leaves].map(|sum| sum as f64 / rays.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_printed_and_all_agree() {
        let scene = Scene::new("test".into(), p2m_testkit::scenes::skewed_gear(30)).unwrap();
        let effort = Effort { rounds: 2, queries: 100, builds: 1, seed: 1 };
        assert!(print(&scene, QuerySet::Box1, &effort).unwrap());
        print_cited();
    }
}
