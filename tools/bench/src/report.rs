//! Prints the results of `p2m-bench query`.

use crate::backend::Unavailable;
use crate::backends::{YARDSTICK, YARDSTICK_DOUBLE};
use crate::measure::{Entry, MedianRange, SetFigures};
use crate::scene::Scene;
use p2m_cli::harness::Table;
use p2m_testkit::queries::QuerySet;

/// Prints the tables of a scene.
pub(crate) fn print_scene(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) {
    println!("\n## {}\n", scene.describe());
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

/// Returns whether our indexes agree.
pub(crate) fn is_clean(entries: &[Entry]) -> bool {
    let ours = entries.iter().filter(|entry| entry.backend.is_ours);
    ours.flat_map(|entry| entry.sets.iter().flatten()).all(|set| set.agreement.is_clean())
}

fn head<const N: usize>(first: [&str; N], sets: &[QuerySet]) -> Table {
    Table::new(first.into_iter().chain(sets.iter().map(|set| set.name())))
}

/// Returns the first cells of a row: name and scalar.
fn names(entry: &Entry) -> Vec<String> {
    vec![entry.backend.name.to_owned(), entry.backend.scalar.name().to_owned()]
}

fn cost(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) -> Table {
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

fn ratios(sets: &[QuerySet], entries: &[Entry]) -> Table {
    let median = |entry: &Entry, i: usize| figure(&entry.sets[i]).map(|(s, _)| s.median);
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

fn agreement(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) -> Table {
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
fn notes(sets: &[QuerySet], entries: &[Entry]) -> Vec<String> {
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
