//! Builds what a release has for one target: the program, and the wheel of the Python package.

use crate::python::{environment, find_python, install_needed, text};
use crate::{Outcome, run, start};
use std::process::Command;

/// The Python package that makes wheels. Zig links wheels for Linux to a C library that is as old as the tag of the wheel says.
const NEEDED: [&str; 1] = ["maturin[zig]>=1.10,<2"];

/// Builds for a target, by default that of the machine.
pub(crate) fn build(arguments: &[String]) -> Outcome {
    let target: Vec<&str> = match arguments {
        [] => Vec::new(),
        [target] => vec!["--target", target],
        _ => return Err("the only argument of this task is a target".to_owned()),
    };
    let Some(python) = find_python() else {
        return crate::skip("there is no Python for the wheel");
    };
    let bin = environment(&python, "release-env")?;
    let python = text(&bin.join("python"))?;
    if let Err(why) = install_needed(&python, &NEEDED) {
        return crate::skip(&format!("maturin cannot be installed\n{why}"));
    }
    let is_linux = if let [_, name] = target[..] { name.contains("linux") } else { cfg!(target_os = "linux") };
    let is_musl = target.iter().any(|name| name.contains("musl"));
    let mut wheel = vec!["-m", "maturin", "build", "--release", "--manifest-path", "bindings/python/Cargo.toml"];
    if is_linux {
        wheel.extend(["--zig", "--compatibility", if is_musl { "musllinux_1_2" } else { "manylinux_2_17" }]);
    }
    // Maturin looks for the Zig of its environment on the path.
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(bin).chain(std::env::split_paths(&path));
    let path = std::env::join_paths(folders).map_err(|error| format!("PATH: {error}"))?;
    start(Command::new(&python).args(wheel).args(&target).env("PATH", path))?;
    run("cargo", &[&["build", "--release", "--locked", "--package", "p2m-cli"][..], &target].concat(), &[])
}
