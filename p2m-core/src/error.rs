//! Errors of building an index or a scene.

use crate::PrimitiveId;

/// An error of building an index or a scene. Queries never fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A coordinate is NaN or infinite.
    #[error("primitive {id} has a coordinate that is not finite")]
    NonFinite {
        /// The first such primitive.
        id: PrimitiveId,
    },
    /// A primitive refers to a position that does not exist.
    #[error("primitive {id} uses position {index}, but there are {len}")]
    IndexOutOfRange {
        /// The id of that primitive.
        id: PrimitiveId,
        /// The index of the position, from 0.
        index: u32,
        /// The number of positions.
        len: usize,
    },
    /// There are more primitives than the 2^30 that have ids.
    #[error("{len} primitives are more than the {} that an id can name", crate::PrimitiveId::MAX_COUNT)]
    TooMany {
        /// The number of primitives, or a lower bound on it where counting stopped.
        len: usize,
    },
    /// An index should be refitted to a set of another size.
    #[error("{len} primitives, but the index was built over {expected}")]
    OtherLength {
        /// The number of primitives of that set.
        len: usize,
        /// The number of primitives that the index was built over.
        expected: usize,
    },
}
