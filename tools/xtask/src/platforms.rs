//! Checks that the library and the program compile for platforms whose programs this machine does not run.
//!
//! A target is checked by the current compiler if it has the standard library, else by that of Debian, which compiles the
//! standard library as well.

use crate::debian::{Packages, has_standard_library};
use crate::{Outcome, absolute_target_folder, start};
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
const WINDOWS_PACKAGES: [&str; 1] = ["binutils-mingw-w64-x86-64"];

/// Checks some targets, or all.
pub(crate) fn check(arguments: &[String]) -> Outcome {
    let all = TARGETS.map(str::to_owned);
    for target in if arguments.is_empty() { &all[..] } else { arguments } {
        let mut cargo = Command::new("cargo");
        cargo.args(["check", "--locked", "--package", "p2m", "--package", "p2m-cli", "--target", target]);
        if !has_standard_library(target) {
            let packages = match Packages::rust_and("windows", &WINDOWS_PACKAGES) {
                Ok(packages) => packages,
                Err(why) => {
                    crate::skip(&format!(
                        "there is no standard library of {target} (rustup target add {target}): {why}"
                    ))?;
                    continue;
                }
            };
            packages.set_compiler(&mut cargo);
            Packages::compile_standard_library(&mut cargo, "std");
            let path = std::env::var_os("PATH").unwrap_or_default();
            let folders = std::env::split_paths(&path).chain([packages.file("usr/bin")]);
            cargo.env("PATH", std::env::join_paths(folders).map_err(|error| format!("PATH: {error}"))?);
            cargo.env("CARGO_TARGET_DIR", absolute_target_folder()?.join("platforms"));
        }
        start(&mut cargo)?;
    }
    Ok(())
}
