//! Numbers of binary files.

use crate::Reason;
use std::io::{BufRead, ErrorKind};

/// The types of numbers that files hold.
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
    /// Size in bytes.
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

/// A binary file with the offset that it is read at.
pub(crate) struct ByteReader<R> {
    reader: R,
    /// Of the number that was read last, and of the one to come.
    start: u64,
    offset: u64,
}

impl<R: BufRead> ByteReader<R> {
    /// `reader` stands at `offset`.
    pub(crate) fn new(reader: R, offset: u64) -> Self {
        Self { reader, start: offset, offset }
    }

    /// Where the number stands that was read last.
    pub(crate) fn start(&self) -> u64 {
        self.start
    }

    pub(crate) fn array<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        self.start = self.offset;
        let mut bytes = [0; N];
        self.reader.read_exact(&mut bytes).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => Reason::UnexpectedEnd,
            _ => Reason::Io(e),
        })?;
        self.offset += N as u64;
        Ok(bytes)
    }

    fn ordered<const N: usize>(&mut self, big_endian: bool) -> Result<[u8; N], Reason> {
        let mut bytes = self.array()?;
        if big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// The number of double precision that is nearest; all but large integers of 64 bits are exact.
    #[allow(clippy::cast_precision_loss, reason = "documented")]
    pub(crate) fn number(&mut self, scalar: Scalar, big_endian: bool) -> Result<f64, Reason> {
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

    /// Passes over so many bytes.
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

    /// Passes over the rest of the file; how many bytes there are.
    pub(crate) fn rest(&mut self) -> Result<u64, Reason> {
        self.start = self.offset;
        let mut rest = 0;
        loop {
            match self.discard(u64::MAX)? {
                0 => return Ok(rest),
                passed => rest += passed,
            }
        }
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
