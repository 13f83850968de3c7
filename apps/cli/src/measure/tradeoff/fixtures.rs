//! Results for tests.

use crate::measure::harness::MedianRange;
use crate::measure::harness::Provenance;
use crate::measure::tradeoff::curve::{Build, Curve, Latency, Point, SceneFigures, SetFigures, Turn};
use crate::measure::tradeoff::errors::{ErrorQuantiles, Errors};

/// Returns a provenance with characters that files have to escape.
pub(crate) fn provenance() -> Provenance {
    let [label, date, commit, cpu, rustc, flags, target_features, command] =
        ["portable", "2026-01-01", "abc", "a <processor>, fast", "rustc 1", "release", "sse2", "p2m tradeoff"]
            .map(str::to_owned);
    Provenance { label, date, commit, cpu, rustc, flags, target_features, command }
}

/// Returns a point with these nanoseconds per query, this relative error and these seconds of building.
pub(crate) fn point(setting: &str, ns: f64, error: f64, seconds: f64) -> Point {
    let worst = |max: f64| ErrorQuantiles { max, p999: max / 2.0 };
    let errors = Errors {
        compared: 100,
        unanswered: 0,
        scaled: worst(error * 1e14),
        relative: worst(error),
        gap: 1e-15,
        bounds_above_truth: 0,
        other_ids: 0,
        broken: 0,
    };
    Point {
        setting: setting.to_owned(),
        queries: 100,
        rounds: 5,
        nanoseconds: MedianRange { median: ns, min: ns * 0.95, max: ns * 1.1 },
        errors,
        latency: Some(Latency { p50: 100, p90: 200, p99: 400, p999: 800, max: 1600 }),
        build: Build { seconds, bytes_per_primitive: 65.5 },
    }
}

/// Returns a scene with one set of queries and two backends.
pub(crate) fn scene() -> SceneFigures {
    let curve = |name: &str, points| Curve { name: name.to_owned(), points };
    let tree = curve("aabb", vec![point("default", 1000.5, 0.0, 0.1), point("epsilon 0.1", 500.0, 0.05, 0.1)]);
    let cells = curve("p2m", vec![point("default", 100.25, 1e-16, 5.0)]);
    let turns = vec![Turn { name: "aabb", from: 0.0 }, Turn { name: "p2m", from: 5.4e6 }];
    let set = SetFigures { name: "1x".to_owned(), about: "uniform".to_owned(), curves: vec![tree, cells], turns };
    SceneFigures {
        name: "a \"scene\", of two".to_owned(),
        about: "2 triangles & 1 segment".to_owned(),
        primitives: 3,
        sets: vec![set],
    }
}
