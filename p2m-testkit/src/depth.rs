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
//!   amounts may differ. No loop over cases is within another one: both would run the case of that number.
//!
//! The cases of a shallow loop have the same numbers, and so the same seeds, as the first ones of the full loop. A loop that
//! panics prints the number of its case, and with which variables that case is replayed. Where `P2M_CASES` names a file, each
//! loop appends a line to it when it is over: the place of the call of [`cases`], a tab and how many cases the loop took.

use std::io::Write;
use std::ops::Range;
use std::panic::Location;

/// The numbers of the cases that a loop runs. Each clone is a loop of its own.
#[derive(Debug)]
pub struct Cases {
    numbers: Range<u64>,
    /// How many there are of them with `P2M_DEEP=1`.
    full: u64,
    /// The number in `P2M_DEEP`.
    times: Option<u64>,
    is_replay: bool,
    /// Where [`cases`] was called.
    place: &'static Location<'static>,
    /// How many of them a loop has taken from here.
    taken: usize,
    /// The one that it has taken last; none before the loop and after it.
    current: Option<u64>,
}

impl Cases {
    /// Whether only one case runs because its number is in `P2M_SEED`. Figures of many cases mean nothing then.
    #[must_use]
    pub fn is_replay(&self) -> bool {
        self.is_replay
    }

    /// Whether `count` is more than what it has to exceed where these are the full number of cases, `in_full`, or than that in
    /// proportion to their number. Always true of a case that is replayed.
    #[must_use]
    pub fn have_more_than(&self, in_full: usize, count: usize) -> bool {
        self.is_replay || self.scaled(count) > in_full as u128 * self.len() as u128
    }

    /// Whether `count` is less than what it has to stay below where these are the full number of cases, `in_full`, or than that
    /// in proportion to their number. Always true of a case that is replayed.
    #[must_use]
    pub fn have_fewer_than(&self, in_full: usize, count: usize) -> bool {
        self.is_replay || self.scaled(count) < in_full as u128 * self.len() as u128
    }

    fn scaled(&self, count: usize) -> u128 {
        count as u128 * u128::from(self.full)
    }

    /// One more than the number of the last case.
    #[must_use]
    pub fn end(&self) -> u64 {
        self.numbers.end
    }

    /// What is said when the loop panics: which case that was, and how it is replayed. Nothing is said of cases that no loop
    /// is over.
    fn failure(&self) -> Option<String> {
        let (case, place) = (self.current?, self.place);
        let deep = self.times.map_or_else(String::new, |times| format!("P2M_DEEP={times} "));
        let place = format!("{}:{}", place.file(), place.line());
        Some(format!("case {case} failed: {deep}P2M_SEED={case} replays it (cases of {place})"))
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
                say(&failure);
            }
        } else if self.taken > 0 {
            record(self.place, self.taken);
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

    #[track_caller]
    fn cases(&self, full: u64, shallow: u64) -> Cases {
        assert!(shallow <= full, "{shallow} shallow cases are more than {full} full ones");
        let numbers = match (self.only(), self.times()) {
            (Some(case), _) => case..case + 1,
            (None, Some(times)) => 0..full.saturating_mul(times),
            (None, None) => 0..shallow,
        };
        let (is_replay, place) = (self.seed.is_some(), Location::caller());
        Cases { numbers, full, times: self.times(), is_replay, place, taken: 0, current: None }
    }
}

/// The numbers of the cases of a loop, from zero: `shallow` of them by default, `full` of them or a multiple with `P2M_DEEP`,
/// and a single one with `P2M_SEED`.
///
/// # Panics
/// If a variable of the environment is no number, or if `shallow` is more than `full`; and at the end of a loop if the file that
/// `P2M_CASES` names cannot be written.
#[must_use]
#[track_caller]
pub fn cases(full: u64, shallow: u64) -> Cases {
    Settings::of_the_process().cases(full, shallow)
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

/// Prints a line, which tests of this file read as well.
fn say(line: &str) {
    #[cfg(test)]
    tests::heard(line);
    eprintln!("{line}");
}

/// Appends the place of a loop and its number of cases to the file that `P2M_CASES` names. A line is a single write, so that lines of several threads and programs do not mix.
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
        /// What this thread has said of loops that panicked.
        static SAID: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
    }

    pub(super) fn heard(line: &str) {
        SAID.with_borrow_mut(|said| said.push(line.to_owned()));
    }

    /// How what is said begins when this panics.
    fn said(deep: Option<&str>, seed: Option<&str>, run: impl FnOnce(Cases)) -> Vec<String> {
        let cases = settings(deep, seed).cases(60, 24);
        assert!(catch_unwind(AssertUnwindSafe(|| run(cases))).is_err(), "it should panic");
        let start =
            |line: String| line.split_once(" (cases of p2m-testkit/src/depth.rs:").map(|(start, _)| start.to_owned());
        SAID.take().into_iter().map(|line| start(line).expect("the place is said")).collect()
    }

    #[test]
    fn loops_that_panic_say_their_case() {
        let at_17 = |case: u64| assert_ne!(case, 17, "this panic is meant");
        let of_a_loop = |cases: Cases| {
            // Neither those that no loop is over nor the loop that went well have anything to say.
            for case in cases.clone().take(17) {
                at_17(case);
            }
            for case in cases.clone() {
                let _unused = cases.clone();
                at_17(case);
            }
        };
        assert_eq!(said(None, None, of_a_loop), ["case 17 failed: P2M_SEED=17 replays it"]);
        assert_eq!(said(Some("2"), None, of_a_loop), ["case 17 failed: P2M_DEEP=2 P2M_SEED=17 replays it"]);
        assert_eq!(said(Some("1"), Some("17"), of_a_loop), ["case 17 failed: P2M_DEEP=1 P2M_SEED=17 replays it"]);
        let expected = ["case 17 failed: P2M_SEED=17 replays it"];
        assert_eq!(said(None, None, |cases| cases.map(|case| (case, 1)).for_each(|(case, _)| at_17(case))), expected);
        let every_fourth = |cases: Cases| {
            for case in cases.skip(1).step_by(4) {
                at_17(case);
            }
        };
        assert_eq!(said(None, None, every_fourth), expected);
        let figures = |cases: Cases| {
            assert_eq!(cases.clone().sum::<u64>(), 0, "this panic is meant");
        };
        assert!(said(None, None, figures).is_empty(), "the loop is over");
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
        assert_eq!(said(None, None, both), expected);
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
