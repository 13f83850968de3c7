//! Scenes of triangles, segments and points, with their readers, writers, generators and statistics.
//!
//! - **Scenes**: [`read_scene`] reads files of every [`Format`] into a [`Scene`], and [`write_scene`] writes them.
//!   [`Scene::add`] and similar methods build a scene from named parts. [`Scene::skipped`] lists the data of a file
//!   that the reader left out. [`read_scene_in_pieces`] reads files larger than the memory.
//! - **Queries**: [`read_points`] and [`read_rays`] read query points and rays from XYZ, CSV, NPY and PLY files.
//! - **Generators**: [`generate`] makes scenes that are the same on every platform.
//! - **Statistics**: [`statistics`] describes a scene.
//!
//! A [`ReadError`] has the file, the location in it and the reason.
//!
//! The feature `mint` lets [`Scene::add_points`] and similar methods take positions of the crate mint.
//!
//! ```
//! use p2m_core::{BruteForce, ClosestPoint};
//! use nalgebra::Point3;
//!
//! let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 5\nf 1 2 3 4\nl 1 5 # a pole\n";
//! let scene = p2m_mixed::read_obj(text.as_bytes(), "court.obj")?;
//! assert_eq!((scene.soup.triangles().len(), scene.soup.segments().len()), (2, 1));
//! assert_eq!(scene.sources, [0, 0, 0]); // both triangles come from the first face, the segment from the first line
//!
//! let index = BruteForce::new(&scene.soup).unwrap();
//! assert_eq!(index.closest_point(&Point3::new(0.0, -1.0, 4.0)).unwrap().primitive.index(), 2);
//! # Ok::<(), p2m_mixed::ReadError>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod assemble;
mod builder;
mod error;
mod formats;
pub mod generate;
mod open;
mod output_file;
mod parse;
mod pieces;
mod points;
mod polygon;
mod read;
mod scene;
pub mod statistics;
mod unit;
mod write;

pub use error::{FileLocation, HeaderProblem, ReadError, Reason};
pub use formats::obj::{read_obj, write_obj};
pub use formats::off::{read_off, write_off};
pub use formats::p2m::{load_scene, read_p2m, save_scene, write_p2m};
pub use formats::ply::{VertexValues, read_ply, write_ply, write_ply_ascii, write_ply_with_values};
pub use formats::stl::{StlRounding, read_stl, stl_rounding, write_stl};
pub use formats::{Format, write_scene};
pub use p2m_core::{UnknownExtension, UnknownFormat};
pub use parse::text::set_max_line_bytes;
pub use pieces::{PieceOptions, PieceSummary, read_scene_in_pieces};
pub use points::{
    PointColumns, PointFormat, PointIds, PointTable, read_point_table, read_point_table_from, read_points,
    read_points_from, read_rays, read_rays_from,
};
pub use polygon::MAX_CORNERS;
pub use read::{read_scene, read_scene_from};
pub use scene::{Object, Scene, Skipped};
pub use unit::Unit;
pub use write::WriteError;

/// The parts of this crate that its sibling crates use. They are not part of the public interface.
#[doc(hidden)]
pub mod engine {
    pub use crate::builder::SceneBuilder;
    pub use crate::open::open;
    pub use crate::output_file::OutputFile;
    pub use crate::parse::bytes::Scalar;
    pub use crate::read::read_scene_in_blocks;
    pub use crate::scene::object_number;
}
