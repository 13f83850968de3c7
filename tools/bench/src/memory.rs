//! Heap memory, measured by an allocator that counts.
//!
//! Counting costs every allocation one or two atomic additions and turns growth in place into copies, for all backends
//! alike. It shows in the build times of backends that grow many vectors, and in queries for all hits of a ray. Other
//! queries do not allocate, unless a traversal outgrows its inline stack.

use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Returns the number of bytes that are allocated at present.
pub(crate) fn current() -> usize {
    ALLOCATOR.current_usage()
}

/// Resets [`peak`] to the bytes that are allocated at present.
pub(crate) fn reset_peak() {
    ALLOCATOR.reset_peak_usage();
}

/// Returns the largest number of bytes allocated at one time since [`reset_peak`].
pub(crate) fn peak() -> usize {
    ALLOCATOR.peak_usage()
}

/// Returns the result of `make` and the number of heap bytes that it holds.
pub(crate) fn measured<V>(make: impl FnOnce() -> V) -> (V, usize) {
    let before = current();
    let value = make();
    (value, current().saturating_sub(before))
}
