//! Tests of `p2m distance`.

use crate::common::*;
use serde_json::Value;
use tempfile::TempDir;

const LOW: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\no floor\nf 1 2 3\n";
const HIGH: &str = "v 1 1 2\nv 1 2 3\nl 1 2\n";

#[test]
fn the_nearest_points_of_two_scenes_are_named() {
    let folder = TempDir::new().unwrap();
    let (low, high) = (write(&folder, "low.obj", LOW), write(&folder, "high.obj", HIGH));
    let text = table(&["distance", &low, &high]);
    let lines: Vec<_> = text.lines().collect();
    assert!(lines[0].starts_with("distance 2, at most ") && lines[0].ends_with("e-14 too large"), "{text}");
    assert_eq!(lines[1], format!("on {low}: (1, 1, 0), triangle 0 (face) of floor"));
    assert_eq!(lines[2], format!("on {high}: (1, 1, 2), segment 0 (vertex0)"));
    let report = json(&["distance", &low, &high, "--json"]);
    assert_eq!((report["distance"].as_f64(), report["intersect"].as_bool()), (Some(2.0), Some(false)));
    assert_eq!(report["scenes"][0]["nearest"]["object"], "floor");
}

#[test]
fn the_second_scene_moves() {
    let folder = TempDir::new().unwrap();
    let (low, high) = (write(&folder, "low.obj", LOW), write(&folder, "high.obj", HIGH));
    let down = "1 0 0 0  0 1 0 0  0 0 1 -2.5";
    let file = write(&folder, "down.txt", format!("{down}\n0 0 0 1\n"));
    for transform in [down, &file] {
        let report = json(&["distance", &low, &high, "--transform", transform, "--json"]);
        assert_eq!((report["distance"].as_f64(), report["intersect"].as_bool()), (Some(0.0), Some(true)));
        assert!(table(&["distance", &low, &high, "--transform", transform]).starts_with("the scenes intersect\n"));
    }
    // A quarter turn about x: the segment then ends at (1, -2, 1).
    let turned = json(&["distance", &low, &high, "--transform", "1 0 0 0, 0 0 -1 0, 0 1 0 0", "--json"]);
    assert!((turned["distance"].as_f64().unwrap() - 5f64.sqrt()).abs() < 1e-15, "{turned}");
}

#[test]
fn solids_contain_what_is_inside() {
    let folder = TempDir::new().unwrap();
    let (tank, arm) = (path(&folder, "tank.ply"), path(&folder, "arm.obj"));
    table(&["generate", "ico-sphere", "--out", &tank]);
    std::fs::write(&arm, "v 0 0 0\nv 0.1 0 0\nl 1 2\n").unwrap();
    assert!(json(&["distance", &tank, &arm, "--json"])["distance"].as_f64() > Some(0.8));
    for scenes in [[&tank, &arm], [&arm, &tank]] {
        let report = json(&["distance", scenes[0], scenes[1], "--solid", "--json"]);
        assert_eq!(
            (report["distance"].as_f64(), &report["intersect"], &report["solid"]),
            (Some(0.0), &true.into(), &true.into())
        );
        assert!(table(&["distance", scenes[0], scenes[1], "--solid"]).starts_with("the scenes intersect\n"));
    }
    let away = ["distance", &tank, &arm, "--transform", "1 0 0 5  0 1 0 0  0 0 1 0", "--solid", "--json"];
    assert!(json(&away)["distance"].as_f64() > Some(3.9));
    let open = write(&folder, "open.obj", LOW);
    // The warning names the scene, whichever it is.
    for scenes in [[&open, &arm], [&arm, &open]] {
        let warning = text(&p2m(&["distance", scenes[0], scenes[1], "--solid"]).stderr);
        assert!(warning.starts_with(&format!("warning  {open}: the surface is open")), "{warning}");
        assert_eq!(warning.lines().count(), 1, "{warning}");
    }
    // A stray segment in the tank, which is no part of its surface.
    let stray = path(&folder, "stray.obj");
    table(&["convert", &tank, &stray]);
    let shell = std::fs::read_to_string(&stray).unwrap();
    std::fs::write(&stray, shell + "v 5 0 0\nv 6 0 0\nl -1 -2\n").unwrap();
    let output = p2m(&["distance", &stray, &arm, "--solid"]);
    assert!(text(&output.stderr).contains("nothing of it counts as filled"), "{}", text(&output.stderr));
    assert!(text(&output.stdout).starts_with("distance 0."), "{}", text(&output.stdout));
    // The arm has no triangles, so nobody expects an inside.
    assert_eq!(text(&p2m(&["distance", &tank, &arm, "--solid"]).stderr), "");
}

#[test]
fn limits_and_wrong_arguments_are_told() {
    let folder = TempDir::new().unwrap();
    let (low, high) = (write(&folder, "low.obj", LOW), write(&folder, "high.obj", HIGH));
    assert_eq!(table(&["distance", &low, &high, "--max-distance", "1.5"]), "nothing is within 1.5\n");
    assert_eq!(json(&["distance", &low, &high, "--max-distance", "2", "--json"])["distance"], 2.0);
    let apart = json(&["distance", &low, &high, "--max-distance", "1.5", "--json"]);
    assert_eq!(
        (&apart["distance"], &apart["lower_bound"], &apart["intersect"]),
        (&Value::Null, &1.5.into(), &false.into())
    );
    let empty = write(&folder, "empty.off", "OFF\n0 0 0\n");
    assert_eq!(table(&["distance", &low, &empty]), "a scene is empty\n");
    let wrong = |transform: &str| failure(&["distance", &low, &high, "--transform", transform], 2);
    assert!(wrong("1 0 0").contains("3 numbers are no matrix"), "{}", wrong("1 0 0"));
    assert!(wrong("2 0 0 0 0 1 0 0 0 0 1 0").contains("no rotation"));
    assert!(wrong("1 0 0 nan 0 1 0 0 0 0 1 0").contains("not finite"));
    assert!(failure(&["distance", &low, &high, "--transform", "missing.txt"], 1).contains("missing.txt"));
    failure(&["distance", &low, &high, "--max-distance", "-1"], 2);
}
