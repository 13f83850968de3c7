//! Writes results to the standard output, or to a file that appears when it is complete.

use crate::io::input::is_standard;
use crate::io::interrupt::{Listed, unfinished};
use crate::io::progress::{Progress, Unit};
use crate::io::streams::{Stream, Streams};
use crate::io::usage::usage;
use anyhow::{Context, bail};
use p2m_mixed::engine::OutputFile;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A buffered destination.
///
/// If it is dropped before [`finish`](Self::finish), or the program is interrupted, the file stays as it was before
/// (see [`OutputFile`]).
pub(crate) struct Output<'a> {
    sink: Sink<'a>,
    name: String,
    bytes: u64,
    progress: Option<Progress>,
}

enum Sink<'a> {
    Stdout(BufWriter<Stream<'a, dyn Write>>),
    /// A file, which is on the list of unfinished files while it has another name.
    File {
        file: OutputFile,
        listed: Option<Listed>,
    },
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

    /// Refuses to write both a report and something else to the standard output.
    pub(crate) fn refuse_report(is_json: bool, path: &Path, instead: &str) -> anyhow::Result<()> {
        if is_json && is_standard(path) {
            return Err(usage(format!("--json reports on the standard output, so {instead}")));
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
            Sink::File { file, .. } => file.write(bytes),
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
            Sink::File { file, .. } => file.flush(),
        }
    }
}

impl Sink<'_> {
    fn open(path: &Path) -> io::Result<Self> {
        let mut unfinished = unfinished();
        let file = OutputFile::create(path)?;
        let listed = file.temporary_name().map(|name| Listed::new(&mut unfinished, name));
        Ok(Self::File { file, listed })
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Stdout(mut writer) => writer.flush(),
            Self::File { mut file, listed } => {
                file.flush()?;
                let unfinished = unfinished();
                let finished = file.finish();
                drop(unfinished);
                drop(listed);
                finished
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
