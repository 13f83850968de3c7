//! Tests of `p2m tradeoff`.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

#[test]
fn table_page_and_record_have_every_setting_of_every_backend() {
    let folder = TempDir::new().unwrap();
    let (html, csv) = (path(&folder, "page.html"), path(&folder, "record.csv"));
    let few = ["--random", "50", "--rounds", "2", "--backends", "aabb,p2m,aabb"];
    let shown = table(&[&["tradeoff", SCENE, "--html", &html, "--csv", &csv][..], &few[..]].concat());
    let (page, record) = (fs::read_to_string(html).unwrap(), fs::read_to_string(csv).unwrap());
    for backend in ["aabb", "p2m"] {
        for setting in ["default", "epsilon 0.1", "certified"] {
            let has = |text: &str| text.lines().any(|line| line.contains(backend) && line.contains(setting));
            assert!(has(&shown) && has(&record), "{backend} {setting}: {shown}");
        }
        assert!(page.contains(&format!("{{\"name\":\"{backend}\",\"points\":[")), "{page}");
    }
    // No answer is farther than its setting promises.
    let mut broken = page.split("\"broken\":").skip(1);
    assert!(broken.clone().count() > 0 && broken.all(|rest| rest.starts_with("0}")), "{page}");
    assert!(!shown.contains("farther than promised"), "{shown}");
}

#[test]
fn what_cannot_be_asked_is_told() {
    let folder = TempDir::new().unwrap();
    let same = failure(&["tradeoff", SCENE, "--random", "5", "--html", "x", "--csv", "x"], 1);
    assert!(same.contains("same file"), "{same}");
    assert!(failure(&["tradeoff", SCENE], 2).contains("--random"));
    let points = path(&folder, "none.xyz");
    fs::write(&points, "").unwrap();
    assert!(failure(&["tradeoff", SCENE, "--points", &points], 1).contains("no finite point"));
    let empty = path(&folder, "empty.obj");
    fs::write(&empty, "# nothing\n").unwrap();
    assert!(failure(&["tradeoff", &empty, "--random", "5"], 1).contains("nothing in it"));
}
