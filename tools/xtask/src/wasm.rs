//! Checks the library for WebAssembly and its answers in Node, and builds the module of pages.
//!
//! The compiler is the current one if it has the standard library of the target. Else it is that of Debian, whose
//! packages contain the sources of the standard library, which cargo then compiles. Where the packages are missing the
//! task is skipped.

use crate::debian::{Packages, has_standard_library};
use crate::{OrSkip, Outcome, Stop, compare_or_write, entries, need, read, start, target, write};
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
    let compiler = Compiler::find().or_skip(&format!("there is no compiler for {TARGET} (rustup target add {TARGET})"));
    if builds {
        // To build nothing would be a failure.
        return compiler
            .map_err(|(Stop::Skipped(why) | Stop::Failed(why))| Stop::Failed(why))
            .and_then(|it| build(&it));
    }
    let compiler = compiler?;
    let packages = ["check", "--locked", "--package", "p2m", "--package", MODULE, "--no-default-features"];
    start(compiler.cargo(&packages, STANDARD_LIBRARY)?.args(["--features", FEATURES]))?;
    if arguments == ["--all"] { compare_checksums(&compiler) } else { Ok(()) }
}

/// Computes the checksums of answers in Node, and compares them with those of other processors.
fn compare_checksums(compiler: &Compiler) -> Outcome {
    need("node")?;
    let arguments = ["test", "--locked", "--package", "p2m-testkit", "--test", "checksums"];
    let mut cargo = compiler.cargo(&arguments, STANDARD_LIBRARY)?;
    cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", RUNNER);
    start(cargo.env("RUSTFLAGS", VECTORS))
}

/// Builds the module, and writes it and the checksum of its sources.
fn build(compiler: &Compiler) -> Outcome {
    let package = ["rustc", "--locked", "--package", MODULE, "--no-default-features", "--profile", "module"];
    let mut cargo = compiler.cargo(&package, "std")?;
    cargo.args(["--lib", "--crate-type", "cdylib"]);
    // Paths of this machine are not part of the module.
    let mut flags = VECTORS.to_owned();
    let workspace = std::env::current_dir().map_err(|error| format!("the current folder: {error}"))?;
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cargo")));
    let packages = compiler.packages.as_ref().map(Packages::folder);
    for folder in [Some(workspace.as_path()), home.as_deref(), packages].into_iter().flatten() {
        flags += &format!(" --remap-path-prefix={}=", folder.display());
    }
    if compiler.packages.is_some() {
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
    let mut files = Vec::new();
    for folder in MODULE_SOURCES {
        files.extend(entries(folder)?);
    }
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rs"));
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

/// A compiler for the target.
struct Compiler {
    /// The packages with the compiler, unless the current compiler does it.
    packages: Option<Packages>,
}

impl Compiler {
    fn find() -> Result<Self, String> {
        let packages = if has_standard_library(TARGET) { None } else { Some(Packages::rust()?) };
        Ok(Self { packages })
    }

    /// Returns a command of cargo for the target. The crates of the standard library are those that it compiles if the
    /// compiler comes without them; panics that abort at once need no crate.
    fn cargo(&self, arguments: &[&str], standard_library: &str) -> Result<Command, String> {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments).args(["--target", TARGET]).env("CARGO_TARGET_DIR", target("wasm"));
        if let Some(packages) = &self.packages {
            packages.set_compiler(&mut cargo);
            Packages::compile_standard_library(&mut cargo, standard_library);
            let folder = packages.file("usr/bin");
            let is_linker =
                |path: &PathBuf| path.file_name().is_some_and(|n| n.display().to_string().starts_with("wasm-ld"));
            let linker = entries(&folder)?.into_iter().find(is_linker);
            let linker = linker.ok_or_else(|| format!("{}: has no wasm-ld", folder.display()))?;
            cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
        }
        Ok(cargo)
    }
}
