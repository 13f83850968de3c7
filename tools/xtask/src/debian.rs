//! Packages of Debian, which give this machine compilers for others. They are unpacked below the target folder, and
//! nothing is installed.

use crate::promises::{numbers, promised_version};
use crate::{Outcome, absolute_target_folder, output, start};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder into which packages are unpacked.
pub(crate) struct Packages(PathBuf);

/// The architectures whose packages are found.
const ARCHITECTURES: [&str; 2] = ["amd64", "arm64"];

impl Packages {
    /// Unpacks the compiler rustc-web, which comes with the sources of its standard library.
    pub(crate) fn rust() -> Result<Self, String> {
        let packages = Self::open()?;
        packages.unpack("rust", || {
            // The names of two packages contain a version.
            let standard_library = packages.standard_library()?;
            let llvm = packages.dependency(&standard_library, "libllvm")?;
            let linker = llvm.replace("libllvm", "lld-");
            let names = ["rustc-web", "rust-web-src", "libstd-rust-web-dev", &standard_library, &llvm, &linker];
            Ok(names.map(str::to_owned).to_vec())
        })?;
        Ok(packages)
    }

    /// Unpacks that compiler, and a group of other packages. The name of a package may end with an architecture.
    pub(crate) fn rust_and(group: &str, names: &[&str]) -> Result<Self, String> {
        let packages = Self::rust()?;
        packages.unpack(group, || Ok(names.iter().copied().map(str::to_owned).collect()))?;
        Ok(packages)
    }

    fn open() -> Result<Self, String> {
        Ok(Self(absolute_target_folder()?.join("debian")))
    }

    /// Returns the path of an unpacked file.
    pub(crate) fn file(&self, path: &str) -> PathBuf {
        self.0.join(path)
    }

    /// Returns the folder with everything.
    pub(crate) fn folder(&self) -> &Path {
        &self.0
    }

    /// Lets a command of cargo use the unpacked compiler.
    pub(crate) fn set_compiler(&self, cargo: &mut Command) {
        cargo.env("RUSTC", self.file("usr/bin/rustc")).env("LD_LIBRARY_PATH", self.file("usr/lib/x86_64-linux-gnu"));
    }

    /// Lets a command of cargo compile these crates of the standard library, because the compiler comes without them.
    pub(crate) fn compile_standard_library(cargo: &mut Command, crates: &str) {
        // This is an unstable option, which the variable allows.
        cargo.arg(format!("-Zbuild-std={crates}")).env("RUSTC_BOOTSTRAP", "1");
    }

    /// Unpacks a group of packages, if that has not been done. An empty file then says so.
    fn unpack(&self, group: &str, names: impl Fn() -> Result<Vec<String>, String>) -> Outcome {
        let done = self.0.join(format!("{group}.unpacked"));
        if done.exists() {
            return Ok(());
        }
        if cfg!(not(all(target_os = "linux", target_arch = "x86_64"))) {
            return Err("packages of Debian are unpacked on x86-64 alone".to_owned());
        }
        let downloads = self.0.join(format!("{group}.part"));
        let failed = |error| format!("{}: {error}", downloads.display());
        if downloads.exists() {
            fs::remove_dir_all(&downloads).map_err(failed)?;
        }
        fs::create_dir_all(&downloads).map_err(failed)?;
        self.update()?;
        let names = names()?;
        start(self.apt("apt-get").args(["-qq", "download"]).args(names).current_dir(&downloads))?;
        for entry in fs::read_dir(&downloads).map_err(failed)? {
            let package = entry.map_err(failed)?.path();
            let [from, to] = [&package, &self.0].map(|path| path.to_string_lossy().into_owned());
            start(Command::new("dpkg").args(["-x", &from, &to]))?;
        }
        fs::remove_dir_all(&downloads).map_err(failed)?;
        fs::write(&done, "").map_err(|error| format!("{}: {error}", done.display()))
    }

    /// Returns a command of apt with lists of its own, in which packages of all architectures are found.
    fn apt(&self, program: &str) -> Command {
        let mut apt = Command::new(program);
        for architecture in ARCHITECTURES {
            apt.arg(format!("-oAPT::Architectures::={architecture}"));
        }
        apt.arg(format!("-oDir::State::Lists={}", self.0.join("lists").display()));
        apt.args(["-oDir::Cache::pkgcache=", "-oDir::Cache::srcpkgcache="]);
        // The user of apt may not be able to write here.
        apt.arg("-oAPT::Sandbox::User=root");
        apt
    }

    fn update(&self) -> Outcome {
        let partial = self.0.join("lists/partial");
        fs::create_dir_all(&partial).map_err(|error| format!("{}: {error}", partial.display()))?;
        start(self.apt("apt-get").args(["-qq", "update"]))
    }

    /// Returns the package of the standard library, whose compiler is new enough.
    fn standard_library(&self) -> Result<String, String> {
        let standard_library = self.dependency("libstd-rust-web-dev", "libstd-rust-web-")?;
        // The name of the standard library ends with the version of the compiler.
        let version = standard_library.trim_start_matches("libstd-rust-web-");
        if numbers(version) < numbers(&promised_version()?) {
            return Err(format!("the compiler of the package rustc-web has the version {version}, which is too old"));
        }
        Ok(standard_library)
    }

    /// Returns the package that a package depends on and whose name has a prefix.
    fn dependency(&self, package: &str, prefix: &str) -> Result<String, String> {
        let depends = self.apt("apt-cache").args(["depends", package]).output();
        let depends = depends.map_err(|error| format!("apt-cache: {error}"))?.stdout;
        let depends = String::from_utf8_lossy(&depends);
        let mut names = depends.lines().filter_map(|line| line.trim().strip_prefix("Depends: "));
        let name = names.find(|name| name.starts_with(prefix));
        name.map(str::to_owned).ok_or_else(|| format!("the package {package} depends on no {prefix}*"))
    }
}

/// Returns whether the current compiler has the standard library of a target.
pub(crate) fn has_standard_library(target: &str) -> bool {
    output("rustc", &["--print", "target-libdir", "--target", target])
        .is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}
