//! Checks the library for WebAssembly, and builds the module of pages.
//!
//! The compiler is the current one if it has the standard library of the target. Else it is that of Debian, whose
//! packages are unpacked below the target folder: they contain the sources of the standard library, which cargo then
//! compiles. Nothing is installed on the machine, and where the packages are missing the task is skipped.

use crate::promises::{numbers, promised_version};
use crate::{Outcome, absolute_target_folder, output, start};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";
/// All features of the facade that concern what is searched and how. Threads do not exist on the target.
const FEATURES: &str = "p2m/backends,p2m/bvh,p2m/field,p2m/instances,p2m/interception,p2m/kdop,p2m/scene,p2m/shards";

/// The crate of the module, and the sources that give its functions to the script of pages.
const MODULE: &str = "p2m-live";
/// The folder of its sources.
const MODULE_SOURCES: &str = "apps/page/live/src";
/// The module, which is part of each page that answers queries.
const MODULE_FILE: &str = "apps/page/assets/live.wasm";
/// A checksum of the sources of the module. Those of the library are not part of it, because its answers do not change:
/// the tests of pages in a browser compare the answers of the module with those of the program.
const STAMP_FILE: &str = "apps/page/assets/live.stamp";
/// The module is in each page, and in the package of p2m-page.
const MAX_MODULE_BYTES: u64 = 1 << 20;

/// Checks the library, or says why it cannot be checked here. With `--build` it builds the module.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    let builds = match arguments {
        [] => false,
        [argument] if argument == "--build" => true,
        _ => return Err("the only argument of this task is --build".to_owned()),
    };
    if !builds {
        check_stamp()?;
    }
    match Compiler::find()? {
        Ok(compiler) if builds => build(&compiler),
        Ok(compiler) => {
            let packages = ["check", "--locked", "--package", "p2m", "--package", MODULE, "--no-default-features"];
            start(compiler.cargo(&packages, "std,panic_abort").args(["--features", FEATURES]))
        }
        Err(why) => {
            let message = format!("there is no compiler for {TARGET} (rustup target add {TARGET}): {why}");
            if builds {
                return Err(message);
            }
            crate::skip(&message)
        }
    }
}

/// Builds the module, and writes it and the checksum of its sources.
fn build(compiler: &Compiler) -> Outcome {
    let mut cargo = compiler.cargo(&["build", "--locked", "--package", MODULE, "--profile", "module"], "std");
    // Paths of this machine are not part of the module, and vectors of 128 bits are part of every browser.
    let mut flags = "-Ctarget-feature=+simd128".to_owned();
    let workspace = std::env::current_dir().map_err(|error| format!("the current folder: {error}"))?;
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cargo")));
    for folder in [Some(&workspace), home.as_ref(), compiler.packages.as_ref()].into_iter().flatten() {
        flags += &format!(" --remap-path-prefix={}=", folder.display());
    }
    if let Some(packages) = &compiler.packages {
        // The standard library is compiled as well, so that panics need no messages: they end the module in any case.
        flags += " -Zunstable-options -Cpanic=immediate-abort -Zlocation-detail=none";
        cargo.args(["-Zpanic-immediate-abort", "--config", "profile.module.panic='immediate-abort'"]);
        let folder = packages.join("usr/bin");
        let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let is_linker = |path: &PathBuf| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with("wasm-ld"));
        let linker = paths.find(is_linker).ok_or_else(|| format!("{}: has no wasm-ld", folder.display()))?;
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    }
    start(cargo.env("RUSTFLAGS", flags))?;
    let built = compiler.target.join(TARGET).join("module").join(MODULE.replace('-', "_")).with_extension("wasm");
    let bytes = fs::metadata(&built).map_err(|error| format!("{}: {error}", built.display()))?.len();
    println!("{MODULE_FILE}: {bytes} bytes");
    if bytes > MAX_MODULE_BYTES {
        return Err(format!("the module has more than the {MAX_MODULE_BYTES} bytes that are allowed"));
    }
    fs::copy(&built, MODULE_FILE).map_err(|error| format!("{MODULE_FILE}: {error}"))?;
    fs::write(STAMP_FILE, stamp()?).map_err(|error| format!("{STAMP_FILE}: {error}"))
}

/// Checks that the module was built of the sources of its crate.
fn check_stamp() -> Outcome {
    let written = fs::read_to_string(STAMP_FILE).map_err(|error| format!("{STAMP_FILE}: {error}"))?;
    if written == stamp()? {
        return Ok(());
    }
    Err(format!("{MODULE_FILE} was built of other sources than those of {MODULE}: run `cargo xtask wasm --build`"))
}

/// Returns a checksum of the sources of the module, as text.
fn stamp() -> Result<String, String> {
    let folder = Path::new(MODULE_SOURCES);
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    // FNV-1a, which is enough to notice a change.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for file in files {
        let text = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        // Lines end differently on other systems.
        for byte in text.bytes().filter(|&byte| byte != b'\r') {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    Ok(format!("{hash:016x}\n"))
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
        let target = absolute_target_folder()?;
        let libraries = output("rustc", &["--print", "target-libdir", "--target", TARGET]);
        if libraries.is_ok_and(|folder| Path::new(folder.trim()).is_dir()) {
            return Ok(Ok(Self { packages: None, target: target.join("wasm") }));
        }
        let packages = target.join("wasm-packages");
        Ok(unpack_packages(&packages).map(|()| Self { packages: Some(packages), target: target.join("wasm") }))
    }

    /// Returns a command of cargo for the target. The crates of the standard library are those that it compiles if the
    /// compiler comes without them; panics that abort at once need no crate.
    fn cargo(&self, arguments: &[&str], standard_library: &str) -> Command {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments).args(["--target", TARGET]).env("CARGO_TARGET_DIR", &self.target);
        if let Some(packages) = &self.packages {
            // To compile a standard library is an unstable option, which this variable allows.
            cargo.arg(format!("-Zbuild-std={standard_library}")).env("RUSTC_BOOTSTRAP", "1");
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
    // The list of packages may be missing, or so old that it has an older compiler.
    let standard_library = find_standard_library().or_else(|_| {
        output("apt-get", &["update"])?;
        find_standard_library()
    })?;
    // The names of two packages contain a version.
    let llvm = dependency(&standard_library, "libllvm")?;
    let linker = llvm.replace("libllvm", "lld-");
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
        start(Command::new("dpkg").args(["-x", &from, &to]))?;
        fs::remove_file(&package).map_err(failed)?;
    }
    // The folder has its name only once it is complete.
    fs::rename(&unpacked, folder).map_err(failed)
}

/// Returns the package of the standard library, whose compiler is new enough.
fn find_standard_library() -> Result<String, String> {
    let standard_library = dependency("libstd-rust-web-dev", "libstd-rust-web-")?;
    // The name of the standard library ends with the version of the compiler.
    let version = standard_library.trim_start_matches("libstd-rust-web-");
    if numbers(version) < numbers(&promised_version()?) {
        return Err(format!("the compiler of the package rustc-web has the version {version}, which is too old"));
    }
    Ok(standard_library)
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
