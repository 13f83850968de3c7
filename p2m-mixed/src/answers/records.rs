//! Files of a header and records, whose number may be part of the header.

use std::io::{self, ErrorKind, Write};

/// Writes a header and records.
#[derive(Debug)]
pub(super) struct Records<W> {
    writer: W,
    header: Header,
    /// The number of records, if it was announced.
    count: Option<u64>,
    written: u64,
    /// All records, if the header needs their number and it was not announced.
    buffered: Vec<u8>,
}

/// The header before the records.
#[derive(Debug)]
pub(super) enum Header {
    /// The header of a text table is a line without the number of records.
    Line(String),
    /// The header of an array of NumPy, with its fields.
    Npy(String),
    /// The header of a point cloud in a PLY file, with the types and names of its properties.
    Ply(Vec<(&'static str, &'static str)>),
}

impl<W: Write> Records<W> {
    pub(super) fn new(mut writer: W, header: Header, count: Option<u64>) -> io::Result<Self> {
        if count.is_some() || matches!(header, Header::Line(_)) {
            writer.write_all(&header.bytes(count.unwrap_or(0)))?;
        }
        Ok(Self { writer, header, count, written: 0, buffered: Vec::new() })
    }

    /// Returns the writer of the next record.
    pub(super) fn next(&mut self) -> io::Result<&mut dyn Write> {
        if let Some(count) = self.count.filter(|count| *count == self.written) {
            let message = format!("there are more answers than the {count} announced");
            return Err(io::Error::new(ErrorKind::InvalidInput, message));
        }
        self.written += 1;
        Ok(if self.is_buffered() { &mut self.buffered } else { &mut self.writer })
    }

    fn is_buffered(&self) -> bool {
        self.count.is_none() && !matches!(self.header, Header::Line(_))
    }

    /// Ends the file and returns the flushed writer.
    pub(super) fn finish(mut self) -> io::Result<W> {
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

/// Returns a header of an NPY file of version 1.0, padded to a multiple of 64 bytes as NumPy does.
///
/// # Panics
/// If the header is longer than 2^16 - 1 bytes.
pub fn npy_header(descr: &str, shape: &str, is_fortran: bool) -> Vec<u8> {
    let order = if is_fortran { "True" } else { "False" };
    let mut description = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
    // Magic, version and length take 10 bytes, and a line end comes last.
    while !(10 + description.len() + 1).is_multiple_of(64) {
        description.push(' ');
    }
    description.push('\n');
    let length = u16::try_from(description.len()).expect("a few hundred bytes");
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend(length.to_le_bytes());
    header.extend(description.into_bytes());
    header
}

/// A record of N bytes that is filled field by field.
pub(super) struct Fields<const N: usize> {
    pub(super) bytes: [u8; N],
    end: usize,
}

impl<const N: usize> Default for Fields<N> {
    fn default() -> Self {
        Self { bytes: [0; N], end: 0 }
    }
}

impl<const N: usize> Fields<N> {
    pub(super) fn add<const M: usize>(&mut self, bytes: [u8; M]) {
        self.bytes[self.end..self.end + M].copy_from_slice(&bytes);
        self.end += M;
    }

    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.add(x.to_le_bytes()));
    }
}
