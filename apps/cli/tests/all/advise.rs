//! Tests of `p2m advise` and `--backend auto`.

use crate::common::*;
use serde_json::Value;
use tempfile::TempDir;

/// Returns name, build, query and total of each estimate of a report.
fn estimates(report: &Value) -> Vec<(String, f64, f64, f64)> {
    let number = |e: &Value, key: &str| e[key].as_f64().unwrap();
    let all = report["estimates"].as_array().unwrap().iter();
    all.map(|e| (e["backend"].as_str().unwrap().to_owned(), number(e, "build"), number(e, "query"), number(e, "total")))
        .collect()
}

#[test]
fn the_least_total_is_recommended_and_break_even_is_where_totals_meet() {
    let folder = TempDir::new().unwrap();
    let knot = path(&folder, "knot.ply");
    table(&["generate", "torus-knot", "--rings", "400", "--out", &knot]);
    for (queries, place) in [("1", "--near"), ("100000", "--box"), ("100000000", "--near"), ("100000000", "--box")] {
        let report = json(&["advise", &knot, "--queries", queries, place, "--json"]);
        let all = estimates(&report);
        assert_eq!(report["backend"], all[0].0);
        assert_eq!(all.len(), p2m_backends::BACKENDS.len());
        let count: f64 = queries.parse().unwrap();
        for (k, (name, build, query, total)) in all.iter().enumerate() {
            assert!((build + count * query - total).abs() <= 1e-9 * total, "{name}");
            assert!(*total >= all[0].3, "{name}");
            let estimate = &report["estimates"][k];
            assert!(!estimate["reason"].as_str().unwrap().is_empty());
            if let Some(meeting) = estimate["break_even"].as_f64() {
                let difference = (build + meeting * query) - (all[0].1 + meeting * all[0].2);
                assert!(difference.abs() <= 2.0 * (query - all[0].2).abs() + 1e-9, "{name}: {difference} at {meeting}");
            }
        }
        assert_eq!(report["backend"] == "brute", queries == "1", "{report}");
        assert_eq!(report["sample_primitives"].as_u64().unwrap() > 0, count > 1e6, "{report}");
    }
}

#[test]
fn memory_and_time_are_limits() {
    let report = json(&["advise", SCENE, "--queries", "100000000", "--box", "--memory", "0.001", "--json"]);
    assert_eq!(report["backend"], "brute");
    assert!(report["estimates"][1]["reason"].as_str().unwrap().contains("more than there may be"), "{report}");
    let report = json(&["advise", SCENE, "--queries", "100000000", "--box", "--time", "0", "--json"]);
    assert_eq!(report["sample_primitives"], 0);
    let text = table(&["advise", SCENE, "--queries", "100000000", "--box"]);
    assert!(text.starts_with("backend  ") && text.contains("the least time for building and all queries"), "{text}");
}

#[test]
fn an_automatic_backend_gives_the_same_answers() {
    let folder = TempDir::new().unwrap();
    let points = write(&folder, "p.csv", "x,y,z\n0,0,0\n1,2,3\n");
    for more in [&["--random", "300"][..], &["--grid", "5"], &["--points", &points]] {
        let run = |backend: &str| table(&[&["query", SCENE, "--backend", backend], more].concat());
        assert_eq!(run("auto"), run("brute"));
    }
    // Without a name the number of queries decides, and the summary says so.
    let out = path(&folder, "a.csv");
    let chosen = |arguments: &[&str]| {
        let report = json(&[&["query", SCENE, "--out", &out, "--json"], arguments].concat());
        (report["backend"].as_str().unwrap().to_owned(), report["backend_reason"].as_str().map(str::to_owned))
    };
    for (count, backend) in [("2000", "aabb"), ("300000", "octree")] {
        let (found, reason) = chosen(&["--random", count]);
        assert_eq!(found, backend);
        assert!(reason.is_some_and(|reason| reason.starts_with("an octree pays from about ")));
        // It depends on nothing else.
        assert_eq!(chosen(&["--random", count, "--threads", "1"]), chosen(&["--random", count]));
    }
    assert_eq!(chosen(&["--random", "200"]), ("aabb".to_owned(), None));
    assert_eq!(chosen(&["--random", "200000", "--k-nearest", "2"]), ("aabb".to_owned(), None));
    let out = path(&folder, "f.raw");
    let report = json(&["field", SCENE, "--resolution", "8", "--backend", "auto", "--out", &out, "--json"]);
    assert!(p2m_backends::BackendEntry::find(report["backend"].as_str().unwrap()).is_some(), "{report}");
    let empty = write(&folder, "empty.obj", "# nothing\n");
    assert_eq!(json(&["advise", &empty, "--queries", "5", "--near", "--json"])["backend"], "brute");
    let saved = path(&folder, "s.p2m");
    let report = json(&["build", SCENE, "--backend", "auto", "--out", &saved, "--json"]);
    assert_ne!(report["backend"], "brute");
}

#[test]
fn wrong_usage_is_told_what_is_wrong() {
    for (arguments, message) in [
        (&["advise", SCENE, "--near"][..], "--queries"),
        (&["advise", SCENE, "--queries", "5"], "--near|--box|--points"),
        (&["advise", SCENE, "--queries", "5", "--near", "--box"], "cannot be used with"),
        (&["advise", SCENE, "--queries", "x", "--near"], "'x'"),
        (&["advise", SCENE, "--queries", "5", "--near", "--memory", "-1"], "'-1'"),
    ] {
        let found = failure(arguments, 2);
        assert!(found.contains(message), "{arguments:?}: {found}");
    }
}
