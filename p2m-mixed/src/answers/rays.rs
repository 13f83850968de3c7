//! Writers of hits and numbers for rays.

use super::names::Names;
use super::records::{Header, Records, integer_bytes, put_columns, put_integer, put_numbers, put_text};
use crate::{AnswerFormat, Object};
use p2m_core::{Hit, Ray, Side};
use std::io::{self, Write};

/// Writes hits of rays one by one, each with its ray and the number of the ray.
///
/// A ray without a hit may have a record or none. A file contains the rays, and [`read_rays`](crate::read_rays) reads
/// one ray for each record.
///
/// # CSV
/// The columns `ray,ox,oy,oz,dx,dy,dz,parameter,x,y,z,primitive,side,w0,w1,w2` are the number of the ray, its origin
/// and its direction, the parameter and the point of the hit, the id of the primitive, the side that is hit (`front`,
/// `back` or `along`, see [`Side`]), and the weights of its vertices. Numbers have the fewest digits that read back as
/// the same number. The last nine columns are empty if there is no hit. With [objects](Self::with_objects) there is a
/// column `object` with the name of the object that is hit, which is empty if the primitive belongs to none.
///
/// # NPY
/// The file is a structured array of shape `(count,)`, little-endian and without gaps. A record has 120 bytes, and
/// every number is at a multiple of its size:
///
/// | field | bytes | type | without a hit |
/// |---|---|---|---|
/// | `origin` | 0..24 | `<f8`, shape `(3,)` | of the ray |
/// | `direction` | 24..48 | `<f8`, shape `(3,)` | of the ray |
/// | `ray` | 48..56 | `<i8` | the number of the ray |
/// | `parameter` | 56..64 | `<f8` | NaN |
/// | `point` | 64..88 | `<f8`, shape `(3,)` | NaN |
/// | `barycentric` | 88..112 | `<f8`, shape `(3,)` | NaN |
/// | `primitive` | 112..116 | `<i4` | -1 |
/// | `side` | 116..120 | `<i4`: 0 the front, 1 the back, 2 along | -1 |
///
/// # PLY
/// The file is a point cloud of the origins with the directions as normals, binary and little-endian. Each `vertex` has
/// the properties `double` `x`, `y`, `z`, `nx`, `ny`, `nz`, `ray`, `parameter`, `hx`, `hy`, `hz` (the point of the
/// hit), `w0`, `w1`, `w2`, `int` `primitive` and `side`, as above. Viewers can colour it by parameter.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_core::{BruteForce, Ray, RayQuery, Segment};
/// use p2m_mixed::{AnswerFormat, HitWriter};
///
/// let scene = [Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0))];
/// let ray = Ray::new(&Point3::new(1.0, 0.0, 5.0), &Vector3::new(0.0, 0.0, -2.0)).unwrap();
/// let hit = BruteForce::new(&scene).unwrap().first_intersection(&ray);
/// let mut writer = HitWriter::new(Vec::new(), AnswerFormat::Csv, Some(1))?;
/// writer.write(0, &ray, hit.as_ref())?;
/// let table = String::from_utf8(writer.finish()?).unwrap();
/// assert_eq!(table.lines().nth(1), Some("0,1.0,0.0,5.0,0.0,0.0,-2.0,2.5,1.0,0.0,0.0,0,along,0.75,0.25,0.0"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct HitWriter<W: Write> {
    records: Records<W>,
    encoder: HitEncoder,
}

/// Encodes hits as the records of a [`HitWriter`], for programs that encode on several threads.
#[derive(Clone, Debug)]
pub struct HitEncoder {
    format: AnswerFormat,
    names: Names,
}

/// Writes a number for each ray, in the order of the rays.
///
/// A file contains the rays, and [`read_rays`](crate::read_rays) reads them.
///
/// CSV has the columns `ray,ox,oy,oz,dx,dy,dz` of [`HitWriter`] and one more under the name of the number. NPY is a
/// structured array with the fields `origin`, `direction`, `ray` of [`HitWriter`] and the number, of type `<i8`. PLY is
/// a cloud with the properties `x`, `y`, `z`, `nx`, `ny`, `nz`, `ray` of [`HitWriter`] and the number, of type
/// `double`.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_core::Ray;
/// use p2m_mixed::{AnswerFormat, NumberWriter};
///
/// let ray = Ray::new(&Point3::origin(), &Vector3::new(0.0, 0.0, 1.0)).unwrap();
/// let mut writer = NumberWriter::new(Vec::new(), AnswerFormat::Csv, "crossings", 1)?;
/// writer.write(0, &ray, 3)?;
/// let table = String::from_utf8(writer.finish()?).unwrap();
/// assert_eq!(table, "ray,ox,oy,oz,dx,dy,dz,crossings\n0,0.0,0.0,0.0,0.0,0.0,1.0,3\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct NumberWriter<W: Write> {
    records: Records<W>,
    encoder: NumberEncoder,
}

/// Encodes numbers as the records of a [`NumberWriter`], for programs that encode on several threads.
#[derive(Clone, Copy, Debug)]
pub struct NumberEncoder {
    format: AnswerFormat,
}

impl<W: Write> HitWriter<W> {
    /// Starts a file of `count` records. Without a count, NPY and PLY files are kept in memory until they are finished,
    /// because their header has the number of records.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn new(writer: W, format: AnswerFormat, count: Option<u64>) -> io::Result<Self> {
        Self::with_objects(writer, format, count, &[])
    }

    /// Starts a file of `count` records with the names of objects.
    ///
    /// The objects are [`Scene::objects`](crate::Scene::objects), and a CSV table has a column of their names. Without
    /// a count, NPY and PLY files are kept in memory until they are finished.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn with_objects(writer: W, format: AnswerFormat, count: Option<u64>, objects: &[Object]) -> io::Result<Self> {
        let names = Names::new(objects);
        let header = match format {
            AnswerFormat::Csv => csv_header(&names.header("parameter,x,y,z,primitive,side,w0,w1,w2")),
            AnswerFormat::Npy => npy_header(
                "('parameter', '<f8'), ('point', '<f8', (3,)), ('barycentric', '<f8', (3,)), ('primitive', '<i4'), \
                ('side', '<i4')",
            ),
            AnswerFormat::Ply => {
                let doubles = ["parameter", "hx", "hy", "hz", "w0", "w1", "w2"].map(|name| ("double", name));
                ply_header(doubles.into_iter().chain([("int", "primitive"), ("int", "side")]))
            }
        };
        let records = Records::new(writer, header, count)?;
        Ok(Self { records, encoder: HitEncoder { format, names } })
    }

    /// Returns the encoder of the records of this file.
    #[must_use]
    pub fn encoder(&self) -> HitEncoder {
        self.encoder.clone()
    }

    /// Writes `count` records that the [`encoder`](Self::encoder) has encoded.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more records than announced.
    pub fn write_encoded(&mut self, count: u64, records: &[u8]) -> io::Result<()> {
        self.records.append(count, records)
    }

    /// Writes a hit of a ray, or a record without a hit. `number` is the number of the ray.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more records than announced.
    pub fn write(&mut self, number: u64, ray: &Ray, hit: Option<&Hit>) -> io::Result<()> {
        self.records.write(|out| self.encoder.encode(number, ray, hit, out))
    }

    /// Ends the file and returns the flushed writer.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for fewer records than announced.
    pub fn finish(self) -> io::Result<W> {
        self.records.finish()
    }
}

impl HitEncoder {
    /// Appends the record of a hit of a ray, or of a ray without a hit. `number` is the number of the ray.
    pub fn encode(&self, number: u64, ray: &Ray, hit: Option<&Hit>, out: &mut Vec<u8>) {
        put_ray(self.format, number, ray, out);
        if self.format == AnswerFormat::Csv {
            let Some(hit) = hit else {
                out.extend_from_slice(b",,,,,,,,");
                return self.names.end_line(out, None);
            };
            let side: &[u8] = match hit.side {
                Side::Front => b",front,",
                Side::Back => b",back,",
                Side::Along => b",along,",
            };
            let ([x, y, z], [a, b, c]): ([f64; 3], _) = (hit.point().coords.into(), hit.barycentric());
            put_columns(out, &[hit.parameter, x, y, z]);
            put_integer(out, hit.primitive.index() as u64);
            out.extend_from_slice(side);
            put_columns(out, &[a, b]);
            put_text(out, c);
            return self.names.end_line(out, Some(hit.primitive));
        }
        match hit {
            None => put_numbers(out, &[f64::NAN; 7]),
            Some(hit) => {
                put_numbers(out, &[hit.parameter]);
                put_numbers(out, hit.point().coords.as_ref());
                put_numbers(out, &hit.barycentric());
            }
        }
        let primitive = hit.and_then(|hit| i32::try_from(hit.primitive.index()).ok()); // ids end at 2^30
        out.extend(primitive.unwrap_or(-1).to_le_bytes());
        let side: i32 = match hit.map(|hit| hit.side) {
            None => -1,
            Some(Side::Front) => 0,
            Some(Side::Back) => 1,
            Some(Side::Along) => 2,
        };
        out.extend(side.to_le_bytes());
    }
}

impl<W: Write> NumberWriter<W> {
    /// Starts a file of `count` numbers, which are called `name`. The name has to be a word of letters.
    ///
    /// # Errors
    /// Errors of `writer`.
    pub fn new(writer: W, format: AnswerFormat, name: &'static str, count: u64) -> io::Result<Self> {
        let header = match format {
            AnswerFormat::Csv => csv_header(name),
            AnswerFormat::Npy => npy_header(&format!("('{name}', '<i8')")),
            AnswerFormat::Ply => ply_header([("double", name)].into_iter()),
        };
        let records = Records::new(writer, header, Some(count))?;
        Ok(Self { records, encoder: NumberEncoder { format } })
    }

    /// Returns the encoder of the records of this file.
    #[must_use]
    pub fn encoder(&self) -> NumberEncoder {
        self.encoder
    }

    /// Writes `count` records that the [`encoder`](Self::encoder) has encoded.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more numbers than announced.
    pub fn write_encoded(&mut self, count: u64, records: &[u8]) -> io::Result<()> {
        self.records.append(count, records)
    }

    /// Writes a value for a ray. `number` is the number of the ray.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for more numbers than announced.
    pub fn write(&mut self, number: u64, ray: &Ray, value: u64) -> io::Result<()> {
        self.records.write(|out| self.encoder.encode(number, ray, value, out))
    }

    /// Ends the file and returns the flushed writer.
    ///
    /// # Errors
    /// Errors of the writer, and [`InvalidInput`](io::ErrorKind::InvalidInput) for fewer numbers than announced.
    pub fn finish(self) -> io::Result<W> {
        self.records.finish()
    }
}

impl NumberEncoder {
    /// Appends the record of a value for a ray. `number` is the number of the ray.
    pub fn encode(&self, number: u64, ray: &Ray, value: u64, out: &mut Vec<u8>) {
        put_ray(self.format, number, ray, out);
        match self.format {
            AnswerFormat::Csv => {
                put_integer(out, value);
                out.push(b'\n');
            }
            _ => out.extend(integer_bytes(self.format, value)),
        }
    }
}

/// Returns the header of a table with the columns of a ray and then others.
fn csv_header(columns: &str) -> Header {
    Header::Line(format!("ray,ox,oy,oz,dx,dy,dz,{columns}"))
}

/// Returns the header of an array with the fields of a ray and then others.
fn npy_header(fields: &str) -> Header {
    Header::Npy(format!("('origin', '<f8', (3,)), ('direction', '<f8', (3,)), ('ray', '<i8'), {fields}"))
}

/// Returns the header of a point cloud with the properties of a ray and then others.
fn ply_header(properties: impl Iterator<Item = (&'static str, &'static str)>) -> Header {
    let ray = ["x", "y", "z", "nx", "ny", "nz", "ray"].map(|name| ("double", name));
    Header::Ply(ray.into_iter().chain(properties).collect())
}

/// Appends the columns of a ray to a line, or its fields to a record.
fn put_ray(format: AnswerFormat, number: u64, ray: &Ray, out: &mut Vec<u8>) {
    let (origin, direction) = (ray.origin(), ray.direction());
    if format == AnswerFormat::Csv {
        put_integer(out, number);
        out.push(b',');
        put_columns(out, origin.coords.as_ref());
        return put_columns(out, direction.as_ref());
    }
    put_numbers(out, origin.coords.as_ref());
    put_numbers(out, direction.as_ref());
    out.extend(integer_bytes(format, number));
}
