//! Heap memory, by an allocator that counts.
//!
//! StatsCollector costs every allocation one or two atomic additions and turns growing in place into copying, for all
//! contenders alike. It shows in the build times of those that grow many vectors, and where all hits of a ray are asked
//! for; other queries of none of them allocate, unless a traversal outgrows its inline stack.

use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Bytes allocated now.
pub(crate) fn current() -> usize {
    ALLOCATOR.current_usage()
}

/// Forgets all peaks up to now.
pub(crate) fn reset_peak() {
    ALLOCATOR.reset_peak_usage();
}

/// The most bytes that were allocated at a time since [`reset_peak`].
pub(crate) fn peak() -> usize {
    ALLOCATOR.peak_usage()
}

/// What `make` returns, and the heap bytes that this holds.
pub(crate) fn measured<V>(make: impl FnOnce() -> V) -> (V, usize) {
    let before = current();
    let value = make();
    (value, current().saturating_sub(before))
}
