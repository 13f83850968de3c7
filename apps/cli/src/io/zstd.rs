//! Reads what zstd has compressed: any number of frames, one after the other.

use ruzstd::decoding::{FrameDecoder, StreamingDecoder};
use std::io::{self, BufRead, Read};

/// The first bytes of a frame of data.
const FRAME_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// The first bytes of a frame that readers skip, but for the lower half of the first byte.
const SKIPPABLE_MAGIC: [u8; 4] = [0x50, 0x2a, 0x4d, 0x18];

/// Returns whether a file that begins with these bytes was compressed by zstd.
pub(crate) fn is_zstd(start: &[u8]) -> bool {
    start.starts_with(&FRAME_MAGIC) || is_skippable(start)
}

fn is_skippable(start: &[u8]) -> bool {
    start.get(..4).is_some_and(|magic| magic[0] & 0xf0 == SKIPPABLE_MAGIC[0] && magic[1..] == SKIPPABLE_MAGIC[1..])
}

/// A reader of decompressed bytes.
pub(crate) struct ZstdReader<R: Read> {
    /// The source, while no frame is open.
    source: Option<R>,
    frame: Option<StreamingDecoder<R, FrameDecoder>>,
}

impl<R: BufRead> ZstdReader<R> {
    pub(crate) fn new(source: R) -> Self {
        Self { source: Some(source), frame: None }
    }

    /// Opens the next frame of data. Returns `false` at the end of the source.
    fn open_frame(&mut self, mut source: R) -> io::Result<bool> {
        loop {
            let start = source.fill_buf()?;
            if start.is_empty() {
                self.source = Some(source);
                return Ok(false);
            }
            if !is_skippable(start) {
                self.frame = Some(StreamingDecoder::new(source).map_err(|_| damaged())?);
                return Ok(true);
            }
            let mut head = [0; 8];
            source.read_exact(&mut head)?;
            let length = u64::from(u32::from_le_bytes([head[4], head[5], head[6], head[7]]));
            if io::copy(&mut source.by_ref().take(length), &mut io::sink())? < length {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
        }
    }

    /// Closes a frame that was read to its end, and compares its checksum, if it has one.
    fn close_frame(&mut self) -> io::Result<()> {
        let Some(frame) = self.frame.take() else { return Ok(()) };
        let (expected, found) = (frame.decoder.get_checksum_from_data(), frame.decoder.get_calculated_checksum());
        self.source = Some(frame.into_inner());
        if expected.is_some() && expected != found { Err(damaged()) } else { Ok(()) }
    }
}

/// The error of a frame that cannot be decompressed.
fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "what zstd has compressed is damaged or cut off")
}

impl<R: BufRead> Read for ZstdReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(source) = self.source.take()
                && !self.open_frame(source)?
            {
                return Ok(0);
            }
            let Some(frame) = &mut self.frame else { return Ok(0) };
            let count = frame.read(buffer).map_err(|_| damaged())?;
            if count > 0 || buffer.is_empty() {
                return Ok(count);
            }
            self.close_frame()?;
        }
    }
}
