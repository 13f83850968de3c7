//! An AABB tree with surface-area splits.
//!
//! [`AabbTree`] is a tree of nodes with eight boxes over packets of sixteen primitives ([`PacketTree`]). A search
//! visits the nearest node first and uses the vector instructions of the processor. Boxes and packets only bound
//! distances, in f32 and with a proof ([docs/proofs/filter.md]). The kernel of the contract evaluates the primitives
//! that may be the answer, so answers are bitwise equal to the answers of [`BruteForce`](p2m_core::BruteForce).
//!
//! ```
//! use p2m_bvh::AabbTree;
//! use p2m_core::{ClosestPoint, Segment};
//! use nalgebra::Point3;
//!
//! let wires = [
//!     Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0)),
//!     Segment::new(Point3::new(0.0, 3.0, 0.0), Point3::new(4.0, 3.0, 0.0)),
//! ];
//! let tree = AabbTree::new(&wires).unwrap();
//! let answer = tree.closest_point(&Point3::new(1.0, 2.0, 0.0)).unwrap();
//! assert_eq!((answer.primitive.index(), answer.distance), (1, 1.0));
//! ```
//!
//! The modules build on each other in this order: `packet` has the leaves, `tree` has the nodes and the tree itself,
//! `traverse` has the searches, and `construct` splits primitives top-down by a [`SplitRule`] into a binary tree and
//! merges its nodes. The k-DOP tree (crate p2m-kdop) and the interception indexes (crate p2m-interception) are built
//! from the same parts.
//!
//! [docs/proofs/filter.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/filter.md
#![forbid(unsafe_code)]

mod construct;
mod index;
mod packet;
mod pairs;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;
mod volume;

pub use construct::{SplitOptions, SplitRule};
pub use index::TreeIndex;
pub use tree::PacketTree;
pub use tree::view::TreeNode;
pub use volume::Volume;

use p2m_core::Aabb;

/// An AABB tree over a set of primitives, which it stores by value or as a reference.
///
/// The type is an alias of [`TreeIndex`], whose methods are:
///
/// - [`new`](TreeIndex::new) builds a tree with default options, and [`build_with`](TreeIndex::build_with) with
///   [`SplitOptions`], as [`BuildIndex::build`](p2m_core::BuildIndex::build) does;
/// - [`refit`](TreeIndex::refit) fits the tree to moved primitives;
/// - [`save`](TreeIndex::save) and [`load`](TreeIndex::load) write the tree to a file and read it;
/// - [`set`](TreeIndex::set), [`tree`](TreeIndex::tree), [`memory`](TreeIndex::memory) and
///   [`directions`](TreeIndex::directions) return its parts and its size;
/// - [`visit`](TreeIndex::visit) and [`visit_ray`](TreeIndex::visit_ray) search with a collector of your own;
/// - [`with_isa`](TreeIndex::with_isa) selects an instruction set.
///
/// Queries are methods of the traits that it implements: [`ClosestPoint`](p2m_core::ClosestPoint),
/// [`NearQuery`](p2m_core::NearQuery), [`BoxQuery`](p2m_core::BoxQuery), [`RayQuery`](p2m_core::RayQuery)
/// and [`CertifiedQuery`](p2m_core::CertifiedQuery).
/// ```
/// use p2m_bvh::AabbTree;
/// use p2m_core::{ClosestPoint, NearQuery, Soup};
///
/// let positions = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let scene: Soup<f64> = Soup::from_arrays(&positions, &[[0, 1, 2]])?;
/// let index = AabbTree::<f64, _>::new(scene)?;
/// let query = [1.0, 1.0, 2.0];
/// assert_eq!(index.closest_point(&query).map(|answer| answer.distance), Some(2.0));
/// assert!(!index.is_any_within(&query, 1.5));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
pub type AabbTree<T, S> = TreeIndex<T, S, Aabb<f64>>;

/// The internals of this crate that its sibling crates use. They may change at any time.
#[doc(hidden)]
pub mod engine {
    pub use crate::traverse::primitive_fn::evaluation;

    /// The search for the nearest primitives.
    pub mod nearest {
        pub use crate::traverse::evaluate::{finish, finish_nearest};
        pub use crate::traverse::nearest::Search;
        pub use crate::traverse::primitive_fn::EvaluateFn;
        pub use crate::traverse::search_state::SearchState;
    }
    /// Interleaved searches.
    pub mod interleaved {
        pub use crate::traverse::groups::answer_in_groups;
        pub use crate::traverse::interleaved_search::{InterleavedSearch, PacketVisit, SEARCHES};
        pub use crate::traverse::interleaved_traversal::InterleavedTraversal;
    }
    /// Nodes and their frame.
    pub mod node {
        pub use crate::tree::aabb_node::BoxNode;
        pub use crate::tree::frame::Frame;
        pub use crate::tree::node_ref::{NodeRef, WIDTH};
    }
    /// Trees as the sides of a search for pairs.
    pub mod pairs {
        pub use crate::traverse::pairs::TreeSide;
    }
    /// Packets and their filters.
    pub mod packet {
        pub use crate::packet::*;
    }
    /// Range searches.
    pub mod range {
        pub use crate::traverse::range::Selection;
    }
    /// Rays in the frame of a tree.
    pub mod ray {
        pub use crate::traverse::primitive_fn::IntersectFn;
        pub use crate::tree::frame_line::{FrameLine, half_extent, misses_scene};
        pub use crate::tree::ray_slab::{RayInterval, SlabRay};
    }
    /// The interface of bounding volumes.
    pub mod volume {
        pub use crate::construct::TreeOptions;
        pub use crate::tree::rounded::Rounded;
        pub use crate::tree::wide_node::{VolumeNodes, WideNode};
        #[cfg(not(test))]
        pub use crate::volume::COMPILED_SEARCHES;
        pub use crate::volume::{Searches, searches};
    }
}
