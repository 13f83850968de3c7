//! Tests of `p2m info`: the report for people and the one for programs.

use crate::common::*;
use p2m_formats::FileFormat;
use serde_json::{Value, json};
use tempfile::TempDir;

/// A scene with a corner of a cube, a pole, and common defects: duplicates, unused positions and names
/// with control characters.
const COURT: &str = "mtllib x.mtl\nv 0 0 0\nv 3 0 0\nv 0 4 0\nv 0 0 12\nv nan 0 0\no wall\nf 1 3 2\nf 1 2 4\no pole\u{7}\nl 1 4\n\
    o wall\nf 1 4 3\nf 1 3 4\nf 1 2 2\no\np 1\n";

#[test]
fn the_report_is_what_the_scene_is() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "court.obj", COURT);
    let build = &json(&["info", &scene, "--json"])["build"];
    let (crates, default) = (&build["crates"], &build["default_crates"]);
    let expected = format!(
        "\
scene       {scene} (obj)
primitives  5 triangles, 1 segment, 1 point
objects     wall: 5 triangles
            pole\\u{{7}}: 1 segment
            (without a name): 1 point
positions   5, 4 of them used
box         (0, 0, 0) to (3, 4, 12), diagonal 13
edges       3 to 12.65
areas       6 to 24
shapes      median aspect 3.333, 0 % thin, 0 % slivers, 1 without area
surface     6 edges, 2 on the boundary, 2 of more than two triangles
parts       1
in f32      exact
skipped     1 x mtllib
build       triangles, segments, points: default-features = false, features = [\"bvh\", \"scene\"]: {crates} crates \
         instead of {default}

- 1 triangle has no area: it counts as the segment or point that it covers.
- 1 primitive repeats another one: among equals the lowest number is the answer.
- 2 edges belong to more than two triangles: closest points are not affected, inside and outside may be.
- 1 position belongs to no primitive and counts for nothing.
"
    );
    assert_eq!(table(&["info", &scene]), expected);
}

#[test]
fn the_json_report_has_the_same_figures() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "court.obj", COURT);
    let report = json(&["info", &scene, "--json"]);
    let counts = |triangles: u32, segments: u32, points: u32| json!({ "triangles": triangles, "segments": segments, "points": points });
    let expected = json!({
        "p2m": "info",
        "version": 4,
        "file": scene,
        "format": "obj",
        "index": null,
        "primitives": counts(5, 1, 1),
        "objects": [
            { "name": "wall", "primitives": counts(5, 0, 0) },
            { "name": "pole\u{7}", "primitives": counts(0, 1, 0) },
            { "name": null, "primitives": counts(0, 0, 1) },
        ],
        "positions": { "total": 5, "used": 4, "distinct": 4 },
        "bounds": { "min": [0.0, 0.0, 0.0], "max": [3.0, 4.0, 12.0] },
        "diagonal": 13.0,
        "edge_length": { "min": 3.0, "max": 160f64.sqrt() },
        "area": { "min": 6.0, "max": 24.0 },
        "shapes": { "zero_area": 1, "zero_length": 0, "slivers": 0, "thin": 0, "median_aspect": 160.0 / 48.0 },
        "duplicates": counts(1, 0, 0),
        "edges": { "total": 6, "boundary": 2, "non_manifold": 2, "inconsistent": 0 },
        "closed": false,
        "components": 1,
        "location": {
            "distance_from_origin": 6.5,
            "largest_coordinate": 12.0,
            "beyond_f32": 0,
            "f32_step": f64::from(f32::EPSILON) * 8.0,
            "f64_step": f64::EPSILON * 8.0,
        },
        "skipped": [{ "kind": "mtllib", "count": 1 }],
        "unit": null,
    });
    let mut found = report.clone();
    let notes = found.as_object_mut().unwrap().shift_remove("notes").unwrap();
    let build = found.as_object_mut().unwrap().shift_remove("build").unwrap();
    assert_eq!(build["features"], json!(["bvh", "scene"]));
    assert_eq!(found, expected);
    let names: Vec<_> = notes.as_array().unwrap().iter().map(|n| n["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["zero_area", "duplicates", "non_manifold", "unused"]);
    assert!(table(&["info", &scene]).contains(&notes[1]["text"].as_str().unwrap()[2..]));
}

#[test]
fn the_carried_scene_has_its_figures() {
    let report = json(&["info", SCENE, "--json"]);
    let figure = |path: &str| report.pointer(path).unwrap().clone();
    assert_eq!((figure("/primitives/triangles"), figure("/primitives/segments")), (json!(3600), json!(480)));
    assert_eq!(
        (figure("/edges/total"), figure("/closed"), figure("/components")),
        (json!(5400), json!(true), json!(6))
    );
    assert_eq!((figure("/positions/total"), figure("/notes")), (json!(2285), json!([])));
    // The tube is closed, so it has half as many vertices as triangles.
    assert_eq!(figure("/bounds/max/0"), json!(3.145));
    let text = table(&["info", SCENE]);
    assert!(
        text.contains("\nprimitives  3,600 triangles, 480 segments\n") && text.contains("by up to 1.192e-7\nbuild  "),
        "{text}"
    );
}

#[test]
fn scenes_come_from_the_standard_input() {
    let file = std::fs::read(SCENE).unwrap();
    let output = p2m_with(&["info", "-", "--format", "obj", "--json"], &file);
    assert_eq!(output.code, 0);
    let mut report: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!(report["file"], "standard input");
    report["file"] = SCENE.into();
    assert_eq!(report, json(&["info", SCENE, "--json"]));
    let message = text(&p2m_with(&["info", "-"], &file).stderr);
    assert!(message.contains("add --format obj|ply|stl|off") && message.contains("'p2m info --help'"), "{message}");
    failure(&["info", "-"], 2);
    // The message names a line of the standard input.
    let output = p2m_with(&["info", "-", "--format", "off"], "OFF\n1 0 0\n0 0 x\n");
    assert_eq!(text(&output.stderr), "error: standard input:3: 'x' is not a number that fits here\n");
}

#[test]
fn the_given_format_goes_before_the_extension() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "scene.scn", "v 0 0 0\np 1\n");
    let message = failure(&["info", &scene], 1);
    let names = FileFormat::names().join(", ");
    let expected = format!("unknown extension 'scn', expected one of {names}, or name the format with --format");
    assert!(message.contains(&expected), "{message}");
    assert_eq!(json(&["info", &scene, "--format", "obj", "--json"])["primitives"]["points"], 1);
    let message = failure(&["info", &scene, "--format", "step"], 2);
    let expected = format!("invalid value 'step' for '--format <FORMAT>'\n  [possible values: {names}]");
    assert!(message.contains(&expected), "{message}");
}

#[test]
fn empty_and_extreme_scenes_are_reported_in_finite_numbers() {
    let folder = TempDir::new().unwrap();
    let empty = write(&folder, "e.obj", "o x\n");
    let report = json(&["info", &empty, "--json"]);
    assert_eq!(
        (&report["bounds"], &report["edge_length"], &report["diagonal"]),
        (&Value::Null, &Value::Null, &json!(0.0))
    );
    assert!(table(&["info", &empty]).contains("\nprimitives  none\n"));
    for size in ["1e-300", "5e-324", "1.7e308"] {
        let text = format!("v -{size} 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\nv {size} {size} {size}\nl 1 4\n");
        let report = json(&["info", &write(&folder, "x.obj", text), "--json"]);
        assert_eq!(report["notes"][0]["name"], "extreme_scale", "{size}");
        let numbers = ["/diagonal", "/edge_length/min", "/edge_length/max", "/area/min", "/location/f64_step"];
        for number in numbers {
            assert!(report.pointer(number).unwrap().as_f64().unwrap() > 0.0, "{size} {number}: {report}");
        }
        assert_eq!(report["shapes"]["median_aspect"], 2.0, "{size}");
    }
    // Coordinates beyond the range of f32 have no step in f32.
    let report = json(&["info", &write(&folder, "y.obj", "v 1e300 0 0\np 1\n"), "--json"]);
    assert_eq!(report["location"]["f32_step"], Value::Null);
}

#[test]
fn boxes_have_the_digits_that_their_size_needs() {
    let folder = TempDir::new().unwrap();
    for (corners, expected) in [
        ("v 500000.25 0 -2\nv 500000 -0.0000001 -2\n", "(500000, 0, -2) to (500000.25, 0, -2)"),
        ("v 90409.32 435440.44 0\nv 91453.879 436089.946 41.158\n", "(90409, 435440, 0) to (91454, 436090, 41)"),
        ("v 0.1 0 -2\nv 0.1 0 -2\n", "(0.1, 0, -2) to (0.1, 0, -2)"),
        ("v 1e300 0 -1.5e300\nv 0 0 0\n", "(0, 0, -1.5e300) to (1e300, 0, 0)"),
        ("v 0.123456 -0 100\nv 0.1 0 100\n", "(0.1, 0, 100) to (0.12346, 0, 100)"),
    ] {
        let report = table(&["info", &write(&folder, "s.obj", format!("{corners}l 1 2\n"))]);
        let found = report.lines().find_map(|l| l.strip_prefix("box         ")).unwrap();
        assert_eq!(found.split_once(", diagonal").unwrap().0, expected);
    }
}

#[test]
fn many_objects_are_cut_short_for_people_only() {
    let folder = TempDir::new().unwrap();
    let mut text = "v 0 0 0\n".to_owned();
    for i in 0..25 {
        text += &format!("o part{i}\np 1\n");
    }
    let scene = write(&folder, "parts.obj", text);
    let report = table(&["info", &scene]);
    assert!(report.contains("            part19: 1 point\n            and 5 more\n"), "{report}");
    assert_eq!(json(&["info", &scene, "--json"])["objects"].as_array().unwrap().len(), 25);
}

#[test]
fn what_cannot_be_read_is_named_with_its_place() {
    let folder = TempDir::new().unwrap();
    let corrupt = write(&folder, "corrupt.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    let message = failure(&["info", &corrupt], 1);
    assert!(message.contains("corrupt.off:6: vertex index 7 is out of range"), "{message}");
    let message = failure(&["info", &path(&folder, "missing.ply"), "--json"], 1);
    assert!(message.contains("missing.ply: cannot be read: "), "{message}");
}
