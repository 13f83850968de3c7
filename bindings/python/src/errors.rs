//! Python exceptions for the errors of the library.

use p2m_core::storage::LoadError;
use p2m_field::GridError;
use p2m_mixed::{ReadError, Reason};
use p2m_shards::ShardError;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileExistsError, PyMemoryError, PyOSError, PyValueError};
use std::io;
use std::path::Path;

/// Returns a `ValueError` with the message of an error.
pub(crate) fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Returns the exception for a row that is not finite.
pub(crate) fn not_finite(name: &str, row: usize) -> PyErr {
    value_error(format!("{name}: row {row} has a coordinate that is not finite"))
}

/// Returns the exception for a grid or a field that cannot be made.
pub(crate) fn grid_error(error: GridError) -> PyErr {
    match error {
        GridError::Memory(_) => PyMemoryError::new_err(error.to_string()),
        _ => value_error(error),
    }
}

/// Returns the exception for an error of the operating system: the subclass of `OSError`, with the name of the file.
pub(crate) fn io_error(error: &io::Error, path: &Path) -> PyErr {
    match error.raw_os_error() {
        // Python chooses the subclass by the error number.
        Some(number) => PyOSError::new_err((number, plain_message(error), path.display().to_string())),
        None => PyOSError::new_err(format!("{}: {error}", path.display())),
    }
}

/// Returns the message of an error of the operating system without its number.
fn plain_message(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_owned()
}

/// Returns the exception for a scene that cannot be read.
pub(crate) fn read_error(error: &ReadError, path: &Path) -> PyErr {
    match &error.reason {
        Reason::Io(source) | Reason::Saved(LoadError::Io(source)) => io_error(source, path),
        _ => value_error(error),
    }
}

/// Returns the exception for a saved index that cannot be loaded.
pub(crate) fn load_error(error: &LoadError, name: &str) -> PyErr {
    match error {
        LoadError::Io(source) => io_error(source, Path::new(name)),
        _ => value_error(format!("{name} {error}")),
    }
}

/// Returns the exception for shards that cannot be written, opened or queried, with the name of the file.
pub(crate) fn shard_error(error: ShardError) -> PyErr {
    match &error {
        ShardError::Io { file, error } => io_error(error, file),
        ShardError::Memory(_) => PyMemoryError::new_err(error.to_string()),
        ShardError::Load { file, error } => load_error(error, &file.display().to_string()),
        ShardError::Exists { .. } => PyFileExistsError::new_err(format!("{error}: give replace=True to replace it")),
        _ => value_error(error),
    }
}
