//! The statistics of a comparison and its verdict, as text for people, as JSON for programs, and in files.

use super::{Args, DeviationFormat};
use crate::io::input::name;
use crate::io::{Output, json};
use crate::page::{about, file_name};
use anyhow::Context;
use nalgebra::Point3;
use p2m_field::deviation::{DeviationStatistics, OutsideTolerance, bands, histogram, outside};
use p2m_mixed::statistics::figure::{Count, Figure};
use p2m_mixed::{Scene, VertexValues, WriteError, write_ply_with_values};
use p2m_page::{Deviations, ObjectDeviations, Sheet, Verdict, diverging_colour};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;

/// The number of bins of a histogram between the limits of colours.
const BINS: usize = 60;

/// The points that have deviations: those of a scan, or the vertices of the part.
pub(super) struct Compared<'a> {
    pub(super) scan: &'a Scene,
    pub(super) scene: &'a Scene,
    /// The deviation of each position of `scan`, or NaN.
    pub(super) values: &'a [f64],
    /// The closest primitive of each position, or `u32::MAX`.
    pub(super) primitives: &'a [u32],
    /// The rule of signs, if there are any.
    pub(super) rule: Option<&'static str>,
    /// The name of the index.
    pub(super) backend: &'static str,
}

/// The statistics of a run, as text for people or as JSON for programs.
pub(super) struct DeviationReport<'a> {
    args: &'a Args,
    compared: Compared<'a>,
    statistics: DeviationStatistics,
    outside: Option<OutsideTolerance>,
    limit: f64,
    /// The part of the points within the tolerance, if there is one.
    verdict: Option<Verdict>,
}

impl<'a> DeviationReport<'a> {
    /// Makes the statistics of deviations.
    pub(super) fn new(args: &'a Args, compared: Compared<'a>) -> Self {
        let statistics = DeviationStatistics::of(compared.values);
        let limit = args.limit.unwrap_or_else(|| Deviations::usual_limit(&statistics, args.tolerance));
        let outside = args.tolerance.map(|tolerance| outside(compared.values, tolerance));
        let mut report = Self { args, compared, statistics, outside, limit, verdict: None };
        report.verdict = report.deviations().verdict(args.require, &args.page.unit);
        report
    }

    /// Tells whether enough of the points are within the tolerance, if that is asked.
    pub(super) fn passes(&self) -> Option<bool> {
        self.verdict.as_ref()?.passes
    }

    /// Returns the verdict as a line, if it was asked for.
    fn verdict(&self) -> Option<String> {
        let verdict = self.verdict.as_ref()?;
        verdict.word().map(|word| format!("{word}: {}", verdict.sentence))
    }

    /// Writes a file, apart from a table of answers, which exists by now.
    pub(super) fn write(&self, format: DeviationFormat, output: &mut Output<'_>) -> anyhow::Result<()> {
        let cannot_write = output.cannot_write();
        match format {
            DeviationFormat::Csv if self.args.on_part => self.write_vertices(output),
            DeviationFormat::Csv => Ok(()),
            DeviationFormat::Ply => return self.write_ply(output).context(cannot_write),
            DeviationFormat::Html => output.write_all(self.page()?.as_bytes()),
            DeviationFormat::Png => output.write_all(&self.with_sheet(|sheet| sheet.png())?),
            DeviationFormat::Pdf => output.write_all(&self.with_sheet(|sheet| sheet.pdf())),
        }
        .context(cannot_write)
    }

    /// Writes the table of the part's vertices.
    fn write_vertices(&self, output: &mut Output<'_>) -> std::io::Result<()> {
        writeln!(output, "number,x,y,z,deviation")?;
        let filter = self.args.filter(Vec::new());
        let rows = self.compared.scan.soup.positions().iter().zip(self.compared.values);
        for (number, (Point3 { coords }, value)) in
            rows.enumerate().filter(|(_, (_, value))| filter.is_in_table(**value))
        {
            write!(output, "{number},{:?},{:?},{:?},", coords.x, coords.y, coords.z)?;
            if value.is_nan() { writeln!(output) } else { writeln!(output, "{value:?}") }?;
        }
        Ok(())
    }

    /// Returns the histogram as a table: the ends of each bin and the number of deviations in it.
    pub(super) fn histogram(&self) -> String {
        let low = if self.compared.rule.is_some() { -self.limit } else { 0.0 };
        let mut text = "low,high,count\n".to_owned();
        for bin in histogram(self.compared.values, low, self.limit, BINS) {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{:?},{:?},{}", bin.low, bin.high, bin.count);
        }
        text
    }

    /// Writes the scan with a deviation and a colour for each vertex.
    fn write_ply(&self, output: &mut Output<'_>) -> Result<(), WriteError> {
        let values = self.compared.values;
        let colours: Vec<[u8; 3]> = values.iter().map(|value| diverging_colour(*value, self.limit)).collect();
        write_ply_with_values(
            self.compared.scan,
            &VertexValues { name: "deviation", values, colours: &colours },
            output,
        )
    }

    fn deviations(&self) -> Deviations<'_> {
        let Compared { scan, values, primitives, rule, .. } = self.compared;
        Deviations {
            scan: &scan.soup,
            values,
            primitives,
            statistics: &self.statistics,
            is_signed: rule.is_some(),
            limit: self.limit,
            tolerance: self.args.tolerance,
        }
    }

    /// Returns how the result was made, for pages and sheets.
    fn about(&self) -> String {
        let files = format!("scan {}, scene {}", name(&self.args.scan.path), self.args.scene.name());
        about(&files, self.compared.backend, self.compared.rule)
    }

    fn title(&self) -> String {
        let [scan, scene] = [&self.args.scan.path, &self.args.scene.path].map(|path| file_name(path));
        format!("{scan} and {scene}")
    }

    /// Returns the page of the scan and the scene.
    fn page(&self) -> serde_json::Result<String> {
        let view = self.args.page.view(self.compared.scene, &Deviations::bounds(&self.compared.scan.soup));
        let mut view = view.with_deviations(&self.deviations());
        view.title = self.title();
        let verdict = self.verdict().map(|verdict| verdict + ". ").unwrap_or_default();
        view.summary = verdict + &self.deviations().summary(&self.args.page.unit);
        let head: String = self.args.head.iter().map(|(name, value)| format!("{name}: {value}; ")).collect();
        view.about = head + &self.about();
        view.html()
    }

    /// Calls a function with the report on one sheet.
    fn with_sheet<R>(&self, write: impl FnOnce(&Sheet<'_>) -> R) -> R {
        let (title, about) = (self.title(), self.about());
        write(&Sheet {
            title: &title,
            head: &self.args.head,
            required: self.args.require,
            unit: &self.args.page.unit,
            up: self.args.page.up,
            scene: self.compared.scene,
            deviations: self.deviations(),
            about: &about,
        })
    }

    /// Returns the part of a report about the deviations.
    pub(super) fn json(&self) -> Value {
        let statistics = |statistics: &DeviationStatistics| -> serde_json::Map<String, Value> {
            statistics.named().into_iter().map(|named| (named.key, json::number(named.value))).collect()
        };
        let Compared { rule, values, .. } = self.compared;
        let objects = ObjectDeviations::of_scene(self.compared.scene, &self.deviations()).into_iter().map(|object| {
            json!({
                "name": Some(object.name).filter(|name| !name.is_empty()),
                "deviations": object.statistics.count,
                "statistics": statistics(&object.statistics),
                "above": object.outside.map(|outside| outside.above),
                "below": object.outside.map(|outside| outside.below),
            })
        });
        json!({
            "signed": rule.is_some(),
            "sign_rule": rule,
            "on_part": self.args.on_part,
            "deviations": self.statistics.count,
            "missing": self.statistics.missing,
            "statistics": statistics(&self.statistics),
            "tolerance": self.args.tolerance,
            "above": self.outside.map(|outside| outside.above),
            "below": self.outside.map(|outside| outside.below),
            "bands": self.args.tolerance.map(|tolerance| bands(values, tolerance, self.limit)),
            "required": self.args.require,
            "passes": self.passes(),
            "limit": self.limit,
            "objects": objects.collect::<Value>(),
        })
    }

    /// Returns the tables of statistics.
    pub(super) fn table(&self) -> String {
        let (unit, statistics) = (&self.args.page.unit, &self.statistics);
        let what = if self.args.on_part { "vertices" } else { "points" };
        let mut rows = vec![
            (format!("{what} with a deviation"), Count(statistics.count as u64).to_string()),
            (format!("{what} without one"), Count(statistics.missing as u64).to_string()),
        ];
        if statistics.count > 0 {
            let named = statistics.named();
            rows.extend(named.into_iter().map(|named| (named.label, format!("{} {unit}", Figure(named.value)))));
        }
        if let (Some(tolerance), Some(outside)) = (self.args.tolerance, self.outside) {
            let part = |count: usize| {
                let percent = Figure(100.0 * count as f64 / statistics.count.max(1) as f64);
                format!("{} ({percent} %)", Count(count as u64))
            };
            rows.push((format!("above {tolerance} {unit}"), part(outside.above)));
            if self.compared.rule.is_some() {
                // The negative of 0 is 0.
                rows.push((format!("below {} {unit}", 0.0 - tolerance), part(outside.below)));
            }
            rows.push((format!("within {tolerance} {unit}"), part(statistics.count - outside.above - outside.below)));
            if self.limit > tolerance {
                let [far_below, .., far_above] = bands(self.compared.values, tolerance, self.limit);
                rows.push((format!("beyond {} {unit}", Figure(self.limit)), part(far_below + far_above)));
            }
        }
        let width = rows.iter().map(|(label, _)| label.len()).max().unwrap_or(0);
        let rows: String = rows.iter().map(|(label, value)| format!("{label:width$}  {value}\n")).collect();
        rows + &self.table_of_objects() + &self.verdict().map(|verdict| verdict + "\n").unwrap_or_default()
    }

    /// Returns a line for each object, if there are some.
    fn table_of_objects(&self) -> String {
        let objects = ObjectDeviations::of_scene(self.compared.scene, &self.deviations());
        if objects.is_empty() {
            return String::new();
        }
        let heading = format!("object, in {}", self.args.page.unit);
        let names = objects.iter().map(|object| object.name.chars().count());
        let width = names.max().unwrap_or(0).max(heading.len());
        let line = |name: &str, cells: &[String]| {
            let cells: String = cells.iter().map(|cell| format!("  {cell:>9}")).collect();
            format!("{name:width$}{cells}\n")
        };
        let columns = ["points", "mean", "rms", "smallest", "largest", "outside"].map(str::to_owned);
        let head = line(&heading, &columns[..if self.outside.is_some() { 6 } else { 5 }]);
        let rows = objects.iter().map(|ObjectDeviations { name, statistics, outside }| {
            let number = |x: f64| if x.is_nan() { "-".to_owned() } else { Figure(x).to_string() };
            let mut cells = vec![Count(statistics.count as u64).to_string()];
            cells.extend([statistics.mean, statistics.rms, statistics.min, statistics.max].map(number));
            cells.extend(outside.map(|outside| Count((outside.above + outside.below) as u64).to_string()));
            line(if name.is_empty() { "-" } else { name }, &cells)
        });
        format!("\n{head}{}", rows.collect::<String>())
    }
}
