use crate::PrimitiveId;

/// Why an index or a scene cannot be built. Queries never fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A coordinate is NaN or infinite.
    #[error("primitive {id} has a coordinate that is not finite")]
    NonFinite {
        /// The first such primitive.
        id: PrimitiveId,
    },
    /// A primitive names a position that does not exist.
    #[error("primitive {id} uses position {index}, but there are {len}")]
    IndexOutOfRange {
        /// The primitive.
        id: PrimitiveId,
        /// The position it names, from 0.
        index: u32,
        /// How many positions there are.
        len: usize,
    },
    /// More primitives than ids, of which there are 2^30.
    #[error("{len} primitives are more than the {} that an id can name", crate::PrimitiveId::MAX_COUNT)]
    TooMany {
        /// How many there are, or were when counting stopped.
        len: usize,
    },
    /// An index is to be fitted to a set of another size.
    #[error("{len} primitives, but the index was built over {expected}")]
    OtherLength {
        /// How many there are.
        len: usize,
        /// How many there were.
        expected: usize,
    },
}
