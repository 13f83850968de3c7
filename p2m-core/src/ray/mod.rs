//! Ray casting: the primitives that a ray hits, and their parameters.
//!
//! Pass a [`Ray`] to an index by [`RayQuery`]. Whether it hits a primitive is decided without rounding, and the
//! parameter of a hit is the exact one rounded to the nearest f64. So all backends return the same bits, and the first
//! hit has the least parameter.

#![allow(clippy::float_cmp, reason = "nothing here has a tolerance")]

mod collector;
mod crossing;
mod exact;
mod hit;
mod line;
mod plane;
mod query;
mod rounding;
mod stats_collector;

pub use collector::{Hits, RayCollector};
pub use crossing::Crossing;
pub use exact::project_onto_ray;
pub use hit::{Hit, RayHit, Side};
pub use line::{Ray, RayError};
pub use query::RayQuery;
pub use rounding::UNDERFLOW_MARGIN;
pub use stats_collector::RayStatsCollector;
