//! Answers to files.

use crate::AnswerFormat;
use nalgebra::Point3;
use p2m_core::{Closest, Feature};
use std::io::{self, ErrorKind, Write};

/// Writes answers one by one, in any [`AnswerFormat`]; the file is never in memory, but the writer should have a
/// buffer.
///
/// Each file holds the queries, so [`read_points`](crate::read_points) asks the same questions again.
///
/// # CSV
/// The columns `qx,qy,qz,x,y,z,distance,primitive,feature`: the query, the closest point, its distance, the id of the
/// primitive, and the part of it that holds the point, in the words of [`Feature`]. Numbers are the shortest that read
/// back as the same ones. The last six are empty where there is no answer.
///
/// # NPY
/// A structured array of shape `(count,)`, little-endian, without gaps; a record has 96 bytes, and every number stands
/// at a multiple of its size:
///
/// | field | bytes | type | without an answer |
/// |---|---|---|---|
/// | `query` | 0..24 | `<f8`, shape `(3,)` | the query |
/// | `point` | 24..48 | `<f8`, shape `(3,)` | NaN |
/// | `distance` | 48..56 | `<f8` | NaN |
/// | `lower_bound` | 56..64 | `<f8` | NaN |
/// | `barycentric` | 64..88 | `<f8`, shape `(3,)` | NaN |
/// | `primitive` | 88..92 | `<i4` | -1 |
/// | `feature_kind` | 92..94 | `<i2`: 0 a vertex, 1 an edge, 2 the face | -1 |
/// | `feature_number` | 94..96 | `<i2`: which vertex or edge, 0 for the face | -1 |
///
/// ```python
/// numpy.dtype([('query', '<f8', (3,)), ('point', '<f8', (3,)), ('distance', '<f8'), ('lower_bound', '<f8'),
///              ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), ('feature_number', '<i2')])
/// ```
///
/// # PLY
/// A point cloud of the queries, binary and little-endian: each `vertex` has the properties `double` `x`, `y`, `z` (the
/// query), `cx`, `cy`, `cz` (the closest point) and `distance`, `int` `primitive`, `char` `feature_kind` and
/// `feature_number`, as above. Viewers can colour it by distance.
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, Point};
/// use p2m_mixed::{AnswerFormat, AnswerWriter};
/// use nalgebra::Point3;
///
/// let scene = [Point::new(Point3::new(0.0, 0.0, 0.0))];
/// let query = Point3::new(0.0, 3.0, 4.0);
/// let answer = BruteForce::new(&scene).unwrap().closest_point(&query);
/// let mut writer = AnswerWriter::new(Vec::new(), AnswerFormat::Csv, 1)?;
/// writer.write(&query, answer.as_ref())?;
/// let table = String::from_utf8(writer.finish()?).unwrap();
/// assert_eq!(table.lines().nth(1), Some("0.0,3.0,4.0,0.0,0.0,0.0,5.0,0,vertex0"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct AnswerWriter<W: Write> {
    writer: W,
    format: AnswerFormat,
    /// Announced, and not yet written.
    count: u64,
    left: u64,
}

/// Bytes of a record of an array, and of a vertex.
const RECORD: usize = 96;
const VERTEX: usize = 62;

impl<W: Write> AnswerWriter<W> {
    /// Begins a file of `count` answers.
    ///
    /// # Errors
    /// Those of `writer`.
    pub fn new(mut writer: W, format: AnswerFormat, count: u64) -> io::Result<Self> {
        match format {
            AnswerFormat::Csv => writeln!(writer, "qx,qy,qz,x,y,z,distance,primitive,feature")?,
            AnswerFormat::Npy => writer.write_all(&npy_header(count))?,
            AnswerFormat::Ply => writer.write_all(ply_header(count).as_bytes())?,
        }
        Ok(Self { writer, format, count, left: count })
    }

    /// Writes the answer to a query.
    ///
    /// # Errors
    /// Those of the writer, and [`ErrorKind::InvalidInput`] for more answers than announced.
    pub fn write(&mut self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            let count = self.count;
            io::Error::new(ErrorKind::InvalidInput, format!("there are more answers than the {count} announced"))
        })?;
        match self.format {
            AnswerFormat::Csv => self.row(query, answer),
            AnswerFormat::Npy => {
                let mut record = Fields::<RECORD>::default();
                record.numbers(query.coords.as_ref());
                match answer {
                    None => record.numbers(&[f64::NAN; 8]),
                    Some(a) => {
                        record.numbers(a.point.coords.as_ref());
                        record.numbers(&[a.distance, a.lower_bound]);
                        record.numbers(&a.barycentric);
                    }
                }
                record.add(primitive(answer).to_le_bytes());
                feature(answer).into_iter().for_each(|x| record.add(i16::from(x).to_le_bytes()));
                self.writer.write_all(&record.bytes)
            }
            AnswerFormat::Ply => {
                let mut vertex = Fields::<VERTEX>::default();
                vertex.numbers(query.coords.as_ref());
                match answer {
                    None => vertex.numbers(&[f64::NAN; 4]),
                    Some(a) => {
                        vertex.numbers(a.point.coords.as_ref());
                        vertex.numbers(&[a.distance]);
                    }
                }
                vertex.add(primitive(answer).to_le_bytes());
                feature(answer).into_iter().for_each(|x| vertex.add(x.to_le_bytes()));
                self.writer.write_all(&vertex.bytes)
            }
        }
    }

    /// `{:?}` writes the shortest number that reads back the same, with an exponent where it is far from 1.
    fn row(&mut self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
        write!(self.writer, "{:?},{:?},{:?},", query.x, query.y, query.z)?;
        match answer {
            None => writeln!(self.writer, ",,,,,"),
            Some(Closest { point, distance, primitive, feature, .. }) => {
                writeln!(self.writer, "{:?},{:?},{:?},{distance:?},{primitive},{feature}", point.x, point.y, point.z)
            }
        }
    }

    /// Ends the file and gives the writer back, flushed.
    ///
    /// # Errors
    /// Those of the writer, and [`ErrorKind::InvalidInput`] if there were fewer answers than announced.
    pub fn finish(mut self) -> io::Result<W> {
        if self.left > 0 {
            let message = format!("there are {} answers, not the {} announced", self.count - self.left, self.count);
            return Err(io::Error::new(ErrorKind::InvalidInput, message));
        }
        self.writer.flush()?;
        Ok(self.writer)
    }
}

/// -1 if there is none; ids end at 2^30.
fn primitive(answer: Option<&Closest<f64>>) -> i32 {
    answer.and_then(|a| i32::try_from(a.primitive.index()).ok()).unwrap_or(-1)
}

/// Kind and number.
fn feature(answer: Option<&Closest<f64>>) -> [i8; 2] {
    match answer.map(|a| a.feature) {
        None => [-1, -1],
        Some(Feature::Vertex(i)) => [0, i.cast_signed()], // at most 2
        Some(Feature::Edge(i)) => [1, i.cast_signed()],
        Some(Feature::Face) => [2, 0],
    }
}

/// A header as NumPy writes it: version 1.0, filled up to a multiple of 64 bytes.
fn npy_header(count: u64) -> Vec<u8> {
    let mut description = format!(
        "{{'descr': [('query', '<f8', (3,)), ('point', '<f8', (3,)), ('distance', '<f8'), ('lower_bound', '<f8'), \
        ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), ('feature_number', '<i2')], \
        'fortran_order': False, 'shape': ({count},), }}"
    );
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

fn ply_header(count: u64) -> String {
    let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n");
    for name in ["x", "y", "z", "cx", "cy", "cz", "distance"] {
        header += &format!("property double {name}\n");
    }
    header + "property int primitive\nproperty char feature_kind\nproperty char feature_number\nend_header\n"
}

/// A record that is filled from its beginning.
struct Fields<const N: usize> {
    bytes: [u8; N],
    end: usize,
}

impl<const N: usize> Default for Fields<N> {
    fn default() -> Self {
        Self { bytes: [0; N], end: 0 }
    }
}

impl<const N: usize> Fields<N> {
    fn add<const M: usize>(&mut self, bytes: [u8; M]) {
        self.bytes[self.end..self.end + M].copy_from_slice(&bytes);
        self.end += M;
    }

    fn numbers(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.add(x.to_le_bytes()));
    }
}
