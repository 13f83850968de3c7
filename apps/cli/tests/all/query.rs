//! Tests of `p2m query`: tables, other formats and summaries.

use crate::common::*;
use p2m_backends::BACKENDS;
use p2m_mixed::statistics::figure::Length;
use std::fs;
use tempfile::TempDir;

#[test]
fn backends_and_threads_give_the_same_table() {
    for sample in [&["--random", "500"][..], &["--grid", "7"], &["--random", "300", "--seed", "9", "--box-scale", "30"]]
    {
        let run = |more: &[&str]| table(&[&["query", SCENE], sample, more].concat());
        let expected = run(&["--backend", "brute"]);
        assert!(expected.starts_with(&format!("{HEADER}\n")));
        assert_eq!(run(&["--backend", "aabb"]), expected);
        assert_eq!(run(&["--backend", "octree"]), expected);
        assert_eq!(run(&["--backend", "p2m"]), expected);
        assert_eq!(run(&["--backend", "kdop"]), expected);
        for faces in ["6", "14", "18", "26", "scene"] {
            assert_eq!(run(&["--backend", "kdop", "--k", faces]), expected);
        }
        assert_eq!(run(&[]), expected);
        assert_eq!(run(&["--threads", "1"]), expected);
        assert_eq!(run(&["--threads", "3"]), expected);
        assert_eq!(run(&["--out", "-"]), expected);
    }
    let seeds = ["0", "1"].map(|seed| table(&["query", SCENE, "--random", "5", "--seed", seed]));
    assert_ne!(seeds[0], seeds[1]);
    assert_eq!(seeds[0], table(&["query", SCENE, "--random", "5"]));
}

#[test]
fn the_summary_tells_what_was_done() {
    let folder = TempDir::new().unwrap();
    let scene =
        write(&folder, "s.obj", "vn 0 0 1\nusemtl a\nusemtl b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\np 1\n");
    let output = p2m(&["query", &scene, "--grid", "2", "--threads", "1", "--max-distance", "0.5"]);
    let summary = text(&output.stderr);
    for part in [
        scene.as_str(),
        "1 triangle, 1 segment, 1 point\n",
        "1 x vn, 2 x usemtl",
        "backend  brute, built in ",
        "queries  8 in ",
        "on 1 thread: ",
        "ns per query",
        "queries/s",
        "without answer ",
        "distance min ",
    ] {
        assert!(summary.contains(part), "{part}: {summary}");
    }
}

#[test]
fn objects_are_named_in_tables() {
    let folder = TempDir::new().unwrap();
    let scene =
        write(&folder, "s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\np 4\no big, \"flat\"\nf 1 2 3\no wire\nl 1 4\n");
    let points = write(&folder, "p.csv", "x,y,z\n0.25,0.25,-1\n-1,-1,3\n0,0,9\n100,0,0\n");
    let query = |scene: &str, backend: &str| {
        table(&["query", scene, "--points", &points, "--max-distance", "9", "--backend", backend])
    };
    let expected = format!(
        "{HEADER},object\n0.25,0.25,-1.0,0.25,0.25,0.0,1.0,1,face,\"big, \"\"flat\"\"\"\n\
        -1.0,-1.0,3.0,0.0,0.0,3.0,1.4142135623730951,2,edge0,wire\n0.0,0.0,9.0,0.0,0.0,5.0,4.0,0,vertex0,\n\
        100.0,0.0,0.0,,,,,,,\n"
    );
    for backend in BACKENDS.iter().map(|backend| backend.name) {
        assert_eq!(query(&scene, backend), expected);
    }
    let saved = path(&folder, "s.p2m");
    table(&["build", &scene, "--backend", "aabb", "--out", &saved]);
    assert_eq!(query(&saved, "aabb"), expected);
    let again = write(&folder, "again.csv", &expected);
    assert_eq!(table(&["query", &scene, "--points", &again, "--max-distance", "9"]), expected);
}

#[test]
fn directions_of_the_scene_are_explained() {
    let query = ["query", SCENE, "--random", "5", "--backend", "kdop"];
    let summary = |k: &str| text(&p2m(&[&query[..], &["--k", k]].concat()).stderr);
    let of_scene = summary("SCENE");
    let choice = after(&of_scene, "k-DOPs   ").to_owned();
    assert!(choice.contains(" directions along "), "{of_scene}");
    let faces = choice.split(' ').next().unwrap();
    assert!(of_scene.contains(&format!("backend  kdop, {faces} faces, built in ")), "{of_scene}");
    let usual = summary("18");
    assert!(usual.contains("backend  kdop, 18 faces, built in ") && !usual.contains("k-DOPs"), "{usual}");
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "answers.csv");
    let report = |more: &[&str]| {
        let output = p2m(&[&["query", SCENE, "--random", "5", "--json", "--out", &out], more].concat());
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        ["faces", "directions_reason"].map(|key| report[key].clone())
    };
    assert_eq!(
        report(&["--backend", "kdop", "--k", "scene"]),
        [serde_json::json!(faces.parse::<usize>().unwrap()), choice.into()]
    );
    assert_eq!(report(&["--backend", "kdop"]), [14.into(), serde_json::Value::Null]);
    assert_eq!(report(&[]), [serde_json::Value::Null, serde_json::Value::Null]);
    let wrong = failure(&[&query[..], &["--k", "-6"]].concat(), 2);
    assert!(wrong.contains("invalid value '-6' for '--k <K>'"), "{wrong}");
    let output = p2m(&["query", SCENE, "--random", "5", "--k", "14"]);
    assert!(text(&output.stderr).contains("--k is for --backend kdop"), "{}", text(&output.stderr));
    assert_eq!(output.code, 2);
}

/// Returns the text after `start` in a line of the summary.
fn after<'a>(summary: &'a str, start: &str) -> &'a str {
    summary.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_else(|| panic!("{start}: {summary}"))
}

#[test]
#[allow(clippy::cast_precision_loss, reason = "a small count")]
fn the_summary_agrees_with_the_table() {
    let output = p2m(&["query", SCENE, "--random", "500", "--max-distance", "0.7", "--threads", "3"]);
    let (table, summary) = (text(&output.stdout), text(&output.stderr));
    let distances: Vec<f64> =
        table.lines().skip(1).filter_map(|line| line.split(',').nth(6).unwrap().parse().ok()).collect();
    let answered = distances.len();
    assert!((1..500).contains(&answered), "{answered}");
    assert!(after(&summary, "queries  500 in ").contains(" on 3 threads: "), "{summary}");
    assert_eq!(after(&summary, "answers  "), format!("{answered}, without answer {}", 500 - answered));
    let min = distances.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    let max = distances.iter().fold(0.0f64, |a, &b| a.max(b));
    let mean = distances.iter().sum::<f64>() / answered as f64;
    assert_eq!(
        after(&summary, "distance "),
        format!("min {}, max {}, mean {}", Length(min), Length(max), Length(mean))
    );
}

#[test]
fn given_points_are_answered_in_their_order() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 5 5 1e300\nf 1 2 3\np 4\n");
    let points = write(&folder, "q.xyz", "0.5 .25 3\n# so\n1 -2 0\n3 0 0\n5 5 1.5e300\n");
    let expected = format!(
        "{HEADER}\n0.5,0.25,3.0,0.5,0.25,0.0,3.0,0,face\n1.0,-2.0,0.0,1.0,0.0,0.0,2.0,0,edge0\n\
        3.0,0.0,0.0,2.0,0.0,0.0,1.0,0,vertex1\n5.0,5.0,1.5e300,5.0,5.0,1e300,"
    );
    let answers = table(&["query", &scene, "--points", &points, "--backend", "brute"]);
    assert_eq!(answers, table(&["query", &scene, "--points", &points]));
    assert!(answers.starts_with(&expected), "{answers}");
    assert!(answers.lines().last().unwrap().ends_with(",1,vertex0"), "{answers}");
    // The table itself is a file of the same queries.
    let again = write(&folder, "q.csv", &answers);
    assert_eq!(table(&["query", &scene, "--points", &again]), answers);
}

#[test]
fn no_answer_leaves_empty_fields() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\np 1\n");
    let points = write(&folder, "q.csv", "x,y,z\n1,0,0\n2,0,0\n3,0,0\n");
    let expected = format!(
        "{HEADER}\n1.0,0.0,0.0,0.0,0.0,0.0,1.0,0,vertex0\n2.0,0.0,0.0,0.0,0.0,0.0,2.0,0,vertex0\n3.0,0.0,0.0,,,,,,\n"
    );
    for backend in ["brute", "aabb"] {
        assert_eq!(
            table(&["query", &scene, "--points", &points, "--max-distance", "2", "--backend", backend]),
            expected
        );
    }
}

#[test]
fn an_empty_scene_has_no_answers() {
    let folder = TempDir::new().unwrap();
    let obj = write(&folder, "e.obj", "# nothing\n");
    let ply = write(
        &folder,
        "e.ply",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
    );
    for scene in [obj, ply] {
        for backend in ["brute", "aabb"] {
            let output = p2m(&["query", &scene, "--grid", "2", "--backend", backend]);
            assert_eq!(output.code, 0);
            let table = text(&output.stdout);
            assert_eq!(table.lines().count(), 9);
            assert!(table.lines().skip(1).all(|l| l.ends_with(",,,,,,")), "{table}");
            assert!(text(&output.stderr).contains("the scene is empty"));
        }
    }
    let scene = write(&folder, "p.obj", "v 0 0 0\n");
    assert_eq!(table(&["query", &scene, "--random", "0"]), format!("{HEADER}\n"));
}

#[test]
fn flat_scenes_are_asked_about_from_both_sides() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "flat.obj", "v 0 0 3\nv 4 0 3\nv 0 4 3\nf 1 2 3\n");
    let table = table(&["query", &scene, "--random", "100", "--box-scale", "1.5"]);
    let z: Vec<f64> = table.lines().skip(1).map(|l| l.split(',').nth(2).unwrap().parse().unwrap()).collect();
    assert!(
        z.iter().any(|&z| z > 3.5) && z.iter().any(|&z| z < 2.5) && z.iter().all(|z| (2.0..=4.0).contains(z)),
        "{z:?}"
    );
}

#[test]
fn both_backends_print_the_same_table_for_every_model() {
    for path in p2m_testkit::model_files() {
        let scene = path.to_str().unwrap();
        let with = |backend| table(&["query", scene, "--random", "40", "--box-scale", "1.5", "--backend", backend]);
        assert!(with("aabb") == with("brute"), "{scene}");
    }
}

#[test]
fn answers_come_in_every_format() {
    let folder = TempDir::new().unwrap();
    let expected = table(&["query", SCENE, "--random", "50", "--max-distance", "0.5"]);
    assert!(expected.contains(",,,,,,\n"), "some have no answer");
    for format in ["npy", "ply", "csv", "NPY"] {
        let out = path(&folder, &format!("answers.{format}"));
        assert_eq!(table(&["query", SCENE, "--random", "50", "--max-distance", "0.5", "--out", &out]), "");
        // The file of answers is a file of the same queries.
        assert_eq!(table(&["query", SCENE, "--points", &out, "--max-distance", "0.5"]), expected, "{format}");
        // The option names the format, for any file name and for the standard output.
        let unnamed = path(&folder, "answers");
        let arguments = ["query", SCENE, "--random", "50", "--max-distance", "0.5", "--out-format", format];
        table(&[&arguments[..], &["--out", &unnamed]].concat());
        assert_eq!(fs::read(&unnamed).unwrap(), fs::read(&out).unwrap(), "{format}");
        assert_eq!(p2m(&arguments).stdout, fs::read(&out).unwrap(), "{format}");
    }
    let npy = fs::read(path(&folder, "answers.npy")).unwrap();
    assert_eq!((&npy[..6], npy.len() % 64), (&b"\x93NUMPY"[..], 50 * 96 % 64));
    let message = failure(&["query", SCENE, "--random", "50", "--out", &path(&folder, "a.vtk")], 1);
    assert!(
        message
            .contains("unknown extension 'vtk', expected one of csv, npy, ply, or name the format with --out-format"),
        "{message}"
    );
}

#[test]
fn scene_or_points_come_from_the_standard_input() {
    let scene = fs::read(SCENE).unwrap();
    let expected = table(&["query", SCENE, "--random", "20"]);
    let output = p2m_with(&["query", "-", "--format", "obj", "--random", "20"], &scene);
    assert_eq!(text(&output.stdout), expected);
    assert!(text(&output.stderr).starts_with("scene    standard input\n"), "{}", text(&output.stderr));
    let output = p2m_with(&["query", SCENE, "--points", "-", "--points-format", "csv"], &expected);
    assert_eq!(text(&output.stdout), expected);
    let output = p2m_with(&["query", SCENE, "--points", "-", "--points-format", "xyz"], "1 2 3\n1 x 3\n");
    assert!(
        text(&output.stderr).starts_with("error: standard input:2: 'x' is not a number"),
        "{}",
        text(&output.stderr)
    );
    for (arguments, why) in [
        (&["query", "-", "--random", "1"][..], "add --format obj|ply|stl|off"),
        (&["query", SCENE, "--points", "-"], "add --points-format obj|ply|stl|off|xyz|txt"),
        (&["query", "-", "--format", "obj", "--points", "-", "--points-format", "csv"], "cannot be both"),
        (&["query", SCENE, "--random", "1", "--points-format", "csv"], "--points"),
        (&["query", SCENE, "--random", "1", "--json"], "add --out FILE"),
    ] {
        let message = failure(arguments, 2);
        assert!(message.contains(why), "{arguments:?}: {message}");
    }
}

#[test]
fn the_json_summary_agrees_with_the_table() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "answers.csv");
    let arguments = ["query", SCENE, "--random", "200", "--seed", "3", "--max-distance", "0.7", "--threads", "2"];
    let output = p2m(&[&arguments[..], &["--out", &out, "--json"]].concat());
    assert_eq!(text(&output.stderr), "");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let table = fs::read_to_string(&out).unwrap();
    let distances: Vec<f64> = table.lines().skip(1).filter_map(|l| l.split(',').nth(6).unwrap().parse().ok()).collect();
    let answered = distances.len() as u64;
    assert!((1..200).contains(&answered), "{answered}");
    for time in ["read", "build", "query"] {
        assert!(report["seconds"][time].as_f64().unwrap() > 0.0, "{report}");
    }
    let mut rest = report.clone();
    rest.as_object_mut().unwrap().shift_remove("seconds");
    let error = rest.as_object_mut().unwrap().shift_remove("error").unwrap();
    // The error is at most 8 u M with M up to twice the size of the scene, and no lower bound is above its distance.
    assert!(error["min"].as_f64().unwrap() >= 0.0 && error["max"].as_f64().unwrap() < 1e-14, "{error}");
    let expected = serde_json::json!({
        "p2m": "query",
        "version": 4,
        "scene": {
            "file": SCENE,
            "format": "obj",
            "primitives": { "triangles": 3600, "segments": 480, "points": 0 },
            "skipped": [],
        },
        "backend": "aabb",
        "backend_reason": null,
        "loaded": false,
        "faces": null,
        "directions_reason": null,
        "cells": null,
        "threads": 2,
        "max_distance": 0.7,
        "accuracy": { "epsilon": null, "max_visits": null, "certified": false },
        "source": { "random": 200, "seed": 3, "box_scale": 1.05 },
        "queries": 200,
        "answered": answered,
        "unanswered": 200 - answered,
        "answers": answered,
        "distance": {
            "min": distances.iter().fold(f64::INFINITY, |a, &b| a.min(b)),
            "max": distances.iter().fold(0.0f64, |a, &b| a.max(b)),
            "mean": distances.iter().sum::<f64>() / answered as f64,
        },
        "sign_rule": null,
        "inside": null,
        "out": { "file": out, "format": "csv", "bytes": table.len() },
    });
    assert_eq!(rest, expected);
}

#[test]
fn json_has_no_numbers_that_are_none() {
    let folder = TempDir::new().unwrap();
    let (scene, out) = (write(&folder, "s.obj", "v -1.7e308 0 0\np 1\n"), path(&folder, "a.npy"));
    let points = write(&folder, "q.xyz", "1.7e308 0 0\n");
    // The distance is beyond the range of f64.
    let report = json(&["query", &scene, "--points", &points, "--max-distance", "inf", "--out", &out, "--json"]);
    assert_eq!(report["max_distance"], serde_json::Value::Null);
    assert_eq!(report["distance"], serde_json::json!({ "min": null, "max": null, "mean": null }));
    assert_eq!(report["source"], serde_json::json!({ "points": points }));
    let report = json(&["query", &scene, "--grid", "2", "--max-distance", "0", "--out", &out, "--json"]);
    assert_eq!((&report["distance"], &report["unanswered"]), (&serde_json::Value::Null, &8.into()));
    assert_eq!(report["source"], serde_json::json!({ "grid": 2, "box_scale": 1.05 }));
}

/// Returns the distances of 300 random queries, and the report.
fn distances(out: &str, options: &[&str]) -> (Vec<f64>, serde_json::Value) {
    let report = json(&[&["query", SCENE, "--random", "300", "--out", out, "--json"], options].concat());
    let table = fs::read_to_string(out).unwrap();
    let column = |line: &str| line.split(',').nth(6).unwrap().parse().unwrap();
    (table.lines().skip(1).map(column).collect(), report)
}

#[test]
fn accuracy_is_traded_within_what_is_told() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "a.csv");
    let (exact, _) = distances(&out, &[]);
    for backend in ["aabb", "kdop", "octree", "p2m"] {
        let ask = |options: &[&str]| distances(&out, &[&["--backend", backend], options].concat());
        let (certified, report) = ask(&["--certified"]);
        assert_eq!(report["accuracy"]["certified"], true);
        let last_place = |(a, b): (&f64, &f64)| (a - b).abs() <= 64.0 * f64::EPSILON * a.max(0.1);
        assert!(certified.iter().zip(&exact).all(last_place), "{backend}");
        let (rough, report) = ask(&["--epsilon", "0.3"]);
        assert_eq!(report["accuracy"]["epsilon"], 0.3);
        assert!(rough.iter().zip(&exact).all(|(a, b)| b <= a && *a <= b * 1.3 * (1.0 + 1e-15)), "{backend}");
        let (budget, report) = ask(&["--max-visits", "0"]);
        assert_eq!(report["accuracy"]["max_visits"], 0);
        assert_eq!(ask(&["--budget", "0"]).0, budget, "the old name of the option");
        assert!(budget.iter().zip(&exact).all(|(a, b)| b <= a) && budget != exact, "{backend}");
        let most = budget.iter().zip(&exact).map(|(a, b)| a - b).fold(0.0, f64::max);
        assert!(report["error"]["max"].as_f64().unwrap() >= most, "{backend}: {report}");
    }
    for wrong in
        [&["--epsilon", "-1"][..], &["--epsilon", "nan"], &["--max-visits", "many"], &["--certified", "--epsilon", "1"]]
    {
        assert_eq!(p2m(&[&["query", SCENE, "--random", "3"], wrong].concat()).code, 2, "{wrong:?}");
    }
}

#[cfg(feature = "paper")]
#[test]
fn the_parts_of_a_p2m_index_may_be_chosen() {
    let folder = TempDir::new().unwrap();
    let saved = path(&folder, "scene.p2m");
    table(&["build", SCENE, "--backend", "p2m", "--out", &saved]);
    let expected = table(&["query", SCENE, "--random", "200", "--box-scale", "9"]);
    for scene in [SCENE, &saved] {
        for parts in [
            &["--locator", "kd-tree"][..],
            &["--filter", "r-tree"],
            &["--locator", "KD-tree", "--filter", "R-tree"],
            &["--locator", "grid", "--filter", "sorted"],
        ] {
            let query = ["query", scene, "--random", "200", "--box-scale", "9", "--backend", "p2m"];
            let run = p2m(&[&query[..], parts].concat());
            assert_eq!(text(&run.stdout), expected, "{parts:?}");
            // A saved index has the default parts, so others are built.
            let is_loaded = scene == saved && parts.contains(&"grid");
            let verb = if is_loaded { "loaded in" } else { "built in" };
            assert!(text(&run.stderr).contains(&format!("backend  p2m, {verb}")), "{}", text(&run.stderr));
        }
    }
    let stats = p2m(&["stats", SCENE, "--backend", "p2m", "--locator", "kd-tree", "--filter", "r-tree"]);
    assert_eq!(stats.code, 0, "{}", text(&stats.stderr));
    for (arguments, message) in [
        (&["query", SCENE, "--random", "5", "--locator", "grid"][..], "--locator is for --backend p2m"),
        (
            &["query", SCENE, "--random", "5", "--backend", "octree", "--filter", "r-tree"],
            "--filter is for --backend p2m",
        ),
        (&["stats", SCENE, "--backend", "aabb", "--locator", "kd-tree"], "--locator is for --backend p2m"),
        (
            &["build", SCENE, "--backend", "kdop", "--locator", "grid", "--out", &saved],
            "--locator is for --backend p2m",
        ),
        (
            &["build", SCENE, "--backend", "p2m", "--filter", "r-tree", "--out", &saved],
            "a saved index has --locator grid",
        ),
        (
            &["query", SCENE, "--random", "5", "--backend", "p2m", "--locator", "tree"],
            "[possible values: grid, kd-tree]",
        ),
    ] {
        let wrong = failure(arguments, 2);
        assert!(wrong.contains(message), "{arguments:?}: {wrong}");
    }
}

#[test]
fn clouds_are_scenes() {
    let folder = TempDir::new().unwrap();
    let scan = write(&folder, "scan.xyz", "//X Y Z intensity\n3\n0 0 0 9\nnan nan nan 9\n5 0 0 9\n");
    let points = write(&folder, "points.csv", "id;x;y;z\n1;1;0;0\n2;5;0;2\n");
    let answers = table(&["query", &scan, "--points", &points, "--columns", "distance,primitive"]);
    assert_eq!(answers, "distance,primitive\n1.0,0\n2.0,1\n");
    let info = table(&["info", &scan]);
    assert!(info.contains("2 points") && info.contains("not finite"), "{info}");
    // Clouds are written as well, and nothing else is written as a cloud.
    let (csv, asc) = (path(&folder, "out.csv"), path(&folder, "out.asc"));
    assert_eq!(p2m(&["convert", &scan, &csv]).code, 0);
    assert_eq!(fs::read_to_string(&csv).unwrap(), "x,y,z\n0.0,0.0,0.0\n5.0,0.0,0.0\n");
    assert_eq!(p2m(&["convert", &csv, &asc]).code, 0);
    assert_eq!(fs::read_to_string(&asc).unwrap(), "0.0 0.0 0.0\n5.0 0.0 0.0\n");
    let npy = path(&folder, "out.npy");
    assert_eq!(p2m(&["convert", &scan, &npy]).code, 0);
    assert_eq!(table(&["query", &npy, "--points", &points, "--columns", "distance,primitive"]), answers);
    let again = path(&folder, "again.csv");
    assert_eq!(p2m(&["convert", &npy, &again]).code, 0);
    assert_eq!(fs::read_to_string(&again).unwrap(), "x,y,z\n0.0,0.0,0.0\n5.0,0.0,0.0\n");
    let message = failure(&["convert", SCENE, &npy], 1);
    assert!(message.contains("primitive 0 is no point"), "{message}");
    let message = failure(&["convert", SCENE, &csv], 1);
    assert!(message.contains("primitive 0 is no point, and a table of points holds nothing else"), "{message}");
    assert_eq!(fs::read_to_string(&csv).unwrap(), "x,y,z\n0.0,0.0,0.0\n5.0,0.0,0.0\n");
}

#[test]
fn counts_may_have_exponents_and_marks() {
    for (text, count) in [("1e3", 1000), ("1_000", 1000), ("1,000", 1000), ("25", 25)] {
        let output = p2m(&["query", SCENE, "--random", text]);
        assert_eq!(self::text(&output.stdout).lines().count(), count + 1, "{text}");
    }
    for text in ["1e-3", "1.5", "-1", "1e30", "", "e3"] {
        assert!(failure(&["query", SCENE, "--random", text], 2).contains("not a whole number"), "{text}");
    }
    assert!(
        failure(&["view", SCENE, "--random", "1e6", "--out", "never.html"], 2).contains("1000000 is not in 0..=100000")
    );
}

#[test]
fn names_of_files_control_no_terminal() {
    let message = failure(&["info", "nofile\u{1b}[31m.obj"], 1);
    assert!(message.contains("nofile\\u{1b}[31m.obj: cannot be read"), "{message:?}");
    let message = failure(&["info", "a\nb.obj"], 1);
    assert!(message.contains("a\\nb.obj: cannot be read") && message.lines().count() == 1, "{message:?}");
    // A file that is missing has no wrong extension.
    assert!(failure(&["query", "she", "--random", "1"], 1).contains("she: cannot be read: "));
}
