//! The errors of records.

/// The reason why a file of records cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file is not a table of comma-separated values, for this reason.
    #[error("not comma-separated values: {0}")]
    Syntax(String),
    /// The file has no records.
    #[error("no records")]
    Empty,
    /// A column is missing.
    #[error("no column {0}")]
    Column(&'static str),
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
