//! The header of a file and the entries of its table of sections.

use bytemuck::{Pod, Zeroable};
use twox_hash::XxHash3_64;

/// The version of the format that is written, and the only one that can be read.
pub const VERSION: u32 = 1;
/// The first bytes of every file.
pub(super) const MAGIC: [u8; 8] = *b"\x89P2M\r\n\x1a\n";
/// The alignment of sections in bytes, a cache line.
pub(super) const ALIGNMENT: usize = 64;
/// The maximum length of the name of a section, in bytes.
pub(super) const MAX_NAME_BYTES: usize = 32;

/// The header of a file.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Header {
    pub(super) magic: [u8; 8],
    pub(super) version: u32,
    /// The number of sections.
    pub(super) sections: u32,
    /// The number of bytes of the file.
    pub(super) length: u64,
    /// The checksum of the table.
    pub(super) checksum: u64,
    /// Reserved for later versions; zero.
    pub(super) unused: [u64; 4],
}

const _: () = assert!(size_of::<Header>() == ALIGNMENT);

/// An entry of the table of sections.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Entry {
    /// The name, padded with zeros.
    pub(super) name: [u8; MAX_NAME_BYTES],
    /// The position of the section in the file, in bytes.
    pub(super) offset: u64,
    /// The number of elements.
    pub(super) count: u64,
    /// The number of bytes of an element.
    pub(super) size: u64,
    /// The checksum of the section.
    pub(super) checksum: u64,
}

const _: () = assert!(size_of::<Entry>() == ALIGNMENT);

impl Entry {
    pub(super) fn name(&self) -> String {
        String::from_utf8_lossy(&self.name).trim_end_matches('\0').to_owned()
    }

    /// Returns the bytes of the section in a file of `length` bytes, or `None` if they exceed it.
    pub(super) fn range(&self, length: u64) -> Option<std::ops::Range<usize>> {
        let end = self.count.checked_mul(self.size)?.checked_add(self.offset)?;
        if end > length {
            return None;
        }
        Some(usize::try_from(self.offset).ok()?..usize::try_from(end).ok()?)
    }
}

/// Returns the XXH3 checksum of some bytes.
pub(super) fn checksum(bytes: &[u8]) -> u64 {
    XxHash3_64::oneshot(bytes)
}
