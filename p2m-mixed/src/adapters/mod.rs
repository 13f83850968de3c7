//! Adapters for other crates: their trees as indexes, and shapes of parry as parts of a scene.
//!
//! A foreign tree finds candidates, and our kernel decides between them, so the indexes keep the contract of
//! [`ClosestPoint`](p2m_core::ClosestPoint). They exist for comparison and for programs that already use such a tree.
//! The indexes of this project are faster.

#[cfg(feature = "parry")]
mod parry;
#[cfg(feature = "rstar")]
mod rstar;
#[cfg(any(feature = "parry", feature = "parry-f32"))]
mod shapes;

#[cfg(feature = "parry")]
pub use parry::ParryIndex;
#[cfg(feature = "rstar")]
pub use rstar::RstarIndex;
#[cfg(any(feature = "parry", feature = "parry-f32"))]
pub use shapes::ShapeError;

#[cfg(any(feature = "parry", feature = "rstar"))]
/// The factor that makes a lower bound of the squared distance of a query from a box as other crates compute it, with
/// a few roundings.
const ROUND_DOWN: f64 = 1.0 - 16.0 * f64::EPSILON;
