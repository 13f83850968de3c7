//! Buffered bytes, and a reader of the numbers in binary files.

use crate::Reason;
use std::io::{self, BufRead, ErrorKind};

/// Returns the buffered bytes of `reader`, which are empty only at the end of the text.
pub(crate) fn fill_buffer(reader: &mut impl BufRead) -> io::Result<&[u8]> {
    loop {
        match reader.fill_buf() {
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
            Ok(_) => break,
        }
    }
    reader.fill_buf() // the buffer is borrowed again, because a borrow cannot leave the loop
}

/// The types of numbers in binary files.
#[allow(missing_docs, reason = "the names of variants are those of Rust")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The types, with their sizes in bytes and their names in NumPy arrays and in PLY files. PLY has no 64-bit integers,
/// but some programs write them.
const SCALARS: [(Scalar, usize, [&str; 3]); 10] = [
    (Scalar::I8, 1, ["i1", "char", "int8"]),
    (Scalar::U8, 1, ["u1", "uchar", "uint8"]),
    (Scalar::I16, 2, ["i2", "short", "int16"]),
    (Scalar::U16, 2, ["u2", "ushort", "uint16"]),
    (Scalar::I32, 4, ["i4", "int", "int32"]),
    (Scalar::U32, 4, ["u4", "uint", "uint32"]),
    (Scalar::I64, 8, ["i8", "int64", "int64"]),
    (Scalar::U64, 8, ["u8", "uint64", "uint64"]),
    (Scalar::F32, 4, ["f4", "float", "float32"]),
    (Scalar::F64, 8, ["f8", "double", "float64"]),
];

impl Scalar {
    /// Returns the type with this name in arrays of NumPy, without the order of bytes.
    #[must_use]
    pub fn of_npy(name: &[u8]) -> Option<Self> {
        SCALARS.iter().find(|(.., names)| names[0].as_bytes() == name).map(|(scalar, ..)| *scalar)
    }

    /// Returns the type with this name in PLY files.
    pub(crate) fn of_ply(name: &[u8]) -> Option<Self> {
        SCALARS.iter().find(|(.., names)| names[1..].iter().any(|n| n.as_bytes() == name)).map(|(scalar, ..)| *scalar)
    }

    /// Returns the size in bytes.
    #[must_use]
    pub fn size(self) -> usize {
        SCALARS[self as usize].1
    }

    pub(crate) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Returns the little-endian number at the start of `bytes`, or `None` if they are too few.
    #[must_use]
    pub fn number(self, mut bytes: &[u8]) -> Option<f64> {
        Bytes::number(&mut bytes, self, false).ok()
    }
}

/// A source of the numbers in binary files.
pub(crate) trait Bytes {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Reason>;

    fn ordered<const N: usize>(&mut self, big_endian: bool) -> Result<[u8; N], Reason> {
        let mut bytes = self.array()?;
        if big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Reads a number and rounds it to double precision. Only large 64-bit integers change.
    #[inline]
    #[allow(clippy::cast_precision_loss, reason = "documented")]
    fn number(&mut self, scalar: Scalar, big_endian: bool) -> Result<f64, Reason> {
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.array()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.array()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.ordered(big_endian)?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.ordered(big_endian)?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.ordered(big_endian)?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.ordered(big_endian)?)),
            Scalar::I64 => i64::from_le_bytes(self.ordered(big_endian)?) as f64,
            Scalar::U64 => u64::from_le_bytes(self.ordered(big_endian)?) as f64,
            Scalar::F32 => f64::from(f32::from_le_bytes(self.ordered(big_endian)?)),
            Scalar::F64 => f64::from_le_bytes(self.ordered(big_endian)?),
        })
    }
}

impl Bytes for &[u8] {
    #[inline]
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let (array, rest) = self.split_first_chunk().ok_or(Reason::UnexpectedEnd)?;
        *self = rest;
        Ok(*array)
    }
}

/// Reads numbers from a binary file and knows the offset of each.
pub(crate) struct ByteReader<R> {
    reader: R,
    /// The offset of the number that was read last.
    start: u64,
    /// The offset of the next byte.
    offset: u64,
}

impl<R: BufRead> Bytes for ByteReader<R> {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        self.start = self.offset;
        let mut bytes = [0; N];
        self.reader.read_exact(&mut bytes).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => Reason::UnexpectedEnd,
            _ => Reason::Io(e),
        })?;
        self.offset += N as u64;
        Ok(bytes)
    }
}

impl<R: BufRead> ByteReader<R> {
    /// `offset` is the current position of `reader` in the file.
    pub(crate) fn new(reader: R, offset: u64) -> Self {
        Self { reader, start: offset, offset }
    }

    /// Returns the offset of the number that was read last.
    pub(crate) fn start(&self) -> u64 {
        self.start
    }

    /// Returns the reader, for reading blocks of bytes.
    pub(crate) fn blocks(&mut self) -> &mut R {
        &mut self.reader
    }

    /// Notes that bytes were read from [`Self::blocks`].
    pub(crate) fn skip_blocks(&mut self, bytes: u64) {
        self.offset += bytes;
    }

    /// Returns the offset of the next byte.
    pub(crate) fn offset(&self) -> u64 {
        self.offset
    }

    /// Skips this number of bytes.
    pub(crate) fn skip(&mut self, bytes: u64) -> Result<(), Reason> {
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

    /// Skips the rest of the file and returns its number of bytes.
    pub(crate) fn skip_rest(&mut self) -> Result<u64, Reason> {
        self.start = self.offset;
        let mut rest = 0;
        loop {
            match self.discard(u64::MAX)? {
                0 => return Ok(rest),
                passed => rest += passed,
            }
        }
    }

    /// Skips buffered bytes, at most `max_count`, and returns their number, which is 0 at the end of the file.
    fn discard(&mut self, max_count: u64) -> Result<u64, Reason> {
        let bytes = fill_buffer(&mut self.reader).map_err(Reason::Io)?;
        let passed = bytes.len().min(usize::try_from(max_count).unwrap_or(usize::MAX));
        self.reader.consume(passed);
        self.offset += passed as u64;
        Ok(passed as u64)
    }
}
