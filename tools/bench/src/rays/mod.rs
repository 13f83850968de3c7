//! `p2m-bench ray`: compares ray casting with parry.
//!
//! Rays begin at the points of a query set and have directions that are evenly distributed on the sphere.

mod backend;
mod backends;
mod external;
mod measure;
pub(crate) mod versus;

pub(crate) use backends::ALL;
