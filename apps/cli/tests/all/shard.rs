//! Tests of `p2m shard`, and of `p2m query` and `p2m ray` of an index in shards.

use crate::common::{SCENE, failure, json, p2m, p2m_with, path, table, text, write};
use serde_json::json;
use std::fs;
use std::io::Write;
use tempfile::TempDir;

/// Writes the carried scene in shards of at most 40 kB, and returns the folder.
fn sharded(folder: &TempDir) -> String {
    let out = path(folder, "site");
    assert_eq!(table(&["shard", SCENE, "--max-bytes", "40kB", "--out", &out]), "");
    let shards = fs::read_dir(&out).unwrap().count() - 1;
    assert!(shards > 3, "{shards}");
    out
}

#[test]
fn a_folder_of_shards_gives_the_table_of_its_scene() {
    let folder = TempDir::new().unwrap();
    let site = sharded(&folder);
    let columns = ["--columns", "number,query,point,distance,primitive,feature,object"];
    for options in [
        &["--random", "500"][..],
        &["--grid", "7", "--box-scale", "3"],
        &["--random", "100", "--certified"],
        &["--random", "100", "--max-distance", "0.1"],
        &["--random", "100", "--k-nearest", "3"],
        &["--random", "100", "--within", "0.2"],
    ] {
        let ask = |scene: &str, more: &[&str]| table(&[&["query", scene], options, &columns, more].concat());
        let expected = ask(SCENE, &[]);
        assert!(expected.lines().count() > 30, "{options:?}");
        for more in [&[][..], &["--max-memory", "1"], &["--map"], &["--threads", "1"]] {
            assert_eq!(ask(&site, more), expected, "{options:?} {more:?}");
        }
        assert_eq!(ask(&format!("{site}/manifest.json"), &[]), expected, "the manifest stands for the folder");
    }
}

#[test]
fn rays_of_a_folder_of_shards_give_the_table_of_its_scene() {
    let folder = TempDir::new().unwrap();
    let site = sharded(&folder);
    let rays = ["--random", "400", "--box-scale", "1.2"];
    for options in [
        &["--mode", "intersects"][..],
        &["--mode", "first"],
        &["--mode", "first", "--radius", "0.05"],
        &["--mode", "all", "--line"],
        &["--mode", "all", "--min", "0.1", "--max", "30"],
        &["--mode", "count", "--radius", "0.01"],
        &["--mode", "crossings", "--line"],
    ] {
        let ask = |scene: &str, more: &[&str]| table(&[&["ray", scene], &rays[..], options, more].concat());
        let expected = ask(SCENE, &[]);
        assert!(expected.lines().count() > 100, "{options:?}");
        for more in [&[][..], &["--max-memory", "1"], &["--map"], &["--threads", "1"]] {
            assert_eq!(ask(&site, more), expected, "{options:?} {more:?}");
        }
    }
    // Some hit may be another one, but there is one for the same rays.
    let has_hits = |scene: &str| -> Vec<bool> {
        let answers = table(&[&["ray", scene], &rays[..], &["--mode", "any"]].concat());
        answers.lines().skip(1).map(|line| !line.split(',').nth(7).unwrap().is_empty()).collect()
    };
    let expected = has_hits(SCENE);
    assert!(expected.contains(&true) && expected.contains(&false));
    assert_eq!(has_hits(&site), expected);
    let out = path(&folder, "hits.csv");
    let report = json(&["ray", &site, "--random", "50", "--max-memory", "40kB", "--json", "--out", &out]);
    assert_eq!((&report["rays"], &report["shards"]["max_memory"]), (&json!(50), &json!(40_000)));
    assert!(report["shards"]["loads"].as_u64() > report["shards"]["count"].as_u64(), "{report}");
    assert!(
        failure(&["ray", &site, "--random", "1", "--backend", "aabb"], 2).contains("no effect on an index in shards")
    );
    assert!(failure(&["ray", SCENE, "--random", "1", "--max-memory", "1"], 2).contains("needs the folder"));
    fs::remove_file(format!("{site}/manifest.json")).unwrap();
    assert!(failure(&["ray", &site, "--random", "1"], 1).contains("without the file manifest.json"));
}

#[test]
fn signs_are_those_of_the_whole_surface() {
    let folder = TempDir::new().unwrap();
    let (scene, site) = (path(&folder, "sphere.obj"), path(&folder, "sphere"));
    table(&["generate", "ico-sphere", "--out", &scene]);
    table(&["shard", &scene, "--max-bytes", "20 kB", "--out", &site]);
    let ask = |scene: &str, sign: &str| table(&["query", scene, "--random", "300", "--box-scale", "1.5", sign]);
    let expected = ask(&scene, "--signed");
    assert!(expected.contains(",-0."), "some points are inside");
    assert_eq!(ask(&site, "--signed"), expected);
    let vertices: String = fs::read_to_string(&scene)
        .unwrap()
        .lines()
        .filter_map(|line| Some(line.strip_prefix("v ")?.to_owned() + "\n"))
        .collect();
    let vertices = write(&folder, "vertices.xyz", vertices);
    let ask = |scene: &str| table(&["query", scene, "--points", &vertices, "--columns", "signed", "--signed"]);
    let expected = ask(&scene);
    assert!(expected.lines().filter(|line| *line == "0.0").count() > 100, "vertices are on the surface");
    assert_eq!(ask(&site), expected);
    let run = p2m(&["query", &site, "--random", "3", "--signed"]);
    assert!(text(&run.stderr).contains("signs    by winding\n"), "{}", text(&run.stderr));
    for (signed, rule) in [(&["--signed=auto"][..], json!("winding")), (&[], json!(null))] {
        let out = path(&folder, "answers.csv");
        let report = json(&[&["query", &site, "--random", "3", "--json", "--out", &out], signed].concat());
        assert_eq!(report["sign_rule"], rule);
    }
    for rule in ["parity", "winding"] {
        let message = failure(&["query", &site, "--random", "1", &format!("--signed={rule}")], 2);
        assert!(message.contains("takes no rule"), "{message}");
    }
    let mixed = sharded(&folder);
    assert!(failure(&["query", &mixed, "--random", "1", "--signed"], 1).contains("which have no inside"));
}

#[test]
fn several_scenes_are_numbered_on() {
    let folder = TempDir::new().unwrap();
    let first = write(&folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2 3\n");
    let second = write(&folder, "b.obj", "v 5 0 0\nv 6 0 0\nl 1 2\n");
    let (site, points) = (path(&folder, "site"), write(&folder, "q.xyz", "5.5 0 2\n0.25 0.25 1\n"));
    let report = json(&["shard", &first, &second, "--out", &site, "--json"]);
    assert_eq!(report["primitives"]["triangles"], 1);
    assert_eq!(report["primitives"]["segments"], 1);
    assert_eq!(report["shards"]["count"], 1);
    assert_eq!(report["skipped"][0]["count"], 1, "{report}");
    let answers = table(&["query", &site, "--points", &points, "--columns", "primitive,distance"]);
    assert_eq!(answers, "primitive,distance\n1,2.0\n0,1.0\n");
}

#[test]
fn compressed_files_and_the_standard_input_are_the_same_scene() {
    let folder = TempDir::new().unwrap();
    let scene = fs::read(SCENE).unwrap();
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(&scene).unwrap();
    let packed = gzip.finish().unwrap();
    let inputs = [(write(&folder, "s.obj.gz", &packed), vec![]), (write(&folder, "s.obj", &packed), vec![])];
    let expected = table(&["query", SCENE, "--random", "50"]);
    for (number, (input, stdin)) in inputs.into_iter().chain([("-".to_owned(), scene)]).enumerate() {
        let site = path(&folder, &number.to_string());
        let arguments = ["shard", &input, "--format", "obj", "--max-bytes", "40kB", "--out", &site];
        assert_eq!(p2m_with(&arguments, stdin).code, 0);
        assert_eq!(table(&["query", &site, "--random", "50"]), expected, "{input}");
    }
}

#[test]
fn wrong_folders_and_files_are_named() {
    let folder = TempDir::new().unwrap();
    let site = sharded(&folder);
    let out = path(&folder, "answers.csv");
    let ask = |scene: &str, code| failure(&["query", scene, "--random", "500", "--out", &out], code);
    assert!(failure(&["shard", SCENE, "--out", &site], 1).contains("there is a sharded index already: give --replace"));
    table(&["shard", SCENE, "--max-bytes", "40kB", "--out", &site, "--replace"]);
    let shard = format!("{site}/1-00001.p2m");
    let whole = fs::read(&shard).unwrap();
    fs::write(&shard, &whole[..whole.len() / 2]).unwrap();
    let message = ask(&site, 1);
    assert_eq!(message.matches("bytes instead of").count(), 1, "{message}");
    assert!(message.contains("1-00001.p2m"), "{message}");
    fs::remove_file(&shard).unwrap();
    assert!(ask(&site, 1).contains("1-00001.p2m"));
    fs::copy(format!("{site}/1-00000.p2m"), &shard).unwrap();
    assert!(ask(&site, 1).contains("1-00001.p2m"));
    fs::write(format!("{site}/manifest.json"), "{}").unwrap();
    assert!(ask(&site, 1).contains("manifest.json"));
    fs::remove_file(format!("{site}/manifest.json")).unwrap();
    assert!(ask(&site, 1).contains("without the file manifest.json, so it is no finished index in shards"));
    // A failed run leaves neither a file nor a folder.
    assert!(!fs::exists(&out).unwrap());
    let missing = path(&folder, "new");
    assert!(failure(&["shard", "missing.obj", "--out", &missing], 1).contains("missing.obj"));
    assert!(!fs::exists(&missing).unwrap());
}

#[test]
fn options_that_have_no_effect_are_refused() {
    let folder = TempDir::new().unwrap();
    let site = sharded(&folder);
    for options in [&["--backend", "octree"][..], &["--k", "26"], &["--format", "obj"], &["--locator", "walk"]] {
        let message = failure(&[&["query", &site, "--random", "1"], options].concat(), 2);
        assert!(message.contains(options[0]), "{message}");
    }
    let named = ["query", SCENE, "--random", "1", "--max-memory", "1GB", "--backend", "octree"];
    assert!(failure(&named, 2).contains("p2m shard"));
    assert!(failure(&["shard", SCENE, "--out", &site, "--max-bytes", "0"], 2).contains("not an amount of memory"));
    failure(&["shard", SCENE, "--out", &site, "--backend", "brute"], 2);
}

#[test]
fn an_empty_scene_has_no_shards() {
    let folder = TempDir::new().unwrap();
    let (scene, site) = (write(&folder, "empty.off", "OFF 0 0 0\n"), path(&folder, "site"));
    let report = json(&["shard", &scene, "--out", &site, "--json"]);
    assert_eq!(report["shards"]["count"], 0);
    let answers = table(&["query", &site, "--random", "2", "--columns", "distance"]);
    assert_eq!(answers, table(&["query", &scene, "--random", "2", "--columns", "distance"]));
}
