//! Arrays as text: base64 of their compressed little-endian bytes. The script of the page unpacks them.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use std::io::Write as _;

/// An array as text.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Packed {
    /// The name of the type of the numbers.
    #[serde(rename = "type")]
    kind: &'static str,
    /// The compressed bytes.
    deflate: String,
}

/// A number that arrays can have, with the name of its type in the script.
pub(crate) trait Number: bytemuck::NoUninit {
    const NAME: &'static str;
}

impl Number for f32 {
    const NAME: &'static str = "f32";
}

impl Number for f64 {
    const NAME: &'static str = "f64";
}

impl Number for u32 {
    const NAME: &'static str = "u32";
}

impl Number for u8 {
    const NAME: &'static str = "u8";
}

impl Packed {
    /// Packs an array.
    pub(crate) fn new<N: Number>(numbers: &[N]) -> Self {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        let written = encoder.write_all(bytemuck::cast_slice(numbers)).and_then(|()| encoder.finish());
        let bytes = written.expect("writing to a vector does not fail");
        Self { kind: N::NAME, deflate: STANDARD.encode(bytes) }
    }

    /// Packs bytes that are compressed already.
    pub(crate) fn compressed(bytes: &[u8]) -> Self {
        Self { kind: u8::NAME, deflate: STANDARD.encode(bytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn packed_bytes_are_those_of_the_numbers() {
        let packed = Packed::new(&[1.5f32, -2.0, 0.1]);
        let bytes = STANDARD.decode(&packed.deflate).unwrap();
        let mut unpacked = Vec::new();
        flate2::read::ZlibDecoder::new(&bytes[..]).read_to_end(&mut unpacked).unwrap();
        assert_eq!(unpacked, [1.5f32, -2.0, 0.1].map(f32::to_le_bytes).concat());
        assert_eq!(packed.kind, "f32");
    }
}
