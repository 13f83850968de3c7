//! `p2m distance`: finds the nearest points of two scenes.

use crate::compare::scene_pair::{ScenePairArgs, line_of_point, report_of_point};
use crate::io::{Output, Progress, SceneFile, Streams, ThreadArgs, Unit, json, usage};
use crate::page::{PairPage, PairPageArgs, PairResult};
use anyhow::Context;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::pair::{ClosestPair, PairOptions, PairQuery};
use p2m_core::{PrimitiveSet, Soup};
use p2m_field::sign::SignedDistance;
use p2m_field::solid::{Parts, Solid};
use p2m_mixed::statistics::figure::{Figure, Length};
use p2m_page::Measure;
use serde_json::{Value, json};

const HELP: &str = "\
The distance is 0 if the scenes intersect, which is decided without rounding. Only surfaces count: a scene inside a \
closed one has the distance to its surface. With --solid, scenes of triangles are filled, and what is inside has the \
distance 0. The lower bound is certified.

Examples:
  p2m distance cell.ply robot.ply --solid
  p2m distance cell.obj arm.obj --transform pose.txt --html page.html --open
  p2m distance a.stl b.stl --max-distance 0.01 --json";

/// Find the distance between two scenes, and whether they intersect
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scenes: ScenePairArgs,

    /// Find nothing farther than this, which takes less time
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true)]
    max_distance: Option<f64>,

    /// Count the inside of closed scenes, so that what is inside has the distance 0
    #[arg(long)]
    solid: bool,

    #[command(flatten)]
    page: PairPageArgs,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let limit = args.max_distance.unwrap_or(f64::INFINITY);
    if limit.is_nan() || limit < 0.0 {
        return Err(usage(format!("--max-distance {limit}: a distance is not negative")));
    }
    args.page.check(&args.scenes.paths())?;
    let motion = args.scenes.motion(streams)?;
    let formats = args.scenes.formats()?;
    let session = args.threads.start(streams)?;
    let files = args.scenes.read(&session, formats)?;
    let mut options = PairOptions::default().with_max_distance(limit);
    options.motion.clone_from(&motion);
    let progress = Progress::start(streams, "comparing", None, Unit::None);
    let soups = files.each_ref().map(|file| &*file.scene.soup);
    let (found, notes) = session.pool.install(|| {
        let build = |k: usize| AabbTree::<f64, &Soup<f64>>::new(soups[k]).with_context(|| files[k].name.clone());
        let indexes = [build(0)?, build(1)?];
        Ok::<_, anyhow::Error>(match args.solid {
            true => closest_pair_of_solids(&indexes, soups, &options),
            false => (indexes[0].closest_pair(&indexes[1], &options), [None, None]),
        })
    })?;
    for (file, note) in files.iter().zip(&notes) {
        if let Some(note) = note {
            streams.print_summary(format_args!("warning  {}: {note}\n", file.name));
        }
    }
    drop(progress);
    args.page.write(streams, || {
        let unit = args.page.unit();
        let measure = |pair: &ClosestPair<f64>| {
            let name = if pair.is_intersecting { "a common point" } else { "distance" };
            Measure { name: name.to_owned(), ends: pair.points, length: pair.distance }
        };
        let verdict = match &found {
            Some(pair) if pair.is_intersecting => "The scenes intersect.".to_owned(),
            Some(pair) => format!("The scenes are {} {unit} apart.", Figure(pair.distance)),
            None => "Nothing is near.".to_owned(),
        };
        let (paths, scenes) = (args.scenes.paths(), files.each_ref().map(|file| &file.scene));
        let (motion, found) = (motion.as_ref(), PairResult::Measures(found.iter().map(measure).collect()));
        PairPage { paths, scenes, motion, title: "Distance", verdict, remarks: Vec::new(), found }
    })?;
    if args.json {
        return json::print_report(streams, "distance", [report(&files, found.as_ref(), limit, args.solid)]);
    }
    Output::print(streams, text(&files, found.as_ref(), limit))
}

/// Returns the nearest pair of two scenes whose inside counts, with a note on each scene whose inside is a guess, or
/// that has none because of what is beside its triangles.
fn closest_pair_of_solids<'a>(
    indexes: &[AabbTree<f64, &'a Soup<f64>>; 2],
    soups: [&'a Soup<f64>; 2],
    options: &PairOptions<f64>,
) -> (Option<ClosestPair<f64>>, [Option<String>; 2]) {
    // Segments and points have no inside.
    let signed = [0, 1].map(|k| SignedDistance::new(&indexes[k], soups[k]));
    let notes = [0, 1].map(|k: usize| match &signed[k] {
        Ok(signed) => signed.note().map(str::to_owned),
        Err(error) if !soups[k].triangles().is_empty() => Some(format!("{error}: nothing of it counts as filled")),
        Err(_) => None,
    });
    let signed = signed.map(Result::ok);
    let inside = signed
        .each_ref()
        .map(|signed| move |point: &Point3<f64>| signed.as_ref().is_some_and(|signed| signed.contains(point)));
    let parts = soups.map(Parts::of);
    let solid = |k: usize| Solid::new(&indexes[k], &parts[k], Some(&inside[k]));
    (solid(0).closest_pair(&solid(1), options), notes)
}

fn text(files: &[SceneFile; 2], found: Option<&ClosestPair<f64>>, limit: f64) -> String {
    let Some(pair) = found else {
        let is_empty = files.iter().any(|file| file.scene.soup.is_empty());
        return if is_empty { "a scene is empty\n".to_owned() } else { format!("nothing is within {limit}\n") };
    };
    let mut lines = if pair.is_intersecting {
        "the scenes intersect\n".to_owned()
    } else {
        let (distance, error) = (Length(pair.distance), Figure(pair.distance - pair.lower_bound));
        format!("distance {distance}, at most {error} too large\n")
    };
    for (k, file) in files.iter().enumerate() {
        lines += &line_of_point(file, pair.points[k], pair.primitives[k], Some(pair.features[k]));
    }
    lines
}

fn report(files: &[SceneFile; 2], found: Option<&ClosestPair<f64>>, limit: f64, is_solid: bool) -> Value {
    let side = |k: usize| {
        let found = found.map(|pair| {
            let feature = json!({ "feature": pair.features[k].to_string() });
            report_of_point(&files[k].scene, pair.points[k], pair.primitives[k], feature)
        });
        json!({ "file": files[k].name, "format": files[k].format.name(), "nearest": found })
    };
    // Scenes with primitives of which none are near do not intersect.
    let are_apart = found.is_none() && files.iter().all(|file| !file.scene.soup.is_empty());
    json!({
        "scenes": [side(0), side(1)],
        "max_distance": json::number(limit),
        "solid": is_solid,
        "distance": found.map(|pair| json::number(pair.distance)),
        "lower_bound": found.map(|pair| pair.lower_bound).or(are_apart.then_some(limit)).map(json::number),
        "intersect": found.map(|pair| pair.is_intersecting).or(are_apart.then_some(false)),
    })
}
