//! Parser of one block of an OBJ file, which needs nothing that comes before the block.
//!
//! The basic idea is that nearly all lines of a large file are plain vertices and faces, which can be parsed in any
//! order. This module parses vertices, references to vertices and skipped statements that are on one line. Of all other
//! statements, and of lines that may be an error, it records only where they are. [`Parser`](super::Parser) then goes
//! through the blocks in order, resolves references and handles the recorded statements one by one.

use crate::Reason;
use crate::parse::text::{is_space, line_end, parse_integer, parse_number_at_start, quote};
use crate::polygon::MAX_CORNERS;
use nalgebra::Point3;

/// References with more digits are left to the sequential parser. Nine digits always fit into an i32.
const MAX_DIGITS: usize = 9;

/// The kind of a statement that creates primitives.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Polygon,
    Polyline,
    Points,
}

/// The kind of a statement, or of a run of statements on consecutive lines.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A run of vertices.
    Vertices,
    /// A statement that creates primitives from vertices.
    Shape(Shape),
    /// A run of statements `vn`, or of statements `vt`, which are skipped.
    Skipped,
    /// A statement of which only the location is recorded.
    Other,
}

#[derive(Clone, Copy)]
pub(super) struct Statement {
    pub(super) kind: Kind,
    /// The first byte of the statement in the block, which may be a blank.
    pub(super) start: u32,
    /// The first line of the statement, counted from 0 at the start of the block.
    pub(super) line: u32,
    /// The number of references, or of statements in a run.
    pub(super) count: u32,
}

#[derive(Default)]
pub(super) struct Block {
    pub(super) positions: Vec<Point3<f64>>,
    /// The references of all shapes, none of which is 0.
    pub(super) references: Vec<i32>,
    pub(super) statements: Vec<Statement>,
    /// The number of lines.
    pub(super) lines: u32,
}

/// Returns the length of the part of `bytes` up to the end of the last complete statement.
pub(super) fn cut(bytes: &[u8]) -> usize {
    let mut end = crate::parse::text::last_line_end(bytes);
    loop {
        // The line before `end`, without its end.
        let line = bytes[..end].strip_suffix(b"\n").unwrap_or(&bytes[..end]);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        if end == 0 || !line.ends_with(b"\\") {
            return end;
        }
        let start = memchr::memrchr2(b'\n', b'\r', line).map_or(0, |at| at + 1);
        if !is_continued(&line[start..]) {
            return end;
        }
        end = start;
    }
}

/// Returns whether the next line continues the statement on this line.
fn is_continued(line: &[u8]) -> bool {
    line.last() == Some(&b'\\') && memchr::memchr(b'#', line).is_none()
}

/// Parses a block, which ends with a complete statement.
#[allow(clippy::cast_possible_truncation, reason = "a block has less than 2^32 bytes")]
pub(super) fn parse(bytes: &[u8]) -> Block {
    let mut block = Block::default();
    let mut next = 0;
    while next < bytes.len() {
        let (start, line) = (next, block.lines);
        let text;
        (text, next) = line_end(bytes, start);
        block.lines += 1;
        let mut last = text;
        while is_continued(last) && next < bytes.len() {
            (last, next) = line_end(bytes, next);
            block.lines += 1;
        }
        // Lines that may be continued are not parsed here.
        let parsed = if text.last() == Some(&b'\\') { None } else { block.statement(text) };
        let (kind, count) = match parsed {
            Some(Parsed::Nothing) => continue,
            Some(Parsed::Run(kind)) => (kind, 1),
            Some(Parsed::Shape(shape, count)) => (Kind::Shape(shape), count),
            None => (Kind::Other, 1),
        };
        match block.statements.last_mut() {
            Some(run) if matches!(kind, Kind::Vertices) && run.kind == kind && run.line + run.count == line => {
                run.count += 1;
            }
            Some(run)
                if matches!(kind, Kind::Skipped)
                    && run.kind == kind
                    && keyword(&bytes[run.start as usize..]) == keyword(text) =>
            {
                run.count += 1;
            }
            _ => block.statements.push(Statement { kind, start: start as u32, line, count }),
        }
    }
    block
}

/// Returns the first two bytes of a statement after blanks.
pub(super) fn keyword(text: &[u8]) -> &[u8] {
    let text = trim_start(text);
    &text[..text.len().min(2)]
}

fn trim_start(text: &[u8]) -> &[u8] {
    &text[text.iter().take_while(|&&b| is_space(b)).count()..]
}

/// The result of parsing a statement on one line.
enum Parsed {
    Nothing,
    Run(Kind),
    /// A shape, and its number of references.
    Shape(Shape, u32),
}

impl Block {
    /// Parses a statement on one line. Returns `None`, and adds nothing, if the sequential parser has to handle it.
    fn statement(&mut self, text: &[u8]) -> Option<Parsed> {
        match trim_start(text) {
            [] | [b'#', ..] => Some(Parsed::Nothing),
            [b'v', blank, rest @ ..] if is_space(*blank) => {
                self.positions.push(position(rest)?);
                Some(Parsed::Run(Kind::Vertices))
            }
            [b'v', b'n' | b't', blank, ..] if is_space(*blank) => Some(Parsed::Run(Kind::Skipped)),
            [b'f', blank, rest @ ..] if is_space(*blank) => {
                let count = self.references(rest, 2..=MAX_CORNERS)?;
                Some(Parsed::Shape(if count == 2 { Shape::Polyline } else { Shape::Polygon }, count))
            }
            [b'l', blank, rest @ ..] if is_space(*blank) => {
                Some(Parsed::Shape(Shape::Polyline, self.references(rest, 2..=usize::MAX)?))
            }
            [b'p', blank, rest @ ..] if is_space(*blank) => {
                Some(Parsed::Shape(Shape::Points, self.references(rest, 1..=usize::MAX)?))
            }
            _ => None,
        }
    }

    /// Parses references and returns their number, or `None` if the number is not in `counts` or a reference needs the
    /// sequential parser.
    fn references(&mut self, text: &[u8], counts: std::ops::RangeInclusive<usize>) -> Option<u32> {
        let start = self.references.len();
        let mut rest = text;
        loop {
            rest = trim_start(rest);
            if rest.is_empty() {
                break;
            }
            match reference(rest) {
                Some((reference, after)) => {
                    self.references.push(reference);
                    rest = after;
                }
                None => {
                    self.references.truncate(start);
                    return None;
                }
            }
        }
        let count = self.references.len() - start;
        if !counts.contains(&count) {
            self.references.truncate(start);
            return None;
        }
        u32::try_from(count).ok()
    }
}

/// Parses the coordinates of a vertex, after which there may be further numbers but nothing else.
fn position(mut rest: &[u8]) -> Option<Point3<f64>> {
    let mut position = Point3::origin();
    for x in position.iter_mut() {
        (*x, rest) = parse_number_at_start(trim_start(rest))?;
    }
    loop {
        rest = trim_start(rest);
        if rest.is_empty() {
            return Some(position);
        }
        (_, rest) = parse_number_at_start(rest)?;
    }
}

/// Parses the reference at the start of `text`, such as `7/1/2` or `-1`, and returns it with the bytes after it.
fn reference(text: &[u8]) -> Option<(i32, &[u8])> {
    let (index, mut rest) = integer(text)?;
    for _ in 0..2 {
        let Some(part) = rest.strip_prefix(b"/") else { break };
        let is_missing = part.first().is_none_or(|&b| b == b'/' || is_space(b));
        rest = if is_missing { part } else { integer(part)?.1 };
    }
    (index != 0 && rest.first().is_none_or(|&b| is_space(b))).then_some((index, rest))
}

/// Parses the integer at the start of `text`, which may be negative and has few digits.
fn integer(text: &[u8]) -> Option<(i32, &[u8])> {
    let (sign, digits) = text.strip_prefix(b"-").map_or((1, text), |digits| (-1, digits));
    let (mut value, mut length) = (0, 0);
    while let Some(digit) = digits.get(length).map(|b| b.wrapping_sub(b'0')).filter(|&digit| digit < 10) {
        if length == MAX_DIGITS {
            return None;
        }
        value = 10 * value + i32::from(digit);
        length += 1;
    }
    (length > 0).then(|| (sign * value, &digits[length..]))
}

/// Returns the index, counted from 0, of the vertex that a reference like `7/1/2` refers to, which may be defined
/// later. `count` is the number of vertices so far.
pub(super) fn vertex_of(token: &[u8], count: usize) -> Result<u32, Reason> {
    let bad = || Reason::BadNumber { text: quote(token) };
    let mut parts = token.split(|&b| b == b'/');
    let index = parts.next().and_then(|part| parse_integer(part).ok()).ok_or_else(bad)?;
    // Texture coordinate and normal are not used, but they have to be numbers if they are present.
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
        1.. => Some(index.unsigned_abs() - 1),
        _ => count.checked_sub(index.unsigned_abs()),
    };
    vertex.and_then(|i| u32::try_from(i).ok()).ok_or(Reason::IndexOutOfRange { index, count })
}
