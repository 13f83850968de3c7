//! Writing sections to a file.

use super::error::LoadError;
use super::section::{ALIGNMENT, Entry, Header, MAGIC, MAX_NAME_BYTES, VERSION, checksum};
use bytemuck::{NoUninit, Zeroable};
use std::borrow::Cow;
use std::io::{self, Write};

/// A collector of the sections of a file. Large arrays are borrowed until the file is written.
#[derive(Default)]
pub struct Writer<'a> {
    /// The name, the bytes and the bytes of an element of each section.
    sections: Vec<(String, Cow<'a, [u8]>, usize)>,
}

impl<'a> Writer<'a> {
    /// Adds a section with a borrowed array. Its name has at most 32 bytes.
    ///
    /// # Panics
    /// It panics if the name is longer, or if there is already a section with this name.
    pub fn put<T: NoUninit>(&mut self, name: &str, elements: &'a [T]) {
        self.add(name, Cow::Borrowed(bytemuck::cast_slice(elements)), size_of::<T>());
    }

    /// Adds a section with a copy of an array. Its name has at most 32 bytes.
    ///
    /// # Panics
    /// It panics if the name is longer, or if there is already a section with this name.
    pub fn put_copy<T: NoUninit>(&mut self, name: &str, elements: &[T]) {
        self.add(name, Cow::Owned(bytemuck::cast_slice(elements).to_vec()), size_of::<T>());
    }

    /// Returns whether there is a section with this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.sections.iter().any(|section| section.0 == name)
    }

    fn add(&mut self, name: &str, bytes: Cow<'a, [u8]>, size: usize) {
        assert!(
            name.len() <= MAX_NAME_BYTES && !self.has(name),
            "the section {name} is there already, or its name too long"
        );
        self.sections.push((name.to_owned(), bytes, size));
    }

    /// Returns the checksum that [`SavedFile::checksum`](super::SavedFile::checksum) will return for the file.
    ///
    /// # Complexity
    /// It reads all sections, as [`write`](Self::write) does.
    #[must_use]
    pub fn checksum(&self) -> u64 {
        checksum(bytemuck::cast_slice(&self.table().0))
    }

    /// Returns the table of the sections and the length of the file.
    fn table(&self) -> (Vec<Entry>, usize) {
        let mut end = ALIGNMENT * (1 + self.sections.len());
        let mut table = Vec::with_capacity(self.sections.len());
        for (name, bytes, size) in &self.sections {
            let mut entry =
                Entry { size: *size as u64, checksum: checksum(bytes), offset: end as u64, ..Entry::zeroed() };
            entry.name[..name.len()].copy_from_slice(name.as_bytes());
            entry.count = (bytes.len() / (*size).max(1)) as u64;
            end += bytes.len().next_multiple_of(ALIGNMENT);
            table.push(entry);
        }
        (table, end)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// It returns the errors of `writer`, and [`io::ErrorKind::Unsupported`] on a processor that is not little-endian.
    pub fn write(&self, mut writer: impl Write) -> io::Result<()> {
        if cfg!(target_endian = "big") {
            return Err(io::Error::new(io::ErrorKind::Unsupported, LoadError::BigEndian));
        }
        let (table, end) = self.table();
        let table: &[u8] = bytemuck::cast_slice(&table);
        let sections = u32::try_from(self.sections.len()).map_err(io::Error::other)?;
        let header = Header {
            magic: MAGIC,
            version: VERSION,
            sections,
            length: end as u64,
            checksum: checksum(table),
            unused: [0; 4],
        };
        writer.write_all(bytemuck::bytes_of(&header))?;
        writer.write_all(table)?;
        for (_, bytes, _) in &self.sections {
            writer.write_all(bytes)?;
            writer.write_all(&[0; ALIGNMENT][..bytes.len().next_multiple_of(ALIGNMENT) - bytes.len()])?;
        }
        writer.flush()
    }
}
