//! What only a terminal sees. Needs the program `script` of util-linux, which makes one.

#![cfg(target_os = "linux")]

use crate::common::*;
use std::collections::BTreeSet;
use std::process::{Command, Stdio};

/// What a terminal shows of a shell command; `None` without `script`.
fn on_terminal(command: &str, environment: &[(&str, &str)]) -> Option<String> {
    let mut script = Command::new("script");
    script.args(["-qec", command, "/dev/null"]).env("P2M", program(&[]).get_program()).env("SCENE", SCENE);
    script.env_remove("NO_COLOR").env("TERM", "xterm").stdin(Stdio::null());
    for (name, value) in environment {
        script.env(name, value);
    }
    let Ok(output) = script.output() else {
        eprintln!("skipped: there is no program 'script'");
        return None;
    };
    Some(text(&output.stdout))
}

const LONG: &str = "timeout 3 \"$P2M\" query \"$SCENE\" --random 100000000 --backend brute --threads 1 --out /dev/null";

#[test]
fn long_work_shows_a_bar_on_a_terminal_only() {
    let Some(shown) = on_terminal(LONG, &[]) else { return };
    // It moves on.
    let words: BTreeSet<_> = shown.split_whitespace().filter(|word| word.ends_with("/100,000,000")).collect();
    assert!(shown.contains("answering") && words.len() > 3, "{shown:?}");
    let shown = on_terminal(&format!("{LONG} 2>/dev/null"), &[]).unwrap();
    assert_eq!(shown, "");
    // No bar, but the prompt of the shell goes to a line of its own after an interruption.
    let shown = on_terminal(LONG, &[("TERM", "dumb")]).unwrap();
    assert_eq!(shown, "\r\n");
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
    // The bar has no colours at all: of the codes only those that move the cursor and clear the line.
    let shown = on_terminal(LONG, &[("NO_COLOR", "1")]).unwrap();
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
