//! The report of `p2m-bench query`.

use crate::agree::Agreement;
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
    print_agreement(scene, sets, entries);
}

/// Prints the agreement of the answers.
pub(crate) fn print_agreement(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) {
    println!(
        "Agreement: `=` all answers bitwise equal among ours of the same scalar; then the largest difference of a \
         distance from our first index in f64, in diagonals of the box.\n"
    );
    println!("{}", agreement(scene, sets, entries));
    for note in notes(sets, entries) {
        println!("- {note}");
    }
}

/// Returns whether our indexes agree, and whether all that could be built have answered.
pub(crate) fn is_clean(entries: &[Entry]) -> bool {
    let ours = entries.iter().filter(|entry| entry.backend.is_ours && entry.index.is_ok());
    ours.flat_map(|entry| &entry.sets).all(|set| set.as_ref().is_ok_and(|set| set.agreement.is_clean()))
}

/// The text of a cell of a backend.
type TextFn<'f> = &'f dyn Fn(&Entry) -> String;

/// Makes a table with a row for each backend: its name and scalar, the cells of `first`, and a cell for each set that
/// was measured.
fn table<const N: usize>(
    first: [(&str, TextFn<'_>); N],
    sets: &[QuerySet],
    entries: &[Entry],
    cell: impl Fn(usize, &SetFigures) -> String,
) -> Table {
    let columns = first.iter().map(|(name, _)| *name).chain(sets.iter().map(|set| set.name()));
    let mut table = Table::new(["", "scalar"].into_iter().chain(columns));
    for entry in entries {
        let mut row = vec![entry.backend.name.to_owned(), entry.backend.scalar.name().to_owned()];
        row.extend(first.iter().map(|(_, cell)| cell(entry)));
        let cells = entry.sets.iter().enumerate();
        row.extend(cells.map(|(i, set)| set.as_ref().map_or("-".to_owned(), |figures| cell(i, figures))));
        table.push(row);
    }
    table
}

fn cost(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) -> Table {
    let max_queries = |i: usize| entries.iter().filter_map(|e| e.sets[i].as_ref().ok()).map(|s| s.queries).max();
    let bytes = |entry: &Entry, bytes: usize| match entry.index {
        Ok(_) => format!("{:.1}", bytes as f64 / scene.len() as f64),
        Err(_) => "-".to_owned(),
    };
    let build_seconds =
        |e: &Entry| MedianRange::of(&e.build.seconds).map_or("-".to_owned(), |range| spread(&range, seconds));
    table(
        [
            ("build s", &build_seconds),
            ("B/primitive", &|e| bytes(e, e.build.owned)),
            ("with scene", &|e| bytes(e, e.build.owned + e.build.borrowed)),
            ("peak", &|e| bytes(e, e.build.peak)),
        ],
        sets,
        entries,
        |i, figures| {
            let is_all = Some(figures.queries) == max_queries(i);
            let count = if is_all { String::new() } else { format!(" n={}", figures.queries) };
            let cell = |range| format!("{}{count}", spread(&range, |ns| format!("{ns:.0}")));
            MedianRange::of(&figures.nanoseconds).map_or("-".to_owned(), cell)
        },
    )
}

fn ratios(sets: &[QuerySet], entries: &[Entry]) -> Table {
    let median = |figures: &SetFigures| Some(MedianRange::of(&figures.nanoseconds)?.median);
    let reference = |name: &str, i: usize| {
        let entry = entries.iter().find(|entry| entry.backend.name == name)?;
        median(entry.sets[i].as_ref().ok()?)
    };
    table([], sets, entries, |i, figures| {
        let ratio = |name| Some(significant(reference(name, i)? / median(figures)?));
        [YARDSTICK, YARDSTICK_DOUBLE].map(|name| ratio(name).unwrap_or_else(|| "-".to_owned())).join(" / ")
    })
}

fn agreement(scene: &Scene, sets: &[QuerySet], entries: &[Entry]) -> Table {
    table([], sets, entries, |_, SetFigures { agreement: a, .. }| {
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
    })
}

/// Returns the footnotes: the reasons for missing backends, and wrong answers.
fn notes(sets: &[QuerySet], entries: &[Entry]) -> Vec<String> {
    let mut notes = Vec::new();
    for entry in entries {
        let name = entry.backend.name;
        if let Err(Unavailable(why)) = &entry.index {
            notes.push(format!("{name} is left out: {why}"));
            continue;
        }
        for (set, figures) in sets.iter().zip(&entry.sets) {
            let mut note = |text: String| notes.push(format!("{name} on {}: {text}", set.name()));
            let figures = match figures {
                Ok(figures) => figures,
                Err(Unavailable(why)) => {
                    note(why.clone());
                    continue;
                }
            };
            let Agreement { compared, other_distance, other_id, example, failed, .. } = figures.agreement;
            if !figures.agreement.is_clean() {
                note(format!(
                    "{other_distance} other distances, {other_id} other ids of {compared}; {failed} queries without a \
                     finite answer"
                ));
            }
            if let Some((query, found, expected)) = example {
                note(format!("query {query} should be {expected:?}, is {found:?}"));
            }
            if figures.checksums.windows(2).any(|pair| pair[0] != pair[1]) {
                note("answers change from round to round".to_owned());
            }
        }
    }
    notes
}

fn spread(s: &MedianRange, format: impl Fn(f64) -> String) -> String {
    format!("{} ({}-{})", format(s.median), format(s.min), format(s.max))
}

fn seconds(s: f64) -> String {
    if s < 1e-3 { format!("{s:.1e}") } else { format!("{s:.4}") }
}

/// Formats a ratio with two decimals, and with more if it is small.
pub(crate) fn significant(ratio: f64) -> String {
    if ratio < 0.1 { format!("{ratio:.1e}") } else { format!("{ratio:.2}") }
}
