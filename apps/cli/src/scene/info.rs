//! `p2m info`: reports the content of a scene.

use crate::io::input::{SceneArgs, SceneFile};
use crate::io::json;
use crate::io::output::Output;
use crate::io::progress::{Progress, Unit};
use crate::io::streams::Streams;
use crate::io::threads::ThreadArgs;
use crate::scene::smallest_build::SmallestBuild;
use p2m_backends::BackendEntry;
use p2m_formats::FileFormat;
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::{Count, Exact, Figure, Share};
use p2m_mixed::statistics::{Counts, Extremes, ObjectCounts, Statistics, objects};
use serde_json::{Value, json};
use std::fmt::{self, Write as _};

/// Describe a scene and report likely problems
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

const HELP: &str = "\
A triangle has no area if its vertices are exactly collinear. Two positions or edges are equal if their coordinates \
are. The aspect ratio of a triangle is its longest edge divided by the height onto that edge: above 10 it is thin, \
above 1024 it is a sliver. Edges are the sides of triangles, and segments. The build has the features that a Rust \
program needs of the crate p2m to read the file and search it, and the number of crates that they compile.

Examples:
  p2m info scene.obj
  p2m info scan.ply --json
  p2m generate skewed-gear | p2m info - --format obj";

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let format = args.scene.format()?;
    let session = ThreadArgs::default().start(streams)?;
    let SceneFile { scene, saved, .. } = args.scene.read(&session, format)?;
    let backend = saved.as_ref().and_then(BackendEntry::from_saved).unwrap_or_else(BackendEntry::default_backend);
    let build = SmallestBuild::new(backend, format);
    let index = saved.and_then(|reader| p2m_core::storage::kind(&reader).ok());
    let progress = Progress::start(streams, "counting", None, Unit::None);
    let statistics = Statistics::of(&scene.soup);
    let objects = objects(&scene);
    drop(progress);
    let name = args.scene.name();
    if args.json {
        return json::print(streams, &report(&name, format, index, &scene, &objects, &statistics, &build));
    }
    let report = TextReport { name, format, index, scene: &scene, objects: &objects, statistics: &statistics, build };
    Output::print(streams, report.to_string())
}

fn report(
    name: &str,
    format: FileFormat,
    index: Option<String>,
    scene: &Scene,
    objects: &[ObjectCounts],
    s: &Statistics,
    build: &SmallestBuild,
) -> Value {
    let [crates, default_crates] = build.crates();
    let extremes = |e: Option<Extremes>| e.map(|e| json!({ "min": e.min, "max": e.max }));
    let corner = |p: nalgebra::Point3<f64>| [p.x, p.y, p.z];
    json!({
        "p2m": "info",
        "version": json::VERSION,
        "file": name,
        "format": format.name(),
        "index": index,
        "primitives": json::counts(&s.primitives),
        "objects": objects.iter().map(|o| {
            json!({ "name": o.name, "primitives": json::counts(&o.primitives) })
        }).collect::<Value>(),
        "positions": {
            "total": s.positions.total,
            "used": s.positions.used,
            "distinct": s.positions.distinct,
        },
        "bounds": s.bounds.map(|b| json!({ "min": corner(b.min), "max": corner(b.max) })),
        "diagonal": json::number(s.sizes.diagonal),
        "edge_length": extremes(s.sizes.edge),
        "area": extremes(s.sizes.area),
        "shapes": {
            "zero_area": s.shapes.zero_area,
            "zero_length": s.shapes.zero_length,
            "slivers": s.shapes.slivers,
            "thin": s.shapes.thin,
            "median_aspect": s.shapes.median_aspect,
        },
        "duplicates": json::counts(&s.duplicates),
        "edges": {
            "total": s.edges.total,
            "boundary": s.edges.boundary,
            "non_manifold": s.edges.non_manifold,
            "inconsistent": s.edges.inconsistent,
        },
        "closed": s.edges.is_closed(),
        "components": s.components,
        "location": {
            "distance_from_origin": json::number(s.location.distance_from_origin),
            "largest_coordinate": json::number(s.location.largest_coordinate),
            "beyond_f32": s.location.beyond_f32,
            "f32_step": s.location.f32_step(),
            "f64_step": json::number(s.location.f64_step()),
        },
        "skipped": json::skipped(&scene.skipped),
        "build": { "features": build.features, "crates": crates, "default_crates": default_crates },
        "unit": scene.unit.map(|unit| unit.to_string()),
        "notes": s.notes().iter().map(|n| json!({ "name": n.name(), "text": n.to_string() })).collect::<Value>(),
    })
}

/// The report as text for people.
struct TextReport<'a> {
    name: String,
    format: FileFormat,
    /// The kind of the index in a saved file.
    index: Option<String>,
    scene: &'a Scene,
    objects: &'a [ObjectCounts],
    statistics: &'a Statistics,
    build: SmallestBuild,
}

/// The largest number of objects that are listed one by one.
const MAX_LISTED_OBJECTS: usize = 20;
/// The width of the labels of lines, in columns.
const LABEL_WIDTH: usize = 12;

impl fmt::Display for TextReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = self.statistics;
        let mut line = |label: &str, text: &str| writeln!(f, "{label:LABEL_WIDTH$}{text}");
        line("scene", &format!("{} ({})", self.name, self.format))?;
        if let Some(index) = &self.index {
            line("index", index)?;
        }
        line("primitives", &counted(&s.primitives))?;
        for (i, object) in self.objects.iter().enumerate().take(MAX_LISTED_OBJECTS) {
            let name = object.name.as_deref().map_or_else(|| "(without a name)".to_owned(), printable);
            line(if i == 0 { "objects" } else { "" }, &format!("{name}: {}", counted(&object.primitives)))?;
        }
        if self.objects.len() > MAX_LISTED_OBJECTS {
            line("", &format!("and {} more", Count((self.objects.len() - MAX_LISTED_OBJECTS) as u64)))?;
        }
        if let Some(unit) = self.scene.unit {
            line("unit", &unit.to_string())?;
        }
        line("positions", &positions(s))?;
        if let Some(b) = &s.bounds {
            let corner = |p: nalgebra::Point3<f64>| {
                let [x, y, z] = [p.x, p.y, p.z].map(|x| coordinate(x, s));
                format!("({x}, {y}, {z})")
            };
            line("box", &format!("{} to {}, diagonal {}", corner(b.min), corner(b.max), Figure(s.sizes.diagonal)))?;
        }
        if let Some(e) = s.sizes.edge {
            line("edges", &range(e))?;
        }
        if let Some(e) = s.sizes.area {
            line("areas", &range(e))?;
        }
        if s.primitives.triangles > 0 {
            line("shapes", &shapes(s))?;
            line("surface", &surface(s))?;
        }
        line("parts", &Count(s.components).to_string())?;
        if s.bounds.is_some() {
            line("in f32", &single(s))?;
        }
        if !self.scene.skipped.is_empty() {
            let list: Vec<String> = self.scene.skipped.iter().map(ToString::to_string).collect();
            line("skipped", &list.join(", "))?;
        }
        line("build", &format!("{}{}", kinds(&s.primitives), self.build))?;
        let notes = s.notes();
        if !notes.is_empty() {
            writeln!(f)?;
        }
        for note in notes {
            writeln!(f, "- {}.", capital(&note.to_string()))?;
        }
        Ok(())
    }
}

/// Escapes control characters of a name, which a file may have.
pub(crate) fn printable(name: &str) -> String {
    name.chars().fold(String::new(), |mut text, c| {
        if c.is_control() {
            text.extend(c.escape_default())
        } else {
            text.push(c)
        }
        text
    })
}

fn capital(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().into_iter().flat_map(char::to_uppercase).chain(rest).collect()
}

/// Returns the numbers of primitives in words, such as `3,600 triangles, 480 segments`.
pub(crate) fn counted(counts: &Counts) -> String {
    let kinds = [(counts.triangles, "triangle"), (counts.segments, "segment"), (counts.points, "point")].map(
        |(count, name)| {
            let plural = if count == 1 { "" } else { "s" };
            (count > 0).then(|| format!("{} {name}{plural}", Count(count)))
        },
    );
    let kinds: Vec<String> = kinds.into_iter().flatten().collect();
    if kinds.is_empty() { "none".to_owned() } else { kinds.join(", ") }
}

/// Returns the kinds of primitives that there are, followed by a colon.
fn kinds(counts: &Counts) -> String {
    let kinds = [(counts.triangles, "triangles"), (counts.segments, "segments"), (counts.points, "points")];
    let kinds: Vec<&str> = kinds.into_iter().filter(|(count, _)| *count > 0).map(|(_, kind)| kind).collect();
    if kinds.is_empty() { String::new() } else { format!("{}: ", kinds.join(", ")) }
}

fn positions(s: &Statistics) -> String {
    let p = &s.positions;
    let mut text = Count(p.total).to_string();
    if p.used < p.total {
        let _ = write!(text, ", {} of them used", Count(p.used));
    }
    if p.distinct < p.used {
        let _ = write!(text, ", {} different", Count(p.distinct));
    }
    text
}

/// Formats a coordinate to a thousandth of the size of the scene or better, so that corners of distant scenes differ.
/// There are no separators of thousands, because commas separate coordinates.
fn coordinate(x: f64, s: &Statistics) -> String {
    // Adding zero turns -0 into 0.
    let (x, size, largest) = (x + 0.0, s.sizes.diagonal, s.location.largest_coordinate);
    if x == 0.0 || size == 0.0 || !(1e-3..1e9).contains(&largest) {
        return Exact(x).to_string();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of digits from 0 to 20")]
    let decimals = (3.0 - size.log10().floor()).clamp(0.0, 20.0) as usize;
    let text = format!("{x:.decimals$}");
    let text = if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn range(extremes: Extremes) -> String {
    let (min, max) = (Figure(extremes.min).to_string(), Figure(extremes.max).to_string());
    if min == max { min } else { format!("{min} to {max}") }
}

fn shapes(s: &Statistics) -> String {
    let of_all = |part: u64| Share { part, whole: s.primitives.triangles };
    let mut text = String::new();
    if let Some(median) = s.shapes.median_aspect {
        let _ = write!(text, "median aspect {}, ", Figure(median));
    }
    let _ = write!(text, "{} thin, {} slivers, ", of_all(s.shapes.thin), of_all(s.shapes.slivers));
    let _ = write!(text, "{} without area", Count(s.shapes.zero_area));
    text
}

fn surface(s: &Statistics) -> String {
    let e = &s.edges;
    if e.is_closed() {
        return format!("closed, {} edges", Count(e.total));
    }
    let parts = [
        (e.boundary, "on the boundary"),
        (e.non_manifold, "of more than two triangles"),
        (e.inconsistent, "between opposite sides"),
    ];
    let mut text = format!("{} edges", Count(e.total));
    for (count, what) in parts.iter().filter(|p| p.0 > 0) {
        let _ = write!(text, ", {} {what}", Count(*count));
    }
    text
}

fn single(s: &Statistics) -> String {
    let (rounded, whole) = (s.location.beyond_f32, 3 * s.positions.distinct);
    match s.location.f32_step() {
        None => "out of range".to_owned(),
        Some(_) if rounded == 0 => "exact".to_owned(),
        Some(step) => {
            format!("{} of {} coordinates are rounded, by up to {}", Count(rounded), Count(whole), Figure(step / 2.0))
        }
    }
}
