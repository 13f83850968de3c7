//! Writes results to the standard output, or to a file that appears when it is complete.

use crate::io::input::is_standard;
use crate::io::interrupt::{Listed, unfinished};
use crate::io::progress::{Progress, Unit};
use crate::io::streams::{Stream, Streams};
use crate::io::usage::usage;
use anyhow::{Context, bail};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// A buffered destination.
///
/// If it is dropped before [`finish`](Self::finish), or the program is interrupted, the file stays as it was before.
/// A process that ends without a chance to clean up (by SIGKILL, or a limit of the system) leaves a file `.p2m-*` in
/// the same folder.
pub(crate) struct Output<'a> {
    sink: Sink<'a>,
    name: String,
    bytes: u64,
    progress: Option<Progress>,
}

enum Sink<'a> {
    Stdout(BufWriter<Stream<'a, dyn Write>>),
    /// A file, which is written under another name in the same directory and renamed at the end.
    File {
        temporary: BufWriter<File>,
        path: TempPath,
        target: PathBuf,
        listed: Listed,
    },
    /// A device or a pipe, which renaming would replace.
    Device(BufWriter<File>),
}

/// The size of buffers for writing, in bytes.
const BUFFER_BYTES: usize = 1 << 16;

impl<'a> Output<'a> {
    /// Refuses to write over any of `inputs`, by whatever name or link `path` reaches it.
    ///
    /// A hard link is harmless: the new file takes the name of the link, and the input keeps its own name and content.
    pub(crate) fn refuse_inputs(path: &Path, inputs: &[&Path]) -> anyhow::Result<()> {
        // A path to nothing is no input.
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

    /// Opens `path`, or the standard output if there is none or it is `-`. A link is followed, and a link to
    /// nothing is refused.
    pub(crate) fn open(streams: &'a Streams, path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|p| !is_standard(p)) else {
            let sink = Sink::Stdout(BufWriter::with_capacity(BUFFER_BYTES, streams.stdout()));
            return Ok(Self { sink, name: "the standard output".to_owned(), bytes: 0, progress: None });
        };
        let name = path.display().to_string();
        let sink = Sink::open(path).with_context(|| cannot_write(&name))?;
        Ok(Self { sink, name, bytes: 0, progress: None })
    }

    /// Shows the progress of writing if that takes long.
    pub(crate) fn with_progress(mut self, streams: &Streams) -> Self {
        self.progress = Some(Progress::start(streams, &format!("writing {}", self.name), None, Unit::Bytes));
        self
    }

    /// Returns the number of bytes that were written so far.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns the message for an error of writing.
    pub(crate) fn cannot_write(&self) -> String {
        cannot_write(&self.name)
    }

    /// Writes all of the content to the standard output.
    pub(crate) fn print(streams: &'a Streams, content: impl AsRef<[u8]>) -> anyhow::Result<()> {
        Self::open(streams, None)?.finish_with(content)
    }

    /// Writes content, and completes the output.
    pub(crate) fn finish_with(mut self, content: impl AsRef<[u8]>) -> anyhow::Result<()> {
        self.write_all(content.as_ref()).with_context(|| self.cannot_write())?;
        self.finish()
    }

    /// Completes the output, and gives a file its name.
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
        // A link is followed, so that it keeps its target.
        let target = match fs::canonicalize(path) {
            Ok(target) => target,
            // Renaming would replace a link to nothing.
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
                return Ok(Self::Device(BufWriter::with_capacity(BUFFER_BYTES, file)));
            }
            Ok(old) if old.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
            Ok(old) => {
                builder.permissions(old.permissions());
            }
            Err(_) => {
                // Like any new file it is readable for everybody, as far as the user's mask permits.
                #[cfg(unix)]
                builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            }
        }
        let directory = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let mut unfinished = unfinished();
        // The error of a temporary file names that file, which means nothing to the user.
        let temporary = builder.tempfile_in(directory).map_err(|e| {
            let folder = directory.display();
            let reason = match e.kind() {
                io::ErrorKind::NotFound => "the folder does not exist".to_owned(),
                kind => kind.to_string(),
            };
            io::Error::new(e.kind(), format!("no file can be made in the folder '{folder}': {reason}"))
        })?;
        // The parts are used separately, because errors of the whole name the temporary file as well.
        let (temporary, path) = temporary.into_parts();
        let listed = Listed::new(&mut unfinished, &path);
        Ok(Self::File { temporary: BufWriter::with_capacity(BUFFER_BYTES, temporary), path, target, listed })
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
