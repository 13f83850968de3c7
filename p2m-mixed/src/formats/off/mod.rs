//! Reads OFF files, the object file format of Geomview, as text or binary.

mod writer;

pub use writer::write_off;
pub(super) use writer::write_off as write;

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::parse::bytes::{ByteReader, Bytes, Scalar};
use crate::parse::text::{LineReader, parse_integer, parse_number, quote};
use crate::parse::tokenizer::Tokenizer;
use crate::polygon::MAX_CORNERS;
use crate::{FileLocation, HeaderProblem, ReadError, Reason, Scene};
use nalgebra::Point3;
use p2m_core::Element;
use std::io::BufRead;

/// Reads an OFF file. `name` is the name of the file in messages.
///
/// Faces of three or more vertices are polygons of any shape, faces of two vertices are segments, and faces of one
/// vertex are points. A file without faces is a point cloud, and each vertex is a point. [`Scene::sources`] counts
/// faces of any number of vertices from 0.
///
/// The first word is `OFF`, prefixed by any of `ST`, `C` and `N`, which announce texture coordinates, colours and
/// normals of vertices. The word may be missing, and the counts may follow it on the same line, even without a blank.
/// The number of edges may be missing. A `#` starts a comment. Vertices and faces may extend over several lines.
///
/// Numbers after the coordinates of a vertex on its line (colours, normals), up to four numbers after a face (its
/// colour), and anything after the last face are left out and counted in [`Scene::skipped`]. `OFF BINARY` files are
/// supported as well.
///
/// Vertices in other dimensions (`4OFF`, `nOFF`) are an error, except `nOFF` with 3 dimensions.
///
/// Coordinates that are not finite are allowed if no primitive uses the vertex. A point cloud leaves such vertices out
/// and counts them in [`Scene::skipped`].
///
/// # Errors
/// [`ReadError`] with the line (text) or the offset (binary) for an invalid header, an early end, invalid numbers or
/// too many of them on a line, indices that are out of range, primitives with a vertex that is not finite, faces
/// without vertices or with more than [`MAX_CORNERS`], and errors of `reader`. No memory is allocated for data that the
/// header only announces.
pub fn read_off(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    read(Source::new(reader), name, SceneBuilder::default())
}

/// Reads an OFF file into a builder.
pub(super) fn read(source: Source<impl BufRead>, name: &str, builder: SceneBuilder<'_>) -> Result<Scene, ReadError> {
    let mut tokens = Tokenizer::with_comments(LineReader::new(source.into_reader(), 0));
    let fail = |line, reason| ReadError::new(name, FileLocation::Line(line), reason);
    let header = read_header(&mut tokens).map_err(|reason| fail(tokens.line(), reason))?;
    let Some(counts) = header.counts else {
        let line = tokens.line();
        let (reader, offset) = tokens.lines.into_reader().map_err(|e| fail(line, Reason::Io(e)))?;
        let mut bytes = ByteReader::new(reader, offset);
        return read_binary(&mut bytes, header.extras, builder)
            .map_err(|reason| ReadError::new(name, FileLocation::Byte(bytes.start()), reason));
    };
    read_text(&mut tokens, counts, builder).map_err(|reason| fail(tokens.line(), reason))
}

struct Header {
    /// The numbers of vertices and faces, or `None` if the data is binary.
    counts: Option<[u64; 2]>,
    /// The number of values after the coordinates of each vertex in a binary file.
    extras: u64,
}

fn read_header(tokens: &mut Tokenizer<impl BufRead>) -> Result<Header, Reason> {
    let first = tokens.next()?.to_vec();
    if first.iter().all(u8::is_ascii_digit) {
        return Ok(Header { counts: Some([count(&first)?, faces_of_header(tokens)?]), extras: 0 });
    }
    let not_off = || Reason::BadHeader(HeaderProblem::NotOff { text: quote(&first) });
    let unsupported = || Reason::UnsupportedFormat { text: quote(&first) };
    let at = first.windows(3).position(|w| w == b"OFF" || w == b"off").ok_or_else(not_off)?;
    let (mut prefix, glued) = (&first[..at], &first[at + 3..]);
    let mut extras = 0;
    let mut has_dimension = false;
    while !prefix.is_empty() {
        let (length, numbers) = match prefix {
            [b'S', b'T', ..] => (2, 2),
            [b'C', ..] => (1, 4),
            [b'N', ..] => (1, 3),
            [b'n', ..] => {
                has_dimension = true;
                (1, 0)
            }
            [b'4', ..] => return Err(unsupported()),
            _ => return Err(not_off()),
        };
        extras += numbers;
        prefix = &prefix[length..];
    }
    if !glued.is_empty() {
        // A well-known collection has headers like `OFF490 518 0`.
        if has_dimension || !glued.iter().all(u8::is_ascii_digit) {
            return Err(not_off());
        }
        return Ok(Header { counts: Some([count(glued)?, faces_of_header(tokens)?]), extras });
    }
    let mut next = tokens.next_on_line().map(<[u8]>::to_vec);
    if next.as_ref().is_some_and(|word| word.eq_ignore_ascii_case(b"binary")) {
        return if has_dimension { Err(unsupported()) } else { Ok(Header { counts: None, extras }) };
    }
    if has_dimension {
        let dimension = next.take().map_or_else(|| tokens.next().map(<[u8]>::to_vec), Ok)?;
        if count(&dimension)? != 3 {
            return Err(unsupported());
        }
    }
    let vertices = next.map_or_else(|| tokens.next().map(<[u8]>::to_vec), Ok)?;
    Ok(Header { counts: Some([count(&vertices)?, faces_of_header(tokens)?]), extras })
}

/// Reads the number of faces, and the optional number of edges after it on the same line.
fn faces_of_header(tokens: &mut Tokenizer<impl BufRead>) -> Result<u64, Reason> {
    let faces = count(tokens.next()?)?;
    if let Some(edges) = tokens.next_on_line() {
        parse_integer(edges)?; // the number of edges is not used, and often wrong
    }
    match tokens.next_on_line() {
        Some(token) => Err(Reason::ExtraWord { text: quote(token) }),
        None => Ok(faces),
    }
}

fn count(token: &[u8]) -> Result<u64, Reason> {
    u64::try_from(parse_integer(token)?).map_err(|_| Reason::BadNumber { text: quote(token) })
}

/// The most numbers of a colour, which may follow a face.
const MAX_COLOUR_NUMBERS: u64 = 4;

fn read_text(
    tokens: &mut Tokenizer<impl BufRead>,
    [vertices, faces]: [u64; 2],
    builder: SceneBuilder<'_>,
) -> Result<Scene, Reason> {
    let mut off = Off::new([vertices, faces], builder)?;
    for _ in 0..vertices {
        let mut position = Point3::origin();
        position.x = parse_number(tokens.next()?)?;
        let mut is_wrapped = false;
        for k in 1..3 {
            position[k] = match tokens.next_on_line().map(parse_number) {
                Some(number) => number?,
                None => {
                    is_wrapped = true;
                    parse_number(tokens.next()?)?
                }
            };
        }
        // If the vertex extends over several lines, the likely cause is a missing number on an earlier line.
        off.vertex(position, extras(tokens, if is_wrapped { 0 } else { u64::MAX })?)?;
    }
    for face in 0..faces {
        let corners = parse_integer(tokens.next()?)?;
        for _ in 0..off.start_face(corners)? {
            off.corner(parse_integer(tokens.next()?)?)?;
        }
        off.end_face(face, extras(tokens, MAX_COLOUR_NUMBERS)?)?;
    }
    let rest = tokens.skip_rest()?;
    off.finish(rest, "words after the last face")
}

/// Passes the numbers on the rest of a line, of which there may be so many, and returns how many there are.
fn extras(tokens: &mut Tokenizer<impl BufRead>, most: u64) -> Result<u64, Reason> {
    let mut extras = 0;
    while let Some(token) = tokens.next_on_line() {
        parse_number(token)?;
        extras += 1;
        if extras > most {
            return Err(Reason::ExtraWord { text: quote(token) });
        }
    }
    Ok(extras)
}

fn read_binary(bytes: &mut ByteReader<impl BufRead>, extras: u64, builder: SceneBuilder<'_>) -> Result<Scene, Reason> {
    let mut counts = [0; 3];
    for count in &mut counts {
        let number = i32::from_be_bytes(bytes.array()?);
        *count = u64::try_from(number).map_err(|_| Reason::BadListCount { count: i64::from(number) })?;
    }
    let [vertices, faces, _] = counts;
    let mut off = Off::new([vertices, faces], builder)?;
    for _ in 0..vertices {
        let mut position = Point3::origin();
        for x in position.iter_mut() {
            *x = bytes.number(Scalar::F32, true)?;
        }
        bytes.skip(4 * extras)?;
        off.vertex(position, extras)?;
    }
    for face in 0..faces {
        let corners = i64::from(i32::from_be_bytes(bytes.array()?));
        for _ in 0..off.start_face(corners)? {
            off.corner(i64::from(i32::from_be_bytes(bytes.array()?)))?;
        }
        let colour = i32::from_be_bytes(bytes.array()?);
        let numbers = u64::try_from(colour).ok().filter(|&n| n <= MAX_COLOUR_NUMBERS);
        let numbers = numbers.ok_or(Reason::BadListCount { count: i64::from(colour) })?;
        bytes.skip(4 * numbers)?;
        off.end_face(face, numbers)?;
    }
    let rest = bytes.skip_rest()?;
    off.finish(rest, "bytes after the last face")
}

/// Builds the scene of an OFF file.
struct Off<'a> {
    builder: SceneBuilder<'a>,
    counts: [u64; 2],
    /// The number of vertices and the number of faces that have further numbers, which are left out.
    extras: [u64; 2],
    /// The vertices of the current face.
    corners: Vec<u32>,
}

impl<'a> Off<'a> {
    fn new(counts: [u64; 2], builder: SceneBuilder<'a>) -> Result<Self, Reason> {
        if counts[0] > u64::from(u32::MAX) {
            return Err(Reason::ElementTooLarge { count: counts[0], limit: u64::from(u32::MAX) });
        }
        Ok(Self { builder, counts, extras: [0; 2], corners: Vec::new() })
    }

    fn vertex(&mut self, position: Point3<f64>, extras: u64) -> Result<(), Reason> {
        self.extras[0] += u64::from(extras > 0);
        self.builder.push_vertex(position).map(|_| ())
    }

    /// Starts a face and returns its number of corners.
    fn start_face(&mut self, corners: i64) -> Result<u64, Reason> {
        let count = u64::try_from(corners).map_err(|_| Reason::BadListCount { count: corners })?;
        if count == 0 {
            return Err(Reason::TooFewVertices { found: 0, needed: 1 });
        }
        if count > MAX_CORNERS as u64 {
            return Err(Reason::ElementTooLarge { count, limit: MAX_CORNERS as u64 });
        }
        self.corners.clear();
        Ok(count)
    }

    fn corner(&mut self, index: i64) -> Result<(), Reason> {
        let count = self.counts[0];
        let vertex = u32::try_from(index).ok().filter(|&v| u64::from(v) < count);
        let vertex = vertex.ok_or(Reason::NoSuchVertex { index, count })?;
        if !self.builder.is_finite(vertex)? {
            return Err(Reason::NonFiniteVertex { index: u64::from(vertex) });
        }
        self.corners.push(vertex);
        Ok(())
    }

    fn end_face(&mut self, face: u64, extras: u64) -> Result<(), Reason> {
        self.extras[1] += u64::from(extras > 0);
        let face = usize::try_from(face).unwrap_or(usize::MAX);
        match *self.corners.as_slice() {
            [a] => self.builder.push(Element::Point(a), face),
            [a, b] => self.builder.push(Element::Segment([a, b]), face),
            _ => self.builder.push_polygon(&self.corners, face),
        }
    }

    fn finish(mut self, rest: u64, what: &str) -> Result<Scene, Reason> {
        let [vertices, faces] = self.extras;
        self.builder.skipped.add_plural(vertices, "vertices with further numbers");
        self.builder.skipped.add_plural(faces, "faces with a colour");
        self.builder.skipped.add_plural(rest, what);
        if self.counts[1] == 0 {
            self.builder.push_point_cloud()?;
        }
        Ok(self.builder.finish())
    }
}
