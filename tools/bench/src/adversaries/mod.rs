//! `p2m-bench adversaries`: builds every backend over adversarial scenes, compares time, memory and visits with
//! budgets, and runs external libraries over the same scenes, for the tables of docs/adversaries.md.

mod external;
mod polygons;

pub(crate) use external::attempt;

use crate::blocks::Blocks;
use crate::memory;
use crate::our_indexes::{aabb_options, octree_options, p2m_options};
use crate::rounds::thread_seconds;
use anyhow::{Context, Result};
use external::{Outcome, QUERIES};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_bvh::{PacketTree, Volume};
use p2m_cli::harness::{Provenance, Table};
use p2m_core::{Aabb, BruteForce, ClosestPoint, IndexStats, PrimitiveSet, QueryCost, Soup};
use p2m_interception::{BuildStage, Progress};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::KdopTree;
use p2m_kdop::{Kdop, KdopOptions};
use p2m_testkit::adversaries::{ADVERSARIES, Adversary, queries};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// The blocks of docs/adversaries.md.
pub(crate) const BLOCKS: Blocks<5> =
    Blocks { command: "adversaries", names: ["provenance", "budgets", "scenes", "figures", "polygons"] };
/// Budgets apply to scenes of at least this many primitives.
const MIN_PRIMITIVES_FOR_BUDGET: usize = 10_000;

/// The budget of a backend, for each primitive.
struct Budget {
    name: &'static str,
    /// Microseconds of one thread for the build.
    build: f64,
    /// The largest number of bytes at any time of the build, without the scene.
    peak: usize,
    /// Bytes of the finished index.
    kept: usize,
}

const AABB: Budget = Budget { name: "aabb", build: 20.0, peak: 448, kept: 160 };
const KDOP: Budget = Budget { name: "kdop-14", build: 20.0, peak: 576, kept: 176 };
const OCTREE: Budget = Budget { name: "octree", build: 1000.0, peak: 2048, kept: 352 };
const P2M: Budget = Budget { name: "p2m", build: 2000.0, peak: 21_248, kept: 5632 };

impl Budget {
    /// Returns the row of the table of budgets.
    fn row(&self) -> Vec<String> {
        let Self { name, build, peak, kept } = self;
        vec![(*name).to_owned(), build.to_string(), peak.to_string(), kept.to_string()]
    }
}

/// The measured cost of an index.
struct BuildCost {
    /// Seconds of one thread for the build.
    build: f64,
    /// The largest number of bytes at any time of the build.
    peak: usize,
    kept: usize,
    depth: usize,
    /// The reason why the tree answers instead of cells, if it does.
    fallback: String,
}

/// A scene that is being measured.
struct Trial<'a> {
    adversary: &'static Adversary,
    soup: &'a Soup<f64>,
    queries: Vec<Point3<f64>>,
    expected: Vec<Option<(u64, usize)>>,
    table: &'a mut Table,
    good: bool,
}

impl Trial<'_> {
    /// Adds the row of an index.
    fn row<I: ClosestPoint<f64> + IndexStats<f64>>(&mut self, budget: &Budget, index: &I, taken: &BuildCost) {
        let count = self.soup.len();
        let allowed = count.max(MIN_PRIMITIVES_FOR_BUDGET);
        let answers = self.queries.iter().map(|q| index.closest_point(q)).map(key);
        let is_right = answers.eq(self.expected.iter().copied());
        let within = taken.build <= budget.build * 1e-6 * allowed as f64
            && taken.peak <= budget.peak * allowed
            && taken.kept <= budget.kept * allowed;
        self.good &= is_right && within;
        let visits = QueryCost::measure(index, &self.queries);
        let lengths = index.list_lengths();
        let longest = lengths.iter().max().map_or_else(String::new, usize::to_string);
        let each = |bytes: usize| (bytes / count).to_string();
        self.table.push(vec![
            self.adversary.name.to_owned(),
            budget.name.to_owned(),
            format!("{:.2}", taken.build * 1e6 / count as f64),
            each(taken.peak),
            each(taken.kept),
            taken.depth.to_string(),
            longest,
            format!("{:.0} / {}", visits.nodes.mean, visits.nodes.max),
            format!("{:.0} / {}", visits.packets.mean, visits.packets.max),
            format!("{:.0} / {}", visits.primitives.mean, visits.primitives.max),
            taken.fallback.clone(),
            match (is_right, within) {
                (true, true) => "yes",
                (true, false) => "EXCEEDED",
                (false, _) => "WRONG",
            }
            .to_owned(),
        ]);
    }
}

/// Adds the rows of external libraries, which have no budget.
fn add_external(adversary: &'static Adversary, count: usize, table: &mut Table) -> Result<()> {
    for name in external::LIBRARIES {
        let Outcome { build, wrong, end } = Outcome::by_this_program(name, adversary, count)?;
        let mut row = vec![String::new(); HEAD.len()];
        row[0] = adversary.name.to_owned();
        row[1] = name.to_owned();
        if let Some((seconds, peak, kept)) = build {
            row[2] = format!("{:.2}", seconds * 1e6 / count as f64);
            row[3] = (peak / count).to_string();
            row[4] = (kept / count).to_string();
        }
        row[HEAD.len() - 2] = end.unwrap_or_default();
        row[HEAD.len() - 1] =
            wrong.filter(|wrong| *wrong > 0).map_or_else(String::new, |wrong| format!("{wrong} wrong"));
        table.push(row);
    }
    Ok(())
}

fn key(closest: Option<p2m_core::Closest<f64>>) -> Option<(u64, usize)> {
    closest.map(|c| (c.distance.to_bits(), c.primitive.index()))
}

/// Measures the build of a tree from its first stage on.
fn measure_tree<V: Volume>(soup: &Soup<f64>, options: &V::Options) -> BuildCost {
    let before = memory::current();
    memory::reset_peak();
    let (tree, build) = thread_seconds(|| PacketTree::<V>::build(soup, options));
    let peak = memory::peak().saturating_sub(before);
    BuildCost { build, peak, kept: tree.memory(), depth: tree.depth(), fallback: String::new() }
}

/// Measures `build` from a stage on, and returns its result with the seconds and the peak. Allocations before that
/// stage are not counted.
fn measure_since<I>(stage: BuildStage, build: impl FnOnce(&(dyn Fn(Progress) + Sync)) -> I) -> (I, f64, usize) {
    let before = memory::current();
    let has_begun = AtomicBool::new(false);
    let report = |progress: Progress| {
        if progress.stage == stage && !has_begun.swap(true, Ordering::Relaxed) {
            memory::reset_peak();
        }
    };
    let (index, seconds) = thread_seconds(|| build(&report));
    let peak = if has_begun.into_inner() { memory::peak().saturating_sub(before) } else { 0 };
    (index, seconds, peak)
}

/// Adds the rows of a scene, and returns whether all budgets were kept and all answers are right.
fn add_rows(adversary: &'static Adversary, count: usize, table: &mut Table) -> Result<bool> {
    let soup = &adversary.soup(count);
    let queries = queries(soup, QUERIES);
    let brute = BruteForce::new(soup).context("an adversary is finite")?;
    let expected = queries.iter().map(|q| key(brute.closest_point(q))).collect();
    let mut trial = Trial { adversary, soup, queries, expected, table, good: true };

    let options = aabb_options();
    let tree = measure_tree::<Aabb<f64>>(soup, &options);
    trial.row(&AABB, &AabbTree::build_with(soup, &options)?, &tree);
    let options = KdopOptions::default().with_splits(aabb_options());
    let taken = measure_tree::<Kdop<14>>(soup, &options);
    trial.row(&KDOP, &KdopTree::<f64, _, 14>::build_with(soup, &options)?, &taken);

    let options = octree_options(1.0);
    let (index, build, peak) =
        measure_since(BuildStage::Tree, |progress| OctreeIndex::build_with_progress(soup, &options, progress));
    let index = index?;
    let report = index.report();
    let fallback = match report.list_cells + report.single_cells {
        0 => "the tree".to_owned(),
        _ if report.resolution < options.resolution => format!("resolution {:.3}", report.resolution),
        _ => "no".to_owned(),
    };
    trial.row(&OCTREE, &index, &BuildCost { build, peak, kept: index.memory(), depth: report.depth, fallback });

    let options = p2m_options();
    let (index, build, peak) =
        measure_since(BuildStage::Delaunay, |progress| P2mIndex::build_with_progress(soup, &options, progress));
    let index = index?;
    let report = index.report();
    let fallback = match report.list_cells {
        0 => "the tree".to_owned(),
        _ if report.fallback_cells > 0 => {
            format!(
                "{:.1} % of cells",
                100.0 * report.fallback_cells as f64 / (report.list_cells + report.fallback_cells) as f64
            )
        }
        _ => "no".to_owned(),
    };
    // The peak before the first stage of the cells is that of the tree.
    let peak = peak.max(tree.peak);
    trial.row(&P2M, &index, &BuildCost { build, peak, kept: index.memory(), depth: tree.depth, fallback });
    Ok(trial.good)
}

/// Publishes the blocks, and returns whether all budgets were kept and all answers are right.
pub(crate) fn run(count: usize, document: Option<&Path>, provenance: &Provenance) -> Result<bool> {
    BLOCKS.check(document)?;
    let mut table = Table::new(HEAD);
    let mut good = true;
    for adversary in ADVERSARIES {
        good &= add_rows(adversary, count, &mut table)?;
        add_external(adversary, count, &mut table)?;
    }
    let mut budgets = Table::new(["backend", "build us", "bytes while building", "bytes of the index"]);
    [AABB, KDOP, OCTREE, P2M].iter().for_each(|budget| budgets.push(budget.row()));
    let mut scenes = Table::new(["scene", "what it is"]);
    ADVERSARIES.iter().for_each(|a| scenes.push(vec![a.name.to_owned(), a.about.to_owned()]));
    let tables = [budgets, scenes, table].map(|table| table.to_string());
    let [budgets, scenes, figures] = tables;
    let (polygons, are_polygons_good) = polygons::table();
    good &= are_polygons_good;
    BLOCKS.publish(document, &[provenance.to_string(), budgets, scenes, figures, polygons.to_string()])?;
    println!(
        "{}",
        if good { "All budgets are kept, and all answers are right." } else { "EXCEEDED or WRONG, see above." }
    );
    Ok(good)
}

const HEAD: [&str; 12] = [
    "scene",
    "backend",
    "build us",
    "peak B",
    "index B",
    "depth",
    "longest list",
    "nodes",
    "packets",
    "evaluated",
    "way out",
    "kept",
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the counts only, because times and the memory of the process include those of other tests.
    #[test]
    fn small_adversaries_are_answered_as_brute_force_does() {
        for adversary in ADVERSARIES {
            let mut table = Table::new(HEAD);
            add_rows(adversary, p2m_testkit::amount(200, 40), &mut table).unwrap();
            let text = table.to_string();
            assert_eq!(["aabb", "kdop-14", "octree", "p2m"].map(|name| text.contains(name)), [true; 4], "{text}");
            assert!(!text.contains("WRONG"), "{text}");
        }
    }
}
