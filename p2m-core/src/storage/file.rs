//! Saved files in memory.

use super::{LoadError, Reader};
use bytemuck::Zeroable;
use memmap2::Mmap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::sync::Arc;

/// A saved file whose head and table are right. Its sections are used once their sums were checked.
#[derive(Clone)]
pub struct SavedFile(Reader);

/// A cache line, to begin where sections have to.
#[derive(Clone, Copy, Zeroable, bytemuck::Pod)]
#[repr(C, align(64))]
struct Line([u8; 64]);

/// Bytes that begin at a cache line.
struct Lines {
    lines: Vec<Line>,
    len: usize,
}

impl AsRef<[u8]> for Lines {
    fn as_ref(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.lines)[..self.len]
    }
}

impl SavedFile {
    /// Maps a file: it is read as it is used, and processes that map the same file share its memory.
    ///
    /// The file must not change while it, or an index that was loaded from it, is in use: answers would change as well,
    /// and a part that is cut off ends the program. Where files are replaced, write a new one and rename it, as `p2m
    /// build` does.
    ///
    /// # Errors
    /// [`LoadError::Io`], and what [`read`](Self::read) says.
    #[allow(unsafe_code, reason = "a file may change while it is mapped; documented")]
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let file = File::open(path)?;
        // SAFETY: the mapping is only read. That nobody changes the file meanwhile is left to whoever names it.
        let map = unsafe { Mmap::map(&file)? };
        Ok(Self(Reader::new(Arc::new(map))?))
    }

    /// Reads a file into memory.
    ///
    /// # Errors
    /// [`LoadError::Io`], [`LoadError::Foreign`], [`LoadError::Version`], [`LoadError::Length`], and
    /// [`LoadError::Damaged`] for the table.
    pub fn read(mut reader: impl Read) -> Result<Self, LoadError> {
        let mut lines = Vec::new();
        let mut len = 0;
        loop {
            if len == lines.len() * 64 {
                lines.resize(lines.len() * 2 + 1024, Line::zeroed());
            }
            match reader.read(&mut bytemuck::cast_slice_mut(&mut lines)[len..]) {
                Ok(0) => break,
                Ok(more) => len += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        lines.truncate(len.div_ceil(size_of::<Line>()));
        lines.shrink_to_fit();
        Ok(Self(Reader::new(Arc::new(Lines { lines, len }))?))
    }

    /// Its sections, after their sums were checked.
    ///
    /// # Errors
    /// [`LoadError::Damaged`].
    ///
    /// # Complexity
    /// Reads the whole file, at some gigabytes a second.
    pub fn checked(&self) -> Result<&Reader, LoadError> {
        self.0.check()?;
        Ok(&self.0)
    }

    /// Its sections without a check of their sums, for a file that was checked before: what is damaged gives wrong
    /// answers or panics.
    #[must_use]
    pub fn unchecked(&self) -> &Reader {
        &self.0
    }
}
