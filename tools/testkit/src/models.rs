//! The files of meshes that tests read: real ones, if there is a folder of them, and stand-ins for each of their kinds.

use crate::depth::{append, is_deep};
use crate::stand_ins;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Returns the folder of real meshes: `P2M_MODELS`, by default `../shared/models` beside the workspace. Returns `None`
/// if there is no such folder.
#[must_use]
pub fn models() -> Option<PathBuf> {
    let folder = std::env::var_os("P2M_MODELS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

/// Returns the folder of stand-ins, below the folder `target`. A program writes those that are missing or outdated.
fn stand_ins() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/stand-ins");
        let write = |name: &str, content: &[u8]| {
            if fs::read(folder.join(name)).is_ok_and(|found| found == content) {
                return Ok(());
            }
            fs::create_dir_all(&folder)?;
            // Tests in other processes may read the file.
            let new = folder.join(format!("{name}.{}", std::process::id()));
            fs::write(&new, content)?;
            fs::rename(&new, folder.join(name))
        };
        for (name, content) in stand_ins::files() {
            write(name, &content).unwrap_or_else(|error| panic!("{}: {error}", folder.join(name).display()));
        }
        folder
    })
}

/// The size of the largest model that shallow tests use, in bytes.
const MAX_SHALLOW_MODEL_BYTES: u64 = 700_000;

fn size(path: &PathBuf) -> u64 {
    fs::metadata(path).map_or(0, |m| m.len())
}

/// Returns the files of the models and of their stand-ins, smallest first.
///
/// Shallow tests leave out models of more than 700,000 bytes, with a message; `P2M_DEEP` includes all.
#[must_use]
pub fn model_files() -> Vec<PathBuf> {
    let mut files = all_model_files();
    let count = files.len();
    files.retain(|path| is_deep() || size(path) <= MAX_SHALLOW_MODEL_BYTES);
    if files.len() < count {
        let left_out = count - files.len();
        eprintln!(
            "left out: {left_out} of {count} models, of more than {MAX_SHALLOW_MODEL_BYTES} bytes (P2M_DEEP=1 has them all)"
        );
    }
    files
}

/// Returns the file of a model or stand-in that a test lists by its name. Returns `None` if there is no such file.
/// Shallow tests also get `None`, with a message, if it has more than 700,000 bytes.
///
/// # Panics
/// Panics in deep tests if there is a folder of models without this model.
#[must_use]
pub fn model_file(name: &str) -> Option<PathBuf> {
    let path = all_model_files().into_iter().find(|path| path.ends_with(name));
    assert!(path.is_some() || models().is_none() || !is_deep(), "{name} is in a list of models, and there is none");
    let path = path?;
    if !is_deep() && size(&path) > MAX_SHALLOW_MODEL_BYTES {
        eprintln!("left out: {name}, of more than {MAX_SHALLOW_MODEL_BYTES} bytes (P2M_DEEP=1 has it)");
        return None;
    }
    Some(path)
}

/// Returns the files of all models and of their stand-ins, smallest first, in shallow tests as well.
#[must_use]
pub fn all_model_files() -> Vec<PathBuf> {
    let folders = models().into_iter().chain([stand_ins().to_owned()]);
    let mut files: Vec<_> = folders
        .flat_map(|folder| fs::read_dir(folder).expect("the folder is there"))
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| ["obj", "ply", "stl", "off"].iter().any(|known| e == *known)))
        .collect();
    files.sort_by_key(size);
    files
}

/// Says why a test, or a part of it, is skipped, and appends that to the file that `P2M_SKIPS` names.
pub fn skip(why: &str) {
    eprintln!("skipped: {why}");
    append("P2M_SKIPS", &format!("a test: {why}\n"));
}
