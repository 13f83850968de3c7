//! Errors of generators, and the checks of options that precede any allocation.

use p2m_core::{BuildError, PrimitiveId};

/// Reasons why a scene cannot be generated or changed.
///
/// ```
/// use p2m_mixed::generate::{GenerateError, TorusKnot, torus_knot};
///
/// let error = torus_knot(&TorusKnot { rings: 2, ..Default::default() }).unwrap_err();
/// assert_eq!(error, GenerateError::TooFew { option: "rings", value: 2, least: 3 });
/// assert_eq!(error.to_string(), "rings is 2, but must be at least 3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// A count among the options is too small.
    #[error("{option} is {value}, but must be at least {least}")]
    TooFew {
        /// The name of the option.
        option: &'static str,
        /// The value of the option.
        value: u32,
        /// The smallest value that is supported.
        least: u32,
    },
    /// An option is out of range or NaN.
    #[error("{option} is {value}, but must be {range}")]
    OutOfRange {
        /// The name of the option or argument.
        option: &'static str,
        /// The value of the option.
        value: f64,
        /// The range, in words.
        range: &'static str,
    },
    /// The windings of a torus knot have a common divisor, so the curve would cover itself.
    #[error("p = {p} and q = {q} must have no common divisor")]
    CommonDivisor {
        /// The number of turns around the axis of the torus.
        p: u32,
        /// The number of turns around the tube of the torus.
        q: u32,
    },
    /// The scene does not fit into memory.
    #[error("{primitives} primitives need about {} MB of memory, and {} MB are free", needed >> 20, free >> 20)]
    Memory {
        /// The number of primitives.
        primitives: usize,
        /// The memory that they need while they are made, in bytes.
        needed: u64,
        /// The memory that is free, in bytes.
        free: u64,
    },
    /// The scene is not a valid soup, because it has more primitives than ids or a coordinate overflows.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Returns [`GenerateError::OutOfRange`] unless `is_valid`. `range` describes the valid values for the message.
pub(super) fn in_range(
    is_valid: bool,
    option: &'static str,
    value: f64,
    range: &'static str,
) -> Result<(), GenerateError> {
    if is_valid { Ok(()) } else { Err(GenerateError::OutOfRange { option, value, range }) }
}

pub(super) fn at_least(least: u32, option: &'static str, value: u32) -> Result<(), GenerateError> {
    if value < least { Err(GenerateError::TooFew { option, value, least }) } else { Ok(()) }
}

/// The memory for each primitive while a scene is made, in bytes: its indices, and its share of the positions and of
/// the edges of a subdivision, twice because lists double when they grow. An estimate, not a measurement.
const BYTES_PER_PRIMITIVE: u64 = 64;
/// The number of primitives from which free memory is checked. Smaller scenes need at most 64 MiB.
const CHECK_FROM_PRIMITIVES: usize = 1 << 20;

/// Returns the number of primitives as a `usize`, or an error if there are too few ids or too little memory. The
/// argument is an u128, so that a product of three 32-bit numbers does not overflow.
pub(super) fn capacity(primitives: u128) -> Result<usize, GenerateError> {
    let len = usize::try_from(primitives).unwrap_or(usize::MAX);
    if len > PrimitiveId::MAX_COUNT {
        return Err(BuildError::TooMany { len }.into());
    }
    check_memory(len, if len < CHECK_FROM_PRIMITIVES { u64::MAX } else { free_memory() })?;
    Ok(len)
}

fn check_memory(primitives: usize, free: u64) -> Result<(), GenerateError> {
    let needed = BYTES_PER_PRIMITIVE * primitives as u64;
    if needed > free { Err(GenerateError::Memory { primitives, needed, free }) } else { Ok(()) }
}

/// Returns the free memory in bytes, or `u64::MAX` if it is not known.
fn free_memory() -> u64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let kilobytes = |name: &str| -> Option<u64> {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    kilobytes("MemAvailable:").map_or(u64::MAX, |free| (free + kilobytes("SwapFree:").unwrap_or(0)) << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_primitives_as_ids_and_no_more() {
        assert!(!matches!(capacity(1 << 30), Err(GenerateError::Build(_))));
        assert_eq!(capacity((1 << 30) + 1), Err(BuildError::TooMany { len: (1 << 30) + 1 }.into()));
        let most = u128::from(u32::MAX);
        assert_eq!(capacity(3 * most * most * most), Err(BuildError::TooMany { len: usize::MAX }.into()));
    }

    #[test]
    fn a_scene_that_does_not_fit_into_memory_is_refused_before_it_is_made() {
        assert_eq!(check_memory(1000, 64_000), Ok(()));
        let error = check_memory(755_040_960, 14 << 30).unwrap_err();
        assert_eq!(error.to_string(), "755040960 primitives need about 46084 MB of memory, and 14336 MB are free");
    }
}
