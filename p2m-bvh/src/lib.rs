//! AABB tree with surface-area splits.
//!
//! The first form, kept plain: a binary tree with a box of the scene's scalar beside each node, searched nearest first.
//! Boxes bound the kernel's own arithmetic (see [`Aabb::lower_bound`](p2m_core::Aabb::lower_bound)), so pruning needs
//! no slack and answers are bitwise those of [`BruteForce`](p2m_core::BruteForce).
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

mod tree;

pub use p2m_core::hierarchy::{SplitOptions as AabbOptions, SplitRule};
pub use tree::{AabbTree, NodeBox};
