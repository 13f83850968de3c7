//! The test kit of p2m: distances in exact rational arithmetic, families of hard cases, and random scenes.
//!
//! The crate is not published. All random numbers come from a seed that a failing test prints.
#![forbid(unsafe_code)]
#![allow(clippy::missing_panics_doc, reason = "a test kit panics where a test should fail")]

pub mod adversaries;
pub mod ball;
mod checksum;
pub mod compiled;
pub mod contract;
#[cfg(feature = "counted")]
pub mod counted_queries;
pub mod depth;
pub mod enclosure;
pub mod extremes;
pub mod families;
mod integers;
mod line_and_primitive;
pub mod line_filter;
mod models;
pub mod near_check;
pub mod oracle;
mod point_file;
pub mod queries;
mod ratio;
pub mod ray_check;
pub mod ray_oracle;
pub mod rays;
pub mod saved_file;
pub mod scenes;
mod stand_ins;
mod surface;
mod thin_scenes;
pub mod truth;

use chacha20::ChaCha8Rng;
pub use checksum::restore_e57_checksums;
pub use depth::{Cases, amount, cases, depth, is_deep};
pub use models::{all_model_files, model_file, model_files, models, skip};
use nalgebra::Vector3;
pub use point_file::point_file;
use rand::{Rng, RngExt, SeedableRng};
pub use surface::normal as normal_number;
pub use thin_scenes::thin_scenes;

/// Returns the random number generator of case number `case` of the test `name`. Cases do not depend on each other or
/// on their order.
#[must_use]
pub fn rng(name: &str, case: u64) -> ChaCha8Rng {
    // The FNV-1a hash of the name makes the numbers of tests with the same case number different.
    let name = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&name.to_le_bytes());
    seed[8..16].copy_from_slice(&case.to_le_bytes());
    ChaCha8Rng::from_seed(seed)
}

/// Returns a random vector of the cube from -1 to 1.
pub fn vector(rng: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0))
}
