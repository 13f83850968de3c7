//! Trees of other crates as indexes.
//!
//! A foreign tree finds candidates, and our kernel decides between them, so the indexes keep the contract of
//! [`ClosestPoint`](p2m_core::ClosestPoint). They exist for comparison. The indexes of this project are faster.

#[cfg(feature = "parry")]
mod parry;
#[cfg(feature = "rstar")]
mod rstar;
#[cfg(all(test, feature = "parry", feature = "rstar"))]
mod tests;

#[cfg(feature = "parry")]
pub use parry::ParryIndex;
#[cfg(feature = "rstar")]
pub use rstar::RstarIndex;

/// The factor that makes a lower bound of the squared distance of a query from a box as other crates compute it, with
/// a few roundings.
#[cfg(any(feature = "parry", feature = "rstar"))]
const ROUND_DOWN: f64 = 1.0 - 16.0 * f64::EPSILON;
