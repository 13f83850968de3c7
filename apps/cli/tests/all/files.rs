//! The program leaves complete files or none, and overwrites no inputs.

use crate::common::*;
use std::fs;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::Stdio;
use tempfile::TempDir;

#[test]
fn files_are_written_whole() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "a.csv");
    let run = |out: &str| p2m(&["query", SCENE, "--random", "100", "--out", out]);
    let output = run(&out);
    assert_eq!((output.code, text(&output.stdout)), (0, String::new()));
    let expected = table(&["query", SCENE, "--random", "100"]);
    assert_eq!(fs::read_to_string(&out).unwrap(), expected);
    // An old file is replaced, also under a bare name in the current directory.
    fs::write(&out, "old").unwrap();
    assert_eq!(run(&out).code, 0);
    assert_eq!(fs::read_to_string(&out).unwrap(), expected);
    let output = program(&["query", SCENE, "--random", "100", "--out", "b.csv"]).current_dir(&folder).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
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
    // A new file has the permissions of any other new file.
    let (new, other) = (path(&folder, "new.csv"), path(&folder, "other"));
    table(&["query", SCENE, "--random", "3", "--out", &new]);
    fs::write(&other, "").unwrap();
    let mode = |p: &str| fs::metadata(p).unwrap().permissions().mode();
    assert_eq!(mode(&new), mode(&other));
    // A device is written to and not replaced.
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
    let points = write(&folder, "bad.xyz", "0 0 0\n0 x 0\n");
    let before = names(folder.path());
    let missing = path(&folder, "missing.obj");
    let out = path(&folder, "out.csv");
    let query = |scene: &str| failure(&["query", scene, "--random", "9", "--out", &out], 1);
    assert!(query(&missing).contains("missing.obj: cannot be read: "));
    assert!(query(&corrupt).contains("corrupt.obj:2: vertex index 2 is out of range, 1 vertices were found"));
    assert!(query(&ply).contains("short.ply:9: unexpected end of file"));
    assert!(
        query(&unknown)
            .contains("scene.step: files with the extension 'step' are not read: FreeCAD or gmsh convert it")
    );
    let message = failure(&["query", SCENE, "--points", &points, "--out", &out], 1);
    assert!(message.contains("bad.xyz:2: 'x' is not a number"), "{message}");
    assert_eq!(names(folder.path()), before);

    let nowhere = path(&folder, "no/such/folder/out.csv");
    let message = failure(&["query", SCENE, "--random", "9", "--out", &nowhere], 1);
    assert!(message.contains("no/such/folder/out.csv: cannot be written: "), "{message}");
    let directory = folder.path().to_str().unwrap();
    let message = failure(&["query", SCENE, "--random", "9", "--out", directory], 1);
    assert!(message.contains(directory), "{message}");
    let nowhere = path(&folder, "no/such/folder/out.obj");
    let message = failure(&["generate", "knot-and-cables", "--out", &nowhere], 1);
    assert!(message.contains("no/such/folder/out.obj: cannot be written: "), "{message}");
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
    // The name is checked before any work: this scene cannot be read.
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
fn causes_are_told_once() {
    let folder = TempDir::new().unwrap();
    let missing = path(&folder, "missing.obj");
    let message = failure(&["query", &missing, "--grid", "1"], 1);
    assert_eq!(message.matches("o such file").count(), if cfg!(unix) { 1 } else { 0 }, "{message}");
    let directory = path(&folder, "folder.obj");
    fs::create_dir(&directory).unwrap();
    let message = failure(&["info", &directory], 1);
    assert_eq!(message, format!("error: {directory}: cannot be read: is a directory\n"));
}

/// A writer that fails like a pipe whose reader closes it after three bytes.
struct Left {
    is_begun: bool,
}

impl Write for Left {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if std::mem::replace(&mut self.is_begun, true) {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        Ok(bytes.len().min(3))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    for arguments in [
        &["query", SCENE, "--random", "50000"][..],
        &["query", SCENE, "--random", "50000", "--out-format", "npy"],
        &["generate", "torus-knot", "--subdivide", "2"],
        &["convert", SCENE, "-", "--to", "off", "--subdivide", "3"],
    ] {
        let (code, stderr) = p2m_into(arguments, "", Left { is_begun: false });
        assert_eq!((code, text(&stderr)), (0, String::new()), "{arguments:?}");
    }
    // The program writes to a real pipe whose reader has closed it.
    let mut query = program(&["query", SCENE, "--random", "50000"]);
    let mut child = query.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = [0; 3];
    child.stdout.as_mut().unwrap().read_exact(&mut first).unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
}
