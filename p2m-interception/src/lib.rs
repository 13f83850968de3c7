//! Interception indexes: everything that can be nearest somewhere in a cell is found once and stored.
//!
//! # Theory
//!
//! A *partition* divides the domain of queries into convex cells. A few points of the scene
//! near a cell are its *dominators*: the distance to any of them is an upper bound of the answer for every query in the
//! cell, and a primitive that is farther than one dominator throughout the cell is left out of the list of the cell.
//! This *interception list* has every primitive that is nearest somewhere in the cell, and perhaps some more. A query
//! *locates* its cell and tests the list, without backtracking \[Zong2023\].
//!
//! The *corner test* decides which primitives are in a list. It compares distances at the corners of a cell only, and
//! holds for any convex cell ([docs/proofs/octree.md]). How cells are made and located is the task of the
//! [`Partition`]:
//!
//! - The [`Octree`] has cubes as cells. It is refined where a split saves the most time for its memory.
//! - The partition [`Voronoi`] has the Voronoi cells of the scene's vertices and of some added points
//!   ([docs/proofs/p2m.md]). A [`Locator`] returns a site near the query, and a walk over Delaunay neighbours ends at
//!   the nearest site. A [`ListFilter`] may shorten the search of long lists. The [`delaunay`] tetrahedra are exact.
//!   With the feature `paper`, `P2mOptions::as_in_paper` has the locator, the filter and the lists of the paper.
//!
//! Lists are stored in blocks: up to eight packets, the lanes of each packet that can be the answer, and lower bounds
//! on the distances to the packets.
//!
//! A tree over the same packets answers outside of the domain, in cells whose lists would be too long, and for queries
//! that want more than the nearest primitive, such as [`NearQuery`](p2m_core::NearQuery). An interception index takes
//! longer to build and more memory than this tree. Answers have the same bits as the answers of
//! [`BruteForce`](p2m_core::BruteForce).
//!
//! # Example
//!
//! ```
//! use p2m_interception::OctreeIndex;
//! use p2m_core::{ClosestPoint, Segment};
//! use nalgebra::Point3;
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 3.0, 0.0)),
//! ];
//! let index = OctreeIndex::new(&wires).unwrap();
//! let answer = index.closest_point(&Point3::new(1.0, 2.0, 0.0)).unwrap();
//! assert_eq!((answer.primitive.index(), answer.distance), (1, 1.0));
//! ```
//!
//! [docs/proofs/octree.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/octree.md
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

pub mod delaunay;
mod index;
mod list;
mod octree;
mod options;
mod parallel_chunks;
mod partition;
mod progress;
mod voronoi;

pub use index::{InterceptionIndex, OctreeIndex, P2mIndex};
pub use octree::Octree;
pub use options::{Domain, OctreeOptions, OctreeReport, P2mOptions, P2mReport, RefinementProgress};
pub use partition::Partition;
pub use progress::{BuildStage, Progress, StageTimes};
#[cfg(feature = "paper")]
pub use voronoi::kd_tree_locator::KdTreeLocator;
#[cfg(feature = "paper")]
pub use voronoi::region_tree::RegionTree;
pub use voronoi::{BuildListFilter, BuildLocator, ListFilter, Locator, LocatorSites, Region, Voronoi};
