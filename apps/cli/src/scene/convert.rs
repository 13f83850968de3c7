//! `p2m convert`: converts scenes from one format to another, with changes on request.

use crate::answers::listed;
use crate::io::input::{lossless_list, or_option, scene_format, scene_help, unnamed};
use crate::io::usage::{one_of, usage};
use crate::io::{Output, SceneFile, Streams, ThreadArgs, input, is_standard, json, shown};
use crate::scene::info::counted;
use crate::scene::modify::{self, Modifiers};
use anyhow::{Context, anyhow};
use p2m_core::{Element, PrimitiveSet};
use p2m_formats::FileFormat;
use p2m_mixed::statistics::Counts;
use p2m_mixed::statistics::figure::{Count, Figure};
use p2m_mixed::{Format, Scene, WriteError, stl_rounding, write_scene};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Convert or transform a scene
#[derive(clap::Args)]
#[command(after_help = help())]
pub(crate) struct Args {
    #[arg(value_name = "IN", help = scene_help("Scene"))]
    from_file: PathBuf,

    /// The file to write; `-` is the standard output
    #[arg(value_name = "OUT")]
    to_file: PathBuf,

    /// The format of IN [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    from: Option<FileFormat>,

    /// The format of OUT [default: by the file extension]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    to: Option<Format>,

    /// Print the summary as JSON; OUT must be a file
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    modifiers: Modifiers,
}

fn help() -> String {
    format!(
        "\
{} files keep the whole geometry: the same positions, bit for bit, and the same primitives in the same order. \
Polygons are cut into triangles. STL files have triangles only, in single precision and without shared vertices. XYZ \
and CSV files have points only. The standard error reports what is lost; what a format cannot hold at all is an error.

{}

Examples:
  p2m convert scene.obj scene.ply
  p2m convert part.stl - --to obj --rotate-x 90 --scale 0.001 | p2m info - --format obj
  p2m convert dragon.ply shards.ply --subdivide 1 --displace 0.1 --gap 0.8",
        lossless_list("and"),
        modify::ORDER
    )
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let from = scene_format(&args.from_file, args.from, "--from")?;
    let target = Target::new(streams, &args.to_file, args.to, None)?;
    target.check_report(args.json)?;
    Output::refuse_inputs(&args.to_file, &[&args.from_file])?;
    let session = ThreadArgs::default().start(streams)?;
    let SceneFile { scene: read, saved, .. } = SceneFile::read(&session, &args.from_file, from, false)?;
    let has_index = saved.is_some_and(|reader| p2m_core::storage::kind(&reader).is_ok());
    let before = Counts::of(&read.soup);
    let polygons = count_cut_polygons(&read);
    let scene = args.modifiers.apply(streams, read)?;
    let mut written = target.write(streams, &scene)?;
    if target.format != Format::P2m {
        written.add_cut_polygons(polygons);
    }
    if has_index {
        written.losses.push(Loss::Index);
    }
    if args.json {
        let report = json!({
            "in": { "file": input::name(&args.from_file), "format": from.name(), "primitives": json::counts(&before) },
            "changes": args.modifiers.json(),
            "out": written.json(),
            "skipped": json::skipped(&scene.skipped),
        });
        return json::print_report(streams, "convert", [report]);
    }
    let mut text = format!("in       {} ({from}): {}\n", input::name(&args.from_file), counted(&before));
    if !scene.skipped.is_empty() {
        text += &format!("skipped  {}\n", listed(&scene.skipped));
    }
    text += &written.text();
    streams.print_summary(format_args!("{text}"));
    Ok(())
}

/// The file that a scene is written to.
pub(crate) struct Target<'a> {
    path: &'a Path,
    format: Format,
}

impl<'a> Target<'a> {
    /// Determines the format: the given one, or else that of the extension. On the standard output it is `default`, if
    /// there is one.
    pub(crate) fn new(
        streams: &Streams,
        path: &'a Path,
        given: Option<Format>,
        default: Option<Format>,
    ) -> anyhow::Result<Self> {
        let format = match given.or_else(|| default.filter(|_| is_standard(path))) {
            Some(format) => format,
            None if is_standard(path) => return Err(unnamed("output", "--to", Format::NAMES)),
            None => Format::from_path(path).map_err(|e| or_option(&e, "--to"))?,
        };
        Self::with_format(streams, path, format)
    }

    /// Takes the format of the extension, for commands without an option for it.
    pub(crate) fn by_extension(streams: &Streams, path: &'a Path) -> anyhow::Result<Self> {
        if is_standard(path) {
            return Err(usage("the standard output has no extension that names its format: choose a file"));
        }
        Self::with_format(streams, path, Format::from_path(path)?)
    }

    /// Refuses a binary format on a terminal.
    fn with_format(streams: &Streams, path: &'a Path, format: Format) -> anyhow::Result<Self> {
        if matches!(format, Format::Ply | Format::Stl | Format::P2m) {
            Output::refuse_terminal(streams, path, format.name())?;
        }
        Ok(Self { path, format })
    }

    /// Refuses to write both a report and a scene to the standard output.
    pub(crate) fn check_report(&self, is_json: bool) -> anyhow::Result<()> {
        Output::refuse_report(is_json, self.path, "the scene has to go to a file")
    }

    /// Writes the scene.
    pub(crate) fn write(&self, streams: &Streams, scene: &Scene) -> anyhow::Result<WrittenScene> {
        let mut output = Output::open(streams, Some(self.path))?.with_progress(streams);
        match write_scene(scene, self.format, &mut output) {
            Ok(()) => {}
            Err(e @ (WriteError::NotATriangle { .. } | WriteError::NotAPoint { .. })) => {
                let others = lossless_list("or").to_lowercase();
                return Err(anyhow!("{}: {e}: choose {others}", output.cannot_write()));
            }
            // The caller needs the error of the system itself: a closed pipe is no error.
            Err(WriteError::Io(e)) => return Err(e).with_context(|| output.cannot_write()),
            Err(e) => return Err(e).with_context(|| output.cannot_write()),
        }
        let bytes = output.bytes();
        output.finish()?;
        let file = if is_standard(self.path) { "standard output".to_owned() } else { shown(self.path) };
        let positions = scene.soup.positions().len() as u64;
        Ok(WrittenScene {
            file,
            format: self.format,
            bytes,
            counts: Counts::of(&scene.soup),
            positions,
            losses: losses(scene, self.format),
        })
    }
}

/// A scene that was written to a file.
pub(crate) struct WrittenScene {
    file: String,
    format: Format,
    bytes: u64,
    counts: Counts,
    positions: u64,
    losses: Vec<Loss>,
}

impl WrittenScene {
    /// Returns the part of a report about the file.
    pub(crate) fn json(&self) -> Value {
        json!({
            "file": self.file,
            "format": self.format.name(),
            "bytes": self.bytes,
            "primitives": json::counts(&self.counts),
            "positions": self.positions,
            "lost": self.losses,
        })
    }

    /// Adds that polygons were cut into triangles.
    fn add_cut_polygons(&mut self, count: u64) {
        if count > 0 {
            self.losses.insert(0, Loss::Polygons { count });
        }
    }

    /// Returns lines about the file for people.
    pub(crate) fn text(&self) -> String {
        let mut text = format!(
            "out      {} ({}): {}, {} bytes\n",
            self.file,
            self.format,
            counted(&self.counts),
            Count(self.bytes)
        );
        for loss in &self.losses {
            text += &format!("lost     {}\n", loss.text());
        }
        text
    }
}

/// A property of the scene that its file does not have. Reports have it as it is here.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Loss {
    /// The number of polygons that were cut into triangles.
    Polygons { count: u64 },
    /// The number of names.
    Names { count: u64 },
    /// The number of coordinates that were rounded to f32, and the largest change.
    Precision { count: u64, largest: f64 },
    /// The number of positions that no primitive uses.
    UnusedPositions { count: u64 },
    /// The vertices that triangles share.
    SharedPositions,
    /// The index of a saved file.
    Index,
}

impl Loss {
    fn text(&self) -> String {
        match *self {
            Self::Polygons { count } => {
                format!("polygons: {} are written as the triangles that they are cut into", Count(count))
            }
            Self::Names { count } => format!("names of objects: {}", Count(count)),
            Self::Precision { count, largest } => {
                format!("precision: coordinates rounded to f32: {}, by up to {}", Count(count), Figure(largest))
            }
            Self::UnusedPositions { count } => format!("positions that belong to no primitive: {}", Count(count)),
            Self::SharedPositions => "which corners are shared: each triangle has its own".to_owned(),
            Self::Index => "the index of the saved file (p2m build makes another)".to_owned(),
        }
    }
}

/// Lists the properties of a scene that a file of this format does not have.
fn losses(scene: &Scene, format: Format) -> Vec<Loss> {
    let mut losses = Vec::new();
    if format == Format::P2m {
        return losses;
    }
    if format != Format::Obj && !scene.objects.is_empty() {
        losses.push(Loss::Names { count: scene.objects.len() as u64 });
    }
    let unused = count_unused_positions(scene);
    let is_used_only = matches!(format, Format::Stl | Format::Xyz | Format::Csv);
    let is_lost = is_used_only || (format != Format::Ply && scene.soup.is_empty());
    if unused > 0 && is_lost {
        losses.push(Loss::UnusedPositions { count: unused });
    }
    if format == Format::Stl {
        let rounding = stl_rounding(scene);
        if rounding.count > 0 {
            losses.push(Loss::Precision { count: rounding.count, largest: rounding.largest });
        }
        if (scene.soup.positions().len() as u64 - unused) < 3 * scene.soup.triangles().len() as u64 {
            losses.push(Loss::SharedPositions);
        }
    }
    losses
}

/// Counts the polygons of the file that were cut into triangles. They are runs of triangles from the same source.
fn count_cut_polygons(scene: &Scene) -> u64 {
    let triangles = scene.soup.elements().zip(&scene.sources).filter(|(e, _)| matches!(e, Element::Triangle(_)));
    let sources: Vec<u32> = triangles.map(|(_, &source)| source).collect();
    sources.chunk_by(|a, b| a == b).filter(|run| run.len() > 1).count() as u64
}

/// Counts the positions that no primitive uses.
fn count_unused_positions(scene: &Scene) -> u64 {
    let mut used = vec![false; scene.soup.positions().len()];
    for element in scene.soup.elements() {
        for &i in element.indices() {
            used[i as usize] = true;
        }
    }
    used.iter().filter(|used| !**used).count() as u64
}
