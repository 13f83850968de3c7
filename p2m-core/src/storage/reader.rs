//! Reading sections from a file in memory.

use super::array::{Array, FileBytes};
use super::error::LoadError;
use super::section::{ALIGNMENT, Entry, Header, MAGIC, VERSION, checksum};
use bytemuck::AnyBitPattern;

/// The sections of a file in memory, by name.
#[derive(Clone)]
pub struct Reader {
    file: FileBytes,
    table: Vec<Entry>,
}

impl Reader {
    /// Creates the reader of a file after checking the header and the table.
    pub(super) fn new(file: FileBytes) -> Result<Self, LoadError> {
        if cfg!(target_endian = "big") {
            return Err(LoadError::BigEndian);
        }
        let bytes = (*file).as_ref();
        let found = bytes.len() as u64;
        let header = check_header(bytes)?;
        if header.length != found {
            return Err(LoadError::Length { found, expected: header.length });
        }
        let damaged = || LoadError::Damaged { section: "the table of sections".to_owned() };
        let table_bytes = usize::try_from(header.sections).ok().and_then(|n| n.checked_mul(size_of::<Entry>()));
        let table = table_bytes.and_then(|n| bytes[size_of::<Header>()..].get(..n)).ok_or_else(damaged)?;
        if checksum(table) != header.checksum {
            return Err(damaged());
        }
        let table: Vec<Entry> = table.chunks_exact(size_of::<Entry>()).map(bytemuck::pod_read_unaligned).collect();
        if table.iter().any(|entry| entry.range(found).is_none()) {
            return Err(damaged());
        }
        let gaps = gaps(&table, bytes.len()).ok_or_else(damaged)?;
        if gaps.into_iter().any(|gap| bytes[gap].iter().any(|byte| *byte != 0)) {
            return Err(LoadError::inconsistent("the gaps between sections", "unused bytes are not zero"));
        }
        Ok(Self { file, table })
    }

    /// Returns the checksum of the table, which is also in the header.
    pub(super) fn table_checksum(&self) -> u64 {
        checksum(bytemuck::cast_slice(&self.table))
    }

    /// Verifies the checksums of all sections, in the order of the file.
    pub(super) fn check(&self) -> Result<(), LoadError> {
        let bytes = (*self.file).as_ref();
        let wrong = |entry: &&Entry| {
            entry.range(bytes.len() as u64).is_none_or(|range| checksum(&bytes[range]) != entry.checksum)
        };
        match self.table.iter().find(wrong) {
            Some(entry) => Err(LoadError::Damaged { section: entry.name() }),
            None => Ok(()),
        }
    }

    /// Returns the names and the numbers of bytes of all sections.
    pub fn sections(&self) -> impl Iterator<Item = (String, u64)> + '_ {
        self.table.iter().map(|entry| (entry.name(), entry.count * entry.size))
    }

    /// Returns whether there is a section with this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.table.iter().any(|entry| entry.name() == name)
    }

    /// Returns a section without copying it.
    ///
    /// # Errors
    /// It returns [`LoadError::Missing`] if there is no such section, or its elements are not of type `T`.
    pub fn array<T: AnyBitPattern>(&self, name: &str) -> Result<Array<T>, LoadError> {
        let missing = || LoadError::Missing { section: name.to_owned() };
        let entry = self.table.iter().find(|entry| entry.name() == name).ok_or_else(missing)?;
        let range = entry.range((*self.file).as_ref().len() as u64).filter(|_| entry.size == size_of::<T>() as u64);
        range.and_then(|range| Array::from_file(&self.file, range)).ok_or_else(missing)
    }

    /// Returns a copy of a section.
    ///
    /// # Errors
    /// It returns [`LoadError::Missing`] if there is no such section, or its elements are not of type `T`.
    pub fn copy<T: AnyBitPattern>(&self, name: &str) -> Result<Vec<T>, LoadError> {
        Ok(self.array(name)?.to_vec())
    }

    /// Returns the element of a section with one element.
    ///
    /// # Errors
    /// It returns [`LoadError::Missing`] if there is no such section, or its elements are not of type `T`, and
    /// [`LoadError::Inconsistent`] if the number of elements is not 1.
    pub fn one<T: AnyBitPattern>(&self, name: &str) -> Result<T, LoadError> {
        match *self.array::<T>(name)? {
            [one] => Ok(one),
            _ => Err(LoadError::inconsistent(name, "there is more or less than one element")),
        }
    }
}

/// Checks and returns the header of a file.
pub(super) fn check_header(bytes: &[u8]) -> Result<Header, LoadError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(LoadError::Foreign);
    }
    let short = LoadError::Length { found: bytes.len() as u64, expected: size_of::<Header>() as u64 };
    let header: Header = bytes.get(..size_of::<Header>()).map(bytemuck::pod_read_unaligned).ok_or(short)?;
    if header.version != VERSION {
        return Err(LoadError::Version { found: header.version });
    }
    if header.unused != [0; 4] {
        return Err(LoadError::inconsistent("the header", "unused bytes are not zero"));
    }
    Ok(header)
}

/// Returns the bytes of a file that belong to no section. It is `None` if the sections are not in the order of the
/// file, overlap, or leave more than a cache line unused.
fn gaps(table: &[Entry], length: usize) -> Option<Vec<std::ops::Range<usize>>> {
    let mut end = size_of::<Header>() + size_of_val(table);
    let starts = table.iter().map(|entry| entry.range(length as u64)).chain([Some(length..length)]);
    let gap = |range: Option<std::ops::Range<usize>>| {
        let range = range?;
        let gap = std::mem::replace(&mut end, range.end)..range.start;
        (gap.start <= gap.end && gap.end - gap.start < ALIGNMENT).then_some(gap)
    };
    starts.map(gap).collect()
}
