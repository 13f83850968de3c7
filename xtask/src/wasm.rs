//! Checks the library for WebAssembly.
//!
//! The compiler is the current one if it has the standard library of the target. Else it is that of Debian, whose
//! packages are unpacked below the target folder: they contain the sources of the standard library, which cargo then
//! compiles. Nothing is installed on the machine, and where the packages are missing the task is skipped.

use crate::promises::{numbers, promised_version};
use crate::{Outcome, output, run, start};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";
/// All features of the facade that concern what is searched and how. Threads do not exist on the target.
const FEATURES: &str = "advisor,bvh,field,instances,interception,kdop,mixed,shards";

/// Checks the library, or says why it cannot be checked here.
pub(crate) fn check() -> Outcome {
    match Compiler::find()? {
        Ok(compiler) => {
            let library = ["check", "--locked", "--package", "p2m", "--no-default-features", "--features", FEATURES];
            start(&mut compiler.cargo(&library))
        }
        Err(why) => {
            println!("\n== skipped: there is no compiler for {TARGET} (rustup target add {TARGET}): {why}");
            Ok(())
        }
    }
}

/// A compiler for the target.
struct Compiler {
    /// The folder of the unpacked packages, unless the current compiler does it.
    packages: Option<PathBuf>,
    /// The folder for what is compiled.
    target: PathBuf,
}

impl Compiler {
    /// Returns a compiler, or within `Ok` the reason why there is none.
    fn find() -> Result<Result<Self, String>, String> {
        let target = PathBuf::from(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()));
        let target = std::path::absolute(&target).map_err(|error| format!("{}: {error}", target.display()))?;
        let libraries = output("rustc", &["--print", "target-libdir", "--target", TARGET]);
        if libraries.is_ok_and(|folder| Path::new(folder.trim()).is_dir()) {
            return Ok(Ok(Self { packages: None, target: target.join("wasm") }));
        }
        let packages = target.join("wasm-packages");
        Ok(unpack_packages(&packages).map(|()| Self { packages: Some(packages), target: target.join("wasm") }))
    }

    /// Returns a command of cargo for the target.
    fn cargo(&self, arguments: &[&str]) -> Command {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments).args(["--target", TARGET]).env("CARGO_TARGET_DIR", &self.target);
        if let Some(packages) = &self.packages {
            // To compile a standard library is an unstable option, which this variable allows.
            cargo.args(["-Zbuild-std=std,panic_abort"]).env("RUSTC_BOOTSTRAP", "1");
            cargo.env("RUSTC", compiler(packages)).env("LD_LIBRARY_PATH", libraries(packages));
        }
        cargo
    }
}

/// Unpacks the packages of Debian into a folder, if that has not been done.
fn unpack_packages(folder: &Path) -> Outcome {
    if compiler(folder).exists() {
        return Ok(());
    }
    if cfg!(not(all(target_os = "linux", target_arch = "x86_64"))) {
        return Err("packages of Debian are unpacked on x86-64 alone".to_owned());
    }
    if output("apt-cache", &["show", "rustc-web"]).is_err() {
        output("apt-get", &["update"])?;
    }
    // The names of two packages contain a version.
    let standard_library = dependency("libstd-rust-web-dev", "libstd-rust-web-")?;
    let llvm = dependency(&standard_library, "libllvm")?;
    let linker = llvm.replace("libllvm", "lld-");
    // The name of the standard library ends with the version of the compiler.
    let version = standard_library.trim_start_matches("libstd-rust-web-");
    if numbers(version) < numbers(&promised_version()?) {
        return Err(format!("the compiler of the package rustc-web has the version {version}, which is too old"));
    }
    let names = ["rustc-web", "rust-web-src", "libstd-rust-web-dev", &standard_library, &llvm, &linker];
    let unpacked = folder.with_extension("part");
    let failed = |error| format!("{}: {error}", unpacked.display());
    if unpacked.exists() {
        fs::remove_dir_all(&unpacked).map_err(failed)?;
    }
    fs::create_dir_all(&unpacked).map_err(failed)?;
    start(Command::new("apt-get").args(["-qq", "download"]).args(names).current_dir(&unpacked))?;
    for entry in fs::read_dir(&unpacked).map_err(failed)? {
        let package = entry.map_err(failed)?.path();
        let [from, to] = [&package, &unpacked].map(|path| path.to_string_lossy().into_owned());
        run("dpkg", &["-x", &from, &to], &[])?;
        fs::remove_file(&package).map_err(failed)?;
    }
    // The folder has its name only once it is complete.
    fs::rename(&unpacked, folder).map_err(failed)
}

/// Returns the package that a package depends on and whose name has a prefix.
fn dependency(package: &str, prefix: &str) -> Result<String, String> {
    let depends = output("apt-cache", &["depends", package])?;
    let mut names = depends.lines().filter_map(|line| line.trim().strip_prefix("Depends: "));
    let name = names.find(|name| name.starts_with(prefix));
    name.map(str::to_owned).ok_or_else(|| format!("the package {package} depends on no {prefix}*"))
}

fn compiler(packages: &Path) -> PathBuf {
    packages.join("usr/bin/rustc")
}

fn libraries(packages: &Path) -> PathBuf {
    packages.join("usr/lib/x86_64-linux-gnu")
}
