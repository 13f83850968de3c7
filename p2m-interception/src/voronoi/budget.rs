//! What building cells of vertices may take: past it the tree answers alone.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Allowances are for at least so many primitives.
const FEW: usize = 1000;

/// Room and work that are left. Whether it is used up does not depend on the order of what is done, and what was made is of
/// no use then: so the index is the same on any number of threads.
pub(crate) struct Allowance {
    bytes: usize,
    work: u64,
    done: AtomicU64,
    is_over: AtomicBool,
}

impl Allowance {
    /// So many bytes and packets tested for each of some primitives.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is nothing")]
    pub(crate) fn new(bytes: f64, work: f64, primitives: usize) -> Self {
        let count = primitives.max(FEW) as f64;
        // Blocks and packets have numbers of 32 bits.
        let bytes = ((bytes * count) as usize).min(size_of::<u32>() * u32::MAX as usize);
        Self { bytes, work: (work * count) as u64, done: AtomicU64::new(0), is_over: AtomicBool::new(false) }
    }

    /// Packets were tested at so many places, or primitives evaluated.
    pub(crate) fn spend(&self, tests: usize) {
        let done = self.done.fetch_add(tests as u64, Ordering::Relaxed) + tests as u64;
        if done > self.work {
            self.is_over.store(true, Ordering::Relaxed);
        }
    }

    /// A structure comes to have so many elements of a type; whether there is room.
    pub(crate) fn holds<T>(&self, count: usize) -> bool {
        let fits = count.saturating_mul(size_of::<T>()) <= self.bytes;
        if !fits {
            self.is_over.store(true, Ordering::Relaxed);
        }
        fits
    }

    /// Whether it is used up.
    pub(crate) fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// How many tetrahedra vertices may have: sites have seven, and rarely more than nine (observed).
pub(crate) fn most_tetrahedra(vertices: usize) -> usize {
    const EACH: usize = 16;
    // Four corners of each are counted in 32 bits.
    vertices.max(FEW).saturating_mul(EACH).min(u32::MAX as usize / 4)
}

/// How many sites there may be, and what a list may have.
#[derive(Clone, Copy)]
pub(crate) struct Limits<'a> {
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Packets of a list.
    pub(crate) most: usize,
    /// Points that may be added.
    pub(crate) added: usize,
    /// Whether all threads are used.
    pub(crate) parallel: bool,
    /// What building may take.
    pub(crate) allowance: &'a Allowance,
}
