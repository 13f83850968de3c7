//! The index of a run: its backend, its options, its signs.

pub(crate) mod args;
pub(crate) mod backend;
pub(crate) mod kdop_directions;
pub(crate) mod p2m_args;
pub(crate) mod shards;
pub(crate) mod sign_rule;
