//! Interception: what can be the nearest primitive anywhere in a cell, found once and kept.
//!
//! A *partition* cuts the domain of queries into convex cells. Each cell has *dominators*: points y of the scene, so
//! that |q - y| bounds the answer for every q of the cell. Its *interception list* holds every primitive that can beat all
//! dominators somewhere in the cell. A query *locates* its cell and tests the list: no search, no backtracking
//! \[Zong2023\].
//!
//! What is in a list is decided by the corner test (`corner`), for any convex cell; how cells are made and located is
//! the partition's affair: cubes ([`Octree`], `refine`). Lists are lists of packets with the lanes that matter, eight
//! to a block, with bounds from the corners of the cell (`block`). Where a list would take longer than the tree over
//! the same packets, and outside of the domain, the tree answers. docs/octree.md has the proofs.

mod block;
mod corner;
mod cube;
mod octree;
mod options;
mod refine;

pub use octree::Octree;
pub use options::{Domain, OctreeOptions, OctreeReport};
