//! Distance fields, signed distances, winding numbers and Hausdorff distances of scenes.
//!
//! - **Fields** are distances at the points of a regular [`Grid`], or on an octree whose cells are small near the
//!   surface ([`refined`]). [`distances`] and [`signed_distances`] query an index for each point.
//!   [`distances_by_lists`] and [`signed_distances_by_lists`] need no index: they divide the grid into blocks and
//!   evaluate the few primitives that can be nearest in a block for all of its points at once ([`grid_candidates`]).
//!   Both ways return the same bits.
//! - **Offset surfaces** are the points at one distance from a scene, as closed triangle meshes ([`offset_surface`]).
//! - **Signs** tell inside from outside ([`sign`]): by winding numbers \[Jacobson2013\], which are exact for closed
//!   surfaces and certified for open ones \[Barill2018\], or by parity.
//! - **Solids** are closed scenes that count as filled in queries for pairs ([`solid`]).
//! - **Hausdorff distances** are the largest values of the distance field of one scene on another scene, between
//!   certified bounds ([`hausdorff_distance`]).
//! - **Alignment** finds the rotation and translation that bring the points of a scan onto a scene ([`align`]).
//! - **Samples** are random points on and around scenes, the same on every platform ([`sample`]).
//! - **Deviations** are the signed distances of the points of a scan, and [`deviation`] has their statistics.
//! - **Output**: [`write_field`] writes NPY, VTI or raw values, [`write_cells`] writes the cells of an octree, and
//!   [`slice()`] draws a layer of a grid.
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
//! // Candidate lists give the same field without an index, and much faster for fine grids.
//! use p2m_field::{CandidateLists, distances_by_lists};
//! let lists = CandidateLists::new(&ball).unwrap();
//! assert_eq!(distances_by_lists(&lists, &grid, &FieldOptions::default(), &|_| ()).unwrap(), field);
//! ```
//!
//! The feature `rayon` computes fields on all threads of the current pool.

#![forbid(unsafe_code)]

pub mod align;
mod by_lists;
mod by_queries;
pub mod deviation;
mod format;
mod grid;
pub mod grid_candidates;
mod hausdorff;
mod layers;
mod offset;
mod options;
mod refined;
pub mod sample;
pub mod sign;
mod slice;
pub mod solid;
mod write;

pub use by_lists::{distances_by_lists, signed_distances_by_lists};
pub use by_queries::{distances, signed_distances};
pub use format::FieldFormat;
pub use grid::{Grid, GridError};
pub use grid_candidates::CandidateLists;
pub use hausdorff::{
    Direction, HausdorffDistance, HausdorffIndex, HausdorffOptions, HausdorffProgress, ReportProgress,
    hausdorff_distance, one_sided_hausdorff_distance,
};
pub use offset::{MeasureDistance, OffsetError, OffsetSurface, offset_grid, offset_surface};
pub use options::FieldOptions;
pub use refined::{Cell, RefineOptions, refined};
pub use slice::slice;
pub use write::{write_cells, write_field};
