//! The budgets of a refinement, and how far it has come.
//!
//! Within a pass all counters only grow, and each cell adds the same amounts on every run. So whether a pass exceeds a
//! budget does not depend on the order in which threads refine cells.

use crate::list::block::{BLOCK_WIDTH, Block};
use crate::octree::refinement::OpenCell;
use crate::progress::{BuildStage, Progress};
use std::sync::atomic::{AtomicU64, Ordering};

/// The tests of a packet at a point that the list of an open cell takes at most: at eight corners, and at the centre.
const TESTS_PER_OPEN_PACKET: usize = 9;

/// The budgets of a refinement, with what has been spent of them.
pub(crate) struct BudgetCounters<'a> {
    /// Bytes of cells and lists so far. They include those of the lists that open cells will get.
    bytes: AtomicU64,
    /// Tests of a packet at a point so far. They include those for the lists that open cells will get.
    work: AtomicU64,
    /// The finished part of the domain, in units of 2^-40.
    finished: AtomicU64,
    /// The budgets of `bytes` and `work`.
    budgets: [u64; 2],
    /// The percentage that was reported last.
    percent: AtomicU64,
    /// Receives the progress.
    progress: &'a (dyn Fn(Progress) + Sync),
}

impl<'a> BudgetCounters<'a> {
    /// Returns the counters before anything was spent.
    pub(crate) fn new(budgets: [u64; 2], progress: &'a (dyn Fn(Progress) + Sync)) -> Self {
        let [bytes, work, finished, percent] = [0; 4].map(AtomicU64::new);
        Self { bytes, work, finished, budgets, percent, progress }
    }

    /// Returns what has been spent, which [`restore`](Self::restore) takes.
    pub(crate) fn spent(&self) -> [u64; 3] {
        [&self.bytes, &self.work, &self.finished].map(|counter| counter.load(Ordering::Relaxed))
    }

    /// Takes back what was spent since `spent` was recorded, because the cells are discarded.
    pub(crate) fn restore(&self, spent: [u64; 3]) {
        for (counter, spent) in [&self.bytes, &self.work, &self.finished].into_iter().zip(spent) {
            counter.store(spent, Ordering::Relaxed);
        }
    }

    /// Returns the tests of packets so far.
    pub(crate) fn work(&self) -> u64 {
        self.spent()[1]
    }

    /// Returns the larger part of a budget that has been spent.
    pub(crate) fn spent_part(&self) -> f64 {
        let [bytes, work, _] = self.spent();
        (bytes as f64 / self.budgets[0] as f64).max(work as f64 / self.budgets[1] as f64)
    }

    /// Returns whether a budget is exceeded. The cells of the pass are discarded then.
    pub(crate) fn is_exceeded(&self) -> bool {
        let [bytes, work, _] = self.spent();
        bytes > self.budgets[0] || work > self.budgets[1]
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

    /// Adds bytes of cells and lists.
    pub(crate) fn add_bytes(&self, bytes: u64) {
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Adds what the list of an open cell will take.
    pub(crate) fn reserve(&self, cell: &OpenCell) {
        let [bytes, work] = reserved_for(cell);
        self.add_bytes(bytes);
        self.work.fetch_add(work, Ordering::Relaxed);
    }

    /// Takes back what was reserved for the list of an open cell.
    pub(crate) fn release(&self, cell: &OpenCell) {
        let [bytes, work] = reserved_for(cell);
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
        self.work.fetch_sub(work, Ordering::Relaxed);
    }
}

/// Returns the bytes and the tests of the list of an open cell at most.
fn reserved_for(cell: &OpenCell) -> [u64; 2] {
    let packets = if cell.may_have_list() { cell.candidates.len() } else { 0 };
    [packets.div_ceil(BLOCK_WIDTH) * size_of::<Block>(), packets * TESTS_PER_OPEN_PACKET].map(|n| n as u64)
}
