//! Delaunay tetrahedra of points, exact for all finite input.
//!
//! The points are enclosed by an octahedron of six bounding sites. These are so far away that the Voronoi cells of the
//! points are bounded, and that none of the six is the nearest site of queries in a box of known size. Exact
//! predicates decide all signs in stages ([`p2m_core::predicates`]). No point is perturbed: points may be cospherical,
//! coplanar, collinear or equal.
//!
//! Points are scaled and sorted along a Hilbert curve (`scale`), ordered in rounds (`order`) and inserted one by one
//! (`insert`, `link`). Finally the tetrahedra are sorted (`compact`). `check` verifies a triangulation.
//!
//! ```
//! use p2m_interception::delaunay::{BOUNDING, Delaunay};
//!
//! let corners: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
//! let delaunay = Delaunay::new(&corners, 22.78)?;
//! assert_eq!(delaunay.sites().len(), BOUNDING + 8);
//! assert!(delaunay.check().is_ok());
//! let within = |t: &&[u32; 4]| t.iter().all(|&v| v as usize >= BOUNDING);
//! // A cube is cut into five or six.
//! assert!([5, 6].contains(&delaunay.tetrahedra().iter().filter(within).count()));
//! # Ok::<(), p2m_interception::delaunay::DelaunayError>(())
//! ```

mod check;
mod compact;
mod insert;
mod link;
mod order;
mod scale;
mod tetrahedron;
mod triangulation;

pub use check::Invalid;
pub(crate) use scale::ScaledSites;
pub use tetrahedron::{BOUNDING, Work};
pub use triangulation::{Delaunay, DelaunayError};

#[cfg(test)]
mod tests;
