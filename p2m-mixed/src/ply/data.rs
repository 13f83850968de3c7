//! The numbers behind the header of a PLY file, in any of its encodings.

use super::header::{Encoding, Header, Layout, Scalar};
use crate::text::{Lines, Words, integer, is_space, number, quote};
use crate::{Place, ReadError, Reason};
use std::io::{BufRead, ErrorKind};

/// Hands out one number after the other.
pub(super) struct Data<'n, R> {
    file: &'n str,
    source: Source<R>,
}

enum Source<R> {
    Text(Text<R>),
    Binary(Binary<R>),
}

struct Text<R> {
    lines: Lines<R>,
    /// Where the rest of the line begins.
    at: usize,
}

struct Binary<R> {
    reader: R,
    big_endian: bool,
    /// Of the number that was read last, and of the one to come.
    start: u64,
    offset: u64,
}

impl<'n, R: BufRead> Data<'n, R> {
    /// `reader` stands behind `header`.
    pub(super) fn new(reader: R, header: &Header, file: &'n str) -> Self {
        let source = match header.encoding {
            Encoding::Ascii => Source::Text(Text { lines: Lines::new(reader, header.lines), at: 0 }),
            encoding => {
                let big_endian = encoding == Encoding::Big;
                Source::Binary(Binary { reader, big_endian, start: header.bytes, offset: header.bytes })
            }
        };
        Self { file, source }
    }

    /// Where the number stands that was read last.
    pub(super) fn place(&self) -> Place {
        match &self.source {
            Source::Text(text) => Place::Line(text.lines.line()),
            Source::Binary(binary) => Place::Byte(binary.start),
        }
    }

    /// The error that `reason` makes at the number that was read last.
    pub(super) fn error(&self, reason: Reason) -> ReadError {
        ReadError::new(self.file, self.place(), reason)
    }

    /// Checks that nothing follows an element on its line of a text. Otherwise the header declares fewer numbers than
    /// there are, and what follows would be read as something that it is not.
    pub(super) fn end_element(&self) -> Result<(), ReadError> {
        if let Source::Text(text) = &self.source
            && let Some(word) = Words::new(&text.lines.bytes()[text.at..]).next()
        {
            return Err(self.error(Reason::ExtraWord { text: quote(word) }));
        }
        Ok(())
    }

    /// A coordinate, finite or not.
    pub(super) fn coordinate(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        let value = match &mut self.source {
            Source::Text(text) => text.word().and_then(|word| {
                if scalar.is_integer() {
                    integer(word)?; // refuses what is a number, but no integer
                }
                number(word)
            }),
            Source::Binary(binary) => binary.number(scalar),
        };
        value.map_err(|reason| self.error(reason))
    }

    /// An integer; `scalar` is of an integer type.
    #[allow(clippy::cast_possible_truncation, reason = "integers of up to 32 bits are exact in f64")]
    pub(super) fn integer(&mut self, scalar: Scalar) -> Result<i64, ReadError> {
        let value = match &mut self.source {
            Source::Text(text) => text.word().and_then(integer),
            Source::Binary(binary) => binary.number(scalar).map(|x| x as i64),
        };
        value.map_err(|reason| self.error(reason))
    }

    /// The length of a list.
    pub(super) fn count(&mut self, scalar: Scalar) -> Result<u64, ReadError> {
        let count = self.integer(scalar)?;
        u64::try_from(count).map_err(|_| self.error(Reason::BadListCount { count }))
    }

    /// Passes over a property.
    pub(super) fn skip(&mut self, layout: Layout) -> Result<(), ReadError> {
        let (numbers, scalar) = match layout {
            Layout::Scalar(scalar) => (1, scalar),
            Layout::List { count, item } => (self.count(count)?, item),
        };
        let skipped = match &mut self.source {
            Source::Text(text) => (0..numbers).try_for_each(|_| text.word().map(|_| ())),
            // No overflow: the longest list of a binary file has 2^32 - 1 items of 8 bytes.
            Source::Binary(binary) => binary.skip(numbers * scalar.size() as u64),
        };
        skipped.map_err(|reason| self.error(reason))
    }

    /// Reads to the end of the file; how many bytes (binary) or words (text) there are, and what they are called.
    pub(super) fn rest(mut self) -> Result<(u64, &'static str), ReadError> {
        let what = match &self.source {
            Source::Text(_) => "words after the last element",
            Source::Binary(_) => "bytes after the last element",
        };
        let mut rest = 0u64;
        loop {
            let more = match &mut self.source {
                Source::Text(text) => match text.word() {
                    Ok(_) => 1,
                    Err(Reason::UnexpectedEnd) => 0,
                    Err(reason) => return Err(self.error(reason)),
                },
                Source::Binary(binary) => match binary.discard(u64::MAX) {
                    Ok(more) => more,
                    Err(reason) => return Err(self.error(reason)),
                },
            };
            if more == 0 {
                return Ok((rest, what));
            }
            rest += more;
        }
    }
}

impl<R: BufRead> Text<R> {
    /// The next word, on this line or further down: not every writer keeps an element on its line.
    fn word(&mut self) -> Result<&[u8], Reason> {
        loop {
            let bytes = self.lines.bytes();
            let start = self.at + bytes[self.at..].iter().take_while(|&&b| is_space(b)).count();
            if start < bytes.len() {
                let end = start + bytes[start..].iter().take_while(|&&b| !is_space(b)).count();
                self.at = end;
                return Ok(&self.lines.bytes()[start..end]);
            }
            self.at = 0;
            if !self.lines.read().map_err(Reason::Io)? {
                return Err(Reason::UnexpectedEnd);
            }
        }
    }
}

impl<R: BufRead> Binary<R> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        self.start = self.offset;
        let mut bytes = [0; N];
        self.reader.read_exact(&mut bytes).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => Reason::UnexpectedEnd,
            _ => Reason::Io(e),
        })?;
        self.offset += N as u64;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Every number of a PLY file is one of double precision.
    fn number(&mut self, scalar: Scalar) -> Result<f64, Reason> {
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    fn skip(&mut self, bytes: u64) -> Result<(), Reason> {
        self.start = self.offset;
        let mut left = bytes;
        while left > 0 {
            match self.discard(left)? {
                0 => return Err(Reason::UnexpectedEnd),
                passed => left -= passed,
            }
        }
        Ok(())
    }

    /// Passes over what is at hand, up to `most` bytes; 0 at the end of the file.
    fn discard(&mut self, most: u64) -> Result<u64, Reason> {
        loop {
            match self.reader.fill_buf() {
                Ok(buffer) => {
                    let passed = buffer.len().min(usize::try_from(most).unwrap_or(usize::MAX));
                    self.reader.consume(passed);
                    self.offset += passed as u64;
                    return Ok(passed as u64);
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(Reason::Io(e)),
            }
        }
    }
}
