//! Files that appear when they are complete.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// The size of the buffer, in bytes.
const BUFFER_BYTES: usize = 1 << 16;

/// A file that is written under another name in the same folder and gets its name when it is complete.
///
/// If it is dropped before [`finish`](Self::finish), the file stays as it was before. A link is followed, a file that
/// is replaced keeps its mode, and a read-only file is not replaced. A device or a pipe is written as it is, because
/// another file would take its place. A process that is killed leaves a file `.p2m-*` in the folder.
#[derive(Debug)]
pub struct OutputFile {
    writer: BufWriter<File>,
    /// The temporary name, which nobody can guess, and the final name; `None` for a device or a pipe.
    names: Option<(TempPath, PathBuf)>,
}

impl OutputFile {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// `path` is a link to nothing, a folder or a read-only file, or no file can be created in its folder.
    pub fn create(path: &Path) -> io::Result<Self> {
        // A link is followed, so that it keeps its target.
        let target = match fs::canonicalize(path) {
            Ok(target) => target,
            // Renaming would replace a link to nothing.
            Err(_) if fs::symlink_metadata(path).is_ok_and(|m| m.is_symlink()) => {
                return Err(io::Error::new(io::ErrorKind::NotFound, "it is a link to nothing"));
            }
            Err(_) => path.to_owned(),
        };
        let old = fs::metadata(&target).ok();
        match &old {
            Some(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Some(old) if !old.is_file() => {
                let file = File::options().write(true).open(&target)?;
                return Ok(Self { writer: BufWriter::with_capacity(BUFFER_BYTES, file), names: None });
            }
            Some(old) if old.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
            _ => {}
        }
        let (file, name) = temporary_file(&target, old.as_ref())?;
        Ok(Self { writer: BufWriter::with_capacity(BUFFER_BYTES, file), names: Some((name, target)) })
    }

    /// Returns the temporary name of the file, if it has one.
    #[must_use]
    pub fn temporary_name(&self) -> Option<&Path> {
        self.names.as_ref().map(|(temporary, _)| &**temporary)
    }

    /// Completes the file, and renames it to its final name.
    ///
    /// # Errors
    /// Errors of writing and renaming.
    pub fn finish(mut self) -> io::Result<()> {
        self.writer.flush()?;
        match self.names {
            Some((temporary, target)) => temporary.persist(target).map_err(|e| e.error),
            None => Ok(()),
        }
    }
}

/// Makes a file beside `target` with the mode of the old file.
fn temporary_file(target: &Path, old: Option<&Metadata>) -> io::Result<(File, TempPath)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".p2m-");
    if let Some(old) = old {
        builder.permissions(old.permissions());
    } else {
        // Like any new file it is readable for everybody, as far as the user's mask permits.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    }
    let folder = match target.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    // The error of a temporary file names that file, which means nothing to the user.
    let file = builder.tempfile_in(folder).map_err(|e| {
        let reason = match e.kind() {
            io::ErrorKind::NotFound => "the folder does not exist".to_owned(),
            kind => kind.to_string(),
        };
        let folder = folder.display();
        io::Error::new(e.kind(), format!("no file can be made in the folder '{folder}': {reason}"))
    })?;
    // The parts are used separately, because errors of the whole name the temporary file as well.
    Ok(file.into_parts())
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}
