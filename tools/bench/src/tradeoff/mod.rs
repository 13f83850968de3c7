//! `p2m-bench report`: compares speed with accuracy for all backends and settings, and writes a page and a record.

mod indexes;
mod profile;
mod sweeps;
mod truth;

use crate::queries::Queries;
use crate::scene::Scene;
use anyhow::{Context, Result};
use indexes::{ALL, build_all, competitors};
use p2m_tradeoff::page::{Page, Sweep};
use p2m_tradeoff::record::record;
use p2m_tradeoff::{Provenance, SceneFigures, SetFigures, clock_nanoseconds, measure, text};
use profile::{FULL, Profile, QUICK, SETS, about};
use std::path::Path;
use std::time::Instant;

/// The seed of all query sets.
const SEED: u64 = 1;

/// Measures everything and writes report.html and report.csv into a folder. Returns whether all promises were kept.
pub(crate) fn write(models: &Path, quick: bool, out: &Path, provenance: &Provenance) -> Result<bool> {
    let (profile, option) = if quick { (&QUICK, " --quick") } else { (&FULL, "") };
    // The command on the page has no folders, because they are those of one machine.
    let provenance = Provenance { command: format!("p2m-bench report{option}"), ..provenance.clone() };
    write_profile(profile, models, out, &provenance)
}

fn write_profile(profile: &Profile, models: &Path, out: &Path, provenance: &Provenance) -> Result<bool> {
    let start = Instant::now();
    // Scenes that cannot be read are reported before anything is measured.
    let scenes = profile.scenes.iter().map(|source| source.read(models)).collect::<Result<Vec<Scene>>>()?;
    std::fs::create_dir_all(out).with_context(|| out.display().to_string())?;
    let clock = clock_nanoseconds();
    let mut sweeps = sweeps::sizes(profile, SEED)?;
    let mut figures = Vec::new();
    for (scene, source) in scenes.iter().zip(profile.scenes) {
        let (measured, threads) = measure_scene(scene, source.about, profile, figures.is_empty())?;
        figures.push(measured);
        sweeps.extend(threads);
    }
    let effort = format!(
        "One thread, one call at a time, {} rounds in turns of at most {} queries or about {} s, seed {SEED}; {} of each index. All of it \
         took {:.0} s.",
        profile.effort.rounds,
        profile.queries,
        profile.effort.seconds,
        if profile.builds == 1 {
            "one build".to_owned()
        } else {
            format!("medians of up to {} builds", profile.builds)
        },
        start.elapsed().as_secs_f64()
    );
    let backends: Vec<(&str, &str)> = ALL.iter().map(|candidate| (candidate.name, candidate.about)).collect();
    let page = Page {
        provenance,
        effort: &effort,
        truth: truth::ABOUT,
        clock,
        scenes: &figures,
        sweeps: &sweeps,
        backends: &backends,
    };
    let save = |path: &Path, text: &str| std::fs::write(path, text).with_context(|| path.display().to_string());
    save(&out.join("report.html"), &page.html()?)?;
    save(&out.join("report.csv"), &record(provenance, &figures, SEED, clock))?;
    let points =
        || figures.iter().flat_map(|s| s.sets.iter().flat_map(|set| set.curves.iter().flat_map(|c| &c.points)));
    let broken: usize = points().map(|point| point.errors.broken).sum();
    let verdict = if broken == 0 { "All promises were kept." } else { "PROMISES WERE BROKEN, see the page." };
    println!("{} in {:.0?}. {verdict}", out.join("report.html").display(), start.elapsed());
    Ok(broken == 0)
}

/// Measures a scene, with threads if wanted, and prints the results.
fn measure_scene(
    scene: &Scene,
    special: &str,
    profile: &Profile,
    threads: bool,
) -> Result<(SceneFigures, Option<Sweep>)> {
    eprintln!("{}", scene.describe());
    let (indexes, notes) = build_all(scene, profile.builds);
    let mut sets = Vec::new();
    for set in SETS {
        let queries = set.generate(&scene.double, profile.queries, SEED);
        let truths = truth::truths(scene, &queries);
        let competitors = competitors(&indexes, false);
        let curves = measure(&competitors, &Queries::new(queries), &truths, &profile.effort, &|_| ());
        let figures = SetFigures { name: set.name().to_owned(), about: about(set).to_owned(), curves };
        println!("\n## {}, {set}\n\n{}", scene.name, text::table(&figures));
        sets.push(figures);
    }
    let threads = threads.then(|| sweeps::threads(scene, &indexes, profile, SEED)).transpose()?;
    let soup = &*scene.double;
    let contents =
        [(soup.triangles().len(), "triangles"), (soup.segments().len(), "segments"), (soup.points().len(), "points")];
    let contents = contents.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
    let about = format!("{special} {}.", contents.collect::<Vec<_>>().join(", "));
    let figures = SceneFigures { name: scene.name.clone(), about, primitives: scene.len(), sets, notes };
    Ok((figures, threads))
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_tradeoff::Effort;
    use p2m_tradeoff::record::read_record;
    use p2m_tradeoff::settings::SETTINGS;

    #[test]
    #[ignore = "deep: the page measures every setting of every backend"]
    fn page_and_record_are_written() {
        let minimal = Profile {
            scenes: &QUICK.scenes[2..],
            queries: 100,
            builds: 1,
            effort: Effort { rounds: 2, seconds: 1e-3 },
            sizes: &[500, 1000],
            batch: 200,
        };
        let folder = tempfile::tempdir().unwrap();
        let kept =
            write_profile(&minimal, Path::new("nowhere"), folder.path(), &crate::report::provenance(Some("test")))
                .unwrap();
        assert!(kept);
        let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
        for word in ["knot and cables", "Threads", "Time per query over size"] {
            assert!(page.contains(word), "{word}");
        }
        let lines = read_record(&std::fs::read_to_string(folder.path().join("report.csv")).unwrap()).unwrap();
        assert_eq!(lines.len(), SETS.len() * (4 * SETTINGS.len() + 4));
    }
}
