//! What building cells of vertices may take: past it the tree answers alone.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Allowances are for at least so many primitives.
const MIN_PRIMITIVES_FOR_BUDGET: usize = 1000;

/// Room and work that are left. Whether it is used up does not depend on the order of what is charged, and what was made is of
/// no use then: so the index is the same on any number of threads.
pub(crate) struct BuildBudget {
    bytes: usize,
    work: u64,
    charged: AtomicU64,
    is_exceeded: AtomicBool,
}

impl BuildBudget {
    /// So many bytes and packets tested for each of some primitives.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is nothing")]
    pub(crate) fn new(bytes: f64, work: f64, primitives: usize) -> Self {
        let count = primitives.max(MIN_PRIMITIVES_FOR_BUDGET) as f64;
        // Blocks and packets have numbers of 32 bits.
        let bytes = ((bytes * count) as usize).min(size_of::<u32>() * u32::MAX as usize);
        Self { bytes, work: (work * count) as u64, charged: AtomicU64::new(0), is_exceeded: AtomicBool::new(false) }
    }

    /// Packets were tested at so many positions, or primitives evaluated.
    pub(crate) fn charge(&self, tests: usize) {
        let charged = self.charged.fetch_add(tests as u64, Ordering::Relaxed) + tests as u64;
        if charged > self.work {
            self.is_exceeded.store(true, Ordering::Relaxed);
        }
    }

    /// A structure comes to have so many elements of a type; whether there is room.
    pub(crate) fn fits<T>(&self, count: usize) -> bool {
        let fits = count.saturating_mul(size_of::<T>()) <= self.bytes;
        if !fits {
            self.is_exceeded.store(true, Ordering::Relaxed);
        }
        fits
    }

    /// Whether it is used up.
    pub(crate) fn is_exceeded(&self) -> bool {
        self.is_exceeded.load(Ordering::Relaxed)
    }
}

/// How many tetrahedra vertices may have: sites have seven, and rarely more than nine (observed).
pub(crate) fn max_tetrahedra(vertices: usize) -> usize {
    const TETRAHEDRA_PER_VERTEX: usize = 16;
    // Four corners of each are counted in 32 bits.
    vertices.max(MIN_PRIMITIVES_FOR_BUDGET).saturating_mul(TETRAHEDRA_PER_VERTEX).min(u32::MAX as usize / 4)
}

/// How many sites there may be, and what a list may have.
#[derive(Clone, Copy)]
pub(crate) struct Limits<'a> {
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Packets of a list.
    pub(crate) max_list_packets: usize,
    /// Points that may be max_added_sites.
    pub(crate) max_added_sites: usize,
    /// Whether all threads are used.
    pub(crate) parallel: bool,
    /// What building may take.
    pub(crate) budget: &'a BuildBudget,
}
