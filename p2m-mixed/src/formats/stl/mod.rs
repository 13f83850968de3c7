//! Reads STL files, which have only triangles, as text or binary.

mod writer;

pub(super) use writer::write_stl as write;
pub use writer::{StlRounding, stl_rounding, write_stl};

use crate::builder::SceneBuilder;
use crate::parse::blocks::Source;
use crate::parse::bytes::{ByteReader, Bytes};
use crate::parse::text::{LineReader, is_space, parse_finite, quote};
use crate::parse::tokenizer::Tokenizer;
use crate::polygon::MAX_CORNERS;
use crate::{FileLocation, HeaderProblem, ReadError, Reason, Scene};
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use nalgebra::Point3;
use std::hash::{BuildHasher, RandomState};
use std::io::{BufRead, Cursor, Read};

/// The number of bytes that decide whether a file is text or binary.
const DETECTION_BYTES: u64 = 1024;

/// Reads an STL file, text or binary. `name` is the name of the file in messages.
///
/// The first 1024 bytes decide whether the file is text. Text starts with `solid`, possibly after blanks, and has no
/// control characters. Many binary files start with `solid` too, but they have zero bytes in the first facets.
///
/// Corners with equal coordinates become one vertex, which has the coordinates of the first of them (0 and -0 are
/// equal). Other corners are not merged. Degenerate facets are kept. [`Scene::sources`] counts facets from 0.
///
/// - **Text** has any number of solids, whose names are in [`Scene::objects`]. Keywords may have any case, and numbers
///   are read in double precision. Normals are ignored and may be missing. A facet of more than three vertices is
///   divided into triangles like any polygon.
/// - **Binary** files have coordinates in single precision, which are exact in double precision. Attribute bytes other
///   than zero, and bytes after the last facet, are counted in [`Scene::skipped`].
///
/// # Errors
/// [`ReadError`] with the line (text) or the offset of the facet (binary) for coordinates that are not finite,
/// invalid numbers, unexpected words, an early end, and errors of `reader`. No memory is allocated for facets that
/// the header only announces.
pub fn read_stl(reader: impl BufRead, name: &str) -> Result<Scene, ReadError> {
    read(Source::new(reader), name, SceneBuilder::default())
}

/// Reads an STL file into a builder.
pub(super) fn read(
    source: Source<impl BufRead>,
    name: &str,
    mut builder: SceneBuilder<'_>,
) -> Result<Scene, ReadError> {
    builder.keep_vertices_of_pieces();
    let mut reader = source.into_reader();
    let fail = |reason| ReadError::new(name, FileLocation::File, reason);
    let mut head = Vec::new();
    reader.by_ref().take(DETECTION_BYTES).read_to_end(&mut head).map_err(|e| fail(Reason::Io(e)))?;
    let is_text = !head.iter().any(|&b| is_control(b));
    let says_solid = starts_with_solid(&head);
    if is_text && !says_solid && !head.is_empty() {
        return Err(fail(Reason::BadHeader(HeaderProblem::NotStl)));
    }
    let reader = Cursor::new(head).chain(reader);
    if is_text && says_solid {
        let mut text = Text { tokens: Tokenizer::new(LineReader::new(reader, 0)), facets: Facets::new(builder) };
        match text.solids() {
            Ok(()) => Ok(text.facets.builder.finish()),
            Err(reason) => Err(ReadError::new(name, FileLocation::Line(text.tokens.line()), reason)),
        }
    } else {
        let mut bytes = ByteReader::new(reader, 0);
        read_binary(&mut bytes, builder)
            .map_err(|reason| ReadError::new(name, FileLocation::Byte(bytes.start()), reason))
    }
}

/// Returns whether a byte does not occur in text. The end mark of old systems (0x1a) does.
fn is_control(byte: u8) -> bool {
    byte < b' ' && !is_space(byte) && byte != 0x1a
}

fn starts_with_solid(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head); // the mark of UTF-8
    let start = head.iter().position(|&b| !is_space(b)).unwrap_or(head.len());
    let token = &head[start..];
    token.len() >= 5 && token[..5].eq_ignore_ascii_case(b"solid") && token.get(5).is_none_or(|&b| is_space(b))
}

/// Builds the scene of an STL file and merges equal vertices.
struct Facets<'a> {
    builder: SceneBuilder<'a>,
    vertices: HashTable<u32>,
    hasher: RandomState,
    /// The number of facets so far.
    count: usize,
    /// The vertices of the current facet.
    corners: Vec<u32>,
}

impl<'a> Facets<'a> {
    fn new(builder: SceneBuilder<'a>) -> Self {
        let (vertices, hasher, corners) = Default::default();
        Self { builder, vertices, hasher, count: 0, corners }
    }

    /// Starts a facet. Pieces share no vertices, so that the vertices of one piece are in memory.
    fn start_facet(&mut self) -> Result<(), Reason> {
        if self.builder.forget_old_vertices()? {
            self.vertices.clear();
        }
        Ok(())
    }

    /// Adds a corner, which has to be finite, to the current facet.
    fn corner(&mut self, corner: [f64; 3]) -> Result<(), Reason> {
        let corner = Point3::from(corner);
        // The sum of -0 and 0 is 0, so equal coordinates have equal hashes.
        let hash = |p: &Point3<f64>| self.hasher.hash_one([p.x, p.y, p.z].map(|x| (x + 0.0).to_bits()));
        let positions = self.builder.positions();
        let equal = |&vertex: &u32| positions[vertex as usize] == corner;
        let vertex = match self.vertices.entry(hash(&corner), equal, |&vertex| hash(&positions[vertex as usize])) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                let vertex = self.builder.push_vertex(corner)?;
                entry.insert(vertex);
                vertex
            }
        };
        self.corners.push(vertex);
        Ok(())
    }

    fn end_facet(&mut self) -> Result<(), Reason> {
        let found = self.corners.len();
        if found < 3 {
            return Err(Reason::TooFewVertices { found: found as u64, needed: 3 });
        }
        if found > MAX_CORNERS {
            return Err(Reason::ElementTooLarge { count: found as u64, limit: MAX_CORNERS as u64 });
        }
        self.builder.push_polygon(&self.corners, self.count)?;
        self.corners.clear();
        self.count += 1;
        Ok(())
    }
}

struct Text<'a, R> {
    tokens: Tokenizer<R>,
    facets: Facets<'a>,
}

impl<R: BufRead> Text<'_, R> {
    fn solids(&mut self) -> Result<(), Reason> {
        let mut is_open = false;
        loop {
            let token = match self.tokens.next() {
                Err(Reason::UnexpectedEnd) if !is_open => return Ok(()),
                token => token?,
            };
            if is(token, "solid") {
                self.facets.builder.start_object(self.tokens.rest_of_line());
                is_open = true;
            } else if is_open && is(token, "facet") {
                self.facet()?;
            } else if is_open && (is(token, "endsolid") || is(token, "end")) {
                if is(token, "end") {
                    self.expect("solid", "'solid'")?;
                }
                self.tokens.rest_of_line();
                is_open = false;
            } else if !is_open && token == b"\x1a" {
                // The end mark of old systems is ignored.
            } else {
                let expected = if is_open { "'facet' or 'endsolid'" } else { "'solid'" };
                return Err(Reason::UnexpectedWord { text: quote(token), expected });
            }
        }
    }

    /// Reads a facet after the word `facet`.
    fn facet(&mut self) -> Result<(), Reason> {
        // The word `normal` and three numbers are skipped. Some writers have other words in place of the numbers.
        for _ in 0..4 {
            if is(self.tokens.next()?, "outer") {
                return self.corners();
            }
        }
        self.expect("outer", "'outer loop'")?;
        self.corners()
    }

    /// Reads the corners of a facet after the word `outer`.
    fn corners(&mut self) -> Result<(), Reason> {
        self.expect("loop", "'loop'")?;
        self.facets.start_facet()?;
        loop {
            let token = self.tokens.next()?;
            if is(token, "endloop") {
                break;
            }
            // Some writers make two words of it.
            if is(token, "end") {
                self.expect("loop", "'loop'")?;
                break;
            }
            if !is(token, "vertex") {
                return Err(Reason::UnexpectedWord { text: quote(token), expected: "'vertex' or 'endloop'" });
            }
            let mut corner = [0.0; 3];
            for x in &mut corner {
                *x = parse_finite(self.tokens.next()?)?;
            }
            self.facets.corner(corner)?;
        }
        let token = self.tokens.next()?;
        if is(token, "end") {
            self.expect("facet", "'facet'")?;
        } else if !is(token, "endfacet") {
            return Err(Reason::UnexpectedWord { text: quote(token), expected: "'endfacet'" });
        }
        self.facets.end_facet()
    }

    fn expect(&mut self, keyword: &str, expected: &'static str) -> Result<(), Reason> {
        let token = self.tokens.next()?;
        if is(token, keyword) { Ok(()) } else { Err(Reason::UnexpectedWord { text: quote(token), expected }) }
    }
}

fn is(token: &[u8], keyword: &str) -> bool {
    token.eq_ignore_ascii_case(keyword.as_bytes())
}

fn read_binary(bytes: &mut ByteReader<impl BufRead>, builder: SceneBuilder<'_>) -> Result<Scene, Reason> {
    bytes.array::<80>()?;
    let count = u32::from_le_bytes(bytes.array()?);
    let mut facets = Facets::new(builder);
    let mut with_attribute = 0;
    for _ in 0..count {
        // A facet has a normal, three vertices and an attribute of two bytes.
        let facet: [u8; 50] = bytes.array()?;
        facets.start_facet()?;
        for corner in facet[12..48].chunks_exact(12) {
            let mut position = [0.0; 3];
            for (x, number) in position.iter_mut().zip(corner.as_chunks().0) {
                *x = f64::from(f32::from_le_bytes(*number));
                if !x.is_finite() {
                    return Err(Reason::NonFinite { text: x.to_string() });
                }
            }
            facets.corner(position)?;
        }
        facets.end_facet()?;
        with_attribute += u64::from(facet[48..] != [0, 0]);
    }
    let rest = bytes.skip_rest()?;
    facets.builder.skipped.add_plural(with_attribute, "facets with attribute bytes");
    facets.builder.skipped.add_plural(rest, "bytes after the last facet");
    Ok(facets.builder.finish())
}
