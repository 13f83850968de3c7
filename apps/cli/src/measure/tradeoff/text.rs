//! Results as a table for a terminal.

use crate::measure::harness::Table;
use crate::measure::tradeoff::curve::{Curve, Latency, SetFigures};
use crate::measure::tradeoff::errors::Errors;

/// The smallest number of queries that has a 99.9th percentile.
const MIN_QUERIES_FOR_P999: usize = 1000;

/// Returns a table with a row for each setting of each backend.
pub(crate) fn table(set: &SetFigures) -> Table {
    let head = [
        "backend",
        "setting",
        "ns",
        "speed",
        "max error",
        "99.9 %",
        "in u M",
        "bound gap",
        "p50 ns",
        "p99.9 ns",
        "build s",
        "B each",
        "",
    ];
    let mut table = Table::new(head);
    for curve in &set.curves {
        for point in &curve.points {
            let Errors { relative, scaled, gap, .. } = point.errors;
            let latency = |of: fn(&Latency) -> u64, min_queries: usize| {
                let shown = point.latency.as_ref().filter(|_| point.queries >= min_queries);
                shown.map_or("-".to_owned(), |latency| of(latency).to_string())
            };
            table.push(vec![
                curve.name.clone(),
                point.setting.clone(),
                format!("{:.0}", point.nanoseconds.median),
                speedup(curve, point.nanoseconds.median),
                error(relative.max),
                if point.queries < MIN_QUERIES_FOR_P999 { "-".to_owned() } else { error(relative.p999) },
                error(scaled.max),
                error(gap),
                latency(|l| l.p50, 2),
                latency(|l| l.p999, MIN_QUERIES_FOR_P999),
                seconds(point.build.seconds),
                format!("{:.0}", point.build.bytes_per_primitive),
                failures(&point.errors),
            ]);
        }
    }
    table
}

/// Returns the speed relative to that of the default setting of the backend, in words.
fn speedup(curve: &Curve, nanoseconds: f64) -> String {
    curve.default_point().map_or("-".to_owned(), |default| format!("{:.2}x", default.nanoseconds.median / nanoseconds))
}

/// Returns the failures of answers in words; an empty string if there are none.
fn failures(errors: &Errors) -> String {
    let count = |count: usize, what: &str| (count > 0).then(|| format!("{count} of {} {what}", errors.compared));
    let all = [
        count(errors.unanswered, "unanswered"),
        count(errors.broken, "farther than promised"),
        count(errors.bounds_above_truth, "bounds above the truth"),
    ];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Formats an error with one decimal.
fn error(value: f64) -> String {
    match value {
        x if x.is_nan() => "-".to_owned(),
        x if x <= 0.0 => "0".to_owned(),
        x if (0.1..1000.0).contains(&x) => format!("{x:.1}"),
        x => format!("{x:.1e}"),
    }
}

/// Formats seconds with three digits.
fn seconds(value: f64) -> String {
    match value {
        x if x < 1e-3 => format!("{x:.1e}"),
        x if x < 10.0 => format!("{x:.3}"),
        x => format!("{x:.1}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::tradeoff::fixtures;

    #[test]
    fn every_point_has_a_row() {
        let scene = fixtures::scene();
        let text = table(&scene.sets[0]).to_string();
        assert_eq!(text.lines().count(), 2 + 3, "{text}");
        assert!(text.contains("2.00x") && text.contains("| p2m "), "{text}");
    }

    #[test]
    fn failures_are_told() {
        let mut errors = fixtures::point("default", 1.0, 0.0, 0.0).errors;
        assert_eq!(failures(&errors), "");
        errors.broken = 2;
        errors.bounds_above_truth = 1;
        assert_eq!(failures(&errors), "2 of 100 farther than promised, 1 of 100 bounds above the truth");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, 0.5, 12.34, 1e-16, 4e15, f64::NAN].map(error), ["0", "0.5", "12.3", "1.0e-16", "4.0e15", "-"]);
        assert_eq!([1e-4, 0.5, 12.0].map(seconds), ["1.0e-4", "0.500", "12.0"]);
    }
}
