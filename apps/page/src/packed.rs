//! Arrays as text: base64 of their compressed little-endian bytes. The script of the page unpacks them.
//!
//! Of several forms of the numbers the shortest is taken, all of which but those of [`Packed::rounded`] are exact.

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
    #[serde(flatten)]
    form: Form,
    /// The compressed bytes.
    bytes: String,
}

/// What is compressed instead of the numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Form {
    /// Whether the bytes are compressed by Zstandard rather than by deflate.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    zstandard: bool,
    /// Whether the first bytes of all numbers come first, then the second ones, and so on.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    planes: bool,
    /// Whether each number but the first is the difference from the one before.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    steps: bool,
    /// Signed numbers of 32 bits, which are these times as large.
    #[serde(skip_serializing_if = "Option::is_none")]
    decimals: Option<f64>,
    /// Numbers of 16 bits, whose unit and origin these are. The largest stands for NaN.
    #[serde(skip_serializing_if = "Option::is_none")]
    rounded: Option<[f64; 2]>,
}

/// A number that arrays can have, with the name of its type in the script.
pub(crate) trait Number: bytemuck::NoUninit {
    const NAME: &'static str;

    /// Returns the numbers in another form that may be shorter, if there is one.
    fn shorter(_: &[Self]) -> Option<(Form, Vec<u8>)> {
        None
    }
}

impl Number for f32 {
    const NAME: &'static str = "f32";
}

impl Number for f64 {
    const NAME: &'static str = "f64";

    /// Files of text have few decimals.
    #[allow(clippy::cast_possible_truncation, reason = "the cast is checked")]
    fn shorter(numbers: &[f64]) -> Option<(Form, Vec<u8>)> {
        // The cast saturates, and makes zeros of -0 and NaN.
        let scaled = |x: f64, scale: f64| -> Option<i32> {
            let integer = (x * scale).round() as i32;
            ((f64::from(integer) / scale).to_bits() == x.to_bits()).then_some(integer)
        };
        let mut scale = 1.0;
        let mut decimals = 0;
        for &x in numbers {
            while scaled(x, scale).is_none() {
                decimals += 1;
                if decimals > MAX_DECIMALS {
                    return None;
                }
                scale *= 10.0;
            }
        }
        let integers: Option<Vec<i32>> = numbers.iter().map(|&x| scaled(x, scale)).collect();
        let bytes = planes(bytemuck::cast_slice(&integers?), 4);
        Some((Form { planes: true, decimals: Some(scale), ..Form::default() }, bytes))
    }
}

impl Number for u32 {
    const NAME: &'static str = "u32";

    /// Vertices of a strip or of a line have numbers that rise evenly.
    fn shorter(numbers: &[u32]) -> Option<(Form, Vec<u8>)> {
        let mut before = 0;
        let steps: Vec<u32> = numbers.iter().map(|&x| x.wrapping_sub(std::mem::replace(&mut before, x))).collect();
        Some((Form { planes: true, steps: true, ..Form::default() }, planes(bytemuck::cast_slice(&steps), 4)))
    }
}

impl Number for u8 {
    const NAME: &'static str = "u8";
}

/// The largest number of decimals of which the power of ten and its products are exact.
const MAX_DECIMALS: u32 = 9;

/// The part of a unit of length to which [`Packed::rounded`] rounds.
const ROUNDED_PART: f64 = 1.0 / 256.0;

impl Packed {
    /// Packs an array.
    pub(crate) fn new<N: Number>(numbers: &[N]) -> Self {
        let bytes = bytemuck::cast_slice(numbers);
        let width = size_of::<N>();
        let in_planes = (width > 1).then(|| (Form { planes: true, ..Form::default() }, planes(bytes, width)));
        let mut best = (Form::default(), compress(bytes, Compression::fast()));
        for (form, bytes) in in_planes.into_iter().chain(N::shorter(numbers)) {
            let compressed = compress(&bytes, Compression::fast());
            if compressed.len() < best.1.len() {
                best = (form, compressed);
            }
        }
        Self { kind: N::NAME, form: best.0, bytes: STANDARD.encode(best.1) }
    }

    /// Packs values rounded to a 256th of a length, or to a 65534th of their range if that is more. NaN stays. Values of
    /// which some are infinite are not rounded.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the quotient is in range")]
    pub(crate) fn rounded(values: &[f32], length: f64) -> Self {
        let numbers = values.iter().copied().filter(|x| !x.is_nan()).map(f64::from);
        let low = numbers.clone().fold(f64::INFINITY, f64::min);
        let high = numbers.fold(f64::NEG_INFINITY, f64::max);
        let last = f64::from(u16::MAX - 1);
        let unit = (length * ROUNDED_PART).max((high - low) / last);
        if !unit.is_finite() || unit <= 0.0 {
            return Self::new(values);
        }
        let round =
            |x: &f32| if x.is_nan() { u16::MAX } else { ((f64::from(*x) - low) / unit).round().min(last) as u16 };
        let mut before = 0;
        let step = |x: &f32| {
            let number = round(x);
            number.wrapping_sub(std::mem::replace(&mut before, number))
        };
        let steps: Vec<u16> = values.iter().map(step).collect();
        let form = Form { planes: true, steps: true, rounded: Some([unit, low]), ..Form::default() };
        let bytes = compress(&planes(bytemuck::cast_slice(&steps), 2), Compression::fast());
        Self { kind: f32::NAME, form, bytes: STANDARD.encode(bytes) }
    }

    /// Packs bytes that are compressed by Zstandard already.
    pub(crate) fn zstandard(bytes: &[u8]) -> Self {
        let form = Form { zstandard: true, ..Form::default() };
        Self { kind: u8::NAME, form, bytes: STANDARD.encode(bytes) }
    }
}

/// Compresses bytes as much as possible, and returns them as text.
pub(crate) fn compressed_text(bytes: &[u8]) -> String {
    STANDARD.encode(compress(bytes, Compression::best()))
}

/// Compresses bytes by deflate.
pub(crate) fn compress(bytes: &[u8], level: Compression) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), level);
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("writing to a vector does not fail")
}

/// Returns the first bytes of all numbers of some width, then the second ones, and so on.
fn planes(bytes: &[u8], width: usize) -> Vec<u8> {
    (0..width).flat_map(|plane| bytes.iter().skip(plane).step_by(width).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    fn unpacked(packed: &Packed) -> Vec<u8> {
        let bytes = STANDARD.decode(&packed.bytes).unwrap();
        let mut unpacked = Vec::new();
        flate2::read::ZlibDecoder::new(&bytes[..]).read_to_end(&mut unpacked).unwrap();
        unpacked
    }

    #[test]
    fn packed_bytes_are_those_of_the_numbers() {
        let packed = Packed::new(&[1.5f32, -2.0, 0.1]);
        assert_eq!(unpacked(&packed), [1.5f32, -2.0, 0.1].map(f32::to_le_bytes).concat());
        assert_eq!((packed.kind, packed.form), ("f32", Form::default()));
    }

    #[test]
    fn the_shortest_form_is_taken() {
        let numbers: Vec<f64> = (0..1000).map(|i| f64::from(i * i % 7919) / 1000.0).collect();
        let packed = Packed::new(&numbers);
        assert_eq!(packed.form, Form { planes: true, decimals: Some(1000.0), ..Form::default() });
        let integers: Vec<i32> = (0..1000).map(|i| i * i % 7919).collect();
        assert_eq!(unpacked(&packed), planes(bytemuck::cast_slice(&integers), 4));
        // A zero with a sign, and a number with more decimals, have no such form.
        for other in [-0.0, 0.1 + 0.2] {
            assert!(f64::shorter(&[1.5, other]).is_none(), "{other}");
        }
        let strip: Vec<u32> = (0..1000).flat_map(|i| [i, i + 1, i + 2]).collect();
        assert_eq!(Packed::new(&strip).form, Form { planes: true, steps: true, ..Form::default() });
    }

    #[test]
    fn values_are_rounded_to_a_part_of_a_length() {
        let values = [-1.0, 0.7, f32::NAN, 2.0, 1.9];
        let packed = Packed::rounded(&values, 0.5);
        let [unit, low] = packed.form.rounded.unwrap();
        assert_eq!((packed.kind, unit, low), ("f32", 0.5 / 256.0, -1.0));
        let bytes = unpacked(&packed);
        let (first, second) = bytes.split_at(values.len());
        let mut number = 0u16;
        for ((x, low_byte), high_byte) in values.iter().zip(first).zip(second) {
            number = number.wrapping_add(u16::from_le_bytes([*low_byte, *high_byte]));
            let read = if number == u16::MAX { f64::NAN } else { low + unit * f64::from(number) };
            assert!((read - f64::from(*x)).abs() <= 0.5 * unit || (read.is_nan() && x.is_nan()), "{read}, not {x}");
        }
        // A large range has a larger unit, and infinite values are not rounded.
        assert_eq!(Packed::rounded(&[0.0, 65534.0], 1.0).form.rounded, Some([1.0, 0.0]));
        assert_eq!(Packed::rounded(&[0.0, f32::INFINITY], 1.0).form.rounded, None);
    }
}
