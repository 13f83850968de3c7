//! AABB tree with surface-area splits.
//!
//! Nodes of eight boxes over packets of sixteen primitives ([`PacketTree`]), searched
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
//!
//! Primitives are split top-down into a binary tree by a [`SplitRule`] (`build`), which is then collapsed into wide nodes
//! over packets (`tree`, `packet`). The traversals are in `traverse`. The tree of k-DOPs (crate p2m-kdop) and the
//! interception indexes (crate p2m-interception) are made of the same parts.
#![forbid(unsafe_code)]

mod build;
mod index;
mod packet;
mod traverse;
mod tree;

pub use build::{SplitOptions, SplitRule};
pub use index::TreeIndex;
pub use tree::{PacketTree, TreeNode, Volume};

use p2m_core::Aabb;

/// Options of an [`AabbTree`]: those of splits, there are no others.
pub type AabbOptions = SplitOptions;

/// An AABB tree over a set of primitives, which it keeps.
pub type AabbTree<T, S> = TreeIndex<T, S, Aabb<f64>>;

/// The inside of this crate, for its sibling crates: it may change at any time.
#[doc(hidden)]
pub mod engine {
    pub use crate::tree::{Leaves, evaluation};
    pub mod nearest {
        pub use crate::traverse::nearest::*;
    }
    pub mod node {
        pub use crate::tree::aabb_node::*;
    }
    pub mod packet {
        pub use crate::packet::*;
    }
    pub mod range {
        pub use crate::traverse::range::*;
    }
    pub mod ray {
        pub use crate::traverse::ray::*;
    }
    pub mod ray_slab {
        pub use crate::traverse::ray_slab::*;
    }
    pub mod volume {
        pub use crate::tree::volume::*;
    }
}
