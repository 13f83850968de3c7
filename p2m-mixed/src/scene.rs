//! Scenes as they come from files.

use crate::polygon::Triangulator;
use crate::text::quote;
use crate::{Place, ReadError, Reason, read_obj, read_ply};
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use std::fmt;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// A scene and what its file says beyond it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The primitives, numbered in the order of the file. Polygons are cut into triangles: those of one polygon have
    /// consecutive ids and its winding.
    pub soup: Soup<f64>,
    /// Where each primitive comes from: `sources[id]` is the number of its statement among those of the same kind, from
    /// 0, in the order of the file. Kinds are counted apart.
    ///
    /// In an OBJ file a triangle counts `f` statements, a segment `l` statements, a point `p` statements. In a PLY file a
    /// triangle counts the elements `face`, a segment the elements `edge`; a file that has both `face` and `tristrips`
    /// goes on with the strips after the last face. In a point cloud (vertices alone, in either format) it is the number
    /// of the vertex.
    pub sources: Vec<u32>,
    /// What the reader recognised as no part of the geometry and left out, in the order of first appearance.
    pub skipped: Vec<Skipped>,
}

/// Something in a file that is no part of the scene. It displays as a list may show it: `2 x usemtl`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// What it is: the keyword of an OBJ statement, an element or a property of a PLY file, `bytes after the last element`
    /// (`words` in a text) of a PLY file, or `vertices that are not finite` in a point cloud.
    pub what: String,
    /// How often it occurs, or how many of them there are.
    pub count: u64,
    /// Whether `what` is a plural to put behind the count, rather than a name.
    is_plural: bool,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}{}", self.count, if self.is_plural { "" } else { "x " }, self.what)
    }
}

/// Kinds of skipped things that are counted one by one. A file of noise has more: they share one count.
const MAX_KINDS: usize = 64;

/// Counts what is skipped.
#[derive(Default)]
pub(crate) struct Skips {
    /// The same thing is often skipped many times in a row: the last one is tried first.
    last: usize,
    keys: Vec<Vec<u8>>,
    list: Vec<Skipped>,
    others: u64,
}

impl Skips {
    /// Adds to the count of a name; nothing if `count` is 0.
    pub(crate) fn add(&mut self, key: &[u8], count: u64) {
        if count == 0 {
            return;
        }
        if self.keys.get(self.last).is_none_or(|k| k != key) {
            match self.keys.iter().position(|k| k == key) {
                Some(at) => self.last = at,
                None if self.keys.len() < MAX_KINDS => {
                    self.last = self.keys.len();
                    self.keys.push(key.to_vec());
                    self.list.push(Skipped { what: quote(key), count: 0, is_plural: false });
                }
                None => {
                    self.others += count;
                    return;
                }
            }
        }
        self.list[self.last].count += count;
    }

    /// Adds so many of what `what` is the plural of, unless there are none.
    pub(crate) fn add_many(&mut self, count: u64, what: &str) {
        if count > 0 {
            self.keys.push(what.as_bytes().to_vec());
            self.list.push(Skipped { what: what.to_owned(), count, is_plural: true });
        }
    }

    fn finish(mut self) -> Vec<Skipped> {
        let others = self.others;
        self.add_many(others, "other statements");
        self.list
    }
}

/// A scene under construction; whoever adds to it has checked indices, and that what they name is finite.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) positions: Vec<Point3<f64>>,
    pub(crate) skips: Skips,
    elements: Vec<Element>,
    sources: Vec<u32>,
    corners: Vec<Point3<f64>>,
    triangulator: Triangulator,
}

impl Builder {
    pub(crate) fn push(&mut self, element: Element, source: usize) {
        self.elements.push(element);
        // A scene of so many primitives is refused at the end.
        self.sources.push(u32::try_from(source).unwrap_or(u32::MAX));
    }

    /// Adds the triangles of a polygon.
    pub(crate) fn polygon(&mut self, vertices: &[u32], source: usize) {
        if let &[a, b, c] = vertices {
            return self.push(Element::Triangle([a, b, c]), source);
        }
        self.corners.clear();
        self.corners.extend(vertices.iter().map(|&v| self.positions[v as usize]));
        let source = u32::try_from(source).unwrap_or(u32::MAX);
        for triangle in self.triangulator.triangulate(&self.corners) {
            self.elements.push(Element::Triangle(triangle.map(|i| vertices[i as usize])));
            self.sources.push(source);
        }
    }

    /// Whether a vertex may be part of a primitive.
    pub(crate) fn is_finite(&self, vertex: u32) -> bool {
        self.positions[vertex as usize].iter().all(|x| x.is_finite())
    }

    /// Makes every vertex a point, except those that are not finite.
    #[allow(clippy::cast_possible_truncation, reason = "readers refuse vertices beyond the range of u32")]
    pub(crate) fn point_cloud(&mut self) {
        let mut left_out = 0;
        for i in 0..self.positions.len() {
            if self.is_finite(i as u32) {
                self.push(Element::Point(i as u32), i);
            } else {
                left_out += 1;
            }
        }
        self.skips.add_many(left_out, "vertices that are not finite");
    }

    pub(crate) fn finish(self) -> Result<Scene, Reason> {
        let soup = Soup::new(self.positions, self.elements).map_err(Reason::Build)?;
        Ok(Scene { soup, sources: self.sources, skipped: self.skips.finish() })
    }
}

/// The extensions of scene files.
const EXTENSIONS: &[&str] = &["obj", "ply"];

/// Reads a scene, in the format that the extension of its name says: `obj` or `ply`, in any case.
///
/// # Errors
/// [`ReadError`] names file, place and reason. A file is read whole or not at all.
pub fn read_scene(path: &Path) -> Result<Scene, ReadError> {
    let name = path.display().to_string();
    match extension(path).as_str() {
        "obj" => read_obj(open(path, &name)?, &name),
        "ply" => read_ply(open(path, &name)?, &name),
        _ => Err(unknown_extension(path, &name, EXTENSIONS)),
    }
}

pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

pub(crate) fn unknown_extension(path: &Path, name: &str, supported: &'static [&'static str]) -> ReadError {
    let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
    ReadError::new(name, Place::File, Reason::UnknownExtension { extension, supported })
}

pub(crate) fn open(path: &Path, name: &str) -> Result<BufReader<File>, ReadError> {
    let fail = |e| ReadError::new(name, Place::File, Reason::Io(e));
    let file = File::open(path).map_err(fail)?;
    // Some systems open a directory and fail only at its first line.
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(fail(io::ErrorKind::IsADirectory.into()));
    }
    Ok(BufReader::with_capacity(1 << 16, file))
}
