//! The numbers of cases and the amounts of work of all tests, which three environment variables control.
//!
//! A loop takes its cases from [`cases`], and each case draws its random numbers from its own number (`rng(name,
//! case)`). The amount of work within a case, such as the queries of a scene, comes from [`amount`].
//!
//! - Without any variable a loop runs its shallow number of cases, with shallow amounts.
//! - `P2M_DEEP=1` runs the full number of cases with full amounts, and `P2M_DEEP=20` twenty times as many cases.
//! - `P2M_SEED=12345` runs case 12345 alone, which replays a failure: `P2M_SEED=12345 cargo test --test all n1_n5`. A
//!   failure of the deep suite is replayed with `P2M_DEEP=1` in addition, because amounts may differ. Loops over cases
//!   must not be nested: both would run the case of that number.
//!
//! The cases of a shallow loop have the same numbers, and so the same seeds, as the first cases of the full loop. A
//! loop that panics prints the number of its case and the variables that replay it. If `P2M_CASES` names a file, each
//! loop appends a line to it when it ends: the location of the call of [`cases`], a tab and the number of cases.

use std::io::Write;
use std::ops::Range;
use std::panic::Location;

/// The numbers of the cases that a loop runs. Each clone is an independent loop.
#[derive(Debug)]
pub struct Cases {
    numbers: Range<u64>,
    /// The number of cases with `P2M_DEEP=1`.
    full: u64,
    /// The number in `P2M_DEEP`, if it is set.
    times: Option<u64>,
    is_replay: bool,
    /// The location of the call of [`cases`].
    location: &'static Location<'static>,
    /// The number of cases that the loop has taken.
    taken: usize,
    /// The case that runs now; `None` before and after the loop.
    current: Option<u64>,
}

impl Cases {
    /// Returns whether only a single case runs, whose number is in `P2M_SEED`. Statistics of many cases are then
    /// meaningless.
    #[must_use]
    pub fn is_replay(&self) -> bool {
        self.is_replay
    }

    /// Returns whether `count` exceeds its share of `in_full`, the limit for the full number of cases. Returns `true`
    /// when a single case is replayed.
    #[must_use]
    pub fn have_more_than(&self, in_full: usize, count: usize) -> bool {
        self.is_replay || self.scaled(count) > in_full as u128 * self.len() as u128
    }

    /// Returns whether `count` is below its share of `in_full`, the limit for the full number of cases. Returns `true`
    /// when a single case is replayed.
    #[must_use]
    pub fn have_fewer_than(&self, in_full: usize, count: usize) -> bool {
        self.is_replay || self.scaled(count) < in_full as u128 * self.len() as u128
    }

    fn scaled(&self, count: usize) -> u128 {
        count as u128 * u128::from(self.full)
    }

    /// Returns the number after the last case.
    #[must_use]
    pub fn end(&self) -> u64 {
        self.numbers.end
    }

    /// Returns the message for a panic of the loop: the number of the case and the variables that replay it. Returns
    /// `None` if no loop is running.
    fn failure(&self) -> Option<String> {
        let (case, location) = (self.current?, self.location);
        let deep = self.times.map_or_else(String::new, |times| format!("P2M_DEEP={times} "));
        let location = format!("{}:{}", location.file(), location.line());
        Some(format!("case {case} failed: {deep}P2M_SEED={case} replays it (cases of {location})"))
    }
}

impl Clone for Cases {
    fn clone(&self) -> Self {
        Self { numbers: self.numbers.clone(), taken: 0, current: None, ..*self }
    }
}

impl Drop for Cases {
    fn drop(&mut self) {
        if std::thread::panicking() {
            if let Some(failure) = self.failure() {
                print_line(&failure);
            }
        } else if self.taken > 0 {
            record(self.location, self.taken);
        }
    }
}

impl Iterator for Cases {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        self.nth(0)
    }

    fn nth(&mut self, skipped: usize) -> Option<u64> {
        self.current = self.numbers.nth(skipped);
        self.taken += usize::from(self.current.is_some());
        self.current
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.numbers.size_hint()
    }
}

impl ExactSizeIterator for Cases {}

/// The settings of the environment.
struct Settings {
    /// The value of `P2M_DEEP`.
    deep: Option<String>,
    /// The value of `P2M_SEED`.
    seed: Option<String>,
}

impl Settings {
    /// Reads the settings of this process.
    fn from_environment() -> Self {
        let read = |name: &str| std::env::var_os(name).map(|text| text.to_string_lossy().into_owned());
        Self { deep: read("P2M_DEEP"), seed: read("P2M_SEED") }
    }

    /// Returns how many times the full number of cases runs, or `None` for shallow tests.
    fn times(&self) -> Option<u64> {
        self.deep.as_ref().map(|text| match text.parse() {
            Ok(times) if times > 0 => times,
            _ => panic!("P2M_DEEP is a whole number of 1 or more, not {text:?}"),
        })
    }

    /// Returns the number of the single case that runs, if `P2M_SEED` names one.
    fn only(&self) -> Option<u64> {
        self.seed.as_ref().map(|text| {
            text.parse().unwrap_or_else(|_| panic!("P2M_SEED is the whole number of one case, not {text:?}"))
        })
    }

    #[track_caller]
    fn cases(&self, full: u64, shallow: u64) -> Cases {
        assert!(shallow <= full, "{shallow} shallow cases are more than {full} full ones");
        let numbers = match (self.only(), self.times()) {
            (Some(case), _) => case..case + 1,
            (None, Some(times)) => 0..full.saturating_mul(times),
            (None, None) => 0..shallow,
        };
        let (is_replay, location) = (self.seed.is_some(), Location::caller());
        Cases { numbers, full, times: self.times(), is_replay, location, taken: 0, current: None }
    }
}

/// Returns the numbers of the cases of a loop, from zero: `shallow` cases by default, `full` or a multiple of it with
/// `P2M_DEEP`, and a single one with `P2M_SEED`.
///
/// # Panics
/// Panics if an environment variable is not a number, if `shallow` exceeds `full`, or, at the end of the loop, if the
/// file that `P2M_CASES` names cannot be written.
#[must_use]
#[track_caller]
pub fn cases(full: u64, shallow: u64) -> Cases {
    Settings::from_environment().cases(full, shallow)
}

/// Returns `full` in the deep suite (`P2M_DEEP`), and `shallow` otherwise. It is for the amount of work within a case.
#[must_use]
pub fn amount<T>(full: T, shallow: T) -> T {
    if is_deep() { full } else { shallow }
}

/// Returns whether this is the deep suite (`P2M_DEEP`).
#[must_use]
pub fn is_deep() -> bool {
    depth() > 0
}

/// Returns how many times the full number of cases runs, which is the number in `P2M_DEEP`, or zero for shallow tests.
#[must_use]
pub fn depth() -> u64 {
    Settings::from_environment().times().unwrap_or(0)
}

/// Prints a line. The tests of this file can read it.
fn print_line(line: &str) {
    #[cfg(test)]
    tests::heard(line);
    eprintln!("{line}");
}

/// Appends the location of a loop and its number of cases to the file that `P2M_CASES` names.
fn record(location: &Location<'_>, count: usize) {
    append("P2M_CASES", &format!("{}:{}\t{count}\n", location.file(), location.line()));
}

/// Appends a line to the file that a variable names, if it is set. Each line is a single write, so that lines of several
/// threads and programs do not mix.
pub(crate) fn append(variable: &str, line: &str) {
    let Some(path) = std::env::var_os(variable) else { return };
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&path);
    file.and_then(|mut file| file.write_all(line.as_bytes()))
        .unwrap_or_else(|error| panic!("{variable} names {}, which cannot be written: {error}", path.display()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::panic::{AssertUnwindSafe, catch_unwind};

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
    fn figures_are_in_proportion_and_count_only_where_all_cases_run() {
        for (deep, twelve) in [(None, 12), (Some("1"), 300), (Some("20"), 6000)] {
            let all = settings(deep, None).cases(600, 24);
            assert!(!all.is_replay() && all.have_more_than(300, twelve + 1) && !all.have_more_than(300, twelve));
            assert!(all.have_fewer_than(300, twelve - 1) && !all.have_fewer_than(300, twelve));
        }
        let one = settings(None, Some("5")).cases(600, 24);
        assert!(one.is_replay() && one.have_more_than(300, 0) && one.have_fewer_than(300, 300));
    }

    thread_local! {
        /// The messages that this thread printed for loops that panicked.
        static PRINTED: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
    }

    pub(super) fn heard(line: &str) {
        PRINTED.with_borrow_mut(|printed| printed.push(line.to_owned()));
    }

    /// Returns the beginnings of the messages that `run` prints if it panics.
    fn printed(deep: Option<&str>, seed: Option<&str>, run: impl FnOnce(Cases)) -> Vec<String> {
        let cases = settings(deep, seed).cases(60, 24);
        assert!(catch_unwind(AssertUnwindSafe(|| run(cases))).is_err(), "it should panic");
        let start =
            |line: String| line.split_once(" (cases of tools/testkit/src/depth.rs:").map(|(start, _)| start.to_owned());
        PRINTED.take().into_iter().map(|line| start(line).expect("the location is printed")).collect()
    }

    #[test]
    fn loops_that_panic_say_their_case() {
        let at_17 = |case: u64| assert_ne!(case, 17, "this panic is meant");
        let panicking_loop = |cases: Cases| {
            // Neither cases outside of a loop nor a loop without a panic print a message.
            for case in cases.clone().take(17) {
                at_17(case);
            }
            for case in cases.clone() {
                let _unused = cases.clone();
                at_17(case);
            }
        };
        assert_eq!(printed(None, None, panicking_loop), ["case 17 failed: P2M_SEED=17 replays it"]);
        assert_eq!(printed(Some("2"), None, panicking_loop), ["case 17 failed: P2M_DEEP=2 P2M_SEED=17 replays it"]);
        assert_eq!(
            printed(Some("1"), Some("17"), panicking_loop),
            ["case 17 failed: P2M_DEEP=1 P2M_SEED=17 replays it"]
        );
        let expected = ["case 17 failed: P2M_SEED=17 replays it"];
        assert_eq!(
            printed(None, None, |cases| cases.map(|case| (case, 1)).for_each(|(case, _)| at_17(case))),
            expected
        );
        let every_fourth = |cases: Cases| {
            for case in cases.skip(1).step_by(4) {
                at_17(case);
            }
        };
        assert_eq!(printed(None, None, every_fourth), expected);
        let figures = |cases: Cases| {
            assert_eq!(cases.clone().sum::<u64>(), 0, "this panic is meant");
        };
        assert!(printed(None, None, figures).is_empty(), "the loop is over");
    }

    #[test]
    fn loops_within_each_other_say_both_cases_the_inner_one_first() {
        let both = |cases: Cases| {
            for case in cases.clone() {
                for other in cases.clone() {
                    assert!(case < 3 || other < 5, "this panic is meant");
                }
            }
        };
        let expected = ["case 5 failed: P2M_SEED=5 replays it", "case 3 failed: P2M_SEED=3 replays it"];
        assert_eq!(printed(None, None, both), expected);
    }

    #[test]
    fn cases_are_counted_as_they_are_taken() {
        let mut cases = settings(None, None).cases(60, 24);
        assert_eq!((cases.next(), cases.nth(3), cases.taken, cases.end()), (Some(0), Some(4), 2, 24));
        assert_eq!(cases.clone().taken, 0);
        assert_eq!((cases.by_ref().last(), cases.taken, cases.current), (Some(23), 21, None));
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
