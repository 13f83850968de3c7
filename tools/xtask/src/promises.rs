//! Checks the promises that the manifests make to users of p2m.

use crate::{Outcome, builds, command, output, read, run, tools};

/// Checks lock files, versions of Rust and the numbers of crates of builds; with `--all` also that the crates compile with
/// each of their features alone, and that the builds that `p2m info` names work.
pub(crate) fn check(arguments: &[String]) -> Outcome {
    // Both lock files belong to their manifests.
    for manifest in ["Cargo.toml", "tools/fuzz/Cargo.toml"] {
        output(command("cargo metadata --locked --format-version 1 --manifest-path").arg(manifest))?;
    }
    check_rust_version()?;
    builds::check_crates()?;
    if arguments != ["--all"] {
        return Ok(());
    }
    builds::run_programs()?;
    // Without its features the program has no parts of the paper.
    tools::each_feature("--package p2m --package p2m-mixed --package p2m-cli")
}

/// Checks that the promised version of Rust compiles all of the source, and that no dependency needs a newer one.
///
/// Only a compiler of that version can tell what the source needs: lints know the versions of functions, but not those
/// of the language.
fn check_rust_version() -> Outcome {
    let promised = promised_version()?;
    let promised = promised.as_str();
    if !read("README.md")?.contains(&format!("Rust ({promised} or newer)")) {
        return Err(format!("README.md does not say that Rust {promised} is needed").into());
    }
    let metadata = output(&mut command("cargo metadata --locked --format-version 1"))?;
    for needed in metadata.split("\"rust_version\":\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        if numbers(needed) > numbers(promised) {
            return Err(format!("a dependency needs Rust {needed}, but {promised} is promised").into());
        }
    }
    // The promised compiler is the current one, or rustup has it.
    let current = output(&mut command("rustc --version"))?;
    let is_promised = |version: &str| version.split(' ').nth(1).is_some_and(|v| v.starts_with(&format!("{promised}.")));
    if is_promised(&current) {
        println!("Rust {promised} is promised, and compiles all of this");
        return Ok(());
    }
    for toolchain in [format!("+{promised}"), format!("+{promised}.0")] {
        if output(&mut command(&format!("rustc {toolchain} --version"))).is_ok_and(|version| is_promised(&version)) {
            return run(&format!("cargo {toolchain} check --locked --package p2m --package p2m-cli"));
        }
    }
    Err(format!("Rust {promised} is promised, but is not installed, so nothing can check the promise").into())
}

/// Returns the version of Rust that the manifest of the workspace promises.
pub(crate) fn promised_version() -> Result<String, String> {
    let manifest = read("Cargo.toml")?;
    let mut lines = manifest.lines();
    let version = lines.find_map(|line| line.strip_prefix("rust-version = \"")?.strip_suffix('"'));
    version.map(str::to_owned).ok_or_else(|| "Cargo.toml promises no version of Rust".to_owned())
}

/// Returns the numbers of a version.
pub(crate) fn numbers(version: &str) -> Vec<u32> {
    let mut numbers: Vec<u32> = version.split('.').map_while(|number| number.parse().ok()).collect();
    numbers.resize(3, 0);
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_their_numbers() {
        assert!(numbers("1.95") > numbers("1.90.1") && numbers("1.9") < numbers("1.10"));
        assert_eq!(numbers("1.95"), numbers("1.95.0"));
    }
}
