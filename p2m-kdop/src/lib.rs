//! k-DOP tree: bounding volumes of K slab directions.
//!
//! The tree of boxes of p2m-bvh (nodes of eight over packets of sixteen primitives, over the same splits) with
//! [k-DOPs](Kdop) in the place of boxes: they fit closer what does not lie along the axes, so fewer nodes and packets
//! are visited, at the price of more arithmetic and memory for each. docs/kdop.md has what that brings on which scenes.
//!
//! K is fixed at compile time and counts both signs: `KdopTree<f64, _, 14>` has seven slabs. [`Directions`] are the
//! usual ones for K = 6, 14, 18 and 26, or your own. Answers are those of [`BruteForce`](p2m_core::BruteForce), bit for
//! bit, whatever they are.
//!
//! ```
//! use p2m_core::{BuildIndex, ClosestPoint, Segment};
//! use p2m_kdop::{Directions, KdopOptions, KdopTree};
//! use nalgebra::{Point3, Vector3};
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 4.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 7.0, 0.0)),
//! ];
//! let tree = KdopTree::<f64, _, 14>::build(&wires, &Default::default()).unwrap();
//! let answer = tree.closest_point(&Point3::new(1.0, 3.5, 0.0)).unwrap();
//! assert_eq!(answer.primitive.index(), 1);
//!
//! // Slabs along and across the wires.
//! let own = Directions::new(&[Vector3::new(1.0, 1.0, 0.0), Vector3::new(1.0, -1.0, 0.0), Vector3::z()]).unwrap();
//! let tree = KdopTree::<f64, _, 6>::build_with(&wires, &KdopOptions::new(own)).unwrap();
//! assert_eq!(tree.closest_point(&Point3::new(1.0, 3.5, 0.0)), Some(answer));
//! ```
//!
//! # References
//! \[Klosowski1998\]; the manual of the k-DOP tree that was made for CGAL, whose features and figures these are
//! measured against.
#![forbid(unsafe_code)]

mod direction_choice;
mod directions;
mod heights;
mod kdop;
mod node;
mod options;
mod overlap;
mod polytope;
#[cfg(test)]
mod ray_entries;
mod volume;

pub use direction_choice::DirectionChoice;
pub use directions::{Directions, DirectionsError};
pub use kdop::Kdop;
pub use options::KdopOptions;
pub use overlap::Overlap;
pub use p2m_bvh::{SplitOptions, SplitRule, TreeNode};
pub use polytope::{Polytope, write_polytopes_ply};

/// A k-DOP tree over a set of primitives, which it keeps.
pub type KdopTree<T, S, const K: usize> = p2m_bvh::TreeIndex<T, S, Kdop<K>>;

/// The inside of this crate: it may change at any time.
#[doc(hidden)]
pub mod engine {
    pub use crate::volume::USUAL;
}
