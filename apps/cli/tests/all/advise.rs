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
        let is_near = |e: &Value| e["total"].as_f64().unwrap() <= 1.15 * all[0].3;
        for estimate in &report["estimates"].as_array().unwrap()[1..] {
            assert_eq!(estimate["about_equal"], is_near(estimate), "{estimate}");
            assert_eq!(estimate["reason"].as_str().unwrap().starts_with("about equal to "), is_near(estimate));
        }
    }
}

#[test]
fn memory_is_a_limit() {
    let report = json(&["advise", SCENE, "--queries", "100000000", "--memory", "0.001", "--json"]);
    // There is no smaller index than the tree, and an exhaustive search would take ages.
    assert_eq!(report["backend"], "aabb");
    let reason = |name: &str| {
        let found = report["estimates"].as_array().unwrap().iter().find(|e| e["backend"] == name);
        found.unwrap()["reason"].as_str().unwrap().to_owned()
    };
    for name in ["kdop", "octree", "p2m"] {
        assert_eq!(reason(name), "takes more memory than there may be");
    }
    let text = table(&["advise", SCENE, "--queries", "100000000", "--box"]);
    assert!(text.starts_with("backend  ") && text.contains("the least time for building and all queries"), "{text}");
}

/// Writes the scenes of the comparison: clean meshes, slivers, points, segments, mixtures, tiny ones, a saved index.
fn scenes(folder: &TempDir) -> Vec<(String, &'static str)> {
    let generated = |name: &str, arguments: &[&str], features: &'static str| {
        let file = path(folder, name);
        table(&[&["generate"], arguments, &["--out", &file]].concat());
        (file, features)
    };
    let points: String = (0..3000).map(|i| format!("{} {} {}\n", i % 17, i % 31, f64::from(i % 29) * 0.3)).collect();
    let track: String = (0..2000).map(|i| format!("v {i} {} 0\n", i % 7)).collect();
    let lines: String = (1..2000).map(|i| format!("l {i} {}\n", i + 1)).collect();
    let rings = r#"{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]]]}"#;
    let saved = path(folder, "saved.p2m");
    table(&["build", SCENE, "--backend", "octree", "--out", &saved]);
    vec![
        (SCENE.to_owned(), "bvh scene"),
        generated("knot.ply", &["torus-knot", "--rings", "400"], "bvh scene"),
        generated("ball.stl", &["ico-sphere"], "bvh scene"),
        generated("gear.off", &["skewed-gear", "--rotate-x", "40", "--rotate-y", "17"], "bvh scene"),
        (write(folder, "cloud.xyz", &points), "bvh scene"),
        (write(folder, "track.obj", &(track + &lines)), "bvh scene"),
        (write(folder, "tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "bvh scene"),
        (write(folder, "dot.xyz", "1 2 3\n"), "bvh scene"),
        (write(folder, "map.geojson", rings), "bvh formats"),
        (saved, "interception scene"),
    ]
}

#[test]
fn advice_is_the_choice_of_auto_in_every_run_and_names_a_build() {
    let folder = TempDir::new().unwrap();
    let mut chosen = Vec::new();
    for (scene, features) in scenes(&folder) {
        let info = json(&["info", &scene, "--json"]);
        let joined = |features: &Value| {
            let names: Vec<_> = features.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
            names.join(" ")
        };
        assert_eq!(joined(&info["build"]["features"]), features, "{scene}");
        assert!(info["build"]["crates"].as_u64() < info["build"]["default_crates"].as_u64(), "{info}");
        for count in ["3", "1000", "2e4", "150_000"] {
            let advice = json(&["advise", &scene, "--queries", count, "--json"]);
            let backend = p2m_backends::BackendEntry::find(advice["backend"].as_str().unwrap()).unwrap();
            assert_eq!(joined(&advice["features"]).contains("bvh"), backend.feature == Some("bvh"), "{advice}");
            if info["index"].is_null() {
                let (queries, out) = (advice["queries"].to_string(), path(&folder, "answers.npy"));
                let auto = ["query", &scene, "--backend", "auto", "--random", &queries, "--out", &out, "--json"];
                assert_eq!(json(&auto)["backend"], advice["backend"], "{scene} {count}");
            }
            chosen.push(backend.name);
        }
    }
    for name in ["brute", "aabb", "kdop", "octree"] {
        assert!(chosen.contains(&name), "{name}: {chosen:?}");
    }
    // It does not depend on the load.
    let arguments = ["advise", SCENE, "--queries", "90000", "--json"];
    let expected = json(&arguments);
    std::thread::scope(|scope| {
        for _ in 0..20 {
            scope.spawn(|| assert_eq!(json(&arguments), expected));
        }
    });
    // No option is needed.
    let text = table(&["advise", SCENE]);
    assert!(text.contains("for 1,000,000 queries in the box of the scene\n"), "{text}");
    assert!(text.contains("default-features = false, features = [\""), "{text}");
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
        assert!(reason.is_some_and(|reason| reason.starts_with("octree pays from about ")));
        // It depends on nothing else.
        assert_eq!(chosen(&["--random", count, "--threads", "1"]), chosen(&["--random", count]));
    }
    assert_eq!(chosen(&["--random", "200"]), ("aabb".to_owned(), None));
    assert_eq!(chosen(&["--random", "200000", "--k-nearest", "2"]), ("aabb".to_owned(), None));
    let out = path(&folder, "f.raw");
    let report = json(&["field", SCENE, "--resolution", "8", "--backend", "auto", "--out", &out, "--json"]);
    assert!(p2m_backends::BackendEntry::find(report["backend"].as_str().unwrap()).is_some(), "{report}");
    let empty = write(&folder, "empty.obj", "# nothing\n");
    assert_eq!(json(&["advise", &empty, "--queries", "5", "--near", "--json"])["backend"], "aabb");
    let saved = path(&folder, "s.p2m");
    let report = json(&["build", SCENE, "--backend", "auto", "--out", &saved, "--json"]);
    assert_ne!(report["backend"], "brute");
}

#[test]
fn wrong_usage_is_told_what_is_wrong() {
    for (arguments, message) in [
        (&["advise", SCENE, "--queries", "5", "--near", "--box"][..], "cannot be used with"),
        (&["advise", SCENE, "--queries", "x", "--near"], "'x'"),
        (&["advise", SCENE, "--queries", "5", "--near", "--memory", "-1"], "'-1'"),
    ] {
        let found = failure(arguments, 2);
        assert!(found.contains(message), "{arguments:?}: {found}");
    }
}
