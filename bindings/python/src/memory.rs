//! Lists of unknown length, which may not fit into memory. Work that runs out of it unwinds, and Python gets a
//! `MemoryError`.

use std::panic::resume_unwind;

/// The memory that has to be left for all other work when a list grows, in bytes.
const SPARE_BYTES: usize = 1 << 26;

/// The payload of an unwinding because memory is missing.
pub(crate) struct OutOfMemory;

/// Ends the work of this thread because memory is missing.
pub(crate) fn out_of_memory() -> ! {
    // No hook prints anything for it.
    resume_unwind(Box::new(OutOfMemory))
}

/// Makes room for more items, or unwinds.
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        let reserved = list.try_reserve(more);
        // Small allocations anywhere would abort the process, so something has to be left for them.
        if reserved.and_then(|()| Vec::<u8>::new().try_reserve_exact(SPARE_BYTES)).is_err() {
            out_of_memory();
        }
    }
}

/// Collects items, or unwinds.
pub(crate) fn collected<T>(items: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    if list.try_reserve_exact(items.len()).is_err() {
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
