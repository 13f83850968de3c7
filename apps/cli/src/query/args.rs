//! The arguments of `p2m query`, and the queries that they ask for.

use crate::answers::queries::BOX_SCALE;
use crate::answers::{AnswerColumn, AnswerFormat, AnswerSummary, Queries, QueryArgs, Region};
use crate::index::{BackendChoice, P2mArgs, SignRule, backend_choices};
use crate::io::usage::{bytes, count, not_negative, positive, usage, whole_number};
use crate::io::{PointArgs, SceneArgs, Streams, input, json};
use crate::query::accuracy::Accuracy;
use clap::ArgGroup;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use nalgebra::Point3;
use p2m_core::{Aabb, QueryOptions};
use p2m_mixed::{Object, PointIds, PointTable};
use serde_json::{Value, json};

const HELP: &str = "\
The table has the columns qx,qy,qz,x,y,z,distance,primitive,feature: the query, the closest point, the distance, the \
number of the primitive, and the feature that has the point. Without an answer the columns from x to feature are \
empty. --signed adds signed_distance. With --k-nearest or --within each answer has a row, and the column number has \
the number of its query; NPY and PLY files of such answers are kept in memory until all are known. A scene with \
named objects has the column object. Numbers are the shortest that read back the same. The summary goes to the \
standard error.

Primitives are numbered from 0, in the order of the file. Polygons are cut into triangles, which are numbered instead.

The feature is face, edge0 to edge2 (edge0 runs from the first vertex of the primitive to the second), or vertex0 to \
vertex2.

NPY files have an array with the fields query, point, distance, lower_bound, barycentric, primitive, feature_kind (0 \
vertex, 1 edge, 2 face) and feature_number. PLY files have a cloud of the queries, coloured by distance in viewers. \
Where there is no answer, numbers are NaN and -1.

Apart from rounding, a distance is never too small. With --epsilon or --max-visits it may be too large, by at most \
what the line `accuracy` of the summary says; the column lower_bound has a certified lower bound. If several \
primitives have the same rounded distance, the first one of the file is the answer, even if another one is nearer by \
less than the rounding. --certified finds the true nearest primitive, and the first of equally near ones.

Text tables of points need the columns qx, qy, qz, or x, y, z (also like 'X [m]'), or easting, northing, height, or \
Points:0 to Points:2; otherwise the first three columns are used. So the table of answers is itself a file of \
queries. --points-columns chooses other columns. Without a third one z is 0. A column id, or that of --points-id, is \
the first column of the answers. NPY files have arrays of three or two columns. Other files give their vertices.

Examples:
  p2m query bunny.obj --points scan.xyz --max-distance 0.5 --out answers.csv
  p2m query scene.ply --random 100000 --seed 7 --box-scale 1.5 --backend aabb > answers.csv
  p2m query bunny.obj --points scan.csv.gz --signed --columns query,signed,primitive --out sides.csv
  p2m query map.geojson --points stations.csv --points-columns E,N --points-id nr --out nearest.csv
  p2m query bunny.obj --random 1000000 --signed --columns query,inside --out occupancy.npy
  p2m query scene.obj --points scan.xyz --k-nearest 3 --out three.csv
  p2m query scene.obj --grid 64 --out field.npy --json
  p2m query city.obj --points scan.xyz --epsilon 0.01 --out rough.npy
  p2m query turned.stl --random 100000 --backend kdop --k scene --out answers.csv
  p2m generate torus-knot | p2m query - --format obj --random 1000 --out distances.ply";

/// Find the points of a scene that are closest to query points
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("queries").required(true).args(["points", "grid", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Query N x N x N points, evenly spaced in the box of the scene; z runs fastest
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1 << 21), allow_negative_numbers = true)]
    grid: Option<u64>,

    /// Query N random points in the box of the scene
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor
    ///
    /// The box of a flat scene also grows along its thin axis, by as much as along its longest one.
    #[arg(long, value_name = "S", default_value_t = BOX_SCALE, value_parser = positive, allow_negative_numbers = true, conflicts_with = "points")]
    box_scale: f64,

    /// The seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, conflicts_with_all = ["points", "grid"])]
    seed: u64,

    /// Find nothing farther than R, in the unit of the scene
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,

    /// The index to search [default: the saved index, or auto]
    #[arg(long, value_parser = backend_choices())]
    pub(crate) backend: Option<BackendChoice>,

    /// Search on this device instead of the processor, with the tree aabb
    #[cfg(feature = "cuda")]
    #[arg(long, value_enum, conflicts_with_all = ["backend", "k_nearest", "within", "signed", "certified", "epsilon", "max_visits", "k", "P2mArgs"])]
    pub(crate) device: Option<Device>,

    #[command(flatten)]
    pub(crate) p2m: P2mArgs,

    /// Find the N nearest primitives: a row for each, nearest first
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true, conflicts_with_all = ["within", "certified", "epsilon", "max_visits"])]
    k_nearest: Option<u32>,

    /// Find all primitives within R: a row for each, nearest first
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true, conflicts_with_all = ["max_distance", "certified", "epsilon", "max_visits"])]
    within: Option<f64>,

    /// Add signed distances, negative inside; the scene must have triangles only
    ///
    /// RULE decides which points are inside. An index in shards needs a closed surface and the rule auto.
    #[arg(long, value_name = "RULE", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_enum, conflicts_with_all = ["k_nearest", "within"])]
    pub(crate) signed: Option<SignRule>,

    /// The columns of the table, separated by commas
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', value_parser = columns())]
    columns: Vec<AnswerColumn>,

    /// Keep at most this much of an index in memory, such as 4GB: in shards, or as auto chooses it
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,

    #[command(flatten)]
    pub(crate) query_args: QueryArgs,

    #[command(flatten)]
    pub(crate) accuracy: Accuracy,
}

/// A value of `--device`.
#[cfg(feature = "cuda")]
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Device {
    /// An NVIDIA card
    Cuda,
}

/// Returns a parser of the names of columns.
fn columns() -> impl TypedValueParser<Value = AnswerColumn> {
    let find = |name: String| AnswerColumn::all().find(|column| column.name() == name);
    PossibleValuesParser::new(AnswerColumn::all().map(AnswerColumn::name))
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
        let queries = json!({
            "cells": cells,
            "max_distance": self.max_distance.map(json::number),
            "accuracy": self.accuracy,
            "source": source_json(self),
        });
        json::joined([queries, summary.json()])
    }

    /// Returns the columns that the arguments name, or else those of the format, with the numbers of queries if these
    /// may have many answers, and with their ids in a text table if they have them.
    pub(crate) fn columns(&self, format: AnswerFormat, objects: &[Object], has_ids: bool) -> Vec<AnswerColumn> {
        if !self.columns.is_empty() {
            return self.columns.clone();
        }
        let mut columns = AnswerColumn::defaults(format, !objects.is_empty(), self.signed.is_some());
        if self.has_many_answers() {
            columns.insert(0, AnswerColumn::Number);
        }
        if has_ids && format == AnswerFormat::Csv {
            columns.insert(0, AnswerColumn::Id);
        }
        columns
    }

    /// Returns whether a column has the normals of the scene.
    pub(crate) fn has_normals(&self) -> bool {
        self.columns.contains(&AnswerColumn::Normal)
    }

    /// Returns whether the columns tell inside from outside and need no distances.
    pub(crate) fn has_only_inside(&self) -> bool {
        let needs_none =
            |c: &AnswerColumn| matches!(c, AnswerColumn::Number | AnswerColumn::Query | AnswerColumn::Inside);
        self.columns.contains(&AnswerColumn::Inside) && self.columns.iter().all(needs_none)
    }

    /// Refuses combinations of arguments that contradict each other.
    pub(crate) fn check(&self, format: AnswerFormat) -> anyhow::Result<()> {
        if self.columns.contains(&AnswerColumn::Id) && (format != AnswerFormat::Csv || self.points.points.is_none()) {
            return Err(usage("the column id is text: it needs a CSV file of answers, and --points with ids"));
        }
        for column in [AnswerColumn::Signed, AnswerColumn::Inside] {
            if self.columns.contains(&column) && self.signed.is_none() {
                return Err(usage(format!("the column {} needs --signed", column.name())));
            }
        }
        if self.has_normals() && self.has_many_answers() {
            return Err(usage("the column normal is not for --k-nearest and --within"));
        }
        match (1..self.columns.len()).find(|i| self.columns[..*i].contains(&self.columns[*i])) {
            Some(twice) => Err(usage(format!("the column {} is named twice", self.columns[twice].name()))),
            None => Ok(()),
        }
    }
}

/// The queries, their ids if their file has them, and a sample of them or of points in their region.
pub(crate) struct PreparedQueries {
    pub(crate) queries: Queries,
    pub(crate) ids: Option<PointIds>,
    pub(crate) sample: Vec<Point3<f64>>,
}

/// Returns the queries.
pub(crate) fn queries(streams: &Streams, args: &Args, bounds: &Aabb<f64>) -> anyhow::Result<PreparedQueries> {
    if let Some(PointTable { points, ids, .. }) = args.points.read(streams)? {
        if ids.is_none() && args.columns.contains(&AnswerColumn::Id) {
            return Err(usage("the column id needs points with ids: a column id in a text table, or --points-id"));
        }
        let sample = Queries::sample_of(&points);
        return Ok(PreparedQueries { queries: Queries::list(points), ids, sample });
    }
    let region = Region::around(bounds, args.box_scale);
    let queries = match args.grid {
        Some(side) => Queries::grid(region, side),
        None => Queries::random(region, args.random.unwrap_or(0), args.seed),
    };
    Ok(PreparedQueries { queries, ids: None, sample: Queries::sample(region) })
}

/// Returns the part of a report about the origin of the queries.
fn source_json(args: &Args) -> Value {
    match (&args.points.points, args.grid) {
        (Some(path), _) => json!({ "points": input::name(path) }),
        (_, Some(side)) => json!({ "grid": side, "box_scale": args.box_scale }),
        _ => json!({ "random": args.random, "seed": args.seed, "box_scale": args.box_scale }),
    }
}
