//! `p2m-bench ray`: compares ray casting with parry, and redraws the ray figures in the manual of CGAL's k-DOP tree.
//!
//! Rays begin at the points of a query set and have directions that are evenly distributed on the sphere.

mod backend;
mod backends;
mod external;
pub(crate) mod manual;
mod measure;
pub(crate) mod versus;

pub(crate) use backends::ALL;
