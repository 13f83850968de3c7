//! Checks the library for WebAssembly and its answers in Node, and builds the module of pages.
//!
//! The compiler is the current one if it has the standard library of the target. Else it is that of Debian, whose
//! packages contain the sources of the standard library, which cargo then compiles. Where the packages are missing the
//! task is skipped.

use crate::debian::{Packages, cargo_for, has_standard_library};
use crate::links::has_extension;
use crate::{OrSkip, Outcome, compare_or_write, entries, need, read, start, target, write};
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";
/// All features of the facade that concern what is searched and how. Threads do not exist on the target.
const FEATURES: &str = "p2m/backends,p2m/bvh,p2m/field,p2m/instances,p2m/interception,p2m/kdop,p2m/scene,p2m/shards";

/// The crates of the standard library, where the compiler comes without them.
const STANDARD_LIBRARY: &str = "std,panic_abort";
/// Vectors of 128 bits are part of every browser.
const VECTORS: &str = "-Ctarget-feature=+simd128";
/// Runs the checksums of answers. The path is relative to the crate of the test.
const RUNNER: &str = "node tests/checksums/node.mjs";

/// The crate of the module, the C interface.
const MODULE: &str = "p2m-c";
/// The name of its library.
const LIBRARY: &str = "p2m";
/// The folders of its sources.
const MODULE_SOURCES: [&str; 2] = ["bindings/c/src", "bindings/js/src"];
/// The module, which is part of the npm package, and of each page that answers queries.
const MODULE_FILE: &str = "apps/page/assets/p2m.wasm.zst";
/// A checksum of the sources of the module. Those of the library are not part of it, because its answers do not change:
/// the tests of pages in a browser compare the answers of the module with those of the program.
const STAMP_FILE: &str = "apps/page/assets/p2m.stamp";
/// Compresses the module, and fails if it is too large.
const PACK: &str = "bindings/js/pack.mjs";

/// Checks the library, or says why it cannot be checked here. With `--all` it also computes the checksums of answers, for
/// which everything is compiled. With `--build` it builds the module.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    let builds = arguments == ["--build"];
    if !builds {
        check_stamp()?;
    }
    // The packages with the compiler, unless the current compiler has the target.
    let packages = if has_standard_library(TARGET) { Ok(None) } else { Packages::rust().map(Some) };
    if builds {
        // To build nothing would be a failure.
        return build(packages?.as_ref());
    }
    let packages = packages.or_skip(&format!("there is no compiler for {TARGET} (rustup target add {TARGET})"))?;
    let check = format!("check --locked --package p2m --package {MODULE} --no-default-features --features {FEATURES}");
    start(&mut cargo(packages.as_ref(), &check, STANDARD_LIBRARY)?)?;
    if arguments == ["--all"] { compare_checksums(packages.as_ref()) } else { Ok(()) }
}

/// Computes the checksums of answers in Node, and compares them with those of other processors.
fn compare_checksums(packages: Option<&Packages>) -> Outcome {
    need("node")?;
    let mut cargo = cargo(packages, "test --locked --package p2m-testkit --test checksums", STANDARD_LIBRARY)?;
    start(cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", RUNNER).env("RUSTFLAGS", VECTORS))
}

/// Builds the module, and writes it and the checksum of its sources.
fn build(packages: Option<&Packages>) -> Outcome {
    let rustc = "rustc --locked --no-default-features --profile module --lib --crate-type cdylib --package";
    let mut cargo = cargo(packages, &format!("{rustc} {MODULE}"), "std")?;
    // Paths of this machine are not part of the module.
    let mut flags = VECTORS.to_owned();
    let workspace = std::env::current_dir().map_err(|error| format!("the current folder: {error}"))?;
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cargo")));
    for folder in [Some(&*workspace), home.as_deref(), packages.map(Packages::folder)].into_iter().flatten() {
        flags += &format!(" --remap-path-prefix={}=", folder.display());
    }
    if packages.is_some() {
        // The standard library is compiled as well, so that panics need no messages: they end the module in any case.
        flags += " -Zunstable-options -Cpanic=immediate-abort -Zlocation-detail=none";
        cargo.args(["-Zpanic-immediate-abort", "--config", "profile.module.panic='immediate-abort'"]);
    }
    start(cargo.env("RUSTFLAGS", flags))?;
    let built = target("wasm").join(TARGET).join("module").join(LIBRARY).with_extension("wasm");
    start(Command::new("node").arg(PACK).args([built.as_path(), Path::new(MODULE_FILE)]))?;
    write(STAMP_FILE, stamp()?)
}

/// Checks that the module was built of the sources of its crate.
fn check_stamp() -> Outcome {
    compare_or_write(STAMP_FILE, &stamp()?, "cargo xtask wasm --build", false)
}

/// Returns a checksum of the sources of the module, as text.
fn stamp() -> Result<String, String> {
    let mut files = MODULE_SOURCES.map(entries).into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    files.retain(|file| has_extension(file, "rs"));
    files.sort();
    // FNV-1a, which is enough to notice a change.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for file in files {
        // Lines end differently on other systems.
        for byte in read(&file)?.bytes().filter(|&byte| byte != b'\r') {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    Ok(format!("{hash:016x}\n"))
}

/// Returns a command of cargo for the target. The crates of the standard library are those that it compiles if the
/// compiler comes without them; panics that abort at once need no crate.
fn cargo(packages: Option<&Packages>, line: &str, standard_library: &str) -> Result<Command, String> {
    let mut cargo = cargo_for(TARGET, packages, standard_library, line);
    cargo.env("CARGO_TARGET_DIR", target("wasm"));
    if let Some(packages) = packages {
        let folder = packages.file("usr/bin");
        let is_linker =
            |path: &PathBuf| path.file_name().is_some_and(|n| n.display().to_string().starts_with("wasm-ld"));
        let linker = entries(&folder)?.into_iter().find(is_linker);
        let linker = linker.ok_or_else(|| format!("{}: has no wasm-ld", folder.display()))?;
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    }
    Ok(cargo)
}
