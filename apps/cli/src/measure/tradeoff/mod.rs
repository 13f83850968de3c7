//! `p2m tradeoff`: measures the costs and the errors of each backend with each setting over a scene.
//!
//! A backend answers faster if it may be less accurate. [`settings`] lists the settings of accuracy. [`rounds`] runs all
//! backends with all settings in turns, and compares their answers with the truth. A [`curve::Curve`] has the results of
//! one backend, and a [`curve::Point`] those of one of its settings. The results become a page ([`page`]), a table
//! ([`text`]) or a record ([`record`]).

mod curve;
mod errors;
#[cfg(test)]
mod fixtures;
mod page;
mod record;
mod rounds;
mod settings;
mod text;

use curve::{Build, SceneFigures, SetFigures, Turn};
use errors::Truth;
use page::Page;
use record::record;
use rounds::{Competitor, Effort, clock_nanoseconds, measure};
use settings::SETTINGS;

use crate::answers::queries::{Queries as QueryPoints, Region};
use crate::index::backend::{Backend, backends};
use crate::io::input::{PointArgs, SceneArgs, read_finite_points};
use crate::io::output::Output;
use crate::io::progress::{Progress, Unit};
use crate::io::streams::Streams;
use crate::io::threads::ThreadArgs;
use crate::io::usage::{count_in, positive, usage, whole_number};
use crate::measure::harness::Provenance;
use crate::measure::harness::queries::Queries;
use crate::measure::harness::rounds::thread_seconds;
use crate::page::open::OpenArgs;
use crate::scene::info::counted;
use anyhow::{Context, bail};
use clap::ArgGroup;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, BACKENDS, BuildSettings, Choice, QueryRegion, SearchStructure, Workload};
use p2m_bvh::AabbTree;
use p2m_core::{CertifiedQuery, PrimitiveSet, Soup};
use p2m_mixed::Scene;
use p2m_mixed::statistics::Counts;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const HELP: &str = "\
Every backend answers the same queries on one thread, with every setting: exact, certified and approximate. For \
each, the table has the nanoseconds per query (the median of the rounds), the speed relative to the default of the \
same backend, the largest relative error of the distance and the error that one query in a thousand exceeds, the \
largest error in units of u M (u is 2^-53, M the distance to the farthest vertex of the closest primitive), the gap \
of the certified lower bound, percentiles of single queries, and the time to build.

The page of --html shows the same as charts with explanations. It is one file.

Examples:
  p2m tradeoff scene.obj --random 20000
  p2m tradeoff scene.obj --points scan.xyz --backends aabb,p2m --html tradeoff.html --csv tradeoff.csv";

/// Measure speed against accuracy for every backend and setting
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("queries").required(true).args(["points", "grid", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    points: PointArgs,

    /// Query N x N x N points, evenly spaced in the box of the scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=512), allow_negative_numbers = true)]
    grid: Option<u64>,

    /// Query N random points in the box of the scene
    #[arg(long, value_name = "N", value_parser = |text: &str| count_in(text, 1, 100_000_000), allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "points")]
    box_scale: f64,

    /// The seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, conflicts_with_all = ["points", "grid"])]
    seed: u64,

    /// The backends to compare
    #[arg(long, value_parser = backends(|_| true), value_delimiter = ',', default_values = default_backends())]
    backends: Vec<Backend>,

    /// The number of rounds; every setting runs once per round
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1000), allow_negative_numbers = true)]
    rounds: usize,

    /// The longest time for one setting per round, in seconds
    #[arg(long, value_name = "S", default_value_t = 0.1, value_parser = positive, allow_negative_numbers = true)]
    round_seconds: f64,

    /// Write a page with charts and explanations
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    #[command(flatten)]
    open: OpenArgs,

    /// Write the figures as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// Returns the names of the backends that are compared by default: all but exhaustive searches.
fn default_backends() -> impl Iterator<Item = &'static str> {
    let has_index = |backend: &Backend| backend.structure != SearchStructure::Exhaustive;
    BACKENDS.iter().filter(has_index).map(|backend| backend.name)
}

/// An index that was built for the comparison, with its cost.
struct MeasuredIndex {
    backend: Backend,
    index: Arc<dyn AnyIndex>,
    cost: Build,
}

impl MeasuredIndex {
    /// Builds an index on one thread, and measures the time.
    fn build(backend: Backend, soup: &Arc<Soup<f64>>) -> anyhow::Result<Self> {
        let settings = BuildSettings::default().with_parallel(false);
        let (built, seconds) = thread_seconds(|| backend.build(Arc::clone(soup), &settings));
        let index = built?.index;
        #[allow(clippy::cast_precision_loss, reason = "less than 2^53 bytes")]
        let bytes_per_primitive = index.memory_bytes() as f64 / soup.len() as f64;
        Ok(Self { backend, index, cost: Build { seconds, bytes_per_primitive } })
    }
}

/// The sentence of the page about the truth that answers are compared with.
const TRUTH: &str = "The truth is what certified answers say: the nearest primitive, and its distance rounded once.";

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let outputs = [&args.html, &args.csv];
    let inputs: Vec<&Path> =
        [Some(&args.scene.path), args.points.points.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect();
    for path in outputs.into_iter().flatten() {
        Output::refuse_inputs(path, &inputs)?;
    }
    if args.open.open && args.html.is_none() {
        return Err(usage("--open needs a page: --html FILE"));
    }
    if args.html.is_some() && args.html == args.csv {
        bail!("--html and --csv name the same file");
    }
    let session = ThreadArgs::default().start(streams)?;
    let scene = args.scene.read(&session, args.scene.format()?)?.scene;
    if scene.soup.is_empty() {
        bail!("{}: there is nothing in it", args.scene.name());
    }
    let (queries, description) = args.queries(streams, &scene)?;
    // The files are opened before the work, which would be lost if a name were wrong.
    let [html, csv] = outputs.map(|path| path.as_ref().map(|path| Output::open(streams, Some(path))).transpose());
    let (html, csv) = (html?, csv?);
    let figures = args.measure(streams, &scene, queries, description).with_context(|| args.scene.name())?;

    let (provenance, clock) = (Provenance::collect(None), clock_nanoseconds());
    let scenes = std::slice::from_ref(&figures);
    if let Some(output) = html {
        let backends: Vec<_> = args.backends.iter().map(|backend| (backend.name, backend.summary)).collect();
        let effort =
            format!("One thread, one call at a time, {} rounds in turns; one build of each index.", args.rounds);
        let page = Page { provenance: &provenance, effort: &effort, truth: TRUTH, clock, scenes, backends: &backends };
        output.finish_with(page.html()?)?;
    }
    if let Some(output) = csv {
        output.finish_with(record(&provenance, scenes, args.seed, clock))?;
    }
    let tables: Vec<String> = figures.sets.iter().map(|set| text::table(set).to_string()).collect();
    Output::print(streams, tables.concat())?;
    args.open.show(args.html.as_deref())
}

impl Args {
    /// Returns the queries and a sentence that describes them. Points that are not finite are left out, because they
    /// have no answers that could be compared.
    fn queries(&self, streams: &Streams, scene: &Scene) -> anyhow::Result<(Vec<Point3<f64>>, String)> {
        let region = Region::around(&scene.soup.aabb(), self.box_scale);
        let points = read_finite_points(streams, &self.points)?;
        let (queries, description) = match (points.zip(self.points.points.as_ref()), self.grid) {
            (Some((points, path)), _) => (points, format!("The points of {}.", crate::io::input::name(path))),
            (None, Some(side)) => (
                QueryPoints::grid(region, side).collect(),
                format!(
                    "A grid of {side} points along each axis of the box of the scene, scaled by {}.",
                    self.box_scale
                ),
            ),
            _ => (
                QueryPoints::random(region, self.random.unwrap_or(0), self.seed).collect(),
                format!("Random points of the box of the scene, scaled by {}.", self.box_scale),
            ),
        };
        let queries: Vec<_> = queries.into_iter().filter(|p: &Point3<f64>| p.iter().all(|x| x.is_finite())).collect();
        if queries.is_empty() {
            bail!("there is no finite point");
        }
        Ok((queries, description))
    }

    /// Returns which of the measured backends takes the least time for some number of queries, by the choice of `auto`.
    fn turns(&self, soup: &Arc<Soup<f64>>, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Turn>> {
        let choice = Choice::compare(Arc::clone(soup), &Workload::new(COMMON_QUERIES, QueryRegion::Like(queries)))?;
        let turns = choice.turns(|e| e.resolution.is_none() && self.backends.contains(&e.backend));
        Ok(turns.into_iter().map(|(estimate, from)| Turn { name: estimate.backend.name, from }).collect())
    }

    /// Builds the indexes and measures all settings of all backends.
    fn measure(
        &self,
        streams: &Streams,
        scene: &Scene,
        queries: Vec<Point3<f64>>,
        description: String,
    ) -> anyhow::Result<SceneFigures> {
        let soup = &scene.soup;
        let progress =
            Progress::start(streams, "building indexes", Some(self.backends.len() as u64), Unit::Items("backends"));
        let mut indexes = Vec::new();
        for (i, backend) in self.backends.iter().enumerate() {
            if self.backends[..i].contains(backend) {
                continue;
            }
            indexes.push(MeasuredIndex::build(backend, soup)?);
            progress.add(1);
        }
        drop(progress);
        let truths = truths(soup, &queries)?;
        let turns = self.turns(soup, &queries)?;
        let competitors: Vec<Competitor<'_>> = indexes
            .iter()
            .flat_map(|index| {
                let (backend, build) = (index.backend.name, index.cost);
                SETTINGS.iter().map(move |setting| Competitor { backend, setting, index: &*index.index, build })
            })
            .collect();
        let progress = Progress::start(streams, "measuring", Some(100), Unit::Percent);
        let effort = Effort { rounds: self.rounds, seconds: self.round_seconds };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 100")]
        let show_progress = |part: f64| progress.advance_to((part * 100.0) as u64);
        let curves = measure(&competitors, &Queries::new(queries), &truths, &effort, &show_progress);
        drop(progress);
        let contents = format!("{}.", counted(&Counts::of(soup)));
        let name = match (&self.points.points, self.grid) {
            (Some(_), _) => "points",
            (None, Some(_)) => "grid",
            (None, None) => "random",
        };
        let set = SetFigures { name: name.to_owned(), about: description, curves, turns };
        Ok(SceneFigures { name: self.scene.name(), about: contents, primitives: soup.len(), sets: vec![set] })
    }
}

/// The number of queries of the first sentence of the page.
const COMMON_QUERIES: u64 = 1_000_000;

/// Returns the certified answers to all queries.
fn truths(soup: &Soup<f64>, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Truth>> {
    let tree = AabbTree::new(soup)?;
    let truth = |query: &Point3<f64>| {
        let closest = tree.certified_closest_point(query, &Default::default())?;
        let closest = closest.context("the scene is not empty, and queries are finite")?;
        let shape = soup.get(closest.primitive);
        let max_vertex_distance = shape.vertices().iter().map(|vertex| (vertex - query).norm()).fold(0.0, f64::max);
        Ok(Truth { distance: closest.distance, max_vertex_distance, primitive: closest.primitive })
    };
    queries.iter().map(truth).collect()
}
