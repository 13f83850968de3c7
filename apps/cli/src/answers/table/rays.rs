//! Records of rays: their hits, or a number for each.

use super::AnswerFormat;
use super::names::Names;
use super::records::{Header, integer_bytes, put_columns, put_integer, put_numbers, put_text};
use p2m_core::{Hit, Ray, Side};
use p2m_mixed::Object;

/// Encodes hits as records, each with its ray and the number of the ray.
///
/// | CSV | NPY | PLY | without a hit |
/// |---|---|---|---|
/// | `ox,oy,oz` | `origin`, `<f8`, shape `(3,)` | `double` `x`, `y`, `z` | of the ray |
/// | `dx,dy,dz` | `direction`, `<f8`, shape `(3,)` | `double` `nx`, `ny`, `nz`, the normal | of the ray |
/// | `ray`, the first column | `ray`, `<i8` | `double` `ray` | the number of the ray |
/// | `parameter` | `parameter`, `<f8` | `double` `parameter` | NaN |
/// | `x,y,z` | `point`, `<f8`, shape `(3,)` | `double` `hx`, `hy`, `hz` | NaN |
/// | `w0,w1,w2`, the last columns | `barycentric`, `<f8`, shape `(3,)` | `double` `w0`, `w1`, `w2` | NaN |
/// | `primitive` | `primitive`, `<i4` | `int` `primitive` | -1 |
/// | `side`: `front`, `back` or `along` | `side`, `<i4`: 0, 1 or 2 | `int` `side` | -1 |
/// | `object`, the name, if there are objects | | | |
///
/// Without a hit, the fields of CSV after the ray are empty. A record of NPY or PLY has 120 bytes, and in NPY every
/// number is at a multiple of its size.
pub(crate) struct HitEncoder<'a> {
    format: AnswerFormat,
    names: Names<'a>,
}

/// Encodes a number for each ray as records, which have the columns `ray,ox,oy,oz,dx,dy,dz` of [`HitEncoder`] and one
/// more, whose type is `<i8` in NPY and `double` in PLY.
pub(crate) struct NumberEncoder {
    format: AnswerFormat,
    /// The name of the number, a word of letters.
    name: &'static str,
}

impl<'a> HitEncoder<'a> {
    /// Makes an encoder. The objects are those of the scene.
    pub(crate) fn new(format: AnswerFormat, objects: &'a [Object]) -> Self {
        Self { format, names: Names(objects) }
    }

    /// Returns the header of a file.
    pub(crate) fn header(&self) -> Header {
        match self.format {
            AnswerFormat::Csv => csv_header(&self.names.header("parameter,x,y,z,primitive,side,w0,w1,w2")),
            AnswerFormat::Npy => npy_header(
                "('parameter', '<f8'), ('point', '<f8', (3,)), ('barycentric', '<f8', (3,)), ('primitive', '<i4'), \
                ('side', '<i4')",
            ),
            AnswerFormat::Ply => {
                let doubles = ["parameter", "hx", "hy", "hz", "w0", "w1", "w2"].map(|name| ("double", name));
                ply_header(doubles.into_iter().chain([("int", "primitive"), ("int", "side")]))
            }
        }
    }

    /// Appends the record of a hit of a ray, or of a ray without a hit. `number` is the number of the ray.
    pub(crate) fn encode(&self, number: u64, ray: &Ray, hit: Option<&Hit>, out: &mut Vec<u8>) {
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

impl NumberEncoder {
    /// Makes an encoder of numbers that are called `name`.
    pub(crate) fn new(format: AnswerFormat, name: &'static str) -> Self {
        Self { format, name }
    }

    /// Returns the header of a file.
    pub(crate) fn header(&self) -> Header {
        let name = self.name;
        match self.format {
            AnswerFormat::Csv => csv_header(name),
            AnswerFormat::Npy => npy_header(&format!("('{name}', '<i8')")),
            AnswerFormat::Ply => ply_header([("double", name)].into_iter()),
        }
    }

    /// Appends the record of a value for a ray. `number` is the number of the ray.
    pub(crate) fn encode(&self, number: u64, ray: &Ray, value: u64, out: &mut Vec<u8>) {
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
