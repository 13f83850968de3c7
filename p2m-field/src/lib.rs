//! Distance fields: the distance at every point of a grid, or of an octree that is fine where the surface is.
//!
//! ```
//! use p2m_core::BruteForce;
//! use p2m_field::{FieldOptions, Grid, distances};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//!
//! let ball = ico_sphere(&IcoSphere::default()).unwrap();
//! let grid = Grid::around(&p2m_core::PrimitiveSet::aabb(&ball), 9, 1.25).unwrap();
//! let field = distances(&BruteForce::new(&ball).unwrap(), &grid, &FieldOptions::default(), &|_| ()).unwrap();
//! assert_eq!(field.len(), 9 * 9 * 9);
//! assert!((field[grid.number([4, 4, 4])] - 1.0).abs() < 0.02); // the centre
//!
//! // The same without an index, and much faster for fine grids.
//! use p2m_field::{CandidateLists, distances_by_lists};
//! let lists = CandidateLists::new(&ball).unwrap();
//! assert_eq!(distances_by_lists(&lists, &grid, &FieldOptions::default(), &|_| ()).unwrap(), field);
//! ```

#![forbid(unsafe_code)]

mod dense;
mod format;
mod grid;
pub mod grid_candidates;
mod layers;
mod listed;
mod refined;
pub mod sign;
mod slice;
mod write;

pub use dense::{FieldOptions, distances, signed_distances};
pub use format::FieldFormat;
pub use grid::{Grid, GridError};
pub use grid_candidates::CandidateLists;
pub use listed::{distances_by_lists, signed_distances_by_lists};
pub use refined::{Cell, RefineOptions, refined};
pub use slice::slice;
pub use write::{write_cells, write_field};
