//! `p2m align`: moves a scan onto a scene.

use crate::compare::scan::ScanArgs;
use crate::index::{Backend, backends};
use crate::io::input::name;
use crate::io::usage::number_that;
use crate::io::{
    Output, Progress, SceneArgs, SceneFile, Session, Streams, ThreadArgs, Unit, is_standard, json, shown, usage,
};
use crate::page::{PairPage, PairPageArgs, PairResult};
use crate::scene::convert::Target;
use anyhow::{Context, anyhow};
use nalgebra::Point3;
use p2m_backends::AnyIndex;
use p2m_core::{Aabb, PrimitiveSet};
use p2m_field::align::{AlignError, AlignOptions, Alignment, Ambiguity, align};
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::{Count, Figure};
use p2m_page::Moved;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const HELP: &str = "\
The scan is rotated and moved so that its points are as near to the surface of the scene as possible: by iterative \
closest points with distances to planes, from several starts. Outliers of up to a third of the points have no weight. \
For a scan that has more than the part, --overlap is the part of its points that lie on it.

The table has the root mean square of the distances (rms), the part of the points that are no outliers (coverage), and \
the matrix. A warning says if another pose would fit about as well.

Examples:
  p2m align scan.ply part.stl --out aligned.ply
  p2m align scan.xyz part.obj --overlap 0.6 --matrix pose.txt
  p2m align scan.ply part.stl --html page.html --open
  p2m align scan.npy part.ply --scale --json";

/// Move a scan onto a scene
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scan: ScanArgs,

    #[command(flatten)]
    scene: SceneArgs,

    /// The part of the scan's points that lie on the scene, above 0 and at most 1
    #[arg(long, value_name = "PART", value_parser = part, default_value_t = 1.0, allow_negative_numbers = true)]
    overlap: f64,

    /// Scale the scan as well
    #[arg(long)]
    scale: bool,

    /// The scan is nearly in place: try no other start
    #[arg(long)]
    near: bool,

    /// Minimise distances between points, which suits scenes of points
    #[arg(long)]
    point_to_point: bool,

    /// Write the moved scan, in the format of the extension
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Write the matrix, row by row, as --transform of other commands reads it
    #[arg(long, value_name = "FILE")]
    matrix: Option<PathBuf>,

    /// The index to search [default: the saved index, or aabb]
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

impl Args {
    fn options(&self) -> AlignOptions {
        AlignOptions::default()
            .with_overlap(self.overlap)
            .with_scale(self.scale)
            .with_search(!self.near)
            .with_point_to_point(self.point_to_point)
    }
}

/// Parses a part of a whole.
fn part(text: &str) -> Result<f64, String> {
    number_that(text, |x| *x > 0.0 && *x <= 1.0, "number above 0 and at most 1")
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    for out in [&args.out, &args.matrix].into_iter().flatten() {
        if is_standard(out) {
            return Err(usage("the result goes to the standard output, so other output needs a file"));
        }
        Output::refuse_inputs(out, &[&args.scan.path, &args.scene.path])?;
    }
    args.page.check(&[&args.scan.path, &args.scene.path])?;
    args.scan.refuse_same_input(&args.scene)?;
    let target = args.out.as_deref().map(|out| Target::by_extension(streams, out)).transpose()?;
    let scan_format = args.scan.format()?;
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let file = args.scene.read(&session, format)?;
    let (mut scan, _) = args.scan.read(&session, scan_format, false)?;
    let index = file.prepare(&session, args.backend.unwrap_or_else(|| file.backend()))?.built.index;
    let before = scan.soup.aabb();
    let found = move_scan(&session, &args.scan.path, &mut scan, (&file, &*index), &args.options())?;
    let written = target.map(|target| target.write(streams, &scan)).transpose()?;
    if let Some(path) = &args.matrix {
        Output::open(streams, Some(path))?.finish_with(rows(&found, ""))?;
    }
    drop(index);
    args.page.write(streams, || {
        let rms = besides_rounding(found.rms, args.page.unit(), &before);
        let verdict = format!("{rms} root mean square distance.");
        let remarks = warnings(&found).map(|warning| format!("Warning: {warning}.")).collect();
        let mut facts = vec![("root mean square", found.rms), ("coverage in %", 100.0 * found.coverage)];
        facts.extend(args.scale.then_some(("scale", found.scale)));
        let moved = Moved { matrix: found.matrix, facts };
        let found = PairResult::Moved { moved, before };
        let (paths, scenes) = ([&*args.scene.path, &*args.scan.path], [&file.scene, &scan]);
        PairPage { paths, scenes, motion: None, title: "Alignment", verdict, remarks, found }
    })?;
    if args.json {
        let head = json!({
            "scan": { "file": name(&args.scan.path), "format": scan_format.name(), "points": scan.soup.positions().len() },
            "scene": { "file": file.name, "format": format.name() },
        });
        let end = json!({
            "out": written.map(|written| written.json()),
            "matrix_file": args.matrix.as_deref().map(shown),
        });
        return json::print_report(streams, "align", [head, report(&found), end]);
    }
    if let Some(written) = written {
        streams.print_summary(format_args!("{}", written.text()));
    }
    Output::print(streams, text(&found, args.scale))
}

/// Moves the points of a scan onto a scene, which is given with its index. A warning says if the result is doubtful.
pub(crate) fn move_scan(
    session: &Session<'_>,
    scan_path: &Path,
    scan: &mut Scene,
    (file, index): (&SceneFile, &dyn AnyIndex),
    options: &AlignOptions,
) -> anyhow::Result<Alignment> {
    let progress = Progress::start(session.streams, "aligning", None, Unit::None);
    let points: &[Point3<f64>] = scan.soup.positions();
    let found = session
        .pool
        .install(|| align(&*file.scene.soup, index, points, options, &mut |_| ControlFlow::Continue(())))
        .map_err(|error| match error {
            AlignError::EmptyScene | AlignError::NoSize => anyhow!("{}: {error}", file.name),
            _ => anyhow!("{}: {error}", name(scan_path)),
        })?;
    drop(progress);
    for warning in warnings(&found) {
        session.streams.print_summary(format_args!("warning  {}: {warning}\n", name(scan_path)));
    }
    let moved = Arc::make_mut(&mut scan.soup).map_positions(|point| found.apply(&point));
    moved.with_context(|| format!("{}: moved", name(scan_path)))?;
    Ok(found)
}

/// The size relative to that of a scan below which a length is an error of rounding.
const ROUNDING: f64 = 1e-12;

/// Returns a length with its unit for a sentence about a scan with this box. An error of rounding is called so.
fn besides_rounding(length: f64, unit: &str, aabb: &Aabb<f64>) -> String {
    if length < ROUNDING * (aabb.max - aabb.min).norm() {
        format!("0 {unit} (rounding: {length:.0e})")
    } else {
        format!("{} {unit}", Figure(length))
    }
}

/// Returns the reasons to doubt an alignment.
fn warnings(found: &Alignment) -> impl Iterator<Item = String> {
    let ambiguity = found.ambiguity.map(|ambiguity| ambiguity.to_string());
    ambiguity.into_iter().chain((!found.is_converged).then(|| "the alignment did not converge".to_owned()))
}

/// Returns the matrix as lines of four numbers.
fn rows(found: &Alignment, indent: &str) -> String {
    let mut text = String::new();
    for row in found.matrix.row_iter() {
        let numbers: Vec<String> = row.iter().map(ToString::to_string).collect();
        // Writing to a string does not fail.
        let _ = writeln!(text, "{indent}{}", numbers.join(" "));
    }
    text
}

fn text(found: &Alignment, is_scaled: bool) -> String {
    let scale = if is_scaled { format!("scale     {}\n", found.scale) } else { String::new() };
    format!(
        "rms       {}\ncoverage  {} %\n{scale}rounds    {}\nmatrix\n{}",
        Figure(found.rms),
        Figure(100.0 * found.coverage),
        Count(found.rounds.len() as u64),
        rows(found, "  ")
    )
}

/// Returns the part of a report about an alignment.
pub(crate) fn report(found: &Alignment) -> Value {
    let rows = |matrix: &nalgebra::Matrix4<f64>| -> Value {
        matrix.row_iter().map(|row| row.iter().copied().map(json::number).collect::<Value>()).collect()
    };
    let rounds = found.rounds.iter().map(
        |round| json!({ "points": round.points, "rms": json::number(round.rms), "step": json::number(round.step) }),
    );
    let ambiguity = found.ambiguity.as_ref().map(|ambiguity| match ambiguity {
        Ambiguity::Sliding { eigenvalue } => json!({ "kind": "sliding", "eigenvalue": json::number(*eigenvalue) }),
        Ambiguity::OtherPose { matrix } => json!({ "kind": "other_pose", "matrix": rows(matrix) }),
        _ => Value::Null,
    });
    json!({
        "matrix": rows(&found.matrix),
        "scale": json::number(found.scale),
        "rms": json::number(found.rms),
        "coverage": json::number(found.coverage),
        "converged": found.is_converged,
        "rounds": rounds.collect::<Value>(),
        "ambiguity": ambiguity,
    })
}
