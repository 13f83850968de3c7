//! `p2m-bench paper`: repeats the evaluation of the P2M paper on our models and redraws its tables and plots as one
//! page.
//!
//! The page is [`PAGE`] with the measurements in place of `{{names}}`; plots lie in a folder beside it. Figures and
//! tables have the numbers of the paper.

mod cited;
mod figures;
mod page;
mod profile;
mod scenes;
mod study;
mod surfaces;
mod tables;

use crate::measure::Effort;
use crate::scene::Scene;
use anyhow::{Context, Result};
use figures::{COMPARED, Figures};
use page::filled;
use profile::{FULL, Profile, QUICK};
use scenes::{Models, spheres};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;
use study::{Study, StudyOptions};

/// The template of the page.
const PAGE: &str = include_str!("page.md");
/// The backends of Table 3 besides those of every table: the paper's locator, lists and list filter. The last two are
/// left out for spheres, where each list would have all triangles without added sites.
const PAPERS: &[&str] = &[KD_TREE, "p2m-long", "p2m-long-rstar"];
const KD_TREE: &str = "p2m-kiddo";

/// Measures everything and writes paper.md, with its plots in the folder `paper`, into a folder. Returns whether the
/// answers of our backends were bitwise equal everywhere.
pub(crate) fn write(models: &Path, quick: bool, out: &Path) -> Result<bool> {
    let (profile, option) = if quick { (&QUICK, " --quick") } else { (&FULL, "") };
    write_profile(profile, &format!("p2m-bench paper{option}"), Models(models.to_owned()), out)
}

fn write_profile(profile: &Profile, command: &str, models: Models, out: &Path) -> Result<bool> {
    let start = Instant::now();
    models.check(profile)?;
    let threads = threads();
    let mut all = Studies { profile, models, threads, known: BTreeMap::new() };
    let plots = out.join("paper");
    std::fs::create_dir_all(&plots).with_context(|| plots.display().to_string())?;

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
    figures.write(&plots)?;

    let studies = || all.known.values().chain(pairs.iter().flat_map(|(_, studies)| studies));
    let agrees = studies().map(|study| study.agrees).fold(true, |all, agrees| all & agrees);
    let answers = if agrees { "All answers of ours were bitwise the same." } else { "ANSWERS OF OURS DIFFER." };
    let provenance = crate::report::provenance(None);
    let values = [
        ("command", command.to_owned()),
        ("machine", provenance.machine()),
        ("date", provenance.date.clone()),
        ("took", format!("{:.0} minutes", (start.elapsed().as_secs_f64() / 60.0).ceil())),
        ("queries", profile.queries.to_string()),
        ("rounds", profile.rounds.to_string()),
        ("answers", answers.to_owned()),
        ("scope", profile.scope.to_owned()),
        ("threads", all.threads.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
        ("swept", scenes::stem(profile.swept).to_owned()),
        ("table 1", tables::lists(&ten)),
        ("table 1 cited", cited::table_1()),
        ("table 2", tables::stages(&ten)),
        ("table 2 cited", cited::table_2()),
        ("table 3", tables::queries(&ten)),
        ("table 3 cited", cited::table_3()),
        ("table 4", tables::triangulations(&pairs)),
        ("table 4 cited", cited::table_4()),
        ("torn and mixed", tables::others(&others)),
        ("memory", tables::memory(&ten)),
        ("notes", tables::notes(studies())),
    ];
    let page = out.join("paper.md");
    std::fs::write(&page, filled(PAGE, &values)?).with_context(|| page.display().to_string())?;
    println!("{} and its plots, in {:.0?}. {answers}", page.display(), start.elapsed());
    Ok(agrees)
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
        scope: "A test.",
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
    #[ignore = "deep: the page measures each of its scenes with every index"]
    fn the_page_and_all_of_its_plots_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let models = Models(std::path::PathBuf::from("nowhere"));
        assert!(write_profile(&MINIMAL, "a test", models, folder.path()).unwrap());
        let page = std::fs::read_to_string(folder.path().join("paper.md")).unwrap();
        assert!(page.contains("`a test`") && page.contains("bitwise the same") && !page.contains("{{"));
        for row in
            ["| torus knot ", "| cylinder ", "| sphere of meridians ", "| cylinder, bad ", "| torus knot, gapped "]
        {
            assert!(page.contains(row), "{row}: {page}");
        }
        let plots: Vec<&str> = page.split("](paper/").skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
        assert_eq!(plots.len(), 11);
        // Spheres have no long lists, and nothing else is left out.
        assert_eq!(page.matches(" - |").count(), 6, "{page}");
        for plot in plots {
            assert!(folder.path().join("paper").join(plot).is_file(), "{plot}");
        }
    }
}
