//! How much memory a piece of work takes.

/// Buffers of a fixed size, in bytes.
const FIXED: usize = 1 << 17;

/// Works, and fails if that took more than so many bytes at a time, besides [`FIXED`]; on this thread, which is the only one that
/// reading works on.
pub fn at_most<T>(bytes: usize, work: impl FnOnce() -> T) -> T {
    let mut result = None;
    let taken = allocation_counter::measure(|| result = Some(work())).bytes_max as usize;
    assert!(taken <= FIXED + bytes, "{taken} bytes taken, {bytes} and {FIXED} expected");
    result.expect("done")
}
