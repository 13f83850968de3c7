//! Errors of changing a scene of instances.

use crate::id::InstanceId;
use p2m_core::PrimitiveId;

/// An error of changing a scene of instances, which is left as it was. Queries never fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InstanceError {
    /// The rotation or the translation is not finite, or the rotation is the zero quaternion.
    #[error("the motion is not finite")]
    NonFiniteMotion,
    /// The motion moves the object out of the range of f64, or so near its ends that boxes overflow.
    #[error("the motion moves the object beyond the range of f64")]
    OutOfRange,
    /// A primitive of the object has no [`vertices`](p2m_core::Primitive::vertices) that could be moved.
    #[error("primitive {id} is no point, segment or triangle of known vertices")]
    NoVertices {
        /// The first such primitive of the object.
        id: PrimitiveId,
    },
    /// The scene has no such instance, perhaps because it was removed.
    #[error("the scene has no instance {id}")]
    Unknown {
        /// The id of the instance.
        id: InstanceId,
    },
    /// All instances together would have more primitives than the 2^30 that have ids.
    #[error("{len} primitives are more than the {} that an id can name", PrimitiveId::MAX_COUNT)]
    TooMany {
        /// The number of primitives of all instances.
        len: usize,
    },
}
