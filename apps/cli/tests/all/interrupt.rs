//! An interrupted run leaves nothing behind.

#![cfg(unix)]

use crate::common::*;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A run that takes hours on every machine.
const LONG_RUN: [&str; 5] = ["--random", "1000000000", "--backend", "brute", "--out"];

/// Starts a long query that writes to `answers.csv`, and waits until its unfinished file is there.
fn start(folder: &Path, before: &mut Command) -> Child {
    let child = before.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while !names(folder).iter().any(|name| name.to_str().is_some_and(|n| n.starts_with(".p2m-"))) {
        assert!(start.elapsed() < Duration::from_secs(60), "no file was begun");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn query(folder: &Path) -> Command {
    long("query", folder)
}

fn long(name: &str, folder: &Path) -> Command {
    let mut command = program(&[name, SCENE]);
    command.args(LONG_RUN).arg(folder.join("answers.csv"));
    command
}

fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

/// Returns whether the tests were started with this signal ignored, in the background of a script (SIGINT) or by
/// `nohup` (SIGHUP, number 1). The program then has to ignore it as well.
fn is_ignored_here(number: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let is_ignored = mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() >> (number - 1) & 1 == 1);
    if is_ignored {
        p2m_testkit::skip(&format!("started with signal {number} ignored"));
    }
    is_ignored
}

#[test]
fn an_interrupted_run_leaves_what_was_there_before() {
    for (name, signal, code) in [("query", "-INT", 130), ("query", "-TERM", 143), ("ray", "-INT", 130)] {
        if signal == "-INT" && is_ignored_here(2) {
            continue;
        }
        let folder = TempDir::new().unwrap();
        write(&folder, "answers.csv", "old");
        let child = start(folder.path(), long(name, folder.path()).arg("--quiet"));
        assert_eq!(names(folder.path()).len(), 2);
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{signal}");
        assert_eq!(text(&output.stderr), "", "{signal}");
        assert_eq!(names(folder.path()), [Path::new("answers.csv")], "{signal}");
        assert_eq!(std::fs::read_to_string(folder.path().join("answers.csv")).unwrap(), "old", "{signal}");
    }
}

#[test]
fn an_interrupted_run_leaves_no_folder_of_shards() {
    let folder = TempDir::new().unwrap();
    let site = folder.path().join("site");
    let mut command = program(&["shard", "-", "--format", "obj", "--out"]);
    // The input does not end, so that the run waits for it.
    let mut child =
        command.arg(&site).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !site.is_dir() || names(&site).is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "no file was begun");
        std::thread::sleep(Duration::from_millis(5));
    }
    // `wait` would close the input that the child has, and the run would end by itself.
    let input = child.stdin.take();
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(143));
    drop(input);
    assert!(names(folder.path()).is_empty());
}

/// A run started by `nohup` goes on when its terminal closes, one in the background of a script when the script is
/// interrupted; both still end by SIGTERM.
#[cfg(target_os = "linux")]
#[test]
fn ignored_signals_stay_ignored() {
    let folder = TempDir::new().unwrap();
    for (ignored, sent, code) in [("HUP", "-HUP", 143), ("USR1", "-HUP", 129), ("INT", "-INT", 143)] {
        if ignored == "USR1" && is_ignored_here(1) {
            continue;
        }
        let mut command = Command::new("sh");
        let p2m = query(folder.path());
        command
            .args(["-c", &format!("trap '' {ignored}; exec \"$@\""), "sh"])
            .arg(p2m.get_program())
            .args(p2m.get_args());
        let child = start(folder.path(), &mut command);
        send(sent, &child);
        if code == 143 {
            // A program that does not ignore the signal, as it should, ends meanwhile by it.
            std::thread::sleep(Duration::from_millis(300));
            let _ = Command::new("kill").args(["-TERM", &child.id().to_string()]).stderr(Stdio::null()).status();
        }
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(code), "{sent} while {ignored} is ignored");
        assert!(names(folder.path()).is_empty());
    }
}
