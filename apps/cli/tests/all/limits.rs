//! Input that would fill the memory is refused.

use crate::common::*;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Write;
use tempfile::TempDir;

/// Writes this number of MiB of comments, compressed.
fn compressed(folder: &TempDir, name: &str, mebibytes: usize) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    for _ in 0..mebibytes {
        encoder.write_all(format!("{:#<65535}\n", "").repeat(16).as_bytes()).unwrap();
    }
    write(folder, name, encoder.finish().unwrap())
}

#[test]
fn a_line_has_a_limit_that_can_be_raised() {
    let folder = TempDir::new().unwrap();
    let comment = [&b"v 0 0 0\np 1\n# "[..], &vec![b'x'; 65 << 20], b"\n"].concat();
    let long = write(&folder, "long.obj", comment);
    let message = failure(&["info", &long], 1);
    assert!(message.contains("long.obj:3: cannot be read: a line has more than 67108864 bytes"), "{message}");
    assert!(message.contains("--read-limit line="), "{message}");
    // The limit is that of the process, and other tests run in this one.
    let output = program(&["info", &long, "--read-limit", "line=100MB"]).output().unwrap();
    assert!(output.status.success() && text(&output.stdout).contains("1 point"), "{}", text(&output.stderr));
    let message = failure(&["info", &long, "--read-limit", "lines=3"], 2);
    assert!(message.contains("not one of line=SIZE"), "{message}");
}

#[test]
fn decompressed_files_have_limits_that_can_be_raised() {
    let folder = TempDir::new().unwrap();
    let bomb = compressed(&folder, "bomb.obj.gz", 80);
    assert!(fs::metadata(&bomb).unwrap().len() < 100_000);
    let message = failure(&["info", &bomb], 1);
    assert!(message.contains("decompresses to more than 200 times its length"), "{message}");
    assert!(message.contains("--read-limit ratio=.. raises the limit"), "{message}");
    assert_eq!(p2m(&["info", &bomb, "--read-limit", "ratio=2000"]).code, 0);
    let message = failure(&["info", &bomb, "--read-limit", "ratio=2000", "--read-limit", "decompressed=70MB"], 1);
    assert!(message.contains("decompresses to more than 70000000 bytes"), "{message}");
    // Little that is compressed well is read.
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all("v 0 0 0\n".repeat(100_000).as_bytes()).unwrap();
    let small = write(&folder, "small.obj.gz", encoder.finish().unwrap());
    assert!(table(&["info", &small]).contains("100,000 points"));
}

#[cfg(unix)]
#[test]
fn the_file_of_a_matrix_has_a_limit() {
    let run = |arguments: &[&str]| failure(&[&["distance", SCENE, SCENE, "--transform"], arguments].concat(), 1);
    let message = run(&["/dev/zero"]);
    assert!(
        message.contains("/dev/zero: cannot be read: it has more than 1048576 bytes (--read-limit matrix="),
        "{message}"
    );
    assert!(run(&["/dev/zero", "--read-limit", "matrix=2MiB"]).contains("more than 2097152 bytes"));
}

#[cfg(target_os = "linux")]
#[test]
fn where_memory_ends_there_is_an_error() {
    let folder = TempDir::new().unwrap();
    let points = write(&folder, "points.obj", "v 0 0 0\n".repeat(8_000_000));
    let run = |kilobytes: u32| {
        let script = format!("ulimit -v {kilobytes}; exec \"$0\" info \"$1\"");
        std::process::Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_p2m"), &points])
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .unwrap()
    };
    let output = run(400_000);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("memory"), "{}", text(&output.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn the_environment_starts_at_most_1024_threads() {
    let folder = TempDir::new().unwrap();
    let pipe = path(&folder, "in.obj");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut child = program(&["info", &pipe]).env("RAYON_NUM_THREADS", "99999").spawn().unwrap();
    // The program has its threads when it opens the scene.
    let mut scene = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    let threads = fs::read_dir(format!("/proc/{}/task", child.id())).unwrap().count();
    scene.write_all(b"v 0 0 0\n").unwrap();
    drop(scene);
    assert!(child.wait().unwrap().success());
    assert!((1024..1034).contains(&threads), "{threads}");
}
