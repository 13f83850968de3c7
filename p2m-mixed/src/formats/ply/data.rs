//! The numbers after the header of a PLY file, in any encoding.

use super::header::{Encoding, Header, Layout};
use crate::parse::bytes::{ByteReader, Bytes, Scalar};
use crate::parse::text::{LineReader, count_lines, parse_integer, parse_number, quote};
use crate::parse::tokenizer::Tokenizer;
use crate::{FileLocation, ReadError, Reason};
use std::io::BufRead;

/// The numbers of the members of elements, one after the other.
pub(super) trait Numbers {
    type Error;

    /// Returns an error for this reason, located at the number that was read last.
    fn error(&self, reason: impl FnOnce() -> Reason) -> Self::Error;

    /// Returns the location of the number that was read last, if it is known.
    fn location(&self) -> FileLocation {
        FileLocation::File
    }

    /// Checks that nothing follows an element on its line of text. Otherwise the header declares too few numbers, and
    /// the rest of the line would be read as the next element.
    fn end_element(&mut self) -> Result<(), Self::Error>;

    /// Reads a coordinate, which need not be finite.
    fn coordinate(&mut self, scalar: Scalar) -> Result<f64, Self::Error>;

    /// Reads an integer. `scalar` has to be an integer type.
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Self::Error>;

    /// Skips `count` numbers of a type.
    fn skip_numbers(&mut self, count: u64, scalar: Scalar) -> Result<(), Self::Error>;

    /// Reads the length of a list.
    fn count(&mut self, scalar: Scalar) -> Result<u64, Self::Error> {
        let count = self.integer(scalar)?;
        u64::try_from(count).map_err(|_| self.error(|| Reason::BadListCount { count }))
    }

    /// Skips a property.
    fn skip(&mut self, layout: Layout) -> Result<(), Self::Error> {
        match layout {
            Layout::Scalar(scalar) => self.skip_numbers(1, scalar),
            Layout::List { count, item } => {
                let count = self.count(count)?;
                self.skip_numbers(count, item)
            }
        }
    }
}

/// Parses a coordinate of a text, which need not be finite.
pub(super) fn parse_coordinate(token: &[u8], scalar: Scalar) -> Result<f64, Reason> {
    if scalar.is_integer() {
        parse_integer(token)?; // numbers that are not integers are an error
    }
    parse_number(token)
}

/// The position of a row, and its encoding.
#[derive(Clone, Copy)]
pub(super) enum Start {
    /// The number of lines before a row of text.
    Line(u64),
    /// The number of bytes before a binary row.
    Byte { offset: u64, big_endian: bool },
}

impl Start {
    /// Returns the position after `bytes`, which are complete rows.
    pub(super) fn after(self, bytes: &[u8]) -> Self {
        match self {
            Self::Line(lines) => Self::Line(lines + count_lines(bytes)),
            Self::Byte { offset, big_endian } => Self::Byte { offset: offset + bytes.len() as u64, big_endian },
        }
    }
}

/// Reads the numbers of a PLY file sequentially.
pub(super) struct Data<'n, R> {
    pub(super) file: &'n str,
    pub(super) source: Encoded<R>,
}

pub(super) enum Encoded<R> {
    /// Numbers as text. They are read as a stream of tokens, because some writers spread an element over several lines.
    Text(Tokenizer<R>),
    Binary {
        bytes: ByteReader<R>,
        big_endian: bool,
    },
}

impl<'n, R: BufRead> Data<'n, R> {
    /// `reader` is positioned after `header`.
    pub(super) fn new(reader: R, header: &Header, file: &'n str) -> Self {
        let start = match header.encoding {
            Encoding::Ascii => Start::Line(header.lines),
            encoding => Start::Byte { offset: header.bytes, big_endian: encoding == Encoding::Big },
        };
        Self::at(start, reader, file)
    }

    /// `reader` is positioned at the start of a row.
    pub(super) fn at(start: Start, reader: R, file: &'n str) -> Self {
        let source = match start {
            Start::Line(lines_before) => Encoded::Text(Tokenizer::new(LineReader::new(reader, lines_before))),
            Start::Byte { offset, big_endian } => {
                Encoded::Binary { bytes: ByteReader::new(reader, offset), big_endian }
            }
        };
        Self { file, source }
    }

    /// Skips the rest of the file. Returns its number of bytes (binary) or words (text), and their description.
    pub(super) fn rest(mut self) -> Result<(u64, &'static str), ReadError> {
        let rest = match &mut self.source {
            Encoded::Binary { bytes, .. } => bytes.skip_rest().map(|rest| (rest, "bytes after the last element")),
            Encoded::Text(tokens) => tokens.skip_rest().map(|rest| (rest, "words after the last element")),
        };
        rest.map_err(|reason| self.error(|| reason))
    }
}

impl<R: BufRead> Numbers for Data<'_, R> {
    type Error = ReadError;

    fn error(&self, reason: impl FnOnce() -> Reason) -> ReadError {
        ReadError::new(self.file, self.location(), reason())
    }

    fn location(&self) -> FileLocation {
        match &self.source {
            Encoded::Text(tokens) => FileLocation::Line(tokens.line()),
            Encoded::Binary { bytes, .. } => FileLocation::Byte(bytes.start()),
        }
    }

    fn end_element(&mut self) -> Result<(), ReadError> {
        if let Encoded::Text(tokens) = &mut self.source
            && let Some(token) = tokens.next_on_line()
        {
            let text = quote(token);
            return Err(self.error(|| Reason::ExtraWord { text }));
        }
        Ok(())
    }

    fn coordinate(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        let value = match &mut self.source {
            Encoded::Text(tokens) => tokens.next().and_then(|token| parse_coordinate(token, scalar)),
            Encoded::Binary { bytes, big_endian } => bytes.number(scalar, *big_endian),
        };
        value.map_err(|reason| self.error(|| reason))
    }

    #[allow(clippy::cast_possible_truncation, reason = "integers of up to 32 bits are exact in f64")]
    fn integer(&mut self, scalar: Scalar) -> Result<i64, ReadError> {
        let value = match &mut self.source {
            Encoded::Text(tokens) => tokens.next().and_then(parse_integer),
            Encoded::Binary { bytes, big_endian } => bytes.number(scalar, *big_endian).map(|x| x as i64),
        };
        value.map_err(|reason| self.error(|| reason))
    }

    fn skip_numbers(&mut self, count: u64, scalar: Scalar) -> Result<(), ReadError> {
        let skipped = match &mut self.source {
            Encoded::Text(tokens) => (0..count).try_for_each(|_| tokens.next().map(|_| ())),
            // The product does not overflow, because the longest list of a binary file has 2^32 - 1 items of 8 bytes.
            Encoded::Binary { bytes, .. } => bytes.skip(count * scalar.size() as u64),
        };
        skipped.map_err(|reason| self.error(|| reason))
    }
}
