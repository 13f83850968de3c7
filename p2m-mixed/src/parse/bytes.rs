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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
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

impl Scalar {
    /// Returns the size in bytes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    pub(crate) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// A source of the numbers in binary files.
pub(crate) trait Bytes {
    type Error;

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Self::Error>;

    fn ordered<const N: usize>(&mut self, big_endian: bool) -> Result<[u8; N], Self::Error> {
        let mut bytes = self.array()?;
        if big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Reads a number and rounds it to double precision. Only large integers of 64 bits are not exact.
    #[inline]
    #[allow(clippy::cast_precision_loss, reason = "documented")]
    fn number(&mut self, scalar: Scalar, big_endian: bool) -> Result<f64, Self::Error> {
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

/// Reads numbers from a binary file and knows the offset of each.
pub(crate) struct ByteReader<R> {
    reader: R,
    /// The offset of the number that was read last.
    start: u64,
    /// The offset of the next byte.
    offset: u64,
}

impl<R: BufRead> Bytes for ByteReader<R> {
    type Error = Reason;

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
