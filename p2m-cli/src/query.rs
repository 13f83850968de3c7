//! `p2m query`: closest points as a table.

use crate::asking::{Asking, Questions, ask};
use crate::backend::{About, Search};
use crate::faces::Faces;
use crate::input::{self, SceneArgs, point_format, read_points, read_scene};
use crate::json;
use crate::output::Output;
use crate::progress::{Progress, Unit};
use crate::sampling::{Queries, Region};
use crate::summary::{Answers, Run};
use crate::usage::{not_negative, one_of, positive, whole};
use anyhow::Context;
use clap::builder::PossibleValue;
use clap::{ArgGroup, ValueEnum};
use p2m_core::{BuildError, ClosestPoint, QueryOptions, Soup};
use p2m_interception::{InterceptionIndex, Octree, Partition, Voronoi};
use p2m_mixed::{AnswerWriter, PointFormat, Scene};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;
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
    #[command(flatten)]
    scene: SceneArgs,

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

    /// Give no answers farther than this, in the unit of the scene; at exactly this distance there is one
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    max_distance: Option<f64>,

    /// How to search
    #[arg(long, value_enum, default_value_t = Backend::Search(Search::Aabb))]
    backend: Backend,

    #[command(flatten)]
    asking: Asking,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Backend {
    Search(Search),
    Octree,
    P2m,
}

impl ValueEnum for Backend {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: &[Backend] = &[
            Backend::Search(Search::Brute),
            Backend::Search(Search::Aabb),
            Backend::Search(Search::Kdop),
            Backend::Octree,
            Backend::P2m,
        ];
        ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let octree =
            "Cells in space with lists of what can be nearest there: no search, for more memory and a longer build";
        let p2m = "Cells of the vertices with lists of what can be nearest there: fastest far from the scene";
        match self {
            Self::Search(search) => search.to_possible_value(),
            Self::Octree => Some(PossibleValue::new(self.name()).help(octree)),
            Self::P2m => Some(PossibleValue::new(self.name()).help(p2m)),
        }
    }
}

impl Backend {
    fn name(self) -> &'static str {
        match self {
            Self::Search(search) => search.name(),
            Self::Octree => "octree",
            Self::P2m => "p2m",
        }
    }

    /// The index, and what there is to say about it.
    fn build(self, soup: &Soup<f64>, faces: Faces) -> Result<(Closest<'_>, About), BuildError> {
        match self {
            Self::Search(search) => search.build(soup, faces).map(|(index, about)| (index as Closest<'_>, about)),
            Self::Octree => interception::<Octree>(soup, About::Cubes),
            Self::P2m => interception::<Voronoi>(soup, About::Cells),
        }
    }
}

type Closest<'a> = Box<dyn ClosestPoint<f64> + Sync + 'a>;

/// An interception index, which takes a while to build.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
fn interception<P: Partition + Sync + 'static>(
    soup: &Soup<f64>,
    about: fn(P::Report) -> About,
) -> Result<(Closest<'_>, About), BuildError> {
    let progress = Progress::start("finding cells", Some(100), Unit::Percent);
    let reach = |part: f64| progress.reach((part * 100.0) as u64);
    let index = InterceptionIndex::<_, _, P>::build_with_progress(soup, &Default::default(), &reach)?;
    let report = index.report();
    Ok((Box::new(index), about(report)))
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let (scene_args, asking) = (&args.scene, &args.asking);
    let is_kdop = args.backend == Backend::Search(Search::Kdop);
    asking.check(scene_args, args.points.as_deref(), "points", is_kdop)?;
    let (format, out_format) = (scene_args.format()?, asking.format()?);
    let start = Instant::now();
    let scene = read_scene(&scene_args.path, format)?;
    let queries = queries(args, &scene)?;
    let read = start.elapsed();
    // Before any work, so that it is not lost to a wrong name.
    let mut output = Output::open(Some(&asking.out))?;

    let start = Instant::now();
    // Interception indexes tell more by themselves.
    let is_search = matches!(args.backend, Backend::Search(_));
    let progress = is_search.then(|| Progress::start("building the index", None, Unit::None));
    let built = args.backend.build(&scene.soup, asking.faces());
    let (index, about) = built.with_context(|| scene_args.name())?;
    drop(progress);
    let build = start.elapsed();

    let pool = asking.pool()?;
    let mut options = QueryOptions::default();
    if let Some(max_distance) = args.max_distance {
        options = options.with_max_distance(max_distance);
    }
    let mut answers = Answers::default();
    let write = || -> io::Result<Duration> {
        let mut writer = AnswerWriter::new(&mut output, out_format, queries.len())?;
        let questions = Questions { name: "queries", count: queries.len(), iter: queries };
        let answer = |queries: &[_], answers: &mut [_]| index.closest_points_into(queries, &options, answers);
        let time = ask(&pool, questions, answer, |query, answer| {
            answers.add(answer.as_ref());
            writer.write(query, answer.as_ref())
        })?;
        writer.finish()?;
        Ok(time)
    };
    let asked = write().with_context(|| output.cannot_write())?;
    let bytes = output.bytes();
    output.finish()?;

    let (scene_name, backend, threads) = (scene_args.name(), args.backend.name(), pool.current_num_threads());
    let run = Run { scene_name, scene: &scene, format, backend, about, threads, read, build, asked };
    if asking.json {
        let max_distance = args.max_distance.map_or(Value::Null, json::number);
        let report = answers.json(&run.cells(), &max_distance, &asked_about(args));
        return json::print(&run.json("query", report, &asking.written(out_format, bytes)));
    }
    // The answers are complete; whether anybody reads this is not our concern.
    let _ = write!(io::stderr(), "{}{answers}", run.text("queries", "query", answers.queries()));
    Ok(())
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
