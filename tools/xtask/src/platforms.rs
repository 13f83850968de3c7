//! Checks that the library and the program compile for platforms whose programs this machine does not run, and runs
//! tests for Windows under wine.
//!
//! A target is checked by the current compiler if it has the standard library, else by that of Debian, which compiles the
//! standard library as well.

use crate::arm::{AGREEMENT, compare_outputs};
use crate::debian::{Packages, cargo_for, has_standard_library};
use crate::{OrSkip, Outcome, Stop, exists, go_on, make_folder, path_with, start, target as target_folder};
use std::process::Command;

/// Windows, macOS, 32 bits, and numbers with the highest byte first.
const TARGETS: [&str; 7] = [
    "x86_64-pc-windows-gnu",
    "aarch64-pc-windows-msvc",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
    "i686-unknown-linux-gnu",
    "armv7-unknown-linux-gnueabihf",
    "s390x-unknown-linux-gnu",
];

/// The package with what makes import libraries for Windows.
const WINDOWS_PACKAGES: &str = "binutils-mingw-w64-x86-64";

/// The target whose programs wine runs.
const WINDOWS: &str = TARGETS[0];
/// The linker for it, and the program that runs what it links: packages of Debian have both.
const LINKER: &str = "x86_64-w64-mingw32-gcc";
const WINE: &str = "wine";
/// A library that old versions of wine lack, and its source.
const RANDOM_LIBRARY: &str = "bcryptprimitives.dll";
const RANDOM_SOURCE: &str = "tools/xtask/src/bcryptprimitives.c";

/// Checks some targets, or all. With `--wine` it runs tests for Windows instead.
pub(crate) fn check(arguments: &[String]) -> Outcome {
    if arguments == ["--wine"] {
        return run_under_wine();
    }
    let all = TARGETS.map(str::to_owned);
    for target in if arguments.is_empty() { &all[..] } else { arguments } {
        let why = format!("there is no standard library of {target} (rustup target add {target})");
        let check = cargo(target, "check --locked --package p2m --package p2m-cli");
        go_on(check.or_skip(&why).and_then(|mut cargo| start(&mut cargo)))?;
    }
    Ok(())
}

/// Returns a command of cargo for a target, or why there is no compiler for it.
fn cargo(target: &str, line: &str) -> Result<Command, String> {
    if has_standard_library(target) {
        return Ok(cargo_for(target, None, "", line));
    }
    let packages = Packages::rust_and("windows", WINDOWS_PACKAGES)?;
    let mut cargo = cargo_for(target, Some(&packages), "std,panic_unwind", line);
    cargo.env("PATH", path_with(&packages.file("usr/bin"), true)?);
    cargo.env("CARGO_TARGET_DIR", target_folder("platforms"));
    Ok(cargo)
}

/// Runs the agreement of all backends, the checksums of answers and the program for Windows.
fn run_under_wine() -> Outcome {
    if !exists(LINKER) || !exists(WINE) {
        let why = format!("there is no {LINKER} or no {WINE} (apt-get install gcc-mingw-w64-x86-64 wine64)");
        return Err(Stop::Skipped(why));
    }
    let folder = target_folder("wine");
    make_folder(&folder)?;
    let library = folder.join(RANDOM_LIBRARY);
    start(Command::new(LINKER).args(["-shared", RANDOM_SOURCE, "-ladvapi32", "-o"]).arg(library))?;
    let wine = |command: &mut Command| {
        // Wine finds libraries there, in its own form of paths, and prints messages of its own unless this is set.
        command.env("WINEPATH", format!("Z:{}", folder.display())).env("WINEDEBUG", "-all");
    };
    let cargo = |line: &str| {
        let mut cargo = cargo(WINDOWS, line)?;
        wine(cargo.env("CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER", WINE));
        Ok::<_, String>(cargo)
    };
    start(&mut cargo("test --locked --package p2m-testkit --test checksums")?)?;
    start(cargo("test --locked --package p2m --test all")?.arg("--").args(AGREEMENT))?;
    start(&mut cargo("build --locked --package p2m-cli")?)?;
    let subfolder = if has_standard_library(WINDOWS) { "" } else { "platforms" };
    let program = target_folder(subfolder).join(WINDOWS).join("debug/p2m.exe");
    compare_outputs(|| {
        let mut program_under_wine = Command::new(WINE);
        wine(program_under_wine.arg(&program));
        program_under_wine
    })
}
