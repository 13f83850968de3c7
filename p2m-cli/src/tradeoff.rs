//! `p2m tradeoff`: what each backend and each setting costs over a scene, and how wrong it is.

use crate::input::{SceneArgs, point_format, read_points, read_scene};
use crate::output::Output;
use crate::progress::{Progress, Unit};
use crate::sampling::{Queries as Places, Region};
use crate::streams::Streams;
use crate::usage::{one_of, positive, whole};
use anyhow::{Context, bail};
use clap::{ArgGroup, ValueEnum};
use nalgebra::Point3;
use p2m_bvh::{AabbOptions, AabbTree};
use p2m_core::{BruteForce, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, PrimitiveSet, Soup};
use p2m_interception::{OctreeIndex, OctreeOptions, P2mIndex, P2mOptions};
use p2m_kdop::{KdopOptions, KdopTree};
use p2m_mixed::{PointFormat, Scene};
use p2m_tradeoff::page::Page;
use p2m_tradeoff::queries::Queries;
use p2m_tradeoff::settings::{Ask, SETTINGS, Setting};
use p2m_tradeoff::{
    Asked, AskedForProof, Build, Effort, Entrant, Provenance, SceneFigures, SetFigures, Subject, Truth,
    clock_nanoseconds, measure, record::record, text, thread_seconds,
};
use std::io::Write as _;
use std::path::{Path, PathBuf};

const HELP: &str = "\
Every backend is built over the scene, on one thread, and asked about the same places with every setting, in turns: the default, certified \
answers and less exact ones. The table has for each the nanoseconds of a query (the median of the rounds), how many times \
as fast that is as the default of the same backend, the largest error of the distance relative to it and what one query in a thousand \
exceeds, the largest error in units of u M (u is 2^-53, M the distance to the farthest corner of the nearest primitive), what the certified \
lower bound leaves open, how long single queries take, the seconds to build, and what is wrong.

The page of --html shows the same as plots with explanations, in one file that needs nothing else.

Examples:
  p2m tradeoff scene.obj --random 20000
  p2m tradeoff scene.obj --points scan.xyz --backends aabb,p2m --html tradeoff.html --csv tradeoff.csv";

/// Say what each backend and each setting costs over a scene, and how wrong it is
#[derive(clap::Args)]
#[command(after_help = HELP)]
#[command(group = ArgGroup::new("queries").required(true).args(["points", "grid", "random"]))]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Ask about the points of this XYZ, TXT, CSV, NPY or PLY file; `-` is the standard input
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,

    /// The format of the points, if the extension of their file does not tell
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<PointFormat>(PointFormat::NAMES), ignore_case = true, requires = "points")]
    points_format: Option<PointFormat>,

    /// Ask about a grid of N x N x N points that fills the scaled box of the scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=512), allow_negative_numbers = true)]
    grid: Option<u64>,

    /// Ask about N uniformly distributed points in the scaled box of the scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000), allow_negative_numbers = true)]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor before filling it
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true, conflicts_with = "points")]
    box_scale: f64,

    /// Seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole, allow_negative_numbers = true, conflicts_with_all = ["points", "grid"])]
    seed: u64,

    /// Backends to compare
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Kind::Aabb, Kind::Kdop, Kind::Octree, Kind::P2m])]
    backends: Vec<Kind>,

    /// Rounds, in which all take turns
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1000), allow_negative_numbers = true)]
    rounds: usize,

    /// The most seconds that a round of one setting takes: slow ones are asked about fewer places
    #[arg(long, value_name = "S", default_value_t = 0.1, value_parser = positive, allow_negative_numbers = true)]
    round_seconds: f64,

    /// Write a page with plots and explanations
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    /// Write a record of comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// What is compared.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Every primitive, every time
    Brute,
    /// A tree of boxes
    Aabb,
    /// A tree of polytopes with 14 faces
    Kdop,
    /// Cells in space with lists of what can be nearest there
    Octree,
    /// Cells of the vertices with lists of what can be nearest there
    P2m,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
            Self::Kdop => "kdop",
            Self::Octree => "octree",
            Self::P2m => "p2m",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Brute => "every primitive, every time",
            Self::Aabb => "a tree of boxes",
            Self::Kdop => "a tree of polytopes with 14 faces, which fit closer what does not lie along the axes",
            Self::Octree => "cells in space with lists of what can be nearest there",
            Self::P2m => "cells of the vertices with lists of what can be nearest there",
        }
    }

    /// Builds it, on one thread, which is what is measured.
    fn build<'a>(self, soup: &'a Soup<f64>) -> anyhow::Result<Index<'a>> {
        let splits = AabbOptions::default().with_parallel(false);
        match self {
            Self::Brute => built::<BruteForce<_>>(soup, &()),
            Self::Aabb => built::<AabbTree<_, _>>(soup, &splits),
            Self::Kdop => built::<KdopTree<_, _, 14>>(soup, &KdopOptions::default().with_splits(splits)),
            Self::Octree => built::<OctreeIndex<_, _>>(soup, &OctreeOptions::default().with_splits(splits)),
            Self::P2m => built::<P2mIndex<_, _>>(soup, &P2mOptions::default().with_splits(splits)),
        }
    }
}

/// An index, and what it cost.
type Index<'a> = (Box<dyn Askable + 'a>, Build);

/// An index of any type.
trait Askable: Sync {
    fn subject(&self, setting: &Setting) -> Box<dyn Subject + '_>;
}

struct Ours<I>(I);

impl<I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync> Askable for Ours<I> {
    fn subject(&self, setting: &Setting) -> Box<dyn Subject + '_> {
        match setting.ask {
            Ask::Certified => Box::new(AskedForProof::new(&self.0)),
            _ => Box::new(Asked::new(&self.0, setting.options::<f64>())),
        }
    }
}

/// Nobody counts bytes here.
fn cost(seconds: f64) -> Build {
    Build { seconds, bytes_each: None }
}

fn built<'a, I>(soup: &'a Soup<f64>, options: &I::Options) -> anyhow::Result<Index<'a>>
where
    I: BuildIndex<f64, &'a Soup<f64>, Error = BuildError> + CertifiedQuery<f64> + Sync + 'a,
{
    let (index, seconds) = thread_seconds(|| I::build(soup, options));
    Ok((Box::new(Ours(index?)), cost(seconds)))
}

/// What is behind the points of a page, in words.
const TRUTH: &str = "The truth is what certified answers say: the nearest primitive, and its distance rounded once.";

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let outputs = [&args.html, &args.csv];
    let inputs: Vec<&Path> =
        [Some(&args.scene.path), args.points.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect();
    for path in outputs.into_iter().flatten() {
        Output::refuse_inputs(path, &inputs)?;
    }
    if args.html.is_some() && args.html == args.csv {
        bail!("--html and --csv name the same file");
    }
    let scene = read_scene(streams, &args.scene.path, args.scene.format()?)?;
    if scene.soup.is_empty() {
        bail!("{}: there is nothing in it to ask about", args.scene.name());
    }
    let (places, about) = args.places(streams, &scene)?;
    // Before any work, so that it is not lost to a wrong name.
    let [html, csv] = outputs.map(|path| path.as_ref().map(|path| Output::open(streams, Some(path))).transpose());
    let (html, csv) = (html?, csv?);
    let figures = args.measured(streams, &scene, places, about).with_context(|| args.scene.name())?;

    let (provenance, clock) = (Provenance::collect(None, None), clock_nanoseconds());
    let scenes = std::slice::from_ref(&figures);
    if let Some(output) = html {
        let backends: Vec<_> = args.backends.iter().map(|kind| (kind.name(), kind.about())).collect();
        let effort =
            format!("One thread, one call at a time, {} rounds in turns; one build of each index.", args.rounds);
        let page = Page {
            provenance: &provenance,
            effort: &effort,
            truth: TRUTH,
            clock,
            scenes,
            sweeps: &[],
            backends: &backends,
        };
        save(output, &page.html()?)?;
    }
    if let Some(output) = csv {
        save(output, &record(&provenance, scenes, args.seed, clock))?;
    }
    let tables: Vec<String> = figures.sets.iter().map(|set| text::table(set).to_string()).collect();
    save(Output::open(streams, None)?, &tables.concat())
}

fn save(mut output: Output<'_>, text: &str) -> anyhow::Result<()> {
    output.write_all(text.as_bytes()).with_context(|| output.cannot_write())?;
    output.finish()
}

impl Args {
    /// Where to ask, and what that is in words. Places that are not finite have no answers that could be compared.
    fn places(&self, streams: &Streams, scene: &Scene) -> anyhow::Result<(Vec<Point3<f64>>, String)> {
        let region = Region::around(&scene.soup, self.box_scale);
        let (places, about) = match (&self.points, self.grid) {
            (Some(path), _) => {
                let points = read_points(streams, path, point_format(path, self.points_format, "--points-format")?)?;
                (points, format!("The points of {}.", crate::input::name(path)))
            }
            (None, Some(side)) => (
                Places::grid(region, side).collect(),
                format!(
                    "A grid of {side} points along each axis of the box of the scene, scaled by {}.",
                    self.box_scale
                ),
            ),
            _ => (
                Places::random(region, self.random.unwrap_or(0), self.seed).collect(),
                format!("Random points of the box of the scene, scaled by {}.", self.box_scale),
            ),
        };
        let places: Vec<_> = places.into_iter().filter(|p: &Point3<f64>| p.iter().all(|x| x.is_finite())).collect();
        if places.is_empty() {
            bail!("no finite point to ask about");
        }
        Ok((places, about))
    }

    fn measured(
        &self,
        streams: &Streams,
        scene: &Scene,
        places: Vec<Point3<f64>>,
        about: String,
    ) -> anyhow::Result<SceneFigures> {
        let soup = &scene.soup;
        let progress =
            Progress::start(streams, "building indexes", Some(self.backends.len() as u64), Unit::Items("backends"));
        let mut indexes = Vec::new();
        for (i, kind) in self.backends.iter().enumerate() {
            if self.backends[..i].contains(kind) {
                continue;
            }
            indexes.push((*kind, kind.build(soup)?));
            progress.add(1);
        }
        drop(progress);
        let truths = truths(soup, &places)?;
        let entrants: Vec<Entrant<'_>> = indexes
            .iter()
            .flat_map(|(kind, (index, build))| {
                SETTINGS.iter().map(move |setting| Entrant {
                    backend: kind.name().to_owned(),
                    setting: setting.name.to_owned(),
                    promise: setting.promise(),
                    subject: index.subject(setting),
                    build: *build,
                })
            })
            .collect();
        let progress = Progress::start(streams, "asking", Some(100), Unit::Percent);
        let effort = Effort { rounds: self.rounds, seconds: self.round_seconds };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 100")]
        let reach = |part: f64| progress.reach((part * 100.0) as u64);
        let curves = measure(&entrants, &Queries::new(places), &truths, &effort, &reach);
        drop(progress);
        let contents = format!(
            "{} triangles, {} segments, {} points.",
            soup.triangles().len(),
            soup.segments().len(),
            soup.points().len()
        );
        let name = match (&self.points, self.grid) {
            (Some(_), _) => "points",
            (None, Some(_)) => "grid",
            (None, None) => "random",
        };
        let set = SetFigures { name: name.to_owned(), about, curves };
        Ok(SceneFigures {
            name: self.scene.name(),
            about: contents,
            primitives: soup.len(),
            sets: vec![set],
            notes: Vec::new(),
        })
    }
}

/// What an exact index answers.
#[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
fn truths(soup: &Soup<f64>, places: &[Point3<f64>]) -> anyhow::Result<Vec<Truth>> {
    let tree = AabbTree::build(soup, &Default::default())?;
    let truth = |place: &Point3<f64>| {
        let closest = tree.certified_closest_point(place, &Default::default())?;
        let closest = closest.context("the scene is not empty, and queries are finite")?;
        let shape = soup.get(closest.primitive);
        let reach = shape.vertices().iter().map(|vertex| (vertex - place).norm()).fold(0.0, f64::max);
        Ok(Truth { distance: closest.distance, rest: 0.0, reach, id: closest.primitive.index() as u32 })
    };
    places.iter().map(truth).collect()
}
