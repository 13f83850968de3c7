//! The errors of records.

/// The reason why a file of records cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A quoted field does not end.
    #[error("not comma-separated values")]
    Syntax,
    /// The file has no records.
    #[error("no records")]
    Empty,
    /// A column is missing.
    #[error("no column {0}")]
    Column(&'static str),
    /// A line has more or fewer fields than there are columns.
    #[error("line {line} has {fields} fields in place of {columns}")]
    Fields {
        /// The number of the line; the head has number 1.
        line: usize,
        /// The number of fields of the line.
        fields: usize,
        /// The number of columns of the head.
        columns: usize,
    },
    /// A field is not a number.
    #[error("line {line}: {column} is not a number")]
    Number {
        /// The number of the line; the head has number 1.
        line: usize,
        /// The name of the column.
        column: &'static str,
    },
    /// Two records have no scene, set, backend and setting in common.
    #[error("the records have nothing in common: no scene, set, backend and setting is in both")]
    Foreign,
}
