//! Files of a header and records, whose number may be part of the header.

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
