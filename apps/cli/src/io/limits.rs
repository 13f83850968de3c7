//! Limits of what is read, so that a small file cannot fill the memory.

use crate::io::usage::bytes;
use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// The number of decompressed bytes from which on their ratio to the compressed bytes matters.
const RATIO_FROM_BYTES: u64 = 1 << 26;

/// The largest amounts of what is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Limits {
    /// The bytes of a line of text.
    pub(crate) line: u64,
    /// The bytes of the file of a matrix.
    pub(crate) matrix: u64,
    /// The bytes that a compressed file decompresses to.
    decompressed: u64,
    /// The decompressed bytes for each compressed one.
    ratio: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { line: 1 << 26, matrix: 1 << 20, decompressed: 1 << 36, ratio: 200 }
    }
}

impl Limits {
    /// The help of the option.
    pub(crate) const HELP: &str = "Change a limit of what is read: line=64MiB, the longest line of a text; \
        matrix=1MiB, the file of --transform; decompressed=64GiB, what a compressed file contains; ratio=200, its \
        decompressed bytes for each compressed one, from 64 MiB on";

    /// Returns the limits with changes such as `line=1GB`.
    pub(crate) fn with(changes: &[Change]) -> Self {
        let mut limits = Self::default();
        changes.iter().for_each(|change| (change.set)(&mut limits, change.value));
        limits
    }
}

/// Another value of a limit.
#[derive(Clone, Copy)]
pub(crate) struct Change {
    set: fn(&mut Limits, u64),
    value: u64,
}

impl Change {
    /// Parses a change such as `line=1GB`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').unwrap_or((text, ""));
        let set: fn(&mut Limits, u64) = match name {
            "line" => |limits, value| limits.line = value,
            "matrix" => |limits, value| limits.matrix = value,
            "decompressed" => |limits, value| limits.decompressed = value,
            "ratio" => |limits, value| limits.ratio = value,
            _ => return Err("not one of line=SIZE, matrix=SIZE, decompressed=SIZE, ratio=N".to_owned()),
        };
        bytes(value).map(|value| Self { set, value })
    }
}

/// The error of an input that is beyond a limit.
pub(crate) fn too_large(what: &str, raise: &str) -> io::Error {
    io::Error::new(io::ErrorKind::FileTooLarge, format!("{what} (--read-limit {raise}=.. raises the limit)"))
}

/// A reader that passes the numbers of bytes that are read to a function.
pub(crate) struct Counted<R, F> {
    pub(crate) reader: R,
    pub(crate) add: F,
}

impl<R: io::BufRead, F: Fn(u64)> Read for Counted<R, F> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        (self.add)(count as u64);
        Ok(count)
    }
}

impl<R: io::BufRead, F: Fn(u64)> io::BufRead for Counted<R, F> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.reader.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        (self.add)(count as u64);
        self.reader.consume(count);
    }
}

/// A reader of decompressed bytes that ends at a limit with an error.
pub(crate) struct Decompressed<R> {
    reader: R,
    limits: Limits,
    /// The number of compressed bytes that were read.
    compressed: Rc<Cell<u64>>,
    /// The number of decompressed bytes.
    count: u64,
}

impl<R> Decompressed<R> {
    pub(crate) fn new(reader: R, limits: Limits, compressed: Rc<Cell<u64>>) -> Self {
        Self { reader, limits, compressed, count: 0 }
    }
}

impl<R: Read> Read for Decompressed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        self.count += count as u64;
        let Limits { decompressed, ratio, .. } = self.limits;
        if self.count > decompressed {
            return Err(too_large(&format!("it decompresses to more than {decompressed} bytes"), "decompressed"));
        }
        if self.count > RATIO_FROM_BYTES && self.count / ratio > self.compressed.get() {
            return Err(too_large(&format!("it decompresses to more than {ratio} times its length"), "ratio"));
        }
        Ok(count)
    }
}
