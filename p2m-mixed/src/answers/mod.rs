//! Writers of answers to queries.

mod names;
mod rays;
mod records;

pub use rays::{HitWriter, NumberWriter};
pub use records::npy_header;

use crate::{AnswerFormat, Object};
use nalgebra::Point3;
use names::Names;
use p2m_core::{Closest, Feature};
use records::{Fields, Header, Records};
use std::io::{self, Write};

/// Writes answers one by one, in any [`AnswerFormat`].
///
/// Every answer is written at once, so `writer` should have a buffer. A file contains the queries, and
/// [`read_points`](crate::read_points) reads them.
///
/// # CSV
/// The columns `qx,qy,qz,x,y,z,distance,primitive,feature` are the query, the closest point, its distance, the id of
/// the primitive, and the feature of the primitive that has the point, as [`Feature`] displays it. Numbers have the
/// fewest digits that read back as the same number. The last six columns are empty if there is no answer. With
/// [objects](Self::with_objects) there is a column `object` with the name of the object that the primitive belongs to,
/// which is empty if it belongs to none.
///
/// # NPY
/// The file is a structured array of shape `(count,)`, little-endian and without gaps. A record has 96 bytes, and every
/// number is at a multiple of its size:
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
/// The file is a point cloud of the queries, binary and little-endian. Each `vertex` has the properties `double` `x`,
/// `y`, `z` (the query), `cx`, `cy`, `cz` (the closest point) and `distance`, `int` `primitive`, `char` `feature_kind`
/// and `feature_number`, as above. Viewers can colour it by distance.
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
    records: Records<W>,
    format: AnswerFormat,
    names: Names,
}

/// The size of a record of an array.
const RECORD_BYTES: usize = 96;
/// The size of a vertex of a PLY file.
const VERTEX_BYTES: usize = 62;

impl<W: Write> AnswerWriter<W> {
    /// Starts a file of `count` answers.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn new(writer: W, format: AnswerFormat, count: u64) -> io::Result<Self> {
        Self::with_objects(writer, format, count, &[])
    }

    /// Starts a file of `count` answers with the names of objects.
    ///
    /// The objects are [`Scene::objects`](crate::Scene::objects). A CSV table has a column of names if there are any;
    /// arrays and point clouds have no names.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn with_objects(writer: W, format: AnswerFormat, count: u64, objects: &[Object]) -> io::Result<Self> {
        let names = Names::new(objects);
        let header = match format {
            AnswerFormat::Csv => Header::Line(names.header("qx,qy,qz,x,y,z,distance,primitive,feature")),
            AnswerFormat::Npy => Header::Npy(
                "('query', '<f8', (3,)), ('point', '<f8', (3,)), ('distance', '<f8'), ('lower_bound', '<f8'), \
                ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), ('feature_number', '<i2')"
                    .to_owned(),
            ),
            AnswerFormat::Ply => {
                let doubles = ["x", "y", "z", "cx", "cy", "cz", "distance"].map(|name| ("double", name));
                let others = [("int", "primitive"), ("char", "feature_kind"), ("char", "feature_number")];
                Header::Ply(doubles.into_iter().chain(others).collect())
            }
        };
        Ok(Self { records: Records::new(writer, header, Some(count))?, format, names })
    }

    /// Writes the answer to a query.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more answers than announced.
    pub fn write(&mut self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
        let out = self.records.next()?;
        match self.format {
            AnswerFormat::Csv => {
                row(out, query, answer)?;
                self.names.end_line(out, answer.map(|a| a.primitive))
            }
            AnswerFormat::Npy => {
                let mut record = Fields::<RECORD_BYTES>::default();
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
                out.write_all(&record.bytes)
            }
            AnswerFormat::Ply => {
                let mut vertex = Fields::<VERTEX_BYTES>::default();
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
                out.write_all(&vertex.bytes)
            }
        }
    }

    /// Ends the file and returns the flushed writer.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for fewer answers than announced.
    pub fn finish(self) -> io::Result<W> {
        self.records.finish()
    }
}

/// Writes the columns of an answer. `{:?}` writes the shortest number that reads back the same, with an exponent if it
/// is far from 1.
fn row(out: &mut dyn Write, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
    write!(out, "{:?},{:?},{:?},", query.x, query.y, query.z)?;
    match answer {
        None => write!(out, ",,,,,"),
        Some(Closest { point, distance, primitive, feature, .. }) => {
            write!(out, "{:?},{:?},{:?},{distance:?},{primitive},{feature}", point.x, point.y, point.z)
        }
    }
}

/// Returns the id of the primitive, which is below 2^30, or -1 if there is no answer.
fn primitive(answer: Option<&Closest<f64>>) -> i32 {
    answer.and_then(|a| i32::try_from(a.primitive.index()).ok()).unwrap_or(-1)
}

/// Returns the kind and the number of the feature, or -1 twice if there is no answer.
fn feature(answer: Option<&Closest<f64>>) -> [i8; 2] {
    match answer.map(|a| a.feature) {
        None => [-1, -1],
        Some(Feature::Vertex(i)) => [0, i.cast_signed()], // at most 2
        Some(Feature::Edge(i)) => [1, i.cast_signed()],
        Some(Feature::Face) => [2, 0],
    }
}
