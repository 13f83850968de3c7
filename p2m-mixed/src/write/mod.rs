//! Writers of scenes.

mod error;
mod obj;
mod off;
mod ply;
mod stl;

pub use error::WriteError;
pub use obj::write_obj;
pub use off::write_off;
pub use ply::{VertexValues, write_ply, write_ply_ascii, write_ply_with_values};
pub use stl::{StlRounding, stl_rounding, write_stl};

use crate::{Format, Scene};
use std::io::Write;

/// Writes a scene. Every number is written at once, so `writer` should have a buffer.
///
/// A file in [`Obj`](Format::Obj), [`Ply`](Format::Ply) or [`Off`](Format::Off) reads back as the same scene, with the
/// same positions bit by bit and the same primitives with the same ids. [`Stl`](Format::Stl) files have triangles in
/// single precision without shared vertices, see [`write_stl`]. [`P2m`](Format::P2m) files keep everything. The other
/// formats keep:
///
/// | | OBJ | PLY | OFF | STL |
/// |---|---|---|---|---|
/// | [`Scene::objects`] | kept | lost | lost | lost |
/// | positions of a scene without primitives | lost | kept | lost | lost |
/// | positions that no primitive uses | kept | kept | kept | lost |
/// | of those, such that are not finite | are the origin | kept | are the origin | lost |
/// | polygons ([`Scene::sources`]) | triangles | triangles | triangles | triangles |
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
/// [`WriteError`] for scenes that STL cannot represent, before anything is written, and for errors of `writer`, after
/// which the file may be incomplete.
pub fn write_scene(scene: &Scene, format: Format, writer: impl Write) -> Result<(), WriteError> {
    match format {
        Format::Obj => write_obj(scene, writer),
        Format::Ply => write_ply(scene, writer),
        Format::Stl => write_stl(scene, writer),
        Format::Off => write_off(scene, writer),
        Format::P2m => Ok(crate::write_p2m(scene, writer)?),
    }
}
