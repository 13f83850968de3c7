//! Packages of Debian, which give this machine compilers for others. They are unpacked below the target folder, and
//! nothing is installed.

use crate::promises::{numbers, promised_version};
use crate::{command, entries, failed, output, target};
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
        let packages = Self(target("debian"));
        packages.unpack("rust", || {
            // The names of two packages contain a version.
            let standard_library = packages.standard_library()?;
            let llvm = packages.dependency(&standard_library, "libllvm")?;
            let linker = llvm.replace("libllvm", "lld-");
            Ok(format!("rustc-web rust-web-src libstd-rust-web-dev {standard_library} {llvm} {linker}"))
        })?;
        Ok(packages)
    }

    /// Unpacks that compiler, and a group of other packages. The name of a package may end with an architecture.
    pub(crate) fn rust_and(group: &str, names: &str) -> Result<Self, String> {
        let packages = Self::rust()?;
        packages.unpack(group, || Ok(names.to_owned()))?;
        Ok(packages)
    }

    /// Returns the path of an unpacked file.
    pub(crate) fn file(&self, path: &str) -> PathBuf {
        self.0.join(path)
    }

    /// Returns the folder with everything.
    pub(crate) fn folder(&self) -> &Path {
        &self.0
    }

    /// Unpacks a group of packages, if that has not been done. An empty file then says so.
    fn unpack(&self, group: &str, names: impl Fn() -> Result<String, String>) -> Result<(), String> {
        let done = self.0.join(format!("{group}.unpacked"));
        if done.exists() {
            return Ok(());
        }
        if cfg!(not(all(target_os = "linux", target_arch = "x86_64"))) {
            return Err("packages of Debian are unpacked on x86-64 alone".to_owned());
        }
        let downloads = self.0.join(format!("{group}.part"));
        for folder in [&downloads, &self.0.join("lists/partial")] {
            fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
        }
        output(self.apt("apt-get").args(["-qq", "update"]))?;
        println!("\n== apt-get download {}", names()?);
        output(self.apt("apt-get").args(["-qq", "download"]).args(names()?.split(' ')).current_dir(&downloads))?;
        for package in entries(&downloads)? {
            output(command("dpkg -x").arg(package).arg(&self.0))?;
        }
        fs::remove_dir_all(&downloads).and_then(|()| fs::write(&done, "")).map_err(|error| failed(&done, error))
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
        let depends = output(self.apt("apt-cache").args(["depends", package]))?;
        let mut names = depends.lines().filter_map(|line| line.trim().strip_prefix("Depends: "));
        let name = names.find(|name| name.starts_with(prefix));
        name.map(str::to_owned).ok_or_else(|| format!("the package {package} depends on no {prefix}*"))
    }
}

/// Returns whether the current compiler has the standard library of a target.
pub(crate) fn has_standard_library(target: &str) -> bool {
    output(&mut command(&format!("rustc --print target-libdir --target {target}")))
        .is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}

/// Returns a command of cargo for a target, with the compiler of the packages if they are needed. That compiles these
/// crates of the standard library if it comes without them.
pub(crate) fn cargo_for(target: &str, packages: Option<&Packages>, standard_library: &str, line: &str) -> Command {
    let mut cargo = command(&format!("cargo {line} --target {target}"));
    if let Some(packages) = packages {
        cargo.env("RUSTC", packages.file("usr/bin/rustc"));
        cargo.env("LD_LIBRARY_PATH", packages.file("usr/lib/x86_64-linux-gnu"));
        if !standard_library.is_empty() {
            // This is an unstable option, which the variable allows.
            cargo.arg(format!("-Zbuild-std={standard_library}")).env("RUSTC_BOOTSTRAP", "1");
        }
    }
    cargo
}
