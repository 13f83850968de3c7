//! `p2m distance`: finds the nearest points of two scenes.

use crate::input::{name, read_scene_and_index, scene_format};
use crate::json;
use crate::output::Output;
use crate::progress::{Progress, Unit};
use crate::streams::Streams;
use crate::threads::ThreadArgs;
use crate::usage::{one_of, usage};
use anyhow::Context;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::pair::{ClosestPair, PairOptions};
use p2m_core::{BuildIndex, Feature, PrimitiveId, Soup};
use p2m_mixed::{Format, Scene};
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::{Path, PathBuf};

fn help() -> String {
    format!(
        "\
The distance is 0 if the scenes intersect: whether two primitives do is decided without rounding. Only surfaces count, so a \
scene inside of a closed one has the distance from its surface. The lower bound is certified: no two points of the scenes \
are nearer.

{}

Examples:
  p2m distance robot.ply cell.ply
  p2m distance arm.obj cell.obj --transform pose.txt
  p2m distance a.stl b.stl --max-distance 0.01 --json",
        json::STABILITY
    )
}

/// Find the nearest points of two scenes, and whether the scenes intersect
#[derive(clap::Args)]
#[command(after_help = help())]
pub(crate) struct Args {
    /// First scene: an OBJ, PLY, STL or OFF file, or an index that `p2m build` saved; `-` is the standard input. Files
    /// that gzip or zstd has compressed are decompressed
    #[arg(value_name = "A")]
    first: PathBuf,

    /// Second scene
    #[arg(value_name = "B")]
    second: PathBuf,

    /// The format of the first scene, if its extension does not name it
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    format: Option<Format>,

    /// The format of the second scene, if its extension does not name it
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<Format>(Format::NAMES), ignore_case = true)]
    second_format: Option<Format>,

    /// Move the second scene by a rotation and a translation: the 12 or 16 numbers of a matrix, row by row, or a file
    /// that has them
    #[arg(long, value_name = "MATRIX|FILE", allow_hyphen_values = true)]
    transform: Option<String>,

    /// The largest distance of an answer; a search that stays within it takes less time
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true)]
    max_distance: Option<f64>,

    #[command(flatten)]
    threads: ThreadArgs,

    /// Report as one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let limit = args.max_distance.unwrap_or(f64::INFINITY);
    if limit.is_nan() || limit < 0.0 {
        return Err(usage(format!("--max-distance {limit}: a distance is not negative")));
    }
    let motion = args.transform.as_deref().map(parse_motion).transpose()?;
    let formats = [
        scene_format(&args.first, args.format, "--format")?,
        scene_format(&args.second, args.second_format, "--second-format")?,
    ];
    let read = |path: &Path, format| Ok::<_, anyhow::Error>(read_scene_and_index(streams, path, format, false)?.0);
    let scenes = [read(&args.first, formats[0])?, read(&args.second, formats[1])?];
    let names = [&args.first, &args.second].map(|path| name(path));
    let mut options = PairOptions::default().with_max_distance(limit);
    options.motion = motion;
    let progress = Progress::start(streams, "comparing", None, Unit::None);
    let found = args.threads.pool()?.install(|| {
        let build = |k: usize| {
            AabbTree::<f64, &Soup<f64>>::build(&scenes[k].soup, &Default::default()).with_context(|| names[k].clone())
        };
        Ok::<_, anyhow::Error>(build(0)?.closest_pair(&build(1)?, &options))
    })?;
    drop(progress);
    if args.json {
        return json::print(streams, &report(&names, formats, &scenes, found.as_ref(), limit));
    }
    let mut output = Output::open(streams, None)?;
    write!(output, "{}", text(&names, &scenes, found.as_ref(), limit)).with_context(|| output.cannot_write())?;
    output.finish()
}

/// Parses a matrix, or reads it from the file of that name.
fn parse_motion(text: &str) -> anyhow::Result<Isometry3<f64>> {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let words = text.split(|c: char| c.is_whitespace() || ",;[]".contains(c)).filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    let (matrix, place) = match numbers(text) {
        Some(matrix) => (matrix, "--transform".to_owned()),
        None => {
            let content =
                std::fs::read_to_string(text).with_context(|| format!("--transform {text}: cannot be read"))?;
            let matrix = numbers(&content).with_context(|| format!("--transform {text}: has something but numbers"))?;
            (matrix, format!("--transform {text}"))
        }
    };
    let is_affine = matrix.len() == 12 || (matrix.len() == 16 && matrix[12..] == [0.0, 0.0, 0.0, 1.0]);
    if !is_affine {
        let count = matrix.len();
        return Err(usage(format!("{place}: {count} numbers are no matrix of 12, or of 16 with the last row 0 0 0 1")));
    }
    let rotation = Matrix3::from_fn(|row, column| matrix[4 * row + column]);
    let translation = Vector3::from_fn(|row, _| matrix[4 * row + 3]);
    let deviation = (rotation * rotation.transpose() - Matrix3::identity()).amax();
    // The comparison is false for NaN.
    let is_rotation = deviation <= 1e-6 && rotation.determinant() > 0.0;
    if !is_rotation || !translation.iter().all(|x| x.is_finite()) {
        return Err(usage(format!("{place}: the first three columns are no rotation, or a number is not finite")));
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&rotation));
    Ok(Isometry3::from_parts(Translation3::from(translation), rotation))
}

/// Returns the word for the kind of a primitive, and the feature in the words of the program.
fn describe(scene: &Scene, primitive: PrimitiveId, feature: Feature) -> (&'static str, String) {
    let kind = match scene.soup.element(primitive).indices().len() {
        1 => "point",
        2 => "segment",
        _ => "triangle",
    };
    (kind, feature.to_string())
}

fn text(names: &[String; 2], scenes: &[Scene; 2], found: Option<&ClosestPair<f64>>, limit: f64) -> String {
    let Some(pair) = found else {
        let is_empty = scenes.iter().any(|scene| scene.soup.elements().next().is_none());
        return if is_empty { "a scene is empty\n".to_owned() } else { format!("nothing is within {limit}\n") };
    };
    let mut lines = if pair.is_intersecting {
        "the scenes intersect\n".to_owned()
    } else {
        format!("distance {}, certainly at least {}\n", pair.distance, pair.lower_bound)
    };
    for k in 0..2 {
        let (kind, feature) = describe(&scenes[k], pair.primitives[k], pair.features[k]);
        let point = pair.points[k];
        let number = pair.primitives[k].index();
        let object =
            scenes[k].object_of(pair.primitives[k]).map_or(String::new(), |object| format!(" of {}", object.name));
        lines += &format!("{}: {} {} {}, {kind} {number} ({feature}){object}\n", names[k], point.x, point.y, point.z);
    }
    lines
}

fn report(
    names: &[String; 2],
    formats: [Format; 2],
    scenes: &[Scene; 2],
    found: Option<&ClosestPair<f64>>,
    limit: f64,
) -> Value {
    let side = |k: usize| {
        let found = found.map(|pair| {
            let (kind, feature) = describe(&scenes[k], pair.primitives[k], pair.features[k]);
            json!({
                "point": [pair.points[k].x, pair.points[k].y, pair.points[k].z],
                "primitive": pair.primitives[k].index(),
                "kind": kind,
                "feature": feature,
                "object": scenes[k].object_of(pair.primitives[k]).map(|object| &object.name),
            })
        });
        json!({ "file": names[k], "format": formats[k].name(), "nearest": found })
    };
    json!({
        "p2m": "distance",
        "version": json::VERSION,
        "scenes": [side(0), side(1)],
        "max_distance": json::number(limit),
        "distance": found.map(|pair| json::number(pair.distance)),
        "lower_bound": found.map(|pair| json::number(pair.lower_bound)),
        "intersect": found.map(|pair| pair.is_intersecting),
    })
}
