//! The columns of answers, and their encoding as records of any format.

use super::AnswerFormat;
use super::records::Header;
use super::values::{Kind, Layout, Value, header, put_record};
use nalgebra::Point3;
use p2m_core::{Closest, Soup};
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
    /// All columns with their names, in the order in which files have them by default.
    const ALL: [(Self, Layout<'static>); 13] = [
        (Self::Number, Layout::new("number", Kind::Integer, &["number"])),
        (Self::Id, Layout::new("id", Kind::Text, &["id"])),
        (Self::Query, Layout::new("query", Kind::Triple, &["qx", "qy", "qz"]).in_clouds(&["x", "y", "z"])),
        (Self::Point, Layout::new("point", Kind::Triple, &["x", "y", "z"]).in_clouds(&["cx", "cy", "cz"])),
        (Self::Distance, Layout::new("distance", Kind::Number, &["distance"])),
        (Self::Signed, Layout::new("signed", Kind::Number, &["signed_distance"])),
        (Self::Inside, Layout::new("inside", Kind::Flag, &["inside"])),
        (Self::Normal, Layout::new("normal", Kind::Triple, &["nx", "ny", "nz"])),
        (Self::LowerBound, Layout::new("lower_bound", Kind::Number, &["lower_bound"])),
        (Self::Barycentric, Layout::new("barycentric", Kind::Triple, &["w0", "w1", "w2"])),
        (Self::Primitive, Layout::new("primitive", Kind::Index, &["primitive"])),
        (
            Self::Feature,
            Layout::new("feature", Kind::Feature, &["feature"]).in_clouds(&["feature_kind", "feature_number"]),
        ),
        (Self::Object, Layout::new("object", Kind::Index, &["object"])),
    ];

    /// Returns all columns in the order in which files have them by default.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().map(|(column, _)| column)
    }

    /// Returns the name of the column on the command line.
    pub(crate) fn name(self) -> &'static str {
        self.layout().name
    }

    fn layout(self) -> Layout<'static> {
        Self::ALL[self as usize].1
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
        Self::all().filter(is_default).collect()
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
    /// The objects of the scene.
    objects: &'a [Object],
    /// The normals of the scene, for the column [`AnswerColumn::Normal`].
    normals: Option<Normals>,
    /// The ids of queries, for the column [`AnswerColumn::Id`].
    ids: Option<PointIds>,
}

impl<'a> AnswerEncoder<'a> {
    /// Makes an encoder of some columns, in this order. The objects are those of the scene.
    pub(crate) fn new(format: AnswerFormat, objects: &'a [Object], columns: Vec<AnswerColumn>) -> Self {
        Self { format, columns, objects, normals: None, ids: None }
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
        let layouts: Vec<_> = self.columns.iter().map(|column| column.layout()).collect();
        header(self.format, &layouts)
    }

    /// Appends a record.
    pub(crate) fn encode(&self, record: &AnswerRecord<'_>, out: &mut Vec<u8>) {
        put_record(self.format, self.columns.iter().map(|column| self.value(*column, record)), out);
    }

    #[inline(always)]
    fn value(&self, column: AnswerColumn, record: &AnswerRecord<'_>) -> Value<'_> {
        let answer = record.answer;
        match column {
            AnswerColumn::Number => Value::Integer(record.number),
            AnswerColumn::Id => {
                let number = usize::try_from(record.number).unwrap_or(usize::MAX);
                Value::Text(self.ids.as_ref().and_then(|ids| ids.get(number)).unwrap_or_default())
            }
            AnswerColumn::Query => Value::Triple(Some(record.query.coords.into())),
            AnswerColumn::Point => Value::Triple(answer.map(|answer| answer.point.coords.into())),
            AnswerColumn::Distance => Value::Number(answer.map(|answer| answer.distance)),
            AnswerColumn::Signed => Value::Number(answer.map(|_| record.signed_distance)),
            AnswerColumn::Inside => Value::Flag(record.signed_distance < 0.0),
            AnswerColumn::Normal => Value::Triple(answer.and_then(|answer| self.normal(answer))),
            AnswerColumn::LowerBound => Value::Number(answer.map(|answer| answer.lower_bound)),
            AnswerColumn::Barycentric => Value::Triple(answer.map(|answer| answer.barycentric)),
            AnswerColumn::Primitive => Value::Index(answer.map(|answer| answer.primitive)),
            AnswerColumn::Feature => Value::Feature(answer.map(|answer| answer.feature)),
            AnswerColumn::Object => Value::object_of(self.objects, answer.map(|answer| answer.primitive)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_has_its_own_layout() {
        assert!(AnswerColumn::all().enumerate().all(|(place, column)| column as usize == place));
    }
}
