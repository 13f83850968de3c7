//! Records: a line of comma-separated values for each point of each curve, with its origin.

use crate::csv::{csv_line, csv_records};
use crate::curve::SceneFigures;
use crate::error::RecordError;
use crate::provenance::Provenance;
use std::fmt::Write;

/// The columns after those of the provenance.
const COLUMNS: [&str; 30] = [
    "scene",
    "primitives",
    "set",
    "seed",
    "backend",
    "setting",
    "queries",
    "rounds",
    "ns_median",
    "ns_min",
    "ns_max",
    "error_um_max",
    "error_um_p999",
    "error_relative_max",
    "error_relative_p999",
    "bound_gap",
    "bounds_above_truth",
    "other_ids",
    "broken_promises",
    "compared",
    "unanswered",
    "clock_ns",
    "latency_p50_ns",
    "latency_p90_ns",
    "latency_p99_ns",
    "latency_p999_ns",
    "latency_max_ns",
    "build_s",
    "bytes_each",
    "program",
];

/// Returns a record of all results as text, which begins with the names of the columns. `seed` is the seed of the
/// queries, and `clock` the time to read the clock, in nanoseconds.
#[must_use]
pub fn record(provenance: &Provenance, scenes: &[SceneFigures], seed: u64, clock: f64) -> String {
    let head: Vec<String> = Provenance::COLUMNS.iter().chain(&COLUMNS).map(|c| (*c).to_owned()).collect();
    let mut text = csv_line(&head) + "\n";
    for scene in scenes {
        for set in &scene.sets {
            for curve in &set.curves {
                for point in &curve.points {
                    let (ns, errors) = (&point.nanoseconds, &point.errors);
                    // All digits are written, so that the same numbers are read back.
                    let number = |value: f64| if value.is_nan() { String::new() } else { format!("{value:e}") };
                    let latency = point.latency.map(|l| [l.p50, l.p90, l.p99, l.p999, l.max]);
                    let latency: [String; 5] =
                        std::array::from_fn(|i| latency.map_or_else(String::new, |l| l[i].to_string()));
                    let [p50, p90, p99, p999, max] = latency;
                    let fields: [String; COLUMNS.len()] = [
                        scene.name.clone(),
                        scene.primitives.to_string(),
                        set.name.clone(),
                        seed.to_string(),
                        curve.name.clone(),
                        point.setting.clone(),
                        point.queries.to_string(),
                        point.rounds.to_string(),
                        number(ns.median),
                        number(ns.min),
                        number(ns.max),
                        number(errors.scaled.max),
                        number(errors.scaled.p999),
                        number(errors.relative.max),
                        number(errors.relative.p999),
                        number(errors.gap),
                        errors.bounds_above_truth.to_string(),
                        errors.other_ids.map_or_else(String::new, |count| count.to_string()),
                        errors.broken.to_string(),
                        errors.compared.to_string(),
                        errors.unanswered.to_string(),
                        number(clock),
                        p50,
                        p90,
                        p99,
                        p999,
                        max,
                        number(point.build.seconds),
                        point.build.bytes_per_primitive.map_or_else(String::new, number),
                        provenance.command.clone(),
                    ];
                    let fields: Vec<String> = provenance.fields().into_iter().chain(fields).collect();
                    // Writing to a string does not fail.
                    let _ = writeln!(text, "{}", csv_line(&fields));
                }
            }
        }
    }
    text
}

/// The fields of a line that are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The scene, set, backend and setting.
    pub key: [String; 4],
    /// The processor, compiler, flags and commit.
    pub origin: [String; 4],
    /// The number of primitives and the seed of the queries. Lines with different ones cannot be compared.
    pub job: [String; 2],
    /// The number of queries. Errors of different numbers of queries cannot be compared.
    pub queries: String,
    /// The nanoseconds per query: median, minimum and maximum of the rounds.
    pub nanoseconds: [f64; 3],
    /// The columns about errors: their names and values.
    pub errors: Vec<(&'static str, String)>,
}

/// The columns about errors, which are reproducible.
const ERROR_COLUMNS: [&str; 9] = [
    "error_um_max",
    "error_um_p999",
    "error_relative_max",
    "error_relative_p999",
    "bound_gap",
    "bounds_above_truth",
    "other_ids",
    "broken_promises",
    "unanswered",
];

/// Reads the lines of a record. Columns are found by their names, and unknown columns are ignored.
///
/// # Errors
/// [`RecordError`], other than [`RecordError::Foreign`].
pub fn read_record(text: &str) -> Result<Vec<Line>, RecordError> {
    let mut records = csv_records(text).ok_or(RecordError::Syntax)?.into_iter();
    let head = records.next().ok_or(RecordError::Empty)?;
    let column = |name: &'static str| head.iter().position(|c| c == name).ok_or(RecordError::Column(name));
    fn columns<const N: usize>(
        names: [&'static str; N],
        column: impl Fn(&'static str) -> Result<usize, RecordError>,
    ) -> Result<[usize; N], RecordError> {
        let mut indices = [0; N];
        for (index, name) in indices.iter_mut().zip(names) {
            *index = column(name)?;
        }
        Ok(indices)
    }
    const NUMBERS: [&str; 3] = ["ns_median", "ns_min", "ns_max"];
    let keys = columns(["scene", "set", "backend", "setting"], column)?;
    let origins = columns(["cpu", "rustc", "flags", "commit"], column)?;
    let jobs = columns(["primitives", "seed"], column)?;
    let queries = column("queries")?;
    let numbers = columns(NUMBERS, column)?;
    let errors = columns(ERROR_COLUMNS, column)?;
    let mut lines = Vec::new();
    for (record, line) in records.zip(2..) {
        if record.len() != head.len() {
            return Err(RecordError::Fields { line, fields: record.len(), columns: head.len() });
        }
        let mut nanoseconds = [0.0; 3];
        for ((value, at), column) in nanoseconds.iter_mut().zip(numbers).zip(NUMBERS) {
            let number: Option<f64> = record[at].parse().ok();
            *value = number.filter(|ns| ns.is_finite() && *ns > 0.0).ok_or(RecordError::Number { line, column })?;
        }
        lines.push(Line {
            key: keys.map(|at| record[at].clone()),
            origin: origins.map(|at| record[at].clone()),
            job: jobs.map(|at| record[at].clone()),
            queries: record[queries].clone(),
            nanoseconds,
            errors: ERROR_COLUMNS.iter().copied().zip(errors.map(|at| record[at].clone())).collect(),
        });
    }
    if lines.is_empty() { Err(RecordError::Empty) } else { Ok(lines) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;

    #[test]
    fn what_is_recorded_is_read_back() {
        let (provenance, scene) = (fixtures::provenance(), fixtures::scene());
        let text = record(&provenance, std::slice::from_ref(&scene), 7, 25.0);
        let lines = read_record(&text).unwrap();
        let points: Vec<_> = scene.sets.iter().flat_map(|s| s.curves.iter().flat_map(|c| &c.points)).collect();
        assert_eq!(lines.len(), points.len());
        for (line, point) in lines.iter().zip(&points) {
            let ns = point.nanoseconds;
            assert_eq!(line.nanoseconds, [ns.median, ns.min, ns.max]);
            assert_eq!(line.errors[0].1.parse::<f64>().unwrap(), point.errors.scaled.max);
            assert_eq!((line.key[0].as_str(), &line.key[3]), ("a \"scene\", of two", &point.setting));
            assert_eq!(
                line.origin,
                [&provenance.cpu, &provenance.rustc, &provenance.flags, &provenance.commit].map(String::clone)
            );
            assert_eq!((line.job[1].as_str(), line.queries.as_str()), ("7", "100"));
        }
    }

    #[test]
    fn what_is_no_record_is_told() {
        let text = record(&fixtures::provenance(), &[fixtures::scene()], 7, 25.0);
        let head = text.lines().next().unwrap();
        assert_eq!(read_record(""), Err(RecordError::Empty));
        assert_eq!(read_record(head), Err(RecordError::Empty));
        assert_eq!(read_record("x,y\n1,2\n"), Err(RecordError::Column("scene")));
        assert_eq!(read_record("\"x"), Err(RecordError::Syntax));
        assert_eq!(read_record(&text.replace("ns_max", "x")), Err(RecordError::Column("ns_max")));
        let columns = Provenance::COLUMNS.len() + COLUMNS.len();
        let short = format!("{head}\na,b\n");
        assert_eq!(read_record(&short), Err(RecordError::Fields { line: 2, fields: 2, columns }));
        let median = fixtures::scene().sets[0].curves[0].points[0].nanoseconds.median;
        let broken = text.replacen(&format!("{median:e}"), "quick", 1);
        assert_eq!(read_record(&broken), Err(RecordError::Number { line: 2, column: "ns_median" }));
    }
}
