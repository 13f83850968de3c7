//! Saved files in memory.

use super::error::LoadError;
use super::reader::Reader;
use bytemuck::Zeroable;
use memmap2::Mmap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::sync::Arc;

/// A saved file whose header and table were checked. [`checked`](Self::checked) verifies its sections as well.
#[derive(Clone)]
pub struct SavedFile(Reader);

/// A cache line: memory that is made of them has the alignment of sections.
#[derive(Clone, Copy, Zeroable, bytemuck::Pod)]
#[repr(C, align(64))]
struct CacheLine([u8; 64]);

/// Bytes that begin at a cache line.
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
    /// Maps a file into memory: pages are read on first use, and processes that map the same file share them.
    ///
    /// The file must not be modified while the mapping, or an index that was loaded from it, is in use. Otherwise
    /// answers may change, and truncation ends the program. To replace a file, write a new one and rename it, as
    /// `p2m build` does.
    ///
    /// # Errors
    /// It returns the errors of [`read`](Self::read), and [`LoadError::Io`] if the file cannot be opened or mapped.
    #[allow(unsafe_code, reason = "a file may change while it is mapped; documented")]
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let file = File::open(path)?;
        // SAFETY: the mapping is only read. The caller has to ensure that nobody modifies the file meanwhile.
        let map = unsafe { Mmap::map(&file)? };
        Ok(Self(Reader::new(Arc::new(map))?))
    }

    /// Reads a file into memory.
    ///
    /// # Errors
    /// It returns [`LoadError::Io`] if reading fails, [`LoadError::Foreign`], [`LoadError::Version`] or
    /// [`LoadError::Length`] for a wrong header, and [`LoadError::Damaged`] for a wrong table.
    pub fn read(mut reader: impl Read) -> Result<Self, LoadError> {
        let mut lines = Vec::new();
        let mut len = 0;
        loop {
            if len == lines.len() * 64 {
                lines.resize(lines.len() * 2 + 1024, CacheLine::zeroed());
            }
            match reader.read(&mut bytemuck::cast_slice_mut(&mut lines)[len..]) {
                Ok(0) => break,
                Ok(more) => len += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        lines.truncate(len.div_ceil(size_of::<CacheLine>()));
        lines.shrink_to_fit();
        Ok(Self(Reader::new(Arc::new(AlignedBytes { lines, len }))?))
    }

    /// Verifies the checksums of all sections and returns the sections.
    ///
    /// # Errors
    /// It returns [`LoadError::Damaged`] if a checksum is wrong.
    ///
    /// # Complexity
    /// It reads the whole file, at some gigabytes a second.
    pub fn checked(&self) -> Result<&Reader, LoadError> {
        self.0.check()?;
        Ok(&self.0)
    }

    /// Returns the sections without verifying their checksums, for a file that was checked before. Damaged sections
    /// give wrong answers or panics.
    #[must_use]
    pub fn unchecked(&self) -> &Reader {
        &self.0
    }
}
