//! `p2m deviation`: how far the points of a scan are from a scene.

use crate::answers::blocks::{BlockSize, QueryStream, Steps, answer_all};
use crate::answers::summary::{IndexSummary, RunSummary, SceneSummary};
use crate::answers::table::{AnswerColumn, AnswerEncoder, AnswerFormat, AnswerRecord, Table};
use crate::compare::align::{self, move_scan};
use crate::compare::scan::ScanArgs;
use crate::index::backend::{BackendChoice, PreparedIndex, SceneSource, backend_choices};
use crate::index::sign_rule::{SignRule, SignedIndex};
use crate::io::input::{SceneArgs, is_standard, name, read_scene_and_index, shown};
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::io::threads::ThreadArgs;
use crate::io::usage::{finite_not_negative, positive, usage};
use crate::page::open::OpenArgs;
use crate::page::source::{PageArgs, about, file_name};
use crate::query::answers::ClosestAnswer;
use anyhow::{Context, anyhow};
use nalgebra::Point3;
use p2m_backends::{AnyIndex, P2mSettings, QueryRegion, Workload};
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, Closest, PrimitiveSet, QueryOptions, Soup};
use p2m_field::align::AlignOptions;
use p2m_field::deviation::{DeviationStatistics, OutsideTolerance, outside};
use p2m_field::sign::SignError;
use p2m_mixed::statistics::figure::{Count, Figure};
use p2m_mixed::{Scene, VertexValues, write_ply_with_values};
use p2m_page::{Deviations, diverging_colour};
use rayon::ThreadPool;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const HELP: &str = "\
The deviation of a point is its distance from the surface of the scene, positive outside and negative inside. The \
points are those of the file of the scan, or all vertices of a mesh, each once, also if no triangle uses them.

If the surface is open or inconsistently oriented, a warning says which rule decides what is inside. On an open \
surface, inside and outside are ambiguous near holes, and both sides of a single sheet are outside. Segments and \
points have no inside: use --unsigned.

Statistics go to the standard output: the mean, the mean magnitude, the root mean square, the standard deviation, \
extremes and percentiles, and with --tolerance the numbers of points above and below it. Points that are not finite, \
or whose side is not defined, are reported as points without a deviation and left out of all statistics.

A CSV file is the table of `p2m query --signed`, where signed_distance is the deviation. A PLY file is the scan with \
the property deviation and colours from blue (inside) over grey to red (outside). An HTML file is a page that any \
browser opens without a network, with the coloured scan, the scene, a histogram and the statistics; --open opens it.

Examples:
  p2m deviation scan.ply part.stl --tolerance 0.05
  p2m deviation scan.xyz part.obj --tolerance 0.05 --unit mm --out page.html
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

    /// The deviation at the ends of the colour scale [default: three tolerances, or the 95th percentile]
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    limit: Option<f64>,

    /// Write a table (.csv), a coloured scan (.ply) or a page (.html)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

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
    }
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let out_format = args.check()?;
    let scan_format = args.scan.format()?;
    let format = args.scene.format()?;
    let pool = args.threads.pool()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &pool, &args.scene.path, format, args.scene.map)?;
    let mut scan = args.scan.read(streams, &pool, scan_format)?;
    let read_time = start.elapsed();
    if let Some(note) = note_on_sizes(&scan.soup, &scene.soup).filter(|_| !args.align) {
        streams.print_summary(format_args!("warning  {note}\n"));
    }
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = args.out.as_ref().map(|out| Output::open(streams, Some(out))).transpose()?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let points = scan.soup.positions();
    // A scan that is moved first will be like the scene.
    let region = if args.align { QueryRegion::SceneBox } else { QueryRegion::Like(points) };
    let workload = Workload::new(points.len() as u64, region);
    let chosen = BackendChoice::resolve(args.backend, saved, &scene.soup, &workload, streams, &pool);
    let chosen = chosen.with_context(|| args.scene.name())?;
    let backend = chosen.backend();
    let source = SceneSource { soup: &scene.soup, kdop_directions: None, p2m: P2mSettings::default(), saved };
    let PreparedIndex { built, is_loaded, reason, .. } =
        source.prepare(streams, chosen, &pool).with_context(|| args.scene.name())?;
    let index = &*built.index;
    let alignment = if args.align {
        let target = (args.scene.name(), &scene, index);
        Some(move_scan(streams, &pool, &args.scan.path, &mut scan, target, &AlignOptions::default())?)
    } else {
        None
    };
    let points = scan.soup.positions();
    let prepare = |rule: SignRule| rule.prepare(streams, index, &scene.soup).map_err(|error| args.without_sign(error));
    let signed = if args.unsigned { None } else { Some(prepare(args.sign)?) };
    let build_time = start.elapsed();
    let rule = signed.as_ref().map(|signed| signed.rule().name());
    if let Some(signed) = signed.as_ref().filter(|_| args.sign == SignRule::Auto)
        && let Some(note) = signed.note()
    {
        streams.print_summary(format_args!("warning  {}: {note}\n", args.scene.name()));
    }

    let mut answers = Answers::new(index, signed.as_ref());
    let query_time = match (&mut output, out_format) {
        (Some(output), Some(DeviationFormat::Csv)) => {
            let encoder = AnswerEncoder::new(AnswerFormat::Csv, &scene.objects, args.columns(&scene));
            answers.add_to_table(streams, &pool, points, &encoder, output)?
        }
        _ => answers.add(streams, &pool, points, |_, _| (), |_, _| Ok(()))?,
    };
    let report = DeviationReport::new(args, &answers.values, rule);
    let bytes = output.map_or(Ok(0), |mut output| {
        match out_format {
            Some(DeviationFormat::Ply) => report.write_ply(&scan, &answers.values, &mut output)?,
            Some(DeviationFormat::Html) => {
                report.write_page(&scan, &scene, &answers, backend.name, &mut output)?;
            }
            Some(DeviationFormat::Csv) | None => {}
        }
        let bytes = output.bytes();
        output.finish().map(|()| bytes)
    })?;

    let summary = SceneSummary::new(args.scene.name(), format, &scene);
    let index = IndexSummary {
        scene: summary,
        backend: backend.name,
        built: Some(&built),
        is_loaded,
        reason,
        read_time,
        build_time,
    };
    let run = RunSummary { index, threads: pool.current_num_threads(), query_time };
    if args.json {
        let out = args.out.as_ref().zip(out_format).map_or(
            Value::Null,
            |(out, format)| json!({ "file": shown(out), "format": format.name(), "bytes": bytes }),
        );
        let scan = json!({
            "file": name(&args.scan.path),
            "format": scan_format.name(),
            "points": points.len(),
            "skipped": json::skipped(&scan.skipped),
        });
        let alignment = json!({ "alignment": alignment.as_ref().map(align::report) });
        let answers = json::joined([json!({ "scan": scan }), alignment, report.json()]);
        args.open.show(args.out.as_deref())?;
        return json::print(streams, &run.json("deviation", answers, &out));
    }
    streams.print_summary(format_args!("{}", run.text("points", "point", points.len() as u64)));
    if !scan.skipped.is_empty() {
        let list: Vec<String> = scan.skipped.iter().map(ToString::to_string).collect();
        streams.print_summary(format_args!("note     of the scan is skipped: {}\n", list.join(", ")));
    }
    if let Some(found) = &alignment {
        let (rms, coverage) = (Figure(found.rms), Figure(100.0 * found.coverage));
        streams.print_summary(format_args!("aligned  rms {rms}, coverage {coverage} %\n"));
    }
    if let Some(out) = &args.out {
        streams.print_summary(format_args!("written  {}, {bytes} bytes\n", out.display()));
    }
    args.open.show(args.out.as_deref())?;
    Output::print(streams, report.table())
}

/// The factors between units of length that are often mixed up, with what they are.
const UNIT_FACTORS: [(f64, &str); 4] = [
    (1000.0, "millimetres and metres"),
    (100.0, "centimetres and metres"),
    (25.4, "millimetres and inches"),
    (39.37, "inches and metres"),
];

/// Returns a sentence if a scan and a scene seem to be in other units or other places.
fn note_on_sizes(scan: &Soup<f64>, scene: &Soup<f64>) -> Option<String> {
    let is_finite = |point: &&Point3<f64>| point.iter().all(|x| x.is_finite());
    let points: Vec<Point3<f64>> = scan.positions().iter().filter(is_finite).copied().collect();
    let (scan, scene) = (Aabb::from_points(&points), scene.aabb());
    if scan.is_empty() || scene.is_empty() {
        return None;
    }
    let [of_scan, of_scene] = [&scan, &scene].map(|bounds| (bounds.max - bounds.min).norm());
    let ratio = of_scan.max(of_scene) / of_scan.min(of_scene);
    if let Some((factor, units)) = UNIT_FACTORS.iter().find(|(factor, _)| (ratio / factor - 1.0).abs() < 0.1) {
        return Some(format!("one of the scan and the scene is about {factor} times as large: {units}?"));
    }
    let gap = |axis: usize| (scan.min[axis] - scene.max[axis]).max(scene.min[axis] - scan.max[axis]);
    (0..3)
        .any(|axis| gap(axis) > of_scene)
        .then(|| "the scan and the scene lie apart: is one of them moved, or in another unit?".to_owned())
}

/// The answers to the points of a scan, and where they come from.
struct Answers<'a> {
    index: &'a dyn AnyIndex,
    signed: Option<&'a SignedIndex<'a>>,
    /// The deviation of each point, or NaN.
    values: Vec<f64>,
    /// The closest primitive of each point.
    primitives: Vec<u32>,
}

impl<'a> Answers<'a> {
    /// Starts without answers.
    fn new(index: &'a dyn AnyIndex, signed: Option<&'a SignedIndex<'a>>) -> Self {
        Self { index, signed, values: Vec::new(), primitives: Vec::new() }
    }

    /// Answers points as [`add`](Self::add) does, and writes their table.
    fn add_to_table(
        &mut self,
        streams: &Streams,
        pool: &ThreadPool,
        points: &[Point3<f64>],
        encoder: &AnswerEncoder<'_>,
        output: &mut Output<'_>,
    ) -> anyhow::Result<Duration> {
        let cannot_write = output.cannot_write();
        let failed = |error| anyhow::Error::new(error).context(cannot_write.clone());
        let mut table = Table::new(output, encoder.header(), Some(points.len() as u64)).map_err(failed)?;
        let encode = |record: &AnswerRecord<'_>, out: &mut Vec<u8>| encoder.encode(record, out);
        let write = |count, records: &[u8]| table.write(count, records).map_err(failed);
        let time = self.add(streams, pool, points, encode, write)?;
        table.finish().map_err(failed)?;
        Ok(time)
    }

    /// Answers points on all threads of a pool, and writes a record of each. Returns the time that the answers took.
    fn add(
        &mut self,
        streams: &Streams,
        pool: &ThreadPool,
        points: &[Point3<f64>],
        encode: impl Fn(&AnswerRecord<'_>, &mut Vec<u8>) + Sync,
        write: impl FnMut(u64, &[u8]) -> anyhow::Result<()>,
    ) -> anyhow::Result<Duration> {
        let Self { index, signed, values, primitives } = self;
        let (index, signed) = (*index, *signed);
        let with_deviation = |(point, answer): (&Point3<f64>, Option<Closest<f64>>)| {
            let deviation = answer.and_then(|answer| match signed {
                Some(signed) => signed.with_sign(point, answer).distance(),
                None => Some(answer.distance),
            });
            (answer, deviation.unwrap_or(f64::NAN))
        };
        let steps = Steps {
            answer: |points: &[Point3<f64>]| {
                let mut answers = vec![None; points.len()];
                let (options, batch) = (QueryOptions::default(), BatchOptions::default());
                batch::closest_points_into(index, points, &options, &batch, &mut answers);
                Ok(points.par_iter().zip(answers).map(with_deviation).collect())
            },
            encode: |number, query: &_, (answer, deviation): &ClosestAnswer, out: &mut _| {
                encode(&AnswerRecord { number, query, answer: answer.as_ref(), signed_distance: *deviation }, out);
                1
            },
            take: |_: &_, (answer, deviation): &ClosestAnswer| {
                values.push(*deviation);
                primitives.push(answer.map_or(u32::MAX, |answer| answer.primitive.number()));
            },
            write,
        };
        let iter = points.iter().copied();
        let queries = QueryStream { name: "points", count: points.len() as u64, iter, block_size: BlockSize::Adaptive };
        answer_all(streams, pool, queries, steps)
    }
}

/// The statistics of a run, as text for people or as JSON for programs.
struct DeviationReport<'a> {
    args: &'a Args,
    statistics: DeviationStatistics,
    outside: Option<OutsideTolerance>,
    limit: f64,
    /// The rule of signs, if there are any.
    rule: Option<&'static str>,
}

impl<'a> DeviationReport<'a> {
    /// Makes the statistics of deviations, to which a rule of signs belongs if there is one.
    fn new(args: &'a Args, values: &[f64], rule: Option<&'static str>) -> Self {
        let statistics = DeviationStatistics::of(values);
        let limit = args.limit.unwrap_or_else(|| Deviations::usual_limit(&statistics, args.tolerance));
        let outside = args.tolerance.map(|tolerance| outside(values, tolerance));
        Self { args, statistics, outside, limit, rule }
    }

    /// Writes the scan with a deviation and a colour for each vertex.
    fn write_ply(&self, scan: &Scene, values: &[f64], output: &mut Output<'_>) -> anyhow::Result<()> {
        let colours: Vec<[u8; 3]> = values.iter().map(|value| diverging_colour(*value, self.limit)).collect();
        let values = VertexValues { name: "deviation", values, colours: &colours };
        write_ply_with_values(scan, &values, &mut *output).with_context(|| output.cannot_write())
    }

    /// Writes the page of the scan and the scene.
    fn write_page(
        &self,
        scan: &Scene,
        scene: &Scene,
        answers: &Answers<'_>,
        backend: &str,
        output: &mut Output<'_>,
    ) -> anyhow::Result<()> {
        let args = self.args;
        let view = args.page.view(scene, &Deviations::bounds(&scan.soup));
        let mut view = view.with_deviations(&Deviations {
            scan: &scan.soup,
            values: &answers.values,
            primitives: &answers.primitives,
            statistics: &self.statistics,
            is_signed: self.rule.is_some(),
            limit: self.limit,
            tolerance: args.tolerance,
        });
        let [scan_name, scene_name] = [&args.scan.path, &args.scene.path].map(|path| file_name(path));
        view.title = format!("{scan_name} and {scene_name} in p2m");
        view.summary = self.summary();
        let files = format!("scan {}, scene {}", name(&args.scan.path), args.scene.name());
        view.about = about(&files, backend, self.rule);
        output.write_all(view.html()?.as_bytes()).with_context(|| output.cannot_write())
    }

    /// Returns the part of a report about the deviations.
    fn json(&self) -> Value {
        let named = self.statistics.named();
        let statistics: serde_json::Map<String, Value> =
            named.into_iter().map(|named| (named.key, json::number(named.value))).collect();
        json!({
            "signed": self.rule.is_some(),
            "sign_rule": self.rule,
            "deviations": self.statistics.count,
            "missing": self.statistics.missing,
            "statistics": statistics,
            "tolerance": self.args.tolerance,
            "above": self.outside.map(|outside| outside.above),
            "below": self.outside.map(|outside| outside.below),
            "limit": self.limit,
        })
    }

    /// Returns the table of statistics.
    fn table(&self) -> String {
        let mut rows = vec![
            ("points with a deviation".to_owned(), Count(self.statistics.count as u64).to_string()),
            ("points without one".to_owned(), Count(self.statistics.missing as u64).to_string()),
        ];
        if self.statistics.count > 0 {
            let unit = &self.args.page.unit;
            let named = self.statistics.named();
            rows.extend(named.into_iter().map(|named| (named.label, format!("{} {unit}", Figure(named.value)))));
        }
        if let (Some(tolerance), Some(outside)) = (self.args.tolerance, self.outside) {
            let part = |count: usize| {
                let percent = Figure(100.0 * count as f64 / self.statistics.count.max(1) as f64);
                format!("{} ({percent} %)", Count(count as u64))
            };
            let unit = &self.args.page.unit;
            rows.push((format!("above {tolerance} {unit}"), part(outside.above)));
            if self.rule.is_some() {
                rows.push((format!("below -{tolerance} {unit}"), part(outside.below)));
            }
            rows.push((
                format!("within {tolerance} {unit}"),
                part(self.statistics.count - outside.above - outside.below),
            ));
        }
        let width = rows.iter().map(|(label, _)| label.len()).max().unwrap_or(0);
        let mut text = String::new();
        for (label, value) in rows {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{label:width$}  {value}");
        }
        text
    }

    /// Returns the sentence below the heading of the page.
    fn summary(&self) -> String {
        let DeviationStatistics { count, mean, rms, min, max, .. } = self.statistics;
        let unit = &self.args.page.unit;
        let what = if self.rule.is_some() { "deviations, positive outside" } else { "distances" };
        let count = Count(count as u64);
        let [mean, rms, min, max] = [mean, rms, min, max].map(Figure);
        format!("{count} {what}: mean {mean} {unit}, root mean square {rms} {unit}, from {min} to {max} {unit}")
    }
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
        if let Some(out) = &self.out {
            Output::refuse_inputs(out, &[&self.scan.path, &self.scene.path])?;
        }
        Ok(format)
    }

    /// Returns the columns of the table, which are those of `p2m query --signed`.
    fn columns(&self, scene: &Scene) -> Vec<AnswerColumn> {
        AnswerColumn::defaults(AnswerFormat::Csv, !scene.objects.is_empty(), !self.unsigned)
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
