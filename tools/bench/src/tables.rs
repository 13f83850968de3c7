//! `p2m-bench tables`: measures scenes, indexes and sets of queries in one run, into one file of data.
//!
//! `cargo xtask figures` makes the tables and figures of the documents from this file.

use crate::command::{Rounds, provenance};
use crate::measure::{self, Entry, MedianRange};
use crate::scene::Scene;
use crate::{backends, report};
use anyhow::{Context, Result};
use clap::Args;
use p2m_testkit::all_model_files;
use p2m_testkit::queries::QuerySet;
use std::fmt::Write as _;
use std::path::PathBuf;

/// The scenes of the tables. Those whose files exist are measured.
const SCENES: [&str; 6] = [
    "bunny.obj",
    "dragon_100k.obj",
    "dragon_871k.ply",
    "mixed_armadillo_camel_wireframe.obj",
    "political_borders_lines.obj",
    "track_lines.obj",
];
/// The indexes of the tables.
const INDEXES: [&str; 15] = [
    "aabb",
    "kdop",
    "octree",
    "p2m",
    "aabb-batch",
    "kdop-batch",
    "octree-batch",
    "octree-batch-finest",
    "p2m-batch",
    "octree-avx2",
    "octree-batch-avx2",
    "aabb-f32",
    "parry3d",
    "parry3d-f64",
    "bvh",
];
const SETS: [QuerySet; 5] = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface, QuerySet::Grid];

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes, instead of those of the tables
    scenes: Vec<PathBuf>,
    /// The file of data
    #[arg(long, default_value = "docs/measurements/speed.csv")]
    data: PathBuf,
    #[command(flatten)]
    rounds: Rounds,
    /// Queries in a round
    #[arg(long, default_value_t = 200_000)]
    queries: usize,
    /// Number of times that each index is built
    #[arg(long, default_value_t = 5)]
    builds: usize,
}

/// Measures all scenes, and returns whether our answers agree.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let Arguments { scenes, data, rounds, queries, builds } = arguments;
    let is_listed = |path: &PathBuf| SCENES.iter().any(|name| path.ends_with(name));
    let scenes: Vec<PathBuf> =
        if scenes.is_empty() { all_model_files().into_iter().filter(is_listed).collect() } else { scenes.clone() };
    let selected: Vec<_> = INDEXES.map(backends::by_name).to_vec();
    let mut text = String::new();
    for line in provenance().to_string().lines() {
        writeln!(text, "# {line}")?;
    }
    writeln!(text, "# {}", rounds.describe("One thread; medians of thread CPU time", *queries, "queries"))?;
    let sets: Vec<String> = SETS.iter().map(|set| format!("{} ns", set.name())).collect();
    writeln!(text, "scene,index,primitives,build s,bytes,bytes with scene,peak bytes,{}", sets.join(","))?;
    let mut agree = true;
    for path in scenes {
        let scene = Scene::read(&path)?;
        eprintln!("{}", scene.describe());
        let mut entries = measure::build_all(&scene, &selected, *builds);
        for set in SETS {
            measure::measure(
                set.generate(&scene.double, *queries, rounds.seed),
                &mut entries,
                rounds.rounds,
                measure::affordable,
            );
        }
        report::print_scene(&scene, &SETS, &entries);
        agree &= report::is_clean(&entries);
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        for entry in entries.iter().filter(|entry| entry.index.is_ok()) {
            writeln!(text, "{name},{},{},{}", entry.backend.name, scene.len(), row(&scene, entry))?;
        }
    }
    std::fs::write(data, text).with_context(|| data.display().to_string())?;
    Ok(agree)
}

/// Returns the figures of an index.
fn row(scene: &Scene, entry: &Entry) -> String {
    let build = &entry.build;
    let seconds = MedianRange::of(&build.seconds).map_or(String::new(), |s| format!("{:.5}", s.median));
    let bytes = |bytes: usize| format!("{:.1}", bytes as f64 / scene.len() as f64);
    let memory = [build.owned, build.owned + build.borrowed, build.peak].map(bytes);
    let nanoseconds = entry.sets.iter().map(|set| {
        let figures = set.as_ref().ok().and_then(|set| MedianRange::of(&set.nanoseconds));
        figures.map_or(String::new(), |ns| format!("{:.1}", ns.median))
    });
    std::iter::once(seconds).chain(memory).chain(nanoseconds).collect::<Vec<_>>().join(",")
}
