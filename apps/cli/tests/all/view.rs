//! Tests of `p2m view`.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

#[test]
fn a_page_has_what_was_asked_for() {
    let folder = TempDir::new().unwrap();
    let page = path(&folder, "page.html");
    let parts = ["\"answers\":{", "\"field\":{", "\"cells\":{", "\"lists\":{"];
    for (options, expected) in [
        (&["--random", "7"][..], [true, false, false, false]),
        (&["--field", "8", "--unit", "metres"], [false, true, false, false]),
        (&["--levels", "2"], [false, false, true, false]),
        (&["--lists", "8", "--backend", "octree"], [false, false, false, true]),
    ] {
        table(&[&["view", SCENE, "--out", &page], options].concat());
        let html = fs::read_to_string(&page).unwrap();
        assert_eq!(parts.map(|part| html.contains(part)), expected, "{options:?}");
        assert_eq!(html.contains("\"unit\":\"metres\""), expected[1], "{options:?}");
    }
}

#[test]
fn small_scenes_have_live_queries_unless_they_are_refused() {
    let folder = TempDir::new().unwrap();
    let (page, sphere) = (path(&folder, "page.html"), path(&folder, "sphere.ply"));
    table(&["generate", "ico-sphere", "--frequency", "71", "--out", &sphere]);
    for (scene, options, expected) in [
        (SCENE, &[][..], true),
        (SCENE, &["--live", "never"], false),
        (&sphere, &[], false),
        (&sphere, &["--live", "always"], true),
    ] {
        table(&[&["view", scene, "--out", &page], options].concat());
        let html = fs::read_to_string(&page).unwrap();
        assert_eq!(html.contains("\"live\":{"), expected, "{scene} {options:?}");
    }
}

#[test]
fn what_cannot_be_shown_is_told() {
    let folder = TempDir::new().unwrap();
    let page = path(&folder, "page.html");
    assert!(failure(&["view", SCENE, "--signed", "--out", &page], 2).contains("--signed needs"));
    assert!(failure(&["view", SCENE, "--out", SCENE], 1).contains("it is an input"));
    failure(&["view", SCENE, "--field", "8", "--lists", "8", "--out", &page], 2);
    assert!(failure(&["view", SCENE, "--lists", "8", "--out", &page], 2).contains("aabb has none"));
    failure(&["view", SCENE, "--random", "100001", "--out", &page], 2);
    let tiny = path(&folder, "tiny.obj");
    fs::write(&tiny, "v 0 0 0\nv 1e-200 0 0\nl 1 2\n").unwrap();
    assert!(failure(&["view", &tiny, "--field", "8", "--out", &page], 1).contains("numbers of f32"));
    assert!(!fs::exists(&page).unwrap());
}

#[test]
fn the_page_is_named_after_its_scene() {
    let folder = TempDir::new().unwrap();
    write(&folder, "tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n");
    let run = |arguments: &[&str]| program(arguments).current_dir(&folder).output().unwrap();
    assert!(run(&["view", "tiny.obj"]).status.success());
    assert!(fs::read_to_string(folder.path().join("tiny.html")).unwrap().starts_with("<!"));
    assert!(failure(&["view", "-", "--format", "obj"], 2).contains("needs --out"));
    // Signs that a scene does not have say what to do.
    for arguments in
        [&["view", "tiny.obj", "--random", "3", "--signed"][..], &["field", "tiny.obj", "--signed", "--out", "f.npy"]]
    {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains("leave --signed out"), "{}", text(&output.stderr));
    }
}
