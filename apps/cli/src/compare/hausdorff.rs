//! `p2m hausdorff`: finds how far points of two scenes are from the other scene at most.

use crate::compare::scene_pair::{ScenePairArgs, line_of_point, report_of_point};
use crate::index::{Backend, backends};
use crate::io::usage::finite_not_negative;
use crate::io::{Output, Progress, SceneFile, Streams, ThreadArgs, Unit, json};
use crate::page::{PairPage, PairPageArgs, PairResult};
use anyhow::{Context, anyhow};
use p2m_core::PrimitiveSet;
use p2m_core::pair::Motion;
use p2m_field::{Direction, HausdorffDistance, HausdorffOptions, hausdorff_distance, one_sided_hausdorff_distance};
use p2m_mixed::statistics::figure::Length;
use p2m_page::Measure;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::sync::Arc;

const HELP: &str = "\
The Hausdorff distance is the largest distance from a point of either scene to the other scene. All points of \
triangles, segments and points count, not only vertices. Both bounds are certified in spite of rounding. Primitives \
are subdivided until the bounds differ by at most the tolerance, or until the limit of queries is reached; \
a note then says so.

Examples:
  p2m hausdorff scan.ply part.stl
  p2m hausdorff coarse.obj fine.obj --one-sided --tolerance 0.001
  p2m hausdorff a.obj b.obj --html page.html --open
  p2m hausdorff a.obj b.obj --transform pose.txt --json";

/// Find the Hausdorff distance between two scenes
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scenes: ScenePairArgs,

    /// The largest difference of the bounds [default: the diagonal / 10000]
    #[arg(long, value_name = "LENGTH", value_parser = finite_not_negative, allow_negative_numbers = true)]
    tolerance: Option<f64>,

    /// Measure from the first scene to the second one only
    #[arg(long)]
    one_sided: bool,

    /// Stop after N queries, not counting one per vertex. Each takes 80 bytes. The bounds may then differ by more than
    /// the tolerance
    #[arg(long, value_name = "N", default_value_t = HausdorffOptions::<f64>::new(0.0).max_queries, allow_negative_numbers = true)]
    max_queries: u64,

    /// The index of both scenes [default: the saved index, or aabb]
    #[arg(long, value_parser = backends(|_| true))]
    backend: Option<Backend>,

    #[command(flatten)]
    page: PairPageArgs,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    args.page.check(&args.scenes.paths())?;
    let motion = args.scenes.motion(streams)?;
    let formats = args.scenes.formats()?;
    let session = args.threads.start(streams)?;
    let mut files = args.scenes.read(&session, formats)?;
    if let Some(motion) = motion.as_ref().map(Motion::new) {
        let second = &mut files[1];
        let moved = Arc::make_mut(&mut second.scene.soup).map_positions(|p| motion.apply(p.coords.into()).into());
        moved.with_context(|| format!("{}: moved by --transform", second.name))?;
        // The saved index is that of the scene before.
        second.saved = None;
    }
    let [a, b] = files.each_ref().map(|file| &*file.scene.soup);
    let bounds = a.aabb().union(&b.aabb());
    let tolerance = args.tolerance.unwrap_or_else(|| (bounds.max - bounds.min).norm() / 1e4);
    let prepare = |k: usize| {
        let backend = args.backend.unwrap_or_else(|| files[k].backend());
        Ok::<_, anyhow::Error>(files[k].prepare(&session, backend)?.built.index)
    };
    let options = HausdorffOptions::new(tolerance).with_max_queries(args.max_queries);
    // One side alone needs no index of the first scene.
    let indexes = if args.one_sided { [None, Some(prepare(1)?)] } else { [Some(prepare(0)?), Some(prepare(1)?)] };
    let progress = Progress::start(streams, "comparing", None, Unit::None);
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let found = session.pool.install(|| match &indexes {
        [Some(index_a), Some(index_b)] => hausdorff_distance((a, &**index_a), (b, &**index_b), &options, &mut go_on),
        [_, Some(index)] => one_sided_hausdorff_distance(a, &**index, &options, &mut go_on),
        [_, None] => Ok(None),
    })?;
    drop(progress);
    let found = found.ok_or_else(|| anyhow!("a scene is empty, so there is no Hausdorff distance"))?;
    args.page.write(streams, || {
        let of = if args.one_sided { "the first" } else { "either" };
        let bounds = [found.lower_bound, found.upper_bound].map(|bound| Length(bound).to_string());
        let range = if bounds[0] == bounds[1] { bounds[0].clone() } else { bounds.join(" to ") };
        let verdict = format!("{range} {} at the farthest point.", args.page.unit());
        let remarks = vec![
            format!("No point of {of} scene is farther than this from the other scene."),
            "The gap between the scenes is another length, which p2m distance finds.".to_owned(),
        ];
        // The points are as far apart as the lower bound says.
        let measure = Measure { name: "farthest".to_owned(), ends: found.points, length: found.lower_bound };
        // The second scene is in its place already.
        let (paths, found) = (args.scenes.paths(), PairResult::Measures(vec![measure]));
        let scenes = files.each_ref().map(|file| &file.scene);
        PairPage { paths, scenes, motion: None, title: "Hausdorff distance", verdict, remarks, found }
    })?;
    if args.json {
        return json::print_report(streams, "hausdorff", [report(&files, &found, tolerance, args.one_sided)]);
    }
    Output::print(streams, text(&files, &found, tolerance))
}

/// Returns the numbers of the scene with the farthest point and of the other one.
fn sides(found: &HausdorffDistance<f64>) -> [usize; 2] {
    match found.direction {
        Direction::FirstToSecond => [0, 1],
        Direction::SecondToFirst => [1, 0],
    }
}

fn text(files: &[SceneFile; 2], found: &HausdorffDistance<f64>, tolerance: f64) -> String {
    let [from, to] = sides(found);
    let line = |k: usize| line_of_point(&files[k], found.points[k], found.primitives[k], None);
    let note = if found.is_tolerance_reached {
        String::new()
    } else {
        format!(
            "note: the tolerance of {tolerance} was not reached: the limit of queries ended the search (--max-queries), or rounding \
             allows no smaller difference\n"
        )
    };
    format!(
        "at least {} and at most {}\n{note}farthest from {}:\n{}closest to it:\n{}",
        found.lower_bound,
        found.upper_bound,
        files[to].name,
        line(from),
        line(to)
    )
}

fn report(files: &[SceneFile; 2], found: &HausdorffDistance<f64>, tolerance: f64, is_one_sided: bool) -> Value {
    let side = |k: usize| {
        let point = report_of_point(&files[k].scene, found.points[k], found.primitives[k], Value::Null);
        json!({ "file": files[k].name, "format": files[k].format.name(), "farthest": point })
    };
    json!({
        "scenes": [side(0), side(1)],
        "one_sided": is_one_sided,
        "tolerance": json::number(tolerance),
        "lower_bound": json::number(found.lower_bound),
        "upper_bound": json::number(found.upper_bound),
        "reached": found.is_tolerance_reached,
        "from": sides(found)[0],
        "queries": found.queries,
    })
}
