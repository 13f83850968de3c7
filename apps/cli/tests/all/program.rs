//! A test that the program does the same as a run within the process of the tests.

use crate::common::*;
use std::io::Write;
use std::process::Stdio;

#[test]
fn the_program_writes_and_returns_what_a_run_does() {
    let input = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (arguments, code) in [
        (&["info", "-", "--format", "obj"][..], 0),
        (&["info", "-", "--format", "obj", "--json"], 0),
        (&["convert", "-", "-", "--from", "obj", "--to", "stl"], 0),
        (&["--version"], 0),
        (&["query", "--help"], 0),
        (&["info", "missing.obj"], 1),
        (&["convert", "-", "-", "--from", "stl", "--to", "obj"], 1),
        (&["info", "-"], 2),
        (&["query", "-"], 2),
        (&[], 2),
    ] {
        let run = p2m_with(arguments, input);
        assert_eq!(run.code, code, "{arguments:?}");
        let mut program = program(arguments);
        // The variable COLUMNS would change the width of help.
        program.env_remove("COLUMNS").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = program.spawn().unwrap();
        // The program may have closed its standard input without reading it.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(i32::from(code)), "{arguments:?}");
        assert_eq!(output.stdout, run.stdout, "{arguments:?}");
        assert_eq!(output.stderr, run.stderr, "{arguments:?}");
        assert_ne!(run.stdout.len() + run.stderr.len(), 0, "{arguments:?}");
    }
}
