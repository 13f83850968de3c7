//! Builds what a release has for one target: the program, and the wheel of the Python package.

use crate::{OrSkip, Outcome, command, path_with, start, tools};
use std::path::Path;
use std::process::Command;

/// The Python package that makes wheels. Zig links wheels for Linux to a C library that is as old as the tag of the wheel says.
const NEEDED: [&str; 1] = ["maturin[zig]>=1.10,<2"];

/// Builds for a target, by default that of the machine.
pub(crate) fn build(arguments: &[String]) -> Outcome {
    let target: Vec<&str> = arguments.iter().flat_map(|target| ["--target", target]).collect();
    let python = tools::python("release-env", &NEEDED).or_skip("maturin cannot be installed")?;
    let is_linux = if let [_, name] = target[..] { name.contains("linux") } else { cfg!(target_os = "linux") };
    let is_musl = target.iter().any(|name| name.contains("musl"));
    let mut wheel = "-m maturin build --release --manifest-path bindings/python/Cargo.toml".to_owned();
    if is_linux {
        wheel += &format!(" --zig --compatibility {}", if is_musl { "musllinux_1_2" } else { "manylinux_2_17" });
    }
    // Maturin looks for the Zig of its environment on the path.
    let path = path_with(python.parent().unwrap_or(Path::new("")), false)?;
    start(Command::new(&python).args(wheel.split(' ')).args(&target).env("PATH", path))?;
    start(command("cargo build --release --locked --package p2m-cli").args(&target))
}
