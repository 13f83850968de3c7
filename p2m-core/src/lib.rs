//! The contract and the kernel of closest-point queries over triangles, segments and points.
//!
//! This crate owns the parts that all p2m backends share:
//!
//! - the accuracy contract, stated on [`ClosestPoint`], and the [`kernel`] that keeps it;
//! - the primitives, and the [`Soup`] that mixes them;
//! - the collector [`Best`], which alone decides the radius, ties, epsilon and the hint of a query;
//! - further queries: [`NearQuery`], [`BoxQuery`], [`RayQuery`] and [`CertifiedQuery`];
//! - exact [`predicates`], [`batch`]es of queries, and [`storage`] of indexes in files;
//! - [`BruteForce`], against which all indexes are tested.
//!
//! ```
//! use p2m_core::{BruteForce, ClosestPoint, Feature, Triangle};
//! use nalgebra::Point3;
//!
//! let scene = [Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 2.0, 0.0))];
//! let answer = BruteForce::new(&scene).unwrap().closest_point(&Point3::new(0.5, 0.25, 3.0)).unwrap();
//! assert_eq!(answer.point, Point3::new(0.5, 0.25, 0.0));
//! assert_eq!(answer.distance, 3.0);
//! assert_eq!(answer.feature, Feature::Face);
//! ```

//!
//! # The module `engine`
//!
//! The hidden module `engine` re-exports the internal items that the sibling crates of this project need, such as lanes
//! and double-double arithmetic. It is not part of the public API and may change in any release.

#![deny(unsafe_code)]

mod aabb;
mod any_index;
mod approx_impls;
pub mod batch;
mod box_query;
mod brute_force;
mod certified;
mod curve;
mod error;
mod exact;
mod format;
mod index;
pub mod kernel;
mod kind_set;
mod local_frame;
mod near_query;
pub mod pair;
mod parallel;
mod pointers;
mod position;
pub mod predicates;
mod primitive;
mod primitive_id;
#[macro_use]
mod query;
#[cfg(feature = "rayon")]
mod pools;
mod ray;
mod real;
mod set;
mod simd;
mod soup;
mod stats;
pub mod storage;
#[cfg(feature = "rayon")]
mod threads;
mod weld;

pub use aabb::Aabb;
pub use any_index::{AnyIndex, CellSummary, Refitted};
pub use box_query::BoxQuery;
pub use brute_force::BruteForce;
pub use certified::{CertifiedQuery, CertifyError, shape_of};
pub use error::BuildError;
#[doc(hidden)]
pub use format::npy_header;
pub use format::{UnknownExtension, UnknownFormat};
pub use index::{BuildIndex, ClosestPoint};
pub use kernel::Key;
pub use kind_set::{KindSet, PointSet, SegmentSet, TriangleSet};
pub use near_query::{Near, NearQuery};
pub use position::Position;
pub use primitive::{
    Feature, Point, Primitive, PrimitiveDefect, Projection, Segment, Shape, Triangle, check_primitive,
};
pub use primitive_id::PrimitiveId;
pub use query::{BatchAnswer, Best, Closest, Collector, QueryOptions};
pub use ray::{Crossing, Hit, Hits, Ray, RayCollector, RayError, RayHit, RayQuery, RayStatsCollector, Side};
pub use real::Real;
pub use set::{PrimitiveSet, check_set};
pub use simd::Isa;
pub use soup::{Element, Soup};
pub use stats::{IndexStats, ListStats, QueryCost, Stat};

/// Internal items for the sibling crates of this project. It is not part of the public API and may change
/// in any release.
#[doc(hidden)]
pub mod engine {
    pub use crate::index::answer_one_by_one;
    #[cfg(feature = "rayon")]
    pub use crate::threads::{MAX_THREADS, default_threads};

    /// Loops over all threads, compiled with one instance of the scheduler.
    pub mod parallel {
        pub use crate::parallel::*;
    }
    /// Thread pools that belong to one process.
    #[cfg(feature = "rayon")]
    pub mod pools {
        pub use crate::pools::*;
    }
    /// The search for near pairs of two trees.
    pub mod pairs {
        pub use crate::pair::search::*;
    }
    /// Orders along a Hilbert curve.
    pub mod curve {
        pub use crate::curve::*;
    }
    /// Double-double arithmetic.
    pub mod double_double {
        pub use crate::kernel::double_double::*;
    }
    /// Exact arithmetic with big integers.
    pub mod exact {
        pub use crate::exact::*;
    }
    /// Vector products in any arithmetic.
    pub mod arithmetic {
        pub use crate::kernel::arithmetic::*;
    }
    /// The collector for which searches are compiled.
    pub mod query {
        pub use crate::query::BestF64;
        pub use crate::query::answer::square_within;
    }
    /// Exact projection onto rays, and the margin of ray filters.
    pub mod ray {
        pub use crate::ray::{UNDERFLOW_MARGIN, project_onto_ray};
    }
    /// Conversion of points from and to f64.
    pub mod real {
        pub use crate::real::{from_f64_array, to_f64_array};
    }
    /// SIMD lanes and instruction sets.
    pub mod simd {
        pub use crate::simd::*;
    }
    /// Percentiles of sorted values.
    pub mod stats {
        pub use crate::stats::percentile;
    }
    /// Signs of determinants, computed with increasing precision.
    pub mod adaptive {
        pub use crate::predicates::adaptive::*;
    }
    /// Vectors of three f64.
    pub mod vector {
        pub use crate::kernel::vector::*;
    }
    /// Local frames of primitives.
    pub mod local_frame {
        pub use crate::local_frame::*;
    }
    /// Welding of vertices.
    pub mod weld {
        pub use crate::weld::*;
    }
    /// The kernel for eight primitives side by side.
    pub mod side_by_side {
        pub use crate::kernel::side_by_side::*;
    }
}
