//! Compares the first hit with parry.

use super::backend::{RayBackend, RayIndex};
use super::backends::{ALL, YARDSTICK, YARDSTICK_PARAMETER};
use super::measure::{Differences, Figures, ROUNDING, first_chunk, measure, verify};
use crate::backend::{Unavailable, catch};
use crate::measure::{BuildFigures, Effort, MedianRange, measure_build};
use crate::memory;
use crate::report::{Line, Record, significant};
use crate::scene::Scene;
use anyhow::Result;
use p2m_cli::harness::Provenance;
use p2m_cli::harness::Table;
use p2m_testkit::queries::QuerySet;

/// A backend in a scene.
struct Entry<'a> {
    backend: &'static RayBackend,
    index: RayIndex<'a>,
    build: BuildFigures,
}

/// Prints times, ratios and agreement of the named backends (of all if no name is given), records them, and returns
/// whether ours agree.
pub(crate) fn print(
    scene: &Scene,
    sets: &[QuerySet],
    names: &[String],
    effort: &Effort,
    provenance: &Provenance,
    mut record: Option<&mut Record>,
) -> Result<bool> {
    let named = |backend: &&RayBackend| names.is_empty() || names.iter().any(|name| name == backend.name);
    let (mut entries, mut notes, mut clean) = (Vec::new(), Vec::new(), true);
    for backend in ALL.iter().filter(named) {
        match build(scene, backend) {
            Ok(entry) => entries.push(entry),
            Err(Unavailable(why)) => notes.push(format!("{} is left out: {why}", backend.name)),
        }
    }
    let indexes: Vec<_> = entries.iter().map(|entry| &entry.index).collect();
    let mut rows: Vec<Vec<String>> =
        entries.iter().map(|e| vec![e.backend.name.to_owned(), e.backend.scalar.to_owned()]).collect();
    for set in sets {
        let all = measure(scene, *set, &indexes, effort);
        for ((entry, figures), row) in entries.iter().zip(&all).zip(&mut rows) {
            row.push(cell(figures, reference_medians(&entries, &all)));
            clean &= matches!(entry.index, RayIndex::External(_)) || is_clean(figures);
            notes.extend(note(entry, *set, figures));
            if let Some(record) = &mut record {
                add(record, provenance, scene, entry, *set, effort.seed, figures)?;
            }
        }
        let agreement = verify(scene, &first_chunk(scene, *set, effort))?;
        clean &= agreement.is_ok();
        let (hits, rays) = all.first().map_or((0, 0), |figures| (figures.hits, figures.rays));
        notes.push(format!("{set}: {hits} of {rays} rays hit. {}", agreement.unwrap_or_else(|difference| difference)));
    }
    println!("\n## {} ({})\n", scene.describe(), provenance.label);
    println!(
        "ns per ray as median (minimum); then the speed relative to {YARDSTICK} / {YARDSTICK_PARAMETER}, which returns \
         neither triangle nor normal: its median over the competitor's, above 1 is faster.\n"
    );
    let mut table = Table::new(["first hit", "scalar"].into_iter().chain(sets.iter().map(|set| set.name())));
    rows.into_iter().for_each(|row| table.push(row));
    println!("{table}");
    notes.iter().for_each(|note| println!("- {note}"));
    Ok(clean)
}

fn build<'a>(scene: &'a Scene, backend: &'static RayBackend) -> Result<Entry<'a>, Unavailable> {
    let before = memory::current();
    let mut build = BuildFigures::default();
    let prepared = (backend.prepare)(scene)?;
    build.borrowed = prepared.borrowed;
    let index = measure_build(&mut build, before, || catch(prepared.build))?;
    Ok(Entry { backend, index, build })
}

fn is_clean(figures: &Figures) -> bool {
    figures.failure.is_none() && figures.differences.is_clean()
}

/// Returns the medians that ratios refer to.
fn reference_medians(entries: &[Entry<'_>], all: &[Figures]) -> [Option<f64>; 2] {
    [YARDSTICK, YARDSTICK_PARAMETER].map(|name| {
        let (_, figures) = entries.iter().zip(all).find(|(entry, _)| entry.backend.name == name)?;
        Some(MedianRange::of(&figures.seconds)?.median)
    })
}

fn cell(figures: &Figures, references: [Option<f64>; 2]) -> String {
    let Some(spread) = MedianRange::of(&figures.seconds).filter(|_| figures.failure.is_none()) else {
        return "-".to_owned();
    };
    let [median, minimum] = [spread.median, spread.min].map(|s| s * 1e9 / figures.rays as f64);
    let [mesh, parameter] =
        references.map(|reference| reference.map_or("-".to_owned(), |median| significant(median / spread.median)));
    format!("{median:.0} ({minimum:.0}), {mesh} / {parameter}")
}

/// Returns a footnote about the answers of a backend; external libraries always have one.
fn note(entry: &Entry<'_>, set: QuerySet, figures: &Figures) -> Option<String> {
    let name = entry.backend.name;
    if let Some(Unavailable(why)) = &figures.failure {
        return Some(format!("{name} on {set}: {why}"));
    }
    let Differences { compared, missed, added, other, largest } = figures.differences;
    let counts =
        format!("of {compared} rays of all rounds it misses {missed} that hit and hits with {added} that miss");
    match entry.index {
        RayIndex::Ours(_) if figures.differences.is_clean() => None,
        RayIndex::Ours(_) => Some(format!("{name} on {set}: DIFFERENCES, {counts}, {other} hits have other bits")),
        RayIndex::External(_) => Some(format!(
            "{name} on {set}: {counts}; {other} parameters are off by more than {ROUNDING:.1e} of parameter and \
             diagonal, {largest:.1e} at most"
        )),
    }
}

/// Adds the rounds of a backend to a record.
fn add(
    record: &mut Record,
    provenance: &Provenance,
    scene: &Scene,
    entry: &Entry<'_>,
    set: QuerySet,
    seed: u64,
    figures: &Figures,
) -> Result<()> {
    for (round, (seconds, checksum)) in figures.seconds.iter().zip(&figures.checksums).enumerate() {
        record.line(
            provenance,
            scene,
            &Line {
                backend: entry.backend.name,
                scalar: entry.backend.scalar,
                build: &entry.build,
                set: &format!("ray {set}"),
                queries: figures.rays,
                seed,
                round,
                nanoseconds: seconds * 1e9 / figures.rays as f64,
                checksum: *checksum,
            },
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::{Element, Soup};

    #[test]
    fn scenes_of_any_kind_are_printed_and_recorded() {
        let directory = std::env::temp_dir().join(format!("p2m-bench-rays-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let path = directory.join("rays.csv");
        let effort = Effort { rounds: 2, queries: 300, builds: 1, seed: 1 };
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        let triangle = Element::Triangle([0, 1, 2]);
        for (elements, competitors) in [(vec![triangle], 11), (vec![triangle, Element::Point(3)], 8)] {
            let scene = Scene::new("test".into(), Soup::new(p.clone(), elements).unwrap()).unwrap();
            let provenance = crate::report::provenance(None);
            let mut record = Record::open(&path).unwrap();
            let sets = [QuerySet::Box1, QuerySet::Grid];
            assert!(print(&scene, &sets, &[], &effort, &provenance, Some(&mut record)).unwrap());
            let lines = std::fs::read_to_string(&path).unwrap();
            let nanoseconds = |line: &str| line.rsplit(',').nth(1).unwrap().parse::<f64>().unwrap();
            assert!(lines.lines().skip(1).all(|line| nanoseconds(line) > 0.0), "{lines}");
            // Instruction sets that this processor lacks have no lines.
            let rounds = (lines.lines().count() - 1) / (sets.len() * effort.rounds);
            assert!((competitors - 2..=competitors).contains(&rounds), "{rounds}");
            std::fs::remove_file(&path).unwrap();
        }
        std::fs::remove_dir_all(&directory).unwrap();
    }
}
