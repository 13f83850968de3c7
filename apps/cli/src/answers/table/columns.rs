//! The columns of answers, and their encoding as records of any format.

use super::AnswerFormat;
use super::names::{Names, field};
use super::records::{Header, integer_bytes, put_columns, put_integer, put_numbers, put_text};
use nalgebra::Point3;
use p2m_core::{Closest, Feature, Soup};
use p2m_field::sign::Normals;
use p2m_mixed::{Object, PointIds};

/// A column of a file of answers. A column may consist of several numbers.
///
/// | column | CSV | NPY | PLY |
/// |---|---|---|---|
/// | `number` | `number` | `number`, `<i8` | `double` `number` |
/// | `id` | `id`, the text of the file of queries | | |
/// | `query` | `qx,qy,qz` | `query`, `<f8`, shape `(3,)` | `double` `x`, `y`, `z` |
/// | `point` | `x,y,z` | `point`, `<f8`, shape `(3,)` | `double` `cx`, `cy`, `cz` |
/// | `distance` | `distance` | `distance`, `<f8` | `double` `distance` |
/// | `signed` | `signed_distance` | `signed_distance`, `<f8` | `double` `signed_distance` |
/// | `inside` | `inside`, 1 or 0 | `inside`, `|b1` | `int` `inside` |
/// | `normal` | `nx,ny,nz` | `normal`, `<f8`, shape `(3,)` | `double` `nx`, `ny`, `nz` |
/// | `lower_bound` | `lower_bound` | `lower_bound`, `<f8` | `double` `lower_bound` |
/// | `barycentric` | `w0,w1,w2` | `barycentric`, `<f8`, shape `(3,)` | `double` `w0`, `w1`, `w2` |
/// | `primitive` | `primitive` | `primitive`, `<i4` | `int` `primitive` |
/// | `feature` | `feature` | `feature_kind`, `feature_number`, `<i2` | `int` `feature_kind`, `feature_number` |
/// | `object` | `object`, the name | `object`, `<i4`, the number from 0 | `int` `object`, the number from 0 |
///
/// Without an answer, fields of CSV are empty, and numbers of NPY and PLY are NaN or -1; the query and its number
/// are always there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AnswerColumn {
    /// The number of the query, from 0.
    Number,
    /// The id of the query in its file.
    Id,
    /// The query point.
    Query,
    /// The closest point.
    Point,
    /// The distance of the closest point, in the unit of the scene.
    Distance,
    /// The distance with the sign of the side, in the unit of the scene: negative inside. It is NaN where the scene
    /// has no inside.
    Signed,
    /// Whether the query is inside of the surface.
    Inside,
    /// The normal of the scene at the closest point, where that is on a triangle.
    Normal,
    /// The certified lower bound of the distance, in the unit of the scene.
    LowerBound,
    /// The weights of the vertices of the primitive.
    Barycentric,
    /// The id of the primitive.
    Primitive,
    /// The part of the primitive that has the closest point.
    Feature,
    /// The object that the primitive belongs to.
    Object,
}

impl AnswerColumn {
    /// All columns, in the order in which files have them by default.
    pub(crate) const ALL: [Self; 13] = [
        Self::Number,
        Self::Id,
        Self::Query,
        Self::Point,
        Self::Distance,
        Self::Signed,
        Self::Inside,
        Self::Normal,
        Self::LowerBound,
        Self::Barycentric,
        Self::Primitive,
        Self::Feature,
        Self::Object,
    ];

    /// Returns the name of the column on the command line.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Id => "id",
            Self::Query => "query",
            Self::Point => "point",
            Self::Distance => "distance",
            Self::Signed => "signed",
            Self::Inside => "inside",
            Self::Normal => "normal",
            Self::LowerBound => "lower_bound",
            Self::Barycentric => "barycentric",
            Self::Primitive => "primitive",
            Self::Feature => "feature",
            Self::Object => "object",
        }
    }

    /// Returns the columns that files of a format have by default. Only text has a column of objects, if there are any.
    pub(crate) fn defaults(format: AnswerFormat, has_objects: bool, has_signs: bool) -> Vec<Self> {
        let is_default = |column: &Self| match column {
            Self::Query | Self::Point | Self::Distance | Self::Primitive | Self::Feature => true,
            Self::LowerBound | Self::Barycentric => format == AnswerFormat::Npy,
            Self::Object => format == AnswerFormat::Csv && has_objects,
            Self::Signed => has_signs,
            Self::Number | Self::Id | Self::Inside | Self::Normal => false,
        };
        Self::ALL.into_iter().filter(is_default).collect()
    }

    /// Returns the names of the columns of text that it consists of.
    const fn text_names(self) -> &'static [&'static str] {
        match self {
            Self::Number => &["number"],
            Self::Id => &["id"],
            Self::Query => &["qx", "qy", "qz"],
            Self::Point => &["x", "y", "z"],
            Self::Distance => &["distance"],
            Self::Signed => &["signed_distance"],
            Self::Inside => &["inside"],
            Self::Normal => &["nx", "ny", "nz"],
            Self::LowerBound => &["lower_bound"],
            Self::Barycentric => &["w0", "w1", "w2"],
            Self::Primitive => &["primitive"],
            Self::Feature => &["feature"],
            Self::Object => &["object"],
        }
    }

    /// Returns the fields of an array that it consists of, as NumPy describes them.
    const fn array_fields(self) -> &'static str {
        match self {
            Self::Number => "('number', '<i8')",
            Self::Id => "", // only text has it
            Self::Query => "('query', '<f8', (3,))",
            Self::Point => "('point', '<f8', (3,))",
            Self::Distance => "('distance', '<f8')",
            Self::Signed => "('signed_distance', '<f8')",
            Self::Inside => "('inside', '|b1')",
            Self::Normal => "('normal', '<f8', (3,))",
            Self::LowerBound => "('lower_bound', '<f8')",
            Self::Barycentric => "('barycentric', '<f8', (3,))",
            Self::Primitive => "('primitive', '<i4')",
            Self::Feature => "('feature_kind', '<i2'), ('feature_number', '<i2')",
            Self::Object => "('object', '<i4')",
        }
    }

    /// Returns the type and the names of the properties of a point cloud that it consists of.
    const fn cloud_properties(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Query => ("double", &["x", "y", "z"]),
            Self::Point => ("double", &["cx", "cy", "cz"]),
            Self::Primitive | Self::Object | Self::Inside => ("int", self.text_names()),
            Self::Feature => ("int", &["feature_kind", "feature_number"]),
            Self::Id => ("double", &[]), // only text has it
            Self::Number | Self::Distance | Self::Signed | Self::Normal | Self::LowerBound | Self::Barycentric => {
                ("double", self.text_names())
            }
        }
    }
}

/// A query with one answer, or none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnswerRecord<'a> {
    /// The number of the query, from 0.
    pub(crate) number: u64,
    /// The query point.
    pub(crate) query: &'a Point3<f64>,
    /// The answer.
    pub(crate) answer: Option<&'a Closest<f64>>,
    /// The distance with the sign of the side, for the columns [`AnswerColumn::Signed`] and [`AnswerColumn::Inside`].
    pub(crate) signed_distance: f64,
}

/// Encodes answers as records.
pub(crate) struct AnswerEncoder<'a> {
    format: AnswerFormat,
    columns: Vec<AnswerColumn>,
    names: Names<'a>,
    /// The normals of the scene, for the column [`AnswerColumn::Normal`].
    normals: Option<Normals>,
    /// The ids of queries, for the column [`AnswerColumn::Id`].
    ids: Option<PointIds>,
}

impl<'a> AnswerEncoder<'a> {
    /// Makes an encoder of some columns, in this order. The objects are those of the scene.
    pub(crate) fn new(format: AnswerFormat, objects: &'a [Object], columns: Vec<AnswerColumn>) -> Self {
        Self { format, columns, names: Names(objects), normals: None, ids: None }
    }

    /// Adds the normals of a scene, if a column needs them.
    pub(crate) fn with_normals(mut self, soup: &Soup<f64>) -> Self {
        self.normals = self.columns.contains(&AnswerColumn::Normal).then(|| Normals::new(soup));
        self
    }

    /// Adds the ids of the queries.
    pub(crate) fn with_ids(mut self, ids: Option<PointIds>) -> Self {
        self.ids = ids;
        self
    }

    fn normal(&self, answer: &Closest<f64>) -> Option<[f64; 3]> {
        Some(self.normals.as_ref()?.at(answer.primitive, answer.feature)?.into())
    }

    /// Returns the header of a file.
    pub(crate) fn header(&self) -> Header {
        let columns = self.columns.iter();
        match self.format {
            AnswerFormat::Csv => {
                Header::Line(columns.flat_map(|column| column.text_names()).copied().collect::<Vec<_>>().join(","))
            }
            AnswerFormat::Npy => {
                Header::Npy(columns.map(|column| column.array_fields()).collect::<Vec<_>>().join(", "))
            }
            AnswerFormat::Ply => {
                let properties = |column: &AnswerColumn| {
                    let (kind, names) = column.cloud_properties();
                    names.iter().map(move |name| (kind, *name))
                };
                Header::Ply(columns.flat_map(properties).collect())
            }
        }
    }

    /// Appends a record.
    pub(crate) fn encode(&self, record: &AnswerRecord<'_>, out: &mut Vec<u8>) {
        if self.format != AnswerFormat::Csv {
            return self.columns.iter().for_each(|column| self.put_bytes(*column, record, out));
        }
        for (number, column) in self.columns.iter().enumerate() {
            if number > 0 {
                out.push(b',');
            }
            self.put_text(*column, record, out);
        }
        out.push(b'\n');
    }

    /// Appends a column to a line of text, without a comma after it.
    fn put_text(&self, column: AnswerColumn, record: &AnswerRecord<'_>, out: &mut Vec<u8>) {
        let three = |out: &mut Vec<u8>, [x, y, z]: [f64; 3]| {
            put_columns(out, &[x, y]);
            put_text(out, z);
        };
        match (column, record.answer) {
            (AnswerColumn::Number, _) => put_integer(out, record.number),
            (AnswerColumn::Id, _) => {
                let number = usize::try_from(record.number).unwrap_or(usize::MAX);
                let id = self.ids.as_ref().and_then(|ids| ids.get(number)).unwrap_or_default();
                out.extend_from_slice(field(id).as_bytes());
            }
            (AnswerColumn::Query, _) => three(out, record.query.coords.into()),
            (AnswerColumn::Inside, _) => put_integer(out, u64::from(record.signed_distance < 0.0)),
            (_, None) => (1..column.text_names().len()).for_each(|_| out.push(b',')),
            (AnswerColumn::Point, Some(answer)) => three(out, answer.point.coords.into()),
            (AnswerColumn::Distance, Some(answer)) => put_text(out, answer.distance),
            (AnswerColumn::Signed, Some(_)) => put_text(out, record.signed_distance),
            (AnswerColumn::Normal, Some(answer)) => match self.normal(answer) {
                Some(normal) => three(out, normal),
                None => out.extend_from_slice(b",,"),
            },
            (AnswerColumn::LowerBound, Some(answer)) => put_text(out, answer.lower_bound),
            (AnswerColumn::Barycentric, Some(answer)) => three(out, answer.barycentric),
            (AnswerColumn::Primitive, Some(answer)) => put_integer(out, answer.primitive.index() as u64),
            (AnswerColumn::Feature, Some(answer)) => out.extend_from_slice(feature_name(answer.feature)),
            (AnswerColumn::Object, Some(answer)) => self.names.write(out, Some(answer.primitive)),
        }
    }

    /// Appends a column to a binary record.
    fn put_bytes(&self, column: AnswerColumn, record: &AnswerRecord<'_>, out: &mut Vec<u8>) {
        let (answer, nan) = (record.answer, [f64::NAN; 3]);
        match column {
            AnswerColumn::Number => out.extend(integer_bytes(self.format, record.number)),
            AnswerColumn::Id => {} // only text has it
            AnswerColumn::Query => put_numbers(out, record.query.coords.as_ref()),
            AnswerColumn::Point => put_numbers(out, answer.map_or(&nan, |a| a.point.coords.as_ref())),
            AnswerColumn::Distance => put_numbers(out, &[answer.map_or(f64::NAN, |a| a.distance)]),
            AnswerColumn::Signed => put_numbers(out, &[answer.map_or(f64::NAN, |_| record.signed_distance)]),
            AnswerColumn::Inside => match (record.signed_distance < 0.0, self.format) {
                (is_inside, AnswerFormat::Ply) => out.extend(i32::from(is_inside).to_le_bytes()),
                (is_inside, _) => out.push(u8::from(is_inside)),
            },
            AnswerColumn::Normal => put_numbers(out, &answer.and_then(|a| self.normal(a)).unwrap_or(nan)),
            AnswerColumn::LowerBound => put_numbers(out, &[answer.map_or(f64::NAN, |a| a.lower_bound)]),
            AnswerColumn::Barycentric => put_numbers(out, answer.map_or(&nan, |a| &a.barycentric)),
            AnswerColumn::Primitive => out.extend(index(answer.map(|a| a.primitive.index())).to_le_bytes()),
            AnswerColumn::Feature => {
                for number in feature_numbers(answer.map(|a| a.feature)) {
                    match self.format {
                        AnswerFormat::Ply => out.extend(i32::from(number).to_le_bytes()),
                        _ => out.extend(number.to_le_bytes()),
                    }
                }
            }
            AnswerColumn::Object => {
                out.extend(index(answer.and_then(|a| self.names.number(a.primitive))).to_le_bytes());
            }
        }
    }
}

/// Returns a number below 2^30, or -1 if there is none.
fn index(number: Option<usize>) -> i32 {
    number.and_then(|number| i32::try_from(number).ok()).unwrap_or(-1)
}

/// Returns the kind and the number of the feature, or -1 twice if there is no answer.
fn feature_numbers(feature: Option<Feature>) -> [i16; 2] {
    match feature {
        None => [-1, -1],
        Some(Feature::Vertex(i)) => [0, i.into()],
        Some(Feature::Edge(i)) => [1, i.into()],
        Some(Feature::Face) => [2, 0],
    }
}

/// Returns the feature as [`Feature`] displays it.
fn feature_name(feature: Feature) -> &'static [u8] {
    match feature {
        Feature::Vertex(0) => b"vertex0",
        Feature::Vertex(1) => b"vertex1",
        Feature::Vertex(_) => b"vertex2",
        Feature::Edge(0) => b"edge0",
        Feature::Edge(1) => b"edge1",
        Feature::Edge(_) => b"edge2",
        Feature::Face => b"face",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_have_the_names_that_they_display() {
        let numbered = (0..3).flat_map(|i| [Feature::Vertex(i), Feature::Edge(i)]);
        for feature in numbered.chain([Feature::Face]) {
            assert_eq!(feature_name(feature), feature.to_string().as_bytes());
        }
    }
}
