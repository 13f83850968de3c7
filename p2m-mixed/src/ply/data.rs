//! The numbers after the header of a PLY file, in any encoding.

use super::header::{Encoding, Header, Layout};
use crate::bytes::{ByteReader, Scalar};
use crate::text::{LineReader, Tokenizer, parse_integer, parse_number, quote};
use crate::{FileLocation, ReadError, Reason};
use std::io::BufRead;

/// Reads one number of a PLY file after the other.
pub(super) struct Data<'n, R> {
    file: &'n str,
    source: Source<R>,
}

enum Source<R> {
    /// Numbers of text are read as a stream of tokens, because some writers spread an element over several lines.
    Text(Tokenizer<R>),
    Binary {
        bytes: ByteReader<R>,
        big_endian: bool,
    },
}

impl<'n, R: BufRead> Data<'n, R> {
    /// `reader` is positioned after `header`.
    pub(super) fn new(reader: R, header: &Header, file: &'n str) -> Self {
        let source = match header.encoding {
            Encoding::Ascii => Source::Text(Tokenizer::new(LineReader::new(reader, header.lines))),
            encoding => {
                Source::Binary { bytes: ByteReader::new(reader, header.bytes), big_endian: encoding == Encoding::Big }
            }
        };
        Self { file, source }
    }

    /// Returns the location of the number that was read last.
    pub(super) fn location(&self) -> FileLocation {
        match &self.source {
            Source::Text(tokens) => FileLocation::Line(tokens.line()),
            Source::Binary { bytes, .. } => FileLocation::Byte(bytes.start()),
        }
    }

    /// Returns the name of the file.
    pub(super) fn file(&self) -> &'n str {
        self.file
    }

    /// Returns an error for this reason, located at the number that was read last.
    pub(super) fn error(&self, reason: Reason) -> ReadError {
        ReadError::new(self.file, self.location(), reason)
    }

    /// Checks that nothing follows an element on its line of a text. Otherwise the header declares too few numbers, and
    /// the rest of the line would be read as the next element.
    pub(super) fn end_element(&mut self) -> Result<(), ReadError> {
        if let Source::Text(tokens) = &mut self.source
            && let Some(token) = tokens.next_on_line()
        {
            let text = quote(token);
            return Err(self.error(Reason::ExtraWord { text }));
        }
        Ok(())
    }

    /// Reads a coordinate, which need not be finite.
    pub(super) fn coordinate(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        let value = match &mut self.source {
            Source::Text(tokens) => tokens.next().and_then(|token| {
                if scalar.is_integer() {
                    parse_integer(token)?; // numbers that are not integers are an error
                }
                parse_number(token)
            }),
            Source::Binary { bytes, big_endian } => bytes.number(scalar, *big_endian),
        };
        value.map_err(|reason| self.error(reason))
    }

    /// Reads an integer. `scalar` has to be an integer type.
    #[allow(clippy::cast_possible_truncation, reason = "integers of up to 32 bits are exact in f64")]
    pub(super) fn integer(&mut self, scalar: Scalar) -> Result<i64, ReadError> {
        let value = match &mut self.source {
            Source::Text(tokens) => tokens.next().and_then(parse_integer),
            Source::Binary { bytes, big_endian } => bytes.number(scalar, *big_endian).map(|x| x as i64),
        };
        value.map_err(|reason| self.error(reason))
    }

    /// Reads the length of a list.
    pub(super) fn count(&mut self, scalar: Scalar) -> Result<u64, ReadError> {
        let count = self.integer(scalar)?;
        u64::try_from(count).map_err(|_| self.error(Reason::BadListCount { count }))
    }

    /// Skips a property.
    pub(super) fn skip(&mut self, layout: Layout) -> Result<(), ReadError> {
        let (numbers, scalar) = match layout {
            Layout::Scalar(scalar) => (1, scalar),
            Layout::List { count, item } => (self.count(count)?, item),
        };
        let skipped = match &mut self.source {
            Source::Text(tokens) => (0..numbers).try_for_each(|_| tokens.next().map(|_| ())),
            // The product does not overflow, because the longest list of a binary file has 2^32 - 1 items of 8 bytes.
            Source::Binary { bytes, .. } => bytes.skip(numbers * scalar.size() as u64),
        };
        skipped.map_err(|reason| self.error(reason))
    }

    /// Skips the rest of the file. Returns its number of bytes (binary) or words (text), and their description.
    pub(super) fn rest(mut self) -> Result<(u64, &'static str), ReadError> {
        let rest = match &mut self.source {
            Source::Binary { bytes, .. } => bytes.skip_rest().map(|rest| (rest, "bytes after the last element")),
            Source::Text(tokens) => {
                let mut rest = 0;
                loop {
                    match tokens.next() {
                        Ok(_) => rest += 1,
                        Err(Reason::UnexpectedEnd) => break Ok((rest, "words after the last element")),
                        Err(reason) => break Err(reason),
                    }
                }
            }
        };
        rest.map_err(|reason| self.error(reason))
    }
}
