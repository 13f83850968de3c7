//! `p2m query`: closest points as a table.

use crate::accuracy::Accuracy;
use crate::answering::{BlockSize, answer_each};
use crate::backend::{BackendChoice, PreparedIndex, SceneSource, backend_choices};
use crate::closest_answers::{ClosestAnswer, Source, Task, with_signed};
use crate::input::{self, SceneArgs, point_format, read_points, read_scene_and_index};
use crate::json;
use crate::kdop_directions::requested;
use crate::output::Output;
use crate::p2m_args::P2mArgs;
use crate::query_args::QueryArgs;
use crate::sampling::{Queries, Region};
use crate::shard_query::{self, shard_folder};
use crate::sign_rule::{SignRule, SignedIndex};
use crate::streams::Streams;
use crate::summary::{AnswerSummary, IndexSummary, RunSummary, SceneSummary};
use crate::usage::{bytes, not_negative, one_of, positive, usage, whole_number};
use anyhow::Context;
use clap::ArgGroup;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use nalgebra::Point3;
use p2m_backends::{AnyIndex, QueryRegion, Workload};
use p2m_core::{Aabb, Closest, PrimitiveSet, QueryOptions};
use p2m_mixed::{AnswerColumn, AnswerFormat, Object, PointFormat};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

/// The text of the help. Each paragraph is one line, so that it wraps at the width of the terminal.
fn help() -> String {
    format!(
        "\
The table has the columns qx,qy,qz,x,y,z,distance,primitive,feature: the query, its closest point in the scene, their \
distance, the number of the primitive from 0 and the part of it that holds the point. The last six are empty where \
there is no answer; --columns chooses others, and --signed adds signed_distance. With --k-nearest or --within each answer has \
a row, with the number of its query from 0 in the column number; as NPY and PLY they are kept in memory until all are known. Of a scene with named objects there is one column more, object: the name of the object of the primitive, \
empty if it belongs to none. Numbers are the shortest that read back the same. A summary goes to the standard error.

Primitives are numbered in the order of the file. Polygons are cut into triangles, and it is the triangles that count.

The feature is face, edge0, edge1 or edge2 (edge0 from the first vertex of the primitive to the second, and so on), or \
vertex0, vertex1 or vertex2.

Answers as NPY are an array of NumPy with the fields query, point, distance, lower_bound, barycentric, primitive, \
feature_kind (0 a vertex, 1 an edge, 2 the face) and feature_number; as PLY a cloud of the queries that viewers can colour \
by distance. Where there is no answer, numbers are NaN and -1.

No distance is smaller than the true one but for rounding. With --epsilon or --max-visits it may be larger, by at most what the line `accuracy` of the summary says: every answer has a \
lower bound that is certain (lower_bound in NPY). Of primitives whose distances are equal after rounding, the answer is \
the one that comes first in the file, although another one may be nearer by less than that rounding; --certified answers \
with the one that is exactly the nearest, and of equal ones with the first.

Points from a CSV file are taken from its columns qx, qy, qz, or else x, y, z (also like 'X [m]'), or else Points:0, \
Points:1, Points:2, or else from the first three columns; so the table itself is a file of the same queries. XYZ and TXT \
files have three or more columns separated by blanks. NPY files are arrays of three columns. Of PLY files the vertices are \
read.

{}

The exit code is 0 for success, with or without answers; 1 for what could not be read, written or done; 2 for wrong usage; \
and 130 after Ctrl-C.

Examples:
  p2m query bunny.obj --points scan.xyz --max-distance 0.5 --out answers.csv
  p2m query scene.ply --random 100000 --seed 7 --box-scale 1.5 --backend aabb > answers.csv
  p2m query bunny.obj --points scan.csv.gz --signed --columns query,signed,primitive --out sides.csv
  p2m query scene.obj --points scan.xyz --k-nearest 3 --out three.csv
  p2m query scene.obj --grid 64 --out field.npy --json
  p2m query city.obj --points scan.xyz --epsilon 0.01 --out rough.npy
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
    pub(crate) scene: SceneArgs,

    /// Query the points of this XYZ, TXT, CSV, NPY or PLY file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    pub(crate) points: Option<PathBuf>,

    /// The format of the points, if the extension of their file does not name it
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, conflicts_with_all = ["grid", "random"])]
    points_format: Option<PointFormat>,

    /// Query a grid of N x N x N points that fills the scaled box of the scene, ends included; z runs fastest
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1 << 21), allow_negative_numbers = true)]
    grid: Option<u64>,

    /// Query N uniformly distributed points in the scaled box of the scene
    #[arg(long, value_name = "N", value_parser = whole_number, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor before filling it.
    ///
    /// Along an axis on which the scene is flat, the box is widened to each side by as much as the factor adds to
    /// its longest side.
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "points")]
    box_scale: f64,

    /// Seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, conflicts_with_all = ["points", "grid"])]
    seed: u64,

    /// Give no answers farther than this, in the unit of the scene; at exactly this distance there is one
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,

    /// The index to search [default: aabb, or as a saved index does]
    #[arg(long, value_parser = backend_choices())]
    pub(crate) backend: Option<BackendChoice>,

    #[command(flatten)]
    pub(crate) p2m: P2mArgs,

    /// Answer with the N nearest primitives of each query, nearest first, one row each
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true, conflicts_with_all = ["within", "certified", "epsilon", "max_visits"])]
    k_nearest: Option<u32>,

    /// Answer with all primitives within this distance of each query, nearest first, one row each
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true, conflicts_with_all = ["max_distance", "certified", "epsilon", "max_visits"])]
    within: Option<f64>,

    /// Add a column of distances that are negative inside; needs a scene of triangles [possible values of RULE: auto,
    /// closed, winding].
    ///
    /// An index in shards has only auto: a ray that crosses the surface an odd number of times begins inside. This is
    /// right for a closed surface, and whether it is closed is not checked.
    #[arg(long, value_name = "RULE", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_enum, conflicts_with_all = ["k_nearest", "within"])]
    pub(crate) signed: Option<SignRule>,

    /// The columns of the answers in this order, separated by commas
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', value_parser = columns())]
    columns: Vec<AnswerColumn>,

    /// Keep at most this much of an index in shards in memory, such as 4GB or 500MiB; one shard is kept in any case
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,

    #[command(flatten)]
    pub(crate) query_args: QueryArgs,

    #[command(flatten)]
    pub(crate) accuracy: Accuracy,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    if let Some(folder) = shard_folder(&args.scene.path, args.max_memory)? {
        return shard_query::run(streams, args, &folder);
    }
    let (scene_args, query_args) = (&args.scene, &args.query_args);
    query_args.check(scene_args, args.points.as_deref(), "points")?;
    args.check()?;
    let (format, out_format) = (scene_args.format()?, query_args.format(streams)?);
    let pool = query_args.threads.pool()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &pool, &scene_args.path, format, scene_args.map)?;
    let (queries, sample) = queries(streams, args, &scene.soup.aabb())?;
    let read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = Output::open(streams, Some(&query_args.out))?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let region = sample.as_deref().map_or(QueryRegion::SceneBox, QueryRegion::Like);
    let workload = Workload::new(queries.len(), region);
    let backend = BackendChoice::resolve(args.backend, saved, &scene.soup, &workload, &pool);
    let backend = backend.with_context(|| scene_args.name())?;
    let kdop_directions = requested(backend.has_kdop_directions, query_args.k)?;
    let p2m = args.p2m.settings(backend.has_p2m_settings)?;
    let source = SceneSource { soup: &scene.soup, kdop_directions, p2m, saved };
    let PreparedIndex { built, is_loaded, .. } =
        source.prepare(streams, backend, &pool).with_context(|| scene_args.name())?;
    let index = &*built.index;
    let build_time = start.elapsed();

    let signed = args.signed.map(|rule| rule.prepare(streams, index, &scene.soup)).transpose();
    let signed = signed.with_context(|| scene_args.name())?.map(|(signed, _)| signed);
    let source = WholeIndex { index, signed: signed.as_ref(), args };
    let objects = &scene.objects;
    let task = Task { streams, args, pool: &pool, queries, output: &mut output, format: out_format, objects };
    let (summary, query_time) = task.run(&source)?;
    let bytes = output.bytes();
    output.finish()?;

    let (backend, threads) = (backend.name, pool.current_num_threads());
    let scene = SceneSummary::new(scene_args.name(), format, &scene);
    let index = IndexSummary { scene, backend, built: Some(&built), is_loaded, read_time, build_time };
    let run = RunSummary { index, threads, query_time };
    if query_args.json {
        let report = args.report(&summary, &run.index.cells());
        return json::print(streams, &run.json("query", report, &query_args.output_json(out_format, bytes)));
    }
    streams.print_summary(format_args!("{}{summary}", run.text("queries", "query", summary.queries())));
    Ok(())
}

/// An index over the whole scene, with signs if they are asked for.
struct WholeIndex<'a> {
    index: &'a dyn AnyIndex,
    signed: Option<&'a SignedIndex<'a>>,
    args: &'a Args,
}

impl Source for WholeIndex<'_> {
    const BLOCK_SIZE: BlockSize = BlockSize::Adaptive;

    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>> {
        let answers = self.args.accuracy.answer(self.index, queries, &self.args.options());
        let with_sign = |(query, answer): (&Point3<f64>, Option<Closest<f64>>)| {
            let signed =
                self.signed.zip(answer).and_then(|(signed, answer)| signed.with_sign(query, answer).distance());
            (answer, signed.unwrap_or(f64::NAN))
        };
        Ok(queries.par_iter().zip(answers).map(with_sign).collect())
    }

    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        let near = |query: &_| match self.args.near() {
            (None, radius) => self.index.all_within(query, radius),
            (Some(k), radius) => self.index.k_nearest(query, k, radius),
        };
        Ok(answer_each(queries, near))
    }
}

/// Returns a parser of the names of columns.
fn columns() -> impl TypedValueParser<Value = AnswerColumn> {
    let find = |name: String| AnswerColumn::ALL.into_iter().find(|column| column.name() == name);
    PossibleValuesParser::new(AnswerColumn::ALL.map(AnswerColumn::name))
        .map(move |name| find(name).expect("the parser accepts the names of columns alone"))
}

impl Args {
    /// Returns whether a query may have more than one answer.
    pub(crate) fn has_many_answers(&self) -> bool {
        self.k_nearest.is_some() || self.within.is_some()
    }

    /// Returns how many primitives to answer with at most, if that is limited, and the largest distance of them.
    pub(crate) fn near(&self) -> (Option<usize>, f64) {
        let largest = self.max_distance.unwrap_or(f64::INFINITY);
        match self.within {
            Some(radius) => (None, radius),
            None => (Some(self.k_nearest.map_or(1, |k| k as usize)), largest),
        }
    }

    /// Returns the options of queries with one answer.
    pub(crate) fn options(&self) -> QueryOptions<f64> {
        self.accuracy.options(self.max_distance)
    }

    /// Returns the part of a report about the queries and their answers.
    pub(crate) fn report(&self, summary: &AnswerSummary, cells: &Value) -> Value {
        let max_distance = self.max_distance.map_or(Value::Null, json::number);
        summary.json(cells, &max_distance, &self.accuracy.json(), &source_json(self))
    }

    /// Returns the columns that the arguments name, or else those of the format, with the numbers of queries if these
    /// may have many answers.
    pub(crate) fn columns(&self, format: AnswerFormat, objects: &[Object]) -> Vec<AnswerColumn> {
        if !self.columns.is_empty() {
            return self.columns.clone();
        }
        let mut columns = AnswerColumn::defaults(format, !objects.is_empty());
        if self.has_many_answers() {
            columns.insert(0, AnswerColumn::Number);
        }
        with_signed(columns, self.signed.is_some())
    }

    /// Refuses combinations of arguments that contradict each other.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        if self.columns.contains(&AnswerColumn::Signed) && self.signed.is_none() {
            return Err(usage("the column signed needs --signed"));
        }
        match (1..self.columns.len()).find(|i| self.columns[..*i].contains(&self.columns[*i])) {
            Some(twice) => Err(usage(format!("the column {} is named twice", self.columns[twice].name()))),
            None => Ok(()),
        }
    }
}

/// Returns the queries and, if they come from a file, a sample of them.
pub(crate) fn queries(
    streams: &Streams,
    args: &Args,
    bounds: &Aabb<f64>,
) -> anyhow::Result<(Queries, Option<Vec<Point3<f64>>>)> {
    if let Some(path) = &args.points {
        let points = read_points(streams, path, point_format(path, args.points_format, "--points-format")?)?;
        let sample = points.iter().step_by(points.len().div_ceil(MAX_SAMPLE_POINTS).max(1)).copied().collect();
        return Ok((Queries::list(points), Some(sample)));
    }
    let region = Region::around(bounds, args.box_scale);
    let queries = match args.grid {
        Some(side) => Queries::grid(region, side),
        None => Queries::random(region, args.random.unwrap_or(0), args.seed),
    };
    Ok((queries, None))
}

/// The largest number of points by which the advisor chooses a backend.
const MAX_SAMPLE_POINTS: usize = 16_384;

/// Returns the part of a report about the origin of the queries.
fn source_json(args: &Args) -> Value {
    match (&args.points, args.grid) {
        (Some(path), _) => json!({ "points": input::name(path) }),
        (_, Some(side)) => json!({ "grid": side, "box_scale": args.box_scale }),
        _ => json!({ "random": args.random, "seed": args.seed, "box_scale": args.box_scale }),
    }
}
