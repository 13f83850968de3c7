//! The scene that a reader builds, statement by statement.

use crate::parse::text::{quote, trim};
use crate::pieces::state::Pieces;
use crate::polygon::{CHECK_REPEATS_ABOVE_CORNERS, MAX_CORNER_SQUARES, Triangulator};
use crate::scene::{Object, Scene, Skipped};
use crate::{Reason, Unit};
use memchr::memchr2;
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveSet, Soup};
use std::fs::File;
use std::io::BufReader;
use std::mem::take;
use std::sync::Arc;

/// The most kinds of skipped records that are counted separately. All further kinds share one count, because a file of
/// noise may have any number of them.
const MAX_SKIPPED_KINDS: usize = 64;

/// Counts the records of a file that a reader skips, by kind.
#[derive(Default)]
pub struct SkippedRecords {
    /// The index of the kind that was counted last. It is tried first, because records of a kind often come in a row.
    last: usize,
    keys: Vec<Vec<u8>>,
    list: Vec<Skipped>,
    others: u64,
}

impl SkippedRecords {
    /// Adds to the count of the kind with this name. A count of 0 adds no kind.
    pub fn add(&mut self, key: &[u8], count: u64) {
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
    pub fn add_plural(&mut self, count: u64, what: &str) {
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

/// The objects so far, as runs of consecutive primitives under one name. A name takes memory only if a primitive
/// follows it.
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

    /// Returns the objects of a piece that ends at id `next`. The next piece starts at id 0 under the current name.
    fn end_piece(&mut self, next: usize) -> Vec<Object> {
        self.end(next);
        self.start = 0;
        take(&mut self.list)
    }
}

/// The primitives so far, of the whole scene or of the current piece.
#[derive(Default)]
struct Output<'a> {
    soup: Soup<f64>,
    sources: Vec<u32>,
    objects: ObjectRuns,
    /// The state of reading in pieces, or `None` if the scene is built as a whole.
    pieces: Option<Box<Pieces<'a>>>,
}

impl Output<'_> {
    /// Adds a primitive whose vertices have the indices of the file.
    #[inline]
    fn push(&mut self, element: Element, source: u32) -> Result<(), Reason> {
        let element = if self.pieces.is_none() { element } else { self.element_of_piece(element)? };
        self.soup.push(element).map_err(Reason::Build)?;
        self.sources.try_reserve(1).map_err(Reason::Memory)?;
        self.sources.push(source);
        Ok(())
    }

    /// Ends the current piece if it is full, and returns a primitive whose vertices have the indices of the piece.
    #[cold]
    fn element_of_piece(&mut self, element: Element) -> Result<Element, Reason> {
        self.end_full_piece()?;
        let Some(pieces) = &mut self.pieces else { return Ok(element) };
        let mut index = |vertex| pieces.index(vertex, &mut self.soup);
        Ok(match element {
            Element::Point(a) => Element::Point(index(a)?),
            Element::Segment([a, b]) => Element::Segment([index(a)?, index(b)?]),
            Element::Triangle([a, b, c]) => Element::Triangle([index(a)?, index(b)?, index(c)?]),
        })
    }

    /// Passes the current piece to the visitor if it is full.
    fn end_full_piece(&mut self) -> Result<(), Reason> {
        match &mut self.pieces {
            Some(pieces) if self.soup.len() >= pieces.max_primitives() => {
                let objects = self.objects.end_piece(self.soup.len());
                let (soup, sources) = (take(&mut self.soup), take(&mut self.sources));
                pieces.visit(Scene { soup: Arc::new(soup), sources, objects, ..Scene::default() })
            }
            _ => Ok(()),
        }
    }

    /// Returns the position of a vertex of the file.
    #[inline]
    fn position(&mut self, vertex: u32) -> Result<Point3<f64>, Reason> {
        match &mut self.pieces {
            None => Ok(self.soup.positions()[vertex as usize]),
            Some(pieces) => pieces.position(vertex),
        }
    }
}

/// Builds a scene, or pieces of a scene. The caller checks that indices are in range and that the vertices of
/// primitives are finite.
#[derive(Default)]
pub struct SceneBuilder<'a> {
    /// The records that are left out.
    pub skipped: SkippedRecords,
    /// The unit of the file.
    pub unit: Option<Unit>,
    /// Whether the points of the file have two coordinates.
    pub is_flat: bool,
    output: Output<'a>,
    /// Whether a vertex is not finite.
    has_non_finite: bool,
    corners: Vec<Point3<f64>>,
    triangulator: Triangulator,
    /// The sum of the squares of the numbers of vertices of large polygons so far.
    corner_squares: u64,
}

impl<'a> SceneBuilder<'a> {
    /// Makes a builder that passes full pieces to a visitor.
    pub(crate) fn in_pieces(pieces: Pieces<'a>) -> Self {
        let output = Output { pieces: Some(Box::new(pieces)), ..Output::default() };
        Self { output, ..Self::default() }
    }

    /// Returns whether the scene is built in pieces.
    pub(crate) fn makes_pieces(&self) -> bool {
        self.output.pieces.is_some()
    }

    /// Stops keeping the vertices of earlier pieces, for a file whose primitives do not use them.
    pub(crate) fn keep_vertices_of_pieces(&mut self) {
        self.output.pieces.iter_mut().for_each(|pieces| pieces.keep_vertices_of_pieces());
    }

    /// Opens the file another time, if it is read in pieces and can be read twice.
    pub(crate) fn open_again(&self) -> Option<BufReader<File>> {
        self.output.pieces.as_ref()?.open_again()
    }

    /// Returns the number of vertices.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        match &self.output.pieces {
            None => self.output.soup.positions().len(),
            Some(pieces) => pieces.vertex_count(),
        }
    }

    /// Returns the positions of all vertices. When the scene is built in pieces, the result is empty unless the builder
    /// [forgets](Self::forget_old_vertices) old vertices, because the others may be in a temporary file.
    pub(crate) fn positions(&self) -> &[Point3<f64>] {
        match &self.output.pieces {
            None => self.output.soup.positions(),
            Some(pieces) => pieces.resident_positions(),
        }
    }

    /// Ends the current piece if it is full. If a piece has ended since the last call, removes all vertices, so that
    /// the next vertex has the index 0, and returns `true`.
    pub(crate) fn forget_old_vertices(&mut self) -> Result<bool, Reason> {
        self.output.end_full_piece()?;
        Ok(self.output.pieces.as_mut().is_some_and(|pieces| pieces.forget_old_vertices()))
    }

    /// Adds a vertex and returns its index.
    ///
    /// # Errors
    /// [`Reason::ElementTooLarge`] if u32 cannot number it.
    pub fn push_vertex(&mut self, position: Point3<f64>) -> Result<u32, Reason> {
        let count = self.vertex_count() as u64;
        let vertex = u32::try_from(count).ok().filter(|&vertex| vertex < u32::MAX);
        let vertex = vertex.ok_or(Reason::ElementTooLarge { count: count + 1, limit: u64::from(u32::MAX) })?;
        self.has_non_finite |= !is_finite(&position);
        match &mut self.output.pieces {
            None => _ = self.output.soup.try_push_position(position).map_err(Reason::Build)?,
            Some(pieces) => pieces.push_position(position)?,
        }
        Ok(vertex)
    }

    /// Adds a primitive, which comes from the statement with this number.
    ///
    /// # Errors
    /// [`Reason::Build`] or [`Reason::Memory`] if there are too many.
    pub fn push(&mut self, element: Element, source: usize) -> Result<(), Reason> {
        self.output.push(element, source_number(source))
    }

    /// Adds the triangles that a polygon is divided into.
    ///
    /// # Errors
    /// Those of [`push`](Self::push), and [`Reason::PolygonsTooLarge`].
    pub fn push_polygon(&mut self, vertices: &[u32], source: usize) -> Result<(), Reason> {
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
        for &vertex in vertices {
            self.corners.push(self.output.position(vertex)?);
        }
        let source = source_number(source);
        for triangle in self.triangulator.triangulate(&self.corners) {
            self.output.push(Element::Triangle(triangle.map(|i| vertices[i as usize])), source)?;
        }
        Ok(())
    }

    /// Returns whether a vertex has finite coordinates, so that it may be part of a primitive.
    ///
    /// # Errors
    /// Those of reading a temporary file, if the scene is read in pieces.
    #[inline]
    pub fn is_finite(&mut self, vertex: u32) -> Result<bool, Reason> {
        Ok(!self.has_non_finite || is_finite(&self.output.position(vertex)?))
    }

    /// Starts an object with this name, whose line ends become blanks. Primitives under an empty name belong to no
    /// object.
    pub fn start_object(&mut self, name: &[u8]) {
        let name = trim(name);
        if memchr2(b'\n', b'\r', name).is_none() {
            return self.start_run(name);
        }
        let blank = |&byte: &u8| if matches!(byte, b'\n' | b'\r') { b' ' } else { byte };
        self.start_run(&name.iter().map(blank).collect::<Vec<_>>());
    }

    /// Starts an object with exactly this name.
    pub(crate) fn start_run(&mut self, name: &[u8]) {
        self.output.objects.start(name, self.output.soup.len());
    }

    /// Removes all objects.
    pub(crate) fn clear_objects(&mut self) {
        self.output.objects = ObjectRuns { start: self.output.soup.len(), ..ObjectRuns::default() };
    }

    /// Adds a point for every vertex with finite coordinates.
    ///
    /// # Errors
    /// Those of [`push`](Self::push).
    #[allow(clippy::cast_possible_truncation, reason = "there are no more vertices than u32 can count")]
    pub fn push_point_cloud(&mut self) -> Result<(), Reason> {
        let mut left_out = 0;
        for i in 0..self.vertex_count() {
            if self.is_finite(i as u32)? {
                self.push(Element::Point(i as u32), i)?;
            } else {
                left_out += 1;
            }
        }
        self.skipped.add_plural(left_out, "vertices that are not finite");
        Ok(())
    }

    /// Returns the scene, or its last piece, with all records that were skipped.
    #[must_use]
    pub fn finish(mut self) -> Scene {
        let uncovered = self.triangulator.uncovered;
        self.skipped.add_plural(uncovered, "insides of polygons that cross themselves");
        let Output { mut soup, mut sources, mut objects, .. } = self.output;
        // The scene does not grow any more.
        soup.shrink_to_fit();
        sources.shrink_to_fit();
        objects.end(soup.len());
        let (unit, is_flat) = (self.unit, self.is_flat);
        Scene { soup: Arc::new(soup), sources, objects: objects.list, skipped: self.skipped.finish(), unit, is_flat }
    }
}

fn is_finite(position: &Point3<f64>) -> bool {
    position.iter().all(|x| x.is_finite())
}

/// Returns the number of a source. `u32::MAX` stands for sources that u32 cannot number.
fn source_number(source: usize) -> u32 {
    u32::try_from(source).unwrap_or(u32::MAX)
}
