//! Where results go: the standard output, or a file that appears when it is complete.

use crate::input::is_standard;
use crate::interrupt::{Listed, unfinished};
use crate::progress::{Progress, Unit};
use crate::streams::{Stream, Streams};
use crate::usage::usage;
use anyhow::{Context, bail};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// A buffered destination. Dropped before [`finish`](Self::finish), or interrupted, a file is as it was before; only a
/// process that ends without any chance to clean up (SIGKILL, or a limit of the system) leaves its unfinished work
/// under the name `.p2m-*` in the same folder.
pub(crate) struct Output<'a> {
    sink: Sink<'a>,
    name: String,
    bytes: u64,
    progress: Option<Progress>,
}

enum Sink<'a> {
    Stdout(BufWriter<Stream<'a, dyn Write>>),
    /// Written under another name in the same directory, and renamed at the end.
    File {
        temporary: BufWriter<File>,
        path: TempPath,
        target: PathBuf,
        listed: Listed,
    },
    /// A device or a pipe: renaming would replace it.
    Device(BufWriter<File>),
}

const BUFFER: usize = 1 << 16;

impl<'a> Output<'a> {
    /// Refuses to write over any of `inputs`, by whatever name or link `path` reaches it.
    ///
    /// A hard link is harmless: a new file takes its name, the input keeps its content under its own.
    pub(crate) fn refuse_inputs(path: &Path, inputs: &[&Path]) -> anyhow::Result<()> {
        // Nothing is there, so no input is.
        let Ok(target) = fs::canonicalize(path) else { return Ok(()) };
        for input in inputs {
            if !is_standard(path) && !is_standard(input) && fs::canonicalize(input).is_ok_and(|input| input == target) {
                bail!(
                    "{}: would be written over, but it is an input: choose another name for the output",
                    path.display()
                );
            }
        }
        Ok(())
    }

    /// Refuses to write bytes to a terminal.
    pub(crate) fn refuse_terminal(streams: &Streams, path: &Path, format: &str) -> anyhow::Result<()> {
        if is_standard(path) && streams.is_stdout_terminal() {
            return Err(usage(format!("{format} is no text for a terminal: name a file, or pipe the output on")));
        }
        Ok(())
    }

    /// Opens `path`; the standard output if there is none or it is `-`. A link is followed; one to nothing is refused.
    pub(crate) fn open(streams: &'a Streams, path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|p| !is_standard(p)) else {
            let sink = Sink::Stdout(BufWriter::with_capacity(BUFFER, streams.stdout()));
            return Ok(Self { sink, name: "the standard output".to_owned(), bytes: 0, progress: None });
        };
        let name = path.display().to_string();
        let sink = Sink::open(path).with_context(|| cannot_write(&name))?;
        Ok(Self { sink, name, bytes: 0, progress: None })
    }

    /// Shows how much is written, if that takes long.
    pub(crate) fn with_progress(mut self, streams: &Streams) -> Self {
        self.progress = Some(Progress::start(streams, &format!("writing {}", self.name), None, Unit::Bytes));
        self
    }

    /// How many bytes are written so far.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
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

impl Write for Output<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = match &mut self.sink {
            Sink::Stdout(writer) => writer.write(bytes),
            Sink::File { temporary, .. } => temporary.write(bytes),
            Sink::Device(writer) => writer.write(bytes),
        }?;
        self.bytes += count as u64;
        if let Some(progress) = &self.progress {
            progress.add(count as u64);
        }
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Stdout(writer) => writer.flush(),
            Sink::File { temporary, .. } => temporary.flush(),
            Sink::Device(writer) => writer.flush(),
        }
    }
}

impl Sink<'_> {
    fn open(path: &Path) -> io::Result<Self> {
        // A link is followed, so that it goes on pointing where it does.
        let target = match fs::canonicalize(path) {
            Ok(target) => target,
            // Renaming would replace the link.
            Err(_) if fs::symlink_metadata(path).is_ok_and(|m| m.is_symlink()) => {
                return Err(io::Error::new(io::ErrorKind::NotFound, "it is a link to nothing"));
            }
            Err(_) => path.to_owned(),
        };
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
        let mut unfinished = unfinished();
        // The error of a temporary file names that file, of which the user knows nothing.
        let temporary = builder.tempfile_in(directory).map_err(|e| {
            let folder = directory.display();
            io::Error::new(e.kind(), format!("no file can be made in the folder '{folder}': {}", e.kind()))
        })?;
        // Apart, for errors of the two together name the file, too.
        let (temporary, path) = temporary.into_parts();
        let listed = Listed::new(&mut unfinished, &path);
        Ok(Self::File { temporary: BufWriter::with_capacity(BUFFER, temporary), path, target, listed })
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Stdout(mut writer) => writer.flush(),
            Self::Device(mut writer) => writer.flush(),
            Self::File { mut temporary, path, target, listed } => {
                temporary.flush()?;
                let unfinished = unfinished();
                let renamed = path.persist(target);
                drop(unfinished);
                drop(listed);
                renamed.map_err(|e| e.error)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_listed_until_it_is_finished_or_given_up() {
        let folder = tempfile::tempdir().unwrap();
        let streams = Streams::new(io::empty(), io::sink(), io::sink());
        let listed = || unfinished().iter().filter(|file| file.starts_with(folder.path())).count();
        let open = |name: &str| Output::open(&streams, Some(&folder.path().join(name))).unwrap();
        let (given_up, finished) = (open("given_up"), open("finished"));
        assert_eq!(listed(), 2);
        drop(given_up);
        assert_eq!(listed(), 1);
        finished.finish().unwrap();
        assert_eq!(listed(), 0);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
