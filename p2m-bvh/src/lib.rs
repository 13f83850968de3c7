//! AABB tree with surface-area splits.
//!
//! Nodes of eight boxes over packets of sixteen primitives ([`PacketTree`](p2m_core::hierarchy::PacketTree)), searched
//! nearest first with the vector instructions that the processor turns out to have. Boxes and packets only bound
//! distances, in f32 and with proof (docs/proofs/filter.md); what may be the answer is evaluated by the kernel of the
//! contract, so answers are bitwise those of [`BruteForce`](p2m_core::BruteForce).
//!
//! ```
//! use p2m_bvh::AabbTree;
//! use p2m_core::{BuildIndex, ClosestPoint, Segment};
//! use nalgebra::Point3;
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 3.0, 0.0)),
//! ];
//! let tree = AabbTree::build(&wires, &Default::default()).unwrap();
//! let answer = tree.closest_point(&Point3::new(1.0, 2.0, 0.0)).unwrap();
//! assert_eq!((answer.primitive.index(), answer.distance), (1, 1.0));
//! ```
#![forbid(unsafe_code)]

use p2m_core::Aabb;
use p2m_core::hierarchy::TreeIndex;

pub use p2m_core::hierarchy::SplitRule;

/// Options of an [`AabbTree`]: those of splits, there are no others.
pub type AabbOptions = p2m_core::hierarchy::SplitOptions;

/// An AABB tree over a set of primitives, which it keeps.
pub type AabbTree<T, S> = TreeIndex<T, S, Aabb<f64>>;
