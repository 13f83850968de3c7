//! Errors of the card.

use cudarc::driver::DriverError;
use cudarc::driver::sys::CUresult;
use p2m_core::PrimitiveId;

/// The error of an index on a card.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CudaError {
    /// No NVIDIA driver is installed.
    #[error("there is no NVIDIA driver (libcuda) on this machine")]
    NoDriver,
    /// The driver has reported an error, for example that there is no card with this number.
    #[error("the CUDA driver failed: {0}")]
    Driver(String),
    /// The memory of the card, or the pinned memory of the processor, is exhausted.
    #[error("the memory of the card does not suffice: {0}")]
    Memory(String),
    /// The scene has no primitives.
    #[error("the scene is empty")]
    Empty,
    /// The scene is too small or too large to be searched in f32.
    #[error("the size of the scene is not within 2^-320..2^300")]
    Scale,
    /// A primitive has no vertices.
    #[error("primitive {id} has no vertices")]
    NoVertices {
        /// The id of the primitive.
        id: PrimitiveId,
    },
    /// The tree is too deep for the stacks of the kernels.
    #[error("the tree has {depth} levels, which are too many for a card")]
    TooDeep {
        /// The number of levels.
        depth: usize,
    },
    /// A checked answer differs from the answer of the processor.
    #[error("the card has answered query {query} with other bits than the processor")]
    Unequal {
        /// The number of the query.
        query: usize,
    },
    /// The scene has more parts, such as vertices, than 32-bit numbers can count.
    #[error("{count} are too many for numbers of 32 bits")]
    TooMany {
        /// The number of parts.
        count: usize,
    },
}

impl From<DriverError> for CudaError {
    fn from(error: DriverError) -> Self {
        match error.0 {
            CUresult::CUDA_ERROR_OUT_OF_MEMORY => Self::Memory(error.to_string()),
            _ => Self::Driver(error.to_string()),
        }
    }
}
