//! Whether there is memory, asked for before it is needed.

use crate::BuildError;

/// Asks the allocator for as much memory as building an index may need at a time, and gives it back at once.
///
/// A probe, not a guarantee: what is free now may be taken a moment later, by other threads and programs, it may be in pieces,
/// and systems that promise more memory than they have refuse nothing but absurd sizes. What it is for is that a build that
/// cannot succeed under a limit of memory (of the process, of a container whose allocator knows it, of the address space) is
/// a typed error and no abort. The memory is not touched, so it costs some microseconds.
///
/// # Errors
/// [`BuildError::OutOfMemory`].
pub fn check_room(bytes: usize) -> Result<(), BuildError> {
    let mut room: Vec<u8> = Vec::new();
    let refused = room.try_reserve_exact(bytes).is_err();
    // Or the compiler leaves out what nobody uses.
    std::hint::black_box(&mut room);
    if refused { Err(BuildError::OutOfMemory { bytes }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absurd_sizes_are_refused_and_usual_ones_are_not() {
        for bytes in [usize::MAX, usize::MAX / 2 + 1, usize::MAX / 2] {
            assert_eq!(check_room(bytes), Err(BuildError::OutOfMemory { bytes }));
        }
        assert_eq!(check_room(0), Ok(()));
        assert_eq!(check_room(1 << 20), Ok(()));
    }
}
