//! Tests that docs/transcript.md and the pages of jobs have the real output of their commands.
//!
//! In blocks marked `console`, lines that start with `$ ` are commands. The lines after them are their output, with the
//! standard error. `P2M_BLESS=1` writes the file anew.

#![cfg(unix)]

use crate::common::*;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

/// Returns the output of a command of the transcript, with its exit code if it is not 0.
fn run(command: &str, folder: &Path) -> String {
    let program = program(&[]);
    let programs = Path::new(program.get_program()).parent().unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let output = Command::new("sh")
        .args(["-c", &format!("exec 2>&1\n{command}")])
        .current_dir(folder)
        .env("PATH", path)
        .env("COLUMNS", "100")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let mut text = text(&output.stdout);
    if !text.is_empty() && !text.ends_with('\n') {
        text.push('\n');
    }
    match output.status.code() {
        Some(0) => {}
        Some(code) => writeln!(text, "[exit code {code}]").unwrap(),
        None => panic!("{command}: {}", output.status),
    }
    text
}

/// Returns the transcript with the real output of each command.
fn replay(transcript: &str, folder: &Path) -> String {
    let mut replayed = String::new();
    let mut is_console = false;
    for line in transcript.lines() {
        if line.starts_with("```") {
            is_console = line == "```console";
        }
        if let Some(command) = line.strip_prefix("$ ").filter(|_| is_console) {
            writeln!(replayed, "{line}").unwrap();
            replayed += &run(command, folder);
        } else if !is_console || line.starts_with("```") {
            writeln!(replayed, "{line}").unwrap();
        }
    }
    replayed
}

/// Units of times and of rates.
const UNITS: [&str; 7] = ["ns", "us", "ms", "s", "k", "M", "G"];

/// Replaces times by dots, because they differ from run to run.
fn masked(transcript: &str) -> String {
    let mask = |line: &str| {
        for start in ["backend  ", "queries  ", "rays     "] {
            if let Some((before, after)) = line.split_once(" in ").filter(|_| line.starts_with(start)) {
                // The number of threads is kept.
                let words: Vec<&str> = after.split(' ').collect();
                let is_time = |i: usize| words[i].starts_with(char::is_numeric) && (i == 0 || words[i - 1] != "on");
                // Units depend on the time as well.
                let is_unit = |i: usize| i > 0 && is_time(i - 1) && UNITS.contains(&words[i]);
                let kept = (0..words.len()).filter(|i| !is_unit(*i));
                let masked: Vec<&str> = kept.map(|i| if is_time(i) { "..." } else { words[i] }).collect();
                return format!("{before} in {}", masked.join(" "));
            }
        }
        for key in ["\"read\": ", "\"build\": ", "\"query\": "] {
            if let Some((before, _)) = line.split_once(key).filter(|(_, value)| value.starts_with(char::is_numeric)) {
                return format!("{before}{key}...");
            }
        }
        line.to_owned()
    };
    transcript.lines().map(|line| mask(line) + "\n").collect()
}

/// Checks that a page has the output of at least so many commands.
fn check(page: &str, commands: usize) {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::copy(SCENE, folder.path().join("scenes/knot_and_cables.obj")).unwrap();
    let path = Path::new(DOCS).join(page);
    let old = fs::read_to_string(&path).unwrap();
    let replayed = replay(&old, folder.path());
    assert!(replayed.matches("\n$ ").count() >= commands, "{page}");
    let new = masked(&replayed);
    if new == old {
        return;
    }
    if std::env::var_os("P2M_BLESS").is_some() {
        fs::write(path, new).unwrap();
        return;
    }
    let differing = new.lines().zip(old.lines()).enumerate().find(|(_, (new, old))| new != old);
    panic!("docs/{page} is out of date (P2M_BLESS=1 writes it anew): {differing:#?}");
}

#[test]
fn the_transcript_is_what_comes_out() {
    check("transcript.md", 20);
}

#[test]
fn pages_of_jobs_are_what_comes_out() {
    for (page, commands) in [("guide/inspection.md", 3), ("guide/maps.md", 6), ("guide/shell.md", 6)] {
        check(page, commands);
    }
}

#[test]
fn only_times_are_masked() {
    let line = "queries  10 in 1.5 ms on 1 thread: 150 ns per query, 6.00 k queries/s";
    assert_eq!(masked(line), "queries  10 in ... on 1 thread: ... per query, ... queries/s\n");
    assert_eq!(masked("    \"read\": 0.25,"), "    \"read\": ...\n");
    for line in ["in       gear.ply (ply): 3 triangles", "  \"query\": {", "scene    in time", "1.0,2.0"] {
        assert_eq!(masked(line), format!("{line}\n"));
    }
}
