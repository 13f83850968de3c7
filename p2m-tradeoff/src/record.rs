//! Records: a line of comma-separated values for each point of each curve, with its origin.

use crate::curve::SceneFigures;
use crate::error::RecordError;
use crate::provenance::Provenance;
use std::collections::BTreeMap;

/// Joins fields to a line of a comma-separated file. Fields are quoted where necessary.
#[must_use]
pub fn csv_line(fields: &[String]) -> String {
    let quoted = |field: &String| {
        if field.contains([',', '"', '\n']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.clone() }
    };
    fields.iter().map(quoted).collect::<Vec<_>>().join(",")
}

/// Returns a record of all results as text, which begins with the names of the columns. `seed` is the seed of the
/// queries, and `clock` the time to read the clock, in nanoseconds. Figures that were not measured are empty.
#[must_use]
pub fn record(provenance: &Provenance, scenes: &[SceneFigures], seed: u64, clock: f64) -> String {
    let sets = scenes.iter().flat_map(|scene| scene.sets.iter().map(move |set| (scene, set)));
    let curves = sets.flat_map(|(scene, set)| set.curves.iter().map(move |curve| (scene, set, curve)));
    let points =
        curves.flat_map(|(scene, set, curve)| curve.points.iter().map(move |point| (scene, set, curve, point)));
    let mut lines = Vec::new();
    for (scene, set, curve, point) in points {
        let (ns, errors) = (&point.nanoseconds, &point.errors);
        let latency = point.latency.map(|l| [l.p50, l.p90, l.p99, l.p999, l.max]);
        let latency = |i: usize| latency.map_or_else(String::new, |all| all[i].to_string());
        let fields = [
            ("scene", scene.name.clone()),
            ("primitives", scene.primitives.to_string()),
            ("set", set.name.clone()),
            ("seed", seed.to_string()),
            ("backend", curve.name.clone()),
            ("setting", point.setting.clone()),
            ("queries", point.queries.to_string()),
            ("rounds", point.rounds.to_string()),
            ("ns_median", number(ns.median)),
            ("ns_min", number(ns.min)),
            ("ns_max", number(ns.max)),
            ("error_um_max", number(errors.scaled.max)),
            ("error_um_p999", number(errors.scaled.p999)),
            ("error_relative_max", number(errors.relative.max)),
            ("error_relative_p999", number(errors.relative.p999)),
            ("bound_gap", number(errors.gap)),
            ("bounds_above_truth", errors.bounds_above_truth.to_string()),
            ("other_ids", errors.other_ids.map_or_else(String::new, |count| count.to_string())),
            ("broken_promises", errors.broken.to_string()),
            ("compared", errors.compared.to_string()),
            ("unanswered", errors.unanswered.to_string()),
            ("clock_ns", number(clock)),
            ("latency_p50_ns", latency(0)),
            ("latency_p90_ns", latency(1)),
            ("latency_p99_ns", latency(2)),
            ("latency_p999_ns", latency(3)),
            ("latency_max_ns", latency(4)),
            ("build_s", number(point.build.seconds)),
            ("bytes_each", point.build.bytes_per_primitive.map_or_else(String::new, number)),
            ("program", provenance.command.clone()),
        ];
        let line = |origin: [String; 7], rest: Vec<String>| csv_line(&[&origin[..], &rest].concat()) + "\n";
        if lines.is_empty() {
            let names = fields.iter().map(|(name, _)| (*name).to_owned()).collect();
            lines.push(line(Provenance::COLUMNS.map(str::to_owned), names));
        }
        lines.push(line(provenance.fields(), fields.map(|(_, value)| value).into()));
    }
    lines.concat()
}

/// Formats a number with all digits, so that the same number is read back.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:e}") }
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

const KEY_COLUMNS: [&str; 4] = ["scene", "set", "backend", "setting"];
const ORIGIN_COLUMNS: [&str; 4] = ["cpu", "rustc", "flags", "commit"];
const JOB_COLUMNS: [&str; 2] = ["primitives", "seed"];
const TIME_COLUMNS: [&str; 3] = ["ns_median", "ns_min", "ns_max"];

/// Reads the lines of a record. Columns are found by their names, and unknown columns are ignored.
///
/// # Errors
/// [`RecordError`], other than [`RecordError::Foreign`].
pub fn read_record(text: &str) -> Result<Vec<Line>, RecordError> {
    let mut lines = Vec::new();
    for (record, line) in csv::Reader::from_reader(text.as_bytes()).deserialize().zip(2..) {
        let mut fields: BTreeMap<String, String> = record.map_err(|error| RecordError::Syntax(error.to_string()))?;
        let mut take = |column| fields.remove(column).ok_or(RecordError::Column(column));
        let key = take_all(KEY_COLUMNS, &mut take)?;
        let mut nanoseconds = [0.0; 3];
        for (value, column) in nanoseconds.iter_mut().zip(TIME_COLUMNS) {
            let number: Option<f64> = take(column)?.parse().ok();
            *value = number.filter(|ns| ns.is_finite() && *ns > 0.0).ok_or(RecordError::Number { line, column })?;
        }
        let errors = ERROR_COLUMNS.iter().map(|column| Ok((*column, take(column)?))).collect::<Result<_, _>>()?;
        lines.push(Line {
            key,
            origin: take_all(ORIGIN_COLUMNS, &mut take)?,
            job: take_all(JOB_COLUMNS, &mut take)?,
            queries: take("queries")?,
            nanoseconds,
            errors,
        });
    }
    if lines.is_empty() { Err(RecordError::Empty) } else { Ok(lines) }
}

/// Takes the fields of some columns.
fn take_all<const N: usize>(
    columns: [&'static str; N],
    take: &mut impl FnMut(&'static str) -> Result<String, RecordError>,
) -> Result<[String; N], RecordError> {
    let mut fields = columns.map(|_| String::new());
    for (field, column) in fields.iter_mut().zip(columns) {
        *field = take(column)?;
    }
    Ok(fields)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        let fields = ["a", "b,c", "d\"e", "1\n2", ""].map(str::to_owned);
        let line = csv_line(&fields);
        assert_eq!(line, "a,\"b,c\",\"d\"\"e\",\"1\n2\",");
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
        assert_eq!(reader.records().next().unwrap().unwrap(), fields.to_vec());
    }

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
        assert_eq!(read_record("\"x"), Err(RecordError::Empty));
        assert_eq!(read_record(&text.replace("ns_max", "x")), Err(RecordError::Column("ns_max")));
        let short = read_record(&format!("{head}\na,b\n"));
        let Err(RecordError::Syntax(message)) = short else { panic!("{short:?}") };
        assert!(message.contains("line: 2") && message.contains("2 fields"), "{message}");
        let median = fixtures::scene().sets[0].curves[0].points[0].nanoseconds.median;
        let broken = text.replacen(&format!("{median:e}"), "quick", 1);
        assert_eq!(read_record(&broken), Err(RecordError::Number { line: 2, column: "ns_median" }));
    }
}
