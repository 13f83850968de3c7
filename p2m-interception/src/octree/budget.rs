//! The budgets of a refinement and its progress.

use crate::progress::{BuildStage, Progress};
use std::sync::atomic::{AtomicU64, Ordering};

/// What has been done so far, and what may be.
pub(crate) struct BudgetCounters<'a> {
    pub(crate) bytes: AtomicU64,
    pub(crate) work: AtomicU64,
    /// No more than this.
    pub(crate) budgets: [u64; 2],
    /// Parts of 2^-40 of the whole, and the last percent that was reported.
    pub(crate) finished: AtomicU64,
    pub(crate) percent: AtomicU64,
    pub(crate) progress: &'a (dyn Fn(Progress) + Sync),
}

impl BudgetCounters<'_> {
    /// Whether a budget is exceeded: what is made is of no use then.
    pub(crate) fn is_exceeded(&self) -> bool {
        self.bytes.load(Ordering::Relaxed) > self.budgets[0] || self.work.load(Ordering::Relaxed) > self.budgets[1]
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share is from 0 to 1")]
    pub(crate) fn add_finished(&self, finished: f64) {
        const ALL: f64 = (1u64 << 40) as f64;
        let part = (finished * ALL) as u64;
        let all = self.finished.fetch_add(part, Ordering::Relaxed) + part;
        let percent = (all as f64 / ALL * 100.0) as u64;
        if self.percent.fetch_max(percent, Ordering::Relaxed) < percent {
            let part = (percent as f64 / 100.0).min(1.0);
            (self.progress)(Progress { stage: BuildStage::Octree, part });
        }
    }

    pub(crate) fn charge_tests(&self, tests: usize) {
        self.work.fetch_add(tests as u64, Ordering::Relaxed);
    }
}
