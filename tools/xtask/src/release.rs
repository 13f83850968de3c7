//! Builds what a release has for one target: the program, and the wheel of the Python package.

use crate::{OrSkip, Outcome, run, start, tools};
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
    let mut wheel = vec!["-m", "maturin", "build", "--release", "--manifest-path", "bindings/python/Cargo.toml"];
    if is_linux {
        wheel.extend(["--zig", "--compatibility", if is_musl { "musllinux_1_2" } else { "manylinux_2_17" }]);
    }
    // Maturin looks for the Zig of its environment on the path.
    let path = std::env::var_os("PATH").unwrap_or_default();
    let bin = python.parent().map(Path::to_owned);
    let folders = bin.into_iter().chain(std::env::split_paths(&path));
    let path = std::env::join_paths(folders).map_err(|error| format!("PATH: {error}"))?;
    start(Command::new(&python).args(wheel).args(&target).env("PATH", path))?;
    run("cargo", &[&["build", "--release", "--locked", "--package", "p2m-cli"][..], &target].concat(), &[])
}
