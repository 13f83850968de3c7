//! Tests of `p2m convert`: formats, changes and losses.

use crate::common::*;
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

/// Returns the figures of a scene that no format may change.
fn geometry(file: &str) -> Value {
    let report = json(&["info", file, "--json"]);
    let keys = ["primitives", "bounds", "edge_length", "area", "shapes", "edges", "duplicates", "components"];
    keys.iter().map(|key| report[key].clone()).collect()
}

#[test]
fn every_format_leads_back_to_the_same_scene() {
    let folder = TempDir::new().unwrap();
    let expected = table(&["query", SCENE, "--random", "100"]);
    let mut file = SCENE.to_owned();
    for format in ["ply", "off", "obj", "off", "ply"] {
        let next = path(&folder, &format!("next{}.{format}", fs::read_dir(&folder).unwrap().count()));
        assert_eq!(table(&["convert", &file, &next]), "");
        assert_eq!(geometry(&next), geometry(SCENE), "{format}");
        assert_eq!(table(&["query", &next, "--random", "100"]), expected, "{format}");
        file = next;
    }
}

#[test]
fn what_stl_cannot_hold_is_an_error() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out.stl");
    let message = failure(&["convert", SCENE, &out], 1);
    assert_eq!(
        message,
        format!(
            "error: {out}: cannot be written: primitive 3600 is no triangle, and an STL file holds nothing else: choose obj, \
            ply or off\n"
        )
    );
    let far = write(&folder, "far.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n");
    let message = failure(&["convert", &far, &out], 1);
    assert!(message.contains("coordinate 1e39, which is beyond the single precision"), "{message}");
    assert_eq!(names(folder.path()).len(), 1);
}

#[test]
fn conversions_report_what_is_lost() {
    let folder = TempDir::new().unwrap();
    let scene = write(
        &folder,
        "s.obj",
        "vn 0 0 1\nv 0 0 0\nv 0.1 0 0\nv 0 0.3 0\nv 0 0 1\nv 9 9 9\no a\nf 1 2 3\no b\nf 1 2 4\n",
    );
    let stl = path(&folder, "s.stl");
    let output = p2m(&["convert", &scene, &stl]);
    let expected = format!(
        "\
in       {scene} (obj): 2 triangles
skipped  1 x vn
out      {stl} (stl): 2 triangles, 184 bytes
lost     names of objects: 2
lost     positions that belong to no primitive: 1
lost     precision: coordinates rounded to f32: 2, by up to 1.192e-8
lost     which corners are shared: each triangle has its own
"
    );
    assert_eq!((output.code, text(&output.stderr), text(&output.stdout)), (0, expected, String::new()));
    let lost = |out: &str| json(&["convert", &scene, out, "--json"])["out"]["lost"].clone();
    let rounding = f64::from(0.3f32) - 0.3;
    assert_eq!(
        lost(&stl),
        json!([
            { "kind": "names", "count": 2 },
            { "kind": "unused_positions", "count": 1 },
            { "kind": "precision", "count": 2, "largest": rounding.abs() },
            { "kind": "shared_positions" },
        ])
    );
    assert_eq!(lost(&path(&folder, "s.ply")), json!([{ "kind": "names", "count": 2 }]));
    assert_eq!(lost(&path(&folder, "t.obj")), json!([]));
    // Skipped records are reported with and without changes.
    let report = json(&["convert", &scene, &stl, "--json", "--subdivide", "1", "--gap", "0.5"]);
    assert_eq!(report["skipped"], json!([{ "kind": "vn", "count": 1 }]));
    // This scene has nothing that a format could lose.
    let plain = write(&folder, "plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(json(&["convert", &plain, &stl, "--json"])["out"]["lost"], json!([]));
    // Text formats do not keep positions that no primitive uses.
    let alone = write(
        &folder,
        "alone.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
        property float z\nelement point 0\nproperty int vertex_index\nend_header\n1 2 3\n",
    );
    assert_eq!(
        json(&["convert", &alone, &path(&folder, "alone.off"), "--json"])["out"]["lost"],
        json!([{ "kind": "unused_positions", "count": 1 }])
    );
}

#[test]
fn polygons_that_are_cut_are_told() {
    let folder = TempDir::new().unwrap();
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 0\nf 1 2 3 4\nf 1 2 3\nl 1 2 3\nf 4 3 2 1\nf 1 2 3 5 4\n";
    let (scene, out) = (write(&folder, "s.obj", text), path(&folder, "s.ply"));
    let report = json(&["convert", &scene, &out, "--json"]);
    assert_eq!(report["in"]["primitives"], json!({ "triangles": 8, "segments": 2, "points": 0 }));
    assert_eq!(report["out"]["lost"], json!([{ "kind": "polygons", "count": 3 }]));
    // Changes to the scene do not change the losses.
    let report = json(&["convert", &scene, &out, "--subdivide", "1", "--json"]);
    assert_eq!(report["out"]["lost"], json!([{ "kind": "polygons", "count": 3 }]));
    let message = text_of_error(&["convert", &scene, &out]);
    assert!(
        message.ends_with("\nlost     polygons: 3 are written as the triangles that they are cut into\n"),
        "{message}"
    );
    // The triangles of the written file count as no polygons.
    assert_eq!(json(&["convert", &out, &path(&folder, "t.off"), "--json"])["out"]["lost"], json!([]));
}

fn text_of_error(arguments: &[&str]) -> String {
    text(&p2m(arguments).stderr)
}

#[test]
fn the_report_says_what_was_done() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nl 1 2\np 1\n");
    let out = path(&folder, "s.off");
    let report = json(&["convert", &scene, &out, "--subdivide", "1", "--translate", "1", "-2", "0.5", "--json"]);
    let expected = json!({
        "p2m": "convert",
        "version": 4,
        "in": { "file": scene, "format": "obj", "primitives": { "triangles": 1, "segments": 1, "points": 1 } },
        "changes": [{ "change": "subdivide", "by": 1 }, { "change": "translate", "by": [1.0, -2.0, 0.5] }],
        "out": {
            "file": out,
            "format": "off",
            "bytes": fs::metadata(&out).unwrap().len(),
            "primitives": { "triangles": 4, "segments": 2, "points": 1 },
            "positions": 6,
            "lost": [],
        },
        "skipped": [],
    });
    assert_eq!(report, expected);
    assert_eq!(json(&["info", &out, "--json"])["bounds"], json!({ "min": [1.0, -2.0, 0.5], "max": [5.0, 2.0, 0.5] }));
}

/// Returns a triangle with legs 4 and 2 after the given changes, as lines of an OBJ file.
fn changed(changes: &[&str]) -> String {
    let input = "v 0 0 0\nv 4 0 0\nv 0 2 0\nf 1 2 3\n";
    let output = p2m_with(&[&["convert", "-", "-", "--from", "obj", "--to", "obj"], changes].concat(), input);
    assert_eq!(output.code, 0, "{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn changes_come_in_their_order() {
    assert_eq!(changed(&["--rotate-z", "90"]), "v 0.0 0.0 0.0\nv 0.0 4.0 0.0\nv -2.0 0.0 0.0\nf 1 2 3\n");
    assert_eq!(changed(&["--rotate-x", "90"]), "v 0.0 0.0 0.0\nv 4.0 0.0 0.0\nv 0.0 0.0 2.0\nf 1 2 3\n");
    assert_eq!(changed(&["--rotate-y", "-90"]), "v 0.0 0.0 0.0\nv 0.0 0.0 4.0\nv 0.0 2.0 0.0\nf 1 2 3\n");
    // In any order of the options, the scene is rotated, then scaled, then translated.
    let expected = "v 1.0 0.0 0.0\nv 1.0 2.0 0.0\nv 0.0 0.0 0.0\nf 1 2 3\n";
    assert_eq!(changed(&["--rotate-z", "90", "--scale", "0.5", "--translate", "1", "0", "0"]), expected);
    assert_eq!(changed(&["--translate", "1", "0", "0", "--scale", "0.5", "--rotate-z", "90"]), expected);
    // The scene is subdivided before gaps open, so no two of the four small triangles share a corner.
    let shards = changed(&["--gap", "0.5", "--subdivide", "1"]);
    assert_eq!((shards.matches("v ").count(), shards.matches("f ").count()), (12, 4));
    let burr = changed(&["--penetrate", "3"]);
    assert!(burr.starts_with("v -2.66") && burr.matches("v ").count() == 3, "{burr}");
    let straight = changed(&["--subdivide", "2"]);
    let rough = changed(&["--subdivide", "2", "--displace", "0.1"]);
    assert_eq!(rough.matches("f ").count(), 16);
    assert_ne!(straight, rough);
    assert_ne!(rough, changed(&["--subdivide", "2", "--displace", "0.1", "--displace-seed", "2"]));
}

#[test]
fn names_stay_with_the_parts_of_their_primitives() {
    let folder = TempDir::new().unwrap();
    let text = "v 0 0 0\nv 4 0 0\nv 0 2 0\np 1\no a\nf 1 2 3\nl 1 2\no b\nl 2 3\nl 3 1\np 2\no a\nf 2 3 1\n";
    let (scene, out) = (write(&folder, "s.obj", text), path(&folder, "t.obj"));
    for changes in [&["--subdivide", "2"][..], &["--subdivide", "2", "--gap", "0.9", "--rotate-z", "5"]] {
        table(&[&["convert", &scene, &out], changes].concat());
        let objects = json(&["info", &out, "--json"])["objects"].clone();
        let counts = |triangles: u32, segments: u32, points: u32| json!({ "triangles": triangles, "segments": segments, "points": points });
        assert_eq!(
            objects,
            json!([
                { "name": "a", "primitives": counts(32, 4, 0) },
                { "name": "b", "primitives": counts(0, 8, 1) },
                { "name": null, "primitives": counts(0, 0, 1) },
            ])
        );
    }
}

#[test]
fn pipes_lead_through_formats() {
    let ply = p2m(&["convert", SCENE, "-", "--to", "ply"]);
    assert_eq!(ply.code, 0);
    assert!(text(&ply.stderr).contains("out      standard output (ply): 3,600 triangles, 480 segments"));
    let obj = p2m_with(&["convert", "-", "-", "--from", "ply", "--to", "obj"], &ply.stdout);
    assert!(text(&obj.stdout) == fs::read_to_string(SCENE).unwrap());
}

#[test]
fn wrong_usage_says_what_to_do() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out.obj");
    for (arguments, code, why) in [
        (&["convert", SCENE][..], 2, "<OUT>"),
        (&["convert", SCENE, "-"], 2, "add --to obj|ply|stl|off"),
        (&["convert", "-", &out], 2, "add --from obj|ply|stl|off"),
        (&["convert", SCENE, "-", "--to", "obj", "--json"], 2, "the scene has to go to a file"),
        (&["convert", SCENE, "scene.step"], 1, "or name the format with --to"),
        (&["convert", SCENE, &out, "--gap", "1.5"], 2, "must be above 0 and below 1"),
        (&["convert", SCENE, &out, "--gap", "-0.5"], 2, "must be above 0 and below 1"),
        (&["convert", SCENE, &out, "--penetrate", "0.5"], 2, "must be above 1"),
        (&["convert", SCENE, &out, "--gap", "0.5", "--penetrate", "2"], 2, "cannot be used with"),
        (&["convert", SCENE, &out, "--displace", "0.1"], 2, "--subdivide"),
        (&["convert", SCENE, &out, "--subdivide", "1", "--displace", "0.7"], 2, "must be from 0 to 0.5"),
        (&["convert", SCENE, &out, "--subdivide", "-1"], 2, "is not in 0.."),
        (&["convert", SCENE, &out, "--subdivide", "20"], 1, "the scene cannot be made: "),
        (&["convert", SCENE, &out, "--scale", "0"], 2, "not a positive number"),
        (&["convert", SCENE, &out, "--rotate-x", "nan"], 2, "not a finite number"),
        (&["convert", SCENE, &out, "--translate", "1", "2"], 2, "3 values required"),
        (
            &["convert", SCENE, &out, "--scale", "1e308", "--translate", "1.7e308", "0", "0"],
            1,
            "the scene cannot be made: ",
        ),
    ] {
        let message = failure(arguments, code);
        assert!(message.contains(why), "{arguments:?}: {message}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_scene_is_not_written_over_itself() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\np 1\n");
    assert!(failure(&["convert", &scene, &scene, "--scale", "2"], 1).contains("it is an input"));
    assert_eq!(fs::read_to_string(&scene).unwrap(), "v 0 0 0\np 1\n");
}
