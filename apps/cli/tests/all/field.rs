//! Tests of `p2m field`: grids, octrees, signs and pictures.

use crate::common::*;
use p2m_backends::BACKENDS;
use std::fs;
use tempfile::TempDir;

/// Returns the values of a raw file.
fn values(path: &str) -> Vec<f32> {
    let bytes = fs::read(path).unwrap();
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn backends_and_threads_give_the_same_field() {
    let folder = TempDir::new().unwrap();
    let field = |name: &str, more: &[&str]| {
        let out = path(&folder, name);
        table(&[&["field", SCENE, "--resolution", "20", "--out", &out], more].concat());
        fs::read(out).unwrap()
    };
    let expected = field("brute.raw", &["--backend", "brute"]);
    for backend in BACKENDS.iter().map(|backend| backend.name) {
        assert!(field("other.raw", &["--backend", backend]) == expected, "{backend}");
    }
    // Without a named backend, distances come from lists.
    assert!(field("one.raw", &["--threads", "1"]) == expected);
    assert!(field("auto.raw", &["--backend", "auto"]) == expected);
    let report = |more: &[&str]| {
        let out = path(&folder, "reported.raw");
        json(&[&["field", SCENE, "--resolution", "20", "--json", "--out", &out], more].concat())["backend"].clone()
    };
    assert_eq!([report(&[]), report(&["--backend", "aabb"])], ["lists", "aabb"]);
    let vti = String::from_utf8(field("whole.vti", &[])).unwrap();
    let data = vti.lines().find_map(|line| line.strip_prefix('_')).unwrap();
    let data = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, data).unwrap();
    assert_eq!(data[8..], expected);
    assert!(field("named", &["--out-format", "npy"]).ends_with(&expected));
    let band = path(&folder, "band.raw");
    table(&["field", SCENE, "--resolution", "20", "--band", "0.1", "--out", &band]);
    let whole = path(&folder, "brute.raw");
    assert!(values(&band).iter().zip(values(&whole)).all(|(b, w)| *b == w.min(0.1)));
}

#[test]
fn signs_name_their_rule() {
    let folder = TempDir::new().unwrap();
    let knot = path(&folder, "knot.ply");
    table(&["generate", "torus-knot", "--out", &knot]);
    let [winding, parity] = ["winding.raw", "parity.raw"].map(|name| path(&folder, name));
    let picture = path(&folder, "slice.png");
    let report =
        json(&["field", &knot, "--signed", "--resolution", "40", "--out", &winding, "--slice", &picture, "--json"]);
    assert_eq!(report["sign_rule"], "winding");
    let counts: Vec<u64> = report["grid"]["counts"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    let all = values(&winding);
    assert_eq!(counts.iter().product::<u64>(), all.len() as u64);
    let inside = all.iter().filter(|x| **x < 0.0).count();
    assert!(inside > 100);
    assert_eq!(report["values"]["inside"], inside);
    assert_eq!(report["values"]["undefined"], 0);
    assert!(fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    let report = json(&["field", &knot, "--signed=parity", "--resolution", "40", "--out", &parity, "--json"]);
    assert_eq!(report["sign_rule"], "parity");
    assert_eq!(values(&parity), all);

    // A surface with a hole has signs by winding numbers alone.
    let whole = path(&folder, "knot.obj");
    table(&["convert", &knot, &whole]);
    let text = fs::read_to_string(whole).unwrap();
    let cut = text.rfind("\nf ").unwrap();
    let open = write(&folder, "open.obj", &text[..=cut]);
    let out = path(&folder, "open.npy");
    assert_eq!(
        json(&["field", &open, "--signed", "--resolution", "9", "--out", &out, "--json"])["sign_rule"],
        "winding"
    );
    let message = failure(&["field", &open, "--signed=parity", "--out", &out], 1);
    assert!(message.contains("open at edge"), "{message}");
    let message = failure(&["field", SCENE, "--signed", "--out", &out], 1);
    assert!(message.contains("480 of the primitives are no triangles"), "{message}");
}

#[test]
fn cells_are_finer_for_smaller_errors() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "cells.npy");
    let cells = |error: &str| {
        let report = json(&["field", SCENE, "--refine", error, "--out", &out, "--json"]);
        let count = report["cells"].as_u64().unwrap();
        let bytes = fs::read(&out).unwrap();
        assert_eq!(bytes.len() as u64 - 96 * count, 192);
        count
    };
    let [coarse, fine] = ["0.2", "0.05"].map(cells);
    assert!(coarse > 8 && fine > coarse, "{coarse} {fine}");
}

#[test]
fn the_summary_tells_the_grid() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "f.npy");
    let output = p2m(&["field", SCENE, "--resolution", "20", "--threads", "1", "--out", &out]);
    let summary = text(&output.stderr);
    for part in
        ["field    ", " points, ", "filled   in ", "on 1 thread: ", "ns per point", "distance min ", "written  "]
    {
        assert!(summary.contains(part), "{part}: {summary}");
    }
}

#[test]
fn wrong_usage_is_told_what_is_wrong() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "f.npy");
    let empty = write(&folder, "empty.obj", "# nothing\n");
    for (arguments, code, message) in [
        (&["field", &empty, "--out", &out][..], 1, "the scene is empty"),
        (&["field", SCENE, "--out", "field.dat"], 1, "unknown extension 'dat', expected one of npy, vti, raw"),
        (&["field", SCENE, "--resolution", "1", "--out", &out], 2, "1 is not in 2..="),
        (&["field", SCENE, "--band", "-1", "--out", &out], 2, "'-1'"),
        (&["field", SCENE, "--refine", "0.1", "--band", "1", "--out", &out], 2, "cannot be used with"),
        (&["field", SCENE, "--json", "--out", "-", "--out-format", "npy"], 2, "the field has to go to a file"),
        (&["field", SCENE, "--out", SCENE, "--out-format", "npy"], 1, "would be written over"),
        (&["field", SCENE, "--out", &out, "--slice", SCENE], 1, "would be written over"),
        (&["field", SCENE, "--out", &out, "--slice", &out], 2, "a file of its own"),
        (&["field", SCENE, "--refine", "0.1", "--out", "cells.vti"], 2, "--refine writes cells as NPY"),
        (&["field", SCENE, "--depth", "3", "--out", &out], 2, "--refine"),
    ] {
        let found = failure(arguments, code);
        assert!(found.contains(message), "{arguments:?}: {found}");
    }
    assert!(!std::path::Path::new(&out).exists());
}

#[test]
fn surfaces_of_fields_are_closed_and_at_their_distance() {
    let folder = TempDir::new().unwrap();
    let (knot, out) = (path(&folder, "knot.ply"), path(&folder, "offset.ply"));
    table(&["generate", "torus-knot", "--out", &knot]);
    let base = ["field", &knot, "--resolution", "40", "--out", &out];
    for (distance, more) in [("0.1", &["--signed"][..]), ("-0.05", &["--signed"]), ("0.1", &["--backend", "kdop"])] {
        let report = json(&[&base[..], &["--json", "--iso", distance], more].concat());
        let surface = &report["surface"];
        let spacing = report["grid"]["spacing"].as_f64().unwrap();
        assert_eq!((&surface["closed"], &report["out"]["format"]), (&true.into(), &"ply".into()));
        assert!(surface["vertex_error"].as_f64().unwrap() <= 1e-7 * spacing, "{distance}: {surface}");
        assert!(surface["triangle_error"].as_f64().unwrap() < spacing, "{distance}: {surface}");
        // The vertices of the file have the distance, as another command measures it.
        let table = table(&["query", &knot, "--points", &out, "--columns", "distance"]);
        let exact = distance.parse::<f64>().unwrap().abs();
        let mut count = 0;
        for line in table.lines().skip(1) {
            let found: f64 = line.parse().unwrap();
            // The file has single precision.
            assert!((found - exact).abs() < 1e-6, "{found}");
            count += 1;
        }
        assert!(count > 1000 && json(&["info", &out, "--json"])["closed"] == true);
    }
    let output = p2m(&[&base[..], &["--iso", "0.1", "--signed"]].concat());
    assert!(text(&output.stderr).contains("surface  closed; vertices are within "), "{}", text(&output.stderr));
    assert!(failure(&[&base[..], &["--iso", "-9", "--signed"]].concat(), 1).contains("there is no surface at -9"));
    failure(&[&base[..], &["--iso", "0.1", "--band", "1"]].concat(), 2);
    failure(&["field", &knot, "--iso", "0.1", "--out", &path(&folder, "offset.npy")], 1);
    assert!(failure(&["field", &knot, "--iso", "0.1", "--out", "-"], 2).contains("choose a file"));
}

#[test]
fn surfaces_that_are_missing_or_elsewhere_are_told() {
    let folder = TempDir::new().unwrap();
    let (ball, out) = (path(&folder, "ball.obj"), path(&folder, "offset.ply"));
    table(&["generate", "ico-sphere", "--frequency", "8", "--out", &ball]);
    let base = ["field", &ball, "--out", &out];
    let error = |more: &[&str], code| failure(&[&base[..], more].concat(), code);
    for distance in ["0", "-0", "-1"] {
        assert!(error(&["--iso", distance], 2).contains("add --signed"), "{distance}");
    }
    assert!(error(&["--iso", "0.1", "--resolution", "7"], 2).contains("a --resolution of at least 8"));
    // No point of the grid is so near to the surface.
    assert!(error(&["--iso", "1e-9", "--resolution", "9"], 1).contains("there is no surface at 0.000000001"));
    assert!(!std::path::Path::new(&out).exists());
    let warned = |more: &[&str]| text(&p2m(&[&base[..], more].concat()).stderr);
    let coarse = warned(&["--iso", "0.02", "--resolution", "32"]);
    assert!(coarse.contains("are too large for a distance of 0.02"), "{coarse}");
    // The side of a cell is shorter than the layer is thick, and its diagonal is longer.
    assert!(warned(&["--iso", "0.05", "--resolution", "32"]).contains("are too large for a distance of 0.05"));
    // With signs there is one layer, and the surface is on one side of it.
    let signed = warned(&["--iso", "0.02", "--signed", "--resolution", "32"]);
    assert!(!signed.contains("warning"), "{signed}");
    let fine = warned(&["--iso", "0.1", "--resolution", "32"]);
    assert!(!fine.contains("warning") && fine.contains("surface  closed"), "{fine}");
    // Half of a ball, whose sides change across its opening.
    let text_of_ball = std::fs::read_to_string(&ball).unwrap();
    let (vertices, faces): (Vec<&str>, Vec<&str>) = text_of_ball.lines().partition(|line| !line.starts_with('f'));
    std::fs::write(&ball, [&vertices[..], &faces[..faces.len() / 2]].concat().join("\n") + "\n").unwrap();
    let open = warned(&["--iso", "-0.1", "--signed", "--resolution", "32"]);
    assert!(open.contains("from where they should be"), "{open}");
    // A vertex on the triangle, whose sides are both outside, has no signed distance.
    let triangle = write(&folder, "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let arguments = ["field", &triangle, "--iso", "0.2", "--signed", "--resolution", "26", "--out", &out];
    let undefined = text(&p2m(&arguments).stderr);
    assert!(undefined.contains("vertices are within an unbounded length"), "{undefined}");
    assert_eq!(json(&[&arguments[..], &["--json"]].concat())["surface"]["vertex_error"], serde_json::Value::Null);
}
