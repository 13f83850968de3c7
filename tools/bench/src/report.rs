//! Prints and records the results of `p2m-bench query`.

use crate::backend::Unavailable;
use crate::backends::{YARDSTICK, YARDSTICK_DOUBLE};
use crate::measure::{BuildFigures, Entry, MedianRange, SetFigures};
use crate::scene::Scene;
use anyhow::{Context, Result, bail};
use p2m_cli::harness::Provenance;
use p2m_cli::harness::{Table, csv_line};
use p2m_testkit::queries::QuerySet;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;

/// Returns the provenance of a measurement by this program, which runs from its checkout.
pub(crate) fn provenance(label: Option<&str>) -> Provenance {
    Provenance::collect(label, Some(env!("CARGO_MANIFEST_DIR").as_ref()))
}

/// Prints the tables of a scene.
pub(crate) fn print_scene(scene: &Scene, sets: &[QuerySet], entries: &[Entry<'_>], label: &str) {
    println!("\n## {} ({label})\n", scene.describe());
    println!("Cost: thread CPU time as median (min-max); n = queries a round where it is not all of them.\n");
    println!("{}", cost(scene, sets, entries));
    println!("Speed relative to {YARDSTICK} / {YARDSTICK_DOUBLE}: its median over the backend's, above 1 is faster.\n");
    println!("{}", ratios(sets, entries));
    println!(
        "Agreement: `=` all answers bitwise equal among ours of the same scalar; then the largest difference of a \
         distance from our first index in f64, in diagonals of the box.\n"
    );
    println!("{}", agreement(scene, sets, entries));
    for note in notes(sets, entries) {
        println!("- {note}");
    }
}

fn head<const N: usize>(first: [&str; N], sets: &[QuerySet]) -> Table {
    Table::new(first.into_iter().chain(sets.iter().map(|set| set.name())))
}

/// Returns the first cells of a row: name and scalar.
fn names(entry: &Entry<'_>) -> Vec<String> {
    vec![entry.backend.name.to_owned(), entry.backend.scalar.name().to_owned()]
}

fn cost(scene: &Scene, sets: &[QuerySet], entries: &[Entry<'_>]) -> Table {
    let max_queries = |i: usize| entries.iter().filter_map(|e| e.sets[i].as_ref().ok()).map(|s| s.queries).max();
    let mut table = head(["", "scalar", "build s", "B/primitive", "with scene", "peak"], sets);
    for entry in entries {
        let mut row = names(entry);
        let bytes = |bytes: usize| match entry.index {
            Ok(_) => format!("{:.1}", bytes as f64 / scene.len() as f64),
            Err(_) => "-".to_owned(),
        };
        row.push(MedianRange::of(&entry.build.seconds).map_or("-".to_owned(), |s| spread(&s, seconds)));
        let build = &entry.build;
        row.extend([build.owned, build.owned + build.borrowed, build.peak].map(bytes));
        for (i, set) in entry.sets.iter().enumerate() {
            row.push(figure(set).map_or("-".to_owned(), |(s, n)| {
                let count = if Some(n) == max_queries(i) { String::new() } else { format!(" n={n}") };
                format!("{}{count}", spread(&s, |ns| format!("{ns:.0}")))
            }));
        }
        table.push(row);
    }
    table
}

fn ratios(sets: &[QuerySet], entries: &[Entry<'_>]) -> Table {
    let median = |entry: &Entry<'_>, i: usize| figure(&entry.sets[i]).map(|(s, _)| s.median);
    let median_of = |name: &str, i: usize| entries.iter().find(|e| e.backend.name == name).and_then(|e| median(e, i));
    let mut table = head(["", "scalar"], sets);
    for entry in entries {
        let mut row = names(entry);
        for i in 0..sets.len() {
            let ratio = |name: &str| match (median_of(name, i), median(entry, i)) {
                (Some(reference), Some(median)) => significant(reference / median),
                _ => "-".to_owned(),
            };
            row.push(match median(entry, i) {
                Some(_) => format!("{} / {}", ratio(YARDSTICK), ratio(YARDSTICK_DOUBLE)),
                None => "-".to_owned(),
            });
        }
        table.push(row);
    }
    table
}

fn agreement(scene: &Scene, sets: &[QuerySet], entries: &[Entry<'_>]) -> Table {
    let mut table = head(["", "scalar"], sets);
    for entry in entries {
        let mut row = names(entry);
        row.extend(entry.sets.iter().map(|set| {
            let Ok(SetFigures { agreement: a, .. }) = set else { return "-".to_owned() };
            let mut words = Vec::new();
            if a.compared > 0 {
                let wrong = a.other_distance + a.other_id;
                words.push(if wrong == 0 { "=".to_owned() } else { format!("{wrong} of {} DIFFER", a.compared) });
            }
            if a.difference > 0.0 {
                words.push(format!("{:.1e}", a.difference / scene.diagonal()));
            } else if a.difference.is_finite() && a.compared == 0 {
                words.push("0".to_owned());
            }
            if a.failed > 0 {
                words.push(format!("{} FAILED", a.failed));
            }
            words.join(" ")
        }));
        table.push(row);
    }
    table
}

/// Returns footnotes: why backends are missing, and which answers are wrong.
fn notes(sets: &[QuerySet], entries: &[Entry<'_>]) -> Vec<String> {
    let mut notes = Vec::new();
    for entry in entries {
        let name = entry.backend.name;
        if let Err(Unavailable(why)) = &entry.index {
            notes.push(format!("{name} is left out: {why}"));
            continue;
        }
        for (set, figures) in sets.iter().zip(&entry.sets) {
            match figures {
                Err(Unavailable(why)) => notes.push(format!("{name} on {}: {why}", set.name())),
                Ok(f) => {
                    let a = &f.agreement;
                    if !a.is_clean() {
                        notes.push(format!(
                            "{name} on {}: {} other distances, {} other ids of {}; {} queries without a finite answer",
                            set.name(),
                            a.other_distance,
                            a.other_id,
                            a.compared,
                            a.failed
                        ));
                    }
                    if f.checksums.windows(2).any(|w| w[0] != w[1]) {
                        notes.push(format!("{name} on {}: answers change from round to round", set.name()));
                    }
                }
            }
        }
    }
    notes
}

/// Returns the nanoseconds and the number of queries.
fn figure(set: &Result<SetFigures, Unavailable>) -> Option<(MedianRange, usize)> {
    let figures = set.as_ref().ok()?;
    Some((MedianRange::of(&figures.nanoseconds)?, figures.queries))
}

fn spread(s: &MedianRange, format: impl Fn(f64) -> String) -> String {
    format!("{} ({}-{})", format(s.median), format(s.min), format(s.max))
}

fn seconds(s: f64) -> String {
    if s < 1e-3 { format!("{s:.1e}") } else { format!("{s:.4}") }
}

/// Formats a ratio with two digits after the point, and with more if it is small.
pub(crate) fn significant(ratio: f64) -> String {
    if ratio < 0.1 { format!("{ratio:.1e}") } else { format!("{ratio:.2}") }
}

/// The columns of a record that differ from line to line of a scene.
pub(crate) struct Line<'a> {
    /// The name of the backend.
    pub(crate) backend: &'a str,
    /// The name of the scalar.
    pub(crate) scalar: &'a str,
    /// The cost of the builds.
    pub(crate) build: &'a BuildFigures,
    /// The name of the query set.
    pub(crate) set: &'a str,
    /// The number of queries in a round.
    pub(crate) queries: usize,
    /// The seed of the query set.
    pub(crate) seed: u64,
    /// The number of the round.
    pub(crate) round: usize,
    /// Nanoseconds per query.
    pub(crate) nanoseconds: f64,
    /// The checksum of the answers.
    pub(crate) checksum: u64,
}

/// A file of comma-separated values with one line for each scene, backend, set and round. Lines are appended to a file
/// that exists, so that the builds of one comparison can share it.
pub(crate) struct Record {
    file: File,
}

const COLUMNS: [&str; 14] = [
    "scene",
    "primitives",
    "contender",
    "scalar",
    "build_s_median",
    "owned_bytes",
    "borrowed_bytes",
    "peak_bytes",
    "set",
    "queries",
    "seed",
    "round",
    "ns_per_query",
    "checksum",
];

impl Record {
    /// Opens or creates the file. A file with other columns is an error and is left as it is.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let name = || format!("cannot open {}", path.display());
        let columns: Vec<String> = Provenance::COLUMNS.iter().chain(&COLUMNS).map(|c| (*c).to_owned()).collect();
        let columns = csv_line(&columns);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path).with_context(name)?;
        let mut first = String::new();
        if BufReader::new(&file).read_line(&mut first).with_context(name)? == 0 {
            writeln!(file, "{columns}")?;
        } else if first.trim_end() != columns {
            bail!("{} is no record of this program: its first line names other columns", path.display());
        }
        Ok(Self { file })
    }

    /// Adds the lines of a scene.
    pub(crate) fn add(
        &mut self,
        provenance: &Provenance,
        scene: &Scene,
        sets: &[QuerySet],
        entries: &[Entry<'_>],
        seed: u64,
    ) -> Result<()> {
        for entry in entries {
            let build = &entry.build;
            for (set, figures) in sets.iter().zip(&entry.sets) {
                let Ok(figures) = figures else { continue };
                for (round, (ns, checksum)) in figures.nanoseconds.iter().zip(&figures.checksums).enumerate() {
                    self.line(
                        provenance,
                        scene,
                        &Line {
                            backend: entry.backend.name,
                            scalar: entry.backend.scalar.name(),
                            build,
                            set: set.name(),
                            queries: figures.queries,
                            seed,
                            round,
                            nanoseconds: *ns,
                            checksum: *checksum,
                        },
                    )?;
                }
            }
        }
        Ok(())
    }

    /// Adds one line.
    pub(crate) fn line(&mut self, provenance: &Provenance, scene: &Scene, line: &Line<'_>) -> Result<()> {
        let build = line.build;
        let fields: [String; COLUMNS.len()] = [
            scene.name.clone(),
            scene.len().to_string(),
            line.backend.to_owned(),
            line.scalar.to_owned(),
            MedianRange::of(&build.seconds).map(|s| format!("{:.6}", s.median)).unwrap_or_default(),
            build.owned.to_string(),
            build.borrowed.to_string(),
            build.peak.to_string(),
            line.set.to_owned(),
            line.queries.to_string(),
            line.seed.to_string(),
            line.round.to_string(),
            format!("{:.1}", line.nanoseconds),
            format!("{:016x}", line.checksum),
        ];
        let fields: Vec<String> = provenance.fields().into_iter().chain(fields).collect();
        Ok(writeln!(self.file, "{}", csv_line(&fields))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_record_is_added_to_and_a_foreign_file_is_left_alone() {
        let directory = std::env::temp_dir().join(format!("p2m-bench-test-{}", std::process::id()));
        fs::create_dir_all(&directory).unwrap();
        let (ours, foreign) = (directory.join("ours.csv"), directory.join("foreign.csv"));
        Record::open(&ours).unwrap();
        let header = fs::read_to_string(&ours).unwrap();
        Record::open(&ours).unwrap();
        assert_eq!(fs::read_to_string(&ours).unwrap(), header);
        assert_eq!(header.lines().count(), 1);
        fs::write(&foreign, "x,y,z\n1,2,3\n").unwrap();
        assert!(Record::open(&foreign).is_err());
        assert_eq!(fs::read_to_string(&foreign).unwrap(), "x,y,z\n1,2,3\n");
        fs::remove_dir_all(&directory).unwrap();
    }
}
