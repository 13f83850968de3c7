//! Parallel reader of the rows of a PLY element, where a row is a member of an element.
//!
//! The basic idea: a block of the file is parsed optimistically, on any thread. Text is parsed as if each row was on a
//! line of its own, and parsing stops at the first row that is invalid or unusual. The caller then hands the rest of
//! the file, from that row on, to the sequential reader, which either reads the row or reports the error with its exact
//! location. So this module needs no error messages.

use super::data::{Data, Encoded, Numbers, Start, parse_coordinate};
use super::header::{Layout, Property};
use crate::parse::blocks::{Source, for_each_block};
use crate::parse::bytes::{Bytes, Scalar};
use crate::parse::text::{Tokens, last_line_end, line_end, parse_integer};
use crate::{ReadError, Reason};
use std::io::BufRead;

/// A function that reads a row, which is a member of an element, in any encoding.
pub(super) trait ReadRow<T>: Sync {
    fn read<N: Numbers>(&self, numbers: &mut N, parsed: &mut T) -> Result<(), N::Error>;
}

/// The error of a row that the sequential reader has to read, to find the location and the reason of a possible error.
#[derive(Debug)]
pub(super) struct Unusual;

/// Reads the rows of a block up to the first one that is left to the sequential reader. Returns what was read, and the
/// end of each row by `position`.
fn read_all<T: Default, N: Numbers>(
    mut rows: N,
    len: usize,
    position: impl Fn(&N) -> usize,
    read_row: &impl ReadRow<T>,
) -> (T, Vec<usize>) {
    let (mut parsed, mut ends) = (T::default(), Vec::new());
    while position(&rows) < len && read_row.read(&mut rows, &mut parsed).is_ok() {
        ends.push(position(&rows));
    }
    (parsed, ends)
}

/// The rows of a text, each of which is on one line.
struct LineRows<'a> {
    bytes: &'a [u8],
    /// The start of the next line.
    next: usize,
    line: Tokens<'a>,
    /// Whether no number of the current row was read yet.
    is_start: bool,
}

impl<'a> LineRows<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, next: 0, line: Tokens::new(&[]), is_start: true }
    }

    fn token(&mut self) -> Result<&'a [u8], Unusual> {
        loop {
            if let Some(token) = self.line.next() {
                self.is_start = false;
                return Ok(token);
            }
            if !self.is_start || self.next == self.bytes.len() {
                return Err(Unusual);
            }
            let line;
            (line, self.next) = line_end(self.bytes, self.next);
            self.line = Tokens::new(line);
        }
    }
}

impl Numbers for LineRows<'_> {
    type Error = Unusual;

    fn error(&self, _: impl FnOnce() -> Reason) -> Unusual {
        Unusual
    }

    fn end_element(&mut self) -> Result<(), Unusual> {
        self.is_start = true;
        if self.line.next().is_none() { Ok(()) } else { Err(Unusual) }
    }

    fn coordinate(&mut self, scalar: Scalar) -> Result<f64, Unusual> {
        parse_coordinate(self.token()?, scalar).map_err(|_| Unusual)
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, Unusual> {
        parse_integer(self.token()?).map_err(|_| Unusual)
    }

    fn skip_numbers(&mut self, count: u64, _: Scalar) -> Result<(), Unusual> {
        (0..count).try_for_each(|_| self.token().map(|_| ()))
    }
}

/// The rows of a block of binary numbers.
struct ByteRows<'a> {
    /// The bytes that were not read yet.
    rest: &'a [u8],
    big_endian: bool,
}

impl Numbers for ByteRows<'_> {
    type Error = Unusual;

    fn error(&self, _: impl FnOnce() -> Reason) -> Unusual {
        Unusual
    }

    fn end_element(&mut self) -> Result<(), Unusual> {
        Ok(())
    }

    fn coordinate(&mut self, scalar: Scalar) -> Result<f64, Unusual> {
        self.rest.number(scalar, self.big_endian).map_err(|_| Unusual)
    }

    #[allow(clippy::cast_possible_truncation, reason = "integers of up to 32 bits are exact in f64")]
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Unusual> {
        self.coordinate(scalar).map(|x| x as i64)
    }

    fn skip_numbers(&mut self, count: u64, scalar: Scalar) -> Result<(), Unusual> {
        let bytes = count.checked_mul(scalar.size() as u64).and_then(|bytes| usize::try_from(bytes).ok());
        self.rest = bytes.and_then(|bytes| self.rest.get(bytes..)).ok_or(Unusual)?;
        Ok(())
    }
}

/// The rows that were read from a block, before the first row that has to be left to the sequential reader.
pub(super) struct Rows<'a, T> {
    /// The values of the rows.
    pub(super) parsed: T,
    /// The number of rows that are wanted.
    pub(super) count: usize,
    /// The end of each row in the block.
    ends: Vec<usize>,
    start: Start,
    bytes: &'a [u8],
}

impl<T> Rows<'_, T> {
    /// Returns an error located at a row. It reads the row again with `read_row` to find the location.
    pub(super) fn error(&self, file: &str, row: usize, reason: Reason, read_row: &impl ReadRow<T>) -> ReadError
    where
        T: Default,
    {
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        let mut data = Data::at(self.start.after(&self.bytes[..start]), &self.bytes[start..], file);
        let _ = read_row.read(&mut data, &mut T::default());
        data.error(|| reason)
    }
}

impl<R: BufRead> Data<'_, Source<R>> {
    /// Reads at most `count` rows of an element in blocks, and returns how many were read. The sequential reader has to
    /// read the other rows.
    ///
    /// `read_row` parses a row, and `add` adds the rows of a block.
    pub(super) fn read_rows<T: Default + Send>(
        &mut self,
        properties: &[Property],
        count: u64,
        read_row: &impl ReadRow<T>,
        mut add: impl FnMut(Rows<'_, T>) -> Result<(), ReadError>,
    ) -> Result<u64, ReadError> {
        let (source, start) = match &mut self.source {
            Encoded::Text(tokens) => match tokens.blocks() {
                Some((source, lines)) => (source, Start::Line(lines)),
                None => return Ok(0),
            },
            Encoded::Binary { bytes, big_endian } => {
                let start = Start::Byte { offset: bytes.offset(), big_endian: *big_endian };
                (bytes.blocks(), start)
            }
        };
        if !source.has_blocks_of(count) {
            return Ok(0);
        }
        let mut uncut = count;
        let cut = |bytes: &[u8]| match start {
            Start::Line(_) => Some(last_line_end(bytes)),
            Start::Byte { big_endian, .. } if uncut > 0 => Some(cut_rows(bytes, properties, big_endian, &mut uncut)),
            Start::Byte { .. } => None,
        };
        let parse = |bytes: &[u8]| match start {
            Start::Line(_) => read_all(LineRows::new(bytes), bytes.len(), |rows| rows.next, read_row),
            Start::Byte { big_endian, .. } => {
                let rows = ByteRows { rest: bytes, big_endian };
                read_all(rows, bytes.len(), |rows| bytes.len() - rows.rest.len(), read_row)
            }
        };
        let mut next = start;
        let mut left = count;
        let mut passed = 0;
        let added = for_each_block(source, cut, parse, |bytes, (parsed, ends)| {
            let wanted = ends.len().min(usize::try_from(left).unwrap_or(usize::MAX));
            let used = wanted.checked_sub(1).map_or(0, |last| ends[last]);
            add(Rows { parsed, count: wanted, ends, start: next, bytes })?;
            next = next.after(&bytes[..used]);
            passed += used as u64;
            left -= wanted as u64;
            Ok((left == 0 || used < bytes.len()).then_some(used))
        });
        match (&mut self.source, start, next) {
            (Encoded::Text(tokens), Start::Line(from), Start::Line(to)) => tokens.lines.skip_lines(to - from, passed),
            (Encoded::Binary { bytes, .. }, ..) => bytes.skip_blocks(passed),
            _ => {}
        }
        added.map(|()| count - left)
    }
}

/// Returns the length of the complete rows in `bytes`, at most `count` of them, and subtracts their number from
/// `count`.
fn cut_rows(bytes: &[u8], properties: &[Property], big_endian: bool, count: &mut u64) -> usize {
    let scalar_size = |p: &Property| match p.layout {
        Layout::Scalar(scalar) => Some(scalar.size() as u64),
        Layout::List { .. } => None,
    };
    if let Some(size) = properties.iter().map(scalar_size).sum::<Option<u64>>().filter(|&size| size > 0) {
        let rows = (bytes.len() as u64 / size).min(*count);
        *count -= rows;
        return usize::try_from(rows * size).unwrap_or(0);
    }
    let mut end = 0;
    let mut data = ByteRows { rest: bytes, big_endian };
    while *count > 0 && properties.iter().all(|property| data.skip(property.layout).is_ok()) {
        end = bytes.len() - data.rest.len();
        *count -= 1;
        if end == bytes.len() {
            break;
        }
    }
    end
}
