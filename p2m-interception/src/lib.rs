//! Interception indexes: what can be nearest anywhere in a cell is found once and kept.
//!
//! A query locates its cell and tests a short list: it neither searches nor turns back . Where
//! lists would be long, outside of the domain of cells, and for [`NearQuery`](p2m_core::NearQuery) a tree over the same
//! primitives answers. That takes longer to build and more memory than a tree. Answers are bitwise those of
//! [`BruteForce`](p2m_core::BruteForce).
//!
//! ```
//! use p2m_interception::OctreeIndex;
//! use p2m_core::{BuildIndex, ClosestPoint, Segment};
//! use nalgebra::Point3;
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 3.0, 0.0)),
//! ];
//! let index = OctreeIndex::build(&wires, &Default::default()).unwrap();
//! let answer = index.closest_point(&Point3::new(1.0, 2.0, 0.0)).unwrap();
//! assert_eq!((answer.primitive.index(), answer.distance), (1, 1.0));
//! ```
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
pub use options::{Domain, OctreeOptions, OctreeReport, P2mOptions, P2mReport};
pub use partition::{Partition, SIDE_BY_SIDE};
pub use progress::{BuildStage, Progress, StageTimes};
#[cfg(feature = "kiddo")]
pub use voronoi::kd_tree_locator::KdTreeLocator;
#[cfg(feature = "rstar")]
pub use voronoi::region_tree::RegionTree;
pub use voronoi::{BuildListFilter, BuildLocator, ListFilter, Locator, LocatorSites, Region, Voronoi};
