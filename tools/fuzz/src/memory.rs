//! A limit on the memory that a function allocates.

/// The size of the buffers that any reader may allocate, in bytes.
const FIXED_BUFFER_BYTES: usize = 1 << 17;

/// Runs `work`, and panics if it allocates more than `bytes` at one time in addition to [`FIXED_BUFFER_BYTES`]. Only
/// this thread is measured, because readers use one thread without the feature `rayon`.
pub fn at_most<T>(bytes: usize, work: impl FnOnce() -> T) -> T {
    let mut result = None;
    let taken = allocation_counter::measure(|| result = Some(work())).bytes_max as usize;
    assert!(taken <= FIXED_BUFFER_BYTES + bytes, "{taken} bytes taken, {bytes} and {FIXED_BUFFER_BYTES} expected");
    result.expect("done")
}
