//! The program from outside: what it prints, what it leaves behind, and how it ends.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/knot_and_cables.obj");
const HEADER: &str = "qx,qy,qz,x,y,z,distance,primitive,feature";

fn p2m(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_p2m")).args(arguments).stdin(Stdio::null()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The table on the standard output of a run that succeeds.
fn table(arguments: &[&str]) -> String {
    let output = p2m(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// The message of a run that fails.
fn failure(arguments: &[&str], code: i32) -> String {
    let output = p2m(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    assert_eq!(text(&output.stdout), "", "{arguments:?}");
    assert!(message.starts_with("error: "), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
    message
}

fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> String {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path.to_str().unwrap().to_owned()
}

fn path(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

fn names(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into()).collect();
    names.sort();
    names
}

#[test]
fn backends_and_threads_give_the_same_table() {
    for sample in [&["--random", "500"][..], &["--grid", "7"], &["--random", "300", "--seed", "9", "--box-scale", "30"]]
    {
        let run = |more: &[&str]| table(&[&["query", SCENE], sample, more].concat());
        let expected = run(&["--backend", "brute"]);
        assert!(expected.starts_with(&format!("{HEADER}\n")));
        assert_eq!(run(&["--backend", "aabb"]), expected);
        assert_eq!(run(&[]), expected);
        assert_eq!(run(&["--threads", "1"]), expected);
        assert_eq!(run(&["--threads", "3"]), expected);
        assert_eq!(run(&["--out", "-"]), expected);
    }
    let seeds = ["0", "1"].map(|seed| table(&["query", SCENE, "--random", "5", "--seed", seed]));
    assert_ne!(seeds[0], seeds[1]);
    assert_eq!(seeds[0], table(&["query", SCENE, "--random", "5"]));
}

#[test]
fn the_summary_tells_what_was_done() {
    let folder = TempDir::new().unwrap();
    let scene =
        write(&folder, "s.obj", "vn 0 0 1\nusemtl a\nusemtl b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\np 1\n");
    let output = p2m(&["query", &scene, "--grid", "2", "--threads", "1", "--max-distance", "0.5"]);
    let summary = text(&output.stderr);
    for part in [
        scene.as_str(),
        "1 triangles, 1 segments, 1 points",
        "1 x vn, 2 x usemtl",
        "backend  aabb, built in ",
        "queries  8 in ",
        "on 1 thread: ",
        "ns per query",
        "queries/s",
        "without answer ",
        "distance min ",
    ] {
        assert!(summary.contains(part), "{part}: {summary}");
    }
}

/// What stands behind `start` in a line of the summary.
fn after<'a>(summary: &'a str, start: &str) -> &'a str {
    summary.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_else(|| panic!("{start}: {summary}"))
}

#[test]
#[allow(clippy::cast_precision_loss, reason = "a small count")]
fn the_summary_agrees_with_the_table() {
    let output = p2m(&["query", SCENE, "--random", "500", "--max-distance", "0.7", "--threads", "3"]);
    let (table, summary) = (text(&output.stdout), text(&output.stderr));
    let distances: Vec<f64> =
        table.lines().skip(1).filter_map(|line| line.split(',').nth(6).unwrap().parse().ok()).collect();
    let answered = distances.len();
    assert!((1..500).contains(&answered), "{answered}");
    assert!(after(&summary, "queries  500 in ").contains(" on 3 threads: "), "{summary}");
    assert_eq!(after(&summary, "answers  "), format!("{answered}, without answer {}", 500 - answered));
    let min = distances.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    let max = distances.iter().fold(0.0f64, |a, &b| a.max(b));
    let mean = distances.iter().sum::<f64>() / answered as f64;
    assert_eq!(after(&summary, "distance "), format!("min {min:?}, max {max:?}, mean {mean:?}"));
}

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
fn causes_are_told_once() {
    let folder = TempDir::new().unwrap();
    let missing = path(&folder, "missing.obj");
    let message = failure(&["query", &missing, "--grid", "1"], 1);
    assert_eq!(message.matches("o such file").count(), if cfg!(unix) { 1 } else { 0 }, "{message}");
    let directory = path(&folder, "folder.obj");
    fs::create_dir(&directory).unwrap();
    let message = failure(&["query", &directory, "--grid", "1"], 1);
    assert_eq!(message, format!("error: {directory}: cannot be read: is a directory\n"));
}

#[test]
fn given_points_are_answered_in_their_order() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 5 5 1e300\nf 1 2 3\np 4\n");
    let points = write(&folder, "q.xyz", "0.5 .25 3\n# so\n1 -2 0\n3 0 0\n5 5 1.5e300\n");
    let expected = format!(
        "{HEADER}\n0.5,0.25,3.0,0.5,0.25,0.0,3.0,0,face\n1.0,-2.0,0.0,1.0,0.0,0.0,2.0,0,edge0\n\
        3.0,0.0,0.0,2.0,0.0,0.0,1.0,0,vertex1\n5.0,5.0,1.5e300,5.0,5.0,1e300,"
    );
    let answers = table(&["query", &scene, "--points", &points, "--backend", "brute"]);
    assert_eq!(answers, table(&["query", &scene, "--points", &points]));
    assert!(answers.starts_with(&expected), "{answers}");
    assert!(answers.lines().last().unwrap().ends_with(",1,vertex0"), "{answers}");
    // The table itself asks the same questions again.
    let again = write(&folder, "q.csv", &answers);
    assert_eq!(table(&["query", &scene, "--points", &again]), answers);
}

#[test]
fn no_answer_leaves_empty_fields() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\np 1\n");
    let points = write(&folder, "q.csv", "x,y,z\n1,0,0\n2,0,0\n3,0,0\n");
    let expected = format!(
        "{HEADER}\n1.0,0.0,0.0,0.0,0.0,0.0,1.0,0,vertex0\n2.0,0.0,0.0,0.0,0.0,0.0,2.0,0,vertex0\n3.0,0.0,0.0,,,,,,\n"
    );
    for backend in ["brute", "aabb"] {
        assert_eq!(
            table(&["query", &scene, "--points", &points, "--max-distance", "2", "--backend", backend]),
            expected
        );
    }
}

#[test]
fn an_empty_scene_has_no_answers() {
    let folder = TempDir::new().unwrap();
    let obj = write(&folder, "e.obj", "# nothing\n");
    let ply = write(
        &folder,
        "e.ply",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
    );
    for scene in [obj, ply] {
        for backend in ["brute", "aabb"] {
            let output = p2m(&["query", &scene, "--grid", "2", "--backend", backend]);
            assert_eq!(output.status.code(), Some(0));
            let table = text(&output.stdout);
            assert_eq!(table.lines().count(), 9);
            assert!(table.lines().skip(1).all(|l| l.ends_with(",,,,,,")), "{table}");
            assert!(text(&output.stderr).contains("the scene is empty"));
        }
    }
    let scene = write(&folder, "p.obj", "v 0 0 0\n");
    assert_eq!(table(&["query", &scene, "--random", "0"]), format!("{HEADER}\n"));
}

#[test]
fn files_are_written_whole() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "a.csv");
    let run = |out: &str| p2m(&["query", SCENE, "--random", "100", "--out", out]);
    let output = run(&out);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), String::new()));
    let expected = table(&["query", SCENE, "--random", "100"]);
    assert_eq!(fs::read_to_string(&out).unwrap(), expected);
    // Over an old file, and with a bare name in the current directory.
    fs::write(&out, "old").unwrap();
    assert_eq!(run(&out).status.code(), Some(0));
    assert_eq!(fs::read_to_string(&out).unwrap(), expected);
    let status = Command::new(env!("CARGO_BIN_EXE_p2m"))
        .args(["query", SCENE, "--random", "100", "--out", "b.csv"])
        .current_dir(&folder)
        .stderr(Stdio::null())
        .status();
    assert!(status.unwrap().success());
    assert_eq!(fs::read_to_string(folder.path().join("b.csv")).unwrap(), expected);
    assert_eq!(names(folder.path()), [PathBuf::from("a.csv"), PathBuf::from("b.csv")]);
}

#[cfg(unix)]
#[test]
fn files_keep_their_kind_and_permissions() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    let folder = TempDir::new().unwrap();
    let (real, link) = (path(&folder, "real.csv"), path(&folder, "link.csv"));
    fs::write(&real, "old").unwrap();
    fs::set_permissions(&real, PermissionsExt::from_mode(0o640)).unwrap();
    symlink(&real, &link).unwrap();
    table(&["query", SCENE, "--random", "3", "--out", &link]);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(fs::read_to_string(&real).unwrap(), table(&["query", SCENE, "--random", "3"]));
    // A new file is as readable as any other new file.
    let (new, other) = (path(&folder, "new.csv"), path(&folder, "other"));
    table(&["query", SCENE, "--random", "3", "--out", &new]);
    fs::write(&other, "").unwrap();
    let mode = |p: &str| fs::metadata(p).unwrap().permissions().mode();
    assert_eq!(mode(&new), mode(&other));
    // A device is written to, not replaced.
    table(&["query", SCENE, "--random", "3", "--out", "/dev/null"]);
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

#[test]
fn what_cannot_be_done_is_code_1_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let corrupt = write(&folder, "corrupt.obj", "v 0 0 0\nf 1 2 3\n");
    let ply = write(
        &folder,
        "short.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
    );
    let unknown = write(&folder, "scene.step", "");
    let points = write(&folder, "bad.xyz", "0 0 0\n0 nan 0\n");
    let before = names(folder.path());
    let missing = path(&folder, "missing.obj");
    let out = path(&folder, "out.csv");
    let query = |scene: &str| failure(&["query", scene, "--random", "9", "--out", &out], 1);
    assert!(query(&missing).contains("missing.obj: cannot be read: "));
    assert!(query(&corrupt).contains("corrupt.obj:2: vertex index 2 is out of range, the file has 1 vertices so far"));
    assert!(query(&ply).contains("short.ply:9: unexpected end of file"));
    assert!(query(&unknown).contains("scene.step: unknown extension 'step', expected one of obj, ply"));
    let message = failure(&["query", SCENE, "--points", &points, "--out", &out], 1);
    assert!(message.contains("bad.xyz:2: coordinate 'nan' is not finite"), "{message}");
    assert_eq!(names(folder.path()), before);

    let nowhere = path(&folder, "no/such/folder/out.csv");
    let message = failure(&["query", SCENE, "--random", "9", "--out", &nowhere], 1);
    assert!(message.contains("no/such/folder/out.csv: cannot be written: "), "{message}");
    let directory = folder.path().to_str().unwrap();
    let message = failure(&["query", SCENE, "--random", "9", "--out", directory], 1);
    assert!(message.contains(directory), "{message}");
    let message = failure(&["generate", "knot-and-cables", "--out", &nowhere], 1);
    assert!(message.contains("no/such/folder/out.csv: cannot be written: "), "{message}");
    assert_eq!(names(folder.path()), before);
}

#[test]
fn inputs_are_not_written_over() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\n");
    let points = write(&folder, "q.xyz", "1 2 3\n");
    fs::create_dir(folder.path().join("sub")).unwrap();
    let mut outs = vec![scene.clone(), points.clone(), path(&folder, "sub/../s.obj"), path(&folder, "./q.xyz")];
    #[cfg(unix)]
    for (target, name) in [(&scene, "to_scene"), (&points, "to_points")] {
        std::os::unix::fs::symlink(target, folder.path().join(name)).unwrap();
        outs.push(path(&folder, name));
    }
    for out in &outs {
        let message = failure(&["query", &scene, "--points", &points, "--out", out], 1);
        assert!(message.contains("it is an input"), "{message}");
    }
    assert_eq!(fs::read_to_string(&scene).unwrap(), "v 0 0 0\n");
    assert_eq!(fs::read_to_string(&points).unwrap(), "1 2 3\n");
    // Before any work: this scene cannot even be read.
    let broken = write(&folder, "broken.obj", "v x\n");
    assert!(failure(&["query", &broken, "--grid", "1", "--out", &broken], 1).contains("it is an input"));
}

#[cfg(unix)]
#[test]
fn a_link_to_nothing_is_refused_and_stays() {
    let folder = TempDir::new().unwrap();
    let link = path(&folder, "link.csv");
    std::os::unix::fs::symlink(folder.path().join("nothing.csv"), &link).unwrap();
    let message = failure(&["query", SCENE, "--grid", "1", "--out", &link], 1);
    assert!(message.contains("link.csv: cannot be written: it is a link to nothing"), "{message}");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(names(folder.path()), [PathBuf::from("link.csv")]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_named() {
    let message = failure(&["query", SCENE, "--grid", "1", "--out", "/proc/new.csv"], 1);
    assert!(
        message.contains("/proc/new.csv: cannot be written: no file can be made in the folder '/proc'"),
        "{message}"
    );
    assert!(!message.contains(".p2m-"), "{message}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let message = failure(&["query", SCENE, "--random", "5000", "--out", "/dev/full"], 1);
    assert!(message.contains("/dev/full: cannot be written: "), "{message}");
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
        &["generate", "tree"],
        &["generate", "knot-and-cables", "--sides", "2"],
        &["ask"],
    ] {
        failure(arguments, 2);
    }
    assert_eq!(p2m(&[]).status.code(), Some(2));
}

#[test]
fn help_has_examples() {
    for arguments in
        [&["--help"][..], &["query", "--help"], &["generate", "--help"], &["generate", "knot-and-cables", "--help"]]
    {
        let help = table(arguments);
        assert!(help.contains("Example") && help.contains("  p2m "), "{help}");
    }
    assert!(table(&["--help"]).starts_with("Closest points of scenes of triangles, segments and points\n"));
    let help = table(&["query", "--help"]);
    for part in ["edge0", "vertex2", "exit code", "Points:0", "cut into triangles", "unit of the scene"] {
        assert!(help.contains(part), "{part}: {help}");
    }
    assert!(table(&["--version"]).starts_with("p2m "));
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_p2m"))
        .args(["query", SCENE, "--random", "50000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 10];
    child.stdout.as_mut().unwrap().read_exact(&mut first).unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
}

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

#[test]
fn flat_scenes_are_asked_about_from_both_sides() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "flat.obj", "v 0 0 3\nv 4 0 3\nv 0 4 3\nf 1 2 3\n");
    let table = table(&["query", &scene, "--random", "100", "--box-scale", "1.5"]);
    let z: Vec<f64> = table.lines().skip(1).map(|l| l.split(',').nth(2).unwrap().parse().unwrap()).collect();
    assert!(
        z.iter().any(|&z| z > 3.5) && z.iter().any(|&z| z < 2.5) && z.iter().all(|z| (2.0..=4.0).contains(z)),
        "{z:?}"
    );
}

#[test]
fn both_backends_print_the_same_table_for_every_model() {
    let Some(folder) = p2m_testkit::models() else { return };
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if !path.extension().is_some_and(|e| e == "obj" || e == "ply") {
            continue;
        }
        let scene = path.to_str().unwrap();
        let with = |backend| table(&["query", scene, "--random", "40", "--box-scale", "1.5", "--backend", backend]);
        assert!(with("aabb") == with("brute"), "{scene}");
        count += 1;
    }
    assert!(count > 0, "the folder has no model in a format that can be read");
}
