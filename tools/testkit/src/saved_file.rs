//! Changes to files of saved indexes on purpose. The layout, which p2m-core/src/storage documents, is implemented here
//! a second time, so that a test can put wrong contents into a file with correct checksums.

use std::ops::Range;
use twox_hash::XxHash3_64;

/// The number of bytes of the header, and of an entry of the table.
pub const HEADER_BYTES: usize = 64;

/// Returns the number in eight bytes at an offset, if the file has them.
fn number(bytes: &[u8], at: usize) -> Option<usize> {
    usize::try_from(u64::from_le_bytes(bytes.get(at..)?.get(..8)?.try_into().ok()?)).ok()
}

/// Returns the offsets of the entries of the table, as far as the file has them.
pub fn entries(bytes: &[u8]) -> impl Iterator<Item = usize> + use<> {
    let announced = bytes.get(12..16).map_or(0, |n| u32::from_le_bytes(n.try_into().expect("four")) as usize);
    let max_entries = (bytes.len() / HEADER_BYTES).saturating_sub(1);
    (0..announced.min(max_entries)).map(|i| HEADER_BYTES * (1 + i))
}

/// Returns the range of an entry's section, if the file has it.
#[must_use]
pub fn section(bytes: &[u8], entry: usize) -> Option<Range<usize>> {
    let [offset, count, size] = [32, 40, 48].map(|k| number(bytes, entry + k));
    let end = offset?.checked_add(count?.checked_mul(size?)?)?;
    (end <= bytes.len()).then_some(offset?..end)
}

/// Returns the bytes of the section with this name.
///
/// # Panics
/// Panics if the file has no such section.
pub fn section_mut<'a>(bytes: &'a mut [u8], name: &str) -> &'a mut [u8] {
    let has_name = |entry: &usize| bytes[*entry..entry + 32].split(|b| *b == 0).next() == Some(name.as_bytes());
    let entry = entries(bytes).find(has_name).unwrap_or_else(|| panic!("no section {name}"));
    let range = section(bytes, entry).expect("within the file");
    &mut bytes[range]
}

/// Corrects the fields that detect damage, which are the length and all checksums.
pub fn correct_checksums(bytes: &mut [u8]) {
    let all: Vec<usize> = entries(bytes).collect();
    for entry in &all {
        if let Some(section) = section(bytes, *entry) {
            let sum = XxHash3_64::oneshot(&bytes[section]);
            bytes[entry + 56..entry + 64].copy_from_slice(&sum.to_le_bytes());
        }
    }
    if bytes.len() < HEADER_BYTES {
        return;
    }
    let sum = XxHash3_64::oneshot(&bytes[HEADER_BYTES..HEADER_BYTES * (1 + all.len())]);
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..32].copy_from_slice(&sum.to_le_bytes());
}
