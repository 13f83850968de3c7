//! Tests of `p2m build` and of the commands that load saved indexes.

use crate::common::{SCENE, failure, p2m, path, table, text, write};
use serde_json::Value;
use std::fs;

fn saved(folder: &tempfile::TempDir, backend: &[&str]) -> String {
    let out = path(folder, &format!("{}.p2m", backend.join("-")));
    let mut arguments = vec!["build", SCENE, "--out", &out, "--backend"];
    arguments.extend(backend);
    assert_eq!(table(&arguments), "");
    out
}

#[test]
fn a_saved_index_gives_the_table_of_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let expected = table(&["query", SCENE, "--random", "300"]);
    for backend in [&["aabb"][..], &["kdop"], &["kdop", "--k", "26"], &["octree"], &["p2m"]] {
        let file = saved(&folder, backend);
        let run = p2m(&["query", &file, "--random", "300"]);
        assert_eq!(text(&run.stdout), expected, "{backend:?}");
        let summary = text(&run.stderr);
        let line = summary.lines().find(|line| line.starts_with("backend")).unwrap().to_owned();
        assert!(line.starts_with(&format!("backend  {}", backend[0])) && line.contains(", loaded in"), "{summary}");
        // Another backend is built over the scene in the file.
        let run = p2m(&["query", &file, "--random", "300", "--backend", "kdop", "--k", "6"]);
        assert_eq!(text(&run.stdout), expected);
        assert!(text(&run.stderr).contains("backend  kdop, 6 faces, built in"), "{}", text(&run.stderr));
    }
}

#[test]
fn every_command_takes_it_in_place_of_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let file = saved(&folder, &["p2m"]);
    let [own, original] = [&file, SCENE].map(|scene| table(&["ray", scene, "--random", "200"]));
    assert_eq!(own, original);
    let [own, original] = [file.as_str(), SCENE].map(|scene| table(&["convert", scene, "-", "--to", "obj"]));
    assert_eq!(own, original, "names and all");
    let back = path(&folder, "back.p2m");
    table(&["convert", SCENE, &back]);
    assert_eq!(table(&["query", &back, "--grid", "4"]), table(&["query", SCENE, "--grid", "4"]));
    let count = |scene: &str| -> Value {
        let report: Value = serde_json::from_str(&table(&["info", scene, "--json"])).unwrap();
        report["primitives"].clone()
    };
    assert!(count(SCENE).is_object());
    assert_eq!(count(&file), count(SCENE));
    assert!(table(&["info", &file]).lines().any(|line| line == "index       p2m"));
    let svg = path(&folder, "boxes.svg");
    assert_eq!(p2m(&["boxes", &file, "--out", &svg]).code, 0);
    // A saved index is read through a pipe as well.
    let run = crate::common::p2m_with(&["query", "-", "--format", "p2m", "--grid", "4"], fs::read(&file).unwrap());
    assert_eq!(text(&run.stdout), table(&["query", SCENE, "--grid", "4"]));
}

#[test]
fn the_report_says_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = path(&folder, "scene.p2m");
    let report: Value =
        serde_json::from_str(&table(&["build", SCENE, "--backend", "octree", "--out", &out, "--json"])).unwrap();
    assert_eq!((&report["p2m"], &report["version"]), (&"build".into(), &4.into()));
    assert_eq!(report["out"]["bytes"].as_u64(), Some(fs::metadata(&out).unwrap().len()));
    assert!(report["cells"]["list_cells"].as_u64() > Some(100), "{report}");
    for stage in ["read", "build", "write"] {
        assert!(report["seconds"][stage].as_f64() > Some(0.0), "{report}");
    }
    let run = p2m(&["build", SCENE, "--out", &out]);
    let summary = text(&run.stderr);
    assert!(summary.contains("backend  aabb, built in") && summary.contains(&format!("written  {out}, ")), "{summary}");
}

#[test]
fn damaged_files_and_wrong_usage_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = saved(&folder, &["octree"]);
    let mut bytes = fs::read(&file).unwrap();
    let half = bytes.len() / 2;
    bytes[half] ^= 1;
    let damaged = write(&folder, "damaged.p2m", &bytes);
    let message = failure(&["query", &damaged, "--random", "1"], 1);
    assert!(message.contains("damaged.p2m: is damaged: the checksum of "), "{message}");
    let message = failure(&["info", &damaged], 1);
    assert!(message.contains("damaged.p2m: is damaged: the checksum of "), "{message}");
    assert_eq!(message.matches("is damaged").count(), 1, "{message}");
    let folder_name = path(&folder, "folder.p2m");
    fs::create_dir(&folder_name).unwrap();
    let message = failure(&["query", &folder_name, "--random", "1"], 1);
    assert!(message.contains("is a directory"), "{message}");
    let short = write(&folder, "short.p2m", &bytes[..half]);
    assert!(failure(&["query", &short, "--random", "1"], 1).contains(&format!("has {half} bytes instead of ")));
    let foreign = write(&folder, "foreign.p2m", "v 0 0 0\n");
    assert!(failure(&["query", &foreign, "--random", "1"], 1).contains("is not a saved index"));
    let empty = write(&folder, "empty.p2m", "");
    assert!(failure(&["query", &empty, "--random", "1"], 1).contains("is not a saved index"));
    let none = path(&folder, "none.p2m");
    assert!(failure(&["query", &none, "--random", "1"], 1).contains("none.p2m: cannot be read"));
    let out = path(&folder, "out.p2m");
    assert!(failure(&["build", SCENE, "--backend", "brute", "--out", &out], 2).contains("no index to save"));
    assert!(failure(&["build", SCENE, "--k", "6", "--out", &out], 2).contains("--k is for --backend kdop"));
    assert!(failure(&["build", &file, "--out", &file], 1).contains("would be written over"));
    assert!(failure(&["build", SCENE, "--out", "-", "--json"], 2).contains("--json"));
    assert!(!fs::exists(&out).unwrap());
}
