//! Tests of `p2m completions` and `p2m man`.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

const COMMANDS: [&str; 20] = [
    "query",
    "build",
    "shard",
    "distance",
    "hausdorff",
    "deviation",
    "align",
    "stats",
    "field",
    "sample",
    "advise",
    "tradeoff",
    "ray",
    "info",
    "boxes",
    "view",
    "convert",
    "generate",
    "completions",
    "man",
];

#[test]
fn every_shell_gets_completions() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = table(&["completions", shell]);
        for word in COMMANDS.iter().chain(&["max-distance", "knot-and-cables", "rotate-x"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    failure(&["completions"], 2);
    assert!(failure(&["completions", "sh"], 2).contains("bash, elvish, fish, powershell, zsh"));
}

#[cfg(unix)]
#[test]
fn bash_completes() {
    let folder = TempDir::new().unwrap();
    let script = write(&folder, "p2m.bash", table(&["completions", "bash"]));
    let ask = "source \"$1\"; shift; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); \
        _p2m p2m \"${!#}\" \"${*: -2:1}\"; echo \"${COMPREPLY[@]}\"";
    for (line, expected) in [
        (&["p2m", "que"][..], "query"),
        (&["p2m", "info", "--format", "o"], "obj off"),
        (&["p2m", "query", "--out-format", ""], "csv npy ply"),
        (&["p2m", "generate", "c"], "cone cylinder cable-bundle"),
    ] {
        let Ok(output) = std::process::Command::new("bash").args(["-c", ask, "bash", &script]).args(line).output()
        else {
            p2m_testkit::skip("there is no bash");
            return;
        };
        assert_eq!(text(&output.stdout).trim_end(), expected, "{line:?} {}", text(&output.stderr));
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let page = table(&["man"]);
    assert!(page.contains(".TH p2m 1") && COMMANDS.iter().all(|c| page.contains(c)), "{page}");
    let folder = TempDir::new().unwrap();
    let pages = path(&folder, "share/man1");
    assert_eq!(table(&["man", "--out", &pages]), "");
    let found = names(pages.as_ref());
    for command in COMMANDS {
        let name = format!("p2m-{command}.1");
        let page = fs::read_to_string(format!("{pages}/{name}")).unwrap();
        assert!(
            page.contains(&format!(".TH p2m\\-{command} 1")) || page.contains(&format!(".TH p2m-{command} 1")),
            "{page}"
        );
        assert!(page.contains("Example") && page.contains(&format!("p2m {command}")), "{name}: {page}");
    }
    assert!(found.contains(&"p2m.1".into()) && found.contains(&"p2m-generate-torus-knot.1".into()), "{found:?}");
    assert_eq!(found.len(), 1 + COMMANDS.len() + 9, "{found:?}");
    assert_eq!(fs::read_to_string(format!("{pages}/p2m.1")).unwrap(), page);
}

#[cfg(target_os = "linux")]
#[test]
fn help_that_cannot_be_written_is_an_error() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = program(&["--help"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output.stderr).starts_with("error: the standard output: cannot be written"),
        "{}",
        text(&output.stderr)
    );
}
