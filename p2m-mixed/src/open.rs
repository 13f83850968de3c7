//! Opening files.

use crate::error::{FileLocation, ReadError, Reason};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// Opens a file with a buffer. `name` is the name of the file in messages.
///
/// # Errors
/// [`Reason::Io`] if the file cannot be opened, or is a directory.
pub fn open(path: &Path, name: &str) -> Result<BufReader<File>, ReadError> {
    let fail = |e| ReadError::new(name, FileLocation::File, Reason::Io(e));
    let file = File::open(path).map_err(fail)?;
    // Some systems can open a directory, and return an error only when it is read.
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(fail(io::ErrorKind::IsADirectory.into()));
    }
    Ok(BufReader::with_capacity(1 << 16, file))
}
