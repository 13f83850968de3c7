//! The first hit, against parry.

use super::backends::{ALL, YARDSTICK};
use super::caster::{Backend, Function, Index};
use super::measure::{Contender, Differences, Figures, ROUNDING, first_part, measure, verify};
use crate::contender::{Absent, catch};
use crate::measure::{BuildFigures, Effort, Spread, weigh};
use crate::memory;
use crate::provenance::Provenance;
use crate::report::{Line, Record, significant};
use crate::scene::Scene;
use crate::table::Table;
use anyhow::Result;
use p2m_testkit::queries::QuerySet;

/// A contender in a scene.
struct Entry<'a> {
    backend: &'static Backend,
    index: Index<'a>,
    build: BuildFigures,
}

/// Prints times, ratios and agreement of the named contenders in a scene, and records them; whether ours agree.
pub(crate) fn print(
    scene: &Scene,
    sets: &[QuerySet],
    names: &[String],
    effort: &Effort,
    provenance: &Provenance,
    mut record: Option<&mut Record>,
) -> Result<bool> {
    println!("\n## {} ({})\n", scene.describe(), provenance.label);
    let named = |backend: &&Backend| names.is_empty() || names.iter().any(|name| name == backend.name);
    let (mut entries, mut notes, mut clean) = (Vec::new(), Vec::new(), true);
    for backend in ALL.iter().filter(named) {
        match build(scene, backend) {
            Ok(entry) => entries.push(entry),
            Err(Absent(why)) => notes.push(format!("{} is left out: {why}", backend.name)),
        }
    }
    let contenders: Vec<_> =
        entries.iter().map(|entry| Contender { index: &entry.index, function: Function::First }).collect();
    let head = ["ns per ray (least), speed", "scalar"].into_iter().chain(sets.iter().map(|set| set.name()));
    let mut times: Vec<Vec<String>> =
        entries.iter().map(|e| vec![e.backend.name.to_owned(), e.backend.scalar.to_owned()]).collect();
    for set in sets {
        let all = measure(scene, *set, &contenders, effort);
        let median = |f: &Figures| Spread::of(&f.seconds).map(|s| s.median);
        let yardstick =
            entries.iter().zip(&all).find(|(e, _)| e.backend.name == YARDSTICK).and_then(|(_, f)| median(f));
        for ((entry, figures), row) in entries.iter().zip(&all).zip(&mut times) {
            let name = entry.backend.name;
            row.push(cell(figures, yardstick, effort.queries));
            if let Some(Absent(why)) = &figures.failure {
                notes.push(format!("{name} on {set}: {why}"));
            }
            let Differences { compared, missed, added, other } = figures.differences;
            match entry.index {
                Index::Ours(_) => clean &= figures.failure.is_none() && figures.differences.is_clean(),
                Index::Rival(_) if other + missed + added == 0 => {}
                Index::Rival(_) => notes.push(format!(
                    "{name} on {set}: of {compared} rays it misses {missed} that hit and hits with {added} that miss; \
                     {other} parameters differ by more than {ROUNDING:.1e} of themselves and the diagonal"
                )),
            }
            if let (Index::Ours(_), false) = (&entry.index, figures.differences.is_clean()) {
                notes.push(format!("{name} on {set}: DIFFERENCES {:?}", figures.differences));
            }
            if let Some(record) = &mut record {
                let per_ray = figures.seconds.iter().map(|s| s * 1e9 / effort.queries as f64);
                for (round, (nanoseconds, checksum)) in per_ray.zip(&figures.checksums).enumerate() {
                    record.line(
                        provenance,
                        scene,
                        &Line {
                            contender: name,
                            scalar: entry.backend.scalar,
                            build: &entry.build,
                            set: &format!("ray {set}"),
                            queries: effort.queries,
                            seed: effort.seed,
                            round,
                            nanoseconds,
                            checksum: *checksum,
                        },
                    )?;
                }
            }
        }
        let hits = all.first().map_or(0, |figures| figures.hits);
        let agreement = verify(scene, &first_part(scene, *set, effort))?;
        clean &= agreement.is_ok();
        notes.push(format!(
            "{set}: {hits} of {} rays hit. {}",
            effort.queries,
            agreement.unwrap_or_else(|differ| differ)
        ));
    }
    let mut table = Table::new(head);
    times.into_iter().for_each(|row| table.push(row));
    println!("{table}");
    notes.iter().for_each(|note| println!("- {note}"));
    Ok(clean)
}

fn build<'a>(scene: &'a Scene, backend: &'static Backend) -> Result<Entry<'a>, Absent> {
    let before = memory::current();
    let mut build = BuildFigures::default();
    let prepared = (backend.prepare)(scene)?;
    build.borrowed = prepared.borrowed;
    let index = weigh(&mut build, before, || catch(prepared.build))?;
    Ok(Entry { backend, index, build })
}

fn cell(figures: &Figures, yardstick: Option<f64>, rays: usize) -> String {
    let Some(spread) = Spread::of(&figures.seconds).filter(|_| figures.failure.is_none()) else {
        return "-".to_owned();
    };
    let [median, least] = [spread.median, spread.min].map(|s| s * 1e9 / rays as f64);
    let ratio = yardstick.map_or("-".to_owned(), |of_rival| significant(of_rival / spread.median));
    format!("{median:.0} ({least:.0}), {ratio}")
}
