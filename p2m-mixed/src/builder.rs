//! The scene that a reader builds, statement by statement.

use crate::Reason;
use crate::polygon::{CHECK_REPEATS_ABOVE_CORNERS, MAX_CORNER_SQUARES, Triangulator};
use crate::scene::{Object, Scene, Skipped};
use crate::text::{quote, trim};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveSet, Soup};

/// The largest number of kinds of skipped records with a count of their own. Further kinds, as a file of noise has
/// them, share one count.
const MAX_SKIPPED_KINDS: usize = 64;

/// Counts the records of a file that a reader skips, by kind.
#[derive(Default)]
pub(crate) struct SkippedRecords {
    /// The index of the kind that was counted last. It is tried first, because records of a kind often come in a row.
    last: usize,
    keys: Vec<Vec<u8>>,
    list: Vec<Skipped>,
    others: u64,
}

impl SkippedRecords {
    /// Adds to the count of the kind with this name. A count of 0 adds no kind.
    pub(crate) fn add(&mut self, key: &[u8], count: u64) {
        if count == 0 {
            return;
        }
        if self.keys.get(self.last).is_none_or(|k| k != key) {
            match self.keys.iter().position(|k| k == key) {
                Some(at) => self.last = at,
                None if self.keys.len() < MAX_SKIPPED_KINDS => {
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

    /// Adds a kind that is described by a plural. A count of 0 adds no kind.
    pub(crate) fn add_plural(&mut self, count: u64, what: &str) {
        if count > 0 {
            self.keys.push(what.as_bytes().to_vec());
            self.list.push(Skipped { what: what.to_owned(), count, is_plural: true });
        }
    }

    /// Removes the kind with this name.
    pub(crate) fn remove(&mut self, key: &[u8]) {
        if let Some(at) = self.keys.iter().position(|k| k == key) {
            self.keys.remove(at);
            self.list.remove(at);
            self.last = 0;
        }
    }

    fn finish(mut self) -> Vec<Skipped> {
        let others = self.others;
        self.add_plural(others, "other statements");
        self.list
    }
}

/// Collects runs of primitives under one name. A name takes memory only if a run of primitives starts with it.
#[derive(Default)]
struct ObjectRuns {
    list: Vec<Object>,
    /// The current name, in the bytes of the file.
    name: Vec<u8>,
    /// The first id under the current name.
    start: usize,
}

impl ObjectRuns {
    /// Starts a run with this name at id `next`.
    fn start(&mut self, name: &[u8], next: usize) {
        self.end(next);
        self.name.clear();
        self.name.extend_from_slice(name);
    }

    fn end(&mut self, next: usize) {
        if self.start < next && !self.name.is_empty() {
            let name = String::from_utf8_lossy(&self.name);
            match self.list.last_mut() {
                Some(last) if last.ids.end == self.start && last.name == name => last.ids.end = next,
                _ => self.list.push(Object { name: name.into_owned(), ids: self.start..next }),
            }
        }
        self.start = next;
    }
}

/// Builds a scene. Callers have to check that indices are in range and that the vertices of primitives are finite.
#[derive(Default)]
pub(crate) struct SceneBuilder {
    pub(crate) skipped: SkippedRecords,
    soup: Soup<f64>,
    sources: Vec<u32>,
    objects: ObjectRuns,
    corners: Vec<Point3<f64>>,
    triangulator: Triangulator,
    /// The sum of the squares of the numbers of vertices of large polygons so far.
    corner_squares: u64,
}

impl SceneBuilder {
    pub(crate) fn positions(&self) -> &[Point3<f64>] {
        self.soup.positions()
    }

    /// Adds a vertex and returns its index.
    ///
    /// # Errors
    /// [`Reason::ElementTooLarge`] if u32 cannot number it.
    pub(crate) fn push_vertex(&mut self, position: Point3<f64>) -> Result<u32, Reason> {
        let count = self.positions().len() as u64;
        let vertex = u32::try_from(count).ok().filter(|&vertex| vertex < u32::MAX);
        let vertex = vertex.ok_or(Reason::ElementTooLarge { count: count + 1, limit: u64::from(u32::MAX) })?;
        self.soup.push_position(position);
        Ok(vertex)
    }

    pub(crate) fn push(&mut self, element: Element, source: usize) -> Result<(), Reason> {
        self.soup.push(element).map_err(Reason::Build)?;
        // `u32::MAX` stands for sources that u32 cannot number. A file with so many has too many primitives anyway.
        self.sources.push(u32::try_from(source).unwrap_or(u32::MAX));
        Ok(())
    }

    /// Adds the triangles that a polygon is divided into.
    pub(crate) fn push_polygon(&mut self, vertices: &[u32], source: usize) -> Result<(), Reason> {
        if let &[a, b, c] = vertices {
            return self.push(Element::Triangle([a, b, c]), source);
        }
        if vertices.len() > CHECK_REPEATS_ABOVE_CORNERS {
            self.corner_squares += (vertices.len() as u64).pow(2);
            if self.corner_squares > MAX_CORNER_SQUARES {
                return Err(Reason::PolygonsTooLarge { limit: MAX_CORNER_SQUARES });
            }
        }
        self.corners.clear();
        self.corners.extend(vertices.iter().map(|&v| self.soup.positions()[v as usize]));
        let source = u32::try_from(source).unwrap_or(u32::MAX);
        for triangle in self.triangulator.triangulate(&self.corners) {
            self.soup.push(Element::Triangle(triangle.map(|i| vertices[i as usize]))).map_err(Reason::Build)?;
            self.sources.push(source);
        }
        Ok(())
    }

    /// Returns whether the coordinates of a vertex are finite, so that it may be part of a primitive.
    pub(crate) fn is_finite(&self, vertex: u32) -> bool {
        self.positions()[vertex as usize].iter().all(|x| x.is_finite())
    }

    /// Starts an object with this name. Primitives under an empty name belong to no object.
    pub(crate) fn start_object(&mut self, name: &[u8]) {
        self.objects.start(trim(name), self.soup.len());
    }

    /// Removes all objects.
    pub(crate) fn clear_objects(&mut self) {
        self.objects = ObjectRuns { start: self.soup.len(), ..ObjectRuns::default() };
    }

    /// Adds a point for every vertex with finite coordinates.
    #[allow(clippy::cast_possible_truncation, reason = "there are no more vertices than u32 can count")]
    pub(crate) fn push_point_cloud(&mut self) -> Result<(), Reason> {
        let mut left_out = 0;
        for i in 0..self.positions().len() {
            if self.is_finite(i as u32) {
                self.push(Element::Point(i as u32), i)?;
            } else {
                left_out += 1;
            }
        }
        self.skipped.add_plural(left_out, "vertices that are not finite");
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Scene {
        // The scene does not grow any more.
        self.soup.shrink_to_fit();
        self.sources.shrink_to_fit();
        self.objects.end(self.soup.len());
        let Self { soup, sources, skipped, objects, .. } = self;
        Scene { soup, sources, objects: objects.list, skipped: skipped.finish() }
    }
}
