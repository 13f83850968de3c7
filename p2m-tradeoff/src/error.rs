//! What can go wrong.

/// Why a plot is not drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlotError {
    /// No point that its axes can show.
    #[error("a plot without points")]
    Empty,
    /// What the drawing library says.
    #[error("cannot draw: {0}")]
    Draw(String),
    /// It cannot be written.
    #[error("{}: {error}", path.display())]
    Write {
        /// Where to.
        path: std::path::PathBuf,
        /// Why not.
        error: std::io::Error,
    },
}

/// Why a file of records is no use.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A quote that does not end.
    #[error("not comma-separated values")]
    Syntax,
    /// Nothing but a head, or not even that.
    #[error("no records")]
    Empty,
    /// A column that is needed.
    #[error("no column {0}")]
    Column(&'static str),
    /// A line with more or fewer fields than there are columns.
    #[error("line {line} has {fields} fields in place of {columns}")]
    Fields {
        /// From 1, that of the head.
        line: usize,
        /// Of this line.
        fields: usize,
        /// Of the head.
        columns: usize,
    },
    /// A field that is no number.
    #[error("line {line}: {column} is not a number")]
    Number {
        /// From 1, that of the head.
        line: usize,
        /// Which column.
        column: &'static str,
    },
    /// Two records that have no scene, set, backend and setting in common.
    #[error("the records have nothing in common: no scene, set, backend and setting is in both")]
    Foreign,
}
