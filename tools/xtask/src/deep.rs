//! Runs all tests with all of their cases, and counts the cases.

use crate::{Outcome, command, make_folder, read, start, target, write};
use std::collections::BTreeMap;
use std::env;
use std::path::Path;

/// Runs the deep suite, then prints how many loops over cases each file of tests ran, and how many cases these took. A
/// loop that failed is not counted.
pub(crate) fn run(filter: &[String]) -> Outcome {
    let log = target("deep-cases");
    // Tests append to the file, so it starts empty.
    make_folder(target(""))?;
    write(&log, "")?;
    let mut tests = command("cargo test --locked --workspace --profile deep --no-fail-fast --");
    tests.args(filter).arg("--include-ignored").env("P2M_CASES", &log);
    if env::var_os("P2M_DEEP").is_none() {
        tests.env("P2M_DEEP", "1");
    }
    let outcome = start(&mut tests);
    print_counts(&log)?;
    outcome
}

/// Prints the sums of the lines `file:line<TAB>count`, one of which each loop has written.
fn print_counts(log: &Path) -> Outcome {
    let text = read(log)?;
    let mut counts: BTreeMap<&str, [u64; 2]> = BTreeMap::new();
    for line in text.lines() {
        let parts = line.split_once('\t').and_then(|(place, count)| Some((place, count.parse::<u64>().ok()?)));
        let (place, count) = parts.ok_or_else(|| format!("{}: not a place and a count: {line}", log.display()))?;
        let file = place.rsplit_once(':').map_or(place, |(file, _)| file);
        let sums = counts.entry(file).or_default();
        *sums = [sums[0] + 1, sums[1] + count];
    }
    println!("\n{:<52} {:>8} {:>12}", "file", "loops", "cases");
    for (file, [loops, cases]) in &counts {
        println!("{file:<52} {loops:>8} {cases:>12}");
    }
    let [loops, cases] = counts.values().fold([0, 0], |[a, b], [c, d]| [a + c, b + d]);
    println!("{:<52} {loops:>8} {cases:>12}", "all");
    if cases == 0 { Err("no test has counted any case".into()) } else { Ok(()) }
}
