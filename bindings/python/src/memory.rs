//! Lists of unknown length, which may not fit into memory. If memory runs out, the work unwinds, and Python raises a
//! `MemoryError`.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The memory in bytes that has to remain free for other work when a list grows.
const SPARE_BYTES: usize = 1 << 26;

/// The panic payload that stands for a lack of memory.
pub(crate) struct OutOfMemory;

/// Unwinds this thread because memory is missing.
pub(crate) fn out_of_memory() -> ! {
    // `resume_unwind` does not call the panic hook, so nothing is printed.
    resume_unwind(Box::new(OutOfMemory))
}

/// Returns whether enough memory remains for other work, whose small allocations would otherwise abort the process.
fn is_memory_left() -> bool {
    Vec::<u8>::new().try_reserve_exact(SPARE_BYTES).is_ok()
}

/// Makes room for more items, or unwinds.
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        let reserved = list.try_reserve(more);
        if reserved.is_err() || !is_memory_left() {
            out_of_memory();
        }
    }
}

/// The number of bytes of lists since memory was last checked.
static UNCHECKED: AtomicUsize = AtomicUsize::new(0);

/// Collects items, or unwinds.
pub(crate) fn collected<T>(items: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    let bytes = items.len() * size_of::<T>();
    // For short lists, checking memory each time would take longer than filling them.
    let unchecked = UNCHECKED.fetch_add(bytes, Ordering::Relaxed) + bytes;
    let is_due = unchecked > SPARE_BYTES / 8;
    if is_due {
        UNCHECKED.store(0, Ordering::Relaxed);
    }
    if list.try_reserve_exact(items.len()).is_err() || (is_due && !is_memory_left()) {
        out_of_memory();
    }
    list.extend(items);
    list
}

/// Joins the lists of all parts, or unwinds. Each list is freed once it has been moved, so little extra memory is
/// needed.
pub(crate) fn joined<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::new();
    reserve(&mut all, parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|mut part| all.append(&mut part));
    all
}
