//! Trees of other crates as indexes that keep our contract: they find candidates, our kernel decides. And shapes of
//! parry as parts of a scene.
//!
//! Trees are for programs that have such a tree at heart, and for comparison; the indexes of this project are faster.

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
/// What another crate computes for the squared distance of a query from a box is wrong by a few roundings; less by this
/// factor it is a lower bound.
const ROUND_DOWN: f64 = 1.0 - 16.0 * f64::EPSILON;
