//! Trees of other crates as indexes that keep our contract: they find candidates, our kernel decides.
//!
//! For programs that have such a tree at heart, and for comparison; the indexes of this project are faster.

#[cfg(feature = "parry")]
mod parry;
#[cfg(feature = "rstar")]
mod rstar;

#[cfg(feature = "parry")]
pub use parry::ParryIndex;
#[cfg(feature = "rstar")]
pub use rstar::RstarIndex;

/// What another crate computes for the squared distance of a query from a box is wrong by a few roundings; less by this
/// factor it is a lower bound.
const ROUND_DOWN: f64 = 1.0 - 16.0 * f64::EPSILON;
