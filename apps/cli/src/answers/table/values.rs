//! The values of records, and their bytes in every format.

use super::AnswerFormat;
use super::records::Header;
use p2m_core::{Feature, PrimitiveId, Side};
use p2m_mixed::Object;
use p2m_mixed::engine::object_number;

/// The kind of the values of a column. It decides their types in files. A missing value is an empty field in CSV, and NaN
/// or -1 elsewhere.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// A number of a query or a count.
    Integer,
    Number,
    Triple,
    Flag,
    /// The number of a primitive or an object, below 2^30; in CSV the name of an object.
    Index,
    /// Two columns in NPY and PLY: the kind and the number.
    Feature,
    Side,
    /// Only CSV has it.
    Text,
}

/// The names of a column and its kind.
#[derive(Clone, Copy)]
pub(super) struct Layout<'a> {
    /// The name of a column of three numbers in NPY, and of every column on the command line.
    pub(super) name: &'static str,
    kind: Kind,
    /// The names in CSV, and in NPY where it is only one.
    text: &'a [&'static str],
    /// The names in PLY.
    cloud: &'a [&'static str],
}

impl<'a> Layout<'a> {
    /// A column that has the same names in CSV and PLY.
    pub(super) const fn new(name: &'static str, kind: Kind, text: &'a [&'static str]) -> Self {
        Self { name, kind, text, cloud: text }
    }

    /// Changes the names in PLY.
    pub(super) const fn in_clouds(self, cloud: &'a [&'static str]) -> Self {
        Self { cloud, ..self }
    }

    /// Returns the fields of an array, as NumPy describes them.
    fn array(&self) -> String {
        let name = self.text[0];
        match self.kind {
            Kind::Integer => format!("('{name}', '<i8')"),
            Kind::Number => format!("('{name}', '<f8')"),
            Kind::Triple => format!("('{}', '<f8', (3,))", self.name),
            Kind::Flag => format!("('{name}', '|b1')"),
            Kind::Index | Kind::Side => format!("('{name}', '<i4')"),
            Kind::Feature => format!("('{name}_kind', '<i2'), ('{name}_number', '<i2')"),
            Kind::Text => String::new(),
        }
    }

    /// Returns the types and names of the properties of a point cloud. PLY has no integers of 64 bits.
    fn properties(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<'a> {
        let scalar = match self.kind {
            Kind::Integer | Kind::Number | Kind::Triple | Kind::Text => "double",
            Kind::Flag | Kind::Index | Kind::Feature | Kind::Side => "int",
        };
        self.cloud.iter().map(move |name| (scalar, *name))
    }
}

/// Returns the header of a file with these columns.
pub(super) fn header(format: AnswerFormat, columns: &[Layout<'_>]) -> Header {
    match format {
        AnswerFormat::Csv => Header::Line(columns.iter().flat_map(|c| c.text).copied().collect::<Vec<_>>().join(",")),
        AnswerFormat::Npy => Header::Npy(columns.iter().map(Layout::array).collect::<Vec<_>>().join(", ")),
        AnswerFormat::Ply => Header::Ply(columns.iter().flat_map(Layout::properties).collect()),
    }
}

/// A value of a record, or that there is none.
pub(super) enum Value<'a> {
    Integer(u64),
    Number(Option<f64>),
    Triple(Option<[f64; 3]>),
    Flag(bool),
    Index(Option<PrimitiveId>),
    /// The number of an object and its name.
    Object(Option<(usize, &'a str)>),
    Feature(Option<Feature>),
    Side(Option<Side>),
    Text(&'a str),
}

/// The names of features in the order of their codes, as [`Feature`] displays them.
const FEATURES: [&str; 7] = ["vertex0", "vertex1", "vertex2", "edge0", "edge1", "edge2", "face"];

impl<'a> Value<'a> {
    /// Returns the object that a primitive belongs to.
    pub(super) fn object_of(objects: &'a [Object], primitive: Option<PrimitiveId>) -> Self {
        let number = primitive.and_then(|primitive| object_number(objects, primitive));
        Self::Object(number.map(|number| (number, &*objects[number].name)))
    }

    /// Appends the value to a line of text, without a comma after it.
    fn put_text(self, out: &mut Vec<u8>) {
        match self {
            Self::Integer(number) => put_integer(out, number),
            Self::Number(Some(x)) => put_number(out, x),
            Self::Triple(Some(numbers)) => {
                for (k, x) in numbers.into_iter().enumerate() {
                    out.extend((k > 0).then_some(b','));
                    put_number(out, x);
                }
            }
            Self::Triple(None) => out.extend_from_slice(b",,"),
            Self::Flag(is_set) => put_integer(out, is_set.into()),
            Self::Index(Some(primitive)) => put_integer(out, primitive.index() as u64),
            Self::Feature(Some(feature)) => out.extend_from_slice(FEATURES[usize::from(feature.code())].as_bytes()),
            Self::Side(Some(Side::Front)) => out.extend_from_slice(b"front"),
            Self::Side(Some(Side::Back)) => out.extend_from_slice(b"back"),
            Self::Side(Some(Side::Along)) => out.extend_from_slice(b"along"),
            Self::Object(Some((_, name))) | Self::Text(name) => out.extend_from_slice(field(name).as_bytes()),
            Self::Number(None) | Self::Index(None) | Self::Feature(None) | Self::Side(None) | Self::Object(None) => {}
        }
    }

    /// Appends the value to a binary record, little-endian.
    #[inline(always)]
    fn put_bytes(self, format: AnswerFormat, out: &mut Vec<u8>) {
        let is_cloud = format == AnswerFormat::Ply;
        let index = |number: Option<usize>| number.and_then(|number| i32::try_from(number).ok()).unwrap_or(-1);
        match self {
            #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 rays")]
            Self::Integer(number) if is_cloud => out.extend_from_slice(&(number as f64).to_le_bytes()),
            Self::Integer(number) => out.extend_from_slice(&number.to_le_bytes()),
            Self::Number(x) => out.extend_from_slice(&x.unwrap_or(f64::NAN).to_le_bytes()),
            Self::Triple(numbers) => {
                out.extend_from_slice(numbers.unwrap_or([f64::NAN; 3]).map(f64::to_le_bytes).as_flattened())
            }
            Self::Flag(is_set) if is_cloud => out.extend_from_slice(&i32::from(is_set).to_le_bytes()),
            Self::Flag(is_set) => out.push(is_set.into()),
            Self::Index(primitive) => out.extend_from_slice(&index(primitive.map(PrimitiveId::index)).to_le_bytes()),
            Self::Object(object) => out.extend_from_slice(&index(object.map(|object| object.0)).to_le_bytes()),
            Self::Feature(feature) => {
                // The codes are those of three vertices, three edges and the face.
                let numbers =
                    feature.map_or([-1; 2], |feature| [feature.code() / 3, feature.code() % 3].map(i16::from));
                match is_cloud {
                    true => out.extend_from_slice(numbers.map(|x| i32::from(x).to_le_bytes()).as_flattened()),
                    false => out.extend_from_slice(numbers.map(i16::to_le_bytes).as_flattened()),
                }
            }
            Self::Side(side) => out.extend_from_slice(&side.map_or(-1, |side| side as i32).to_le_bytes()),
            Self::Text(_) => {}
        }
    }
}

/// Appends a record.
#[inline]
pub(super) fn put_record<'a>(format: AnswerFormat, values: impl IntoIterator<Item = Value<'a>>, out: &mut Vec<u8>) {
    if format != AnswerFormat::Csv {
        return values.into_iter().for_each(|value| value.put_bytes(format, out));
    }
    for (k, value) in values.into_iter().enumerate() {
        out.extend((k > 0).then_some(b','));
        value.put_text(out);
    }
    out.push(b'\n');
}

/// Appends a number to a line of text: the shortest that reads back the same, with an exponent if it is far from 1.
fn put_number(out: &mut Vec<u8>, x: f64) {
    let mut buffer = zmij::Buffer::new();
    let text = buffer.format(x).as_bytes();
    // Rust writes exponents without a plus sign, and zmij with one, which only numbers from 1e16 on get.
    match if x.abs() < 1e16 { None } else { text.iter().position(|byte| *byte == b'+') } {
        None => out.extend_from_slice(text),
        Some(plus) => {
            out.extend_from_slice(&text[..plus]);
            out.extend_from_slice(&text[plus + 1..]);
        }
    }
}

/// Appends an integer to a line of text.
fn put_integer(out: &mut Vec<u8>, number: u64) {
    out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}

/// Returns a name as a field of a table, on one line and in quotes if that is necessary.
fn field(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let is_plain = !name.contains(['"', ',', ';']) && name.trim() == name;
    if is_plain { name } else { format!("\"{}\"", name.replace('"', "\"\"")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_characters_are_one_field() {
        for (name, expected) in [
            ("tube", "tube"),
            ("left arm", "left arm"),
            ("a,b", "\"a,b\""),
            ("5'11\" bolt", "\"5'11\"\" bolt\""),
            ("two\nlines\r", "\"two lines \""),
            ("é;\u{7}", "\"é; \""),
        ] {
            assert_eq!(field(name), expected);
        }
    }

    #[test]
    fn features_have_the_names_that_they_display() {
        let numbered = (0..3).flat_map(|i| [Feature::Vertex(i), Feature::Edge(i)]);
        for feature in numbered.chain([Feature::Face]) {
            let mut text = Vec::new();
            Value::Feature(Some(feature)).put_text(&mut text);
            assert_eq!(String::from_utf8(text).unwrap(), feature.to_string());
        }
    }

    #[test]
    fn numbers_in_text_are_short_and_read_back_the_same() {
        let text = |x: f64| {
            let mut out = Vec::new();
            put_number(&mut out, x);
            String::from_utf8(out).unwrap()
        };
        for (x, expected) in [
            (0.5, "0.5"),
            (3.0, "3.0"),
            (-0.0, "-0.0"),
            (1e300, "1e300"),
            (-1.5e16, "-1.5e16"),
            (1e-300, "1e-300"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(text(x), expected);
        }
        for case in p2m_testkit::cases(100_000, 1000) {
            let x = f64::from_bits(rand::RngExt::random(&mut p2m_testkit::rng("text", case)));
            let found: f64 = text(x).parse().unwrap();
            assert!(found.to_bits() == x.to_bits() || (found.is_nan() && x.is_nan()), "{x:?}");
        }
    }
}
