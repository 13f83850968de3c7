//! The header of a PLY file, which declares the elements and their properties.

use crate::parse::bytes::{Scalar, fill_buffer};
use crate::parse::text::{Tokens, parse_integer, quote, read_until};
use crate::{FileLocation, HeaderProblem, ReadError, Reason};
use memchr::{memchr, memchr2};
use std::collections::HashSet;
use std::io::{self, BufRead};

/// The longest line of a header in bytes. A file of other data may have no line ends at all.
const MAX_LINE_BYTES: usize = 1 << 16;

/// The encoding of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The layout of a property: one number, or a list of numbers after its count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: Vec<u8>,
    pub(super) layout: Layout,
    /// The type in the words of the header, which messages quote.
    pub(super) declared: String,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: Vec<u8>,
    /// The number of members that the header announces.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Returns the index of the first property with one of these names.
    pub(super) fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.iter().any(|n| p.name.eq_ignore_ascii_case(n.as_bytes())))
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The number of lines of the header.
    pub(super) lines: u64,
    /// The number of bytes of the header.
    pub(super) bytes: u64,
}

/// Reads the header up to the end of the line `end_header`.
pub(super) fn read_header(reader: &mut impl BufRead, file: &str) -> Result<Header, ReadError> {
    let mut header = Header { encoding: Encoding::Ascii, elements: Vec::new(), lines: 0, bytes: 0 };
    let mut parser = Parser::default();
    let mut line = Vec::new();
    let mut end = None;
    loop {
        line.clear();
        let read = match end {
            Some(end) => read_until(reader, |bytes| memchr(end, bytes), MAX_LINE_BYTES, &mut line),
            None => first_line(reader, &mut line).map(|found| {
                end = Some(found);
                line.len()
            }),
        };
        header.lines += 1;
        let fail = |reason| Err(ReadError::new(file, FileLocation::Line(header.lines), reason));
        match read {
            Err(e) => return fail(Reason::Io(e)),
            Ok(read) => header.bytes += read as u64,
        }
        if header.lines == 1 {
            // Some editors write the byte order mark of UTF-8.
            let text = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line);
            if text.trim_ascii_end() != b"ply" {
                return fail(Reason::BadHeader(HeaderProblem::NotPly));
            }
            continue;
        }
        if line.last().copied() != end {
            let too_long = line.len() == MAX_LINE_BYTES;
            let reason = if too_long { Reason::BadHeader(HeaderProblem::LineTooLong) } else { Reason::UnexpectedEnd };
            return fail(reason);
        }
        match parser.line(&line, &mut header.elements) {
            Err(reason) => return fail(reason),
            Ok(false) => {}
            Ok(true) => {
                header.encoding = match parser.encoding {
                    Some(encoding) => encoding,
                    None => return fail(Reason::BadHeader(HeaderProblem::NoFormat)),
                };
                return Ok(header);
            }
        }
    }
}

/// Reads the first line, and returns the byte that ends all lines of the header.
///
/// That byte is `\n`, also in `\r\n`, unless the first line ends at `\r` alone. The first line decides, because the
/// last line is ambiguous: the byte after `end_header` and `\r` may be a `\n`, or the number 10 as the first byte
/// of the data.
fn first_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<u8> {
    read_until(reader, |bytes| memchr2(b'\n', b'\r', bytes), MAX_LINE_BYTES, line)?;
    if line.last() != Some(&b'\r') {
        return Ok(b'\n');
    }
    if fill_buffer(reader)?.first() != Some(&b'\n') {
        return Ok(b'\r');
    }
    reader.consume(1);
    line.push(b'\n');
    Ok(b'\n')
}

/// The declarations that were parsed so far.
#[derive(Default)]
struct Parser {
    encoding: Option<Encoding>,
    element_names: HashSet<Vec<u8>>,
    /// The names of the properties of the last element.
    property_names: HashSet<Vec<u8>>,
}

impl Parser {
    /// Parses a line and returns whether it ends the header.
    fn line(&mut self, line: &[u8], elements: &mut Vec<Element>) -> Result<bool, Reason> {
        let bad_line = || Reason::BadHeader(HeaderProblem::BadLine { text: quote(line.trim_ascii()) });
        let mut tokens = Tokens::new(line);
        match tokens.next() {
            None | Some(b"comment" | b"obj_info") => return Ok(false),
            Some(b"end_header") => return Ok(true),
            Some(b"format") => {
                let encoding = match (tokens.next(), tokens.next()) {
                    (Some(b"ascii"), Some(b"1.0")) => Encoding::Ascii,
                    (Some(b"binary_little_endian"), Some(b"1.0")) => Encoding::Little,
                    (Some(b"binary_big_endian"), Some(b"1.0")) => Encoding::Big,
                    _ => {
                        let text = line.trim_ascii().strip_prefix(b"format").unwrap_or(line);
                        return Err(Reason::UnsupportedFormat { text: quote(text.trim_ascii()) });
                    }
                };
                if self.encoding.replace(encoding).is_some() {
                    return Err(bad_line());
                }
            }
            Some(b"element") => {
                let (Some(name), Some(count)) = (tokens.next(), tokens.next()) else { return Err(bad_line()) };
                let count = parse_integer(count).ok().and_then(|c| u64::try_from(c).ok()).ok_or_else(bad_line)?;
                if !self.element_names.insert(name.to_vec()) {
                    return Err(duplicate(name));
                }
                self.property_names.clear();
                elements.push(Element { name: name.to_vec(), count, properties: Vec::new() });
            }
            Some(b"property") => {
                let element = elements.last_mut().ok_or_else(bad_line)?;
                let property = property(&mut tokens).ok_or_else(bad_line)??;
                if !self.property_names.insert(property.name.clone()) {
                    return Err(duplicate(&property.name));
                }
                element.properties.push(property);
            }
            Some(_) => return Err(bad_line()),
        }
        // A further token means that the line is not the declaration that it seems to be.
        if tokens.next().is_some() { Err(bad_line()) } else { Ok(false) }
    }
}

fn duplicate(name: &[u8]) -> Reason {
    Reason::BadHeader(HeaderProblem::Duplicate { name: quote(name) })
}

/// Parses the tokens after `property`. Returns `None` if there are too few.
fn property(tokens: &mut Tokens<'_>) -> Option<Result<Property, Reason>> {
    let first = tokens.next()?;
    let (layout, name, declared) = if first == b"list" {
        let (count, item, name) = (tokens.next()?, tokens.next()?, tokens.next()?);
        let declared = format!("list {} {}", quote(count), quote(item));
        let count = Scalar::of_ply(count).filter(|s| s.is_integer());
        (count.zip(Scalar::of_ply(item)).map(|(count, item)| Layout::List { count, item }), name, declared)
    } else {
        (Scalar::of_ply(first).map(Layout::Scalar), tokens.next()?, quote(first))
    };
    Some(match layout {
        Some(layout) => Ok(Property { name: name.to_vec(), layout, declared }),
        None => Err(Reason::BadHeader(HeaderProblem::BadType { name: quote(name), declared })),
    })
}
