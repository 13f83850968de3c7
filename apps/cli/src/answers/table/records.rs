//! Files of a header and records, whose number may be part of the header.

use super::AnswerFormat;
use p2m_core::npy_header;
use std::io::{self, ErrorKind, Write};

/// A file of a header and records.
pub(crate) struct Table<W> {
    writer: W,
    header: Header,
    /// The number of records, if it was announced.
    count: Option<u64>,
    written: u64,
    /// All records, if the header needs their number and it was not announced.
    buffered: Vec<u8>,
}

/// The header before the records.
pub(crate) enum Header {
    /// The header of a text table is a line without the number of records.
    Line(String),
    /// The header of an array of NumPy, with its fields.
    Npy(String),
    /// The header of a point cloud in a PLY file, with the types and names of its properties.
    Ply(Vec<(&'static str, &'static str)>),
}

impl<W: Write> Table<W> {
    /// Starts a file of `count` records. Without a count, NPY and PLY files are kept in memory until they are finished,
    /// because their header has the number of records.
    pub(crate) fn new(mut writer: W, header: Header, count: Option<u64>) -> io::Result<Self> {
        if count.is_some() || matches!(header, Header::Line(_)) {
            writer.write_all(&header.bytes(count.unwrap_or(0)))?;
        }
        Ok(Self { writer, header, count, written: 0, buffered: Vec::new() })
    }

    /// Writes `count` encoded records. More than announced are an error.
    pub(crate) fn write(&mut self, count: u64, bytes: &[u8]) -> io::Result<()> {
        self.written = self.written.saturating_add(count);
        if let Some(announced) = self.count.filter(|announced| *announced < self.written) {
            let message = format!("there are more answers than the {announced} announced");
            return Err(io::Error::new(ErrorKind::InvalidInput, message));
        }
        if self.is_buffered() {
            self.buffered.extend_from_slice(bytes);
            return Ok(());
        }
        self.writer.write_all(bytes)
    }

    fn is_buffered(&self) -> bool {
        self.count.is_none() && !matches!(self.header, Header::Line(_))
    }

    /// Ends the file and returns the flushed writer. Fewer records than announced are an error.
    pub(crate) fn finish(mut self) -> io::Result<W> {
        if let Some(count) = self.count.filter(|count| *count > self.written) {
            let message = format!("there are {} answers, not the {count} announced", self.written);
            return Err(io::Error::new(ErrorKind::InvalidInput, message));
        }
        if self.is_buffered() {
            self.writer.write_all(&self.header.bytes(self.written))?;
            self.writer.write_all(&self.buffered)?;
        }
        self.writer.flush()?;
        Ok(self.writer)
    }
}

impl Header {
    fn bytes(&self, count: u64) -> Vec<u8> {
        match self {
            Self::Line(line) => format!("{line}\n").into_bytes(),
            Self::Npy(fields) => npy_header(&format!("[{fields}]"), &format!("({count},)"), false),
            Self::Ply(properties) => {
                let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n");
                for (scalar, name) in properties {
                    header += &format!("property {scalar} {name}\n");
                }
                (header + "end_header\n").into_bytes()
            }
        }
    }
}

/// Appends numbers to a record, little-endian.
pub(super) fn put_numbers(out: &mut Vec<u8>, numbers: &[f64]) {
    numbers.iter().for_each(|x| out.extend(x.to_le_bytes()));
}

/// Appends a number to a line of text: the shortest that reads back the same, with an exponent if it is far from 1.
pub(super) fn put_text(out: &mut Vec<u8>, x: f64) {
    let mut buffer = zmij::Buffer::new();
    let text = buffer.format(x).as_bytes();
    // Rust writes exponents without a plus sign, and zmij with one, which only numbers from 1e16 on get.
    match if x.abs() < 1e16 { None } else { text.iter().position(|byte| *byte == b'+') } {
        None => out.extend_from_slice(text),
        Some(plus) => {
            out.extend_from_slice(&text[..plus]);
            out.extend_from_slice(&text[plus + 1..]);
        }
    }
}

/// Appends an integer to a line of text.
pub(super) fn put_integer(out: &mut Vec<u8>, number: u64) {
    out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}

/// Appends numbers to a line of text, with a comma after each.
pub(super) fn put_columns(out: &mut Vec<u8>, numbers: &[f64]) {
    for x in numbers {
        put_text(out, *x);
        out.push(b',');
    }
}

/// Returns the bytes of an integer. PLY has no integers of 64 bits, so it gets a `double`.
#[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 rays")]
pub(super) fn integer_bytes(format: AnswerFormat, number: u64) -> [u8; 8] {
    if format == AnswerFormat::Ply { (number as f64).to_le_bytes() } else { number.to_le_bytes() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_text_are_short_and_read_back_the_same() {
        let text = |x: f64| {
            let mut out = Vec::new();
            put_text(&mut out, x);
            String::from_utf8(out).unwrap()
        };
        for (x, expected) in [
            (0.5, "0.5"),
            (3.0, "3.0"),
            (-0.0, "-0.0"),
            (1e300, "1e300"),
            (-1.5e16, "-1.5e16"),
            (1e-300, "1e-300"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(text(x), expected);
        }
        for case in p2m_testkit::cases(100_000, 1000) {
            let x = f64::from_bits(rand::RngExt::random(&mut p2m_testkit::rng("text", case)));
            let found: f64 = text(x).parse().unwrap();
            assert!(found.to_bits() == x.to_bits() || (found.is_nan() && x.is_nan()), "{x:?}");
        }
    }
}
