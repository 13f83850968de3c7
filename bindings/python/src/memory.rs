//! Lists of unknown length, which may not fit into memory. Work that runs out of it unwinds, and Python gets a
//! `MemoryError`.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The memory that has to be left for all other work when a list grows, in bytes.
const SPARE_BYTES: usize = 1 << 26;

/// The payload of an unwinding because memory is missing.
pub(crate) struct OutOfMemory;

/// Ends the work of this thread because memory is missing.
pub(crate) fn out_of_memory() -> ! {
    // No hook prints anything for it.
    resume_unwind(Box::new(OutOfMemory))
}

/// Returns whether there is memory for other work: small allocations anywhere would abort the process.
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

/// The bytes of lists since memory was checked.
static UNCHECKED: AtomicUsize = AtomicUsize::new(0);

/// Collects items, or unwinds.
pub(crate) fn collected<T>(items: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    let bytes = items.len() * size_of::<T>();
    // Checking for each of many short lists would take longer than filling them.
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

/// Joins lists that parts returned, or unwinds. Each is freed as soon as it is moved, so there is little memory besides.
pub(crate) fn joined<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::new();
    reserve(&mut all, parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|mut part| all.append(&mut part));
    all
}
