//! A k-DOP tree: bounding volumes of K slab directions.
//!
//! It is the tree of p2m-bvh (nodes with eight children over packets of sixteen primitives, with the same splits), but
//! its bounding volumes are [k-DOPs](Kdop) instead of boxes. They fit primitives that are oblique to the axes more
//! closely, so a query visits fewer nodes and packets. In return each node takes more arithmetic and memory.
//! [docs/measurements/kdop.md] compares the two.
//!
//! K is fixed at compile time and counts both signs of a direction, so `KdopTree<f64, _, 14>` has seven slabs.
//! [`Directions`] has default sets for K = 6, 14, 18 and 26, and can be created from your own vectors. With any
//! directions, answers are bitwise equal to the answers of [`BruteForce`](p2m_core::BruteForce).
//!
//! ```
//! use p2m_core::{ClosestPoint, Segment};
//! use p2m_kdop::{Directions, KdopOptions, KdopTree};
//! use nalgebra::{Point3, Vector3};
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 4.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 7.0, 0.0)),
//! ];
//! let tree = KdopTree::<f64, _, 14>::new(&wires).unwrap();
//! let answer = tree.closest_point(&Point3::new(1.0, 3.5, 0.0)).unwrap();
//! assert_eq!(answer.primitive.index(), 1);
//!
//! // These slabs lie along and across the wires.
//! let own = Directions::new(&[Vector3::new(1.0, 1.0, 0.0), Vector3::new(1.0, -1.0, 0.0), Vector3::z()]).unwrap();
//! let tree = KdopTree::<f64, _, 6>::build_with(&wires, &KdopOptions::new(own)).unwrap();
//! assert_eq!(tree.closest_point(&Point3::new(1.0, 3.5, 0.0)), Some(answer));
//! ```
//!
//! # References
//! \[Klosowski1998\] describes the trees. The features and figures of this crate are compared with the manual of the
//! k-DOP tree that was made for CGAL.
//!
//! [docs/measurements/kdop.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/kdop.md
#![forbid(unsafe_code)]

mod direction_choice;
mod direction_table;
mod directions;
mod kdop;
mod lower_bound;
mod node;
mod options;
mod orientation;
mod polytope;
#[cfg(test)]
mod tests;
mod volume;

pub use direction_choice::DirectionChoice;
pub use directions::{Directions, DirectionsError};
pub use kdop::Kdop;
pub use options::KdopOptions;
pub use p2m_bvh::{SplitOptions, SplitRule, TreeNode};
pub use polytope::{Polytope, write_polytopes_ply};

/// A k-DOP tree over a set of primitives, which it owns.
///
/// The type is an alias of [`TreeIndex`](p2m_bvh::TreeIndex), whose methods are:
///
/// - [`build_with`](p2m_bvh::TreeIndex::build_with) builds a tree for any K, and
///   [`BuildIndex::build`](p2m_core::BuildIndex::build) one with the default directions of K = 6, 14, 18 or 26;
/// - [`refit`](p2m_bvh::TreeIndex::refit) fits the tree to moved primitives;
/// - [`save`](p2m_bvh::TreeIndex::save) and [`load`](p2m_bvh::TreeIndex::load) write the tree to a file and read it;
/// - [`set`](p2m_bvh::TreeIndex::set), [`tree`](p2m_bvh::TreeIndex::tree), [`memory`](p2m_bvh::TreeIndex::memory) and
///   [`directions`](p2m_bvh::TreeIndex::directions) return its parts and its size;
/// - [`visit`](p2m_bvh::TreeIndex::visit) and [`visit_ray`](p2m_bvh::TreeIndex::visit_ray) search with a collector of
///   your own;
/// - [`with_isa`](p2m_bvh::TreeIndex::with_isa) selects an instruction set.
///
/// Queries are methods of the traits that it implements: [`ClosestPoint`](p2m_core::ClosestPoint),
/// [`NearQuery`](p2m_core::NearQuery), [`BoxQuery`](p2m_core::BoxQuery), [`RayQuery`](p2m_core::RayQuery)
/// and [`CertifiedQuery`](p2m_core::CertifiedQuery).
pub type KdopTree<T, S, const K: usize = 14> = p2m_bvh::TreeIndex<T, S, Kdop<K>>;

/// The internals of this crate that its sibling crates use. They may change at any time.
#[doc(hidden)]
#[cfg(not(test))]
pub mod engine {
    use crate::Kdop;
    use p2m_bvh::engine::volume::{Searches, searches};

    /// The searches of trees with 6, 14, 18 and 26 faces, which have default directions. A generic function is compiled
    /// in each crate that calls it, unless an upstream crate has compiled it for the same parameters and it is never
    /// inlined. The searches are such functions, so crates that use this one need not compile them.
    pub static COMPILED_SEARCHES: (Searches<Kdop<6>>, Searches<Kdop<14>>, Searches<Kdop<18>>, Searches<Kdop<26>>) =
        (searches(), searches(), searches(), searches());
}
