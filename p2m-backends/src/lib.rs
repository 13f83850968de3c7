//! The registry of backends: every index by its name, and the choice between them for a scene and a workload.
//!
//! [`BACKENDS`] lists every backend with what it can do. An entry builds and loads its index as one [`AnyIndex`], over
//! a scene that the index shares.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_backends::{BackendEntry, BuildSettings};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//! use std::sync::Arc;
//!
//! let ball = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
//! let backend = BackendEntry::find("octree").expect("a name of the registry");
//! let index = backend.build(ball, &BuildSettings::default())?.index;
//! assert!(index.closest_point(&Point3::new(0.0, 0.0, 3.0)).is_some());
//! # Ok::<(), p2m_core::BuildError>(())
//! ```
//!
//! [`Choice`] chooses the backend that takes the least time for a number of queries, and estimates the time and the
//! memory of all of them. It counts the work of some queries and measures no time.
#![forbid(unsafe_code)]

mod choice;
mod registry;

pub use choice::{Choice, Estimate, QueryRegion, Workload};
pub use p2m_core::AnyIndex;
pub use registry::{
    BACKENDS, BackendEntry, BuildSettings, BuiltIndex, ChosenDirections, Cost, KdopDirections, KdopVisitor,
    ListFilterKind, LocatorKind, P2mSettings, SearchStructure,
};
