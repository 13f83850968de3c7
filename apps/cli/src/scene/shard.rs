//! `p2m shard`: writes scenes as an index in shards.

use crate::index::{Backend, backends};
use crate::io::interrupt::{Listed, unfinished};
use crate::io::usage::{bytes, one_of};
use crate::io::{Progress, SceneFile, Session, Streams, ThreadArgs, Unit, input, json};
use crate::scene::info::counted;
use p2m_backends::BackendEntry;
use p2m_formats::FileFormat;
use p2m_mixed::statistics::figure::{Count, Time};
use p2m_mixed::{Format, PieceOptions, Skipped};
use p2m_shards::{ShardError, ShardOptions, ShardWriter, ShardedIndex, shard_file};
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const HELP: &str = "\
The scenes are joined in the order of the command line, and the numbers of primitives continue from one scene to the \
next. `p2m query` and `p2m ray` accept the folder as a scene, load shards on demand, and give the answers of one \
index over everything, apart from the last bits of lower bounds. With --epsilon or --max-visits the answers may \
differ, within the stated error. These commands refuse folders of more than 2^30 \
primitives, whose numbers do not fit into a table of answers.

Space is divided so that the file of each shard has at most --max-bytes bytes. One shard is in memory at a time, and \
scenes are read in pieces. Compressed files, saved indexes, the standard input, and files without the extension of \
their format are read as a whole, so they have to fit into memory. Temporary files in the folder take at most 176 \
bytes per primitive and 24 bytes per vertex.

The file manifest.json is written last: a folder without it is unfinished, and an index that is being replaced stays \
valid until then. The next run with --replace removes what killed runs have left. A query fails if it needs a shard \
that is missing, damaged, or from another index.

Examples:
  p2m shard city.obj --max-bytes 500MB --out city/
  p2m shard north.ply south.ply --out country/ --replace
  p2m query city/ --points scan.xyz --max-memory 2GB --out answers.npy";

/// Divide a scene that is larger than memory into shards
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[arg(value_name = "SCENE", required = true, help = input::scene_help("Each scene"))]
    scenes: Vec<PathBuf>,

    /// The format of the scenes [default: by their file extensions]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<FileFormat>(FileFormat::names()), ignore_case = true)]
    format: Option<FileFormat>,

    /// The largest size of the file of a shard, such as 500MB
    #[arg(long, value_name = "BYTES", default_value = "1GiB", value_parser = bytes)]
    max_bytes: u64,

    /// The index of each shard [default: aabb]
    #[arg(long, value_parser = backends(BackendEntry::is_saveable))]
    backend: Option<Backend>,

    /// The folder of the shards; it is created if needed
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,

    /// Replace the shards of the folder once the new ones are complete
    #[arg(long)]
    replace: bool,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: ThreadArgs,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let format_of = |path: &PathBuf| input::scene_format(path, args.format, "--format");
    let formats: Vec<FileFormat> = args.scenes.iter().map(format_of).collect::<Result<_, _>>()?;
    let backend = args.backend.unwrap_or_else(BackendEntry::default_backend);
    let options =
        ShardOptions::default().with_max_bytes(args.max_bytes).with_backend(backend).with_replace(args.replace);
    let session = args.threads.start(streams)?;

    let start = Instant::now();
    let mut files = unfinished();
    let is_new = !args.out.exists();
    let mut writer = ShardWriter::new(&args.out, options).map_err(name_the_option)?;
    let first = args.out.join(shard_file(writer.run(), 0));
    let paths = is_new.then_some(&args.out).into_iter().chain([&first]);
    let listed = paths.map(|path| Listed::new(&mut files, path)).collect();
    drop(files);
    let mut skipped = Vec::new();
    for (path, format) in args.scenes.iter().zip(formats) {
        let found = add(&session, &mut writer, path, format)?;
        skipped.extend(found.into_iter().map(|kind| (input::name(path), kind)));
    }
    let read_time = start.elapsed();

    let start = Instant::now();
    let index = finish(&session, args, writer, listed)?;
    report(streams, args, &index, &skipped, [read_time, start.elapsed()])
}

/// Adds the primitives of a file, and returns the records that were skipped. The file is read in pieces if that is
/// possible, so that it may be larger than memory.
fn add(
    session: &Session<'_>,
    writer: &mut ShardWriter,
    path: &Path,
    format: FileFormat,
) -> anyhow::Result<Vec<Skipped>> {
    if Format::from_path(path).ok().map(FileFormat::Own) == Some(format) && input::is_plain_file(path) {
        let _progress = Progress::start(session.streams, &format!("reading {}", input::name(path)), None, Unit::None);
        return Ok(session.pool.install(|| writer.add_file(path, &PieceOptions::default()))?.skipped);
    }
    let scene = SceneFile::read(session, path, format, false)?.scene;
    writer.add_scene(&scene)?;
    Ok(scene.skipped)
}

/// Builds all shards. Until the last one is written, an interruption removes those that are there. The folder, if it
/// is new, and the first file are listed already.
fn finish(
    session: &Session<'_>,
    args: &Args,
    writer: ShardWriter,
    mut listed: Vec<Listed>,
) -> anyhow::Result<ShardedIndex> {
    let total = writer.primitive_count();
    let bar = Progress::start(session.streams, "building shards", Some(total), Unit::Items("primitives"));
    let (run, mut finished) = (writer.run(), 0);
    let mut progress = |done| {
        bar.advance_to(done);
        if done == total {
            listed.clear();
        } else {
            finished += 1;
            listed.push(Listed::new(&mut unfinished(), &args.out.join(shard_file(run, finished))));
        }
        ControlFlow::Continue(())
    };
    session.pool.install(|| writer.finish_with_progress(&mut progress)).map_err(name_the_option)
}

/// Adds the option that replaces an index to the error that there is one already.
fn name_the_option(error: ShardError) -> anyhow::Error {
    match error {
        ShardError::Exists { .. } => anyhow::anyhow!("{error}: give --replace to replace it"),
        other => other.into(),
    }
}

fn report(
    streams: &Streams,
    args: &Args,
    index: &ShardedIndex,
    skipped: &[(String, Skipped)],
    times: [Duration; 2],
) -> anyhow::Result<()> {
    let manifest = index.manifest();
    let lengths = || manifest.shards.iter().map(|shard| shard.bytes);
    let (count, total, largest) = (manifest.shards.len(), lengths().sum::<u64>(), lengths().max().unwrap_or(0));
    let scenes: Vec<String> = args.scenes.iter().map(|path| input::name(path)).collect();
    if args.json {
        let skip = |(file, kind): &(String, Skipped)| json!({ "file": file, "kind": kind.what, "count": kind.count });
        let report = json!({
            "scenes": scenes,
            "primitives": json::counts(&manifest.counts()),
            "skipped": skipped.iter().map(skip).collect::<Value>(),
            "backend": manifest.backend,
            "shards": { "count": count, "bytes": total, "largest_bytes": largest, "max_bytes": args.max_bytes },
            "seconds": { "read": times[0].as_secs_f64(), "write": times[1].as_secs_f64() },
            "out": { "folder": input::shown(&args.out) },
        });
        return json::print_report(streams, "shard", [report]);
    }
    let mut text: String = scenes.iter().map(|scene| format!("scene    {scene}\n")).collect();
    text += &format!("         {}\n", counted(&manifest.counts()));
    text.extend(skipped.iter().map(|(file, kind)| format!("skipped  {kind} in {file}\n")));
    let (backend, folder) = (&manifest.backend, args.out.display());
    let ([total, largest], [read, write]) = ([total, largest].map(Count), times.map(Time));
    streams.print_summary(format_args!(
        "{text}backend  {backend}\nread     in {read}\nwritten  {folder}, {count} shards, {total} bytes, the largest \
         {largest}, in {write}\n"
    ));
    Ok(())
}
