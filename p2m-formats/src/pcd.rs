//! PCD, the format of the Point Cloud Library. A text header is followed by points as text, as bytes, or as bytes that
//! are compressed by LZF.

use crate::File;
use crate::sink::{Sink, expanded_limit};
use p2m_mixed::engine::Scalar;
use p2m_mixed::{FileLocation, ReadError, Scene};
use std::borrow::Cow;
use std::ops::Range;

/// The position of a coordinate in a record.
#[derive(Clone, Copy)]
struct Field {
    /// The number of the first word of the field in a line of text.
    word: usize,
    /// The offset of the field in a binary record.
    offset: usize,
    scalar: Scalar,
}

/// Returns the type of numbers with this letter and this size in bytes.
fn scalar(kind: u8, size: usize) -> Option<Scalar> {
    let letter = char::from(kind).to_ascii_lowercase();
    Scalar::of_npy(format!("{letter}{size}").as_bytes()).filter(|_| kind.is_ascii_uppercase())
}

struct Header<'a> {
    fields: [Field; 3],
    record_len: usize,
    count: usize,
    data: &'a str,
    /// The offset of the first byte after the header.
    end: usize,
    lines: u64,
}

impl<'a> Header<'a> {
    fn read(file: &File<'a>) -> Result<Self, ReadError> {
        let (mut names, mut sizes, mut kinds, mut counts): (Vec<&str>, Vec<_>, Vec<_>, Vec<_>) = Default::default();
        let (mut width, mut height, mut points, mut at, mut line) = (None, 1, None, 0, 0u64);
        loop {
            line += 1;
            let fail = |text: String| file.error_at(FileLocation::Line(line), text);
            let rest = &file.bytes[at..];
            let Some(len) = rest.iter().position(|b| *b == b'\n') else {
                return Err(fail("the header ends without a line DATA".to_owned()));
            };
            at += len + 1;
            let text = std::str::from_utf8(&rest[..len]).map_err(|_| fail("the header is not text".to_owned()))?;
            let mut words = text.split_ascii_whitespace();
            let key = words.next().unwrap_or("#");
            let whole = |word: &'a str| {
                word.parse::<usize>().map_err(|_| fail(format!("'{}' is not a whole number", word.escape_debug())))
            };
            let one = || words.clone().next().ok_or_else(|| fail(format!("{key} has no value")));
            match key {
                "FIELDS" | "COLUMNS" => names = words.collect(),
                "SIZE" => sizes = words.map(whole).collect::<Result<_, _>>()?,
                "TYPE" => kinds = words.map(|word| word.as_bytes()[0]).collect(),
                "COUNT" => counts = words.map(whole).collect::<Result<_, _>>()?,
                "WIDTH" => width = Some(whole(one()?)?),
                "HEIGHT" => height = whole(one()?)?,
                "POINTS" => points = Some(whole(one()?)?),
                "DATA" => {
                    let data = one()?;
                    if counts.is_empty() {
                        counts = vec![1; names.len()];
                    }
                    if [sizes.len(), kinds.len(), counts.len()] != [names.len(); 3] {
                        return Err(fail("FIELDS, SIZE, TYPE and COUNT have different numbers of words".to_owned()));
                    }
                    let (mut word, mut offset) = (0usize, 0usize);
                    let mut fields = [None; 3];
                    for i in 0..names.len() {
                        if let Some(axis) = ["x", "y", "z"].iter().position(|name| *name == names[i]) {
                            let scalar = scalar(kinds[i], sizes[i]).filter(|_| counts[i] == 1);
                            let unknown = || fail(format!("the type or the size of {} is unknown", names[i]));
                            fields[axis] = Some(Field { word, offset, scalar: scalar.ok_or_else(unknown)? });
                        }
                        word = word.saturating_add(counts[i]);
                        offset = offset.saturating_add(sizes[i].saturating_mul(counts[i]));
                    }
                    let [Some(x), Some(y), Some(z)] = fields else {
                        return Err(fail(format!(
                            "the fields x, y, z are not among {}",
                            names.join(", ").escape_debug()
                        )));
                    };
                    let count = points.or(width.and_then(|width| width.checked_mul(height)));
                    let count = count.ok_or_else(|| fail("the header has no number of points".to_owned()))?;
                    return Ok(Self { fields: [x, y, z], record_len: offset, count, data, end: at, lines: line });
                }
                _ => {}
            }
        }
    }
}

pub(crate) fn read(file: &File<'_>) -> Result<Scene, ReadError> {
    let header = Header::read(file)?;
    let mut sink = Sink::new(file.bytes.len());
    match header.data {
        "ascii" => read_text(file, &header, &mut sink)?,
        "binary" => {
            let len = header.count.saturating_mul(header.record_len);
            let records = file.slice(header.end, len)?;
            let fields = header.fields;
            let field = |axis: usize, row: usize| {
                let at = row * header.record_len + fields[axis].offset;
                at..at + fields[axis].scalar.size()
            };
            read_bytes(file, &header, records, field, &mut sink)?;
        }
        "binary_compressed" => {
            let len = u32::from_le_bytes(file.array(header.end)?) as usize;
            let expanded = u32::from_le_bytes(file.array(header.end + 4)?) as usize;
            if header.count.checked_mul(header.record_len) != Some(expanded)
                || expanded > expanded_limit(file.bytes.len())
            {
                let text = format!("{expanded} bytes of data are not those of {} points", header.count);
                return Err(file.error_at(FileLocation::Byte(header.end as u64 + 4), text));
            }
            let start = header.end + 8;
            let data = expand(file.slice(start, len)?, expanded).map_err(|at| {
                file.error_at(FileLocation::Byte((start + at) as u64), "the compressed data is damaged")
            })?;
            // Compressed data has all values of the first field, then all of the second, and so on.
            let field = |axis: usize, row: usize| {
                let Field { offset, scalar, .. } = header.fields[axis];
                let at = header.count * offset + row * scalar.size();
                at..at + scalar.size()
            };
            read_bytes(file, &header, &data, field, &mut sink)?;
        }
        other => {
            let text = format!("DATA '{}' is unknown", other.escape_debug());
            return Err(file.error_at(FileLocation::Line(header.lines), text));
        }
    }
    Ok(sink.finish())
}

fn read_bytes(
    file: &File<'_>,
    header: &Header<'_>,
    data: &[u8],
    field: impl Fn(usize, usize) -> Range<usize>,
    sink: &mut Sink,
) -> Result<(), ReadError> {
    for row in 0..header.count {
        let number = |axis: usize| header.fields[axis].scalar.number(&data[field(axis, row)]);
        let position = std::array::from_fn(|axis| number(axis).expect("the range has the size of the number"));
        sink.point(position).map_err(|reason| ReadError::new(file.name, FileLocation::Row(row as u64), reason))?;
    }
    Ok(())
}

fn read_text(file: &File<'_>, header: &Header<'_>, sink: &mut Sink) -> Result<(), ReadError> {
    let mut line = header.lines;
    let mut rows = 0;
    for text in file.bytes[header.end..].split(|b| *b == b'\n') {
        line += 1;
        let at_line = |text: String| file.error_at(FileLocation::Line(line), text);
        let text: Cow<'_, str> = String::from_utf8_lossy(text);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        let mut position = [0.0; 3];
        for (x, field) in position.iter_mut().zip(header.fields) {
            let word = *words.get(field.word).ok_or_else(|| at_line("a point has too few values".to_owned()))?;
            // A number of a text is rounded to the type of its field, as binary numbers are.
            let number = match field.scalar {
                Scalar::F32 => word.parse::<f32>().map(f64::from),
                _ => word.parse(),
            };
            *x = number.map_err(|_| at_line(format!("'{}' is not a number", word.escape_debug())))?;
        }
        sink.point(position).map_err(|reason| ReadError::new(file.name, FileLocation::Line(line), reason))?;
        rows += 1;
    }
    if rows != header.count {
        return Err(file.error_at(
            FileLocation::Line(line),
            format!("the header announces {} points, but there are {rows}", header.count),
        ));
    }
    Ok(())
}

/// Expands data compressed by LZF. The error is the offset at which the data is damaged.
///
/// Each step begins with a control byte. If its upper three bits are zero, its value plus one bytes follow as they are.
/// Otherwise a run of earlier output is repeated: the upper three bits are its length less two (7 means that the next
/// byte is added), and the lower five bits with one more byte are the distance back, less one. A run may overlap its
/// own copy.
fn expand(data: &[u8], len: usize) -> Result<Vec<u8>, usize> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(&control) = data.get(at) {
        let start = at;
        let mut next = || {
            at += 1;
            data.get(at).copied().map(usize::from).ok_or(start)
        };
        let mut count = usize::from(control >> 5);
        if count == 0 {
            // A literal run.
            let run = at + 1..at + 2 + usize::from(control);
            at = run.end;
            out.extend_from_slice(data.get(run).ok_or(start)?);
        } else {
            // A repeated run.
            count += 2 + if count == 7 { next()? } else { 0 };
            let back = (usize::from(control & 0x1f) << 8) + next()? + 1;
            at += 1;
            let from = out.len().checked_sub(back).ok_or(start)?;
            (from..from + count).for_each(|i| out.push(out[i]));
        }
        if out.len() > len {
            return Err(start);
        }
    }
    if out.len() == len { Ok(out) } else { Err(at) }
}

#[cfg(test)]
mod tests {
    use super::expand;

    #[test]
    fn runs_repeat_what_came_before() {
        // Three bytes as they are, then seven that begin two bytes back, then twelve.
        let data = [2, b'a', b'b', b'c', 5 << 5, 1, 7 << 5, 3, 9];
        assert_eq!(expand(&data, 22).unwrap(), b"abcbcbcbcbabcbcbcbcbab".to_vec());
        assert_eq!(expand(&data, 21), Err(6));
        assert_eq!(expand(&data, 23), Err(9));
        assert_eq!(expand(&data[..8], 22), Err(6));
        assert_eq!(expand(&[1 << 5, 0], 3), Err(0));
    }
}
