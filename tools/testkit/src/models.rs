//! The files of real meshes that tests read, if there is a folder of them.

use crate::depth::is_deep;
use std::path::{Path, PathBuf};

/// Returns the folder of real meshes: `P2M_MODELS`, by default `../shared/models` beside the workspace. Returns `None`,
/// with a message, if there is no such folder.
#[must_use]
pub fn models() -> Option<PathBuf> {
    let folder = std::env::var_os("P2M_MODELS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no models in {} (set P2M_MODELS to a folder of meshes)", folder.display());
    None
}

/// The size of the largest model that shallow tests use, in bytes.
const MAX_SHALLOW_MODEL_BYTES: u64 = 700_000;

/// Returns the files of the models, smallest first. The list is empty, with a message, if there is no folder of models.
///
/// Shallow tests leave out models of more than 700,000 bytes, with a message; `P2M_DEEP` includes all.
#[must_use]
pub fn model_files() -> Vec<PathBuf> {
    let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |m| m.len());
    let mut files = all_model_files();
    if !is_deep() {
        let count = files.len();
        files.retain(|path| size(path) <= MAX_SHALLOW_MODEL_BYTES);
        if files.len() < count {
            let left_out = count - files.len();
            eprintln!(
                "left out: {left_out} of {count} models, of more than {MAX_SHALLOW_MODEL_BYTES} bytes (P2M_DEEP=1 has them all)"
            );
        }
    }
    files
}

/// Returns the file of a model that a test lists by its name. Returns `None`, with a message, if there is no folder of
/// models. Shallow tests also get `None` if the model is missing or has more than 700,000 bytes.
///
/// # Panics
/// Panics in deep tests if there is a folder of models without this model.
#[must_use]
pub fn model_file(name: &str) -> Option<PathBuf> {
    let path = models()?.join(name);
    match std::fs::metadata(&path) {
        Ok(file) if is_deep() || file.len() <= MAX_SHALLOW_MODEL_BYTES => return Some(path),
        Ok(_) => eprintln!("left out: {name}, of more than {MAX_SHALLOW_MODEL_BYTES} bytes (P2M_DEEP=1 has it)"),
        Err(error) => assert!(!is_deep(), "{} is in a list of models: {error}", path.display()),
    }
    None
}

/// Returns the files of all models, smallest first, in shallow tests as well. The list is empty, with a message, if
/// there is no folder of models.
#[must_use]
pub fn all_model_files() -> Vec<PathBuf> {
    let Some(folder) = models() else { return Vec::new() };
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| ["obj", "ply", "stl", "off"].iter().any(|known| e == *known)))
        .collect();
    files.sort_by_key(|path| std::fs::metadata(path).map_or(0, |m| m.len()));
    files
}
