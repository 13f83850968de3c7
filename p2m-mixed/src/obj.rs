//! Wavefront OBJ: the geometry of it.

use crate::builder::SceneBuilder;
use crate::polygon::MAX_CORNERS;
use crate::text::{LineReader, Tokens, parse_integer, parse_number, quote};
use crate::{FileLocation, ReadError, Reason, Scene};
use nalgebra::Point3;
use p2m_core::Element;
use std::io::BufRead;

/// Reads an OBJ file; `name` is for messages.
///
/// Understood are `v` (three coordinates; weights or colours behind them are ignored, but must be numbers), `f` (and
/// its old name `fo`) with polygons of any shape, `l` polylines, whose n vertices make n - 1 segments, and `p` points.
/// References may be `a`, `a/b`, `a//c` or `a/b/c`, where `a` counts vertices from 1, or backwards from -1; only
/// vertices further up can be referred to. Everything else, free-form curves and surfaces included, is counted in
/// [`Scene::skipped`] by keyword. A file without any `f`, `l` and `p` is a point cloud: each of its vertices is a
/// point, unless it has statements of free-form geometry (`cstype`, `curv`, `surf`, ...). Then its vertices are control
/// points, and the scene is empty.
///
/// [`Scene::objects`] are made by the statements `o`; a file that has none of them takes `g` instead. The name is the
/// rest of the line, a `#` included.
///
/// Coordinates that are not finite are no error as long as no primitive uses the vertex. A point cloud leaves such
/// vertices out and counts them in [`Scene::skipped`].
///
/// Lines end at `\n`, `\r\n` or `\r`. A backslash at the end of a line continues it, except in a comment. Comments may
/// follow data. Bytes outside of the statements above are never interpreted, so any encoding of names will do. The file
/// is read line by line.
///
/// A face that repeats vertices is kept: it is the degenerate triangle or polygon that it says.
///
/// # Errors
/// [`ReadError`] with the line for numbers that are none, indices of no vertex or of one that is not finite, statements
/// with too few vertices, faces beyond [`MAX_CORNERS`], and for what goes wrong in reading. A file without any vertex,
/// but with statements that are unknown to OBJ, is refused as none.
pub fn read_obj(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    let mut lines = LineReader::new(reader, 0);
    let mut parser = Parser::default();
    loop {
        match lines.read_continued() {
            Ok(true) => {}
            Ok(false) => break,
            Err(e) => return Err(ReadError::new(name, FileLocation::Line(lines.line()), Reason::Io(e))),
        }
        let mut tokens = Tokens::new(lines.bytes());
        parser
            .statement(&mut tokens)
            .map_err(|reason| ReadError::new(name, FileLocation::Line(lines.line() + tokens.line_offset()), reason))?;
    }
    parser.finish().map_err(|reason| ReadError::new(name, FileLocation::File, reason))
}

#[derive(Default)]
struct Parser {
    builder: SceneBuilder,
    /// Statements so far, of each kind.
    faces: usize,
    lines: usize,
    points: usize,
    /// Whether there are statements that OBJ does not know, and such of free-form geometry.
    has_unknown: bool,
    has_free_form: bool,
    has_objects: bool,
    /// The vertices of the statement at hand.
    vertices: Vec<u32>,
}

impl Parser {
    /// `tokens` is left at the word that an error is about.
    fn statement(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Reason> {
        let Some(keyword) = tokens.next() else { return Ok(()) };
        match keyword {
            b"v" => self.vertex(tokens),
            b"f" | b"fo" => {
                self.vertices(tokens, 3)?;
                let found = self.vertices.len();
                if found > MAX_CORNERS {
                    return Err(Reason::ElementTooLarge { count: found as u64, limit: MAX_CORNERS as u64 });
                }
                self.builder.push_polygon(&self.vertices, self.faces)?;
                self.faces += 1;
                Ok(())
            }
            b"l" => {
                self.vertices(tokens, 2)?;
                for ends in self.vertices.windows(2) {
                    self.builder.push(Element::Segment([ends[0], ends[1]]), self.lines)?;
                }
                self.lines += 1;
                Ok(())
            }
            b"p" => {
                self.vertices(tokens, 1)?;
                for &vertex in &self.vertices {
                    self.builder.push(Element::Point(vertex), self.points)?;
                }
                self.points += 1;
                Ok(())
            }
            b"o" | b"g" => {
                // Whether it is passed over is known at the end.
                self.builder.skipped.add(keyword, 1);
                if keyword == b"o" && !self.has_objects {
                    self.builder.clear_objects(); // groups so far
                    self.has_objects = true;
                }
                if keyword == b"o" || !self.has_objects {
                    self.object(tokens.rest());
                }
                Ok(())
            }
            [b'#', ..] => Ok(()),
            other => {
                self.has_free_form |= is_free_form(other);
                self.has_unknown |= !is_known(other) && !is_free_form(other);
                self.builder.skipped.add(other, 1);
                Ok(())
            }
        }
    }

    fn object(&mut self, name: &[u8]) {
        if name.contains(&b'\n') {
            // A line that is continued.
            let name: Vec<u8> = name.iter().map(|&b| if b == b'\n' { b' ' } else { b }).collect();
            self.builder.start_object(&name);
        } else {
            self.builder.start_object(name);
        }
    }

    fn finish(mut self) -> Result<Scene, Reason> {
        if self.has_unknown && self.builder.positions().is_empty() {
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
        // Anything else behind the coordinates means that the line is not what it seems.
        while let Some(token) = tokens.next() {
            parse_number(token)?;
        }
        self.builder.push_vertex(Point3::from(position)).map(|_| ())
    }

    /// Reads the references of a statement, `needed` or more, into `self.vertices`.
    fn vertices(&mut self, tokens: &mut Tokens<'_>, needed: u64) -> Result<(), Reason> {
        tokens.end_at_comment();
        self.vertices.clear();
        while let Some(token) = tokens.next() {
            let vertex = vertex_of(token, self.builder.positions().len())?;
            if !self.builder.is_finite(vertex) {
                return Err(Reason::NonFiniteVertex { index: u64::from(vertex) + 1 });
            }
            self.vertices.push(vertex);
        }
        let found = self.vertices.len() as u64;
        if found < needed { Err(Reason::TooFewVertices { found, needed }) } else { Ok(()) }
    }
}

/// Keywords of free-form curves and surfaces, superseded ones included.
fn is_free_form(keyword: &[u8]) -> bool {
    matches!(
        keyword,
        b"cstype"
            | b"deg"
            | b"bmat"
            | b"step"
            | b"curv"
            | b"curv2"
            | b"surf"
            | b"parm"
            | b"trim"
            | b"hole"
            | b"scrv"
            | b"sp"
            | b"end"
            | b"con"
            | b"bzp"
            | b"bsp"
            | b"cdc"
            | b"cdp"
            | b"res"
    )
}

/// Other keywords of OBJ that say nothing of the geometry.
fn is_known(keyword: &[u8]) -> bool {
    matches!(
        keyword,
        b"vt"
            | b"vn"
            | b"vp"
            | b"g"
            | b"s"
            | b"o"
            | b"mg"
            | b"usemtl"
            | b"mtllib"
            | b"usemap"
            | b"maplib"
            | b"bevel"
            | b"c_interp"
            | b"d_interp"
            | b"lod"
            | b"shadow_obj"
            | b"trace_obj"
            | b"ctech"
            | b"stech"
            | b"call"
            | b"csh"
    )
}

/// The number, from 0, of the vertex that a reference like `7/1/2` names when `count` are known.
fn vertex_of(token: &[u8], count: usize) -> Result<u32, Reason> {
    let bad = || Reason::BadNumber { text: quote(token) };
    let mut parts = token.split(|&b| b == b'/');
    let index = parts.next().and_then(|part| parse_integer(part).ok()).ok_or_else(bad)?;
    // Texture and normal are not looked up, but they should be numbers, if they are there.
    for part in parts.by_ref().take(2) {
        if !part.is_empty() {
            parse_integer(part).map_err(|_| bad())?;
        }
    }
    if parts.next().is_some() {
        return Err(bad());
    }
    let count = count as u64;
    let vertex = match index {
        0 => return Err(Reason::IndexZero),
        1.. => Some(index.unsigned_abs() - 1).filter(|&i| i < count),
        _ => count.checked_sub(index.unsigned_abs()),
    };
    vertex.and_then(|i| u32::try_from(i).ok()).ok_or(Reason::IndexOutOfRange { index, count })
}
