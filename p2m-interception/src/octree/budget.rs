//! The budgets of a refinement, and how far it has come.

use crate::progress::{BuildStage, Progress};
use std::ops::{Add, AddAssign, Sub};
use std::sync::atomic::{AtomicU64, Ordering};

/// The least number of primitives that budgets are computed for. Smaller scenes have the budgets of a scene with this
/// many.
pub(crate) const MIN_PRIMITIVES_FOR_BUDGETS: usize = 10_000;

/// The amounts that cells take of the budgets.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spent {
    /// Bytes of cells and lists.
    pub(crate) bytes: i64,
    /// Tests of a packet at a point.
    pub(crate) tests: i64,
}

impl Spent {
    /// Makes an amount of bytes and tests.
    pub(crate) fn new(bytes: usize, tests: usize) -> Self {
        let [bytes, tests] = [bytes, tests].map(|n| i64::try_from(n).unwrap_or(i64::MAX));
        Self { bytes, tests }
    }

    /// Returns whether a budget is exceeded.
    pub(crate) fn exceeds(self, budgets: Self) -> bool {
        self.bytes > budgets.bytes || self.tests > budgets.tests
    }

    /// Returns the larger amount of each budget.
    pub(crate) fn max(self, other: Self) -> Self {
        Self { bytes: self.bytes.max(other.bytes), tests: self.tests.max(other.tests) }
    }

    /// Returns the spent fraction of the budget that is closer to its end.
    pub(crate) fn part_of(self, budgets: Self) -> f64 {
        (self.bytes as f64 / budgets.bytes as f64).max(self.tests as f64 / budgets.tests as f64)
    }
}

impl Add for Spent {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { bytes: self.bytes + other.bytes, tests: self.tests + other.tests }
    }
}

impl Sub for Spent {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { bytes: self.bytes - other.bytes, tests: self.tests - other.tests }
    }
}

impl AddAssign for Spent {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// The amounts that a task takes from the budgets.
#[derive(Default)]
pub(crate) struct Account {
    /// The amounts that had been spent before the task, or by an earlier time.
    before: Spent,
    /// The amounts that have been spent, including those before the task.
    pub(crate) spent: Spent,
    /// The largest amounts that the task itself had spent before a split.
    pub(crate) peak: Spent,
    /// Whether cells were not split because a budget was exceeded.
    pub(crate) is_truncated: bool,
}

impl Account {
    /// Begins with the amounts that have been spent before.
    pub(crate) fn new(before: Spent) -> Self {
        Self { before, spent: before, ..Self::default() }
    }

    /// Returns what the task itself has spent.
    pub(crate) fn own(&self) -> Spent {
        self.spent - self.before
    }

    /// Returns whether no cell may be split any more because a budget is exceeded.
    pub(crate) fn exceeds(&mut self, budgets: Spent) -> bool {
        self.peak = self.peak.max(self.own());
        let exceeds = self.spent.exceeds(budgets);
        self.is_truncated |= exceeds;
        exceeds
    }
}

/// Reports how much of the domain is finished.
pub(crate) struct FinishedPart<'a> {
    /// The finished part of the domain, in units of 2^-40.
    finished: AtomicU64,
    /// The percentage that was reported last.
    percent: AtomicU64,
    /// Receives the progress.
    progress: &'a (dyn Fn(Progress) + Sync),
}

impl<'a> FinishedPart<'a> {
    /// Begins with nothing.
    pub(crate) fn new(progress: &'a (dyn Fn(Progress) + Sync)) -> Self {
        Self { finished: AtomicU64::new(0), percent: AtomicU64::new(0), progress }
    }

    /// Adds a finished part of the domain, from 0 to 1, and reports each new percent.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
    pub(crate) fn add(&self, part_of_domain: f64) {
        const ALL: f64 = (1u64 << 40) as f64;
        let part = (part_of_domain * ALL) as u64;
        let all = self.finished.fetch_add(part, Ordering::Relaxed) + part;
        let percent = ((all as f64 / ALL * 100.0) as u64).min(100);
        if self.percent.fetch_max(percent, Ordering::Relaxed) < percent {
            let part = percent as f64 / 100.0;
            (self.progress)(Progress { stage: BuildStage::Octree, part });
        }
    }
}
