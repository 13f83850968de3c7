//! Primitives in a temporary file, in ascending order of their ids.

use bytemuck::{Pod, Zeroable};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A primitive of the whole scene.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Record {
    /// The id in the whole scene.
    pub(super) id: u64,
    /// The source as in [`Scene::sources`](p2m_mixed::Scene::sources).
    pub(super) source: u32,
    /// The number of vertices.
    pub(super) len: u32,
    /// The vertices, of which the first `len` count.
    pub(super) vertices: [[f64; 3]; 3],
}

/// The number of bytes of a record.
const RECORD_BYTES: u64 = size_of::<Record>() as u64;
/// The number of bytes that are written or read at a time.
const BUFFER_BYTES: usize = 1 << 16;

impl Record {
    /// Returns the vertices that count.
    pub(super) fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices[..self.len as usize]
    }

    /// Returns the centre of the box of the primitive.
    pub(super) fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|k| {
            let along = self.vertices().iter().map(|vertex| vertex[k]);
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            // The sum of halves does not overflow.
            0.5 * low + 0.5 * high
        })
    }
}

/// Records in an unnamed file, which the system removes when it is closed.
pub(super) struct Spill {
    out: BufWriter<File>,
    len: u64,
}

impl Spill {
    /// Creates an empty file on the disk of a folder.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        Ok(Self { out: BufWriter::with_capacity(BUFFER_BYTES, tempfile::tempfile_in(folder)?), len: 0 })
    }

    /// Adds a record.
    pub(super) fn push(&mut self, record: &Record) -> io::Result<()> {
        self.len += 1;
        self.out.write_all(bytemuck::bytes_of(record))
    }

    /// Returns the number of records.
    pub(super) fn len(&self) -> u64 {
        self.len
    }

    /// Calls a function with all records in their order.
    pub(super) fn for_each(&mut self, mut visit: impl FnMut(Record) -> io::Result<()>) -> io::Result<()> {
        self.out.flush()?;
        let file = self.out.get_mut();
        file.seek(SeekFrom::Start(0))?;
        let mut reader = BufReader::with_capacity(BUFFER_BYTES, &*file);
        let mut record = Record::zeroed();
        for _ in 0..self.len {
            reader.read_exact(bytemuck::bytes_of_mut(&mut record))?;
            visit(record)?;
        }
        Ok(())
    }

    /// Returns the centres of at most `count` primitives, which are evenly spread over the file.
    pub(super) fn sample_centres(&mut self, count: u64) -> io::Result<Vec<[f64; 3]>> {
        self.out.flush()?;
        let step = self.len.div_ceil(count).max(1);
        let file = self.out.get_mut();
        let mut record = Record::zeroed();
        let mut centres = Vec::new();
        for number in (0..self.len).step_by(usize::try_from(step).unwrap_or(usize::MAX)) {
            file.seek(SeekFrom::Start(number * RECORD_BYTES))?;
            file.read_exact(bytemuck::bytes_of_mut(&mut record))?;
            centres.push(record.centre());
        }
        file.seek(SeekFrom::End(0))?;
        Ok(centres)
    }
}
