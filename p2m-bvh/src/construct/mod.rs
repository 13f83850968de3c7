//! The construction of a tree.
//!
//! Primitives are split top-down into a binary tree ([`split`], by the surface-area heuristic of [`sah`]) whose leaves
//! are packets. Its nodes are merged into nodes of eight children ([`collapse`]) while the packets are made. Finally
//! all nodes are bounded from the leaves to the root ([`packet_tree`]).

mod collapse;
mod options;
mod packet_tree;
pub(crate) mod primitive;
mod sah;
mod split;

pub use options::{SplitOptions, SplitRule, TreeOptions};
