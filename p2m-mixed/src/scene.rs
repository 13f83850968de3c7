//! Scenes as they come from files.

use crate::polygon::Triangulator;
use crate::text::quote;
use crate::{Place, ReadError, Reason, read_obj, read_ply};
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use std::fs::File;
use std::io::BufReader;
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

/// Something in a file that is no part of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// What it is: the keyword of an OBJ statement, or an element, property or rest of a PLY file.
    pub what: String,
    /// How often it occurs.
    pub count: u64,
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
    pub(crate) fn add(&mut self, key: &[u8], count: u64) {
        if self.keys.get(self.last).is_none_or(|k| k != key) {
            match self.keys.iter().position(|k| k == key) {
                Some(at) => self.last = at,
                None if self.keys.len() < MAX_KINDS => {
                    self.last = self.keys.len();
                    self.keys.push(key.to_vec());
                    self.list.push(Skipped { what: quote(key), count: 0 });
                }
                None => {
                    self.others += count;
                    return;
                }
            }
        }
        self.list[self.last].count += count;
    }

    fn finish(mut self) -> Vec<Skipped> {
        if self.others > 0 {
            self.list.push(Skipped { what: "other statements".to_owned(), count: self.others });
        }
        self.list
    }
}

/// A scene under construction; whoever adds to it has checked indices and coordinates.
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

    /// Makes every vertex a point.
    #[allow(clippy::cast_possible_truncation, reason = "readers refuse vertices beyond the range of u32")]
    pub(crate) fn point_cloud(&mut self) {
        for i in 0..self.positions.len() {
            self.push(Element::Point(i as u32), i);
        }
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
    let file = File::open(path).map_err(|e| ReadError::new(name, Place::File, Reason::Io(e)))?;
    Ok(BufReader::with_capacity(1 << 16, file))
}
