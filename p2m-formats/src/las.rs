//! LAS files, whose layout is fixed and simple, and LAZ files, which the crate laz decompresses.
//!
//! The header, the records of variable length and the point records are read here. Coordinates are the first twelve
//! bytes of a point record.

use crate::sink::{MAX_RATIO, Sink};
use crate::{File, wkt};
use laz::laszip::ChunkTable;
use laz::{DecompressionSelection, LasZipDecompressor, LazItemRecordBuilder, LazItemType, LazVlr};
use p2m_mixed::{FileLocation, ReadError, Scene, Unit};
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::thread;

/// The minimal length in bytes of a point record of each format.
const RECORD_BYTES: [u16; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];

/// The number of points that are decompressed at a time.
const BATCH: u64 = 1 << 12;

/// The size in bytes of the stack of the decompressing thread, and the depth of the stack at which data is refused.
///
/// The crate laz recurses once for each switch to another sequence of GPS times, so damaged data can exhaust any stack.
/// The depth is checked whenever the decompressor reads a byte, see [`Shallow`]. Between two bytes it recurses at most
/// 40,000 times, because a symbol takes at least 1/5000 of a bit. A call takes 64 bytes in the release profile, and may
/// take twenty times as many in others.
const STACK: usize = 1 << 26;
const MAX_STACK: usize = STACK / 4;

struct Header {
    data_start: usize,
    format: u8,
    is_compressed: bool,
    record_len: u16,
    count: u64,
    scale: [f64; 3],
    offset: [f64; 3],
}

impl Header {
    fn read(file: &File<'_>) -> Result<Self, ReadError> {
        if file.slice(0, 4)? != b"LASF" {
            return Err(file.error_at(FileLocation::Byte(0), "the file does not start with 'LASF'"));
        }
        let [minor] = file.array(25)?;
        let header_len = u16::from_le_bytes(file.array(94)?);
        let [format] = file.array(104)?;
        let triple = |at: usize| -> Result<[f64; 3], ReadError> {
            let number = |k: usize| file.array(at + 8 * k).map(f64::from_le_bytes);
            Ok([number(0)?, number(1)?, number(2)?])
        };
        let mut count = u64::from(u32::from_le_bytes(file.array(107)?));
        if minor >= 4 && header_len >= 375 {
            count = u64::from_le_bytes(file.array(247)?);
        }
        let header = Self {
            data_start: u32::from_le_bytes(file.array(96)?) as usize,
            format: format & 0x3f,
            is_compressed: format & 0x80 != 0,
            record_len: u16::from_le_bytes(file.array(105)?),
            count,
            scale: triple(131)?,
            offset: triple(155)?,
        };
        let at = |byte, text: String| Err(file.error_at(FileLocation::Byte(byte), text));
        let Some(&least) = RECORD_BYTES.get(usize::from(header.format)) else {
            return at(104, format!("point format {} is unknown", header.format));
        };
        if header.record_len < least {
            let text =
                format!("records of {} bytes are too short for point format {}", header.record_len, header.format);
            return at(105, text);
        }
        if let Some(k) = (0..3).find(|k| !header.scale[*k].is_finite() || !header.offset[*k].is_finite()) {
            return at(131, format!("the scale or the offset of {} is not finite", ["x", "y", "z"][k]));
        }
        Ok(header)
    }

    /// Returns the coordinates of a record.
    fn position(&self, record: &[u8]) -> [f64; 3] {
        std::array::from_fn(|k| {
            let bytes = record[4 * k..][..4].try_into().expect("four bytes");
            f64::from(i32::from_le_bytes(bytes)) * self.scale[k] + self.offset[k]
        })
    }
}

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let header = Header::read(file)?;
    if !header.is_compressed {
        return read_records(file, &header);
    }
    thread::scope(|scope| {
        let thread = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || read_records(file, &header));
        let thread = thread.map_err(|error| file.error(format!("no thread to decompress it: {error}")))?;
        thread.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}

fn read_records(file: &File<'_>, header: &Header) -> Result<Scene, ReadError> {
    let mut sink = Sink::new(file.bytes.len());
    let record_len = usize::from(header.record_len);
    let mut next = 0u64;
    let mut take = |records: &[u8]| {
        records.chunks_exact(record_len).try_for_each(|record| {
            next += 1;
            sink.point(header.position(record))
                .map_err(|reason| ReadError::new(file.name, FileLocation::Row(next - 1), reason))
        })
    };
    let records = record_variables(file)?;
    if header.is_compressed {
        decompress(file, header, &records, &mut take)?;
    } else {
        let held = file.bytes.len().saturating_sub(header.data_start) / record_len;
        if header.count > held as u64 {
            let text = format!("the header announces {} points, but the file has {held}", header.count);
            return Err(file.error_at(FileLocation::Byte(107), text));
        }
        let len = usize::try_from(header.count).map_or(0, |count| count * record_len);
        take(file.slice(header.data_start, len)?)?;
    }
    sink.builder.unit = unit(&records);
    Ok(sink.finish())
}

/// A record of variable length: user id, record number and data.
type Variable<'a> = (&'a [u8], u16, &'a [u8]);

/// Returns the records of variable length after the header.
fn record_variables<'a>(file: &'a File<'_>) -> Result<Vec<Variable<'a>>, ReadError> {
    let mut at = usize::from(u16::from_le_bytes(file.array(94)?));
    let mut records = Vec::new();
    for _ in 0..u32::from_le_bytes(file.array(100)?) {
        let len = usize::from(u16::from_le_bytes(file.array(at + 20)?));
        let user = file.slice(at + 2, 16)?;
        let user = &user[..user.iter().position(|b| *b == 0).unwrap_or(16)];
        records.push((user, u16::from_le_bytes(file.array(at + 18)?), file.slice(at + 54, len)?));
        at += 54 + len;
    }
    Ok(records)
}

/// Returns the unit of the coordinate system, which is given by well-known text or by GeoTIFF keys.
fn unit(records: &[Variable<'_>]) -> Option<Unit> {
    let find = |number| records.iter().find(|(user, n, _)| *user == b"LASF_Projection" && *n == number).map(|r| r.2);
    if let Some(text) = find(2112) {
        return wkt::unit(&String::from_utf8_lossy(text));
    }
    let (numbers, _) = find(34735)?.as_chunks::<2>();
    let numbers: Vec<_> = numbers.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect();
    let key =
        |key| numbers.chunks_exact(4).skip(1).find(|entry| entry[0] == key && entry[1] == 0).map(|entry| entry[3]);
    match (key(1024), key(3076)) {
        (Some(2), _) => Some(Unit::Degree),
        (_, Some(9001)) => Some(Unit::Metre),
        (_, Some(9002)) => Some(Unit::Foot),
        (_, Some(9003)) => Some(Unit::SurveyFoot),
        _ => None,
    }
}

/// A file that returns an error instead of data once the stack is too deep.
struct Shallow<'a> {
    file: Cursor<&'a [u8]>,
    /// The address of a variable on the stack when reading begins.
    start: usize,
}

/// Returns an address on the stack.
#[inline(never)]
fn stack_address() -> usize {
    let here = 0u8;
    std::hint::black_box(&raw const here).addr()
}

impl Read for Shallow<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.start.abs_diff(stack_address()) > MAX_STACK {
            return Err(io::Error::other("it switches between too many sequences of times"));
        }
        self.file.read(out)
    }
}

impl Seek for Shallow<'_> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}

/// Decompresses all records, after checking everything that the crate laz would trust.
fn decompress(
    file: &File<'_>,
    header: &Header,
    records: &[Variable<'_>],
    take: &mut impl FnMut(&[u8]) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let laszip = records.iter().find(|(user, number, _)| *user == b"laszip encoded" && *number == LazVlr::RECORD_ID);
    let (.., data) = laszip.ok_or_else(|| file.error("the header has no record of the compression"))?;
    let in_record = |error: String| file.error(format!("record of the compression in the header: {error}"));
    let vlr = LazVlr::read_from(*data).map_err(|error| in_record(error.to_string()))?;
    // The decompressor relies on the items of the point format.
    let extra = header.record_len - RECORD_BYTES[usize::from(header.format)];
    let expected = LazItemRecordBuilder::default_for_point_format_id(header.format, extra);
    let expected = expected.map_err(|error| in_record(error.to_string()))?;
    let items = |items: &[laz::LazItem]| items.iter().map(|i| (i.item_type(), i.size())).collect::<Vec<_>>();
    let versions: Vec<_> = vlr.items().iter().map(|item| item.version()).collect();
    let is_layered = header.format >= 6;
    let known = if is_layered { 3..=4 } else { 1..=2 };
    if items(vlr.items()) != items(&expected) || !versions.iter().all(|version| known.contains(version)) {
        return Err(in_record("it does not describe the records of the point format".to_owned()));
    }
    let most = (file.bytes.len() as u64).saturating_mul(MAX_RATIO as u64) / u64::from(header.record_len);
    if header.count > most {
        let text = format!("the header announces {} points, more than the {most} that the file can have", header.count);
        return Err(file.error_at(FileLocation::Byte(107), text));
    }
    check_chunk_table(file, header)?;
    let at_row = |row: u64, error: &dyn std::fmt::Display| {
        file.error_at(FileLocation::Row(row), format!("cannot be decompressed: {error}"))
    };
    let counts = if vlr.uses_variable_size_chunks() {
        varying_counts(file, header, &vlr).map_err(|error| at_row(0, &error))?
    } else {
        Vec::new()
    };
    if is_layered {
        check_layers(file, header, &vlr, &counts)?;
    }
    let mut source = Shallow { file: Cursor::new(file.bytes), start: stack_address() };
    source.seek(SeekFrom::Start(header.data_start as u64)).expect("any position is fine");
    let selection = DecompressionSelection::xy_returns_channel().decompress_z();
    // Damaged data, including a damaged table of chunks, makes the decoder index beyond its tables. After such a panic
    // it is dropped.
    let decompressor = catch_unwind(AssertUnwindSafe(|| LasZipDecompressor::selective(source, vlr, selection)));
    let decompressor = decompressor.map_err(|_| at_row(0, &DAMAGED_TABLE))?;
    let mut decompressor = decompressor.map_err(|error| at_row(0, &error))?;
    let mut done = 0;
    let mut batch = Vec::new();
    while done < header.count {
        let count = BATCH.min(header.count - done);
        batch.resize(usize::try_from(count).expect("at most a batch") * usize::from(header.record_len), 0);
        let result = catch_unwind(AssertUnwindSafe(|| decompressor.decompress_many(&mut batch)));
        match result {
            Ok(result) => result.map_err(|error| at_row(done, &error))?,
            Err(_) => return Err(at_row(done, &"the data is damaged at or after it")),
        }
        take(&batch)?;
        done += count;
    }
    Ok(())
}

const DAMAGED_TABLE: &str = "the table of chunks is damaged";

/// Returns the numbers of points of chunks of varying size. The decompressor trusts these numbers.
fn varying_counts(file: &File<'_>, header: &Header, vlr: &LazVlr) -> Result<Vec<u64>, String> {
    let mut source = Cursor::new(file.bytes);
    source.set_position(header.data_start as u64);
    let table = catch_unwind(AssertUnwindSafe(|| ChunkTable::read_from(source, vlr)));
    let table = table.map_err(|_| DAMAGED_TABLE)?.map_err(|error| error.to_string())?;
    let counts: Vec<u64> = table.as_ref().iter().map(|chunk| chunk.point_count).collect();
    let total = counts.iter().copied().fold(0, u64::saturating_add);
    if total != header.count {
        return Err(format!("the chunks have {total} points, but the header announces {}", header.count));
    }
    if counts.contains(&0) {
        return Err("a chunk has no points".to_owned());
    }
    Ok(counts)
}

/// Refuses a table of more chunks than the file can have, because the decompressor would allocate memory for them.
fn check_chunk_table(file: &File<'_>, header: &Header) -> Result<(), ReadError> {
    let end = file.bytes.len() - 8.min(file.bytes.len());
    for at in [header.data_start, end] {
        let table = u64::from_le_bytes(file.array(at)?);
        let count = usize::try_from(table).ok().and_then(|table| file.array(table.checked_add(4)?).ok());
        if let Some(count) = count.map(u32::from_le_bytes)
            && table > header.data_start as u64
            && count as usize > file.bytes.len() / usize::from(header.record_len)
        {
            let text = format!("the table of chunks announces {count} chunks, more than the file can have");
            return Err(file.error_at(FileLocation::Byte(table), text));
        }
    }
    Ok(())
}

/// Refuses chunks whose layers are longer than the file, because the decompressor would allocate memory for them.
/// `counts` has the number of points of each chunk, if they vary.
fn check_layers(file: &File<'_>, header: &Header, vlr: &LazVlr, counts: &[u64]) -> Result<(), ReadError> {
    let layers: usize = vlr
        .items()
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(count) => usize::from(count),
            _ => 1,
        })
        .sum();
    let mut at = header.data_start.saturating_add(8);
    let mut points = 0u64;
    let mut counts = counts.iter();
    while points < header.count {
        // A chunk has its first record, the number of its points, the lengths of its layers, and the layers.
        let sizes = at.saturating_add(usize::from(header.record_len));
        let count = u32::from_le_bytes(file.array(sizes)?);
        if count == 0 {
            return Err(file.error_at(FileLocation::Byte(sizes as u64), "a chunk has no points"));
        }
        if let Some(expected) = counts.next().filter(|expected| **expected != u64::from(count)) {
            let text = format!("a chunk has {count} points, but the table of chunks says {expected}");
            return Err(file.error_at(FileLocation::Byte(sizes as u64), text));
        }
        // The decompressor begins a new chunk after the usual number of points.
        points += u64::from(count.min(vlr.chunk_size()));
        let lens = file.slice(sizes + 4, 4 * layers)?.as_chunks::<4>().0;
        let len: u64 = lens.iter().map(|len| u64::from(u32::from_le_bytes(*len))).sum();
        let start = sizes + 4 + 4 * layers;
        at = usize::try_from(len)
            .ok()
            .and_then(|len| start.checked_add(len))
            .filter(|end| *end <= file.bytes.len())
            .ok_or_else(|| {
                file.error_at(
                    FileLocation::Byte(sizes as u64 + 4),
                    format!("the layers of a chunk take {len} bytes, which is more than the file has"),
                )
            })?;
    }
    Ok(())
}
