//! Scenes and scans in the formats of other programs: LAS and LAZ, E57, PCD, glTF and GLB, 3MF, GeoJSON, shapefiles.
//!
//! [`read_scene`] reads files in these formats and in those of `p2m-mixed`. Points of a file become points of the
//! scene, lines become segments, and polygons become triangles. Names in the file become names of objects.
//!
//! Coordinates are not converted: [`Scene::unit`] has their unit if the file states it. If a file has two coordinates
//! for each point, z is 0 and [`Scene::is_flat`] is set.
//!
//! [`Scene::sources`] counts the primitives of each kind in the file. In maps, it is the number of the feature or of
//! the record.
//!
//! ```
//! use p2m_formats::{FileFormat, read_scene_from};
//!
//! let file = br#"{"type": "LineString", "coordinates": [[4.0, 52.0], [5.0, 52.0], [5.0, 53.0]]}"#;
//! let scene = read_scene_from(&file[..], "geojson".parse()?, "track.geojson", None)?;
//! assert_eq!((scene.soup.segments().len(), scene.is_flat), (2, true));
//! assert_eq!(scene.unit, Some(p2m_mixed::Unit::Degree));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Memory
//! The file is in memory while it is read. No memory is allocated for what a header only announces, and a scene takes
//! at most 1,000 bytes for each byte of its file, or 64 MiB.
//!
//! # Panics of other crates
//! Most formats are decoded by other crates. A panic in one of them is caught and returned as an error.

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod e57;
mod features;
mod format;
mod geojson;
mod gltf;
mod las;
mod pcd;
mod shapefile;
mod sink;
mod threemf;
mod wkt;

pub use format::{FileFormat, ForeignFormat};

use p2m_mixed::engine::open;
use p2m_mixed::{
    FileLocation, PointColumns, PointFormat, PointTable, ReadError, Reason, Scene, read_point_table_from,
    read_scene_from as read_own_scene_from,
};
use std::io::BufRead;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Reads a scene from a file. Its extension, in any case, selects the format.
///
/// # Errors
/// [`ReadError`] has the file, the location in it and the reason. For many formats that are not read, the error names a
/// program that converts them.
pub fn read_scene(path: &Path) -> Result<Scene, ReadError> {
    let format = FileFormat::from_path(path)?;
    let name = path.display().to_string();
    read_scene_from(open(path, &name)?, format, &name, Some(path))
}

/// Reads a scene from any reader. `name` is the name of the file in messages. `path` is the location of the file, by
/// which its companions are found: the buffers of a glTF file, and the `.prj` file of a shapefile, which has the unit.
///
/// # Errors
/// The errors are those of [`read_scene`].
pub fn read_scene_from(
    reader: impl BufRead,
    format: FileFormat,
    name: &str,
    path: Option<&Path>,
) -> Result<Scene, ReadError> {
    match format {
        FileFormat::Own(format) => read_own_scene_from(reader, format, name),
        FileFormat::Foreign(format) => read_foreign_scene(reader, format, name, path),
    }
}

fn read_foreign_scene(
    mut reader: impl BufRead,
    format: ForeignFormat,
    name: &str,
    path: Option<&Path>,
) -> Result<Scene, ReadError> {
    let mut bytes = Vec::new();
    let fail = |reason| ReadError::new(name, FileLocation::File, reason);
    reader.read_to_end(&mut bytes).map_err(|error| fail(Reason::Io(error)))?;
    let file = File { bytes: &bytes, name, path };
    // A panic leaves no broken state behind, because the scene is dropped.
    catch_unwind(AssertUnwindSafe(|| format.read(&file))).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("of an unknown kind");
        Err(fail(Reason::Format(format!("the reader of the format failed at damaged data: {text}").into())))
    })
}

/// Reads points, with their ids if the file has them, from a file. Its extension, in any case, selects the format.
///
/// # Errors
/// The errors are those of [`read_points_from`].
pub fn read_points(path: &Path, columns: &PointColumns) -> Result<PointTable, ReadError> {
    let format = FileFormat::from_path(path)?;
    let name = path.display().to_string();
    read_points_from(open(path, &name)?, format, &name, Some(path), columns)
}

/// Reads points, with their ids if the file has them, from any reader. If the file is not a table or an array, its
/// vertices are the points.
///
/// # Errors
/// The errors are those of [`read_scene`] and [`read_point_table_from`].
pub fn read_points_from(
    reader: impl BufRead,
    format: FileFormat,
    name: &str,
    path: Option<&Path>,
    columns: &PointColumns,
) -> Result<PointTable, ReadError> {
    if let Ok(format) = format.name().parse::<PointFormat>() {
        return read_point_table_from(reader, format, name, columns);
    }
    let scene = read_scene_from(reader, format, name, path)?;
    let mut table = PointTable::default();
    table.points = scene.soup.positions().to_vec();
    (table.unit, table.is_flat) = (scene.unit, scene.is_flat);
    Ok(table)
}

/// A file in memory.
struct File<'a> {
    bytes: &'a [u8],
    name: &'a str,
    path: Option<&'a Path>,
}

impl File<'_> {
    /// Returns an error without a location of its own, whose text may describe one.
    fn error(&self, text: impl std::fmt::Display) -> ReadError {
        self.error_at(FileLocation::File, text)
    }

    fn error_at(&self, location: FileLocation, text: impl std::fmt::Display) -> ReadError {
        ReadError::new(self.name, location, Reason::Format(text.to_string().into()))
    }

    /// Returns the bytes of a range, or an error located at the early end of the file.
    fn slice(&self, start: usize, len: usize) -> Result<&[u8], ReadError> {
        let end = start.checked_add(len).filter(|end| *end <= self.bytes.len());
        let early = || ReadError::new(self.name, FileLocation::Byte(self.bytes.len() as u64), Reason::UnexpectedEnd);
        end.map(|end| &self.bytes[start..end]).ok_or_else(early)
    }

    /// Returns the `N` bytes from `start`, such as those of a number.
    fn array<const N: usize>(&self, start: usize) -> Result<[u8; N], ReadError> {
        Ok(self.slice(start, N)?.try_into().expect("the slice has N bytes"))
    }
}
