//! Sections by their names.

use super::array::FileBytes;
use super::{Array, LoadError, VERSION};
use bytemuck::{AnyBitPattern, NoUninit, Pod, Zeroable};
use std::io::{self, Write};
use twox_hash::XxHash3_64;

const MAGIC: [u8; 8] = *b"\x89P2M\r\n\x1a\n";
/// Sections begin at multiples of this: a cache line.
const ALIGNMENT: usize = 64;
const NAME: usize = 32;

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Head {
    magic: [u8; 8],
    version: u32,
    sections: u32,
    length: u64,
    sum: u64,
    free: [u64; 4],
}

const _: () = assert!(size_of::<Head>() == ALIGNMENT);

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Entry {
    name: [u8; NAME],
    offset: u64,
    count: u64,
    size: u64,
    sum: u64,
}

const _: () = assert!(size_of::<Entry>() == ALIGNMENT);

impl Entry {
    fn name(&self) -> String {
        String::from_utf8_lossy(&self.name).trim_end_matches('\0').to_owned()
    }

    /// Where the section is, if that is within some length.
    fn part(&self, length: u64) -> Option<std::ops::Range<usize>> {
        let end = self.count.checked_mul(self.size)?.checked_add(self.offset)?;
        if end > length {
            return None;
        }
        Some(usize::try_from(self.offset).ok()?..usize::try_from(end).ok()?)
    }
}

/// Collects the sections of a file. Large arrays are not copied until it is written.
#[derive(Default)]
pub struct Writer<'a> {
    sections: Vec<(String, Bytes<'a>, usize)>,
}

enum Bytes<'a> {
    Lent(&'a [u8]),
    Own(Vec<u8>),
}

impl Bytes<'_> {
    fn get(&self) -> &[u8] {
        match self {
            Self::Lent(bytes) => bytes,
            Self::Own(bytes) => bytes,
        }
    }
}

impl<'a> Writer<'a> {
    /// Adds an array under a name of at most 32 bytes, which no other section has.
    ///
    /// # Panics
    /// For a name that is longer, or there already.
    pub fn put<T: NoUninit>(&mut self, name: &str, elements: &'a [T]) {
        self.add(name, Bytes::Lent(bytemuck::cast_slice(elements)), size_of::<T>());
    }

    /// The same for what does not last.
    ///
    /// # Panics
    /// The same.
    pub fn put_copy<T: NoUninit>(&mut self, name: &str, elements: &[T]) {
        self.add(name, Bytes::Own(bytemuck::cast_slice(elements).to_vec()), size_of::<T>());
    }

    /// Whether there is a section of that name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.sections.iter().any(|own| own.0 == name)
    }

    fn add(&mut self, name: &str, bytes: Bytes<'a>, size: usize) {
        assert!(name.len() <= NAME && !self.has(name), "the section {name} is there already, or its name too long");
        self.sections.push((name.to_owned(), bytes, size));
    }

    /// Writes the file.
    ///
    /// # Errors
    /// Those of `writer`; [`io::ErrorKind::Unsupported`] on a processor that is not little-endian.
    pub fn write(&self, mut writer: impl Write) -> io::Result<()> {
        if cfg!(target_endian = "big") {
            return Err(io::Error::new(io::ErrorKind::Unsupported, LoadError::BigEndian));
        }
        let mut end = ALIGNMENT * (1 + self.sections.len());
        let mut table = Vec::with_capacity(self.sections.len());
        for (name, bytes, size) in &self.sections {
            let bytes = bytes.get();
            let mut entry = Entry { size: *size as u64, sum: sum(bytes), offset: end as u64, ..Entry::zeroed() };
            entry.name[..name.len()].copy_from_slice(name.as_bytes());
            entry.count = (bytes.len() / (*size).max(1)) as u64;
            end += bytes.len().next_multiple_of(ALIGNMENT);
            table.push(entry);
        }
        let table: &[u8] = bytemuck::cast_slice(&table);
        let sections = u32::try_from(self.sections.len()).map_err(io::Error::other)?;
        let head = Head { magic: MAGIC, version: VERSION, sections, length: end as u64, sum: sum(table), free: [0; 4] };
        writer.write_all(bytemuck::bytes_of(&head))?;
        writer.write_all(table)?;
        for (_, bytes, _) in &self.sections {
            let bytes = bytes.get();
            writer.write_all(bytes)?;
            writer.write_all(&[0; ALIGNMENT][..bytes.len().next_multiple_of(ALIGNMENT) - bytes.len()])?;
        }
        writer.flush()
    }
}

fn sum(bytes: &[u8]) -> u64 {
    XxHash3_64::oneshot(bytes)
}

/// The sections of a file in memory.
#[derive(Clone)]
pub struct Reader {
    file: FileBytes,
    table: Vec<Entry>,
}

impl Reader {
    /// Looks at the head and the table.
    pub(super) fn new(file: FileBytes) -> Result<Self, LoadError> {
        if cfg!(target_endian = "big") {
            return Err(LoadError::BigEndian);
        }
        let bytes = (*file).as_ref();
        let found = bytes.len() as u64;
        let head = bytes.get(..size_of::<Head>()).map(bytemuck::pod_read_unaligned::<Head>);
        let start = &bytes[..bytes.len().min(MAGIC.len())];
        let head = match head {
            _ if start != MAGIC => return Err(LoadError::Foreign),
            None => return Err(LoadError::Length { found, expected: size_of::<Head>() as u64 }),
            Some(head) => head,
        };
        if head.version != VERSION {
            return Err(LoadError::Version { found: head.version });
        }
        if head.length != found {
            return Err(LoadError::Length { found, expected: head.length });
        }
        let damaged = || LoadError::Damaged { section: "the table of sections".to_owned() };
        let table_bytes = usize::try_from(head.sections).ok().and_then(|n| n.checked_mul(size_of::<Entry>()));
        let table = table_bytes.and_then(|n| bytes[size_of::<Head>()..].get(..n)).ok_or_else(damaged)?;
        if sum(table) != head.sum {
            return Err(damaged());
        }
        let table: Vec<Entry> = table.chunks_exact(size_of::<Entry>()).map(bytemuck::pod_read_unaligned).collect();
        if table.iter().any(|entry| entry.part(found).is_none()) {
            return Err(damaged());
        }
        Ok(Self { file, table })
    }

    /// Checks the sums of all sections, in memory order.
    pub(super) fn check(&self) -> Result<(), LoadError> {
        let bytes = (*self.file).as_ref();
        let wrong = |entry: &&Entry| entry.part(bytes.len() as u64).is_none_or(|part| sum(&bytes[part]) != entry.sum);
        match self.table.iter().find(wrong) {
            Some(entry) => Err(LoadError::Damaged { section: entry.name() }),
            None => Ok(()),
        }
    }

    /// The names of all sections with their bytes.
    pub fn sections(&self) -> impl Iterator<Item = (String, u64)> + '_ {
        self.table.iter().map(|entry| (entry.name(), entry.count * entry.size))
    }

    /// Whether there is a section of that name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.table.iter().any(|entry| entry.name() == name)
    }

    /// A section, where it is.
    pub fn array<T: AnyBitPattern>(&self, name: &str) -> Result<Array<T>, LoadError> {
        let missing = || LoadError::Missing { section: name.to_owned() };
        let entry = self.table.iter().find(|entry| entry.name() == name).ok_or_else(missing)?;
        let part = entry.part((*self.file).as_ref().len() as u64).filter(|_| entry.size == size_of::<T>() as u64);
        part.and_then(|part| Array::of_file(&self.file, part)).ok_or_else(missing)
    }

    /// A copy of a section.
    ///
    /// # Errors
    /// [`LoadError::Missing`].
    pub fn copy<T: AnyBitPattern>(&self, name: &str) -> Result<Vec<T>, LoadError> {
        Ok(self.array(name)?.to_vec())
    }

    /// A section of one element.
    ///
    /// # Errors
    /// [`LoadError::Missing`] and [`LoadError::Inconsistent`].
    pub fn one<T: AnyBitPattern>(&self, name: &str) -> Result<T, LoadError> {
        match *self.array::<T>(name)? {
            [one] => Ok(one),
            _ => Err(LoadError::Inconsistent { section: name.to_owned() }),
        }
    }
}
