//! Errors of readers: the file, the location in it, and the reason.

use p2m_core::{BuildError, RayError, UnknownExtension};
use std::fmt;

/// The error of a file that cannot be read.
///
/// ```
/// let error = p2m_mixed::read_obj("v 0 0 0\np 2\n".as_bytes(), "two.obj").unwrap_err();
/// assert_eq!(error.to_string(), "two.obj:2: vertex index 2 is out of range, 1 vertices were found");
/// assert!(matches!(error.reason, p2m_mixed::Reason::IndexOutOfRange { index: 2, count: 1 }));
/// ```
///
/// The message includes the message of the operating system, so `println!("{error}")` shows the whole reason.
#[derive(Debug)]
#[non_exhaustive]
pub struct ReadError {
    /// The name of the file as the caller gave it.
    pub file: String,
    /// The location of the error in the file.
    pub location: FileLocation,
    /// The reason of the error.
    pub reason: Reason,
}

impl ReadError {
    /// Makes the error of a reader, such as one of another format.
    #[must_use]
    pub fn new(file: &str, location: FileLocation, reason: Reason) -> Self {
        Self { file: file.to_owned(), location, reason }
    }
}

impl From<UnknownExtension> for ReadError {
    fn from(UnknownExtension { file, extension, supported }: UnknownExtension) -> Self {
        Self { file, location: FileLocation::File, reason: Reason::UnknownExtension { extension, supported } }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}: {}", self.file, self.location, self.reason)
    }
}

impl std::error::Error for ReadError {
    /// Returns the source of the reason, because the reason itself is in the message.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.reason.source()
    }
}

/// A location in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileLocation {
    /// The file as a whole.
    File,
    /// The number of a line of text, counted from 1.
    Line(u64),
    /// An offset from the start of the file in bytes, counted from 0.
    Byte(u64),
    /// The number of a row of an array, counted from 0.
    Row(u64),
}

impl fmt::Display for FileLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, " at byte {byte}"),
            Self::Row(row) => write!(f, " in row {row}, counted from 0"),
        }
    }
}

/// Reasons why a file cannot be read. Texts that are quoted from the file are shortened and escaped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The operating system returned an error.
    #[error("cannot be read: {0}")]
    Io(std::io::Error),
    /// The file is not a saved index, or it is damaged.
    #[error(transparent)]
    Saved(p2m_core::storage::LoadError),
    /// There are too many primitives for a scene.
    #[error("no scene can be made of it: {0}")]
    Build(BuildError),
    /// The extension of the file belongs to no format.
    #[error("unknown extension '{extension}', expected one of {}", supported.join(", "))]
    UnknownExtension {
        /// The extension, which is empty if there is none.
        extension: String,
        /// The extensions that are supported here.
        supported: &'static [&'static str],
    },
    /// The file ends in the middle of something.
    #[error("unexpected end of file")]
    UnexpectedEnd,
    /// A text is not a number of the expected kind.
    #[error("'{text}' is not a number that fits here")]
    BadNumber {
        /// The text in the file.
        text: String,
    },
    /// A coordinate of an STL facet is NaN, infinite, or too large for double precision.
    #[error("coordinate '{text}' is not finite")]
    NonFinite {
        /// The text in the file.
        text: String,
    },
    /// A primitive has a vertex with a coordinate that is NaN, infinite, or too large for double precision. A PLY file
    /// is located at the vertex, and any other file at the primitive.
    #[error("vertex {index} is part of a primitive, but has a coordinate that is not finite")]
    NonFiniteVertex {
        /// The number of the vertex, which OBJ counts from 1, PLY and OFF from 0.
        index: u64,
    },
    /// The file has no vertex, and it is empty or has statements that OBJ does not define.
    #[error("no vertex in it, is this an OBJ file?")]
    NoVertex,
    /// The large polygons of a file would take too long to be triangulated.
    #[error("its large polygons would take too long to triangulate: divide those of more than 256 vertices")]
    PolygonsTooLarge {
        /// The largest allowed sum of the squared numbers of vertices, over all polygons of more than 256 vertices.
        limit: u64,
    },
    /// A word is not the expected keyword.
    #[error("'{text}' is not {expected}, which should be here")]
    UnexpectedWord {
        /// The word in the file.
        text: String,
        /// The words that are expected.
        expected: &'static str,
    },
    /// A line of a text PLY or OFF file has more words than the element that ends on it.
    #[error("'{text}' is more than the header declares for the element on this line")]
    ExtraWord {
        /// The first of the additional words.
        text: String,
    },
    /// A point has fewer than three coordinates.
    #[error("a point needs 3 coordinates, found {found}")]
    TooFewCoordinates {
        /// The number of coordinates.
        found: usize,
    },
    /// A ray has fewer than six coordinates.
    #[error("a ray needs 6 coordinates, found {found}")]
    IncompleteRay {
        /// The number of coordinates.
        found: usize,
    },
    /// The six coordinates do not make a ray.
    #[error("{0}")]
    Ray(RayError),
    /// A vertex index of an OBJ file is 0, but indices count from 1, or backwards from -1.
    #[error("vertex index 0, but vertices are numbered from 1")]
    IndexZero,
    /// An OBJ file does not have the vertex with this index before this line. Indices count from 1, or backwards from
    /// -1.
    #[error("vertex index {index} is out of range, {count} vertices were found")]
    IndexOutOfRange {
        /// The index in the file.
        index: i64,
        /// The number of vertices of the file. For an index that is negative or above 2^32, it counts only the vertices
        /// before this line.
        count: u64,
    },
    /// A PLY or OFF file does not have the vertex with this index. Indices count from 0.
    #[error("vertex index {index} is out of range, the file has {count} vertices, counted from 0")]
    NoSuchVertex {
        /// The index in the file.
        index: i64,
        /// The number of vertices in the file.
        count: u64,
    },
    /// A face has fewer than three vertices (OFF and PLY: none), a polyline fewer than two, or a point statement none.
    #[error("{needed} or more vertices expected, found {found}")]
    TooFewVertices {
        /// The number of vertices.
        found: u64,
        /// The number of vertices that are needed.
        needed: u64,
    },
    /// A list in a PLY or OFF file has a negative length, or one that is not valid there.
    #[error("a list cannot have {count} items")]
    BadListCount {
        /// The length of the list.
        count: i64,
    },
    /// A face has more than [`MAX_CORNERS`](crate::MAX_CORNERS) vertices, or the file has more than 2^32 - 1.
    #[error("{count} vertices are more than the {limit} that are supported here")]
    ElementTooLarge {
        /// The number of vertices.
        count: u64,
        /// The largest number that is supported.
        limit: u64,
    },
    /// The ids of primitives in a PLY file (the properties `p2m_id`) are not a permutation of 0, 1, 2, ...
    #[error("primitive id {id} is out of range or there twice, the file has {count} primitives")]
    BadPrimitiveId {
        /// An id that is out of range or repeated.
        id: i64,
        /// The number of primitives.
        count: u64,
    },
    /// The file of an array has more data than its header announces.
    #[error("{bytes} bytes follow the end of the array")]
    TrailingBytes {
        /// The number of additional bytes.
        bytes: u64,
    },
    /// The header of the file is not valid.
    #[error("bad header: {0}")]
    BadHeader(HeaderProblem),
    /// The variant of a format is not supported: a PLY file other than `ascii`, `binary_little_endian` and
    /// `binary_big_endian` 1.0, an OFF file with vertices in another number of dimensions, or an NPY file of
    /// an unknown version.
    #[error("unsupported format '{text}'")]
    UnsupportedFormat {
        /// The variant in the words of the header.
        text: String,
    },
    /// The names of the columns of a table do not identify the coordinates.
    #[error("no coordinates among the columns {}; they may be named {expected}", names.join(", "))]
    UnknownColumns {
        /// The names of the columns, or of the first ones if there are many.
        names: Vec<String>,
        /// The names that are expected.
        expected: &'static str,
    },
    /// The columns of a table have no names, and the first of them may be the number of the point.
    #[error(
        "the first of the {found} columns may be the number of the point, and not its x: name the columns on the first \
         line, such as 'id,x,y,z,code'"
    )]
    UnnamedColumns {
        /// The number of columns.
        found: usize,
    },
    /// The first line of a table announces a wrong number of rows.
    #[error("the first line announces {announced} rows, but there are {found}")]
    RowCount {
        /// The number on the first line.
        announced: u64,
        /// The number of rows.
        found: u64,
    },
    /// A row has more or fewer columns than the first row, which has two, in a table whose columns have no names.
    #[error("the first row has 2 columns, but this one has {found}")]
    ColumnCount {
        /// The number of columns.
        found: usize,
    },
    /// The caller chose a column that the table does not have.
    #[error("there is no column '{name}' among {}", names.join(", "))]
    NoSuchColumn {
        /// The name, or the number from 1.
        name: String,
        /// The names of the columns, or else the fields of the first row. Only the first ones are listed if there are
        /// many.
        names: Vec<String>,
    },
    /// The reader of a format in another crate found an error.
    #[error("{0}")]
    Format(Box<dyn std::error::Error + Send + Sync>),
    /// The content of the file does not fit into memory.
    #[error("does not fit into memory: {0}")]
    Memory(std::collections::TryReserveError),
    /// A record of a table has a quote that is not closed.
    #[error("a quote is not closed on this line")]
    BadRecord,
}

/// Reasons why the header of a file is not valid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HeaderProblem {
    /// The first line is not `ply`.
    #[error("the file does not start with 'ply'")]
    NotPly,
    /// An STL file is text, but does not start with `solid`.
    #[error("the file is text, but does not start with 'solid'")]
    NotStl,
    /// The first word of an OFF file is neither a count nor `OFF` with a known prefix.
    #[error("the file starts with '{text}', not with 'OFF'")]
    NotOff {
        /// The first word.
        text: String,
    },
    /// The file does not start with the magic bytes of an NPY file.
    #[error("the file does not start as an array of NumPy does (format .npy)")]
    NotNpy,
    /// The dictionary in the header of an NPY file is not one that NumPy writes.
    #[error("the description of the array is not understood near '{text}'")]
    BadDescription {
        /// The text where parsing failed.
        text: String,
    },
    /// The description of an array has no entry with this key.
    #[error("the description of the array has no '{key}'")]
    MissingKey {
        /// The key of the missing entry.
        key: &'static str,
    },
    /// The items of an array are not numbers, or numbers of a size that is not supported.
    #[error("items of type {text} are no coordinates, expected integers or floats of 4 or 8 bytes")]
    UnsupportedType {
        /// The type in the words of the header.
        text: String,
    },
    /// The names of the fields of a structured array do not identify the coordinates.
    #[error("no coordinates among the fields {}; expected {expected}", names.join(", "))]
    UnknownFields {
        /// The names of the fields, or of the first ones if there are many.
        names: Vec<String>,
        /// The names that are expected.
        expected: &'static str,
    },
    /// The shape of an array is not that of points or rays.
    #[error("the array has the shape {text}, expected {expected}")]
    BadShape {
        /// The shape of the array.
        text: String,
        /// The shape that is expected.
        expected: &'static str,
    },
    /// A line or a header is too long.
    #[error("line too long")]
    LineTooLong,
    /// A line is not a declaration of a PLY header.
    #[error("'{text}' is not understood")]
    BadLine {
        /// The line of the header.
        text: String,
    },
    /// The header has no line `format`.
    #[error("no format line")]
    NoFormat,
    /// A property has a type that does not exist, or that is not suitable for the property.
    #[error("property '{name}' is of type '{declared}', which is unknown or does not fit")]
    BadType {
        /// The name of the property.
        name: String,
        /// The type in the words of the header.
        declared: String,
    },
    /// Two elements, or two properties of an element, have the same name.
    #[error("'{name}' is declared twice")]
    Duplicate {
        /// The name that occurs twice.
        name: String,
    },
    /// The file has no element with this name.
    #[error("there is no element '{element}'")]
    MissingElement {
        /// The name of the element.
        element: &'static str,
    },
    /// An element lacks a property that it needs.
    #[error("element '{element}' has no property '{property}'")]
    MissingProperty {
        /// The name of the element.
        element: &'static str,
        /// The name of the property.
        property: &'static str,
    },
}
