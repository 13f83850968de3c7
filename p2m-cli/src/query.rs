//! `p2m query`: closest points as a table.

use crate::faces::{Faces, WithTree};
use crate::input::{self, is_standard, or_option, point_format, read_points, read_scene, scene_format};
use crate::json;
use crate::output::Output;
use crate::progress::{Progress, Unit};
use crate::sampling::{Queries, Region};
use crate::summary::{About, Answers, Summary};
use crate::usage::{not_negative, one_of, positive, usage, whole};
use anyhow::{Context, anyhow};
use clap::{ArgGroup, ValueEnum};
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, QueryOptions, Soup};
use p2m_interception::OctreeIndex;
use p2m_kdop::KdopTree;
use p2m_mixed::{AnswerFormat, AnswerWriter, Format, PointFormat, Scene};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Each paragraph is one line, so that it wraps at the width of the terminal.
fn help() -> String {
    format!(
        "\
The table has the columns qx,qy,qz,x,y,z,distance,primitive,feature: the query, its closest point in the scene, their \
distance, the number of the primitive from 0 and the part of it that holds the point. The last six are empty where \
there is no answer. Numbers are the shortest that read back the same. A summary goes to the standard error.

Primitives are numbered in the order of the file. Polygons are cut into triangles, and it is the triangles that count.

The feature is face, edge0, edge1 or edge2 (edge0 from the first vertex of the primitive to the second, and so on), or \
vertex0, vertex1 or vertex2.

Answers as NPY are an array of NumPy with the fields query, point, distance, lower_bound, barycentric, primitive, \
feature_kind (0 a vertex, 1 an edge, 2 the face) and feature_number; as PLY a cloud of the queries that viewers can colour \
by distance. Where there is no answer, numbers are NaN and -1.

Points from a CSV file are taken from its columns qx, qy, qz, or else x, y, z (also like 'X [m]'), or else Points:0, \
Points:1, Points:2, or else from the first three columns; so the table itself can be asked about again. XYZ and TXT \
files have three or more columns separated by blanks. NPY files are arrays of three columns. Of PLY files the vertices are \
asked about.

{}

The exit code is 0 for success, with or without answers; 1 for what could not be read, written or done; 2 for wrong usage; \
and 130 after Ctrl-C.

Examples:
  p2m query bunny.obj --points scan.xyz --max-distance 0.5 --out answers.csv
  p2m query scene.ply --random 100000 --seed 7 --box-scale 1.5 --backend aabb > answers.csv
  p2m query scene.obj --grid 64 --out field.npy --json
  p2m query turned.stl --random 100000 --backend kdop --k scene --out answers.csv
  p2m generate torus-knot | p2m query - --format obj --random 1000 --out distances.ply",
        json::STABILITY
    )
}

/// Find the closest points of a scene to given, regularly spaced or random points
#[derive(clap::Args)]
#[command(after_help = help())]
#[command(group = ArgGroup::new("queries").required(true).args(["points", "grid", "random"]))]
pub(crate) struct Args {
    /// Scene: an OBJ, PLY, STL or OFF file; `-` is the standard input
    scene: PathBuf,

    /// The format of the scene, if the extension of its name does not tell
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    format: Option<Format>,

    /// Ask about the points of this XYZ, TXT, CSV, NPY or PLY file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,

    /// The format of the points, if the extension of their file does not tell
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, conflicts_with_all = ["grid", "random"])]
    points_format: Option<PointFormat>,

    /// Ask about a grid of N x N x N points that fills the scaled box of the scene, ends included; z runs fastest
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1 << 21), allow_negative_numbers = true)]
    grid: Option<u64>,

    /// Ask about N uniformly distributed points in the scaled box of the scene
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor before filling it.
    ///
    /// Along an axis on which the scene is flat, the box is widened to each side by as much as the factor adds to its
    /// longest side.
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "points")]
    box_scale: f64,

    /// Seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole, allow_negative_numbers = true, conflicts_with_all = ["points", "grid"])]
    seed: u64,

    /// How to search
    #[arg(long, value_enum, default_value_t = Backend::Aabb)]
    backend: Backend,

    /// How many faces the polytopes of --backend kdop have [default: 14]
    #[arg(long, value_name = "K", value_enum, ignore_case = true, allow_negative_numbers = true)]
    k: Option<Faces>,

    /// Give no answers farther than this, in the unit of the scene; at exactly this distance there is one
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    max_distance: Option<f64>,

    /// Where to write the answers; `-` is the standard output.
    ///
    /// The file appears under this name when it is complete, and does not if the run is interrupted (one that is ended
    /// by SIGKILL leaves a file `.p2m-*` beside it). A link is followed, one to nothing is refused, and so is the
    /// name of an input.
    #[arg(long, value_name = "FILE", default_value = "-")]
    out: PathBuf,

    /// The format of the answers, if the extension of their file does not tell; CSV is the default
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<AnswerFormat>(AnswerFormat::NAMES), ignore_case = true)]
    out_format: Option<AnswerFormat>,

    /// Report the summary as one JSON object on the standard output; needs --out FILE
    #[arg(long)]
    json: bool,

    /// How many threads to use, up to 1024; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Backend {
    /// Every primitive, every time
    Brute,
    /// A tree of boxes
    Aabb,
    /// Cells in space with lists of what can be nearest there: no search, for more memory and a longer build
    Octree,
    /// A tree of polytopes with --k faces, which fit closer what does not lie along the axes
    Kdop,
}

impl Backend {
    fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
            Self::Octree => "octree",
            Self::Kdop => "kdop",
        }
    }

    /// The index, and what there is to say about it.
    fn build(self, soup: &Soup<f64>, faces: Faces) -> Result<(Index<'_>, About), p2m_core::BuildError> {
        Ok(match self {
            Self::Brute => (Box::new(BruteForce::build(soup, &())?), About::Nothing),
            Self::Aabb => (Box::new(AabbTree::build(soup, &Default::default())?), About::Nothing),
            Self::Octree => octree(soup)?,
            Self::Kdop => {
                let (index, used) = faces.build(soup, AnyTree)?;
                (index, About::Faces(used))
            }
        })
    }
}

/// The octree, which takes a while to build.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
fn octree(soup: &Soup<f64>) -> Result<(Index<'_>, About), p2m_core::BuildError> {
    let progress = Progress::start("finding cells", Some(100), Unit::Percent);
    let reach = |part: f64| progress.reach((part * 100.0) as u64);
    let index = OctreeIndex::build_with_progress(soup, &Default::default(), &reach)?;
    let report = index.report();
    Ok((Box::new(index), About::Cells(report)))
}

/// A k-DOP tree as an index.
struct AnyTree;

impl<'a> WithTree<'a> for AnyTree {
    type Output = Index<'a>;
    fn with<const K: usize>(self, tree: KdopTree<f64, &'a Soup<f64>, K>) -> Index<'a> {
        Box::new(tree)
    }
}

type Index<'a> = Box<dyn ClosestPoint<f64> + Sync + 'a>;

/// Queries that are asked before their answers are written: enough to keep all threads busy, few enough to hold.
const CHUNK: usize = 1 << 14;
/// Queries that one thread takes at a time. A brute-force query of a large scene takes milliseconds.
const SHARE: usize = 32;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.json && is_standard(&args.out) {
        return Err(usage(
            "--json reports on the standard output, so the answers have to go to a file: add --out FILE",
        ));
    }
    if is_standard(&args.scene) && args.points.as_deref().is_some_and(is_standard) {
        return Err(usage("the standard input cannot be both the scene and the points"));
    }
    if args.k.is_some() && args.backend != Backend::Kdop {
        return Err(usage("--k is for --backend kdop"));
    }
    let inputs: Vec<&Path> = std::iter::once(&args.scene).chain(&args.points).map(PathBuf::as_path).collect();
    Output::refuse_inputs(&args.out, &inputs)?;
    let format = scene_format(&args.scene, args.format, "--format")?;
    let out_format = answer_format(args)?;
    let start = Instant::now();
    let scene = read_scene(&args.scene, format)?;
    let queries = queries(args, &scene)?;
    let read = start.elapsed();
    // Before any work, so that it is not lost to a wrong name.
    let mut output = Output::open(Some(&args.out))?;

    let name = input::name(&args.scene);
    let start = Instant::now();
    // The octree tells more by itself.
    let progress = (args.backend != Backend::Octree).then(|| Progress::start("building the index", None, Unit::None));
    let (index, about) =
        args.backend.build(&scene.soup, args.k.unwrap_or(Faces::Fourteen)).with_context(|| name.clone())?;
    drop(progress);
    let build = start.elapsed();

    let threads = args.threads.map_or(0, usize::from); // 0 is all of them
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| anyhow!("cannot start threads: {e}"))?; // as text: its source says the same again
    let mut options = QueryOptions::default();
    if let Some(max_distance) = args.max_distance {
        options = options.with_max_distance(max_distance);
    }
    let asked = ask(&*index, &options, queries, &pool, &mut output, out_format);
    let (query, answers) = asked.with_context(|| output.cannot_write())?;
    let bytes = output.bytes();
    output.finish()?;

    let backend = args.backend.name();
    let threads = pool.current_num_threads();
    let scene_name = name;
    let summary = Summary { scene_name, scene: &scene, format, backend, about, threads, read, build, query, answers };
    if args.json {
        let out = json!({ "file": args.out.display().to_string(), "format": out_format.name(), "bytes": bytes });
        return json::print(&summary.json(&asked_about(args), args.max_distance, &out));
    }
    // The answers are complete; whether anybody reads this is not our concern.
    let _ = write!(io::stderr(), "{summary}");
    Ok(())
}

/// The given format, or that of the extension; CSV for names that have none.
fn answer_format(args: &Args) -> anyhow::Result<AnswerFormat> {
    let format = match args.out_format {
        Some(format) => format,
        None if is_standard(&args.out) || args.out.extension().is_none() => AnswerFormat::Csv,
        None => AnswerFormat::from_path(&args.out).map_err(|e| or_option(&e, "--out-format"))?,
    };
    if format != AnswerFormat::Csv {
        Output::refuse_terminal(&args.out, format.name())?;
    }
    Ok(format)
}

fn queries(args: &Args, scene: &Scene) -> anyhow::Result<Queries> {
    if let Some(path) = &args.points {
        return Ok(Queries::list(read_points(path, point_format(path, args.points_format, "--points-format")?)?));
    }
    let region = Region::around(&scene.soup, args.box_scale);
    Ok(match args.grid {
        Some(side) => Queries::grid(region, side),
        None => Queries::random(region, args.random.unwrap_or(0), args.seed),
    })
}

/// Which points were asked about, for the report.
fn asked_about(args: &Args) -> Value {
    match (&args.points, args.grid) {
        (Some(path), _) => json!({ "points": input::name(path) }),
        (_, Some(side)) => json!({ "grid": side, "box_scale": args.box_scale }),
        _ => json!({ "random": args.random, "seed": args.seed, "box_scale": args.box_scale }),
    }
}

/// Asks chunk by chunk and writes the answers; how long the asking took, and what came of it.
fn ask(
    index: &(dyn ClosestPoint<f64> + Sync),
    options: &QueryOptions<f64>,
    mut queries: Queries,
    pool: &rayon::ThreadPool,
    output: &mut Output,
    format: AnswerFormat,
) -> io::Result<(Duration, Answers)> {
    let progress = Progress::start("asking", Some(queries.len()), Unit::Queries);
    let mut statistics = Answers::none();
    let mut time = Duration::ZERO;
    let mut chunk = Vec::new();
    let mut answers = Vec::new();
    let mut writer = AnswerWriter::new(output, format, queries.len())?;
    while queries.len() > 0 {
        queries.fill(CHUNK, &mut chunk);
        answers.clear();
        answers.resize(chunk.len(), None);
        let start = Instant::now();
        pool.install(|| {
            chunk.par_chunks(SHARE).zip(answers.par_chunks_mut(SHARE)).for_each(|(queries, answers)| {
                index.closest_points_into(queries, options, answers);
                progress.add(queries.len() as u64);
            });
        });
        time += start.elapsed();
        for (query, answer) in chunk.iter().zip(&answers) {
            statistics.add(answer.as_ref());
            writer.write(query, answer.as_ref())?;
        }
    }
    writer.finish()?;
    Ok((time, statistics))
}
