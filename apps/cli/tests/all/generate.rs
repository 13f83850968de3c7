//! Tests of `p2m generate`.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

#[test]
fn the_generator_writes_the_scene_of_this_repository() {
    let expected = fs::read_to_string(SCENE).unwrap();
    assert!(table(&["generate", "knot-and-cables"]) == expected);
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "k.obj");
    table(&["generate", "knot-and-cables", "--out", &out]);
    assert!(fs::read_to_string(&out).unwrap() == expected);
    let small = table(&[
        "generate",
        "knot-and-cables",
        "--rings",
        "3",
        "--sides",
        "4",
        "--cables",
        "1",
        "--cable-segments",
        "2",
    ]);
    let count = |keyword: &str| small.lines().filter(|l| l.starts_with(keyword)).count();
    assert_eq!((count("v "), count("f "), count("l ")), (15, 24, 2));
}

const KINDS: [&str; 9] = [
    "knot-and-cables",
    "torus-knot",
    "skewed-gear",
    "sphere",
    "ico-sphere",
    "cone",
    "cylinder",
    "cable-bundle",
    "mixed-sizes",
];

#[test]
fn every_kind_of_the_library_is_made() {
    let kinds: Vec<_> = p2m_mixed::generate::Kind::all().iter().map(|kind| kind.name()).collect();
    assert_eq!(kinds, KINDS);
    let folder = TempDir::new().unwrap();
    for kind in p2m_mixed::generate::Kind::all() {
        let out = path(&folder, "scene.ply");
        let report = json(&["generate", kind.name(), "--out", &out, "--json"]);
        let soup = kind.generate().unwrap();
        assert_eq!((&report["p2m"], &report["kind"]), (&"generate".into(), &kind.name().into()));
        assert_eq!(report["out"]["primitives"]["triangles"], soup.triangles().len());
        assert_eq!(report["out"]["bytes"], fs::metadata(&out).unwrap().len());
        // The scene is bit for bit that of the library.
        assert_eq!(*p2m_mixed::read_scene(out.as_ref()).unwrap().soup, soup, "{}", kind.name());
        // Each option has the same name on the command line and in the report, and changes the scene.
        for (name, default) in report["options"].as_object().unwrap() {
            // The value 7 is no default, and has no common divisor with the windings of a knot.
            let value: serde_json::Value = if default.is_f64() { 0.25.into() } else { 7.into() };
            let option = format!("--{}", name.replace('_', "-"));
            let report = json(&["generate", kind.name(), "--out", &out, "--json", &option, &value.to_string()]);
            assert_eq!(report["options"][name], value);
            let changed = p2m_mixed::read_scene(out.as_ref()).unwrap().soup;
            assert_ne!(*changed, soup, "{} {option}", kind.name());
        }
    }
}

#[test]
fn options_reach_the_scene() {
    let count = |arguments: &[&str], keyword: &str| {
        table(&[&["generate"], arguments].concat()).lines().filter(|l| l.starts_with(keyword)).count()
    };
    assert_eq!(count(&["torus-knot", "--rings", "10", "--sides", "3"], "f "), 60);
    assert_eq!(count(&["skewed-gear", "--teeth", "3", "--points", "4"], "f "), 96);
    assert_eq!(count(&["sphere", "--meridians", "5", "--bands", "4"], "f "), 30);
    assert_eq!(count(&["ico-sphere", "--frequency", "2"], "f "), 80);
    assert_eq!(count(&["cone", "--sides", "6", "--bands", "1", "--cap-bands", "1"], "f "), 12);
    assert_eq!(count(&["cylinder", "--sides", "6", "--bands", "1", "--cap-bands", "1"], "f "), 24);
    assert_eq!(count(&["cable-bundle", "--strands", "3", "--segments", "7"], "l "), 21);
    assert_eq!(count(&["mixed-sizes", "--triangles", "2", "--segments", "3", "--points", "4"], "p "), 4);
    assert_eq!(count(&["ico-sphere", "--frequency", "1", "--subdivide", "2"], "f "), 320);
}

#[test]
fn scenes_go_to_files_in_their_format() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "ball.stl");
    // Two coordinates of each of 12 corners and of each of 24 midpoints of edges are not representable in f32. The
    // other 6 midpoints are on the axes.
    let output = p2m(&["generate", "ico-sphere", "--frequency", "2", "--out", &out]);
    assert_eq!(
        text(&output.stderr),
        format!(
            "made     the unit sphere as a subdivided icosahedron\nout      {out} (stl): 80 triangles, 4,084 bytes\n\
            lost     precision: coordinates rounded to f32: 72, by up to 2.539e-8\n\
            lost     which corners are shared: each triangle has its own\n"
        )
    );
    assert!(table(&["generate", "cone", "--to", "off"]).starts_with("OFF\n"));
    let unnamed = path(&folder, "ball");
    table(&["generate", "ico-sphere", "--frequency", "2", "--out", &unnamed, "--to", "ply"]);
    assert!(fs::read(&unnamed).unwrap().starts_with(b"ply\n"));
}

#[test]
fn wrong_options_say_why() {
    for (arguments, why) in [
        (&["torus-knot", "--p", "2", "--q", "4"][..], "must have no common divisor"),
        (&["torus-knot", "--tube-radius", "-1"], "tube radius is -1, but must be"),
        (&["torus-knot", "--rings", "2"], "not in 3.."),
        (&["cable-bundle", "--twists", "1e9"], "must be"),
        (&["mixed-sizes", "--decades", "13"], "must be from 0 to 12"),
        (&["sphere", "--json"], "the scene has to go to a file"),
        (&["sphere", "--to", "dwg"], "[possible values: obj, ply, "),
    ] {
        let message = failure(&[&["generate"], arguments].concat(), 2);
        assert!(message.contains(why), "{arguments:?}: {message}");
        assert!(message.contains("--help"), "{message}");
    }
    let message = failure(&["generate", "torus-knot", "--p", "2", "--q", "4"], 2);
    assert!(message.ends_with("try 'p2m generate torus-knot --help'.\n"), "{message}");
    let message = failure(&["generate", "sphere", "--meridians", "4000000000", "--bands", "4000000000"], 1);
    assert!(message.contains("the scene cannot be made: "), "{message}");
}
