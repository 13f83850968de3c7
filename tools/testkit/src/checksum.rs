//! Checksums of E57 files.

/// The number of bytes of a page without its checksum.
const PAGE: usize = 1020;

/// Corrects the checksums of all pages, so that damage in a file reaches the code behind the checksums.
pub fn restore_e57_checksums(file: &mut [u8]) {
    for page in file.chunks_exact_mut(PAGE + 4) {
        let (data, checksum) = page.split_at_mut(PAGE);
        // The CRC-32C, one bit at a time.
        let step = |crc: u32| (crc >> 1) ^ (0x82f6_3b78 & 0u32.wrapping_sub(crc & 1));
        let crc = data.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)));
        checksum.copy_from_slice(&(!crc).to_be_bytes());
    }
}
