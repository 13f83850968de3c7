//! Reads input files. The name `-` stands for the standard input.

use crate::progress::{Progress, Unit};
use crate::streams::Streams;
use crate::usage::{one_of, usage};
use anyhow::{Context, anyhow};
use nalgebra::Point3;
use p2m_core::Ray;
use p2m_core::storage::{LoadError, Reader, SavedFile};
use p2m_mixed::{Format, PointFormat, ReadError, Scene, load_scene};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// The size of buffers for reading, in bytes.
const BUFFER_BYTES: usize = 1 << 16;
/// The name of the standard input and the standard output.
pub(crate) const STANDARD: &str = "-";

/// A scene to read.
#[derive(clap::Args)]
pub(crate) struct SceneArgs {
    /// Scene: an OBJ, PLY, STL or OFF file, or an index that `p2m build` saved; `-` is the standard input
    #[arg(value_name = "SCENE")]
    pub(crate) path: PathBuf,

    /// The format of the scene, if its extension does not name it
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    format: Option<Format>,
}

impl SceneArgs {
    /// Returns the name of the scene in messages.
    pub(crate) fn name(&self) -> String {
        name(&self.path)
    }

    /// Returns the format of the scene.
    pub(crate) fn format(&self) -> anyhow::Result<Format> {
        scene_format(&self.path, self.format, "--format")
    }
}

/// Whether `path` stands for the standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// Returns the name of an input in messages.
pub(crate) fn name(path: &Path) -> String {
    if is_standard(path) { "standard input".to_owned() } else { path.display().to_string() }
}

/// Returns the format of a scene: the given one, or else that of the extension.
pub(crate) fn scene_format(path: &Path, given: Option<Format>, option: &str) -> anyhow::Result<Format> {
    match given {
        Some(format) => Ok(format),
        None if is_standard(path) => Err(unnamed(option, Format::NAMES)),
        None => Format::from_path(path).map_err(|e| or_option(&e, option)),
    }
}

/// Returns the format of points or rays: the given one, or else that of the extension.
pub(crate) fn point_format(path: &Path, given: Option<PointFormat>, option: &str) -> anyhow::Result<PointFormat> {
    match given {
        Some(format) => Ok(format),
        None if is_standard(path) => Err(unnamed(option, PointFormat::NAMES)),
        None => PointFormat::from_path(path).map_err(|e| or_option(&e, option)),
    }
}

/// The error that the standard input has no format.
fn unnamed(option: &str, names: &[&str]) -> anyhow::Error {
    usage(format!("the standard input has no extension that names its format: add {option} {}", names.join("|")))
}

/// The error of an unknown extension, with the option that names the format.
pub(crate) fn or_option(error: &ReadError, option: &str) -> anyhow::Error {
    anyhow!("{error}, or name the format with {option}")
}

/// Reads a scene. Of a saved index it returns the reader of the index as well.
pub(crate) fn read_scene_and_index(
    streams: &Streams,
    path: &Path,
    format: Format,
) -> anyhow::Result<(Scene, Option<Reader>)> {
    if format != Format::P2m {
        return Ok((p2m_mixed::read_scene_from(open(streams, path)?, format, &name(path))?, None));
    }
    let stream = open(streams, path)?;
    let load = || -> Result<_, LoadError> {
        let file = SavedFile::read(stream)?;
        let reader = file.checked()?;
        Ok((load_scene(reader)?, Some(reader.clone())))
    };
    load().with_context(|| name(path))
}

/// Reads a scene.
pub(crate) fn read_scene(streams: &Streams, path: &Path, format: Format) -> anyhow::Result<Scene> {
    Ok(read_scene_and_index(streams, path, format)?.0)
}

/// Reads the points of a file.
pub(crate) fn read_points(streams: &Streams, path: &Path, format: PointFormat) -> anyhow::Result<Vec<Point3<f64>>> {
    Ok(p2m_mixed::read_points_from(open(streams, path)?, format, &name(path))?)
}

/// Reads the rays of a file.
pub(crate) fn read_rays(streams: &Streams, path: &Path, format: PointFormat) -> anyhow::Result<Vec<Ray>> {
    Ok(p2m_mixed::read_rays_from(open(streams, path)?, format, &name(path))?)
}

/// Opens a file and shows the progress of reading.
fn open<'a>(streams: &'a Streams, path: &Path) -> anyhow::Result<ProgressReader<'a>> {
    let name = name(path);
    let what = format!("reading {name}");
    if is_standard(path) {
        let reader = Box::new(BufReader::with_capacity(BUFFER_BYTES, streams.stdin()));
        return Ok(ProgressReader { reader, progress: Progress::start(streams, &what, None, Unit::Bytes) });
    }
    let cannot_read = || format!("{name}: cannot be read");
    let file = File::open(path).with_context(cannot_read)?;
    let metadata = file.metadata().with_context(cannot_read)?;
    // Some systems open a directory and fail only at its first line.
    if metadata.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory)).with_context(cannot_read);
    }
    // A pipe has no length.
    let total = metadata.is_file().then_some(metadata.len());
    let reader = Box::new(BufReader::with_capacity(BUFFER_BYTES, file));
    Ok(ProgressReader { reader, progress: Progress::start(streams, &what, total, Unit::Bytes) })
}

/// A reader that shows its progress.
struct ProgressReader<'a> {
    reader: Box<dyn BufRead + 'a>,
    progress: Progress,
}

impl Read for ProgressReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        self.progress.add(count as u64);
        Ok(count)
    }
}

impl BufRead for ProgressReader<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.reader.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.progress.add(count as u64);
        self.reader.consume(count);
    }
}
