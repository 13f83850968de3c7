//! A test that docs/json.md lists every key of every report.

use crate::common::*;
use serde_json::Value;
use std::collections::BTreeSet;
use tempfile::TempDir;

fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                found.insert(key.clone());
                // The keys of `options` are the options of generators.
                if key != "options" {
                    keys(value, found);
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn every_key_is_documented() {
    let folder = TempDir::new().unwrap();
    let text = "vn 0 0 1\nv 0 0 0\nv 0.1 0 0\nv 0 1 0\nv 9 9 9\no a\nf 1 2 3\nf 1 2 2\n";
    let (scene, out) = (write(&folder, "s.obj", text), path(&folder, "s.stl"));
    let (answers, saved, field) = (path(&folder, "a.csv"), path(&folder, "s.p2m"), path(&folder, "f.npy"));
    let (points, site) = (write(&folder, "q.xyz", "1 2 3\n"), path(&folder, "site"));
    let npz = path(&folder, "samples.npz");
    let mut found = BTreeSet::new();
    for arguments in [
        &["info", &scene, "--json"][..],
        &["convert", &scene, &out, "--scale", "2", "--json"],
        &["generate", "ico-sphere", "--out", &out, "--json"],
        &["query", &scene, "--grid", "2", "--out", &answers, "--json"],
        &["query", &scene, "--random", "2", "--out", &answers, "--json"],
        &["query", &scene, "--points", &points, "--out", &answers, "--json"],
        &["stats", &scene, "--backend", "octree", "--json"],
        &["field", &scene, "--resolution", "3", "--out", &field, "--json"],
        &["field", &scene, "--refine", "1", "--signed", "--out", &field, "--json"],
        &["advise", &scene, "--queries", "2", "--near", "--json"],
        &["build", &scene, "--backend", "p2m", "--out", &saved, "--json"],
        &["shard", &scene, "--out", &site, "--json"],
        &["query", &site, "--random", "2", "--out", &answers, "--json"],
        &["distance", &scene, &scene, "--json"],
        &["hausdorff", &scene, &scene, "--json"],
        &["sample", &out, "--near", "9", "--out", &npz, "--json"],
        &["align", &out, &out, "--json"],
        &["deviation", &out, &out, "--align", "--unsigned", "--tolerance", "1", "--json"],
    ] {
        keys(&json(arguments), &mut found);
    }
    assert!(found.len() > 60, "{found:?}");
    let document = include_str!("../../../../docs/json.md");
    let missing: Vec<_> = found.iter().filter(|key| !document.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn a_failed_run_reports_nothing() {
    let folder = TempDir::new().unwrap();
    let missing = path(&folder, "missing.obj");
    let out = path(&folder, "out.obj");
    failure(&["info", &missing, "--json"], 1);
    failure(&["convert", &missing, &out, "--json"], 1);
    failure(&["query", &missing, "--random", "1", "--out", &out, "--json", "--out-format", "csv"], 1);
}
