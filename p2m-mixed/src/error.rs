//! Why a file cannot be read, and where it goes wrong.

use p2m_core::{BuildError, RayError};
use std::fmt;

/// A file that cannot be read.
///
/// ```
/// let error = p2m_mixed::read_obj("v 0 0 0\np 2\n".as_bytes(), "two.obj").unwrap_err();
/// assert_eq!(error.to_string(), "two.obj:2: vertex index 2 is out of range, the file has 1 vertices so far");
/// assert!(matches!(error.reason, p2m_mixed::Reason::IndexOutOfRange { index: 2, count: 1 }));
/// ```
///
/// What the operating system says is not part of the message, but its [`source`](std::error::Error::source).
#[derive(Debug)]
#[non_exhaustive]
pub struct ReadError {
    /// The name of the file as the caller gave it.
    pub file: String,
    /// Where in the file.
    pub location: FileLocation,
    /// What is wrong there.
    pub reason: Reason,
}

impl ReadError {
    pub(crate) fn new(file: &str, location: FileLocation, reason: Reason) -> Self {
        Self { file: file.to_owned(), location, reason }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}: {}", self.file, self.location, self.reason)
    }
}

impl std::error::Error for ReadError {
    /// That of the reason, which is itself in the message already.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.reason.source()
    }
}

/// A location in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileLocation {
    /// The file as a whole.
    File,
    /// A line of text, from 1.
    Line(u64),
    /// An offset in bytes from the start of the file, from 0.
    Byte(u64),
    /// A row of an array, from 0.
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

/// What is wrong with a file. Texts quoted from it are shortened and escaped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The operating system says no.
    #[error("cannot be read")]
    Io(#[source] std::io::Error),
    /// It is no saved index, or a damaged one.
    #[error(transparent)]
    Saved(p2m_core::storage::LoadError),
    /// The primitives do not make a scene: there are too many.
    #[error("no scene can be made of it")]
    Build(#[source] BuildError),
    /// The name of the file does not tell its format.
    #[error("unknown extension '{extension}', expected one of {}", supported.join(", "))]
    UnknownExtension {
        /// What follows the last dot of the name, if anything.
        extension: String,
        /// What could have followed.
        supported: &'static [&'static str],
    },
    /// The file ends in the middle of something.
    #[error("unexpected end of file")]
    UnexpectedEnd,
    /// A number was expected.
    #[error("'{text}' is not a number that fits here")]
    BadNumber {
        /// What stands there.
        text: String,
    },
    /// A number was expected in a table whose columns are separated by blanks.
    #[error("'{text}' is not a number that fits here (a table with commas or semicolons should be named .csv)")]
    SeparatorInNumber {
        /// What stands there.
        text: String,
    },
    /// A coordinate of a query or of an STL facet is NaN or infinite, or too large for a number of double precision.
    #[error("coordinate '{text}' is not finite")]
    NonFinite {
        /// What stands there.
        text: String,
    },
    /// A primitive has a vertex with a coordinate that is NaN or infinite, or too large for a number of double
    /// precision. OBJ counts vertices from 1, PLY and OFF from 0. The location is that of the vertex in a PLY file, of
    /// the primitive in the others.
    #[error("vertex {index} is part of a primitive, but has a coordinate that is not finite")]
    NonFiniteVertex {
        /// The number of the vertex.
        index: u64,
    },
    /// A file that should be OBJ has statements that OBJ does not know, and no vertex.
    #[error("no vertex in it, is this an OBJ file?")]
    NoVertex,
    /// A word that is not the keyword that should be there.
    #[error("'{text}' is not {expected}, which should be here")]
    UnexpectedWord {
        /// The word.
        text: String,
        /// What should be there instead.
        expected: &'static str,
    },
    /// A line of a text PLY or OFF file has more words than the element that ends on it.
    #[error("'{text}' is more than the header declares for the element on this line")]
    ExtraWord {
        /// The first word too many.
        text: String,
    },
    /// A point has fewer than three coordinates.
    #[error("a point needs 3 coordinates, found {found}")]
    TooFewCoordinates {
        /// How many it has.
        found: usize,
    },
    /// A ray has fewer than six coordinates.
    #[error("a ray needs 6 coordinates, found {found}")]
    IncompleteRay {
        /// How many it has.
        found: usize,
    },
    /// Six coordinates that make no ray.
    #[error("{0}")]
    Ray(RayError),
    /// OBJ numbers vertices from 1 (or -1, backwards).
    #[error("vertex index 0, but vertices are numbered from 1")]
    IndexZero,
    /// A vertex that an OBJ file does not have, at least not before this line. Counted from 1 or, backwards, from -1.
    #[error("vertex index {index} is out of range, the file has {count} vertices so far")]
    IndexOutOfRange {
        /// The index as it stands in the file.
        index: i64,
        /// How many vertices there are before this line.
        count: u64,
    },
    /// A vertex that a PLY or OFF file does not have. Counted from 0.
    #[error("vertex index {index} is out of range, the file has {count} vertices, counted from 0")]
    NoSuchVertex {
        /// The index as it stands in the file.
        index: i64,
        /// How many vertices there are in the whole file.
        count: u64,
    },
    /// A face of fewer than three vertices (in OFF: of none), a line of fewer than two, a point statement of none.
    #[error("{needed} or more vertices expected, found {found}")]
    TooFewVertices {
        /// How many there are.
        found: u64,
        /// How many it takes.
        needed: u64,
    },
    /// A list in a PLY file, or something in an OFF file, has a negative length or one that makes no sense.
    #[error("a list cannot have {count} items")]
    BadListCount {
        /// The length.
        count: i64,
    },
    /// A face of more vertices than [`MAX_CORNERS`](crate::MAX_CORNERS), or more than 2^32 - 1 vertices.
    #[error("{count} vertices are more than the {limit} that are supported here")]
    ElementTooLarge {
        /// How many there are.
        count: u64,
        /// How many there may be.
        limit: u64,
    },
    /// The numbers that a PLY file gives its primitives (its properties `p2m_id`) are not 0, 1, 2, ... in some order.
    #[error("primitive id {id} is out of range or there twice, the file has {count} primitives")]
    BadPrimitiveId {
        /// A number that is.
        id: i64,
        /// How many primitives there are.
        count: u64,
    },
    /// More data than the header of an array announces.
    #[error("{bytes} bytes follow the end of the array")]
    TrailingBytes {
        /// How many.
        bytes: u64,
    },
    /// The header of a file makes no sense.
    #[error("bad header: {0}")]
    BadHeader(HeaderProblem),
    /// A PLY file in a format or version other than `ascii`, `binary_little_endian` and `binary_big_endian` 1.0, an OFF
    /// file with vertices in another number of dimensions, an NPY file of an unknown version.
    #[error("unsupported format '{text}'")]
    UnsupportedFormat {
        /// What the header says.
        text: String,
    },
    /// The names of a CSV file's columns do not tell which of them are coordinates.
    #[error("no coordinates among the columns {}; they may be named {expected}", names.join(", "))]
    UnknownColumns {
        /// The names, of the first columns if there are many.
        names: Vec<String>,
        /// What they could be.
        expected: &'static str,
    },
    /// A CSV record with a quote that is not closed.
    #[error("a quote is not closed on this line")]
    BadRecord,
}

/// What is wrong with the header of a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HeaderProblem {
    /// The first line is not `ply`.
    #[error("the file does not start with 'ply'")]
    NotPly,
    /// An STL file is text, but does not start with `solid`.
    #[error("the file is text, but does not start with 'solid'")]
    NotStl,
    /// The first word is neither a count nor `OFF` behind known letters.
    #[error("the file starts with '{text}', not with 'OFF'")]
    NotOff {
        /// The first word.
        text: String,
    },
    /// The first bytes are not those of an NPY file.
    #[error("the file does not start as an array of NumPy does (format .npy)")]
    NotNpy,
    /// The dictionary in the header of an NPY file is not what NumPy writes.
    #[error("the description of the array is not understood near '{text}'")]
    BadDescription {
        /// What stands where it stops making sense.
        text: String,
    },
    /// The description of an array lacks one of its parts.
    #[error("the description of the array has no '{key}'")]
    MissingKey {
        /// Which part.
        key: &'static str,
    },
    /// An array of something else than numbers, or of numbers too large or too small to be coordinates.
    #[error("items of type {text} are no coordinates, expected integers or floats of 4 or 8 bytes")]
    UnsupportedType {
        /// The type in the words of the header.
        text: String,
    },
    /// A structured array in which no fields are coordinates.
    #[error("no coordinates among the fields {}; expected {expected}", names.join(", "))]
    UnknownFields {
        /// The names, of the first fields if there are many.
        names: Vec<String>,
        /// What they could be.
        expected: &'static str,
    },
    /// An array of a shape that no points have.
    #[error("the array has the shape {text}, expected {expected}")]
    BadShape {
        /// The shape.
        text: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A line is longer than any sensible one.
    #[error("line too long")]
    LineTooLong,
    /// A line that is not of the header's grammar.
    #[error("'{text}' is not understood")]
    BadLine {
        /// The line.
        text: String,
    },
    /// There is no `format` line.
    #[error("no format line")]
    NoFormat,
    /// A property of a type that does not exist, or whose type cannot serve its purpose.
    #[error("property '{name}' is of type '{declared}', which is unknown or does not fit")]
    BadType {
        /// The property.
        name: String,
        /// Its type in the words of the header.
        declared: String,
    },
    /// Two elements, or two properties of an element, have the same name.
    #[error("'{name}' is declared twice")]
    Duplicate {
        /// The name.
        name: String,
    },
    /// An element is missing.
    #[error("there is no element '{element}'")]
    MissingElement {
        /// The element.
        element: &'static str,
    },
    /// An element lacks a property without which it means nothing.
    #[error("element '{element}' has no property '{property}'")]
    MissingProperty {
        /// The element.
        element: &'static str,
        /// The property.
        property: &'static str,
    },
}
