//! Records: a line of comma-separated values for each point of each curve, with its origin.

use super::curve::SceneFigures;
use crate::measure::harness::{Provenance, csv_line};

/// Returns a record of all results as text, which begins with the names of the columns. `seed` is the seed of the
/// queries, and `clock` the time to read the clock, in nanoseconds. Figures that were not measured are empty.
pub(crate) fn record(provenance: &Provenance, scenes: &[SceneFigures], seed: u64, clock: f64) -> String {
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
            ("other_ids", errors.other_ids.to_string()),
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
            ("bytes_each", number(point.build.bytes_per_primitive)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::tradeoff::fixtures;
    use std::collections::BTreeMap;

    #[test]
    fn each_point_has_a_line_of_its_figures() {
        let (provenance, scene) = (fixtures::provenance(), fixtures::scene());
        let text = record(&provenance, std::slice::from_ref(&scene), 7, 25.0);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let lines: Vec<BTreeMap<String, String>> = reader.deserialize().map(Result::unwrap).collect();
        let points: Vec<_> = scene.sets.iter().flat_map(|s| s.curves.iter().flat_map(|c| &c.points)).collect();
        assert_eq!(lines.len(), points.len());
        for (line, point) in lines.iter().zip(&points) {
            let number = |column: &str| line[column].parse::<f64>().unwrap();
            let ns = point.nanoseconds;
            assert_eq!(["ns_median", "ns_min", "ns_max"].map(number), [ns.median, ns.min, ns.max]);
            assert_eq!(number("error_um_max"), point.errors.scaled.max);
            assert_eq!((line["scene"].as_str(), &line["setting"]), ("a \"scene\", of two", &point.setting));
            assert_eq!((&line["cpu"], &line["commit"]), (&provenance.cpu, &provenance.commit));
            assert_eq!((line["seed"].as_str(), line["queries"].as_str()), ("7", "100"));
        }
    }
}
