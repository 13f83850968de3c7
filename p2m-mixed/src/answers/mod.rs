//! Writers of answers to queries.

mod columns;
mod names;
mod rays;
mod records;

pub use columns::{AnswerColumn, AnswerEncoder, AnswerRecord};
pub use rays::{HitEncoder, HitWriter, NumberEncoder, NumberWriter};
pub use records::npy_header;

use crate::{AnswerFormat, Object};
use nalgebra::Point3;
use p2m_core::Closest;
use records::Records;
use std::io::{self, Write};

/// Writes answers one by one, in any [`AnswerFormat`].
///
/// Every answer is written at once, so `writer` should have a buffer. A file contains the queries, and
/// [`read_points`](crate::read_points) reads them.
///
/// # CSV
/// The columns `qx,qy,qz,x,y,z,distance,primitive,feature` are the query, the closest point, its distance, the id of
/// the primitive, and the feature of the primitive that has the point, as [`Feature`](p2m_core::Feature) displays it.
/// Numbers have the fewest digits that read back as the same number. The last six columns are empty if there is no
/// answer. With [objects](Self::with_objects) there is a column `object` with the name of the object that the primitive
/// belongs to, which is empty if it belongs to none.
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
///              ('barycentric', '<f8', (3,)), ('primitive', '<i4'), ('feature_kind', '<i2'), ('feature_number',
/// '<i2')])
/// ```
///
/// # PLY
/// The file is a point cloud of the queries, binary and little-endian. Each `vertex` has the properties `double` `x`,
/// `y`, `z` (the query), `cx`, `cy`, `cz` (the closest point) and `distance`, `int` `primitive`, `feature_kind` and
/// `feature_number`, as above. Viewers can colour it by distance.
///
/// These are the columns by default. [`with_columns`](Self::with_columns) chooses among all of [`AnswerColumn`].
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
    encoder: AnswerEncoder,
}

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
    /// arrays and point clouds have none by default.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn with_objects(writer: W, format: AnswerFormat, count: u64, objects: &[Object]) -> io::Result<Self> {
        let columns = AnswerColumn::defaults(format, !objects.is_empty());
        Self::with_columns(writer, AnswerEncoder::new(format, objects, &columns), Some(count))
    }

    /// Starts a file of `count` answers with the columns of an encoder. Without a count, NPY and PLY files are kept in
    /// memory until they are finished, because their header has the number of records.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn with_columns(writer: W, encoder: AnswerEncoder, count: Option<u64>) -> io::Result<Self> {
        Ok(Self { records: Records::new(writer, encoder.header(), count)?, encoder })
    }

    /// Returns the encoder of the records of this file.
    #[must_use]
    pub fn encoder(&self) -> AnswerEncoder {
        self.encoder.clone()
    }

    /// Writes the answer to a query. The column `number`, if there is one, has the number of answers so far, and
    /// `signed_distance` has NaN.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more answers than announced.
    pub fn write(&mut self, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
        let record = AnswerRecord { number: self.records.count(), query, answer, signed_distance: f64::NAN };
        self.records.write(|out| self.encoder.encode(&record, out))
    }

    /// Writes `count` records that the [`encoder`](Self::encoder) has encoded.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more answers than announced.
    pub fn write_encoded(&mut self, count: u64, records: &[u8]) -> io::Result<()> {
        self.records.append(count, records)
    }

    /// Ends the file and returns the flushed writer.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for fewer answers than announced.
    pub fn finish(self) -> io::Result<W> {
        self.records.finish()
    }
}
