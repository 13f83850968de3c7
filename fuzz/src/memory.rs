//! Bounds the memory that a function allocates.

/// Buffers of a fixed size, in bytes.
const FIXED: usize = 1 << 17;

/// Runs `work`, and panics if it allocated more than `bytes` at a time in addition to [`FIXED`]. Only this thread is
/// measured, because readers work on one thread.
pub fn at_most<T>(bytes: usize, work: impl FnOnce() -> T) -> T {
    let mut result = None;
    let taken = allocation_counter::measure(|| result = Some(work())).bytes_max as usize;
    assert!(taken <= FIXED + bytes, "{taken} bytes taken, {bytes} and {FIXED} expected");
    result.expect("done")
}
