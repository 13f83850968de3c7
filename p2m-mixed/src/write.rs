//! What writers of all formats share.

use p2m_core::PrimitiveId;
use std::io;

/// Reasons why a scene cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The writer returned an error.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A primitive is not a triangle, and STL files have only triangles.
    #[error("primitive {id} is no triangle, and an STL file holds nothing else")]
    NotATriangle {
        /// The first primitive that is not a triangle.
        id: PrimitiveId,
    },
    /// A primitive is not a point, and a table of points has only points.
    #[error("primitive {id} is no point, and a table of points holds nothing else")]
    NotAPoint {
        /// The first primitive that is not a point.
        id: PrimitiveId,
    },
    /// A coordinate is beyond the range of single precision, which STL files have.
    #[error("primitive {id} has a coordinate {coordinate:e}, which is beyond the single precision of an STL file")]
    BeyondSinglePrecision {
        /// The first primitive with such a coordinate.
        id: PrimitiveId,
        /// The coordinate in double precision.
        coordinate: f64,
    },
    /// The scene has more triangles than the 2^32 - 1 that an STL file can have.
    #[error("{count} triangles are more than an STL file can hold")]
    TooMany {
        /// The number of triangles.
        count: usize,
    },
}

/// Returns the position that text files have: one that is not finite becomes the origin. No primitive uses
/// such a position.
pub(crate) fn finite_or_origin(position: &nalgebra::Point3<f64>) -> nalgebra::Point3<f64> {
    if position.iter().all(|x| x.is_finite()) { *position } else { nalgebra::Point3::origin() }
}
