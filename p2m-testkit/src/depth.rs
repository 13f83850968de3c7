//! How much the tests do: one knob for all loops over cases.
//!
//! A loop takes its cases from [`cases`], and each case draws its random numbers from its own number (`rng(name, case)`).
//! How much there is within a case, such as queries of a scene, comes from [`amount`]. Three environment variables turn the
//! knob:
//!
//! - Without any of them a loop runs its shallow number of cases, with shallow amounts.
//! - `P2M_DEEP=1` runs the full number of cases with full amounts, and `P2M_DEEP=20` twenty times as many cases.
//! - `P2M_SEED=12345` runs case 12345 alone, which is how a failure is replayed:
//!   `P2M_SEED=12345 cargo test --test all n1_n5`. A failure of the deep suite is replayed with `P2M_DEEP=1` beside it, since
//!   amounts may differ.
//!
//! The cases of a shallow loop have the same numbers, and so the same seeds, as the first ones of the full loop. Where
//! `P2M_CASES` names a file, each call of [`cases`] appends a line to it: the place of the call, a tab and the number of cases.

use std::io::Write;
use std::ops::Range;
use std::panic::Location;

/// The numbers of the cases that a loop runs.
#[derive(Clone, Debug)]
pub struct Cases {
    numbers: Range<u64>,
    is_replay: bool,
}

impl Cases {
    /// Whether only one case runs because its number is in `P2M_SEED`. Figures of many cases mean nothing then.
    #[must_use]
    pub fn is_replay(&self) -> bool {
        self.is_replay
    }

    /// Whether `count` is more than `share` times the number of these cases. Always true of a case that is replayed.
    #[must_use]
    pub fn have_more_than(&self, share: f64, count: usize) -> bool {
        self.is_replay || count as f64 > share * self.len() as f64
    }
}

impl Iterator for Cases {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        self.numbers.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.numbers.size_hint()
    }
}

impl ExactSizeIterator for Cases {}

/// The settings of the environment.
struct Settings {
    /// That of `P2M_DEEP`.
    deep: Option<String>,
    /// That of `P2M_SEED`.
    seed: Option<String>,
}

impl Settings {
    /// The settings of this process.
    fn of_the_process() -> Self {
        let read = |name: &str| std::env::var_os(name).map(|text| text.to_string_lossy().into_owned());
        Self { deep: read("P2M_DEEP"), seed: read("P2M_SEED") }
    }

    /// How many times the full number of cases runs; none where tests are shallow.
    fn times(&self) -> Option<u64> {
        self.deep.as_ref().map(|text| match text.parse() {
            Ok(times) if times > 0 => times,
            _ => panic!("P2M_DEEP is a whole number of 1 or more, not {text:?}"),
        })
    }

    /// The one case that runs, if there is only one.
    fn only(&self) -> Option<u64> {
        self.seed.as_ref().map(|text| {
            text.parse().unwrap_or_else(|_| panic!("P2M_SEED is the whole number of one case, not {text:?}"))
        })
    }

    fn cases(&self, full: u64, shallow: u64) -> Cases {
        assert!(shallow <= full, "{shallow} shallow cases are more than {full} full ones");
        let numbers = match (self.only(), self.times()) {
            (Some(case), _) => case..case + 1,
            (None, Some(times)) => 0..full.saturating_mul(times),
            (None, None) => 0..shallow,
        };
        Cases { numbers, is_replay: self.seed.is_some() }
    }
}

/// The numbers of the cases of a loop, from zero: `shallow` of them by default, `full` of them or a multiple with `P2M_DEEP`,
/// and a single one with `P2M_SEED`.
///
/// # Panics
/// If a variable of the environment is no number, if `shallow` is more than `full`, or if the file that `P2M_CASES` names
/// cannot be written.
#[must_use]
#[track_caller]
pub fn cases(full: u64, shallow: u64) -> Cases {
    let cases = Settings::of_the_process().cases(full, shallow);
    record(Location::caller(), cases.len());
    cases
}

/// `full` in the deep suite, which `P2M_DEEP` asks for, and `shallow` otherwise: how much there is of something within a case.
#[must_use]
pub fn amount<T>(full: T, shallow: T) -> T {
    if is_deep() { full } else { shallow }
}

/// Whether this is the deep suite, which `P2M_DEEP` asks for.
#[must_use]
pub fn is_deep() -> bool {
    depth() > 0
}

/// How many times the full number of cases runs, which is the number in `P2M_DEEP`; zero where tests are shallow.
#[must_use]
pub fn depth() -> u64 {
    Settings::of_the_process().times().unwrap_or(0)
}

/// Appends the place of a loop and its number of cases to the file that `P2M_CASES` names. The line is written at once, so
/// that lines of several threads and programs do not mix.
fn record(place: &Location<'_>, count: usize) {
    let Some(path) = std::env::var_os("P2M_CASES") else { return };
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&path);
    let line = format!("{}:{}\t{count}\n", place.file(), place.line());
    file.and_then(|mut file| file.write_all(line.as_bytes()))
        .unwrap_or_else(|error| panic!("P2M_CASES names {}, which cannot be written: {error}", path.display()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::catch_unwind;

    fn settings(deep: Option<&str>, seed: Option<&str>) -> Settings {
        Settings { deep: deep.map(str::to_owned), seed: seed.map(str::to_owned) }
    }

    #[test]
    fn depth_decides_how_many_cases_run() {
        let numbers = |deep, seed| settings(deep, seed).cases(600, 24).collect::<Vec<_>>();
        assert_eq!(numbers(None, None), (0..24).collect::<Vec<_>>());
        assert_eq!(numbers(Some("1"), None), (0..600).collect::<Vec<_>>());
        assert_eq!(numbers(Some("20"), None).len(), 12_000);
        assert_eq!(numbers(None, Some("17")), [17]);
        assert_eq!(numbers(Some("3"), Some("12345")), [12345], "one case is one case at any depth");
        assert_eq!(settings(Some("18446744073709551615"), None).cases(2, 1).numbers, 0..u64::MAX);
    }

    #[test]
    fn figures_count_only_where_all_cases_run() {
        let all = settings(None, None).cases(600, 24);
        assert!(!all.is_replay() && all.have_more_than(0.5, 13) && !all.have_more_than(0.5, 12));
        let one = settings(None, Some("5")).cases(600, 24);
        assert!(one.is_replay() && one.have_more_than(0.5, 0));
    }

    #[test]
    fn settings_that_make_no_sense_are_refused() {
        for bad in ["0", "-1", "1.5", "yes", ""] {
            assert!(catch_unwind(|| settings(Some(bad), None).times()).is_err(), "{bad:?}");
        }
        for bad in ["-1", "1.5", "last", ""] {
            assert!(catch_unwind(|| settings(None, Some(bad)).only()).is_err(), "{bad:?}");
        }
        assert!(catch_unwind(|| settings(None, None).cases(1, 2)).is_err());
    }
}
