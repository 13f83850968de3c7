//! `p2m view`: a page that shows a scene, its answers, its field and the boxes of its tree in a browser.

use crate::answers::{Queries, Region};
use crate::index::{Backend, SignRule, SignedIndex, backends};
use crate::io::input::{ray_format, read_finite_points, read_rays};
use crate::io::usage::{count_in, not_negative, positive, usage, whole_number};
use crate::io::{Output, PointArgs, Progress, SceneArgs, Session, Streams, ThreadArgs, Unit, is_standard};
use crate::page::open::OpenArgs;
use crate::page::source::{PageArgs, about, file_name};
use crate::page::tree_levels::TreeLevels;
use crate::scene::info::counted;
use anyhow::{Context, bail};
use nalgebra::Point3;
use p2m_backends::AnyIndex;
use p2m_bvh::{AabbTree, PacketTree};
use p2m_core::engine::parallel;
use p2m_core::{Aabb, Closest, PrimitiveSet, QueryOptions, Ray};
use p2m_field::{FieldOptions, Grid, distances, signed_distances};
use p2m_mixed::Scene;
use p2m_mixed::statistics::Counts;
use p2m_page::{Level, Measure, View};
use std::path::{Path, PathBuf};

const HELP: &str = "\
The page is one HTML file, which any browser opens without a network. It shows the triangles, segments and points of \
the scene, whose objects you can hide. With queries it shows closest points, coloured by distance: click on a query \
to see its answer, the primitive, the feature and the sphere of the lower bound. --field adds a movable slice of the \
distance field, --lists a slice through cells, and --levels boxes of the AABB tree. The keyboard can do everything \
that the mouse can.

Pages of scenes of up to 100,000 primitives answer queries under the mouse pointer with the library itself, compiled \
to WebAssembly. --open opens the page in the browser.

Numbers are those of `p2m query`, with all digits. Scenes of more than a million primitives are drawn in less \
detail, and a note on the page says so.

Examples:
  p2m view scene.obj --random 1000 --out page.html
  p2m view bunny.obj --field 64 --signed --up y --out field.html
  p2m view scene.obj --rays hits.csv --open
  p2m view bunny.obj --backend p2m --lists 128 --out cells.html
  p2m view city.obj --points scan.xyz --unit metres --levels 8 --out city.html";

/// Show a scene, closest points and a distance field in a browser
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    points: PointArgs,

    /// Show the closest points of N random points in the box of the scene
    #[arg(long, value_name = "N", value_parser = |text: &str| count_in(text, 0, MAX_QUERIES), allow_negative_numbers = true, conflicts_with = "points")]
    random: Option<u64>,

    /// Scale the box of the scene about its centre by this factor
    #[arg(long, value_name = "S", default_value_t = 1.2, value_parser = positive, allow_negative_numbers = true)]
    box_scale: f64,

    /// The seed of the random points
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true, requires = "random")]
    seed: u64,

    /// Find nothing farther than R, in the unit of the scene
    #[arg(long, value_name = "R", value_parser = not_negative, allow_negative_numbers = true)]
    max_distance: Option<f64>,

    /// Show the first hits of the rays of a file, such as the table of `p2m ray`
    #[arg(long, value_name = "FILE")]
    rays: Option<PathBuf>,

    /// Show slices of a distance field with N grid points along the longest side
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=256), allow_negative_numbers = true)]
    field: Option<u32>,

    /// Compute signed distances, negative inside; the scene must have triangles only
    #[arg(long, value_name = "RULE", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_enum)]
    signed: Option<SignRule>,

    /// Show slices through the cells of an octree or a P2M index, coloured by the length of their lists
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=256), allow_negative_numbers = true, conflicts_with = "field")]
    lists: Option<u32>,

    /// Show the boxes of the first N levels of the AABB tree
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=16), allow_negative_numbers = true)]
    levels: u8,

    /// Answer queries under the mouse pointer; auto: for up to 100,000 primitives
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Live::Auto)]
    live: Live,

    /// The index to search [default: the saved index, or aabb]
    #[arg(long, value_parser = backends(|_| true))]
    backend: Option<Backend>,

    #[command(flatten)]
    page: PageArgs,

    #[command(flatten)]
    open: OpenArgs,

    /// Write the page to this file; `-` is the standard output [default: SCENE.html in this folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    threads: ThreadArgs,
}

/// When a page answers queries itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Live {
    /// If the scene is small
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The number of primitives above which a page has no live queries unless they are asked for.
const MAX_LIVE_PRIMITIVES: usize = 100_000;

/// The largest number of query points of a page.
const MAX_QUERIES: u64 = 100_000;

/// The sides of scenes whose distances, and much smaller and larger ones, f32 represents.
const F32_SIDES: std::ops::Range<f64> = 1e-30..1e30;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let out = args.out()?;
    args.check(&out)?;
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let file = args.scene.read(&session, format)?;
    let scene = &file.scene;
    let bounds = scene.soup.aabb();
    let queries = args.queries(streams, &bounds)?;
    let grid = args.grid(&bounds)?;
    let rays =
        args.rays.as_ref().map(|path| read_rays(streams, path, ray_format(path, None, "--rays")?)).transpose()?;
    if rays.as_ref().is_some_and(|rays| rays.len() as u64 > MAX_QUERIES) {
        bail!("--rays: a page shows at most {MAX_QUERIES} rays");
    }
    let output = Output::open(streams, Some(&out))?;

    let backend = args.backend.unwrap_or_else(|| file.backend());
    let index = file.prepare(&session, backend)?.built.index;
    if args.lists.is_some() && index.list_lengths().is_empty() {
        return Err(usage(format!("--lists needs an index with lists: {} has none", backend.name)));
    }
    let signed = args.signed.map(|rule| rule.prepare_signed(streams, &*index, &scene.soup)).transpose();
    let signed = signed.with_context(|| args.scene.name())?;
    let rule = signed.as_ref().map(|signed| signed.rule().name());
    let source = PageSource { session: &session, args, backend, index: &*index, signed: signed.as_ref() };
    let hits = rays.map(|rays| source.hits(&rays)).transpose()?;
    let mut view = source.view(scene, queries.as_deref(), grid.as_ref(), hits.as_deref())?;
    view.about = about(&format!("scene {}", args.scene.name()), backend.name, rule);
    let page = view.html()?;
    output.finish_with(&page)?;
    streams.print_summary(format_args!("{}\nwritten  {}, {} bytes\n", view.summary, out.display(), page.len()));
    args.open.show(Some(&out))
}

/// The index and the signs of a scene, by which its page is computed.
struct PageSource<'a> {
    session: &'a Session<'a>,
    args: &'a Args,
    backend: Backend,
    index: &'a dyn AnyIndex,
    signed: Option<&'a SignedIndex<'a>>,
}

impl PageSource<'_> {
    /// Returns the view of a scene with all that the arguments ask for.
    fn view<'v>(
        &self,
        scene: &'v Scene,
        queries: Option<&[Point3<f64>]>,
        grid: Option<&Grid>,
        hits: Option<&[Option<Measure>]>,
    ) -> anyhow::Result<View<'v>> {
        let ends = hits.unwrap_or_default().iter().flatten().flat_map(|hit| hit.ends);
        let around = Aabb::from_points(&queries.unwrap_or_default().iter().copied().chain(ends).collect::<Vec<_>>());
        let around = grid.map_or(around, |grid| {
            around.union(&Aabb { min: grid.origin(), max: grid.point(grid.counts().map(|n| n - 1)) })
        });
        let args = self.args;
        let mut view = args.page.view(scene, &around);
        view.title = file_name(&args.scene.path);
        let is_empty = scene.soup.is_empty();
        view.summary = if is_empty { "an empty scene".to_owned() } else { counted(&Counts::of(&scene.soup)) };
        if let Some(queries) = queries {
            view = self.with_answers(view, queries);
        }
        if let Some(hits) = hits {
            let found: Vec<Measure> = hits.iter().flatten().cloned().collect();
            let verdict = format!("{} of {} rays hit the scene.", found.len(), hits.len());
            view.summary += &format!("; {} rays", hits.len());
            view = view.with_measures("Rays", &verdict, &[], &found);
        }
        if let (Some(grid), Some(_)) = (grid, args.lists) {
            view = self.with_list_lengths(view, grid);
        }
        if let (Some(grid), Some(_)) = (grid, args.field) {
            view = self.with_field(view, grid)?;
        }
        let is_small = scene.soup.len() <= MAX_LIVE_PRIMITIVES;
        if args.live == Live::Always || (args.live == Live::Auto && is_small) {
            view = view.with_live_queries();
        }
        if args.levels > 0 {
            let tree = self.session.pool.install(|| AabbTree::new(&*scene.soup));
            let tree = tree.with_context(|| args.scene.name())?;
            view = view.with_levels("Boxes of the AABB tree", &levels(tree.tree(), usize::from(args.levels)));
        }
        Ok(view)
    }

    /// Adds query points and their closest points.
    fn with_answers<'v>(&self, mut view: View<'v>, queries: &[Point3<f64>]) -> View<'v> {
        let Self { session, index, .. } = *self;
        let options = QueryOptions::default();
        let options = self.args.max_distance.map_or(options, |limit| options.with_max_distance(limit));
        let _progress = Progress::start(self.session.streams, "answering", None, Unit::None);
        let answers: Vec<Option<Closest<f64>>> = session
            .pool
            .install(|| parallel::map_slice(queries, true, |query| index.closest_point_with(query, &options)));
        let signs: Option<Vec<f64>> = self.signed.map(|signed| {
            let sign = |i: usize| {
                let distance = answers[i].and_then(|answer| signed.with_sign(&queries[i], answer).distance());
                distance.unwrap_or(f64::NAN)
            };
            session.pool.install(|| parallel::map(answers.len(), true, sign))
        });
        view.summary +=
            &format!("; {} query points and their closest points, found by {}", queries.len(), self.backend.name);
        view.with_answers(queries, &answers, signs.as_deref())
    }

    /// Returns the lines from the origins of rays to their first hits.
    fn hits(&self, rays: &[Ray]) -> anyhow::Result<Vec<Option<Measure>>> {
        let index = self.index.as_ray_query();
        let index = index.ok_or_else(|| usage(format!("--rays: {} casts no rays", self.backend.name)))?;
        let hit = |ray: &Ray| {
            let hit = index.first_intersection(ray)?;
            let ends = [ray.origin(), hit.point()];
            Some(Measure { name: String::new(), ends, length: (ends[1] - ends[0]).norm() })
        };
        Ok(self.session.pool.install(|| parallel::map_slice(rays, true, hit)))
    }

    /// Adds the lengths of the lists at the points of a grid.
    fn with_list_lengths<'v>(&self, mut view: View<'v>, grid: &Grid) -> View<'v> {
        let ([x, y, z], index) = (grid.counts(), self.index);
        let length = |number: usize| {
            let point = grid.point([number % x, number / x % y, number / (x * y)]);
            index.list_length(&point).map_or(f32::NAN, |length| length as f32)
        };
        let lengths: Vec<f32> = self.session.pool.install(|| parallel::map(grid.len(), true, length));
        view.summary += &format!("; lengths of the lists of {} at {x} x {y} x {z} points", self.backend.name);
        view.with_list_lengths(grid, &lengths)
    }

    /// Adds the distances at the points of a grid.
    fn with_field<'v>(&self, mut view: View<'v>, grid: &Grid) -> anyhow::Result<View<'v>> {
        let points = Some(grid.len() as u64);
        let progress = Progress::start(self.session.streams, "filling the grid", points, Unit::Items("points"));
        let count = |points: usize| progress.add(points as u64);
        let options = FieldOptions::default();
        let Self { session, index, signed, .. } = *self;
        let values = session.pool.install(|| match signed {
            Some(signed) => signed_distances(signed, grid, &options, &count),
            None => distances(index, grid, &options, &count),
        })?;
        let [x, y, z] = grid.counts();
        view.summary += &format!("; a field of {x} x {y} x {z} points");
        Ok(view.with_field(grid, &values))
    }
}

/// Returns the boxes of the first levels.
fn levels(tree: &PacketTree, count: usize) -> Vec<Level> {
    let tree_levels = TreeLevels::new(tree);
    let level = |level: usize| {
        let boxes: Vec<Aabb<f64>> = tree_levels.level(level).iter().map(|node| node.volume).collect();
        let noun = if boxes.len() == 1 { "box" } else { "boxes" };
        Level { title: format!("level {level}: {} {noun}", boxes.len()), boxes }
    };
    (0..count.min(tree_levels.count())).map(level).collect()
}

impl Args {
    /// Refuses combinations of arguments that contradict each other.
    fn check(&self, out: &Path) -> anyhow::Result<()> {
        if self.signed.is_some() && self.field.is_none() && self.points.points.is_none() && self.random.is_none() {
            return Err(usage("--signed needs --field, --random or --points"));
        }
        let inputs: Vec<&Path> =
            std::iter::once(self.scene.path.as_path()).chain(self.points.points.as_deref()).collect();
        Output::refuse_inputs(out, &inputs)
    }

    /// Returns the file of the page.
    fn out(&self) -> anyhow::Result<PathBuf> {
        match &self.out {
            Some(out) => Ok(out.clone()),
            None if is_standard(&self.scene.path) => Err(usage("a scene from the standard input needs --out FILE")),
            None => Ok(Path::new(&file_name(&self.scene.path)).with_extension("html")),
        }
    }

    /// Returns the grid of distances or of lengths of lists, if there is one. `bounds` is the box of the scene.
    fn grid(&self, bounds: &Aabb<f64>) -> anyhow::Result<Option<Grid>> {
        let grid = self.field.or(self.lists).map(|n| Grid::around(bounds, n as usize, self.box_scale)).transpose();
        let grid = grid.with_context(|| self.scene.name())?;
        let side = if bounds.is_empty() { 0.0 } else { (bounds.max - bounds.min).amax() };
        if self.field.is_some() && side != 0.0 && !F32_SIDES.contains(&side) {
            bail!("{}: --field has numbers of f32, which cannot hold lengths of about {side:e}", self.scene.name());
        }
        Ok(grid)
    }

    /// Returns the query points, if there are any to show.
    fn queries(&self, streams: &Streams, bounds: &Aabb<f64>) -> anyhow::Result<Option<Vec<Point3<f64>>>> {
        if let Some(points) = read_finite_points(streams, &self.points)? {
            if points.len() as u64 > MAX_QUERIES {
                bail!("--points: {} points are too many to show: at most {MAX_QUERIES}", points.len());
            }
            return Ok(Some(points));
        }
        let region = Region::around(bounds, self.box_scale);
        Ok(self.random.map(|count| Queries::random(region, count, self.seed).collect()))
    }
}
