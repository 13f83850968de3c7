//! Reads the geometry of Wavefront OBJ files.

mod block;
mod keywords;
mod writer;

pub use writer::write_obj;
pub(super) use writer::write_obj as write;

use crate::builder::SceneBuilder;
use crate::parse::blocks::{Source, for_each_block};
use crate::parse::text::{LineReader, Tokens, parse_number};
use crate::polygon::MAX_CORNERS;
use crate::{FileLocation, ReadError, Reason, Scene};
use block::{Block, Kind, Shape, vertex_of};
use keywords::{is_free_form, is_known};
use nalgebra::Point3;
use p2m_core::Element;
use std::io::BufRead;
use std::ops::Range;

/// Reads an OBJ file. `name` is the name of the file in messages.
///
/// The statements with geometry are:
///
/// - `v` is a vertex of three coordinates. Weights or colours after them are ignored, but have to be numbers.
/// - `f` (or its old name `fo`) is a polygon of any shape. One of two vertices is a polyline.
/// - `l` is a polyline, whose n vertices make n - 1 segments.
/// - `p` is a list of points.
///
/// A reference to a vertex may be `a`, `a/b`, `a//c` or `a/b/c`, where `a` counts vertices from 1, or backwards from
/// -1. A positive reference may be to a vertex that is defined later. All other statements, free-form curves and
/// surfaces included, are counted in [`Scene::skipped`] by keyword.
///
/// A file without `f`, `l` and `p` is a point cloud, and each of its vertices is a point. If it has statements of
/// free-form geometry (`cstype`, `curv`, `surf`, ...), its vertices are control points, and the scene is empty.
///
/// The statements `o` make [`Scene::objects`], or the statements `g` in a file without `o`. The name is the rest of the
/// line, a `#` included.
///
/// Coordinates that are not finite are allowed if no primitive uses the vertex. A point cloud leaves such vertices out
/// and counts them in [`Scene::skipped`].
///
/// Lines end at `\n`, `\r\n` or `\r`. A backslash at the end of a line continues it, except in a comment. Comments may
/// follow data. Bytes outside of the statements above are not interpreted, so names may have any encoding. The file is
/// read line by line.
///
/// A face with repeated vertices is kept as a degenerate triangle or polygon.
///
/// # Errors
/// [`ReadError`] with the line for invalid numbers, indices that are out of range or refer to a vertex that is not
/// finite, statements with too few vertices, faces with more than [`MAX_CORNERS`] vertices,
/// [`Reason::PolygonsTooLarge`], and errors of `reader`. A file without bytes, and one without vertices that has
/// statements unknown to OBJ, returns [`Reason::NoVertex`].
pub fn read_obj(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    read(Source::new(reader), name, SceneBuilder::default())
}

/// Reads an OBJ file into a builder.
pub(super) fn read(
    mut source: Source<impl BufRead>,
    name: &str,
    builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    let fail = |(line, reason)| ReadError::new(name, FileLocation::Line(line), reason);
    let mut parser = Parser { builder, ..Parser::default() };
    for_each_block(
        &mut source,
        |bytes| Some(block::cut(bytes)),
        block::parse,
        |bytes, block| parser.add_block(bytes, &block).map(|()| None).map_err(fail),
    )?;
    let mut is_empty = parser.line == 0;
    let mut lines = LineReader::new(source, parser.line);
    loop {
        match lines.read_continued() {
            Ok(true) => is_empty = false,
            Ok(false) => break,
            Err(e) => return Err(fail((lines.line(), Reason::Io(e)))),
        }
        parser.add_statement(lines.bytes(), lines.line()).map_err(fail)?;
    }
    if is_empty {
        return Err(ReadError::new(name, FileLocation::File, Reason::NoVertex));
    }
    parser.add_deferred().map_err(fail)?;
    parser.finish().map_err(|reason| ReadError::new(name, FileLocation::File, reason))
}

/// Returns whether an OBJ file has statements `o`. An error of the reader ends the search, because it occurs again when
/// the file is read.
fn has_objects(reader: impl BufRead) -> bool {
    let mut lines = LineReader::new(reader, 0);
    while lines.read_continued().unwrap_or(false) {
        if Tokens::new(lines.bytes()).next() == Some(b"o") {
            return true;
        }
    }
    false
}

/// A statement that is deferred to the end of the file, because it refers to a vertex that was not defined yet. All
/// statements after it are deferred as well, so that primitives stay in the order of the file.
enum Deferred {
    /// The shape, its line, and the range of its vertices in [`Parser::deferred_vertices`].
    Shape(Shape, u64, Range<usize>),
    /// The name of an object that starts here.
    Object(Vec<u8>),
    /// The removal of all objects so far, which come from statements `g`, because the file has statements `o`.
    ClearObjects,
}

#[derive(Default)]
struct Parser<'a> {
    builder: SceneBuilder<'a>,
    /// The number of statements `f` so far.
    faces: usize,
    /// The number of statements `l` so far.
    lines: usize,
    /// The number of statements `p` so far.
    points: usize,
    /// Whether there is a statement that OBJ does not have.
    has_unknown: bool,
    /// Whether there is a statement of free-form geometry.
    has_free_form: bool,
    /// Whether there is a statement `o`.
    has_objects: bool,
    /// Whether there is a statement `g` before all statements `o`.
    has_groups: bool,
    /// Whether statements `g` are ignored, because statements `o` follow.
    ignores_groups: bool,
    /// The vertices of the current statement.
    vertices: Vec<u32>,
    /// The first line of the current statement, or the last line of the last block.
    line: u64,
    /// The line of the first reference of the statement to a vertex that is not defined yet.
    forward_line: Option<u64>,
    deferred: Vec<Deferred>,
    deferred_vertices: Vec<u32>,
}

impl Parser<'_> {
    /// Adds the statements of a block. The error has its line.
    fn add_block(&mut self, bytes: &[u8], block: &Block) -> Result<(), (u64, Reason)> {
        let lines_before = self.line;
        let (mut positions, mut references) = (block.positions.as_slice(), block.references.as_slice());
        for statement in &block.statements {
            let line = lines_before + 1 + u64::from(statement.line);
            let text = &bytes[statement.start as usize..];
            match statement.kind {
                Kind::Vertices => {
                    let run;
                    (run, positions) = positions.split_at(statement.count as usize);
                    for (line, &position) in (line..).zip(run) {
                        self.builder.push_vertex(position).map_err(|reason| (line, reason))?;
                    }
                }
                Kind::Shape(shape) => {
                    let own;
                    (own, references) = references.split_at(statement.count as usize);
                    self.line = line;
                    if self.resolve(own) {
                        self.shape(shape).map_err(|reason| (line, reason))?;
                    } else {
                        self.add_statement_at_start(text, line)?;
                    }
                }
                Kind::Skipped => self.builder.skipped.add(block::keyword(text), u64::from(statement.count)),
                Kind::Other => self.add_statement_at_start(text, line)?,
            }
        }
        self.line = lines_before + u64::from(block.lines);
        Ok(())
    }

    /// Resolves the references of a statement on one line into `self.vertices`. Returns `false` if there is an error,
    /// which the sequential parser then finds and describes.
    fn resolve(&mut self, references: &[i32]) -> bool {
        let count = self.builder.vertex_count();
        self.vertices.clear();
        let mut is_forward = false;
        for &reference in references {
            let index = reference.unsigned_abs();
            let vertex = if reference > 0 {
                Some(index - 1)
            } else {
                u32::try_from(count).ok().and_then(|c| c.checked_sub(index))
            };
            let Some(vertex) = vertex else { return false };
            if vertex as usize >= count {
                is_forward = true;
            } else if !self.builder.is_finite(vertex).unwrap_or(false) {
                return false;
            }
            self.vertices.push(vertex);
        }
        self.forward_line = is_forward.then_some(self.line);
        true
    }

    /// Parses the first statement of a text. `line` is its line, and the error has its own.
    fn add_statement_at_start(&mut self, text: &[u8], line: u64) -> Result<(), (u64, Reason)> {
        let mut lines = LineReader::new(text, line - 1);
        match lines.read_continued() {
            Ok(_) => self.add_statement(lines.bytes(), line),
            Err(e) => Err((line, Reason::Io(e))),
        }
    }

    /// Parses a statement. `line` is its line, and the error has its own.
    fn add_statement(&mut self, text: &[u8], line: u64) -> Result<(), (u64, Reason)> {
        let mut tokens = Tokens::new(text);
        self.line = line;
        self.statement(&mut tokens).map_err(|reason| (line + tokens.line_offset(), reason))
    }

    /// Parses a statement. After an error, the last token of `tokens` is the one that the error is about.
    fn statement(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Reason> {
        let Some(keyword) = tokens.next() else { return Ok(()) };
        match keyword {
            b"v" => self.vertex(tokens),
            b"f" | b"fo" => {
                self.vertices(tokens, 2)?;
                let found = self.vertices.len();
                if found > MAX_CORNERS {
                    return Err(Reason::ElementTooLarge { count: found as u64, limit: MAX_CORNERS as u64 });
                }
                self.shape(if found == 2 { Shape::Polyline } else { Shape::Polygon })
            }
            b"l" => {
                self.vertices(tokens, 2)?;
                self.shape(Shape::Polyline)
            }
            b"p" => {
                self.vertices(tokens, 1)?;
                self.shape(Shape::Points)
            }
            b"o" | b"g" => {
                // Whether the statement counts as skipped is known only at the end of the file.
                self.builder.skipped.add(keyword, 1);
                if keyword == b"o" && !self.has_objects {
                    // The groups so far are no objects, because the file has statements `o`.
                    if self.deferred.is_empty() {
                        self.builder.clear_objects();
                    } else {
                        self.deferred.push(Deferred::ClearObjects);
                    }
                    self.has_objects = true;
                }
                if keyword == b"g" && !self.has_objects && !self.has_groups {
                    self.has_groups = true;
                    // A scene that is read as a whole still has all groups when an object follows.
                    self.ignores_groups = self.builder.open_again().is_some_and(has_objects);
                }
                if keyword == b"o" || !(self.has_objects || self.ignores_groups) {
                    self.object(tokens.rest());
                }
                Ok(())
            }
            [b'#', ..] => Ok(()),
            other => {
                if !is_known(other) {
                    let is_free_form = is_free_form(other);
                    self.has_free_form |= is_free_form;
                    self.has_unknown |= !is_free_form;
                }
                self.builder.skipped.add(other, 1);
                Ok(())
            }
        }
    }

    fn object(&mut self, name: &[u8]) {
        if self.deferred.is_empty() {
            self.builder.start_object(name);
        } else {
            self.deferred.push(Deferred::Object(name.to_vec()));
        }
    }

    /// Adds the primitives of the current statement, or defers it.
    fn shape(&mut self, shape: Shape) -> Result<(), Reason> {
        let line = self.forward_line.take();
        if line.is_none() && self.deferred.is_empty() {
            let vertices = std::mem::take(&mut self.vertices);
            let added = self.add(shape, &vertices);
            self.vertices = vertices;
            return added;
        }
        let start = self.deferred_vertices.len();
        self.deferred_vertices.try_reserve(self.vertices.len()).map_err(Reason::Memory)?;
        self.deferred.try_reserve(1).map_err(Reason::Memory)?;
        self.deferred_vertices.extend_from_slice(&self.vertices);
        self.deferred.push(Deferred::Shape(shape, line.unwrap_or(self.line), start..self.deferred_vertices.len()));
        Ok(())
    }

    /// Adds the primitives of a statement whose vertices are defined and finite.
    fn add(&mut self, shape: Shape, vertices: &[u32]) -> Result<(), Reason> {
        match shape {
            Shape::Polygon => {
                self.builder.push_polygon(vertices, self.faces)?;
                self.faces += 1;
            }
            Shape::Polyline => {
                for ends in vertices.windows(2) {
                    self.builder.push(Element::Segment([ends[0], ends[1]]), self.lines)?;
                }
                self.lines += 1;
            }
            Shape::Points => {
                for &vertex in vertices {
                    self.builder.push(Element::Point(vertex), self.points)?;
                }
                self.points += 1;
            }
        }
        Ok(())
    }

    fn check_finite(&mut self, vertices: &[u32]) -> Result<(), Reason> {
        for &vertex in vertices {
            if !self.builder.is_finite(vertex)? {
                return Err(Reason::NonFiniteVertex { index: u64::from(vertex) + 1 });
            }
        }
        Ok(())
    }

    /// Adds the primitives of the deferred statements. The error has the line of its statement.
    fn add_deferred(&mut self) -> Result<(), (u64, Reason)> {
        let (deferred, vertices) = (std::mem::take(&mut self.deferred), std::mem::take(&mut self.deferred_vertices));
        let count = self.builder.vertex_count() as u64;
        for statement in deferred {
            match statement {
                Deferred::Object(name) => self.builder.start_object(&name),
                Deferred::ClearObjects => self.builder.clear_objects(),
                Deferred::Shape(shape, line, range) => {
                    let vertices = &vertices[range];
                    if let Some(vertex) = vertices.iter().find(|vertex| u64::from(**vertex) >= count) {
                        return Err((line, Reason::IndexOutOfRange { index: i64::from(*vertex) + 1, count }));
                    }
                    self.check_finite(vertices)
                        .and_then(|()| self.add(shape, vertices))
                        .map_err(|reason| (line, reason))?;
                }
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Scene, Reason> {
        if self.has_unknown && self.builder.vertex_count() == 0 {
            return Err(Reason::NoVertex);
        }
        if self.faces + self.lines + self.points > 0 || self.has_free_form {
            self.builder.skipped.remove(if self.has_objects { b"o" } else { b"g" });
        } else {
            self.builder.clear_objects();
            self.builder.push_point_cloud()?;
        }
        Ok(self.builder.finish())
    }

    fn vertex(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Reason> {
        tokens.end_at_comment();
        let mut position = [0.0; 3];
        for (found, x) in position.iter_mut().enumerate() {
            *x = parse_number(tokens.next().ok_or(Reason::TooFewCoordinates { found })?)?;
        }
        // If a token is not a number, the line is not a vertex.
        while let Some(token) = tokens.next() {
            parse_number(token)?;
        }
        self.builder.push_vertex(Point3::from(position)).map(|_| ())
    }

    /// Reads the references of a statement into `self.vertices`. There have to be at least `needed`.
    fn vertices(&mut self, tokens: &mut Tokens<'_>, needed: u64) -> Result<(), Reason> {
        tokens.end_at_comment();
        self.vertices.clear();
        while let Some(token) = tokens.next() {
            let vertex = vertex_of(token, self.builder.vertex_count())?;
            if vertex as usize >= self.builder.vertex_count() {
                self.forward_line.get_or_insert(self.line + tokens.line_offset());
            } else if !self.builder.is_finite(vertex)? {
                return Err(Reason::NonFiniteVertex { index: u64::from(vertex) + 1 });
            }
            self.vertices.push(vertex);
        }
        let found = self.vertices.len() as u64;
        if found < needed { Err(Reason::TooFewVertices { found, needed }) } else { Ok(()) }
    }
}
