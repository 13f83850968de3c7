//! How much memory a piece of work takes.

use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Buffers of a fixed size, in bytes.
const FIXED: usize = 1 << 17;

/// Works, and fails if that took more than so many bytes at a time, besides [`FIXED`]. Nothing else may be going on.
pub fn at_most<T>(bytes: usize, work: impl FnOnce() -> T) -> T {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let result = work();
    let taken = MEMORY.peak_usage().saturating_sub(before);
    assert!(taken <= FIXED + bytes, "{taken} bytes taken, {bytes} and {FIXED} expected");
    result
}
