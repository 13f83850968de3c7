//! Saved files in memory.

use super::error::LoadError;
use super::reader::{Reader, check_header};
use bytemuck::Zeroable;
use memmap2::Mmap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::sync::Arc;

/// A saved file whose header and table have been checked. [`checked`](Self::checked) verifies its sections as well.
#[derive(Clone)]
pub struct SavedFile(Reader);

/// A cache line. Memory that is allocated as cache lines has the alignment that sections need.
#[derive(Clone, Copy, Zeroable, bytemuck::Pod)]
#[repr(C, align(64))]
struct CacheLine([u8; 64]);

/// The number of bytes of a cache line.
const LINE_BYTES: usize = size_of::<CacheLine>();
/// The least growth of the buffer for a file of unknown length, in cache lines: 16 KiB in all.
const FIRST_LINES: usize = 1 << 8;

/// Bytes that are aligned to a cache line.
struct AlignedBytes {
    lines: Vec<CacheLine>,
    len: usize,
}

impl AsRef<[u8]> for AlignedBytes {
    fn as_ref(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.lines)[..self.len]
    }
}

impl SavedFile {
    /// Reads the file at a path into memory.
    ///
    /// # Errors
    /// It returns the errors of [`read`](Self::read), and [`LoadError::Io`] if the file cannot be opened.
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Self::read_with_length(file, length)
    }

    /// Maps the file at a path into memory. Pages are read on first use, and processes that map the same file share
    /// them.
    ///
    /// # Safety
    /// Nobody may change or truncate the file while the mapping, or an index that was loaded from it, is in use. A
    /// change is a data race, whatever was checked before, and truncation terminates the program. To replace a file,
    /// write a new one and rename it, as `p2m build` does.
    ///
    /// # Errors
    /// It returns the errors of [`read`](Self::read), and [`LoadError::Io`] if the file cannot be opened or mapped.
    #[allow(unsafe_code, reason = "a file may change while it is mapped; the caller has to prevent that")]
    pub unsafe fn map(path: &Path) -> Result<Self, LoadError> {
        let file = File::open(path)?;
        // SAFETY: the mapping is only read, and the caller ensures that nobody modifies the file meanwhile.
        let map = unsafe { Mmap::map(&file)? };
        Ok(Self(Reader::new(Arc::new(map))?))
    }

    /// Reads a file into memory: the header, and then as many bytes as the header announces. Input without a header of
    /// the right version is refused before more of it is read.
    ///
    /// # Errors
    /// It returns [`LoadError::Io`] if reading fails, [`LoadError::Foreign`], [`LoadError::Version`] or
    /// [`LoadError::Length`] for a wrong header, and [`LoadError::Damaged`] for a wrong table.
    pub fn read(reader: impl Read) -> Result<Self, LoadError> {
        Self::read_with_length(reader, 0)
    }

    /// Reads a file into memory as [`read`](Self::read) does, given its expected length, for instance the length of the
    /// file on disk. The length may be wrong. If the header announces at most `length` bytes, the memory is allocated
    /// at once, which is several times faster than a buffer that grows.
    ///
    /// # Errors
    /// It returns the errors of [`read`](Self::read).
    pub fn read_with_length(mut reader: impl Read, length: u64) -> Result<Self, LoadError> {
        let mut lines = vec![CacheLine::zeroed()];
        let mut len = read_until_full(&mut reader, bytemuck::cast_slice_mut(&mut lines))?;
        let expected = check_header(&bytemuck::cast_slice(&lines)[..len])?.length;
        // The announced length may be wrong, so beyond `length` the memory only grows with the bytes that were read.
        while (len as u64) < expected && len == size_of_val(&lines[..]) {
            let wanted = usize::try_from(expected.div_ceil(LINE_BYTES as u64)).unwrap_or(usize::MAX);
            let is_there = expected <= length;
            let room = if is_there { wanted } else { wanted.min(lines.len() * 2 + FIRST_LINES) };
            lines.reserve_exact(room - lines.len());
            lines.resize(room, CacheLine::zeroed());
            len += read_until_full(&mut reader, &mut bytemuck::cast_slice_mut(&mut lines)[len..])?;
        }
        // A file that is longer than announced is refused after one more byte.
        let mut one = [0];
        if len as u64 >= expected && read_until_full(&mut reader, &mut one)? > 0 {
            return Err(LoadError::Length { found: expected.saturating_add(1), expected });
        }
        lines.truncate(len.div_ceil(LINE_BYTES));
        lines.shrink_to_fit();
        Ok(Self(Reader::new(Arc::new(AlignedBytes { lines, len }))?))
    }

    /// Returns the checksum of the table. The table has the checksums of all sections, so this identifies the whole
    /// content.
    #[must_use]
    pub fn checksum(&self) -> u64 {
        self.0.table_checksum()
    }

    /// Verifies the checksums of all sections and returns the sections.
    ///
    /// # Errors
    /// It returns [`LoadError::Damaged`] if a checksum is wrong.
    ///
    /// # Complexity
    /// It reads the whole file, at a few gigabytes per second.
    pub fn checked(&self) -> Result<&Reader, LoadError> {
        self.0.check()?;
        Ok(&self.0)
    }

    /// Returns the sections without verifying their checksums, for a file that was checked before. An index that is
    /// loaded from damaged sections neither panics nor searches without end, but its answers may be wrong.
    #[must_use]
    pub fn unchecked(&self) -> &Reader {
        &self.0
    }
}

/// Reads until a buffer is full or the input ends, and returns the number of bytes that were read.
fn read_until_full(reader: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut len = 0;
    while len < buffer.len() {
        match reader.read(&mut buffer[len..]) {
            Ok(0) => break,
            Ok(more) => len += more,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(len)
}
