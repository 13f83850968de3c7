//! Packs the crates as for publishing, without a registry, and checks what is in their packages.

use crate::{
    Outcome, command, entries, fail_if_any, files_below, make_empty_folder, output, read, start, target, tools,
};
use std::fs;
use std::path::{Path, PathBuf};

/// Whoever depends on a crate downloads its package, so it has no room for reports and models.
const MAX_PACKAGE_BYTES: u64 = 1 << 20;
/// The crate whose package contains the script and the module of pages, which may have as many bytes again.
const WITH_ASSETS: &str = "p2m-page";
/// These licence texts have to be in each package, because both licences ask for it.
const LICENCE_TEXTS: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];
/// The registry shows these keys of a manifest, and finds crates by them.
const MANIFEST_KEYS: [&str; 8] =
    ["categories", "description", "documentation", "keywords", "license", "readme", "repository", "rust-version"];

/// Packs each crate that is published, unpacks it again and checks it, and checks the licences of dependencies.
pub(crate) fn run() -> Outcome {
    tools::deny()?;
    let published = published_crates()?;
    let target = target("packages");
    // A package that an earlier run has left, perhaps of another version, could be checked in place of the new one.
    make_empty_folder(&target)?;
    // Without verification nothing is compiled; all sources are compiled by the tests anyway.
    let mut package = command("cargo package --locked --offline --no-verify --allow-dirty --quiet --target-dir");
    start(package.arg(&target).args(published.iter().flat_map(|name| ["--package", name])))?;
    let packages = target.join("package");
    let mut failures = Vec::new();
    for name in &published {
        let unpacked = unpack(&packages, name)?;
        let bytes = files_below(&unpacked)?.iter().map(|file| fs::metadata(file).map_or(0, |file| file.len())).sum();
        println!("{name:<18} {:>5} KiB", u64::div_ceil(bytes, 1024));
        let limit = if name == WITH_ASSETS { 2 * MAX_PACKAGE_BYTES } else { MAX_PACKAGE_BYTES };
        failures.extend(faults(&unpacked, bytes, limit)?.into_iter().map(|fault| format!("{name}: {fault}")));
    }
    fail_if_any("packages are incomplete", &failures)
}

/// Returns the names of the crates of the workspace whose manifest does not rule out that they are published.
fn published_crates() -> Result<Vec<String>, String> {
    let mut names = Vec::new();
    let folders = [vec![".".into()], entries(".")?, entries("apps")?, entries("bindings")?].concat();
    for manifest in
        folders.iter().map(|folder: &PathBuf| folder.join("Cargo.toml")).filter(|manifest| manifest.is_file())
    {
        let text = read(&manifest)?;
        if text.lines().all(|line| line.trim() != "publish = false") {
            let name = text.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
            names.push(name.ok_or_else(|| format!("{}: has no name", manifest.display()))?.to_owned());
        }
    }
    names.sort();
    Ok(names)
}

/// Unpacks the package of a crate beside it, and returns the folder.
fn unpack(packages: &Path, name: &str) -> Result<PathBuf, String> {
    // The name of another crate may begin with this one, but its version does not.
    let is_package = |file: &str| {
        let version = file.strip_prefix(name).and_then(|rest| rest.strip_prefix('-'));
        version.is_some_and(|version| version.starts_with(|c: char| c.is_ascii_digit()) && version.ends_with(".crate"))
    };
    let is_file = |path: &PathBuf| path.file_name().is_some_and(|file| is_package(&file.to_string_lossy()));
    let path = entries(packages)?.into_iter().find(is_file).ok_or_else(|| format!("{name}: has no package"))?;
    output(command("tar -xzf").arg(&path).arg("-C").arg(packages))?;
    Ok(path.with_extension(""))
}

/// Returns what is wrong with the content of an unpacked package of so many bytes, of which `limit` are allowed.
fn faults(unpacked: &Path, bytes: u64, limit: u64) -> Result<Vec<String>, String> {
    let mut faults = Vec::new();
    for licence in LICENCE_TEXTS {
        // A text may be a link that was checked out as a file with the path in it, so that its content matters.
        if fs::read_to_string(unpacked.join(licence)).ok() != Some(read(licence)?) {
            faults.push(format!("{licence} is absent or differs from that of the workspace"));
        }
    }
    if fs::read_to_string(unpacked.join("README.md")).map_or(0, |text| text.trim().len()) == 0 {
        faults.push("README.md is absent or empty".to_owned());
    }
    // Cargo has put the keys that are inherited from the workspace into this manifest.
    let manifest = read(unpacked.join("Cargo.toml"))?;
    let package: Vec<&str> = manifest.lines().skip_while(|line| *line != "[package]").collect();
    for key in MANIFEST_KEYS {
        if !package.iter().any(|line| line.strip_prefix(key).is_some_and(|rest| rest.starts_with(" = "))) {
            faults.push(format!("its manifest has no {key}"));
        }
    }
    if bytes > limit {
        faults.push(format!("it has {bytes} bytes, more than the {limit} that are allowed"));
    }
    Ok(faults)
}
