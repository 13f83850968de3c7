//! `p2m-bench saved`: compares the cost of saving and loading an index with that of building it.

use crate::measure::MedianRange;
use crate::scene::Scene;
use anyhow::Result;
use p2m_backends::{BACKENDS, BuildSettings};
use p2m_core::storage::{SavedFile, Writer};
use p2m_mixed::{load_scene, save_scene};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;
use std::time::Instant;

/// The number of queries whose answers are compared.
const QUERIES: usize = 10_000;

/// Prints the table of a scene, and returns whether loaded indexes answer as those that were built.
pub(crate) fn print(scene: &Scene, rounds: usize) -> Result<bool> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("index.p2m");
    let queries = QuerySet::Box1.generate(&scene.double, QUERIES, 1);
    let file_scene = p2m_mixed::Scene::from((*scene.double).clone());
    let mut table = Table::new(HEAD);
    let mut clean = true;
    for backend in BACKENDS.iter().filter(|backend| backend.is_saveable()) {
        let start = Instant::now();
        let built = backend.build(Arc::clone(&scene.double), &BuildSettings::default().with_parallel(false))?;
        let build = start.elapsed().as_secs_f64();
        let mut writer = Writer::default();
        save_scene(&file_scene, &mut writer);
        built.save(&mut writer);
        let start = Instant::now();
        writer.write(BufWriter::new(File::create(&path)?))?;
        let write = start.elapsed().as_secs_f64();
        let (mut starts, mut scenes, mut checks) = (Vec::new(), Vec::new(), Vec::new());
        for round in 0..rounds {
            let start = Instant::now();
            let file = SavedFile::open(&path)?;
            let opened = start.elapsed();
            file.checked()?;
            let checked = start.elapsed();
            let again = load_scene(file.unchecked())?;
            let loaded = start.elapsed();
            let index = backend.load(again.soup, file.unchecked())?.index;
            starts.push((start.elapsed() - checked + opened).as_secs_f64() * 1e3);
            scenes.push((loaded - checked).as_secs_f64() * 1e3);
            checks.push((checked - opened).as_secs_f64() * 1e3);
            if round == 0 {
                clean &= queries.iter().all(|q| index.closest_point(q) == built.index.closest_point(q));
            }
        }
        let [start, of_scene, check] =
            [&starts, &scenes, &checks].map(|all| MedianRange::of(all).map_or(f64::NAN, |s| s.median));
        table.push(vec![
            backend.name.to_owned(),
            format!("{build:.3}"),
            format!("{:.1}", std::fs::metadata(&path)?.len() as f64 / 1e6),
            format!("{:.0}", write * 1e3),
            format!("{start:.1}"),
            format!("{of_scene:.1}"),
            format!("{check:.1}"),
            format!("{:.0}", build * 1e3 / (start + check)),
        ]);
    }
    println!("\n## {}\n", scene.describe());
    println!(
        "Wall time, medians of {rounds} rounds; building and writing once, building on one thread. *Start* \
         is reading the file and taking scene and index from it, *checks* verifies the checksums of all sections \
         before that. {}\n\n{table}",
        if clean { "All answers are those of the index that was built." } else { "ANSWERS DIFFER." }
    );
    Ok(clean)
}

const HEAD: [&str; 8] =
    ["index", "build s", "file MB", "write ms", "start ms", "of which scene", "checks ms", "build / (start + checks)"];
