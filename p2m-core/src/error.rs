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
    #[error("primitive {id} uses position {index}, but {}", describe_positions(*len))]
    IndexOutOfRange {
        /// The id of that primitive.
        id: PrimitiveId,
        /// The index of the position, from 0.
        index: u32,
        /// The number of positions.
        len: usize,
    },
    /// A flat array of coordinates or indices has a length that is not a multiple of three.
    #[error("an array has {len} numbers, but triples need a multiple of three; for points of the plane append z = 0")]
    NotTriples {
        /// The length of the array.
        len: usize,
    },
    /// The new positions are not as many as the old ones.
    #[error("{len} positions, but the scene has {expected}")]
    OtherPositionCount {
        /// The number of new positions.
        len: usize,
        /// The number of positions of the scene.
        expected: usize,
    },
    /// The positions or primitives do not fit into memory.
    #[error("it does not fit into memory")]
    OutOfMemory,
    /// There are more primitives than ids, which are 2^30.
    #[error("{len} primitives are more than the {} that an id can name", crate::PrimitiveId::MAX_COUNT)]
    TooMany {
        /// The number of primitives, or a lower bound on it if counting stopped.
        len: usize,
    },
    /// The set for a refit has another number of primitives.
    #[error("{len} primitives, but the index was built over {expected}")]
    OtherLength {
        /// The number of primitives of that set.
        len: usize,
        /// The number of primitives that the index was built over.
        expected: usize,
    },
}

/// Describes the number of positions for an error message.
fn describe_positions(len: usize) -> String {
    match len {
        0 => "there are no positions".to_owned(),
        1 => "there is only position 0".to_owned(),
        _ => format!("positions are numbered 0 to {}", len - 1),
    }
}
