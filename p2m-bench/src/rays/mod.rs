//! `p2m-bench ray`: rays against parry, and the figures of rays in the manual of CGAL's k-DOP tree, redrawn.
//!
//! Rays begin at a query set and go in directions that are evenly distributed on the sphere.

mod backends;
mod caster;
pub(crate) mod manual;
mod measure;
mod rivals;
pub(crate) mod versus;

pub(crate) use backends::ALL;
