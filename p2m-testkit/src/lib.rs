//! What the tests hold p2m against: distances in exact rational arithmetic, families of hard cases, random scenes.
//!
//! Not published. Everything random comes from a seed that a failing test prints.
#![forbid(unsafe_code)]
#![allow(clippy::missing_panics_doc, reason = "a test kit panics where a test should fail")]

pub mod adversaries;
pub mod asking;
pub mod ball;
pub mod compiled;
pub mod contract;
pub mod depth;
pub mod enclosure;
pub mod extremes;
pub mod families;
pub mod left_first;
pub mod line_filter;
pub mod near_check;
pub mod oracle;
pub mod paper;
pub mod queries;
pub mod ray_check;
pub mod ray_oracle;
pub mod rays;
pub mod scenes;
mod surface;
pub mod truth;

pub use depth::{Cases, amount, cases, depth, is_deep};
use nalgebra::Vector3;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The generator of case number `case` of the test `name`: cases are independent of each other and of their order.
#[must_use]
pub fn rng(name: &str, case: u64) -> ChaCha8Rng {
    // FNV-1a, so that two tests with the same case number draw different numbers.
    let name = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&name.to_le_bytes());
    seed[8..16].copy_from_slice(&case.to_le_bytes());
    ChaCha8Rng::from_seed(seed)
}

/// A vector of the cube from -1 to 1.
pub fn vector(rng: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0))
}

/// The folder of real meshes: `P2M_MODELS`, by default `../shared/models` beside the workspace. `None`, with a message,
/// where there is none.
#[must_use]
pub fn models() -> Option<std::path::PathBuf> {
    let folder = std::env::var_os("P2M_MODELS").map_or_else(
        || std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/models"),
        std::path::PathBuf::from,
    );
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no models in {} (set P2M_MODELS to a folder of meshes)", folder.display());
    None
}

/// The most bytes of a model that tests look at where they are not deep.
const SMALL: u64 = 700_000;

/// The files of the models, smallest first; none, with a message, where there is no folder of them.
///
/// Only with `P2M_DEEP` are all of them there. Otherwise those of more than 700,000 bytes are left out, with a message.
#[must_use]
pub fn model_files() -> Vec<std::path::PathBuf> {
    let size = |path: &std::path::PathBuf| std::fs::metadata(path).map_or(0, |m| m.len());
    let mut files = all_model_files();
    if !is_deep() {
        let count = files.len();
        files.retain(|path| size(path) <= SMALL);
        if files.len() < count {
            let left_out = count - files.len();
            eprintln!("left out: {left_out} of {count} models, of more than {SMALL} bytes (P2M_DEEP=1 has them all)");
        }
    }
    files
}

/// The file of a model that a test lists by its name; none, with a message, where there is no folder of models. Where tests are
/// not deep, none as well if it is missing or has more than 700,000 bytes.
///
/// # Panics
/// If tests are deep and there is a folder of models without this one.
#[must_use]
pub fn model_file(name: &str) -> Option<std::path::PathBuf> {
    let path = models()?.join(name);
    match std::fs::metadata(&path) {
        Ok(file) if is_deep() || file.len() <= SMALL => return Some(path),
        Ok(_) => eprintln!("left out: {name}, of more than {SMALL} bytes (P2M_DEEP=1 has it)"),
        Err(error) => assert!(!is_deep(), "{} is in a list of models: {error}", path.display()),
    }
    None
}

/// The files of all models, smallest first, at any depth; none, with a message, where there is no folder of them.
#[must_use]
pub fn all_model_files() -> Vec<std::path::PathBuf> {
    let Some(folder) = models() else { return Vec::new() };
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| ["obj", "ply", "stl", "off"].iter().any(|known| e == *known)))
        .collect();
    files.sort_by_key(|path| std::fs::metadata(path).map_or(0, |m| m.len()));
    files
}
