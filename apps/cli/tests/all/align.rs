//! Tests of `p2m align` and `p2m deviation --align`.

use crate::common::*;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use tempfile::TempDir;

/// A tetrahedron without symmetries.
const PART: &str = "v 0 0 0\nv 5 0 0\nv 0 3 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Returns points of the faces of the part, which are turned by the angle whose cosine is 0.6 and moved.
fn scan() -> String {
    let corners = [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]];
    let mut text = String::new();
    for [a, b, c] in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        for i in 0..=20 {
            for j in 0..=20 - i {
                let weights = [(a, i), (b, j), (c, 20 - i - j)].map(|(corner, w): (usize, i32)| (corner, f64::from(w)));
                let [x, y, z]: [f64; 3] =
                    std::array::from_fn(|k| weights.iter().map(|(corner, w)| corners[*corner][k] * w / 20.0).sum());
                writeln!(text, "{} {} {}", 0.6 * x - 0.8 * y + 9.0, 0.8 * x + 0.6 * y - 7.0, z + 3.0).unwrap();
            }
        }
    }
    text
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap()).map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn a_scan_is_moved_onto_its_part() {
    let folder = TempDir::new().unwrap();
    let (part, scan) = (write(&folder, "part.obj", PART), write(&folder, "scan.xyz", scan()));
    let (aligned, matrix) = (path(&folder, "aligned.ply"), path(&folder, "pose.txt"));
    let report = json(&["align", &scan, &part, "--out", &aligned, "--matrix", &matrix, "--json"]);
    assert!(report["rms"].as_f64().unwrap() < 1e-9 && report["converged"] == true, "{report}");
    assert_eq!((&report["scale"], &report["ambiguity"]), (&1.0.into(), &Value::Null));
    let expected = [0.6, 0.8, 0.0, 0.2, -0.8, 0.6, 0.0, 11.4, 0.0, 0.0, 1.0, -3.0, 0.0, 0.0, 0.0, 1.0];
    let found = numbers(&report["matrix"]);
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-9), "{found:?}");
    // The file of the matrix has the same numbers, and other commands read it.
    let written: Vec<f64> =
        fs::read_to_string(&matrix).unwrap().split_whitespace().map(|x| x.parse().unwrap()).collect();
    assert_eq!(written, found);
    table(&["hausdorff", &part, &part, "--transform", &matrix]);
    let deviation = json(&["deviation", &aligned, &part, "--json"]);
    assert!(deviation["statistics"]["rms"].as_f64().unwrap() < 1e-9 && deviation["alignment"].is_null());
    // The table for people has the same matrix.
    let text = table(&["align", &scan, &part, "--backend", "octree", "--threads", "1"]);
    let of_table: Vec<f64> =
        text.split_once("matrix\n").unwrap().1.split_whitespace().map(|x| x.parse().unwrap()).collect();
    assert_eq!(of_table, found);
}

#[test]
fn a_deviation_can_align_first() {
    let folder = TempDir::new().unwrap();
    let (part, scan) = (write(&folder, "part.obj", PART), write(&folder, "scan.xyz", scan()));
    assert!(json(&["deviation", &scan, &part, "--json"])["statistics"]["rms"].as_f64().unwrap() > 1.0);
    let cloud = path(&folder, "cloud.ply");
    let report = json(&["deviation", &scan, &part, "--align", "--out", &cloud, "--json"]);
    assert!(report["statistics"]["max"].as_f64().unwrap() < 1e-9, "{report}");
    assert_eq!(numbers(&report["alignment"]["matrix"]).len(), 16);
    // The file has the moved scan.
    assert!(json(&["deviation", &cloud, &part, "--json"])["statistics"]["max"].as_f64().unwrap() < 1e-9);
}

#[test]
fn doubtful_alignments_are_warnings_and_wrong_ones_are_refused() {
    let folder = TempDir::new().unwrap();
    let ball = path(&folder, "ball.ply");
    table(&["generate", "ico-sphere", "--frequency", "20", "--out", &ball]);
    let output = p2m_with(&["align", &ball, &ball], Vec::new());
    assert!(text(&output.stderr).contains("ball.ply: the scan can slide or turn"), "{}", text(&output.stderr));
    let scan = write(&folder, "scan.xyz", scan());
    let few = write(&folder, "few.xyz", "1 2 3\n4 5 6\n");
    assert!(
        failure(&["align", &few, &ball], 1)
            .contains("few.xyz: an alignment needs at least 6 finite points, but the scan has 2")
    );
    assert!(failure(&["align", &scan, &write(&folder, "empty.xyz", "")], 1).contains("empty.xyz: the scene is empty"));
    assert!(failure(&["align", &scan, &ball, "--overlap", "0"], 2).contains("above 0 and at most 1"));
    assert!(failure(&["align", &scan, &ball, "--out", "-"], 2).contains("needs a file"));
    let unknown = failure(&["align", &scan, &ball, "--out", "moved.doc"], 1);
    assert!(unknown.contains("unknown extension 'doc'") && !unknown.contains("--to"), "{unknown}");
    assert!(failure(&["align", &scan, &ball, "--out", &ball], 1).contains("is an input"));
}
