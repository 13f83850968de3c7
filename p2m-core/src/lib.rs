//! Closest points of scenes made of triangles, segments and points.
//!
//! This crate holds what every p2m backend shares: the accuracy contract (stated on [`ClosestPoint`]),
//! the kernel that keeps it ([`kernel`]), the primitives, the [`Soup`] that mixes them, the running best
//! ([`Best`]) that decides radius, ties, epsilon and hint in one place, the plain [`BruteForce`] oracle and
//! the [`hierarchy`] that trees are made of.
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

#![deny(unsafe_code)]

mod aabb;
mod approx_impls;
pub mod batch;
mod box_query;
mod brute_force;
mod certified;
mod curve;
mod error;
mod exact;
mod index;
mod indexed;
pub mod kernel;
mod near_query;
pub mod predicates;
mod primitive;
#[macro_use]
mod query;
mod ray;
mod real;
mod set;
mod simd;
mod soup;
mod stats;
mod stats_collector;
pub mod storage;

pub use aabb::Aabb;
pub use box_query::{BoxQuery, ClosestLeaf};
pub use brute_force::BruteForce;
pub use certified::{CertifiedQuery, CertifyError, shape_of};
pub use error::BuildError;
pub use index::{BuildIndex, ClosestPoint};
pub use indexed::Indexed;
pub use kernel::Key;
pub use near_query::{Near, NearQuery};
pub use primitive::{Feature, Point, Primitive, Projection, Segment, Shape, Triangle};
pub use query::{Best, Closest, Collector, QueryOptions};
pub use ray::{Crossing, Hit, Hits, Ray, RayCollector, RayError, RayHit, RayQuery, RayStatsCollector, Side};
pub use real::Real;
pub use set::{PrimitiveId, PrimitiveSet, check_set};
pub use simd::Isa;
pub use soup::{Element, Soup};
pub use stats::{Inspect, ListStats, QueryCost, Stat};
pub use stats_collector::StatsCollector;

/// The inside of this crate, for its sibling crates: it may change at any time.
#[doc(hidden)]
pub mod engine {
    pub mod curve {
        pub use crate::curve::*;
    }
    pub mod double {
        pub use crate::kernel::double_double::*;
    }
    pub mod integers {
        pub use crate::exact::*;
    }
    pub mod number {
        pub use crate::kernel::arithmetic::*;
    }
    pub mod query {
        pub use crate::query::BestF64;
    }
    pub mod ray {
        pub use crate::ray::{UNDERFLOW_MARGIN as TINY, project_onto_ray as foot};
    }
    pub mod real {
        pub use crate::real::{from_f64_array, to_f64_array};
    }
    pub mod simd {
        pub use crate::simd::*;
    }
    pub mod staged {
        pub use crate::predicates::adaptive::*;
    }
    pub mod vector {
        pub use crate::kernel::vector::*;
    }
    pub mod vertices {
        pub use crate::kernel::vertices::*;
    }
}
