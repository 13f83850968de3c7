//! Tests of `p2m hausdorff`.

use crate::common::*;
use p2m_backends::BACKENDS;
use tempfile::TempDir;

const FLOOR: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\no floor\nf 1 2 3\n";
/// A floor of the same size, and a pole that stands on it.
const WITH_POLE: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0\nv 1 1 3\no ground\nf 1 2 3\no pole\nl 4 5\n";

#[test]
fn the_farthest_point_is_named() {
    let folder = TempDir::new().unwrap();
    let (floor, pole) = (write(&folder, "floor.obj", FLOOR), write(&folder, "pole.obj", WITH_POLE));
    let text = table(&["hausdorff", &floor, &pole]);
    let lines: Vec<_> = text.lines().collect();
    assert!(lines[0].starts_with("at least 2.99999999999999"), "{text}");
    assert!(lines[0].contains(" and at most 3.0000000000000"), "{text}");
    assert_eq!(lines[1], format!("farthest from {floor}:"));
    assert_eq!(lines[2], format!("on {pole}: (1, 1, 3), segment 1 of pole"));
    assert_eq!(lines[3..], ["closest to it:".to_owned(), format!("on {floor}: (1, 1, 0), triangle 0 of floor")]);
    let report = json(&["hausdorff", &floor, &pole, "--json"]);
    assert_eq!((report["from"].as_u64(), report["one_sided"].as_bool()), (Some(1), Some(false)));
    assert_eq!(report["scenes"][1]["farthest"]["object"], "pole");
    let diagonal = (4.0f64 * 4.0 + 4.0 * 4.0 + 3.0 * 3.0).sqrt();
    assert_eq!(report["tolerance"].as_f64(), Some(diagonal / 1e4));
}

#[test]
fn one_side_counts_points_of_the_first_scene_alone() {
    let folder = TempDir::new().unwrap();
    let (floor, pole) = (write(&folder, "floor.obj", FLOOR), write(&folder, "pole.obj", WITH_POLE));
    let upper = |first: &str, second: &str| {
        let report = json(&["hausdorff", first, second, "--one-sided", "--tolerance", "1e-6", "--json"]);
        (report["upper_bound"].as_f64().unwrap(), report["from"].as_u64())
    };
    assert!(upper(&floor, &pole).0 <= 1e-6, "{:?}", upper(&floor, &pole));
    let found = upper(&pole, &floor);
    assert!((3.0..=3.000_001).contains(&found.0) && found.1 == Some(0), "{found:?}");
}

#[test]
fn every_backend_and_number_of_threads_gives_the_same_report() {
    let folder = TempDir::new().unwrap();
    let (ball, ring) = (path(&folder, "ball.ply"), path(&folder, "ring.ply"));
    table(&["generate", "ico-sphere", "--frequency", "8", "--out", &ball]);
    table(&["generate", "torus-knot", "--rings", "60", "--sides", "12", "--out", &ring]);
    let expected = json(&["hausdorff", &ball, &ring, "--json"]);
    assert!(expected["lower_bound"].as_f64().unwrap() > 1.0, "{expected}");
    for backend in BACKENDS.iter().map(|backend| backend.name) {
        assert_eq!(json(&["hausdorff", &ball, &ring, "--backend", backend, "--json"]), expected, "{backend}");
    }
    assert_eq!(json(&["hausdorff", &ball, &ring, "--threads", "1", "--json"]), expected);
    let saved = path(&folder, "ball.p2m");
    table(&["build", &ball, "--backend", "octree", "--out", &saved]);
    let loaded = json(&["hausdorff", &saved, &ring, "--json"]);
    assert_eq!((&loaded["lower_bound"], &loaded["queries"]), (&expected["lower_bound"], &expected["queries"]));
    assert_eq!(loaded["scenes"][0]["format"], "p2m");
}

#[test]
fn the_second_scene_moves() {
    let folder = TempDir::new().unwrap();
    let (floor, pole) = (write(&folder, "floor.obj", FLOOR), write(&folder, "pole.obj", WITH_POLE));
    let up = "1 0 0 0  0 1 0 0  0 0 1 2";
    let report = json(&["hausdorff", &floor, &floor, "--transform", up, "--json"]);
    assert!((report["upper_bound"].as_f64().unwrap() - 2.0).abs() < 1e-3, "{report}");
    // An index that was saved before the motion is not used.
    let saved = path(&folder, "pole.p2m");
    table(&["build", &pole, "--out", &saved]);
    let report = json(&["hausdorff", &floor, &saved, "--transform", up, "--json"]);
    assert!((report["upper_bound"].as_f64().unwrap() - 5.0).abs() < 1e-3, "{report}");
    let far = "1 0 0 1e308  0 1 0 0  0 0 1 0";
    let huge = write(&folder, "huge.obj", "v 1e308 0 0\np 1\n");
    assert!(failure(&["hausdorff", &floor, &huge, "--transform", far], 1).contains("--transform"));
}

#[test]
fn limits_and_wrong_arguments_are_told() {
    let folder = TempDir::new().unwrap();
    let (floor, pole) = (write(&folder, "floor.obj", FLOOR), write(&folder, "pole.obj", WITH_POLE));
    let empty = write(&folder, "empty.off", "OFF\n0 0 0\n");
    assert!(failure(&["hausdorff", &floor, &empty], 1).contains("a scene is empty"));
    for tolerance in ["-1", "nan", "inf"] {
        failure(&["hausdorff", &floor, &pole, "--tolerance", tolerance], 2);
    }
    // Without further queries only vertices are asked.
    let points = write(&folder, "points.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\np 1\np 2\np 3\n");
    let queries =
        |limit: &str| json(&["hausdorff", &floor, &points, "--max-queries", limit, "--json"])["queries"].clone();
    assert_eq!(queries("0"), 6);
    assert!(queries("10").as_u64().is_some_and(|queries| queries > 6), "{}", queries("10"));
}

#[test]
fn a_tolerance_that_was_not_reached_is_said() {
    let folder = TempDir::new().unwrap();
    let floor = write(&folder, "floor.obj", FLOOR);
    let points = write(&folder, "points.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\np 1\np 2\np 3\n");
    for (limit, is_reached) in [("0", false), ("1000000", true)] {
        let args = ["hausdorff", &floor, &points, "--tolerance", "0.001", "--max-queries", limit];
        let text = table(&args);
        assert_eq!(text.contains("note: the tolerance of 0.001 was not reached"), !is_reached, "{text}");
        assert_eq!(json(&[&args[..], &["--json"]].concat())["reached"].as_bool(), Some(is_reached));
    }
}
