//! Interception indexes: what can be nearest anywhere in a cell is found once and kept.
//!
//! A query locates its cell and tests a short list: it neither searches nor turns back ([`p2m_core::interception`]). Where
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

mod index;
#[cfg(feature = "kiddo")]
mod kd_tree;
#[cfg(feature = "rstar")]
mod region_tree;

pub use index::{InterceptionIndex, OctreeIndex, P2mIndex};
#[cfg(feature = "kiddo")]
pub use kd_tree::KdTreeLocator;
pub use p2m_core::interception::{
    BuildListFilter, BuildLocator, Domain, ListFilter, Locator, LocatorSites, Octree, OctreeOptions, OctreeReport,
    P2mOptions, P2mReport, Partition, Progress, Region, Stage, Voronoi,
};
#[cfg(feature = "rstar")]
pub use region_tree::RegionTree;
