//! Scenes as they come from files.

use crate::{FileLocation, Format, ReadError, Reason, read_obj, read_off, read_p2m, read_ply, read_stl};
use p2m_core::{Element, PrimitiveId, Soup};
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::Path;

/// A scene: from a file, with what that says beyond it, or of parts that are [added](Scene::add).
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The primitives, numbered in the order of the file. Polygons are cut into triangles: those of one polygon have
    /// consecutive ids and its winding. In f64, as coordinates are in files; for an f32 scene make a `Soup<f32>` of the
    /// positions, rounded, and the elements.
    pub soup: Soup<f64>,
    /// Where each primitive comes from: `sources[id]` is the number of its statement among those of the same kind,
    /// from 0, in the order of the file. Kinds are counted apart.
    ///
    /// In an OBJ file a triangle counts `f` statements, a segment `l` statements, a point `p` statements. In a PLY
    /// file a triangle counts the elements `face`, a segment the elements `edge`, a point the elements `point`; a
    /// file that has both `face` and `tristrips` goes on with the strips after the last face. In STL files facets
    /// are counted, in OFF files faces of any number of vertices. In a point cloud (vertices alone, in any format
    /// that has them) it is the number of the vertex. Of parts that were [added](Scene::add) primitives are counted
    /// from 0 in each.
    pub sources: Vec<u32>,
    /// The named parts of the scene, in ascending order and apart from each other; primitives may be in none.
    ///
    /// Those of an OBJ file are its statements `o` or, if it has none, `g`; those of a text STL file its solids. Other
    /// formats have none, and neither has a point cloud. What has no name or no primitives is left out.
    pub objects: Vec<Object>,
    /// What the reader recognised as no part of the geometry and left out, in the order of first appearance.
    pub skipped: Vec<Skipped>,
}

/// A scene made from nothing: each primitive is a statement of its own.
impl From<Soup<f64>> for Scene {
    fn from(soup: Soup<f64>) -> Self {
        let mut counts = [0; 3];
        let next = |element: Element| {
            let count = &mut counts[element.indices().len() - 1];
            *count += 1;
            *count - 1
        };
        let sources = soup.elements().map(next).collect();
        Self { soup, sources, objects: Vec::new(), skipped: Vec::new() }
    }
}

/// Consecutive primitives under one name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Object {
    /// The name as it stands in the file, without blanks around it. A file may use a name again, further down.
    ///
    /// What is not UTF-8 is replaced by U+FFFD. Names are those of the file's author: whoever shows them should expect
    /// any characters.
    pub name: String,
    /// The ids of its primitives.
    pub ids: Range<usize>,
}

/// The object that a primitive is in, of those in ascending order.
pub(crate) fn object_of(objects: &[Object], id: PrimitiveId) -> Option<&Object> {
    let next = objects.partition_point(|object| object.ids.start <= id.index());
    objects[..next].last().filter(|object| object.ids.contains(&id.index()))
}

/// Something in a file that is no part of the scene. It displays as a list may show it: `2 x usemtl`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// What it is: the keyword of an OBJ statement, an element or a property of a PLY file, or a plural such as
    /// `bytes after the last element` (`words` in a text), `facets with attribute bytes`, `vertices with further
    /// numbers`, `faces with a colour`, `vertices that are not finite` (of a point cloud).
    pub what: String,
    /// How often it occurs, or how many of them there are.
    pub count: u64,
    /// Whether `what` is a plural to put behind the count, rather than a name.
    pub(crate) is_plural: bool,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}{}", self.count, if self.is_plural { "" } else { "x " }, self.what)
    }
}

/// Reads a scene from a file in the format that its extension says: obj, ply, stl, off or p2m, in any case.
///
/// # Errors
/// [`ReadError`] names file, place and reason. A file is read whole or not at all.
pub fn read_scene(path: &Path) -> Result<Scene, ReadError> {
    let format = Format::from_path(path)?;
    let name = path.display().to_string();
    read_scene_from(open(path, &name)?, format, &name)
}

/// Reads a scene from whatever can be read, such as the standard input; `name` is for messages.
///
/// The file is read once from its beginning to its end. While it is, at most three times the memory of the finished
/// scene is needed, whatever the file announces, besides small buffers and the longest line of a text.
///
/// ```
/// use p2m_mixed::{Format, read_scene_from};
///
/// let scene = read_scene_from("OFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".as_bytes(), Format::Off, "standard input")?;
/// assert_eq!(scene.soup.triangles(), [[0, 1, 2]]);
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
///
/// # Errors
/// As [`read_scene`].
pub fn read_scene_from(reader: impl BufRead, format: Format, name: &str) -> Result<Scene, ReadError> {
    match format {
        Format::Obj => read_obj(reader, name),
        Format::Ply => read_ply(reader, name),
        Format::Stl => read_stl(reader, name),
        Format::Off => read_off(reader, name),
        Format::P2m => read_p2m(reader, name),
    }
}

pub(crate) fn open(path: &Path, name: &str) -> Result<BufReader<File>, ReadError> {
    let fail = |e| ReadError::new(name, FileLocation::File, Reason::Io(e));
    let file = File::open(path).map_err(fail)?;
    // Some systems open a directory and fail only at its first line.
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(fail(io::ErrorKind::IsADirectory.into()));
    }
    Ok(BufReader::with_capacity(1 << 16, file))
}
