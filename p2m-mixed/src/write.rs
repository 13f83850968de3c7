//! Writing a scene in any format.

use crate::{Format, Scene};
use p2m_core::PrimitiveId;
use std::io::{self, Write};

/// Writes a scene. Every number is written at once, so `writer` should have a buffer.
///
/// A file of a [lossless](Format::is_lossless) format reads back as the same scene, with the same positions bit by bit
/// and the same primitives with the same ids; objects and polygons ([`Scene::sources`]) may be lost. What each format
/// keeps is described at its function, such as [`write_obj`](crate::write_obj).
///
/// ```
/// use p2m_mixed::{Format, read_obj, read_scene_from, write_scene};
///
/// let scene = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\np 3\n".as_bytes(), "scene.obj").unwrap();
/// let mut file = Vec::new();
/// write_scene(&scene, Format::Ply, &mut file).unwrap();
/// assert_eq!(read_scene_from(&file[..], Format::Ply, "scene.ply").unwrap().soup, scene.soup);
/// ```
///
/// # Errors
/// [`WriteError`] for scenes that STL or a table of points cannot represent, before anything is written, and for errors of `writer`, after
/// which the file may be incomplete.
pub fn write_scene(scene: &Scene, format: Format, writer: impl Write) -> Result<(), WriteError> {
    format.write(scene, writer)
}

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
