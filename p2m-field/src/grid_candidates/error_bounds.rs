//! The constants of the error bound that the proof in the [module head](super) derives.

use p2m_core::engine::vector::power_of_two;

/// The error of a computed distance, as a multiple of the reach R: 2^-44.
pub(crate) const ERROR_PER_REACH: f64 = 1.0 / (1u64 << 44) as f64;
/// The distance from all edge lines from which on a point counts as inside of a triangle, as a multiple of R: 2^-46.
pub(crate) const INSIDE_MARGIN_PER_REACH: f64 = 1.0 / (1u64 << 46) as f64;
/// The error of a computed distance that underflow of squares adds: 2^-400.
pub(crate) const UNDERFLOW_ERROR: f64 = power_of_two(-400);
/// The largest magnitude of a coordinate, of the scene or of a box, for which candidate lists are defined: 2^250.
pub const MAX_COORDINATE: f64 = power_of_two(250);
