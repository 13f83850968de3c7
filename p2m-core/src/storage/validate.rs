//! Helpers for the validation of what was loaded.

use super::error::LoadError;

/// Checks a condition that every valid section of this name satisfies.
///
/// # Errors
/// It returns [`LoadError::Inconsistent`] if the condition is false.
pub fn require(condition: bool, section: &str, reason: &'static str) -> Result<(), LoadError> {
    if condition { Ok(()) } else { Err(LoadError::inconsistent(section, reason)) }
}

/// The number of elements that one thread checks at a time.
const ELEMENTS_PER_CHUNK: usize = 1 << 12;

/// Returns whether a condition holds for all chunks of some elements, each of which is given with the index of its
/// first element. With the feature `rayon`, all threads check chunks.
pub fn all_chunks<T: Sync>(elements: &[T], holds: impl Fn(usize, &[T]) -> bool + Sync) -> bool {
    let holds = |(number, chunk): (usize, &[T])| holds(number * ELEMENTS_PER_CHUNK, chunk);
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        elements.par_chunks(ELEMENTS_PER_CHUNK).enumerate().all(holds)
    }
    #[cfg(not(feature = "rayon"))]
    elements.chunks(ELEMENTS_PER_CHUNK).enumerate().all(holds)
}
