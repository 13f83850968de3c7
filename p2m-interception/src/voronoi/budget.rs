//! The memory and work budget of a build of Voronoi cells. If it is exceeded, the index falls back to its tree.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The least number of primitives that a budget is computed for. Smaller scenes have the budget of a scene with this
/// many.
const MIN_PRIMITIVES_FOR_BUDGET: usize = 1000;

/// The memory and work budget of a build, which its threads share. Whether it is exceeded does not depend on the order
/// in which threads work, and if it is exceeded, everything that was built is discarded. So the index is the same on
/// any number of threads.
pub(crate) struct BuildBudget {
    /// The largest size of one structure.
    bytes: usize,
    /// The largest number of tests.
    work: u64,
    /// The tests so far.
    charged: AtomicU64,
    /// Whether a limit was exceeded.
    is_exceeded: AtomicBool,
}

impl BuildBudget {
    /// Makes a budget from numbers of bytes and of tests per primitive.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is nothing")]
    pub(crate) fn new(bytes: f64, work: f64, primitives: usize) -> Self {
        let count = primitives.max(MIN_PRIMITIVES_FOR_BUDGET) as f64;
        // The numbers of blocks and packets have 32 bits.
        let bytes = ((bytes * count) as usize).min(size_of::<u32>().saturating_mul(u32::MAX as usize));
        Self { bytes, work: (work * count) as u64, charged: AtomicU64::new(0), is_exceeded: AtomicBool::new(false) }
    }

    /// Charges tests of a node or a packet at a point, or evaluations of a primitive.
    pub(crate) fn charge(&self, tests: usize) {
        let charged = self.charged.fetch_add(tests as u64, Ordering::Relaxed) + tests as u64;
        if charged > self.work {
            self.is_exceeded.store(true, Ordering::Relaxed);
        }
    }

    /// Returns whether a structure may grow to some number of elements, and records it if it may not.
    pub(crate) fn fits<T>(&self, count: usize) -> bool {
        let fits = count.saturating_mul(size_of::<T>()) <= self.bytes;
        if !fits {
            self.is_exceeded.store(true, Ordering::Relaxed);
        }
        fits
    }

    /// Returns the number of tests so far.
    #[cfg(test)]
    pub(crate) fn charged(&self) -> u64 {
        self.charged.load(Ordering::Relaxed)
    }

    /// Returns whether the budget is exceeded.
    pub(crate) fn is_exceeded(&self) -> bool {
        self.is_exceeded.load(Ordering::Relaxed)
    }
}

/// Returns the largest number of tetrahedra that is allowed for a number of vertices. Sites usually have seven
/// tetrahedra, and rarely more than nine (observed).
pub(crate) fn max_tetrahedra(vertices: usize) -> usize {
    const TETRAHEDRA_PER_VERTEX: usize = 16;
    // The corners of all tetrahedra are counted in 32 bits.
    vertices.max(MIN_PRIMITIVES_FOR_BUDGET).saturating_mul(TETRAHEDRA_PER_VERTEX).min(u32::MAX as usize / 4)
}

/// Converts a number to 32 bits. Budgets ensure that it fits.
pub(crate) fn to_u32(n: usize) -> u32 {
    u32::try_from(n).expect("numbers of 32 bits")
}

/// The limits of a build, which all of its stages share.
#[derive(Clone, Copy)]
pub(crate) struct Limits<'a> {
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
    /// The largest number of packets in a list.
    pub(crate) max_list_packets: usize,
    /// The largest number of added sites.
    pub(crate) max_added_sites: usize,
    /// Whether all threads are used.
    pub(crate) parallel: bool,
    /// The memory and work budget.
    pub(crate) budget: &'a BuildBudget,
}
