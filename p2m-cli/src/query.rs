//! `p2m query`: closest points as a table.

use crate::output::Output;
use crate::sampling::{Queries, Region};
use crate::summary::{Answers, Summary};
use anyhow::{Context, anyhow};
use clap::{ArgGroup, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, BuildIndex, Closest, ClosestPoint, QueryOptions, Soup};
use p2m_mixed::{Scene, read_points, read_scene};
use rayon::prelude::*;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Each paragraph is one line, so that it wraps at the width of the terminal.
const EXAMPLES: &str = "\
The table has the columns qx,qy,qz,x,y,z,distance,primitive,feature: the query, its closest point in the scene, their \
distance, the number of the primitive from 0 and the part of it that holds the point. The last six are empty where \
there is no answer. Numbers are the shortest that read back the same. A summary goes to the standard error.

Primitives are numbered in the order of the file. Polygons are cut into triangles, and it is the triangles that count.

The feature is face, edge0, edge1 or edge2 (edge0 from the first vertex of the primitive to the second, and so on), or \
vertex0, vertex1 or vertex2.

Points from a CSV file are taken from its columns qx, qy, qz, or else x, y, z (also like 'X [m]'), or else Points:0, \
Points:1, Points:2, or else from the first three columns; so the table itself can be asked about again. XYZ and TXT \
files have three or more columns separated by blanks.

The exit code is 0 for success, with or without answers; 1 for what could not be read, written or done; and 2 for \
wrong usage.

Examples:
  p2m query bunny.obj --points scan.xyz --max-distance 0.5 --out answers.csv
  p2m query scene.ply --random 100000 --seed 7 --box-scale 1.5 --backend aabb > answers.csv
  p2m query scene.obj --grid 64 --out field.csv";

/// Find the closest points of a scene to given, regularly spaced or random points
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
#[command(group = ArgGroup::new("queries").required(true).args(["points", "grid", "random"]))]
pub(crate) struct Args {
    /// Scene: an OBJ or PLY file
    scene: PathBuf,

    /// Ask about the points of this XYZ, TXT or CSV file
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,

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

    /// Give no answers farther than this, in the unit of the scene; at exactly this distance there is one
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    max_distance: Option<f64>,

    /// Where to write the table; `-` is the standard output.
    ///
    /// The file appears under this name when it is complete; a killed run may leave a file `.p2m-*` beside it. A link is
    /// followed, one to nothing is refused, and so is the name of an input.
    #[arg(long, value_name = "FILE", default_value = "-")]
    out: PathBuf,

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
}

impl Backend {
    fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
        }
    }

    fn build(self, soup: &Soup<f64>) -> Result<Box<dyn ClosestPoint<f64> + Sync + '_>, p2m_core::BuildError> {
        Ok(match self {
            Self::Brute => Box::new(BruteForce::build(soup, &())?),
            Self::Aabb => Box::new(AabbTree::build(soup, &Default::default())?),
        })
    }
}

fn whole(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("not a whole number from 0 to {}", u64::MAX))
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("not a positive number".to_owned()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x >= 0.0 => Ok(x),
        _ => Err("not a number from 0 up".to_owned()),
    }
}

/// Queries that are asked before their answers are written: enough to keep all threads busy, few enough to hold.
const CHUNK: usize = 1 << 14;
/// Queries that one thread takes at a time. A brute-force query of a large scene takes milliseconds.
const SHARE: usize = 32;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let inputs: Vec<&Path> = std::iter::once(&args.scene).chain(&args.points).map(PathBuf::as_path).collect();
    Output::refuse_inputs(&args.out, &inputs)?;
    let scene = read_scene(&args.scene)?;
    let queries = queries(args, &scene)?;
    // Before any work, so that it is not lost to a wrong name.
    let mut output = Output::open(Some(&args.out))?;

    let start = Instant::now();
    let index = args.backend.build(&scene.soup).with_context(|| args.scene.display().to_string())?;
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
    let (query, answers) = answer(&*index, &options, queries, &pool, &mut output)?;
    output.finish()?;

    let summary = Summary {
        scene_name: args.scene.display().to_string(),
        scene: &scene,
        backend: args.backend.name(),
        threads: pool.current_num_threads(),
        build,
        query,
        answers,
    };
    // The table is complete; whether anybody reads this is not our concern.
    let _ = write!(io::stderr(), "{summary}");
    Ok(())
}

fn queries(args: &Args, scene: &Scene) -> anyhow::Result<Queries> {
    if let Some(path) = &args.points {
        return Ok(Queries::list(read_points(path)?));
    }
    let region = Region::around(&scene.soup, args.box_scale);
    Ok(match args.grid {
        Some(side) => Queries::grid(region, side),
        None => Queries::random(region, args.random.unwrap_or(0), args.seed),
    })
}

/// Asks chunk by chunk and writes the table; how long the asking took, and what came of it.
fn answer(
    index: &(dyn ClosestPoint<f64> + Sync),
    options: &QueryOptions<f64>,
    mut queries: Queries,
    pool: &rayon::ThreadPool,
    output: &mut Output,
) -> anyhow::Result<(Duration, Answers)> {
    let progress = Progress::new(queries.len());
    let mut statistics = Answers::none();
    let mut time = Duration::ZERO;
    let mut chunk = Vec::new();
    let mut answers = Vec::new();
    writeln!(output, "qx,qy,qz,x,y,z,distance,primitive,feature").with_context(|| output.cannot_write())?;
    while queries.len() > 0 {
        queries.fill(CHUNK, &mut chunk);
        answers.clear();
        answers.resize(chunk.len(), None);
        let start = Instant::now();
        pool.install(|| {
            chunk.par_chunks(SHARE).zip(answers.par_chunks_mut(SHARE)).for_each(|(queries, answers)| {
                index.closest_points_into(queries, options, answers);
                progress.add(queries.len());
            });
        });
        time += start.elapsed();
        for (query, answer) in chunk.iter().zip(&answers) {
            statistics.add(answer.as_ref());
            row(output, query, answer.as_ref()).with_context(|| output.cannot_write())?;
        }
    }
    progress.bar.finish_and_clear();
    Ok((time, statistics))
}

/// `{:?}` writes the shortest number that reads back the same, with an exponent where it is far from 1.
fn row(output: &mut Output, query: &Point3<f64>, answer: Option<&Closest<f64>>) -> io::Result<()> {
    write!(output, "{:?},{:?},{:?},", query.x, query.y, query.z)?;
    match answer {
        None => writeln!(output, ",,,,,"),
        Some(Closest { point, distance, primitive, feature, .. }) => {
            writeln!(output, "{:?},{:?},{:?},{distance:?},{primitive},{feature}", point.x, point.y, point.z)
        }
    }
}

/// A bar on the standard error, if that is a terminal and the work takes long.
struct Progress {
    bar: ProgressBar,
    done: AtomicU64,
    start: Instant,
}

const PATIENCE: Duration = Duration::from_secs(1);

impl Progress {
    fn new(len: u64) -> Self {
        // Hidden by itself where the standard error is no terminal; it draws nothing before it is told its position.
        let bar = ProgressBar::with_draw_target(Some(len), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {human_pos}/{human_len} queries, {eta} left") {
            bar.set_style(style);
        }
        Self { bar, done: AtomicU64::new(0), start: Instant::now() }
    }

    fn add(&self, count: usize) {
        let done = self.done.fetch_add(count as u64, Ordering::Relaxed) + count as u64;
        if self.start.elapsed() > PATIENCE {
            self.bar.set_position(done);
        }
    }
}
