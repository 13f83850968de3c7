//! `p2m-bench paper`: repeats the evaluation of the P2M paper on our models, for the tables and plots of docs/paper.md.
//!
//! Figures and tables have the numbers of the paper.

mod figures;
mod profile;
mod scenes;
mod study;
mod surfaces;
mod tables;

use crate::blocks::Blocks;
use crate::measure::Effort;
use crate::scene::Scene;
use anyhow::{Context, Result};
use figures::{COMPARED, Figures};
use profile::{FULL, Profile, QUICK};
use scenes::{Models, spheres};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;
use study::{Study, StudyOptions};

/// The blocks of docs/paper.md.
pub(crate) const BLOCKS: Blocks<8> = Blocks {
    command: "paper",
    names: ["provenance", "lists", "stages", "queries", "triangulations", "torn and mixed", "memory", "not measured"],
};
/// The backends of Table 3 besides those of every table: the paper's locator, lists and list filter. The last two are
/// left out for spheres, where each list would have all triangles without added sites.
const PAPERS: &[&str] = &[KD_TREE, "p2m-long", "p2m-long-rstar"];
const KD_TREE: &str = "p2m-kiddo";

/// Measures everything, publishes the blocks, and draws the plots into a folder. Returns whether the answers of our
/// backends were bitwise equal everywhere.
pub(crate) fn run(models: &Path, quick: bool, document: Option<&Path>, plots: &Path) -> Result<bool> {
    BLOCKS.check(document)?;
    let (contents, agrees) = measure(if quick { &QUICK } else { &FULL }, Models(models.to_owned()), plots)?;
    BLOCKS.publish(document, &contents)?;
    Ok(agrees)
}

/// Draws the plots into a folder, and returns the contents of the blocks and whether all answers of ours were equal.
fn measure(profile: &Profile, models: Models, plots: &Path) -> Result<([String; 8], bool)> {
    let start = Instant::now();
    models.check(profile)?;
    let threads = threads();
    let mut all = Studies { profile, models, threads, known: BTreeMap::new() };
    std::fs::create_dir_all(plots).with_context(|| plots.display().to_string())?;

    // Models that cannot be read are reported before anything is measured.
    let scattered_scenes = all.models.scattered(profile)?;
    for name in profile.five {
        all.read(name, PAPERS)?;
    }
    for name in profile.long {
        all.read(name, PAPERS)?;
    }
    let spheres = spheres(profile.sphere)?;
    for scene in &spheres {
        all.add(scene, &[KD_TREE])?;
    }
    all.read(profile.swept, &[])?;
    let mut sweep = Vec::new();
    for resolution in profile.resolutions {
        let scene = all.models.at(profile.swept, *resolution)?;
        all.add(&scene, &[])?;
        sweep.push(scene.name);
    }
    let mut pairs = Vec::new();
    for name in profile.pairs {
        let scenes = all.models.pair(name, profile.pair_size)?;
        let [bad, good] = scenes.each_ref().map(|scene| all.study(scene, &[]));
        pairs.push((scenes, [bad?, good?]));
    }
    let torn = all.models.torn(profile.torn)?;
    for scene in &torn {
        all.add(scene, &[])?;
    }
    if let Some(name) = profile.mixed {
        all.read(name, &[])?;
    }
    let mut scattered = Vec::new();
    for scene in scattered_scenes {
        all.add(&scene, &[])?;
        scattered.push(scene.name);
    }

    let of = |names: &mut dyn Iterator<Item = &str>| -> Vec<&Study> { names.map(|name| all.get(name)).collect() };
    let five = of(&mut profile.five.iter().copied());
    let sweep = of(&mut sweep.iter().map(String::as_str));
    let scattered = of(&mut scattered.iter().map(String::as_str));
    let long = of(&mut profile.long.iter().copied().chain(spheres.iter().map(|scene| scene.name.as_str())));
    let others = of(&mut torn.iter().map(|scene| scene.name.as_str()).chain(profile.mixed));
    let ten: Vec<&Study> = five.iter().chain(&long).copied().collect();
    let dragon = all.get(profile.swept);
    let figures = Figures {
        sweep: &sweep,
        five: &five,
        dragon,
        boxes: profile.boxes,
        threads: &all.threads,
        scattered: &scattered,
    };
    figures.write(plots)?;

    let studies = || all.known.values().chain(pairs.iter().flat_map(|(_, studies)| studies));
    let agrees = studies().map(|study| study.agrees).fold(true, |all, agrees| all & agrees);
    let provenance = format!(
        "{}\n{:.0} minutes; {} queries for each scene, {} rounds. {}",
        crate::report::provenance(None),
        (start.elapsed().as_secs_f64() / 60.0).ceil(),
        profile.queries,
        profile.rounds,
        if agrees { "All answers of ours were bitwise the same." } else { "ANSWERS OF OURS DIFFER." }
    );
    let contents = [
        provenance,
        tables::lists(&ten),
        tables::stages(&ten),
        tables::queries(&ten),
        tables::triangulations(&pairs),
        tables::others(&others),
        tables::memory(&ten),
        tables::notes(studies()),
    ];
    Ok((contents, agrees))
}

/// Returns the powers of two up to the number of cores, and that number.
fn threads() -> Vec<usize> {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    (0..usize::BITS).map(|i| 1 << i).take_while(|count| *count <= most).collect()
}

/// The studies so far by names of scenes, so that no scene is measured twice.
struct Studies<'a> {
    profile: &'a Profile,
    models: Models,
    threads: Vec<usize>,
    known: BTreeMap<String, Study>,
}

impl Studies<'_> {
    fn read(&mut self, name: &str, more: &[&str]) -> Result<()> {
        let scene = self.models.read(name)?;
        self.add(&scene, more)
    }

    fn add(&mut self, scene: &Scene, more: &[&str]) -> Result<()> {
        if !self.known.contains_key(&scene.name) {
            let study = self.study(scene, more)?;
            self.known.insert(scene.name.clone(), study);
        }
        Ok(())
    }

    fn get(&self, name: &str) -> &Study {
        &self.known[name]
    }

    /// Measures a scene, with more backends than those that are compared everywhere.
    fn study(&self, scene: &Scene, more: &[&str]) -> Result<Study> {
        let Profile { queries, rounds, builds, boxes, swept, .. } = *self.profile;
        let is_swept = scene.name == swept;
        let wanted = StudyOptions {
            backends: &COMPARED,
            more,
            boxes: if is_swept { boxes } else { &[] },
            threads: if is_swept { &self.threads } else { &[] },
        };
        Study::of(scene, wanted, &Effort { rounds, queries, builds, seed: 1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use profile::Resolution::{Coarsened, Own, Subdivided};

    /// The smallest profile, which needs generated models only.
    const MINIMAL: Profile = Profile {
        queries: 200,
        rounds: 2,
        builds: 1,
        five: &["torus knot"],
        swept: "torus knot",
        resolutions: &[Coarsened(600), Own, Subdivided(400)],
        boxes: &[1.0, 10.0],
        long: &["cylinder"],
        sphere: 800,
        pairs: &["cylinder"],
        pair_size: 3_000,
        torn: "torus knot",
        mixed: None,
        scattered: Some(&["cylinder"]),
        min_primitives: 0,
    };

    #[test]
    #[ignore = "deep: each of the scenes is measured with every index"]
    fn all_tables_and_plots_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let (contents, agrees) = measure(&MINIMAL, Models("nowhere".into()), folder.path()).unwrap();
        assert!(agrees && contents[0].contains("bitwise the same"));
        let page = contents.concat();
        for row in
            ["| torus knot ", "| cylinder ", "| sphere of meridians ", "| cylinder, bad ", "| torus knot, gapped "]
        {
            assert!(page.contains(row), "{row}: {page}");
        }
        // Spheres have no long lists, and nothing else is left out.
        assert_eq!(page.matches(" - |").count(), 6, "{page}");
        let plots = include_str!("../../../../docs/paper.md").split("](paper/").skip(1);
        let plots: Vec<&str> = plots.map(|rest| rest.split(')').next().unwrap()).collect();
        assert_eq!(plots.len(), 11);
        for plot in plots {
            assert!(folder.path().join(plot).is_file(), "{plot}");
        }
    }
}
