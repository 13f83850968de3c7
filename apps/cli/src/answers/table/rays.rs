//! Records of rays: their hits, or a number for each.

use super::AnswerFormat;
use super::records::Header;
use super::values::{Kind, Layout, Value, header, put_record};
use p2m_core::{Hit, Ray};
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
    /// The objects of the scene.
    objects: &'a [Object],
}

/// Encodes a number for each ray as records, which have the columns `ray,ox,oy,oz,dx,dy,dz` of [`HitEncoder`] and one
/// more, whose type is `<i8` in NPY and `double` in PLY.
pub(crate) struct NumberEncoder {
    format: AnswerFormat,
    /// The name of the number, a word of letters.
    name: &'static str,
}

/// The number, the origin and the direction of a ray.
const RAY: [Layout<'static>; 3] = [
    Layout::new("ray", Kind::Integer, &["ray"]),
    Layout::new("origin", Kind::Triple, &["ox", "oy", "oz"]).in_clouds(&["x", "y", "z"]),
    Layout::new("direction", Kind::Triple, &["dx", "dy", "dz"]).in_clouds(&["nx", "ny", "nz"]),
];

const HIT: [Layout<'static>; 5] = [
    Layout::new("parameter", Kind::Number, &["parameter"]),
    Layout::new("point", Kind::Triple, &["x", "y", "z"]).in_clouds(&["hx", "hy", "hz"]),
    Layout::new("primitive", Kind::Index, &["primitive"]),
    Layout::new("side", Kind::Side, &["side"]),
    Layout::new("barycentric", Kind::Triple, &["w0", "w1", "w2"]),
];

/// Arranges what belongs to [`RAY`] and [`HIT`] as a format has it. In binary records, numbers of 8 bytes come first.
fn arranged<T>(
    format: AnswerFormat,
    [number, origin, direction]: [T; 3],
    [parameter, point, primitive, side, weights]: [T; 5],
) -> [T; 8] {
    match format {
        AnswerFormat::Csv => [number, origin, direction, parameter, point, primitive, side, weights],
        _ => [origin, direction, number, parameter, point, weights, primitive, side],
    }
}

/// Returns the values of the columns [`RAY`].
fn ray_values(number: u64, ray: &Ray) -> [Value<'static>; 3] {
    let (origin, direction) = (ray.origin().coords.into(), ray.direction().into());
    [Value::Integer(number), Value::Triple(Some(origin)), Value::Triple(Some(direction))]
}

impl<'a> HitEncoder<'a> {
    /// Makes an encoder. The objects are those of the scene.
    pub(crate) fn new(format: AnswerFormat, objects: &'a [Object]) -> Self {
        Self { format, objects }
    }

    /// Returns whether the last column has names of objects.
    fn has_objects(&self) -> bool {
        self.format == AnswerFormat::Csv && !self.objects.is_empty()
    }

    /// Returns the header of a file.
    pub(crate) fn header(&self) -> Header {
        let object = self.has_objects().then_some(Layout::new("object", Kind::Index, &["object"]));
        header(self.format, &arranged(self.format, RAY, HIT).into_iter().chain(object).collect::<Vec<_>>())
    }

    /// Appends the record of a hit of a ray, or of a ray without a hit. `number` is the number of the ray.
    pub(crate) fn encode(&self, number: u64, ray: &Ray, hit: Option<&Hit>, out: &mut Vec<u8>) {
        let primitive = hit.map(|hit| hit.primitive);
        let values = [
            Value::Number(hit.map(|hit| hit.parameter)),
            Value::Triple(hit.map(|hit| hit.point().coords.into())),
            Value::Index(primitive),
            Value::Side(hit.map(|hit| hit.side)),
            Value::Triple(hit.map(Hit::barycentric)),
        ];
        let object = self.has_objects().then(|| Value::object_of(self.objects, primitive));
        put_record(self.format, arranged(self.format, ray_values(number, ray), values).into_iter().chain(object), out);
    }
}

impl NumberEncoder {
    /// Makes an encoder of numbers that are called `name`.
    pub(crate) fn new(format: AnswerFormat, name: &'static str) -> Self {
        Self { format, name }
    }

    /// Returns the header of a file.
    pub(crate) fn header(&self) -> Header {
        let [ray, origin, direction] = RAY;
        let names = [self.name];
        let number = Layout::new(self.name, Kind::Integer, &names);
        match self.format {
            AnswerFormat::Csv => header(self.format, &[ray, origin, direction, number]),
            _ => header(self.format, &[origin, direction, ray, number]),
        }
    }

    /// Appends the record of a value for a ray. `number` is the number of the ray.
    pub(crate) fn encode(&self, number: u64, ray: &Ray, value: u64, out: &mut Vec<u8>) {
        let ([number, origin, direction], value) = (ray_values(number, ray), Value::Integer(value));
        match self.format {
            AnswerFormat::Csv => put_record(self.format, [number, origin, direction, value], out),
            _ => put_record(self.format, [origin, direction, number, value], out),
        }
    }
}
