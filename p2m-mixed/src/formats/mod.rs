//! The formats of scenes: a module for each, and their table.
//!
//! The module of a format has two functions, which the table calls. `read` reads a file into a builder, and returns the
//! scene or its last piece. `write` writes a scene.

mod cloud;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod p2m;
pub(crate) mod ply;
pub(crate) mod stl;

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::{ReadError, Scene, WriteError};
use std::io::{BufRead, Write};

/// Generates [`Format`] from a table. A row has the names of a format, which are also the extensions of its files, its
/// reader, its writer, and whether its files preserve every scene.
macro_rules! scene_formats {
    ($(
        $(#[$doc:meta])*
        $variant:ident = $name:literal $(| $other:literal)*,
        $read:path, $write:path, is_lossless: $is_lossless:literal;
    )*) => {
        p2m_core::formats! {
            /// The file formats of scenes, all of which can be read and written.
            ///
            /// ```
            /// use p2m_mixed::Format;
            ///
            /// assert_eq!("STL".parse(), Ok(Format::Stl));
            /// assert_eq!(Format::from_path("a/b.off".as_ref()).unwrap().to_string(), "off");
            /// let error = "step".parse::<Format>().unwrap_err();
            /// assert!(error.to_string().starts_with("unknown format 'step', expected one of obj, ply"));
            /// ```
            Format { $($(#[$doc])* $variant = $name $(| $other)*,)* }
        }

        impl Format {
            /// Returns whether files of this format preserve every scene: primitives of all kinds, and positions bit
            /// for bit.
            #[must_use]
            pub fn is_lossless(self) -> bool {
                match self {
                    $(Self::$variant => $is_lossless,)*
                }
            }

            pub(crate) fn read(
                self,
                source: Source<impl BufRead>,
                name: &str,
                builder: SceneBuilder<'_>,
            ) -> Result<Scene, ReadError> {
                match self {
                    $(Self::$variant => $read(source, name, builder),)*
                }
            }

            fn write(self, scene: &Scene, writer: impl Write) -> Result<(), WriteError> {
                match self {
                    $(Self::$variant => $write(scene, writer),)*
                }
            }
        }
    };
}

scene_formats! {
    /// Wavefront OBJ, a text format: see [`read_obj`](crate::read_obj) and [`write_obj`](crate::write_obj).
    Obj = "obj", obj::read, obj::write, is_lossless: true;
    /// The Stanford polygon format: see [`read_ply`](crate::read_ply) and [`write_ply`](crate::write_ply).
    Ply = "ply", ply::read, ply::write, is_lossless: true;
    /// Stereolithography files, which have triangles in single precision: see [`read_stl`](crate::read_stl) and
    /// [`write_stl`](crate::write_stl).
    Stl = "stl", stl::read, stl::write, is_lossless: false;
    /// The object file format of Geomview: see [`read_off`](crate::read_off) and [`write_off`](crate::write_off).
    Off = "off", off::read, off::write, is_lossless: true;
    /// Text tables of points with columns separated by blanks: see [`read_points`](crate::read_points).
    Xyz = "xyz" | "txt" | "asc" | "pts", cloud::read_table, cloud::write_xyz, is_lossless: false;
    /// Text tables of points with columns separated by commas: see [`read_points`](crate::read_points).
    Csv = "csv", cloud::read_table, cloud::write_csv, is_lossless: false;
    /// NumPy arrays of points: see [`read_points`](crate::read_points).
    Npy = "npy", cloud::read_npy, cloud::write_npy, is_lossless: false;
    /// Saved indexes that include a scene: see [`read_p2m`](crate::read_p2m) and [`write_p2m`](crate::write_p2m).
    P2m = "p2m", p2m::read, p2m::write, is_lossless: true;
}

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
/// [`WriteError`] for scenes that STL or a table of points cannot represent, before anything is written, and for errors of
/// `writer`, after which the file may be incomplete.
pub fn write_scene(scene: &Scene, format: Format, writer: impl Write) -> Result<(), WriteError> {
    format.write(scene, writer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PointFormat;
    use std::path::Path;

    #[test]
    fn names_and_extensions_in_any_case() {
        for (name, format) in [("obj", Format::Obj), ("Ply", Format::Ply), ("STL", Format::Stl), ("oFF", Format::Off)] {
            assert_eq!(name.parse(), Ok(format));
            assert_eq!(Format::from_path(Path::new(&format!("a.b.{name}"))).unwrap(), format);
            assert_eq!(format.to_string(), name.to_lowercase());
        }
        assert_eq!("txt".parse(), Ok(PointFormat::Xyz));
        assert_eq!("npy".parse(), Ok(PointFormat::Npy));
        assert!("".parse::<Format>().is_err() && ".stl".parse::<Format>().is_err());
        let error = PointFormat::from_path(Path::new("q.las")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "q.las: unknown extension 'las', expected one of xyz, txt, asc, pts, csv, npy, ply"
        );
        assert!(PointFormat::from_path(Path::new("csv")).is_err(), "a name is no extension");
    }
}
