//! The output on a terminal. These tests need the program `script` of util-linux, which makes a terminal.

#![cfg(target_os = "linux")]

use crate::common::*;
use std::collections::BTreeSet;
use std::process::{Command, Stdio};

/// Returns the output of a shell command on a terminal, or `None` without `script`.
fn on_terminal(command: &str, environment: &[(&str, &str)]) -> Option<String> {
    let mut script = Command::new("script");
    script.args(["-qec", command, "/dev/null"]).env("P2M", program(&[]).get_program()).env("SCENE", SCENE);
    script.env_remove("NO_COLOR").env("TERM", "xterm").stdin(Stdio::null());
    for (name, value) in environment {
        script.env(name, value);
    }
    let Ok(output) = script.output() else {
        p2m_testkit::skip("there is no program 'script'");
        return None;
    };
    Some(text(&output.stdout))
}

/// Returns the output of a long run that is ended after a few seconds, or on a busy machine later, when `is_enough` says
/// that there is what it should show.
fn long_run_on_terminal(environment: &[(&str, &str)], is_enough: impl Fn(&str) -> bool) -> Option<String> {
    let mut shown = String::new();
    for seconds in [3, 12, 60] {
        let run = LONG_RUN.replace("timeout 3 ", &format!("timeout {seconds} "));
        shown = on_terminal(&run, environment)?;
        if is_enough(&shown) {
            break;
        }
    }
    Some(shown)
}

const LONG_RUN: &str =
    "timeout 3 \"$P2M\" query \"$SCENE\" --random 100000000 --backend brute --threads 1 --out /dev/null";

#[test]
fn long_work_shows_a_bar_on_a_terminal_only() {
    // The bar moves.
    let states = |shown: &str| -> usize {
        shown.split_whitespace().filter(|word| word.ends_with("/100,000,000")).collect::<BTreeSet<_>>().len()
    };
    let Some(shown) = long_run_on_terminal(&[], |shown| states(shown) > 3) else { return };
    assert!(shown.contains("answering") && states(&shown) > 3, "{shown:?}");
    // Before the first answer there is no estimate of the time.
    assert!(!shown.contains(" 0/100,000,000 queries, "), "{shown:?}");
    let shown = on_terminal(&format!("{LONG_RUN} 2>/dev/null"), &[]).unwrap();
    assert_eq!(shown, "");
    let shown = on_terminal(&format!("{LONG_RUN} --quiet"), &[]).unwrap();
    assert_eq!(shown, "\r\n");
    // There is no bar, but a note, and after an interruption the prompt of the shell is on a line of its own.
    let shown = long_run_on_terminal(&[("TERM", "dumb")], |shown| shown.starts_with("note")).unwrap();
    let note = shown.strip_prefix("note     100,000,000 queries: about 14").unwrap_or_else(|| panic!("{shown:?}"));
    assert!(note.ends_with("\r\n\r\n") && note.lines().count() == 2, "{shown:?}");
}

#[test]
fn short_work_shows_no_bar() {
    let Some(shown) = on_terminal("\"$P2M\" query \"$SCENE\" --random 10 --out /dev/null", &[]) else { return };
    assert!(shown.starts_with("scene    "), "{shown:?}");
    assert!(!shown.contains('\u{1b}') && !shown.contains("answering"), "{shown:?}");
}

#[test]
fn colours_are_for_terminals_that_want_them() {
    let help = "\"$P2M\" query --scene-that-is-no-option";
    let Some(shown) = on_terminal(help, &[]) else { return };
    assert!(shown.contains("\u{1b}["), "{shown:?}");
    let shown = on_terminal(help, &[("NO_COLOR", "1")]).unwrap();
    assert!(shown.contains("error: ") && !shown.contains('\u{1b}'), "{shown:?}");
    // So are those of errors of a run.
    let missing = "\"$P2M\" info missing.obj";
    let shown = on_terminal(missing, &[]).unwrap();
    assert!(shown.starts_with('\u{1b}') && shown.contains("missing.obj: cannot be read"), "{shown:?}");
    let shown = on_terminal(missing, &[("NO_COLOR", "1")]).unwrap();
    assert!(shown.starts_with("error: missing.obj: cannot be read"), "{shown:?}");
    // The bar has no colours, only codes that move the cursor and clear the line.
    let shown = long_run_on_terminal(&[("NO_COLOR", "1")], |shown| shown.contains("answering")).unwrap();
    assert!(shown.contains("answering") && !shown.contains("\u{1b}[3"), "{shown:?}");
}

#[test]
fn binary_files_are_kept_off_terminals() {
    for command in
        ["query \"$SCENE\" --random 3 --out-format npy", "convert \"$SCENE\" - --to ply", "generate sphere --to stl"]
    {
        let Some(shown) = on_terminal(&format!("\"$P2M\" {command}; echo code $?"), &[]) else { return };
        assert!(shown.contains("is no text for a terminal") && shown.contains("code 2"), "{command}: {shown:?}");
    }
}
