//! Reads input files. The name `-` stands for the standard input.

use crate::io::limits::{Counted, Decompressed, too_large};
use crate::io::progress::{Progress, Unit};
use crate::io::read_pipeline::pump;
use crate::io::streams::Streams;
use crate::io::threads::Session;
use crate::io::usage::{one_of, usage};
use crate::io::zstd::{ZstdReader, is_zstd};
use anyhow::{Context, anyhow, bail};
use flate2::bufread::MultiGzDecoder;
use nalgebra::Point3;
use p2m_core::Ray;
use p2m_core::storage::{LoadError, Reader, SavedFile};
use p2m_formats::FileFormat;
use p2m_mixed::{Format, PointColumns, PointFormat, PointTable, Reason, Scene, Unit as LengthUnit, load_scene};
use std::cell::Cell;
use std::fs::{File, Metadata};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// The size of buffers for reading, in bytes.
const BUFFER_BYTES: usize = 1 << 16;
/// The name of the standard input and the standard output.
pub(crate) const STANDARD: &str = "-";

/// The end of the help of files that may be compressed.
pub(crate) const COMPRESSED: &str = ", also compressed by gzip or zstd";

/// Returns the help of a scene with this name.
pub(crate) fn scene_help(name: &str) -> String {
    format!("{name}: a file ({}), a saved index, or `-`", format_list(FileFormat::all(), "or"))
}

/// Returns a list of formats of scenes, such as `OBJ, PLY or OFF`, in which `last` comes before the last one. Saved
/// indexes are not in it.
pub(crate) fn format_list(formats: impl Iterator<Item = FileFormat>, last: &str) -> String {
    let listed = formats.filter(|format| *format != Format::P2m.into());
    let mut names: Vec<_> = listed.map(|format| format.name().to_uppercase()).collect();
    let end = names.pop().expect("a format of scenes");
    format!("{} {last} {end}", names.join(", "))
}

/// Returns a list of the formats that hold every scene.
pub(crate) fn lossless_list(last: &str) -> String {
    format_list(Format::ALL.iter().filter(|format| format.is_lossless()).map(|format| (*format).into()), last)
}

/// A scene to read.
#[derive(clap::Args)]
pub(crate) struct SceneArgs {
    #[arg(value_name = "SCENE", help = scene_help("Scene") + COMPRESSED)]
    pub(crate) path: PathBuf,

    /// The format of the scene [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    format: Option<FileFormat>,

    /// Map a saved index into memory, so that processes share it
    ///
    /// The file is still checked. Do not change or truncate it while the command runs: the behaviour is then undefined.
    #[arg(long)]
    pub(crate) map: bool,
}

impl SceneArgs {
    /// Returns the name of the scene in messages.
    pub(crate) fn name(&self) -> String {
        name(&self.path)
    }

    /// Returns whether the user names the format.
    pub(crate) fn has_format(&self) -> bool {
        self.format.is_some()
    }

    /// Returns the format of the scene.
    pub(crate) fn format(&self) -> anyhow::Result<FileFormat> {
        scene_format(&self.path, self.format, "--format")
    }

    /// Reads the scene.
    pub(crate) fn read(&self, session: &Session<'_>, format: FileFormat) -> anyhow::Result<SceneFile> {
        SceneFile::read(session, &self.path, format, self.map)
    }
}

/// A scene that was read from a file.
pub(crate) struct SceneFile {
    /// The name of the file in messages.
    pub(crate) name: String,
    pub(crate) format: FileFormat,
    pub(crate) scene: Scene,
    /// The reader of the index, if the file is a saved one.
    pub(crate) saved: Option<Reader>,
    /// The time that reading took.
    pub(crate) read_time: Duration,
}

impl SceneFile {
    /// Reads a scene, and the reader of the index of a saved one, which is mapped if `is_mapped` is set.
    pub(crate) fn read(
        session: &Session<'_>,
        path: &Path,
        format: FileFormat,
        is_mapped: bool,
    ) -> anyhow::Result<Self> {
        let start = Instant::now();
        let name = name(path);
        // A file that is missing is an error of mapping it.
        let is_no_file = is_standard(path) || (path.exists() && !path.is_file());
        if is_mapped && (format != Format::P2m.into() || is_no_file || is_compressed(path)) {
            return Err(usage("--map needs the file of a saved index, which is not compressed"));
        }
        let (scene, saved) = if format == Format::P2m.into() {
            let load = |file: SavedFile| -> Result<_, LoadError> {
                let reader = file.checked()?;
                Ok((load_scene(reader)?, Some(reader.clone())))
            };
            let file = if is_mapped {
                map(path)
            } else {
                SavedFile::read_with_length(open(session.streams, path)?, length(path))
            };
            file.and_then(load).with_context(|| name.clone())?
        } else {
            let read = |reader| p2m_formats::read_scene_from(reader, format, &name, companions_of(path));
            let scene = pump(&session.pool, open(session.streams, path)?, read)?;
            print_notes(session.streams, path, scene.unit, scene.is_flat);
            (scene, None)
        };
        Ok(Self { name, format, scene, saved, read_time: start.elapsed() })
    }
}

/// Whether `path` stands for the standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// Returns the name of an input in messages.
pub(crate) fn name(path: &Path) -> String {
    if is_standard(path) { "standard input".to_owned() } else { shown(path) }
}

/// Returns a path as text of one line. Characters that control a terminal are escaped, and so are bytes that are no
/// UTF-8, as in `a\\xff.obj`.
pub(crate) fn shown(path: &Path) -> String {
    match path.to_str() {
        Some(text) if !text.contains(char::is_control) => text.to_owned(),
        Some(text) => {
            text.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.into() }).collect()
        }
        None => path.as_os_str().as_encoded_bytes().escape_ascii().to_string(),
    }
}

/// Returns the format of a scene: the given one, or else that of the extension.
pub(crate) fn scene_format(path: &Path, given: Option<FileFormat>, option: &str) -> anyhow::Result<FileFormat> {
    match given {
        Some(format) => Ok(format),
        None if is_standard(path) => Err(unnamed("input", option, FileFormat::names())),
        None => FileFormat::from_path(&uncompressed_name(path)?).map_err(|error| match error.reason {
            Reason::UnknownExtension { .. } => or_option(&error, option),
            // The error names a converter.
            _ => error.into(),
        }),
    }
}

/// Returns the format of rays: the given one, or else that of the extension.
pub(crate) fn ray_format(path: &Path, given: Option<PointFormat>, option: &str) -> anyhow::Result<PointFormat> {
    match given {
        Some(format) => Ok(format),
        None if is_standard(path) => Err(unnamed("input", option, PointFormat::NAMES)),
        None => PointFormat::from_path(&uncompressed_name(path)?).map_err(|e| or_option(&e, option)),
    }
}

/// Returns the name of a file without the extension of a compression. A directory has no format, and is refused.
pub(crate) fn uncompressed_name(path: &Path) -> anyhow::Result<PathBuf> {
    if path.is_dir() {
        bail!("{}: cannot be read: is a directory", shown(path));
    }
    // The name of a file that is missing is more likely wrong than without its extension.
    if path.extension().is_none() {
        path.metadata().with_context(|| format!("{}: cannot be read", name(path)))?;
    }
    Ok(if is_compressed(path) { path.with_extension("") } else { path.to_owned() })
}

/// Returns whether a name has one of these extensions.
pub(crate) fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|found| extensions.iter().any(|extension| found.eq_ignore_ascii_case(extension)))
}

/// Returns whether a name has the extension of a compression.
fn is_compressed(path: &Path) -> bool {
    has_extension(path, &["gz", "zst"])
}

/// The error that a standard stream has no format.
pub(crate) fn unnamed(stream: &str, option: &str, names: &[&str]) -> anyhow::Error {
    let names = names.join("|");
    usage(format!("the standard {stream} has no extension that names its format: add {option} {names}"))
}

/// The error of an unknown extension, with the option that names the format.
pub(crate) fn or_option(error: &impl std::fmt::Display, option: &str) -> anyhow::Error {
    anyhow!("{error}, or name the format with {option}")
}

/// Returns the length of a file in bytes, or 0 where it is not known, as for a pipe.
fn length(path: &Path) -> u64 {
    path.metadata().ok().filter(Metadata::is_file).map_or(0, |metadata| metadata.len())
}

/// Maps the file of a saved index.
fn map(path: &Path) -> Result<SavedFile, LoadError> {
    // SAFETY: `--map` says that the user has to keep the file unchanged.
    #[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
    unsafe {
        SavedFile::map(path)
    }
}

/// Returns the place where a file may have companions.
fn companions_of(path: &Path) -> Option<&Path> {
    Some(path).filter(|path| !is_standard(path))
}

/// Says what a reader assumes of coordinates.
fn print_notes(streams: &Streams, path: &Path, unit: Option<LengthUnit>, is_flat: bool) {
    let name = name(path);
    if is_flat {
        streams.print_summary(format_args!("note     {name} has two coordinates for each point: z is 0\n"));
    }
    if unit == Some(LengthUnit::Degree) {
        streams.print_summary(format_args!(
            "note     {name} is in degrees, so distances are no lengths: ogr2ogr -t_srs converts it to metres\n"
        ));
    }
}

/// Points to read.
#[derive(clap::Args)]
pub(crate) struct PointArgs {
    /// Read the query points from a file: a table (XYZ, TXT, ASC, PTS, CSV), an array (NPY), or the vertices of a scene
    #[arg(long, value_name = "FILE")]
    pub(crate) points: Option<PathBuf>,

    /// The format of the points [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    points_format: Option<FileFormat>,

    /// The columns of x, y and perhaps z in a text table: names, or numbers from 1
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', num_args = 1)]
    points_columns: Vec<String>,

    /// The column of a text table that has the ids of points [default: id]
    #[arg(long, value_name = "COLUMN")]
    points_id: Option<String>,
}

impl PointArgs {
    /// Reads the points, if there is a file of them.
    pub(crate) fn read(&self, streams: &Streams) -> anyhow::Result<Option<PointTable>> {
        let Some(path) = &self.points else {
            // clap forgets what an option requires where that conflicts with another one.
            let has_options =
                self.points_format.is_some() || self.points_id.is_some() || !self.points_columns.is_empty();
            return match has_options {
                true => Err(usage("--points-format, --points-columns and --points-id need --points")),
                false => Ok(None),
            };
        };
        let format = scene_format(path, self.points_format, "--points-format")?;
        let columns = PointColumns { coordinates: self.points_columns.clone(), id: self.points_id.clone() };
        read_points(streams, path, format, &columns, "--points-columns and --points-id are").map(Some)
    }
}

/// Reads the points of a file. Only the columns of a text table can be chosen, which `options` do.
pub(crate) fn read_points(
    streams: &Streams,
    path: &Path,
    format: FileFormat,
    columns: &PointColumns,
    options: &str,
) -> anyhow::Result<PointTable> {
    let is_table = matches!(format, FileFormat::Own(Format::Xyz | Format::Csv));
    if *columns != PointColumns::default() && !is_table {
        return Err(usage(format!("{options} for text tables, and {} is none", name(path))));
    }
    let reader = open(streams, path)?;
    let table = p2m_formats::read_points_from(reader, format, &name(path), companions_of(path), columns)?;
    print_notes(streams, path, table.unit, table.is_flat);
    Ok(table)
}

/// Reads points whose coordinates are finite, if there is a file of them. A note says how many are left out.
pub(crate) fn read_finite_points(streams: &Streams, args: &PointArgs) -> anyhow::Result<Option<Vec<Point3<f64>>>> {
    let Some(PointTable { mut points, .. }) = args.read(streams)? else { return Ok(None) };
    let count = points.len();
    points.retain(|point| point.iter().all(|x| x.is_finite()));
    if points.len() < count {
        let left_out = count - points.len();
        streams.print_summary(format_args!("note     {left_out} of {count} points are not finite and are left out\n"));
    }
    Ok(Some(points))
}

/// Reads the rays of a file.
pub(crate) fn read_rays(streams: &Streams, path: &Path, format: PointFormat) -> anyhow::Result<Vec<Ray>> {
    Ok(p2m_mixed::read_rays_from(open(streams, path)?, format, &name(path))?)
}

/// Opens a file, shows the progress of reading, and decompresses what gzip or zstd has compressed.
fn open<'a>(streams: &'a Streams, path: &Path) -> anyhow::Result<Box<dyn BufRead + 'a>> {
    let mut raw = open_raw(streams, path)?;
    let start = raw.fill_buf().with_context(|| format!("{}: cannot be read", name(path)))?;
    let (is_gzip, is_zstd) = (start.starts_with(&GZIP_MAGIC), is_zstd(start));
    if !is_gzip && !is_zstd {
        return Ok(Box::new(raw));
    }
    let compressed = Rc::new(Cell::new(0));
    let count = Rc::clone(&compressed);
    let raw = Counted { reader: raw, add: move |bytes| count.set(count.get() + bytes) };
    let decoder: Box<dyn Read + 'a> =
        if is_gzip { Box::new(MultiGzDecoder::new(raw)) } else { Box::new(ZstdReader::new(raw)) };
    let decompressed = Decompressed::new(decoder, streams.limits(), compressed);
    Ok(Box::new(BufReader::with_capacity(BUFFER_BYTES, decompressed)))
}

/// Reads a small text file, such as a matrix.
pub(crate) fn read_small_text(streams: &Streams, path: &Path) -> anyhow::Result<String> {
    let cannot_read = || format!("{}: cannot be read", name(path));
    let limit = streams.limits().matrix;
    let mut text = String::new();
    let count = File::open(path).and_then(|file| file.take(limit.saturating_add(1)).read_to_string(&mut text));
    if count.with_context(cannot_read)? as u64 > limit {
        return Err(too_large(&format!("it has more than {limit} bytes"), "matrix")).with_context(cannot_read);
    }
    Ok(text)
}

/// Returns whether a path is a file, and not a pipe, whose content is not compressed.
pub(crate) fn is_plain_file(path: &Path) -> bool {
    let is_compressed = || -> io::Result<bool> {
        let mut reader = BufReader::new(File::open(path)?);
        let start = reader.fill_buf()?;
        Ok(start.starts_with(&GZIP_MAGIC) || is_zstd(start))
    };
    path.is_file() && is_compressed().is_ok_and(|is_compressed| !is_compressed)
}

/// The first bytes of what gzip has compressed.
const GZIP_MAGIC: [u8; 3] = [0x1f, 0x8b, 8];

/// Opens a file and shows the progress of reading.
fn open_raw<'a>(streams: &'a Streams, path: &Path) -> anyhow::Result<Box<dyn BufRead + 'a>> {
    let name = name(path);
    let with_progress = |source: Box<dyn Read + 'a>, total| -> Box<dyn BufRead + 'a> {
        let progress = Progress::start(streams, &format!("reading {name}"), total, Unit::Bytes);
        let reader = BufReader::with_capacity(BUFFER_BYTES, source);
        Box::new(Counted { reader, add: move |bytes| progress.add(bytes) })
    };
    if is_standard(path) {
        return Ok(with_progress(Box::new(streams.stdin()), None));
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
    Ok(with_progress(Box::new(file), total))
}
