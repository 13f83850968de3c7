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
    /// The scene is not a valid soup, because it has more primitives than ids or a coordinate overflows.
    #[error(transparent)]
    Build(#[from] BuildError),
}

pub(super) fn at_least(least: u32, option: &'static str, value: u32) -> Result<(), GenerateError> {
    if value < least { Err(GenerateError::TooFew { option, value, least }) } else { Ok(()) }
}

/// Returns the number of primitives, or an error if there are not enough ids. The argument has room for the product of
/// three numbers of 32 bits.
pub(super) fn capacity(primitives: u128) -> Result<usize, BuildError> {
    let len = usize::try_from(primitives).unwrap_or(usize::MAX);
    if len > PrimitiveId::MAX_COUNT { Err(BuildError::TooMany { len }) } else { Ok(len) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_primitives_as_ids_and_no_more() {
        assert_eq!(capacity(1 << 30), Ok(1 << 30));
        assert_eq!(capacity((1 << 30) + 1), Err(BuildError::TooMany { len: (1 << 30) + 1 }));
        let most = u128::from(u32::MAX);
        assert_eq!(capacity(3 * most * most * most), Err(BuildError::TooMany { len: usize::MAX }));
    }
}
