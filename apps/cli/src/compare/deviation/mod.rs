//! `p2m deviation`: how far the points of a scan are from a scene.

mod answers;
mod hints;
mod report;

use crate::answers::{AnswerColumn, AnswerEncoder, AnswerFormat, IndexSummary, RunSummary, listed};
use crate::compare::align::{self, move_scan};
use crate::compare::scan::ScanArgs;
use crate::index::{BackendChoice, PreparedIndex, SignRule, backend_choices};
use crate::io::input::name;
use crate::io::usage::{finite_not_negative, not_negative, number_that, positive, usage};
use crate::io::{Output, Progress, SceneArgs, SceneFile, Session, Streams, ThreadArgs, Unit, input, is_standard, json};
use crate::page::{OpenArgs, PageArgs};
use answers::{Answers, Filter, Signs};
use anyhow::anyhow;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, QueryRegion, Workload};
use p2m_field::align::{AlignOptions, Alignment};
use p2m_field::deviation::{LocalPlanes, isolated_points, on_vertices, primitives_of_positions};
use p2m_field::sign::SignError;
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::{Count, Figure};
use report::{Compared, DeviationReport};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

const HELP: &str = "\
The deviation of a point is its distance from the surface of the scene, positive outside and negative inside. The \
points are those of the file of the scan, or all vertices of a mesh, each once, also if no triangle uses them.

If the surface is open or inconsistently oriented, a warning says which rule decides what is inside. On an open \
surface, inside and outside are ambiguous near holes, and both sides of a single sheet are outside. Segments and \
points have no inside: use --unsigned.

A scene of points alone has a side by the planes through each point and its eleven nearest others: deviations are then \
distances from these planes, positive above or outside. --unsigned returns the distances from the points.

Statistics go to the standard output, for each named object of the scene as well. With --require, the last line is the \
verdict, and the exit code is 3 if it is FAIL. Points that are not finite, whose side is not defined, or that an option \
leaves out, have no deviation and are in no statistics. With --on-part, all results are about the vertices of the scene, \
each with the mean deviation of the points around it.

A CSV file is the table of `p2m query --signed`, where signed_distance is the deviation, with the ids of the scan if \
it has a column id. A PLY file is the scan with \
the property deviation and colours from blue (inside) over grey to red (outside). An HTML file is a page that any \
browser opens without a network, with the coloured scan, the scene, a histogram and the statistics; --open opens it. \
PNG and PDF files are a report on one sheet.

Examples:
  p2m deviation scan.ply part.stl --tolerance 0.05
  p2m deviation scan.xyz part.obj --tolerance 0.05 --unit mm --out page.html
  p2m deviation scan.ply part.stl --align --tolerance 0.05 --require 99 --head Operator=Li --out report.pdf
  p2m deviation print.stl design.stl --out deviations.csv --json
  p2m deviation points.npy cables.obj --unsigned --limit 0.2 --out coloured.ply";

/// Compare a scan with a scene: statistics, colours and a histogram
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    scan: ScanArgs,

    #[command(flatten)]
    scene: SceneArgs,

    /// Move the scan onto the scene first, as `p2m align` does
    #[arg(long)]
    align: bool,

    /// Compute distances without signs; needed for segments and points
    #[arg(long, conflicts_with = "sign")]
    unsigned: bool,

    /// Which points are inside
    #[arg(long, value_name = "RULE", value_enum, default_value = "auto")]
    sign: SignRule,

    /// Count the points outside of this tolerance, in the unit of the scene
    #[arg(long, value_name = "LENGTH", value_parser = finite_not_negative, allow_negative_numbers = true)]
    tolerance: Option<f64>,

    /// Fail with exit code 3 unless this percentage of the points is within the tolerance
    #[arg(long, value_name = "PERCENT", value_parser = percent, requires = "tolerance", allow_negative_numbers = true)]
    require: Option<f64>,

    /// Show the vertices of the scene, with the mean deviations of the points around them
    #[arg(long)]
    on_part: bool,

    /// Leave out isolated points of the scan, such as dust
    #[arg(long)]
    drop_isolated: bool,

    /// Leave out points that are farther from the scene
    #[arg(long = "max-distance", value_name = "LENGTH", value_parser = not_negative, default_value_t = f64::INFINITY, hide_default_value = true, allow_negative_numbers = true)]
    farthest: f64,

    /// The deviation at the ends of the colour scale [default: three tolerances, or the 95th percentile]
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    limit: Option<f64>,

    /// Write a table (.csv), a coloured scan (.ply), a page (.html) or a report (.pdf, .png)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Write only points outside of the tolerance to the table, with their numbers
    #[arg(long, requires_all = ["tolerance", "out"])]
    only_outside: bool,

    /// Write the histogram as a table (.csv)
    #[arg(long, value_name = "FILE")]
    histogram: Option<PathBuf>,

    /// Add a line to the head of a report or page, such as Part=Bracket or Date=2026-05-04
    #[arg(long, value_name = "NAME=VALUE", value_parser = head)]
    head: Vec<(String, String)>,

    /// The index to search [default: the saved index, or auto]
    #[arg(long, value_parser = backend_choices())]
    backend: Option<BackendChoice>,

    #[command(flatten)]
    page: PageArgs,

    #[command(flatten)]
    open: OpenArgs,

    /// Report as one JSON object on the standard output, instead of the table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: ThreadArgs,
}

p2m_core::formats! {
    /// The formats of files of deviations.
    DeviationFormat {
        /// A table of answers.
        Csv = "csv",
        /// The scan with a number and a colour for each vertex.
        Ply = "ply",
        /// A page for browsers.
        Html = "html" | "htm",
        /// A report on one sheet, as a picture.
        Png = "png",
        /// A report on one sheet.
        Pdf = "pdf",
    }
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let out_format = args.check()?;
    let scan_format = args.scan.format()?;
    let format = args.scene.format()?;
    let session = args.threads.start(streams)?;
    let start = Instant::now();
    let mut file = args.scene.read(&session, format)?;
    let has_table = out_format == Some(DeviationFormat::Csv) && !args.on_part;
    let (mut scan, ids) = args.scan.read(&session, scan_format, has_table)?;
    file.read_time = start.elapsed();
    let scene = &file.scene;
    if let Some(note) = hints::note_on_sizes(&scan.soup, &scene.soup).filter(|_| !args.align) {
        streams.print_summary(format_args!("warning  {note}\n"));
    }
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = args.out.as_ref().map(|out| Output::open(streams, Some(out))).transpose()?;

    let start = Instant::now();
    let prepared = args.prepare(&session, &file, scan.soup.positions())?;
    let index = &*prepared.built.index;
    let alignment = args.place(&session, (&file, index), &mut scan)?;
    let signs = args.signs(&session, index, scene)?;
    let points = scan.soup.positions();
    let filter = args.filter(args.isolated(&session, points));
    let build_time = start.elapsed();

    let barycentric = args.on_part.then(Vec::new);
    let mut answers =
        Answers { index, signs: &signs, filter: &filter, values: Vec::new(), primitives: Vec::new(), barycentric };
    let encoder = has_table.then(|| {
        let columns = args.columns(scene, ids.is_some());
        AnswerEncoder::new(AnswerFormat::Csv, &scene.objects, columns).with_ids(ids)
    });
    let query_time = answers.add(&session, points, encoder.as_ref().zip(output.as_mut()))?;
    let Answers { mut values, mut primitives, barycentric, .. } = answers;
    if let Some(barycentric) = barycentric {
        values = on_vertices(&scene.soup, &primitives, &barycentric, &values);
        primitives = primitives_of_positions(&scene.soup);
    }
    let (rule, backend) = (signs.rule(), prepared.backend.name);
    let shown = if args.on_part { scene } else { &scan };
    let compared = Compared { scan: shown, scene, values: &values, primitives: &primitives, rule, backend };
    let report = DeviationReport::new(args, compared);
    let bytes = output.zip(out_format).map_or(Ok(0), |(mut output, format)| {
        report.write(format, &mut output)?;
        let bytes = output.bytes();
        output.finish().map(|()| bytes)
    })?;
    if let Some(path) = &args.histogram {
        Output::open(streams, Some(path))?.finish_with(report.histogram())?;
    }

    let index = IndexSummary::new(&file, backend, Some(&prepared), build_time);
    let run = RunSummary { index, threads: session.pool.current_num_threads(), query_time };
    if args.json {
        let scan = json!({
            "file": name(&args.scan.path),
            "format": scan_format.name(),
            "points": points.len(),
            "skipped": json::skipped(&scan.skipped),
        });
        let compared = json!({ "scan": scan, "alignment": alignment.as_ref().map(align::report) });
        let out = args.out.as_deref().zip(out_format);
        let out =
            out.map(|(out, format)| json!({ "file": input::shown(out), "format": format.name(), "bytes": bytes }));
        run.print_json(streams, "deviation", json::joined([compared, report.json()]), &json!(out))?;
    } else {
        let mut text = run.text("points", "point", points.len() as u64);
        if !scan.skipped.is_empty() {
            text += &format!("note     of the scan is skipped: {}\n", listed(&scan.skipped));
        }
        if args.drop_isolated {
            let count = Count((0..points.len()).filter(|i| filter.is_left_out(*i)).count() as u64);
            text += &format!("dropped  {count} isolated points\n");
        }
        if let Some(found) = &alignment {
            text += &format!("aligned  rms {}, coverage {} %\n", Figure(found.rms), Figure(100.0 * found.coverage));
        }
        if let Some(out) = &args.out {
            text += &format!("written  {}, {bytes} bytes\n", out.display());
        }
        streams.print_summary(format_args!("{text}"));
        Output::print(streams, report.table())?;
    }
    args.open.show(args.out.as_deref())?;
    if report.passes() == Some(false) { Err(NotPassed.into()) } else { Ok(()) }
}

/// A comparison whose points are not within the tolerance as often as required. The report says so.
#[derive(Debug)]
pub(crate) struct NotPassed;

impl std::fmt::Display for NotPassed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("too few points are within the tolerance")
    }
}

impl std::error::Error for NotPassed {}

/// Parses a percentage.
fn percent(text: &str) -> Result<f64, String> {
    number_that(text.trim_end_matches('%').trim(), |x| (0.0..=100.0).contains(x), "number from 0 to 100")
}

/// Parses a name and a value.
fn head(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("not a name and a value, such as Operator=Li")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

impl Args {
    /// Refuses combinations of arguments that contradict each other, and returns the format of the file, if
    /// there is one.
    fn check(&self) -> anyhow::Result<Option<DeviationFormat>> {
        if self.out.as_deref().is_some_and(is_standard) {
            return Err(usage("the statistics go to the standard output, so the deviations need a file: --out FILE"));
        }
        let format = self.out.as_deref().map(DeviationFormat::from_path).transpose()?;
        if self.open.open && format != Some(DeviationFormat::Html) {
            return Err(usage("--open needs a page: --out FILE.html"));
        }
        self.scan.refuse_same_input(&self.scene)?;
        let inputs: [&Path; 2] = [&self.scan.path, &self.scene.path];
        for out in self.out.iter().chain(&self.histogram) {
            Output::refuse_inputs(out, &inputs)?;
        }
        if self.only_outside && format != Some(DeviationFormat::Csv) {
            return Err(usage("--only-outside needs a table: --out FILE.csv"));
        }
        if self.histogram.as_deref().is_some_and(|path| is_standard(path) || Some(path) == self.out.as_deref()) {
            return Err(usage("--histogram needs a file of its own"));
        }
        Ok(format)
    }

    /// Returns which points count and which are written, given those that are left out.
    fn filter(&self, left_out: Vec<bool>) -> Filter {
        let beyond = self.tolerance.filter(|_| self.only_outside).unwrap_or(-1.0);
        Filter { left_out, max_distance: self.farthest, beyond }
    }

    /// Loads or builds the index to search for the points of a scan.
    fn prepare(
        &self,
        session: &Session<'_>,
        file: &SceneFile,
        points: &[Point3<f64>],
    ) -> anyhow::Result<PreparedIndex> {
        // A scan that is moved first will be like the scene.
        let region = if self.align { QueryRegion::SceneBox } else { QueryRegion::Like(points) };
        let chosen =
            file.choose(session, self.backend, &Workload::new(points.len() as u64, region).with_needs_index(true))?;
        file.prepare(session, chosen)
    }

    /// Moves the scan onto the scene if that was asked for. Otherwise a warning says if it seems to be elsewhere.
    fn place(
        &self,
        session: &Session<'_>,
        (file, index): (&SceneFile, &dyn AnyIndex),
        scan: &mut Scene,
    ) -> anyhow::Result<Option<Alignment>> {
        if self.align {
            return move_scan(session, &self.scan.path, scan, (file, index), &AlignOptions::default()).map(Some);
        }
        let (points, unit) = (scan.soup.positions(), &self.page.unit);
        if let Some(note) = session.pool.install(|| hints::note_on_place(points, &file.scene.soup, index, unit)) {
            session.streams.print_summary(format_args!("warning  {note}\n"));
        }
        Ok(None)
    }

    /// Returns which points of a scan are left out as isolated ones.
    fn isolated(&self, session: &Session<'_>, points: &[Point3<f64>]) -> Vec<bool> {
        if !self.drop_isolated {
            return Vec::new();
        }
        let _progress = Progress::start(session.streams, "looking for isolated points", None, Unit::None);
        session.pool.install(|| isolated_points(points))
    }

    /// Prepares what gives deviations their signs. A warning says if the rule auto is a guess.
    fn signs<'a>(&self, session: &Session<'_>, index: &'a dyn AnyIndex, scene: &'a Scene) -> anyhow::Result<Signs<'a>> {
        if self.unsigned {
            return Ok(Signs::None);
        }
        if self.sign == SignRule::Auto {
            let _progress = Progress::start(session.streams, "fitting planes", None, Unit::None);
            if let Some(planes) = session.pool.install(|| LocalPlanes::new(&scene.soup, index)) {
                return Ok(Signs::Planes(planes));
            }
        }
        let signed =
            self.sign.prepare(session.streams, index, &scene.soup).map_err(|error| self.without_sign(error))?;
        if let Some(note) = signed.note().filter(|_| self.sign == SignRule::Auto) {
            session.streams.print_summary(format_args!("warning  {}: {note}\n", self.scene.name()));
        }
        Ok(Signs::Surface(signed))
    }

    /// Returns the columns of the table, which are those of `p2m query --signed`, after numbers if points are missing,
    /// and after ids if the scan has them.
    fn columns(&self, scene: &Scene, has_ids: bool) -> Vec<AnswerColumn> {
        let columns = AnswerColumn::defaults(AnswerFormat::Csv, !scene.objects.is_empty(), !self.unsigned);
        let number = self.only_outside.then_some(AnswerColumn::Number);
        number.into_iter().chain(has_ids.then_some(AnswerColumn::Id)).chain(columns).collect()
    }

    /// Returns the error of a scene that has no sign by the rule.
    fn without_sign(&self, error: SignError) -> anyhow::Error {
        let advice = match error {
            SignError::OtherKinds { .. } => ": add --unsigned for distances without signs",
            SignError::Open { .. } => ": see --sign and --unsigned",
            _ => "",
        };
        anyhow!("{}: {error}{advice}", self.scene.name())
    }
}
