//! Reads arrays of NumPy as points or rays.

mod literal;

use super::row::Row;
use crate::parse::bytes::{ByteReader, Bytes, Scalar};
use crate::parse::text::quote;
use crate::{FileLocation, HeaderProblem, ReadError, Reason};
use literal::{Value, parse};
use std::io::BufRead;

/// The longest header in bytes. NumPy writes longer headers only for arrays of very many fields, and refuses to read
/// them.
const MAX_HEADER_BYTES: u32 = 1 << 16;

/// The largest number of fields that a message lists.
const MAX_LISTED_FIELDS: usize = 16;

/// Calls a function for each row of an array, with its id if the array has a field of ids. Returns whether rows have
/// two numbers, so that the third one is 0.
pub(crate) fn for_each_row<R: Row<N>, const N: usize>(
    reader: impl BufRead,
    name: &str,
    mut take: impl FnMut(R, Option<&[u8]>) -> Result<(), Reason>,
) -> Result<bool, ReadError> {
    let mut bytes = ByteReader::new(reader, 0);
    let at_byte = |bytes: &ByteReader<_>, reason| ReadError::new(name, FileLocation::Byte(bytes.start()), reason);
    let array = read_header::<R, N>(&mut bytes).map_err(|reason| at_byte(&bytes, reason))?;
    let mut take_row = |row, numbers, id: Option<&[u8]>| {
        let taken = R::new(numbers).and_then(|numbers| take(numbers, id));
        taken.map_err(|reason| ReadError::new(name, FileLocation::Row(row), reason))
    };
    if array.is_fortran {
        let rows = read_columns(&mut bytes, &array).map_err(|reason| at_byte(&bytes, reason))?;
        (0..).zip(rows).try_for_each(|(row, numbers)| take_row(row, numbers, None))?;
    } else {
        let columns = if array.is_flat { 2 } else { N };
        let coordinates = array.coordinates[..columns].iter().enumerate();
        let mut parts: Vec<(u64, Part)> = coordinates.map(|(axis, c)| (c.offset, Part::Coordinate(axis))).collect();
        parts.extend(array.id.map(|id| (id.offset, Part::Id(id.kind))));
        parts.sort_by_key(|(offset, _)| *offset);
        let mut id = Vec::new();
        for row in 0..array.count {
            let numbers = read_row(&mut bytes, &array, &parts, &mut id).map_err(|reason| at_byte(&bytes, reason))?;
            take_row(row, numbers, array.id.map(|_| &id[..]))?;
        }
    }
    match bytes.skip_rest() {
        Ok(0) => Ok(array.is_flat),
        Ok(rest) => Err(at_byte(&bytes, Reason::TrailingBytes { bytes: rest })),
        Err(reason) => Err(at_byte(&bytes, reason)),
    }
}

/// The layout of an array.
#[derive(Debug)]
struct Array<const N: usize> {
    count: u64,
    /// The size of an item in bytes.
    size: u64,
    /// The coordinates of an item.
    coordinates: [Coordinate; N],
    /// The id of an item.
    id: Option<IdField>,
    /// Whether the array has all x first, then all y, and so on.
    is_fortran: bool,
    /// Whether items have two numbers. The third coordinate is then 0.
    is_flat: bool,
}

#[derive(Debug, Clone, Copy)]
struct Coordinate {
    offset: u64,
    scalar: Scalar,
    big_endian: bool,
}

/// The field of ids.
#[derive(Debug, Clone, Copy)]
struct IdField {
    offset: u64,
    kind: IdKind,
}

/// The type of ids.
#[derive(Debug, Clone, Copy)]
enum IdKind {
    /// A whole number, and whether it is big-endian.
    Integer(Scalar, bool),
    /// Text of this number of bytes.
    Bytes(u64),
    /// Text of this number of characters of four bytes, and whether they are big-endian.
    Characters(u64, bool),
}

/// A part of an item that the reader uses.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// The coordinate of an axis.
    Coordinate(usize),
    /// The id.
    Id(IdKind),
}

fn bad(problem: HeaderProblem) -> Reason {
    Reason::BadHeader(problem)
}

fn read_header<R: Row<N>, const N: usize>(bytes: &mut ByteReader<impl BufRead>) -> Result<Array<N>, Reason> {
    let not_npy = |reason| match reason {
        Reason::UnexpectedEnd => bad(HeaderProblem::NotNpy),
        other => other,
    };
    if bytes.array::<6>().map_err(not_npy)? != *b"\x93NUMPY" {
        return Err(bad(HeaderProblem::NotNpy));
    }
    let [major, minor] = bytes.array()?;
    let length = match major {
        1 => u32::from(u16::from_le_bytes(bytes.array()?)),
        2 | 3 => u32::from_le_bytes(bytes.array()?),
        _ => return Err(Reason::UnsupportedFormat { text: format!("NPY {major}.{minor}") }),
    };
    if length > MAX_HEADER_BYTES {
        return Err(bad(HeaderProblem::LineTooLong));
    }
    let mut text = Vec::new();
    for _ in 0..length {
        text.push(u8::from_le_bytes(bytes.array()?));
    }
    array::<R, N>(&text)
}

/// Parses a description like `{'descr': '<f8', 'fortran_order': False, 'shape': (5, 3), }`.
fn array<R: Row<N>, const N: usize>(text: &[u8]) -> Result<Array<N>, Reason> {
    let value = parse(text).map_err(|rest| bad(HeaderProblem::BadDescription { text: quote(rest) }))?;
    let Value::Dictionary(entries) = value else {
        return Err(bad(HeaderProblem::BadDescription { text: quote(text) }));
    };
    let find = |key: &'static str| {
        let entry = entries.iter().find(|(k, _)| *k == Value::Text(key.as_bytes()));
        entry.map(|(_, value)| value).ok_or(bad(HeaderProblem::MissingKey { key }))
    };
    let (descr, order, shape) = (find("descr")?, find("fortran_order")?, find("shape")?);
    let unclear = |text: String| bad(HeaderProblem::BadDescription { text });
    let Value::Boolean(is_fortran) = *order else { return Err(unclear(order.to_string())) };
    let Value::Tuple(lengths) = shape else { return Err(unclear(shape.to_string())) };
    match descr {
        Value::Text(_) => {
            let (scalar, big_endian) = scalar(descr)?;
            let (count, columns) = match lengths.as_slice() {
                &[Value::Integer(count), Value::Integer(columns)]
                    if columns == N as u64 || columns == 2 && !R::FLAT.is_empty() =>
                {
                    (count, columns)
                }
                _ => return Err(bad(HeaderProblem::BadShape { text: shape.to_string(), expected: R::SHAPE })),
            };
            let size = scalar.size() as u64;
            let coordinates = std::array::from_fn(|k| Coordinate { offset: k as u64 * size, scalar, big_endian });
            let is_flat = columns < N as u64;
            Ok(Array { count, size: columns * size, coordinates, id: None, is_fortran, is_flat })
        }
        Value::List(fields) => {
            let &[Value::Integer(count)] = lengths.as_slice() else {
                return Err(bad(HeaderProblem::BadShape { text: shape.to_string(), expected: "(n,)" }));
            };
            let (coordinates, id, size) = structure::<R, N>(fields)?;
            Ok(Array { count, size, coordinates, id, is_fortran: false, is_flat: false })
        }
        other => Err(bad(HeaderProblem::UnsupportedType { text: other.to_string() })),
    }
}

/// Returns the coordinates and the id among the fields of a structured array, and the size of an item.
fn structure<R: Row<N>, const N: usize>(
    fields: &[Value<'_>],
) -> Result<([Coordinate; N], Option<IdField>, u64), Reason> {
    let mut offset = 0u64;
    let mut id = None;
    let (mut of_triples, mut singles) = ([None; N], [None; N]);
    let mut names = Vec::new();
    for field in fields {
        let too_large = || bad(HeaderProblem::UnsupportedType { text: field.to_string() });
        let (names_of_field, descr, shape) = match field {
            Value::Tuple(parts) => match parts.as_slice() {
                [name, descr] => (name, descr, None),
                [name, descr, shape] => (name, descr, Some(shape)),
                _ => return Err(too_large()),
            },
            _ => return Err(too_large()),
        };
        // A field may have a title before its name.
        let name = match names_of_field {
            Value::Text(name) => *name,
            Value::Tuple(both) => match both.as_slice() {
                [Value::Text(_), Value::Text(name)] => name,
                _ => return Err(too_large()),
            },
            _ => return Err(too_large()),
        };
        let coordinate = scalar(descr).map(|(scalar, big_endian)| Coordinate { offset, scalar, big_endian });
        let is_three = matches!(shape, Some(Value::Tuple(s)) if **s == [Value::Integer(3)])
            || matches!(shape, Some(Value::Integer(3)));
        let is_name = |n: &&str| n.as_bytes() == name;
        if let (Some(triple), true) = (R::TRIPLES.iter().position(is_name), is_three) {
            let first = coordinate?;
            for (k, c) in (0..).zip(&mut of_triples[3 * triple..][..3]) {
                *c = Some(Coordinate { offset: first.offset + k * first.scalar.size() as u64, ..first });
            }
        } else if let (Some(axis), None) = (R::FIELDS.iter().position(is_name), shape) {
            singles[axis] = coordinate.ok();
        } else if shape.is_none() && name.eq_ignore_ascii_case(b"id") {
            id = id_kind(descr).map(|kind| IdField { offset, kind });
        }
        if names.len() < MAX_LISTED_FIELDS {
            names.push(quote(name));
        }
        let size = size(descr, shape).ok_or_else(too_large)?;
        offset = offset.checked_add(size).ok_or_else(too_large)?;
    }
    let all = |found: [Option<Coordinate>; N]| found.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok();
    match [of_triples, singles].into_iter().find_map(all) {
        Some(coordinates) => Ok((coordinates, id, offset)),
        None => Err(bad(HeaderProblem::UnknownFields { names, expected: R::EXPECTED_FIELDS })),
    }
}

/// Returns the type that a description like `<f8` stands for, and whether its bytes are big-endian.
fn scalar(descr: &Value<'_>) -> Result<(Scalar, bool), Reason> {
    let unsupported = || bad(HeaderProblem::UnsupportedType { text: descr.to_string() });
    let Value::Text([order, kind @ ..]) = descr else { return Err(unsupported()) };
    let scalar = Scalar::of_npy(kind).ok_or_else(unsupported)?;
    match order {
        b'<' => Ok((scalar, false)),
        b'>' => Ok((scalar, true)),
        b'|' if scalar.size() == 1 => Ok((scalar, false)),
        _ => Err(unsupported()),
    }
}

/// Returns the type of ids that a description stands for, or `None` for other types.
fn id_kind(descr: &Value<'_>) -> Option<IdKind> {
    if let Ok((scalar, is_big_endian)) = scalar(descr) {
        return scalar.is_integer().then_some(IdKind::Integer(scalar, is_big_endian));
    }
    let Value::Text([order, kind, digits @ ..]) = descr else { return None };
    let count = std::str::from_utf8(digits).ok()?.parse().ok()?;
    match kind {
        b'S' => Some(IdKind::Bytes(count)),
        b'U' => Some(IdKind::Characters(count, *order == b'>')),
        _ => None,
    }
}

/// Returns the size in bytes of a field of any type, or `None` for objects, whose size is not known.
fn size(descr: &Value<'_>, shape: Option<&Value<'_>>) -> Option<u64> {
    let item = match descr {
        Value::Text([b'<' | b'>' | b'|', kind, rest @ ..]) => {
            let digits = &rest[..rest.iter().take_while(|b| b.is_ascii_digit()).count()];
            let number = std::str::from_utf8(digits).ok()?.parse::<u64>().ok()?;
            match kind {
                b'O' => return None,
                b'U' => number.checked_mul(4)?, // characters
                _ => number,
            }
        }
        Value::List(fields) => fields.iter().try_fold(0u64, |sum, field| {
            let Value::Tuple(parts) = field else { return None };
            sum.checked_add(size(parts.get(1)?, parts.get(2))?)
        })?,
        _ => return None,
    };
    match shape {
        None => Some(item),
        Some(&Value::Integer(length)) => item.checked_mul(length),
        Some(Value::Tuple(lengths)) => lengths.iter().try_fold(item, |product, length| match length {
            &Value::Integer(length) => product.checked_mul(length),
            _ => None,
        }),
        Some(_) => None,
    }
}

/// Reads the rows of an array that has all x first.
fn read_columns<const N: usize>(
    bytes: &mut ByteReader<impl BufRead>,
    array: &Array<N>,
) -> Result<Vec<[f64; N]>, Reason> {
    let mut rows = Vec::new();
    let columns = if array.is_flat { 2 } else { N };
    for (axis, c) in array.coordinates.iter().take(columns).enumerate() {
        for i in 0..array.count {
            let x = coordinate(bytes, c)?;
            if axis == 0 {
                rows.try_reserve(1).map_err(Reason::Memory)?;
                let mut row = [0.0; N];
                row[0] = x;
                rows.push(row);
            } else if let Some(row) = usize::try_from(i).ok().and_then(|i| rows.get_mut(i)) {
                row[axis] = x;
            }
        }
    }
    Ok(rows)
}

/// Reads an item, whose parts have these offsets in ascending order. The id replaces the previous one.
fn read_row<const N: usize>(
    bytes: &mut ByteReader<impl BufRead>,
    array: &Array<N>,
    parts: &[(u64, Part)],
    id: &mut Vec<u8>,
) -> Result<[f64; N], Reason> {
    let mut row = [0.0; N];
    let mut offset = 0;
    for &(start, part) in parts {
        if start > offset {
            bytes.skip(start - offset)?;
        }
        offset = start
            + match part {
                Part::Coordinate(axis) => {
                    let c = &array.coordinates[axis];
                    row[axis] = coordinate(bytes, c)?;
                    c.scalar.size() as u64
                }
                Part::Id(kind) => read_id(bytes, kind, id)?,
            };
    }
    if array.size > offset {
        bytes.skip(array.size - offset)?;
    }
    Ok(row)
}

/// Reads an id as text, and returns its length in the file. The text ends before the zeros that pad it.
fn read_id(bytes: &mut ByteReader<impl BufRead>, kind: IdKind, id: &mut Vec<u8>) -> Result<u64, Reason> {
    id.clear();
    let len = match kind {
        IdKind::Integer(scalar, is_big_endian) => {
            // All types of integers fit into 128 bits.
            let number = match scalar {
                Scalar::I64 => i128::from(i64::from_le_bytes(bytes.ordered(is_big_endian)?)),
                Scalar::U64 => i128::from(u64::from_le_bytes(bytes.ordered(is_big_endian)?)),
                #[allow(clippy::cast_possible_truncation, reason = "an integer of at most 32 bits")]
                _ => bytes.number(scalar, is_big_endian)? as i128,
            };
            id.extend_from_slice(number.to_string().as_bytes());
            scalar.size() as u64
        }
        IdKind::Bytes(count) => {
            for _ in 0..count {
                id.try_reserve(1).map_err(Reason::Memory)?;
                id.push(u8::from_le_bytes(bytes.array()?));
            }
            count
        }
        IdKind::Characters(count, is_big_endian) => {
            for _ in 0..count {
                let code = u32::from_le_bytes(bytes.ordered(is_big_endian)?);
                let character = char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER);
                id.try_reserve(4).map_err(Reason::Memory)?;
                id.extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes());
            }
            4 * count
        }
    };
    id.truncate(id.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1));
    Ok(len)
}

fn coordinate(bytes: &mut ByteReader<impl BufRead>, c: &Coordinate) -> Result<f64, Reason> {
    bytes.number(c.scalar, c.big_endian)
}
