//! Helpers for the validation of loaded files.

use super::error::LoadError;
use crate::parallel;

/// Checks a condition that every valid section with this name satisfies.
///
/// # Errors
/// It returns [`LoadError::Inconsistent`] if the condition is false.
pub fn require(condition: bool, section: &str, reason: &'static str) -> Result<(), LoadError> {
    if condition { Ok(()) } else { Err(LoadError::inconsistent(section, reason)) }
}

/// The number of elements that one thread checks at a time.
const ELEMENTS_PER_CHUNK: usize = 1 << 12;

/// Checks elements chunk by chunk. `check` gets each chunk with the index of its first element. With the feature
/// `rayon`, chunks are checked on all threads, and any one of several errors is returned.
///
/// # Errors
/// It returns an error of `check`.
pub fn check_chunks<T: Sync>(
    elements: &[T],
    check: impl Fn(usize, &[T]) -> Result<(), LoadError> + Sync,
) -> Result<(), LoadError> {
    parallel::try_for_each(elements.len().div_ceil(ELEMENTS_PER_CHUNK), true, |chunk| {
        let first = chunk * ELEMENTS_PER_CHUNK;
        check(first, &elements[first..elements.len().min(first + ELEMENTS_PER_CHUNK)])
    })
}
