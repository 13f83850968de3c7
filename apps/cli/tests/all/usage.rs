//! Tests of help, and of messages about wrong usage.

use crate::common::*;

#[test]
fn wrong_numbers_are_told_why() {
    for (option, value, why) in [
        ("--box-scale", "-1", "not a positive number"),
        ("--seed", "-1", "not a whole number"),
        ("--random", "-1", "not a whole number"),
        ("--threads", "0", "is not in 1..=1024"),
        ("--threads", "1025", "is not in 1..=1024"),
        ("--threads", "99999999", "is not in 1..=1024"),
        ("--max-distance", "-1", "not a number from 0 up"),
    ] {
        let rest = if option == "--random" { &[][..] } else { &["--random", "1"] };
        let message = failure(&[&["query", SCENE, option, value], rest].concat(), 2);
        assert!(message.contains(why) && message.contains(option), "{message}");
    }
}

#[test]
fn wrong_usage_is_code_2() {
    for arguments in [
        &["query"][..],
        &["query", SCENE],
        &["query", SCENE, "--grid", "3", "--random", "3"],
        &["query", SCENE, "--grid", "3", "--points", "a.xyz"],
        &["query", SCENE, "--grid", "0"],
        &["query", SCENE, "--grid", "x"],
        &["query", SCENE, "--random", "-1"],
        &["query", SCENE, "--random", "3", "--backend", "magic"],
        &["query", SCENE, "--random", "3", "--max-distance", "-1"],
        &["query", SCENE, "--random", "3", "--max-distance", "nan"],
        &["query", SCENE, "--random", "3", "--box-scale", "0"],
        &["query", SCENE, "--random", "3", "--box-scale", "inf"],
        &["query", SCENE, "--random", "3", "--threads", "0"],
        &["query", SCENE, "--grid", "3", "--seed", "1"],
        &["query", SCENE, "--points", "a.xyz", "--box-scale", "2"],
        &["ray", SCENE],
        &["ray", SCENE, "--random", "-1"],
        &["ray", SCENE, "--grid", "3"],
        &["generate", "tree"],
        &["generate", "knot-and-cables", "--sides", "2"],
        &["ask"],
    ] {
        failure(arguments, 2);
    }
    assert_eq!(p2m(&[]).code, 2);
}

#[test]
fn help_has_examples() {
    for arguments in [
        &["--help"][..],
        &["query", "--help"],
        &["ray", "--help"],
        &["generate", "--help"],
        &["generate", "knot-and-cables", "--help"],
    ] {
        let help = table(arguments);
        assert!(help.contains("Example") && help.contains("  p2m "), "{help}");
    }
    assert!(
        table(&["--help"]).starts_with("Closest points and hits of rays in scenes of triangles, segments and points\n")
    );
    let help = table(&["query", "--help"]);
    for part in ["edge0", "vertex2", "Points:0", "cut into triangles", "unit of the scene"] {
        assert!(help.contains(part), "{part}: {help}");
    }
    let help = table(&["ray", "--help"]);
    for part in ["origin + t direction", "without rounding", "crossings", "w2", "Normals:2", "unit of the scene"] {
        assert!(help.contains(part), "{part}: {help}");
    }
    assert!(table(&["--version"]).starts_with("p2m "));
}
