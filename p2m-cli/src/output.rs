//! Where results go: the standard output, or a file that appears when it is complete.

use anyhow::Context;
use std::fs::{self, File};
use std::io::{self, BufWriter, StdoutLock, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A buffered destination. Nothing is left of it unless [`finish`](Self::finish) is reached.
pub(crate) struct Output {
    sink: Sink,
    name: String,
}

enum Sink {
    Stdout(BufWriter<StdoutLock<'static>>),
    /// Written under another name in the same directory, and renamed at the end.
    File {
        temporary: BufWriter<NamedTempFile>,
        target: PathBuf,
    },
    /// A device or a pipe: renaming would replace it.
    Device(BufWriter<File>),
}

const BUFFER: usize = 1 << 16;

impl Output {
    /// Opens `path`; the standard output if there is none or it is `-`.
    pub(crate) fn open(path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|p| *p != Path::new("-")) else {
            let sink = Sink::Stdout(BufWriter::with_capacity(BUFFER, io::stdout().lock()));
            return Ok(Self { sink, name: "the standard output".to_owned() });
        };
        let name = path.display().to_string();
        let sink = Sink::open(path).with_context(|| cannot_write(&name))?;
        Ok(Self { sink, name })
    }

    /// What to say when writing fails.
    pub(crate) fn cannot_write(&self) -> String {
        cannot_write(&self.name)
    }

    /// Makes the result visible.
    pub(crate) fn finish(self) -> anyhow::Result<()> {
        self.sink.finish().with_context(|| cannot_write(&self.name))
    }
}

fn cannot_write(name: &str) -> String {
    format!("{name}: cannot be written")
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Stdout(writer) => writer.write(bytes),
            Sink::File { temporary, .. } => temporary.write(bytes),
            Sink::Device(writer) => writer.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Stdout(writer) => writer.flush(),
            Sink::File { temporary, .. } => temporary.flush(),
            Sink::Device(writer) => writer.flush(),
        }
    }
}

impl Sink {
    fn open(path: &Path) -> io::Result<Self> {
        // A link is followed, so that it goes on pointing where it does.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let mut builder = tempfile::Builder::new();
        builder.prefix(".p2m-");
        match fs::metadata(&target) {
            Ok(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(old) if !old.is_file() => {
                let file = File::options().write(true).open(&target)?;
                return Ok(Self::Device(BufWriter::with_capacity(BUFFER, file)));
            }
            Ok(old) if old.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
            Ok(old) => {
                builder.permissions(old.permissions());
            }
            Err(_) => {
                // As for any new file: everybody may read it, unless the user's mask says otherwise.
                #[cfg(unix)]
                builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            }
        }
        let directory = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let temporary = BufWriter::with_capacity(BUFFER, builder.tempfile_in(directory)?);
        Ok(Self::File { temporary, target })
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Stdout(mut writer) => writer.flush(),
            Self::Device(mut writer) => writer.flush(),
            Self::File { temporary, target } => {
                let file = temporary.into_inner().map_err(io::IntoInnerError::into_error)?;
                file.persist(target)?;
                Ok(())
            }
        }
    }
}
