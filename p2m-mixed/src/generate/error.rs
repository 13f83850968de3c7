//! Why a scene cannot be made, and the checks that say so before anything is allocated.

use p2m_core::{BuildError, PrimitiveId};

/// Why a scene cannot be made or changed.
///
/// ```
/// use p2m_mixed::generate::{GenerateError, TorusKnot, torus_knot};
///
/// let error = torus_knot(&TorusKnot::default().with_rings(2)).unwrap_err();
/// assert_eq!(error, GenerateError::TooFew { option: "rings", value: 2, least: 3 });
/// assert_eq!(error.to_string(), "rings is 2, but must be at least 3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// An option that counts something is too small for the scene to exist.
    #[error("{option} is {value}, but must be at least {least}")]
    TooFew {
        /// The field of the options.
        option: &'static str,
        /// Its value.
        value: u32,
        /// The least that makes sense.
        least: u32,
    },
    /// A number is not in its range, or not a number.
    #[error("{option} is {value}, but must be {range}")]
    OutOfRange {
        /// The field of the options or the argument.
        option: &'static str,
        /// Its value.
        value: f64,
        /// The range in words.
        range: &'static str,
    },
    /// The windings of a torus knot have a common divisor: the curve would run over itself.
    #[error("p = {p} and q = {q} must have no common divisor")]
    CommonDivisor {
        /// Turns around the axis of the torus.
        p: u32,
        /// Turns around its tube.
        q: u32,
    },
    /// The scene is no valid soup: there are more primitives than ids, or a coordinate overflows.
    #[error(transparent)]
    Build(#[from] BuildError),
}

pub(super) fn at_least(least: u32, option: &'static str, value: u32) -> Result<(), GenerateError> {
    if value < least { Err(GenerateError::TooFew { option, value, least }) } else { Ok(()) }
}

/// That many primitives, if there are ids for them. Three numbers of 32 bits can be multiplied
/// without overflow in the argument.
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
