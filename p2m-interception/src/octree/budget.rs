//! The budgets of a refinement, and how far it has come.
//!
//! All counters only grow, and each cell adds the same amounts on every run. So whether a budget is exceeded in the
//! end does not depend on the order in which threads refine cells.

use crate::progress::{BuildStage, Progress};
use std::sync::atomic::{AtomicU64, Ordering};

/// The budgets of a refinement, with what has been spent of them.
pub(crate) struct BudgetCounters<'a> {
    /// Bytes of cells and lists so far.
    pub(crate) bytes: AtomicU64,
    /// Tests of a packet at a point so far.
    pub(crate) work: AtomicU64,
    /// The budgets of `bytes` and `work`.
    pub(crate) budgets: [u64; 2],
    /// The finished part of the domain, in units of 2^-40.
    pub(crate) finished: AtomicU64,
    /// The percentage that was reported last.
    pub(crate) percent: AtomicU64,
    /// Receives the progress.
    pub(crate) progress: &'a (dyn Fn(Progress) + Sync),
}

impl BudgetCounters<'_> {
    /// Returns whether a budget is exceeded. The cells are discarded then.
    pub(crate) fn is_exceeded(&self) -> bool {
        self.bytes.load(Ordering::Relaxed) > self.budgets[0] || self.work.load(Ordering::Relaxed) > self.budgets[1]
    }

    /// Adds a finished part of the domain, from 0 to 1, and reports each new percent.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
    pub(crate) fn add_finished(&self, part_of_domain: f64) {
        const ALL: f64 = (1u64 << 40) as f64;
        let part = (part_of_domain * ALL) as u64;
        let all = self.finished.fetch_add(part, Ordering::Relaxed) + part;
        let percent = (all as f64 / ALL * 100.0) as u64;
        if self.percent.fetch_max(percent, Ordering::Relaxed) < percent {
            let part = (percent as f64 / 100.0).min(1.0);
            (self.progress)(Progress { stage: BuildStage::Octree, part });
        }
    }

    /// Adds tests of packets to the work.
    pub(crate) fn charge_tests(&self, tests: usize) {
        self.work.fetch_add(tests as u64, Ordering::Relaxed);
    }
}
